//! Tool poses: cutter location files, and axis words of machines with rotary axes.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{CLOSE, FILE, settings};
use toolglide_kinematics::{PoseEnd, PoseFeed, PoseMove, Vector};
use toolglide_program::{Language, Poses, ProgramError};

fn try_read(text: &str, language: Language) -> Result<Vec<PoseMove>, ProgramError> {
    Poses::new(text.as_bytes(), FILE, settings(), language).collect()
}

fn locations(text: &str) -> Vec<PoseMove> {
    try_read(text, Language::CutterLocations).unwrap_or_else(|error| panic!("{text:?}: {error}"))
}

fn axis_words(text: &str) -> Vec<PoseMove> {
    try_read(text, Language::Ngc).unwrap_or_else(|error| panic!("{text:?}: {error}"))
}

/// Tip and orientation of a move.
fn pose(step: &PoseMove) -> (Vector<3>, Vector<3>) {
    match step.end() {
        PoseEnd::Pose(pose) => (pose.tip(), pose.orientation()),
        other => panic!("{other:?} is no pose"),
    }
}

/// Linear words, rotary words, and whether the former are those of the tip.
fn axes(step: &PoseMove) -> (Vector<3>, [f64; 3], bool) {
    match step.end() {
        PoseEnd::Axes {
            linear,
            rotary,
            tip,
            ..
        } => (*linear, *rotary, *tip),
        other => panic!("{other:?} is no axis words"),
    }
}

fn speed(step: &PoseMove) -> f64 {
    match step.feed() {
        PoseFeed::Speed(feedrate) => feedrate.speed(),
        PoseFeed::Rapid => f64::INFINITY,
        PoseFeed::Duration(duration) => panic!("{duration} s is no speed"),
    }
}

fn duration(step: &PoseMove) -> f64 {
    match step.feed() {
        PoseFeed::Duration(duration) => duration,
        other => panic!("{other:?} is no duration"),
    }
}

#[test]
fn a_cutter_location_file_gives_tips_orientations_and_feedrates() {
    let text = "PARTNO/BLADE\nUNITS/MM $$ metric\nMULTAX/ON\nLOADTL/3\nRAPID\nGOTO/0,0,50\n\
                FEDRAT/600,MMPM\nGOTO/1,2,3, 0,0.6,0.8\nGOTO/4,5,$\n6\nEND\nGOTO/9,9,9\n";
    let moves = locations(text);
    assert_eq!(moves.len(), 3, "END ends");
    assert!(speed(&moves[0]).is_infinite(), "rapid for one move");
    assert!((speed(&moves[1]) - 10.0).abs() < CLOSE, "600 mm/min");
    let (tip, orientation) = pose(&moves[1]);
    assert!(
        (tip - Vector::<3>::new(1.0, 2.0, 3.0)).norm() < CLOSE,
        "tip"
    );
    let tilted = Vector::<3>::new(0.0, 0.6, 0.8);
    assert!((orientation - tilted).norm() < CLOSE, "orientation");
    assert!((pose(&moves[2]).1 - tilted).norm() < CLOSE, "it stays");
    let lines: Vec<u32> = moves.iter().map(PoseMove::line).collect();
    assert_eq!(lines, [6, 8, 10], "lines");
}

#[test]
fn inches_scale_tips_and_feedrates() {
    let moves = locations("UNITS/INCHES\nFEDRAT/IPM,60\nGOTO/1,0,0\nGODLTA/0,1,0\n");
    assert!((speed(&moves[0]) - 25.4).abs() < CLOSE, "60 inch/min");
    let end = pose(&moves[1]).0;
    assert!(
        (end - Vector::<3>::new(25.4, 25.4, 0.0)).norm() < CLOSE,
        "{end}"
    );
}

#[test]
fn a_circle_is_chords_within_a_tenth_of_the_tolerance() {
    let text = "FEDRAT/60\nFROM/10,0,1\nCIRCLE/0,0,0, 0,0,1, 10\nGOTO/0,10,3\n";
    let moves = locations(text);
    assert!(moves.len() > 10, "{} chords", moves.len());
    let error = 0.1 * settings().tolerance.length();
    let mut last = Vector::<3>::new(10.0, 0.0, 1.0);
    for step in &moves {
        let (tip, _) = pose(step);
        assert!((tip[0].hypot(tip[1]) - 10.0).abs() < CLOSE, "{tip}");
        let middle = (tip + last) * 0.5;
        assert!(
            10.0 - middle[0].hypot(middle[1]) <= error * 1.001,
            "{middle}"
        );
        assert!(
            step.tolerance().length() < settings().tolerance.length(),
            "the rest"
        );
        last = tip;
    }
    assert!(
        (last - Vector::<3>::new(0.0, 10.0, 3.0)).norm() < CLOSE,
        "end"
    );
    let middle = pose(&moves[moves.len() / 2 - 1]).0;
    assert!(
        middle[0] > 0.0 && middle[1] > 0.0,
        "counter-clockwise: {middle}"
    );
}

