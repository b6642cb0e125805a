//! Every refusal, with its line, its column and its word.

mod common;

use common::{refusal, refusal_with, settings};
use toolglide_kinematics::{ToolpathError, Vector};
use toolglide_program::{FARTHEST, LONGEST_LINE, Program, Reason};

/// Asserts place, word and reason of the refusal of a program.
macro_rules! refuses {
    ($text:expr, $line:expr, $column:expr, $word:expr, $reason:pat) => {
        let (line, column, word, reason) = refusal($text);
        let expected: &str = $word.as_ref();
        let place = (line, column, word.as_str());
        assert_eq!(place, ($line, $column, expected), "{:?}: {reason}", $text);
        assert!(matches!(reason, $reason), "{:?}: {reason:?}", $text);
    };
}

#[test]
fn codes_that_are_not_read_are_named() {
    for code in [
        "G6.1", "G7", "G15", "G17.1", "G33", "G38.2", "G43.4", "G76", "G95", "G96", "M47", "M97",
        "M428",
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
    for code in ["G100", "G12", "G64.5", "M12", "M206", "M999"] {
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
fn broken_words_are_refused() {
    refuses!("G0 X Y1", 1, 4, "X", Reason::NumberMissing { letter: 'X' });
    refuses!("G0 X--1", 1, 4, "X", Reason::NumberMissing { .. });
    refuses!("(c) 12", 1, 5, "12", Reason::LetterMissing);
    refuses!("G0 X1.2.3", 1, 8, ".3", Reason::LetterMissing);
    refuses!(
        "G0 X1 ~",
        1,
        7,
        "~",
        Reason::BadCharacter { character: '~' }
    );
    refuses!(
        "(µ) G0 ä",
        1,
        8,
        "ä",
        Reason::BadCharacter { character: 'ä' }
    );
    refuses!(
        "G0 X1 /Y2",
        1,
        7,
        "/",
        Reason::BadCharacter { character: '/' }
    );
    refuses!("N1 G1 X1*57", 1, 9, "*", Reason::BadCharacter { .. });
    let huge = format!("G0 X{}", "9".repeat(320));
    let (line, column, _, reason) = refusal(&huge);
    let expected = Reason::NumberOutOfRange { letter: 'X' };
    assert_eq!((line, column, reason), (1, 4, expected), "huge");
}

#[test]
fn broken_comments_are_refused() {
    refuses!("G0 X1 (to", 1, 7, "(", Reason::CommentNotClosed);
    refuses!("G0 (a (b))", 1, 7, "(", Reason::CommentNested);
    refuses!("G0 X1)", 1, 6, ")", Reason::CommentNotOpened);
}

#[test]
fn a_percent_sign_stands_alone() {
    refuses!("%\n% end", 2, 1, "%", Reason::PercentNotAlone);
    refuses!("G0 X1 %", 1, 7, "%", Reason::PercentNotAlone);
}

#[test]
fn binary_files_are_refused() {
    refuses!(
        "G0 X1\n\u{7f}ELF",
        2,
        1,
        "\u{7f}",
        Reason::ControlByte { byte: 0x7f }
    );
    refuses!("G0\0", 1, 3, "\0", Reason::ControlByte { byte: 0 });
    refuses!(
        "(a\u{1b}b)",
        1,
        3,
        "\u{1b}",
        Reason::ControlByte { byte: 0x1b }
    );
    refuses!("; \u{2}", 1, 3, "\u{2}", Reason::ControlByte { byte: 2 });
    refuses!("/ \u{2}", 1, 3, "\u{2}", Reason::ControlByte { byte: 2 });
    refuses!("G0\rX1", 1, 3, "\r", Reason::ControlByte { byte: 0x0d });
    let wide = b"\xff\xfeG\x000\x00";
    let error = Program::new(&wide[..], "a", settings())
        .next()
        .unwrap()
        .unwrap_err();
    assert_eq!((error.line(), error.column()), (1, 1), "UTF-16: {error}");
}

#[test]
fn long_lines_are_refused_and_end_the_reading() {
    let text = format!("G0 X1\n{}\nX2", " ".repeat(LONGEST_LINE + 1));
    let column = u32::try_from(LONGEST_LINE).unwrap() + 1;
    refuses!(
        &text,
        2,
        column,
        "",
        Reason::LineTooLong {
            bound: LONGEST_LINE
        }
    );
    let mut program = Program::new(text.as_bytes(), "a", settings());
    assert!(program.next().unwrap().is_ok(), "the move before");
    assert!(program.next().unwrap().is_err(), "the line");
    assert!(program.next().is_none(), "nothing after");
}

#[test]
fn a_file_that_cannot_be_read_is_refused_with_its_line() {
    struct Failing(bool);
    impl std::io::Read for Failing {
        fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
            if std::mem::replace(&mut self.0, true) {
                return Err(std::io::Error::other("cable pulled"));
            }
            into[..6].copy_from_slice(b"G0 X1\n");
            Ok(6)
        }
    }
    let reader = std::io::BufReader::new(Failing(false));
    let mut program = Program::new(reader, "a", settings());
    assert!(program.next().unwrap().is_ok(), "first line");
    let error = program.next().unwrap().unwrap_err();
    assert_eq!(
        error.to_string(),
        "a:2:1: cannot be read: cable pulled",
        "message"
    );
    assert!(program.next().is_none(), "fused");
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
fn feed_moves_need_a_feedrate() {
    refuses!("G1 X1", 1, 1, "G1", Reason::NoFeedrate);
    refuses!("G1\nX1", 2, 1, "X1", Reason::NoFeedrate);
    refuses!("G2 I1", 1, 1, "G2", Reason::NoFeedrate);
    refuses!(
        "G1 F0 X1",
        1,
        4,
        "F0",
        Reason::NotPositive {
            quantity: "feedrate",
            ..
        }
    );
    refuses!("F0\nG1 X1", 2, 1, "G1", Reason::NotPositive { .. });
    refuses!(
        "G1 X1 F-5",
        1,
        7,
        "F-5",
        Reason::Negative {
            quantity: "feedrate",
            ..
        }
    );
    refuses!("G93 G1 X1 F60\nX2", 2, 1, "X2", Reason::NoInverseTime);
    refuses!("F60 G93 G1 X1\nG94 X2", 2, 5, "X2", Reason::NoFeedrate);
    refuses!("F60\nG93\nG1 X2", 3, 1, "G1", Reason::NoInverseTime);
    refuses!("G93 G1 X1 F0", 1, 11, "F0", Reason::NotPositive { .. });
    let tiny = format!("G1 X1 F.{}1", "0".repeat(322));
    let (_, column, _, reason) = refusal(&tiny);
    assert_eq!(column, 7, "tiny");
    assert!(matches!(reason, Reason::NotPositive { .. }), "{reason:?}");
    let vast = format!("G20\nG1 X1 F1{}", "0".repeat(308));
    let (_, column, _, reason) = refusal(&vast);
    assert_eq!(column, 7, "vast");
    assert!(matches!(reason, Reason::Feedrate { .. }), "{reason:?}");
    let none = format!("G1 X1 F0.{}1", "0".repeat(299));
    let (_, column, _, reason) = refusal(&none);
    assert_eq!(column, 7, "next to nothing");
    assert!(matches!(reason, Reason::Feedrate { .. }), "{reason:?}");
}

#[test]
fn numbers_out_of_their_bounds_are_refused() {
    refuses!(
        "G4 P-1",
        1,
        4,
        "P-1",
        Reason::Negative {
            quantity: "dwell",
            ..
        }
    );
    refuses!("G4 P1000001", 1, 4, "P1000001", Reason::DwellTooLong { .. });
    refuses!(
        "S-5",
        1,
        1,
        "S-5",
        Reason::Negative {
            quantity: "spindle speed",
            ..
        }
    );
    refuses!(
        "T1.5",
        1,
        1,
        "T1.5",
        Reason::NotWhole {
            quantity: "tool number",
            ..
        }
    );
    refuses!("T-1", 1, 1, "T-1", Reason::NotWhole { .. });
    refuses!("N-1", 1, 1, "N-1", Reason::Negative { .. });
    refuses!(
        "G64 P0",
        1,
        5,
        "P0",
        Reason::NotPositive {
            quantity: "tolerance",
            ..
        }
    );
    refuses!("G64 P-1", 1, 5, "P-1", Reason::Negative { .. });
    refuses!("G64 Q-1", 1, 5, "Q-1", Reason::Negative { .. });
    refuses!(
        "G0 X1000000000.5",
        1,
        4,
        "X1000000000.5",
        Reason::TooFar {
            bound: FARTHEST,
            ..
        }
    );
    refuses!(
        "G20 G0 X-40000000",
        1,
        8,
        "X-40000000",
        Reason::TooFar { letter: 'X', .. }
    );
    refuses!("G91 G0 X6h8", 1, 10, "h8", Reason::NotSupported { .. });
    refuses!(
        "G91 G0 X600000000\nX600000000",
        2,
        1,
        "X600000000",
        Reason::TooFar { .. }
    );
    refuses!(
        "F9 G2 X1 R2000000000",
        1,
        10,
        "R2000000000",
        Reason::TooFar { letter: 'R', .. }
    );
    refuses!(
        "F9 G2 X1 J2000000000",
        1,
        10,
        "J2000000000",
        Reason::TooFar { letter: 'J', .. }
    );
}

#[test]
fn impossible_arcs_are_refused() {
    refuses!(
        "F9\nG2 X1",
        2,
        1,
        "G2",
        Reason::ArcCenterMissing { offsets: "I or J" }
    );
    refuses!(
        "F9 G18\nG3 X1 Z1",
        2,
        1,
        "G3",
        Reason::ArcCenterMissing { offsets: "I or K" }
    );
    refuses!("F9 G2 I1\nY5", 2, 1, "Y5", Reason::ArcCenterMissing { .. });
    refuses!("F9 G2", 1, 4, "G2", Reason::ArcCenterMissing { .. });
    refuses!(
        "F9 G2 X1 I1 R1",
        1,
        10,
        "I1",
        Reason::ArcCenterAndRadius { letter: 'I' }
    );
    refuses!(
        "F9 G2 X1 I1 K1",
        1,
        13,
        "K1",
        Reason::OffsetOutsidePlane { letter: 'K', .. }
    );
    refuses!(
        "F9 G18 G2 X1 J1",
        1,
        14,
        "J1",
        Reason::OffsetOutsidePlane { letter: 'J', .. }
    );
    refuses!(
        "F9 G19 G2 Y1 I1",
        1,
        14,
        "I1",
        Reason::OffsetOutsidePlane { letter: 'I', .. }
    );
    refuses!(
        "F9 G90.1 G2 X1 I1",
        1,
        16,
        "I1",
        Reason::ArcCenterIncomplete { .. }
    );
    refuses!(
        "F9 G2 X10 R4.99",
        1,
        11,
        "R4.99",
        Reason::ArcRadiusTooShort { .. }
    );
    refuses!(
        "F9 G2 X.001 R0",
        1,
        13,
        "R0",
        Reason::ArcRadiusTooShort { .. }
    );
    refuses!("F9 G2 X0 R5", 1, 10, "R5", Reason::ArcRadiusClosed { .. });
    refuses!("F9 G2 R5", 1, 7, "R5", Reason::ArcRadiusClosed { .. });
    refuses!(
        "F9 G2 I1 P0",
        1,
        10,
        "P0",
        Reason::NotWhole {
            quantity: "number of turns",
            ..
        }
    );
    refuses!("F9 G2 I1 P1.5", 1, 10, "P1.5", Reason::NotWhole { .. });
    refuses!(
        "F9 G2 I1 P1000001",
        1,
        10,
        "P1000001",
        Reason::NotWhole {
            most: 1_000_000,
            ..
        }
    );
    let mismatch = "F9 G2 X10 Y0 I4 J0";
    refuses!(
        mismatch,
        1,
        14,
        "I4",
        Reason::Path(ToolpathError::ArcMismatch { .. })
    );
    refuses!(
        "F9 G2 X1 J0",
        1,
        10,
        "J0",
        Reason::Path(ToolpathError::ArcRadius { .. })
    );
}

#[test]
fn a_start_that_is_no_point_is_refused_at_the_first_move() {
    let mut nowhere = settings();
    nowhere.start = Vector::<3>::new(0.0, f64::NAN, 0.0);
    let (line, _, _, reason) = refusal_with("\nG0 X1", nowhere);
    assert_eq!(
        (line, reason),
        (2, Reason::Path(ToolpathError::NotFinite)),
        "reason"
    );
}

#[test]
fn after_a_refusal_nothing_more_is_read() {
    let mut program = Program::new(&b"G0 X1\nG4 P1 G1 X2\nX3"[..], "a", settings());
    assert!(program.next().unwrap().is_ok(), "before");
    assert!(
        program.next().unwrap().is_err(),
        "no part of a refused block is a move"
    );
    assert!(
        program.next().is_none() && program.next().is_none(),
        "after"
    );
    assert_eq!(program.lines(), 2, "lines");
}

#[test]
fn messages_tell_place_quantity_value_and_bound() {
    let shown = |text: &str| {
        let (line, column, _, reason) = refusal(text);
        format!("{line}:{column}: {reason}")
    };
    assert_eq!(
        shown("\n G1 X1 F-20"),
        "2:8: feedrate is -20, but must not be negative",
        "F"
    );
    assert_eq!(shown("G4"), "1:1: G4 needs a P word", "G4");
    assert_eq!(
        shown("F9\nG2 X10 R4"),
        "2:8: arc radius is 4 mm, but half the distance from start to end is 5 mm; it may be short \
         by 0.005 mm",
        "R"
    );
    assert_eq!(
        shown("T2.5"),
        "1:1: tool number is 2.5, but must be a whole number from 0 to 999999",
        "T"
    );
}

/// Lines of refusals, and whether each may follow from one before it.
fn all_refusals(text: &str) -> Vec<(u64, bool)> {
    Program::new(text.as_bytes(), "a", settings())
        .past_refusals()
        .filter_map(Result::err)
        .map(|refused| (refused.line(), refused.is_consequence()))
        .collect()
}

#[test]
fn what_follows_from_a_refusal_is_told_apart() {
    for (text, expected) in [
        ("G1 X1\nX2\nX3\n", &[(1, false), (2, true), (3, true)][..]),
        (
            "G1 F100 X1 ~\nX2\nG1 X3\nF9 X4\n",
            &[(1, false), (2, true), (3, true)],
        ),
        (
            "F60\n#<a>=[1+\nG1 X#<a>\nX#<b>\n",
            &[(2, false), (3, true), (4, false)],
        ),
        (
            "F60 G1 X10 U1\nG2 X5 Y5 R1\nG2 X0 Y50 R1\n",
            &[(1, false), (2, true), (3, false)],
        ),
        (
            "o1 if [1+]\nG0 X1\no1 endif\no2 endif\n",
            &[(1, false), (3, true), (4, false)],
        ),
    ] {
        assert_eq!(all_refusals(text), expected, "{text:?}");
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
