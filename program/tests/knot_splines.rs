//! Splines whose program gives each knot.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{CLOSE, assert_close, ends, read, refusal};
use toolglide_program::{MachiningError, Reason};

/// A quarter of a circle about the origin at height 2, by three points with weights.
const QUARTER: &str = "G21 G90 F600\nG0 X10 Y0 Z2\nG6.2 P3 K0 X10 Y0 Z2 R1\n\
                       K0 X10 Y10 Z2 R0.70710678118654752\nK0 X0 Y10 Z2\nK1\nK1\nK1\n";

fn reason(text: &str) -> MachiningError {
    match refusal(text).3 {
        Reason::Machining(reason) => reason,
        other => panic!("{text:?}: {other}"),
    }
}

#[test]
fn three_weighted_points_make_a_quarter_of_a_circle() {
    let found = ends(QUARTER);
    assert!(found.len() > 20, "{} moves", found.len());
    for end in &found[1..] {
        assert!((end[0].hypot(end[1]) - 10.0).abs() < CLOSE, "{end:?}");
        assert!((end[2] - 2.0).abs() < CLOSE, "{end:?}");
    }
    assert_close(found.last().unwrap(), &[0.0, 10.0, 2.0], "end");
    let moves = read(QUARTER);
    assert_eq!(moves.last().unwrap().line(), 8, "the line of the last knot");
}

#[test]
fn equal_steps_between_knots_make_the_spline_of_control_points_alone() {
    let points = "X0 Y10\nX20 Y20\nX20 Y0\nX5 Y5\n";
    let even = format!("F600\nG0 X0 Y0\nG5.2 P1 L3\n{points}G5.3\n");
    let knots = ["0", "0", "1", "2"];
    let lines: String = points
        .lines()
        .zip(knots)
        .map(|(point, knot)| format!("K{knot} {point}\n"))
        .collect();
    let with_knots = format!("F600\nG0 X0 Y0\nG6.2 P3 K0\n{lines}K3\nK3\nK3\n");
    let (one, other) = (ends(&even).concat(), ends(&with_knots).concat());
    assert_close(&one, &other, "the same curve");
}

#[test]
fn a_spline_goes_up_as_well() {
    let text = "F600\nG0 X0 Y0\nG6.2 P2 X0\nK0 X5 Y0 Z3\nK1 X10 Z0\nK2\nK2\n";
    assert_close(
        &ends(text).concat(),
        &[0.0, 0.0, 0.0, 5.0, 0.0, 3.0, 10.0, 0.0, 0.0],
        "straight between the points of a spline of order 2",
    );
}

#[test]
fn a_spline_begins_where_the_tool_is() {
    let text = "F600\nG6.2 P2 K0 X0.5 Y0\nK0 X5\nK1\nK1\n";
    let expected = MachiningError::SplineStart {
        distance: 0.5,
        allowed: 0.003,
    };
    assert_eq!(reason(text), expected, "start");
}

#[test]
fn knots_that_make_no_curve_are_refused() {
    let with = |knots: &str| format!("F600\nG6.2 P3 K0\n{knots}");
    let order = 3;
    assert_eq!(
        reason(&with("K1 X1\nK0 X2\n")),
        MachiningError::KnotFalls {
            knot: 0.0,
            before: 1.0
        },
        "falls"
    );
    assert_eq!(reason(&with("X1\n")), MachiningError::NoKnot, "missing");
    assert_eq!(
        reason(&with("K0 X1\nK1 X2\nK2\nK2\nK2\n")),
        MachiningError::KnotsNotClamped { order },
        "begins elsewhere"
    );
    assert_eq!(
        reason(&with("K0 X1\nK0 X2\nK1\nK1\nK2\n")),
        MachiningError::KnotsNotClamped { order },
        "ends elsewhere"
    );
    assert_eq!(
        reason(&with("K0 X1\nK0 X2\nK1 X3\nK1 X4\nK1 X5\nK2\nK2\nK2\n")),
        MachiningError::KnotRepeated { knot: 1.0, most: 2 },
        "torn"
    );
    assert_eq!(
        reason(&with("K0 X1\nK0 X2\nK0 X3\nK2\nK2\nK2\n")),
        MachiningError::KnotRepeated { knot: 0.0, most: 3 },
        "torn at its start"
    );
    let given = 2;
    assert_eq!(
        reason(&with("K0 X1\nK0\nK0\nK0\n")),
        MachiningError::TooFewPoints { given, order },
        "too few points"
    );
    assert_eq!(
        reason(&with("K0 X1\nK0 X2\nK1\nK1 X3\n")),
        MachiningError::LatePoint,
        "late point"
    );
}

