//! Checks that lenient reading turns words that move no axis into warnings.

mod common;

use common::{FILE, lenient, refusal_with, settings, try_read};
use toolglide_kinematics::Vector;
use toolglide_program::{MAX_WARNINGS, Notice, Program, Reason};

#[test]
fn words_that_move_no_axis_become_warnings() {
    let text = "M107\nM104 S200\nG1 X5 F600\nG97 S1000 M3\nG96 D2500 S200\nG98\nM100 P1 Q2\n";
    let mut program = Program::new(text.as_bytes(), FILE, lenient());
    let moves: Vec<_> = program.by_ref().map(Result::unwrap).collect();
    assert_eq!(moves.len(), 1, "one move");
    assert_eq!(
        moves[0].end(Vector::zeros()),
        Vector::<3>::new(5.0, 0.0, 0.0),
        "its end"
    );
    let places: Vec<(u64, &str)> = program
        .warnings()
        .iter()
        .map(|warning| (warning.place().line(), warning.place().word()))
        .collect();
    let expected = [
        (1, "M107"),
        (2, "M104"),
        (5, "G96"),
        (5, "D2500"),
        (7, "M100"),
    ];
    assert_eq!(places, expected, "warnings");
    assert_eq!(
        program.warnings()[0].to_string(),
        "part.ngc:1:1: skipped: M107 is not supported: a function of another machine",
        "message"
    );
    for line in ["G96 D2500 S200", "M200", "G0 X1 D1"] {
        assert!(
            try_read(line, settings()).is_err(),
            "strict reading refuses {line:?}"
        );
        assert!(
            try_read(line, lenient()).is_ok(),
            "lenient reading does not"
        );
    }
}

#[test]
fn words_that_may_move_an_axis_stay_refused() {
    for line in [
        "G43.4 H1",
        "G76 Z-1 R1",
        "M97 P1000",
        "M428",
        "G0 A5",
        "G0 U1",
        "G95",
        "G0 X5 E2.5",
        "G33 Z1 K1",
        "G123",
    ] {
        assert!(try_read(line, lenient()).is_err(), "{line:?}");
    }
}

#[test]
fn axis_words_of_a_skipped_code_are_never_taken_for_a_motion() {
    let (line, column, word, reason) = refusal_with("G1 X1 F60\nM201 X1000 Y1000", lenient());
    assert_eq!((line, column, word.as_str()), (2, 1, "M201"), "place");
    assert!(matches!(reason, Reason::UnknownCode { .. }), "{reason:?}");
    assert!(
        try_read("F60 G2 I1\nM301 I2", lenient()).is_err(),
        "offsets"
    );
    assert_eq!(
        try_read("G0 X1 M106", lenient()).unwrap().len(),
        1,
        "its own motion"
    );
    let (.., reason) = refusal_with("G4 P1 M106", lenient());
    assert!(matches!(reason, Reason::Ambiguous { .. }), "{reason:?}");
}

#[test]
fn the_number_of_warnings_kept_is_bounded() {
    let text = "M107\n".repeat(MAX_WARNINGS + 7);
    let mut program = Program::new(text.as_bytes(), FILE, lenient());
    assert_eq!(program.by_ref().count(), 0, "moves");
    assert_eq!(program.warnings().len(), MAX_WARNINGS, "kept");
    assert_eq!(program.more_warnings(), 7, "counted");
    let all_skipped = program
        .warnings()
        .iter()
        .all(|warning| matches!(warning.notice(), Notice::Skipped(_)));
    assert!(all_skipped, "skipped");
}
