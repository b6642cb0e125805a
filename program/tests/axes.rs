//! Programs of machines with axes beside X, Y and Z.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{FILE, assert_close, settings};
use toolglide_kinematics::{Feedrate, Move, Path, Vector};
use toolglide_program::{AXES_BESIDE, Language, Program, ProgramError};

/// The moves of a program on the axes with these letters.
fn try_moves<const N: usize>(
    text: &str,
    letters: [char; N],
    language: Language,
) -> Result<Vec<Move<N>>, ProgramError> {
    let has = AXES_BESIDE.map(|letter| letters.contains(&letter));
    Program::new(text.as_bytes(), FILE, settings())
        .in_language(language)
        .on_all_axes(has, [0.0; 6])
        .map(|next| next.map(|next| next.on_axes(&letters).unwrap()))
        .collect()
}

fn moves<const N: usize>(text: &str, letters: [char; N]) -> Vec<Move<N>> {
    match try_moves(text, letters, Language::Ngc) {
        Ok(moves) => moves,
        Err(refused) => panic!("{text:?}: {refused}"),
    }
}

/// Where each move ends, and how long it takes at its feedrate; 0 for a rapid.
fn ends<const N: usize>(moves: &[Move<N>]) -> (Vec<[f64; N]>, Vec<f64>) {
    let mut at = Vector::<N>::zeros();
    let mut times = Vec::new();
    let mut ends = Vec::new();
    for next in moves {
        let length = match next.path() {
            Path::Arc(arc) => arc.length(),
            _ => (next.end(at) - at).norm(),
        };
        let rapid = next.feedrate() == Feedrate::RAPID;
        times.push(if rapid {
            0.0
        } else {
            length / next.feedrate().speed()
        });
        at = next.end(at);
        ends.push(at.into());
    }
    (ends, times)
}

#[test]
fn a_rotary_axis_goes_along_and_the_feedrate_is_that_of_the_straight_ones() {
    let text = "G0 A-998.2889 X0\nG1 F1200 Z-4\nX20 A-958.2889\nA-257.9456\nG91 X3 A360\nG0 A1";
    let (ends, times) = ends(&moves(text, ['X', 'Y', 'Z', 'A']));
    let a: Vec<f64> = ends.iter().map(|end| end[3]).collect();
    assert_close(
        &a,
        &[
            -998.2889, -998.2889, -958.2889, -257.9456, 102.0544, 103.0544,
        ],
        "A",
    );
    assert_close(&[ends[4][0]], &[23.0], "X");
    // 4 mm and 20 mm at 20 mm/s, 700.3433 degrees at 20 degrees/s, 3 mm at 20 mm/s.
    assert_close(&times, &[0.0, 0.2, 1.0, 35.017_165, 0.15, 0.0], "times");
}

#[test]
fn inverse_time_is_the_time_of_all_axes_whatever_moves() {
    let text = "G93 G1 X3 A30 F2\nA90 F4\nX6 F60\nG94 F60 A100";
    let (_, times) = ends(&moves(text, ['X', 'Y', 'Z', 'A']));
    assert_close(&times, &[30.0, 15.0, 1.0, 10.0], "times");
}

#[test]
fn inches_are_lengths_and_degrees_stay() {
    let text = "G20\nG1 F60 X1 A90 U1\nA150\nU2";
    let (ends, times) = ends(&moves(text, ['X', 'Y', 'Z', 'A', 'U']));
    assert_close(&ends[1], &[25.4, 0.0, 0.0, 150.0, 25.4], "place");
    assert_close(
        &times,
        &[1.0, 60.0, 1.0],
        "60 in, 60 degrees, 60 in a minute",
    );
}

#[test]
fn both_ends_of_a_hot_wire_move() {
    let text = "G1 F600 X30 Y40 U30 V0\nU60 V40\nX0 Y0 U0 V0";
    let (ends, times) = ends(&moves(text, ['X', 'Y', 'U', 'V']));
    assert_close(&ends[1], &[30.0, 40.0, 60.0, 40.0], "place");
    assert_close(
        &times,
        &[5.0, 5.0, 5.0],
        "X and Y, else U and V, at 10 mm/s",
    );
}

#[test]
fn an_arc_stays_an_arc_while_a_rotary_axis_turns() {
    for (text, sweep) in [
        ("G3 X0 Y20 I0 J10 A90 F600", std::f64::consts::PI),
        ("G2 X0 Y0 I0 J10 P3 A90 F600", -6.0 * std::f64::consts::PI),
        ("G18 G2 X20 Z0 I10 A90 F600", std::f64::consts::PI),
        ("G19 G3 Y20 Z0 J10 A90 F600", std::f64::consts::PI),
    ] {
        let moves = moves(text, ['X', 'Y', 'Z', 'A']);
        let [one] = moves.as_slice() else {
            panic!("{text}: one move")
        };
        let Path::Arc(arc) = one.path() else {
            panic!("{text}: an arc")
        };
        assert_close(
            &[arc.sweep().abs(), arc.end()[3]],
            &[sweep.abs(), 90.0],
            text,
        );
        let (_, times) = ends(&moves);
        assert_close(&times, &[sweep.abs()], "10 mm of radius at 10 mm/s");
    }
}

#[test]
fn chords_of_a_turned_arc_share_the_turn() {
    let text = "G10 L2 P1 R30\nG18 G2 X20 Z0 I10 A90 F600";
    let moves = moves(text, ['X', 'Y', 'Z', 'A']);
    let (ends, _) = ends(&moves);
    assert!(ends.len() > 20, "chords");
    let middle = ends[ends.len() / 2][3];
    assert!((40.0..55.0).contains(&middle), "{middle} half way");
    assert_close(&[ends[ends.len() - 1][3]], &[90.0], "end");
}

#[test]
fn an_axis_that_is_not_there_and_words_where_they_cannot_be_are_refused() {
    for (text, expected) in [
        ("G0 B1", "1:4: axis B: "),
        ("G0 U1", "1:4: axis U: "),
        ("G43.4 H1", "1:1: "),
        ("G0 X1\nG5.1 X5 Y5 I1 J1 A3 F9", "2:"),
        ("G81 X1 Z-1 R1 A3 F9", "1:15: "),
        ("G41.1 D1 G1 F9 X5\nX9 A3", "2:4: "),
    ] {
        let refused = try_moves(text, ['X', 'Y', 'Z', 'A'], Language::Ngc);
        let refused = refused.unwrap_err().to_string();
        let place = expected
            .trim_end_matches("axis B: ")
            .trim_end_matches("axis U: ");
        assert!(
            refused.starts_with(&format!("{FILE}:{place}")),
            "{text:?}: {refused}"
        );
    }
}

#[test]
fn sinumerik_moves_them_too() {
    let text = "G1 F600 X=10 A=90\nU=20\n";
    let moves = try_moves(text, ['X', 'Y', 'Z', 'A', 'U'], Language::Sinumerik).unwrap();
    let (ends, _) = ends(&moves);
    assert_close(&ends[1], &[10.0, 0.0, 0.0, 90.0, 20.0], "place");
}
