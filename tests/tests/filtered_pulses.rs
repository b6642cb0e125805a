//! Filtered feed pulses keep every limit and the tolerance of the true path, and land exactly.

use toolglide_tests::filtered::{keeps, keeps_behind_one};
use toolglide_tests::{run, strategies};

/// Cases of each kind of course, each planned eight times.
const CASES: u32 = 40;

/// Mixed courses of each dimension, each planned twice: a thousand in all.
const MIXED: u32 = 500;

#[test]
fn any_course_of_lines_and_arcs_in_space() {
    run::try_all(strategies::courses::<3>(), MIXED, keeps_behind_one);
}

#[test]
fn any_course_of_lines_and_arcs_in_the_plane() {
    run::try_all(strategies::courses::<2>(), MIXED, keeps_behind_one);
}

#[test]
fn corners_of_any_angle() {
    run::try_all(strategies::zigzags::<2>(), CASES, keeps);
}

#[test]
fn curves_cut_into_chords() {
    run::try_all(strategies::curves::<3>(), CASES, keeps);
}

#[test]
fn lines_and_arcs_without_a_corner() {
    run::try_all(strategies::bends::<2>(), MIXED, keeps_behind_one);
}
