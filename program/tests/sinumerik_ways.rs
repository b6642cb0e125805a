//! Sinumerik: `AC( )`, `IC( )`, `DC( )`, `ACP( )` and `ACN( )` on every word that takes them.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{FILE, assert_close, settings};
use toolglide_kinematics::{Arc, Path, PoseEnd, PoseMove};
use toolglide_program::{Language, Poses, Program, ProgramError};

fn program(text: &str) -> Program<&[u8]> {
    Program::new(text.as_bytes(), FILE, settings()).in_language(Language::Sinumerik)
}

fn arc(text: &str) -> Arc<3> {
    let moves: Result<Vec<_>, _> = program(text).collect();
    let moves = moves.unwrap_or_else(|error| panic!("{text}: {error}"));
    match moves.last().unwrap().path() {
        Path::Arc(arc) => *arc,
        other => panic!("{text}: {other:?}"),
    }
}

fn try_poses(text: &str) -> Result<Vec<PoseMove>, ProgramError> {
    Poses::new(text.as_bytes(), FILE, settings(), Language::Sinumerik).collect()
}

/// Where A, B and C are behind each move, degrees.
fn turns(text: &str) -> Vec<[f64; 3]> {
    let moves = try_poses(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    moves
        .iter()
        .map(|step| match step.end() {
            PoseEnd::Axes { rotary, .. } => rotary.map(f64::to_degrees),
            other => panic!("{other:?}"),
        })
        .collect()
}

fn assert_axis(text: &str, axis: usize, expected: &[f64]) {
    let found: Vec<f64> = turns(text).iter().map(|turn| turn[axis]).collect();
    assert_close(&found, expected, text);
}

#[test]
fn centres_are_places_or_steps_by_their_words() {
    let full = arc("G17 G90 G71 G94\nG0 X20 Y0 Z0\nG2 X20 Y0 I=AC(30) J=AC(0) F500\n");
    assert_close(
        &[full.center()[0], full.center()[1]],
        &[30.0, 0.0],
        "centre",
    );
    assert_close(&[full.radii().0], &[10.0], "radius");
    for (text, center) in [
        ("G3 X0 Y10 I=AC(0) J=AC(0) F500", [0.0, 0.0, 0.0]),
        ("G3 X0 Y10 I=IC(-10) J=AC(0) F500", [0.0, 0.0, 0.0]),
        ("G3 X0 Y10 I-10 J=AC(2-2) F500", [0.0, 0.0, 0.0]),
        ("G18 G2 X=IC(5) Z5 I=AC(15) K=IC(0) F500", [15.0, 0.0, 0.0]),
        ("G91 G3 X-10 Y10 I=AC(0) J0 F500", [0.0, 0.0, 0.0]),
        ("G700 G3 X=IC(-10/25.4) Y10/25.4 F60 I=AC(0)", [0.0; 3]),
    ] {
        let text = text.replace("Y10/25.4", "Y=10/25.4");
        let found = arc(&format!("G0 X10 Y0\n{text}\n"));
        let found: [f64; 3] = found.center().into();
        assert_close(&found, &center, &text);
    }
}

#[test]
fn a_centre_in_another_system_is_a_place_of_that_system() {
    let text = "G0 X10 Y0\nTRANS X5\nG3 X-5 Y10 I=AC(-5) J=AC(0) F500\n";
    let center = arc(text).center();
    assert_close(&[center[0], center[1]], &[0.0, 0.0], "frame");
}

#[test]
fn rotary_axes_go_the_way_that_their_words_say() {
    let text = "G17 G90 G71 G94\nG0 X0 Y0 Z0 A0 C0\nG0 C=DC(350)\nG0 C=ACP(10)\nG0 C=ACN(350)\n";
    assert_axis(text, 2, &[0.0, -10.0, 10.0, -10.0]);
    let text = "G0 A30\nA=DC(30)\nA=ACP(30)\nA=ACN(30)\nA=DC(210)\nA=DC(20)\nA=ACP(0)\nA=ACN(0)\n";
    let expected = [30.0, 30.0, 30.0, 30.0, 210.0, 380.0, 720.0, 720.0];
    assert_axis(text, 0, &expected);
    assert_axis(
        "G0 B100\nB=IC(-30)\nG91 B=AC(5)\nB=DC(355)\n",
        1,
        &[100.0, 70.0, 5.0, -5.0],
    );
    assert_axis(
        "G91 G1 C=DC(90) F100\nC=IC(10) X5\nC = ACP ( 45 * 2 )\n",
        2,
        &[90.0, 100.0, 450.0],
    );
}

#[test]
fn polar_words_take_places_and_steps() {
    let text = "G0 X10 Y0\nG1 RP=IC(5) AP=90 F600\nAP=IC(-90)\nG91 RP=AC(20) AP=AC(180)\n";
    let moves: Vec<_> = program(text).map(Result::unwrap).collect();
    let mut at = toolglide_kinematics::Vector::zeros();
    let mut found = Vec::new();
    for step in &moves {
        at = step.end(at);
        found.extend([at[0], at[1]]);
    }
    assert_close(
        &found,
        &[10.0, 0.0, 0.0, 15.0, 15.0, 0.0, -20.0, 0.0],
        "ends",
    );
}

#[test]
fn steps_are_from_where_the_tool_is_in_the_system_of_the_block() {
    let text = "G0 X10 Y0\nG1 X=IC(5) F100\nTRANS X3\nX=IC(5)\nG91 X=AC(0)\nG153 G0 X=AC(1)\n";
    let refused = program(text).find_map(Result::err);
    assert!(refused.is_some(), "G153 with G91 stays refused");
    let text = "G0 X10 Y0\nG1 X=IC(5) F100\nTRANS X3\nX=IC(5)\nX=AC(0)\nSUPA G0 X=IC(2)\n";
    let mut at = toolglide_kinematics::Vector::zeros();
    let mut found = Vec::new();
    for step in program(text) {
        at = step.unwrap().end(at);
        found.push(at[0]);
    }
    assert_close(&found, &[10.0, 15.0, 20.0, 3.0, 5.0], "X");
}

#[test]
fn words_that_cannot_carry_a_way_are_refused() {
    for text in [
        "G1 X10 F=AC(100)",
        "G0 X=DC(10)",
        "G0 Z=ACP(10)",
        "G2 X1 CR=AC(5)",
        "R1=AC(5)",
        "S=IC(5)",
        "T=AC(1)",
        "TRANS X=AC(5)",
        "G2 X1 I=DC(5)",
        "G4 F=IC(1)",
        "G0 C=DC(400)",
        "G0 C=ACN(-10)",
        "G=AC(1) X5",
        "M=IC(3)",
        "G0 X=AC 5",
        "G0 X=AC(5",
    ] {
        let refused = try_poses(text);
        assert!(refused.is_err(), "{text}: {refused:?}");
    }
    assert!(try_poses("SPOS=DC(90)\nG0 X1").is_ok(), "the spindle turns");
}

#[test]
fn exponents_are_those_of_sinumerik() {
    let text = "G0 X2.5EX1 Y=1EX-1*20 Z-.5EX+2\n";
    let moves: Vec<_> = program(text).map(Result::unwrap).collect();
    let end = moves[0].end(toolglide_kinematics::Vector::zeros());
    assert_close(&<[f64; 3]>::from(end), &[25.0, 2.0, -50.0], "end");
    for text in [
        "G0 X2.35e-12",
        "G0 X1 2",
        "G0 X=1 2",
        "G91.1 G0 X1",
        "G0 A3=0.5",
    ] {
        assert!(try_poses(text).is_err(), "{text}");
    }
    let refused = try_poses("G90 G1 X2.35e-12 F100").unwrap_err();
    assert_eq!(
        (refused.column(), refused.word()),
        (8, "X2.35e-12"),
        "place"
    );
}

#[test]
fn codes_of_others_do_nothing_here() {
    let text = "M128\nM60\nG0 X1\n";
    let moves = try_poses(text).unwrap();
    assert_eq!(moves.len(), 1, "no rest");
    let PoseEnd::Axes { tip, .. } = moves[0].end() else {
        panic!("{moves:?}")
    };
    assert!(!tip, "no tool tip");
}
