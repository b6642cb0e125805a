//! Arcs whose coordinates were rounded to 0.01 mm or 0.001 inch: LinuxCNC's limits, and a centre that fits.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

#[macro_use]
mod common;

use common::{FILE, assert_close, last_arc, settings, try_read};
use toolglide_kinematics::{Arc, Path, ToolpathError};
use toolglide_program::{Notice, Program, Reason};

const TWO_DECIMALS: &str = "G21 G90 F600\nG0 X0.00 Y0.00\nG2 X2.12 Y0.88 I2.12 J-2.13\n\
    G3 X4.25 Y1.76 I2.13 J-2.12\nG2 X6.37 Y2.64 I2.12 J-2.13\nM2\n";

fn radii(arc: &Arc<3>) -> [f64; 2] {
    let (start, end) = arc.radii();
    [start, end]
}

#[test]
fn the_centre_of_a_rounded_arc_is_moved_so_that_both_ends_are_on_one_circle() {
    let mut program = Program::new(TWO_DECIMALS.as_bytes(), FILE, settings());
    let arcs: Vec<Arc<3>> = program
        .by_ref()
        .filter_map(|step| match step.unwrap().path() {
            Path::Arc(arc) => Some(*arc),
            _ => None,
        })
        .collect();
    assert_eq!(arcs.len(), 3, "arcs");
    let [start, end] = radii(&arcs[1]);
    assert_close(&[start], &[end], "one circle");
    let center = arcs[1].center();
    let written = [4.25, -1.24];
    let moved = (center[0] - written[0]).hypot(center[1] - written[1]);
    assert!(moved > 0.005 && moved < 0.01, "moved by {moved} mm");
    let off = (center[0] - 4.243_723_9).hypot(center[1] + 1.242_593);
    assert!(off < 1e-6, "{center}");
}

#[test]
fn rounded_arcs_are_told_once() {
    let twice = format!(
        "{}G3 X0 Y0.02 I-3.185 J-1.31\n",
        TWO_DECIMALS.replace("M2\n", "")
    );
    let mut program = Program::new(twice.as_bytes(), FILE, settings());
    program
        .by_ref()
        .for_each(|step| assert!(step.is_ok(), "{step:?}"));
    let [warning] = program.warnings() else {
        panic!("{:?}", program.warnings())
    };
    assert_eq!(warning.place().line(), 4, "the first");
    let Notice::RoundedArc { mismatch } = warning.notice() else {
        panic!("{warning}")
    };
    assert!((mismatch - 0.005_207).abs() < 1e-5, "{mismatch}");
}

#[test]
fn the_limits_are_those_of_linuxcnc() {
    let radius = |text: &str| try_read(&format!("F60 {text}"), settings());
    // Half a circle whose end is this much too far.
    for (text, read) in [
        ("G2 X2.028 I1", true),
        ("G2 X2.029 I1", false),
        ("G20 G2 X2.0028 I1", true),
        ("G20 G2 X2.0029 I1", false),
        ("G2 X200.1 I100", true),
        ("G2 X200.11 I100", false),
        ("G2 X4002.9 I2000", false),
        ("G2 X4001.9 I2000", true),
        ("G2 X6002.8 I3000", true),
        ("G2 X6002.9 I3000", false),
    ] {
        assert_eq!(radius(text).is_ok(), read, "{text}");
    }
    refuses!(
        "F60 G2 X2.029 I1",
        1,
        15,
        "I1",
        Reason::Path(ToolpathError::ArcMismatch { .. })
    );
}

#[test]
fn an_almost_whole_circle_keeps_its_centre() {
    let arc = last_arc("F60\nG3 X0.02 Y0 I10 J0");
    assert_close(&radii(&arc), &[10.0, 9.98], "radii");
    assert_close(&[arc.sweep()], &[std::f64::consts::TAU], "a whole turn");
    let arc = last_arc("F60\nG2 X0.01 Y0.015 I10 J0");
    let center = arc.center();
    let moved = (center[0] - 10.0).hypot(center[1]);
    assert!(moved < 0.0283, "moved by {moved} mm");
    assert!((arc.end()[0] - 0.01).abs() < 1e-12, "the end is met");
}

#[test]
fn rounding_that_nobody_sees_moves_nothing() {
    let arc = last_arc("F60\nG2 X2.003 I1");
    assert_close(&radii(&arc), &[1.0, 1.003], "radii");
}
