//! Refusals of text that makes no words: characters, comments, lines, files.

#[macro_use]
mod common;

use common::{refusal, settings};
use toolglide_program::{LONGEST_LINE, Program, Reason};

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