#[test]
fn wrong_statements_are_refused_at_their_place() {
    for (text, expected) in [
        (
            "GOTO/1,2",
            "part.ngc:1:1: GOTO has 2 numbers, but needs 3 or 6",
        ),
        (
            "FEDRAT/9\nGOTO/1,x,2",
            "part.ngc:2:8: a number is missing here",
        ),
        (
            "GOTO/1,2,3",
            "part.ngc:1:1: feedrate was never set, but a feed move needs one",
        ),
        (
            "ZIGZAG/1",
            "part.ngc:1:1: statement ZIGZAG is not supported",
        ),
        (
            "UNITS/M",
            "part.ngc:1:1: UNITS is not followed by MM or INCHES",
        ),
        (
            "FEDRAT/0",
            "part.ngc:1:1: feedrate is 0, but must be positive",
        ),
        (
            "GOTO/1,$",
            "part.ngc:1:1: the statement goes on (\"$\"), but the file ends",
        ),
        (
            "CIRCLE/0,0,0,0,0,1,5\nFROM/1,2,3",
            "part.ngc:2:1: CIRCLE must be followed by the GOTO where the arc ends",
        ),
        (
            "FEDRAT/9\nFROM/5,0,0\nCIRCLE/0,0,0,0,0,1,5\nGOTO/0,6,0",
            "part.ngc:4:1: the end of the arc is 6 mm from its axis, but the radius is 5 mm; they \
             may differ by 0.028284271247461905 mm",
        ),
    ] {
        let shown = try_read(text, Language::CutterLocations)
            .unwrap_err()
            .to_string();
        assert_eq!(shown, expected, "{text:?}");
    }
}

#[test]
fn rotary_words_are_axes_in_rad_and_stay() {
    let moves = axis_words("G0 X1 A90 C-180\nG1 Y2 F600\n");
    let (linear, rotary, tip) = axes(&moves[1]);
    assert!(
        (linear - Vector::<3>::new(1.0, 2.0, 0.0)).norm() < CLOSE,
        "linear"
    );
    let expected = [std::f64::consts::FRAC_PI_2, 0.0, -std::f64::consts::PI];
    let close = rotary
        .iter()
        .zip(expected)
        .all(|(one, other)| (one - other).abs() < CLOSE);
    assert!(close, "{rotary:?}");
    assert!(!tip, "positions of the machine");
}

#[test]
fn inverse_time_is_a_duration_even_where_only_the_orientation_changes() {
    let moves = axis_words("G93\nG1 A10 F120\nG1 X5 A20 F30\nG0 A0\n");
    assert!((duration(&moves[0]) - 0.5).abs() < CLOSE, "turn");
    assert!((duration(&moves[1]) - 2.0).abs() < CLOSE, "both");
    assert!(speed(&moves[2]).is_infinite(), "rapid");
}

#[test]
fn a_feedrate_of_rotary_axes_alone_is_in_degrees_a_minute() {
    let moves = axis_words("G1 C90 F360\nG20\nG1 C0\n");
    assert!((duration(&moves[0]) - 15.0).abs() < CLOSE, "90 degrees");
    assert!(
        (duration(&moves[1]) - 15.0 * 25.4).abs() < 1e-6,
        "F was read in mm"
    );
}

#[test]
fn the_tool_tip_moves_once_a_code_says_so() {
    for (on, off) in [("G43.4 H1", "G49"), ("M428", "M429"), ("M128", "M129")] {
        let moves = axis_words(&format!("{on}\nG0 X1\n{off}\nG0 X2"));
        assert!(axes(&moves[0]).2, "{on}");
        assert!(!axes(&moves[1]).2, "{off}");
    }
}

#[test]
fn arcs_of_axis_words_are_chords_along_which_the_axes_turn() {
    let moves = axis_words("G0 X10\nG3 X-10 I-10 C90 F600\n");
    let half = &moves[1..];
    assert!(half.len() > 20, "{} chords", half.len());
    let share = std::f64::consts::FRAC_PI_2 / f64::from(u32::try_from(half.len()).unwrap());
    assert!((axes(&half[0]).1[2] - share).abs() < CLOSE, "even turn");
}
