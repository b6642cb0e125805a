//! Cycles of drilling and boring.
//!
//! Where a number is not plain, LinuxCNC gives the same.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{assert_close, assert_ends, dwell, read, refusal};
use toolglide_kinematics::{Move, Vector};
use toolglide_program::{MachiningError, Reason};

#[test]
fn drilling_goes_over_down_and_up() {
    let text = "G0 Z10\nG99 G81 X1 Y2 Z-3 R2 F60\nX4\nG80\n";
    let z = [10.0, 10.0, 2.0, -3.0, 2.0, 2.0, -3.0, 2.0];
    let x = [0.0, 1.0, 1.0, 1.0, 1.0, 4.0, 4.0, 4.0];
    let expected: Vec<[f64; 3]> = (0..8)
        .map(|n| [x[n], if n > 0 { 2.0 } else { 0.0 }, z[n]])
        .collect();
    assert_ends(text, &expected);
    assert!(
        read(text)[1..].iter().all(Move::stops),
        "a hole has a bottom"
    );
    let up = read("G0 Z10\nG98 G81 X1 Z-3 R2 F60");
    assert_close(
        &[up.last().unwrap().end(Vector::zeros())[2]],
        &[10.0],
        "G98",
    );
}

#[test]
fn repeated_incremental_holes_step_on() {
    let moves = read("G0 Z10\nG91 G81 X2 Z-3 R-5 L2 F60");
    let mut at = Vector::zeros();
    let ends: Vec<[f64; 3]> = moves
        .iter()
        .map(|step| {
            at = step.end(at);
            at.into()
        })
        .collect();
    let expected = [
        [2.0, 0.0, 5.0],
        [2.0, 0.0, 2.0],
        [2.0, 0.0, 5.0],
        [4.0, 0.0, 5.0],
        [4.0, 0.0, 2.0],
    ];
    assert_close(&ends[2..7].concat(), &expected.concat(), "holes");
}

#[test]
fn pecks_withdraw_or_break_the_chip() {
    let z = |text: &str| -> Vec<f64> {
        read(text)
            .iter()
            .map(|step| step.end(Vector::zeros())[2])
            .collect()
    };
    let begin = "G0 Z1\nF60 ";
    let deep = z(&format!("{begin}G83 X0 Z-2 R1 Q1"));
    assert_close(
        &deep[1..],
        &[0.0, 1.0, 0.254, -1.0, 1.0, -0.746, -2.0, 1.0],
        "withdrawn",
    );
    let chip = z(&format!("{begin}G73 X0 Z-2 R1 Q1"));
    assert_close(&chip[1..], &[0.0, 0.254, -1.0, -0.746, -2.0, 1.0], "broken");
}

#[test]
fn boring_feeds_out_and_dwells() {
    let moves = read("G0 Z1\nG82 X0 Z-2 R1 P.5 F60\nG85 X1 Z-2 R1\nG89 X2 Z-2 R1 P2");
    let dwells: Vec<f64> = moves.iter().filter_map(dwell).collect();
    assert_close(&dwells, &[0.5, 2.0], "dwells");
    let feeds = moves
        .iter()
        .filter(|step| dwell(step).is_none() && !common::is_rapid(step));
    assert_eq!(feeds.count(), 5, "one down, and two down and up");
}

#[test]
fn incomplete_cycles_are_refused() {
    for (text, expected) in [
        ("F9 G81 X1 Z-1", "the first block of G81 needs a R word"),
        ("F9 G81 X1 R1", "the first block of G81 needs a Z word"),
        ("F9 G83 X1 Z-1 R1", "the first block of G83 needs a Q word"),
        ("F9 G82 X1 Z-1 R1", "the first block of G82 needs a P word"),
        (
            "F9 G81 X1 Z2 R1",
            "R is at 1 mm, below the bottom of the hole at 2 mm",
        ),
        (
            "F9 G83 X1 Z-1 R1 Q0",
            "depth of a peck is 0, but must be positive",
        ),
        (
            "G81 X1 Z-1 R1",
            "feedrate was never set, but a feed move needs one",
        ),
    ] {
        let (.., reason) = refusal(text);
        assert_eq!(reason.to_string(), expected, "{text:?}");
    }
    let (.., reason) = refusal("F9 G83 X1 Z-1000000 R1 Q.001");
    assert!(
        matches!(
            reason,
            Reason::Machining(MachiningError::TooManyMoves { .. })
        ),
        "{reason}"
    );
}

#[test]
fn holes_may_be_named_by_distance_and_angle() {
    let text = "F100\nG0 Z10\nG99 G81 @10 ^0 Z-2 R1\n^90\nG91 ^90 L2\nG80\n";
    let bottoms: Vec<[f64; 3]> = common::ends(text)
        .into_iter()
        .filter(|end| (end[2] + 2.0).abs() < 1e-9)
        .collect();
    let expected = [[10.0, 0.0, -2.0], [0.0, 10.0, -2.0]];
    common::assert_close(&bottoms[..2].concat(), &expected.concat(), "G90");
    let refused = common::try_read("F100\nG0 Z10\nG18 G81 @10 ^0 Y-2 R1\n", common::settings());
    assert!(refused.is_err(), "outside G17");
}
