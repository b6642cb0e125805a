//! Refusals of words that are not known, or not where they stand.

#[macro_use]
mod common;

use common::{refusal, refusal_with, settings};
use toolglide_program::{Program, Reason};

#[test]
fn codes_that_are_not_read_are_named() {
    for code in [
        "G6.1", "G7", "G12", "G15", "G17.1", "G33", "G38.2", "G43.4", "G65", "G68", "G76", "G95",
        "G96", "M47", "M97", "M428",
    ] {
        let text = format!("G21 (m)\nN5 {code} X1");
        refuses!(&text, 2, 4, code, Reason::NotSupported { .. });
    }
    let (.., reason) = refusal("G95 G1 X1");
    assert_eq!(
        reason.to_string(),
        "G95 is not supported: feed for each turn of the spindle",
        "message"
    );
}

#[test]
fn codes_that_nobody_knows_are_refused() {
    for code in ["G100", "G14", "G64.5", "M12", "M206", "M999"] {
        refuses!(
            &format!("G0 X1 {code}"),
            1,
            7,
            code,
            Reason::UnknownCode { .. }
        );
    }
    refuses!("G1.25", 1, 1, "G1.25", Reason::NotACode { letter: 'G', .. });
    refuses!("G-1", 1, 1, "G-1", Reason::NotACode { .. });
    refuses!("G1000", 1, 1, "G1000", Reason::NotACode { .. });
    refuses!("M3.5", 1, 1, "M3.5", Reason::NotACode { letter: 'M', .. });
}

#[test]
fn axes_that_nobody_moves_are_refused() {
    for letter in ["D", "H", "L"] {
        let word = format!("{letter}1.5");
        refuses!(
            &format!("G0 X1 {word}"),
            1,
            7,
            &word,
            Reason::NotSupported { .. }
        );
    }
    for letter in ["A", "B", "C", "U", "V", "W"] {
        let word = format!("{letter}1.5");
        refuses!(
            &format!("G0 X1 {word}"),
            1,
            7,
            &word,
            Reason::NoSuchAxis { .. }
        );
    }
    let named = Program::new("G0 X1 V2".as_bytes(), "a", settings()).for_machine("gantry");
    let refused = named.last().unwrap().unwrap_err().to_string();
    assert_eq!(refused, "a:1:7: machine \"gantry\" has no axis V", "name");
    let mut flat = settings();
    flat.axes = [true, false, true];
    let (line, column, word, reason) = refusal_with("G0 X1\nY2", flat);
    assert_eq!((line, column, word.as_str()), (2, 1, "Y2"), "place");
    let missing = |reason: &Reason| matches!(reason, Reason::NoSuchAxis { letter: 'Y', .. });
    assert!(missing(&reason), "{reason}");
    let (_, column, _, reason) = refusal_with("F60 G2 X1 I.5", flat);
    assert!(column == 5 && missing(&reason), "plane: {reason}");
}

#[test]
fn words_stand_once_in_a_block() {
    refuses!("G0 X1 X2", 1, 7, "X2", Reason::Repeated { letter: 'X' });
    refuses!("F1 F1", 1, 4, "F1", Reason::Repeated { letter: 'F' });
    refuses!("N1 N2", 1, 4, "N2", Reason::Repeated { letter: 'N' });
}

#[test]
fn codes_of_one_group_exclude_each_other() {
    for (first, second) in [
        ("G0", "G1"),
        ("G1", "G1"),
        ("G17", "G18"),
        ("G20", "G21"),
        ("G90", "G91"),
        ("G90.1", "G91.1"),
        ("G93", "G94"),
        ("G61", "G64"),
        ("G4", "G4"),
        ("M0", "M30"),
        ("M3", "M5"),
        ("M7", "M9"),
        ("M8", "M9"),
        ("M9", "M8"),
        ("M48", "M49"),
        ("M6", "M6"),
    ] {
        let text = format!("{first} {second}");
        let column = u32::try_from(first.len()).unwrap() + 2;
        refuses!(&text, 1, column, second, Reason::SameGroup { .. });
    }
    let (.., reason) = refusal("G0 G1 X1");
    let expected = "G0 and G1 are both of the group \"motion\", of which a block may have one";
    assert_eq!(reason.to_string(), expected, "message");
}

#[test]
fn words_without_a_use_are_refused() {
    refuses!("G4 P1 X2", 1, 7, "X2", Reason::Unused { letter: 'X' });
    refuses!(
        "G0 X1\nG4 P1 Y2",
        2,
        7,
        "Y2",
        Reason::Unused { letter: 'Y' }
    );
    refuses!("G80 Z1", 1, 5, "Z1", Reason::Unused { letter: 'Z' });
    refuses!("G0 X1 I2", 1, 7, "I2", Reason::Unused { letter: 'I' });
    refuses!("G0 X1 R2", 1, 7, "R2", Reason::Unused { letter: 'R' });
    refuses!("G0 X1 P2", 1, 7, "P2", Reason::Unused { letter: 'P' });
    refuses!("G61 P2", 1, 5, "P2", Reason::Unused { letter: 'P' });
    refuses!("G0 X1 Q2", 1, 7, "Q2", Reason::Unused { letter: 'Q' });
    refuses!("K1", 1, 1, "K1", Reason::Unused { letter: 'K' });
    refuses!(
        "G64 P1 G4",
        1,
        5,
        "P1",
        Reason::Ambiguous { letter: 'P', .. }
    );
    refuses!("F9 G4 P1 G2 I1", 1, 7, "P1", Reason::Ambiguous { .. });
}

#[test]
fn words_of_spindle_and_overrides_have_their_uses() {
    for text in [
        "M19 R90 P1",
        "M50 P1",
        "M51 P0",
        "M52 P1",
        "M53 P1",
        "G10 L0",
    ] {
        assert_eq!(common::read(text), [], "{text:?}");
    }
}

#[test]
fn half_of_a_pair_of_words_is_refused() {
    for (text, column, word) in [
        ("F9 G5 X2 I1 P1 Q1", 4, "G5"),
        ("G43.2", 1, "G43.2"),
        ("G43.2 H1 Z1", 1, "G43.2"),
        ("G91 G0 @5 ^30", 8, "@5"),
    ] {
        let (_, found, met, reason) = refusal(text);
        assert_eq!((found, met.as_str()), (column, word), "{text:?}: {reason}");
    }
}

#[test]
fn axis_words_need_a_motion_mode() {
    refuses!("X1", 1, 1, "X1", Reason::NoMotionMode { letter: 'X' });
    refuses!(
        "G0 X1\nG80\nG90 Y1",
        3,
        5,
        "Y1",
        Reason::NoMotionMode { letter: 'Y' }
    );
}

#[test]
fn a_dwell_needs_its_time() {
    refuses!(
        "G0 X1\n(c) G4",
        2,
        5,
        "G4",
        Reason::WordMissing { letter: 'P', .. }
    );
}

#[test]
fn statements_of_macros_are_refused_as_what_they_are() {
    for (line, column) in [
        ("WHILE [#1 LT 2] DO1", 1),
        ("N10 IF [#1 EQ 2] GOTO 20", 5),
        ("GOTO 10", 1),
        ("END1", 1),
    ] {
        let (_, found, _, reason) = refusal(line);
        assert_eq!(found, column, "{line}");
        assert!(
            reason.to_string().contains("--dialect fanuc"),
            "{line}: {reason}"
        );
    }
}
