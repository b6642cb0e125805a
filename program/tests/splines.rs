//! Splines of RS274/NGC as chords.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{CLOSE, assert_close, read, refusal};
use toolglide_kinematics::Vector;

#[test]
fn splines_are_chords_that_end_where_they_should() {
    for (text, end) in [
        ("G5 I0 J3 P0 Q-3 X1 Y1 F60", [1.0, 1.0]),
        ("G5.1 X2 I1 J2 F60", [2.0, 0.0]),
        ("F60 G5.2 P1 L3 X0 Y1\nX2 Y2\nX2 Y0 P2\nG5.3", [2.0, 0.0]),
    ] {
        let moves = read(text);
        assert!(moves.len() > 4, "{text:?}: {} chords", moves.len());
        let last = moves.last().unwrap();
        let there = last.end(Vector::zeros());
        assert_close(&[there[0], there[1]], &end, text);
        assert_close(
            &[last.tolerance().length()],
            &[0.009],
            "the rest of the tolerance",
        );
    }
    // A parabola: y = 2 x - x² from 0 to 2.
    for step in read("G5.1 X2 I1 J2 F60") {
        let end = step.end(Vector::zeros());
        assert!(
            (end[1] - (2.0 * end[0] - end[0] * end[0])).abs() < CLOSE,
            "{end}"
        );
    }
}

#[test]
fn splines_out_of_place_are_refused() {
    for (text, expected) in [
        ("F9 G5 X1 P1 Q1", "G5 needs I and J"),
        ("F9 G5 X1 I1 J1", "G5 needs P and Q"),
        (
            "F9 G18 G5.1 X1 I1",
            "G5.1 is not possible outside the plane XY (G17)",
        ),
        (
            "F9 G5.2 X1 L3\nG1 X2",
            "the spline begun by G5.2 is not ended by G5.3",
        ),
        ("G5.3", "G5.3 ends a spline, but none was begun by G5.2"),
        (
            "F9 G5.2 X1 L4\nG5.3",
            "the spline has 2 points, but its order of 4 needs at least as many",
        ),
        ("F9 G5.2 X1 P0", "weight is 0, but must be positive"),
    ] {
        let (.., reason) = refusal(text);
        assert_eq!(reason.to_string(), expected, "{text:?}");
    }
}
