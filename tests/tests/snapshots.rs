//! Three plans written down: a changed number is seen, and explained where it changed.
//!
//! Rows stand at the knots and at 64 equal times. Numbers are rounded so that the last digits of
//! the floating point do not show.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use std::fmt::Write;
use toolglide_kinematics::{Plan, Sample, Toolpath, Trajectory};
use toolglide_smoothing::{Settings, plan};
use toolglide_tests::course::{Course, Lead, Numbers, arc, go, limits, stop};
use toolglide_verify::verify;

/// Rows at equal times.
const ROWS: u32 = 64;

/// A number with some digits after the point, and zero without a sign.
fn rounded(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    if text.trim_matches(['-', '0', '.']).is_empty() {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    }
}

fn row<const N: usize>(kind: &str, time: f64, sample: &Sample<N>) -> String {
    let mut row = format!("{kind},{}", rounded(time, 6));
    for (vector, digits) in [
        (&sample.position, 6),
        (&sample.velocity, 4),
        (&sample.acceleration, 2),
        (&sample.jerk, 0),
    ] {
        for coordinate in vector {
            let _ = write!(row, ",{}", rounded(*coordinate, digits));
        }
    }
    row
}

fn written<const N: usize>(plan: &Plan<N>) -> String {
    let mut text = "at,t_s".to_owned();
    for (quantity, unit) in [("", "mm"), ("v", "mm/s"), ("a", "mm/s2"), ("j", "mm/s3")] {
        for axis in ["x", "y", "z"].iter().take(N) {
            let _ = write!(text, ",{quantity}{axis}_{unit}");
        }
    }
    text.push('\n');
    for (piece, time) in plan.pieces().iter().zip(plan.knots()) {
        let serves = piece.serves();
        let kind = format!("knot {}-{}", serves.first, serves.last);
        let _ = writeln!(text, "{}", row(&kind, *time, &piece.at(0.0)));
    }
    for tick in 0..=ROWS {
        let time = plan.duration() * f64::from(tick) / f64::from(ROWS);
        let _ = writeln!(text, "tick,{}", &row("", time, &plan.sample(time))[1..]);
    }
    text
}

fn snapshot<const N: usize>(name: &str, path: &Toolpath<N>, numbers: &Numbers<N>) {
    let limits = limits(numbers);
    let motion = plan(path, &Settings::new(limits)).unwrap();
    let report = verify(&motion, path, &limits);
    assert!(report.passes(), "{:#?}", report.examples);
    insta::assert_snapshot!(name, written(&motion));
}

#[test]
fn a_right_angle() {
    let ends = [[10.0, 0.0], [10.0, 10.0]];
    let course = Course::of_lines([0.0, 0.0], &ends, 100.0, 0.1);
    snapshot(
        "right_angle__kcs",
        &course.toolpath(),
        &[[500.0, 2_500.0, 2e5]; 2],
    );
}

#[test]
fn lines_an_arc_and_a_dwell() {
    let course = Course {
        start: [0.0; 3],
        legs: vec![
            go(Lead::Line([0.0, 0.0, -1.0]), f64::INFINITY, 0.02),
            go(Lead::Line([8.0, 0.0, -1.0]), 60.0, 0.02),
            go(
                arc([8.0, 3.0, 0.0], [8.0, 6.0, -1.0], [0, 1], true, 0),
                60.0,
                0.02,
            ),
            go(Lead::Dwell(0.1), 60.0, 0.02),
            stop(Lead::Line([4.0, 6.0, -1.0]), 60.0, 0.02),
            go(Lead::Line([0.0, 4.0, 0.0]), 120.0, 0.02),
        ],
    };
    snapshot(
        "line_arc_dwell__kcs",
        &course.toolpath(),
        &[[500.0, 2_000.0, 5e4]; 3],
    );
}

#[test]
fn a_reversal_with_unequal_axes() {
    let ends = [[10.0, 5.0], [2.0, 1.0], [2.0, 6.0]];
    let course = Course::of_lines([0.0, 0.0], &ends, 80.0, 0.05);
    let numbers = [[500.0, 3_000.0, 1e5], [200.0, 1_000.0, 2e4]];
    snapshot("reversal__kcs", &course.toolpath(), &numbers);
}
