//! Axes beside X, Y and Z: shifts, origins, homes and feedrates of A B C and U V W.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{FILE, assert_close, settings};
use toolglide_kinematics::{PoseEnd, PoseFeed, PoseMove};
use toolglide_program::{Language, Poses, ProgramError};

fn try_read(text: &str) -> Result<Vec<PoseMove>, ProgramError> {
    Poses::new(text.as_bytes(), FILE, settings(), Language::Ngc).collect()
}

fn read(text: &str) -> Vec<PoseMove> {
    try_read(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn turns(text: &str, axis: usize) -> Vec<f64> {
    read(text)
        .iter()
        .map(|step| match step.end() {
            PoseEnd::Axes { rotary, .. } => rotary[axis].to_degrees(),
            other => panic!("{other:?}"),
        })
        .collect()
}

fn slides(text: &str, axis: usize) -> Vec<f64> {
    read(text)
        .iter()
        .map(|step| step.secondary()[axis])
        .collect()
}

fn duration(step: &PoseMove) -> f64 {
    match step.feed() {
        PoseFeed::Duration(duration) => duration,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_shift_of_a_rotary_axis_counts_until_it_ends() {
    let text = "G0 A90\nG92 A0\nG0 A10\nG92.2\nG0 A5\nG92.3\nG0 A0\nG92.1\nG0 A1\nG52 A30\nG0 A1\n";
    assert_close(&turns(text, 0), &[90.0, 100.0, 5.0, 90.0, 1.0, 31.0], "A");
    let text = "G0 C720\nG92 C0\nG1 C#<_c> X1 F100\nG91 C5\nG90 G53 G0 C7\nX#5212 Y#5216 Z#5425\n";
    assert_close(&turns(text, 2), &[720.0, 720.0, 725.0, 7.0, 7.0], "C");
    let moves = read(text);
    let PoseEnd::Axes { linear, .. } = moves[4].end() else {
        panic!("{moves:?}")
    };
    let told = [0.0, 720.0, 7.0 - 720.0];
    assert_close(&<[f64; 3]>::from(*linear), &told, "parameters");
}

#[test]
fn a_coordinate_system_has_origins_for_every_axis() {
    let text = "G10 L2 P1 A10 U1\nG0 A0 U0\nG10 L2 P2 A20\nG55 A0\nG10 L20 P2 A5\nA0\nG54 A0 U0\n";
    assert_close(&turns(text, 0), &[10.0, 20.0, 15.0, 10.0], "A");
    assert_close(&slides(text, 0), &[1.0, 1.0, 1.0, 1.0], "U");
    let text = "G0\n#5225=7\nG55\nG54 B0\n";
    assert_close(&turns(text, 1), &[7.0], "by parameter");
}

#[test]
fn rotary_axes_go_home_with_the_others_or_by_their_name() {
    let text = "G0 X5 A30\nG28.1\nG0 X0 A90 C45\nG28 A90\nG0 A90\nG28\n";
    let moves = read(text);
    assert_close(&turns(text, 0), &[30.0, 90.0, 30.0, 90.0, 30.0], "A");
    assert_close(&turns(text, 2), &[0.0, 45.0, 45.0, 45.0, 0.0], "C");
    let x = |step: &PoseMove| match step.end() {
        PoseEnd::Axes { linear, .. } => linear[0],
        other => panic!("{other:?}"),
    };
    let ends: Vec<f64> = moves.iter().map(x).collect();
    assert_close(&ends, &[5.0, 0.0, 0.0, 0.0, 5.0], "X stays");
    assert_close(&turns("G0 A30\nG91 G28 A0\n", 0), &[30.0, 0.0], "G91");
    assert!(try_read("G0 A30\nG28 A77\n").is_err(), "by way of A77");
}

#[test]
fn straight_axes_of_a_second_set_are_lengths() {
    let text = "G0 X1 Y2 U3 V4\nG20 G1 U1 F60\nG91 V-1\nG21 G90 G1 X5 U0 W0 F600\n";
    assert_close(&slides(text, 0), &[3.0, 25.4, 25.4, 0.0], "U");
    assert_close(&slides(text, 1), &[4.0, 4.0, -21.4, -21.4], "V");
    let moves = read("G0 U0 V0\nG1 U3 V4 F600\nG93 G1 U0 F2\n");
    assert_close(&[duration(&moves[1])], &[0.5], "5 mm at 10 mm/s");
    assert_close(&[duration(&moves[2])], &[30.0], "inverse time");
    let shifted = "G0 U5\nG92 U0\nG0 U1 X#<_u>\n";
    assert_close(&slides(shifted, 0), &[5.0, 6.0], "shift");
}

#[test]
fn words_that_nothing_would_obey_are_refused() {
    for text in [
        "G0 Z5\nG81 X1 Z-1 R1 A30 F100",
        "G43.1 A5",
        "G43.2 C5",
        "G10 L1 P1 A5",
        "F60 G5.1 X2 I1 U3",
        "F60 G41.1 D1\nG1 X5\nU5",
    ] {
        assert!(try_read(text).is_err(), "{text}");
    }
}
