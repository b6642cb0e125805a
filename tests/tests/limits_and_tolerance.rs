//! Whatever the path, the limits, the method and the window: the judge finds nothing.

use proptest::prelude::*;
use std::cell::Cell;
use toolglide_tests::bounds::MIN_PLANS;
use toolglide_tests::course::Course;
use toolglide_tests::judged::judge;
use toolglide_tests::run::try_all;
use toolglide_tests::strategies;

/// Judges random courses.
fn judge_all<const N: usize>(courses: impl Strategy<Value = Course<N>>) {
    let plans = Cell::new(0);
    try_all(courses, CASES, |course, numbers| {
        plans.set(plans.get() + judge(course, numbers)?);
        Ok(())
    });
    assert!(plans.get() >= CASES * PLANS_A_CASE, "{} plans", plans.get());
}

/// Cases of each kind of course and number of axes.
const CASES: u32 = 100;

/// Every window with every method, which are four or more.
const PLANS_A_CASE: u32 = 16;

const _: () = assert!(9 * CASES * PLANS_A_CASE >= MIN_PLANS, "too few plans");

#[test]
fn any_path_in_two_axes_is_planned_within_its_limits() {
    judge_all(strategies::courses::<2>());
}

#[test]
fn any_path_in_three_axes_is_planned_within_its_limits() {
    judge_all(strategies::courses::<3>());
}

#[test]
fn any_path_in_four_axes_is_planned_within_its_limits() {
    judge_all(strategies::courses::<4>());
}

#[test]
fn zigzags_of_two_axes_are_planned_within_their_limits() {
    judge_all(strategies::zigzags::<2>());
}

#[test]
fn zigzags_of_three_axes_are_planned_within_their_limits() {
    judge_all(strategies::zigzags::<3>());
}

#[test]
fn zigzags_of_four_axes_are_planned_within_their_limits() {
    judge_all(strategies::zigzags::<4>());
}

#[test]
fn chords_of_curves_in_two_axes_are_planned_within_their_limits() {
    judge_all(strategies::curves::<2>());
}

#[test]
fn chords_of_curves_in_three_axes_are_planned_within_their_limits() {
    judge_all(strategies::curves::<3>());
}

#[test]
fn chords_of_curves_in_four_axes_are_planned_within_their_limits() {
    judge_all(strategies::curves::<4>());
}

#[test]
fn lines_and_arcs_without_a_corner_are_planned_within_their_limits() {
    judge_all(strategies::bends::<2>());
}
