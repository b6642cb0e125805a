//! The first cut of the language of Sinumerik 840D.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{CLOSE, FILE, settings};
use toolglide_kinematics::{PoseEnd, PoseFeed, PoseMove, Vector};
use toolglide_program::{Language, Poses, ProgramError};

fn try_read(text: &str) -> Result<Vec<PoseMove>, ProgramError> {
    Poses::new(text.as_bytes(), FILE, settings(), Language::Sinumerik).collect()
}

fn ends(text: &str) -> Vec<Vector<3>> {
    let moves = try_read(text).unwrap_or_else(|error| panic!("{text:?}: {error}"));
    moves
        .iter()
        .map(|step| match step.end() {
            PoseEnd::Axes { linear, .. } => *linear,
            other => panic!("{other:?}"),
        })
        .collect()
}

fn assert_ends(text: &str, expected: &[[f64; 3]]) {
    let found = ends(text);
    assert_eq!(found.len(), expected.len(), "{text:?}: {found:?}");
    for (one, other) in found.iter().zip(expected) {
        let off = (one - Vector::<3>::from(*other)).norm();
        assert!(off < CLOSE, "{text:?}: {found:?}, expected {expected:?}");
    }
}

#[test]
fn addresses_take_numbers_and_expressions() {
    let text = "N10 DEF REAL _SAFE = 5, _DEEP\nN20 _DEEP = -(2 + 1) * 2\nN30 G0 X=_SAFE+1 Z = _SAFE\n\
                N40 R1=4.5 G1 Z=_DEEP Y=SIN(30)*R1 F600 ; remark\n";
    assert_ends(text, &[[6.0, 0.0, 5.0], [6.0, 2.25, -6.0]]);
}

#[test]
fn absolute_and_incremental_values_stand_side_by_side() {
    assert_ends(
        "G90 G0 X5 Y5\nX=IC(2) Y1\nG91 X1 Y=AC(0)\n",
        &[[5.0, 5.0, 0.0], [7.0, 1.0, 0.0], [8.0, 0.0, 0.0]],
    );
}

#[test]
fn frames_shift_and_turn_and_end() {
    let text = "TRANS X10\nG0 X1\nAROT Z90\nG0 X2 Y0\nATRANS X1\nG0 X0\nTRANS\nG0 X0 Y0\n";
    assert_ends(
        text,
        &[
            [11.0, 0.0, 0.0],
            [10.0, 2.0, 0.0],
            [10.0, 1.0, 0.0],
            [0.0, 0.0, 0.0],
        ],
    );
}

#[test]
fn an_arc_in_a_turned_frame_keeps_its_radius() {
    let text = "AROT X30.\nG0 X10 Y0 Z0\nG3 X-10 Y0 I-10 J0 F600\n";
    let found = ends(text);
    assert!(found.len() > 20, "{} chords", found.len());
    for end in &found {
        assert!((end.norm() - 10.0).abs() < CLOSE, "{end}");
    }
    let top = found.iter().map(|end| end[2]).fold(0.0, f64::max);
    assert!((top - 5.0).abs() < 0.01, "half the radius high: {top}");
}

#[test]
fn machine_coordinates_know_no_frame() {
    assert_ends(
        "TRANS X10 Y10\nSUPA G0 Z50 D0\nSUPA G0 X-3 Y=1+1\n",
        &[[0.0, 0.0, 50.0], [-3.0, 2.0, 50.0]],
    );
}

#[test]
fn the_tool_tip_moves_between_traori_and_trafoof() {
    let moves = try_read("G0 B90. C0.0\nTRAORI\nG0 X1\nTRAFOOF\nG0 X2\n").unwrap();
    let tips: Vec<bool> = moves
        .iter()
        .map(|step| matches!(step.end(), PoseEnd::Axes { tip: true, .. }))
        .collect();
    assert_eq!(tips, [false, true, false], "tips");
    let PoseEnd::Axes { rotary, .. } = moves[2].end() else {
        panic!("axis words")
    };
    assert!(
        (rotary[1] - std::f64::consts::FRAC_PI_2).abs() < CLOSE,
        "B stays"
    );
}

#[test]
fn cycle832_sets_the_tolerance_and_ends_it() {
    let text = "G60\nG1 X1 F600\nCYCLE832(.02,1,1)\nX2\nCYCLE832()\nX3\n";
    let moves = try_read(text).unwrap();
    let tolerances: Vec<f64> = moves.iter().map(|step| step.tolerance().length()).collect();
    assert!((tolerances[1] - 0.02).abs() < CLOSE, "{tolerances:?}");
    assert!((tolerances[2] - 0.01).abs() < CLOSE, "{tolerances:?}");
    let stops: Vec<bool> = moves.iter().map(PoseMove::stops).collect();
    assert_eq!(stops, [true, false, false], "exact stop before");
}

#[test]
fn radius_turns_dwells_and_tool_names_are_read() {
    let text =
        "T=\"MILL 12\" M6\nMSG(\"hello (there)\")\nG0 X0 Y0\nG2 X10 Y0 CR=5 F600\nG4 F2\nM17\nX9\n";
    let moves = try_read(text).unwrap();
    let last = moves.last().unwrap();
    assert_eq!(
        last.end(),
        &PoseEnd::Dwell { duration: 2.0 },
        "G4 F is a time"
    );
    assert!(
        matches!(moves[1].feed(), PoseFeed::Speed(speed) if (speed.speed() - 10.0).abs() < CLOSE),
        "feedrate"
    );
}

#[test]
fn what_is_not_read_is_refused_at_its_place() {
    for (text, expected) in [
        (
            "G0 X1\n  GOTOF ENDE",
            "part.ngc:2:3: GOTOF is not supported in this dialect",
        ),
        (
            "G41 X1",
            "part.ngc:1:1: G41 is not supported in this dialect",
        ),
        (
            "X=_NO",
            "part.ngc:1:3: parameter #<_no> has no value: it was never set here",
        ),
        (
            "_NO=5",
            "part.ngc:1:1: _NO is not supported in this dialect",
        ),
        (
            "CYCLE800(1,2)",
            "part.ngc:1:1: CYCLE800 with arguments is not supported in this dialect",
        ),
        (
            "G0 X=(1+2",
            "part.ngc:1:6: \"[\" is not closed: an operator or \"]\" is missing",
        ),
        ("G0 X1/0 !", "part.ngc:1:6: character '/' begins no word"),
    ] {
        let shown = try_read(text).unwrap_err().to_string();
        assert_eq!(shown, expected, "{text:?}");
    }
}