#[test]
fn a_spline_that_is_not_complete_is_refused_where_something_else_stands() {
    let missing = |given| MachiningError::KnotsMissing { given, wanted: 5 };
    let open = "F600\nG6.2 P3 K0\nK0 X1\n";
    assert_eq!(reason(&format!("{open}G1 X5\n")), missing(2), "a move");
    assert_eq!(reason(&format!("{open}M2\n")), missing(2), "M2");
    assert_eq!(reason(&format!("{open}%\n")), missing(2), "percent");
    assert_eq!(reason(open), missing(2), "end of the file");
    assert_eq!(
        reason("F600\nG5.2 X1 Y1\nX2 Y0\n"),
        MachiningError::OpenSpline,
        "control points alone"
    );
}

#[test]
fn behind_a_spline_no_motion_goes_on_by_itself() {
    let (.., reason) = refusal(&format!("{QUARTER}X0 Y0\n"));
    assert_eq!(reason, Reason::NoMotionMode { letter: 'X' }, "none");
    let found = ends(&format!("{QUARTER}G1 X0 Y0\n"));
    assert_close(found.last().unwrap(), &[0.0, 0.0, 2.0], "written again");
}

#[test]
fn knots_stand_in_splines_only() {
    let (.., reason) = refusal("F600\nG1 X1 K1\n");
    assert_eq!(reason, Reason::Unused { letter: 'K' }, "K");
}

#[test]
fn a_spline_as_linuxcnc_writes_it_is_the_same_curve() {
    let points = "X64.124 Y106.12 R1 K0\nX65.998 Y103.621 R1 K0\nX80.988 Y83.634 R2 K1\nX92.98 Y35.666 R1 K2\n";
    let begin = "F600\nG0 X63.562 Y106.12\n";
    let first = "X63.562 Y106.12 R1 K0 P3";
    let ours = format!("{begin}G6.2 {first}\n{points}K3\nK3\nK3\nG1 X0\n");
    let expected = common::ends(&ours);
    assert!(expected.len() > 20, "{} moves", expected.len());
    for way in 1..=3 {
        let theirs =
            format!("{begin}G6.2 {first} Q{way}\n{points}G6.2 K3\nG6.2 K3\nG6.2 K3\nG1 X0\n");
        assert_eq!(common::ends(&theirs), expected, "Q{way}");
    }
    for wrong in ["Q4", "Q0", "Q1.5"] {
        let text = format!("{begin}G6.2 {first} {wrong}\n{points}K3\nK3\nK3\n");
        assert!(
            common::try_read(&text, common::settings()).is_err(),
            "{wrong}"
        );
    }
}

#[test]
fn a_spline_of_control_points_may_lie_in_any_plane() {
    let spline = "G5.2 P1 L3\nU1 V2\nU3 V5 P2\nU6 V1\nG5.3\n";
    let text = |plane: &str, first: &str, second: &str| {
        let points = spline.replace('U', first).replace('V', second);
        common::ends(&format!("F600\n{plane}\n{points}"))
    };
    let flat = text("G17", "X", "Y");
    let turned = text("G18", "Z", "X");
    let upright = text("G19", "Y", "Z");
    assert!(flat.len() > 10, "{} chords", flat.len());
    for ((one, other), third) in flat.iter().zip(&turned).zip(&upright) {
        assert_close(&[one[0], one[1]], &[other[2], other[0]], "G18");
        assert_close(&[one[0], one[1]], &[third[1], third[2]], "G19");
    }
    let wrong = "F600\nG18\nG5.2 L3\nX1 Y2\nX3\nG5.3\n";
    assert!(common::try_read(wrong, common::settings()).is_err(), "Y");
}
