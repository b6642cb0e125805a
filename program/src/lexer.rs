//! One line of a program into words: a letter and a number, with their place.
//!
//! Source: RS274/NGC, sections on the format of a line. Parameters and expressions would stand
//! where a number stands; they are refused by name. Not here: what a word means.

use crate::error::Fault;
use crate::place::Span;
use crate::reason::Reason;

/// Whole numbers up to this are floats exactly.
const EXACT_MANTISSA: u64 = 1 << 53;

/// Powers of ten that are floats exactly; the quotient of two exact floats is rounded once, so a
/// short number is read without the general algorithm and to the same bit.
const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Digits that a mantissa of 64 bits holds whatever they are.
const SAFE_DIGITS: u32 = 19;

/// A letter in upper case and the number after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Word {
    pub(crate) letter: u8,
    pub(crate) value: f64,
    pub(crate) span: Span,
}

/// Takes the words of a line one after the other.
#[derive(Debug)]
pub(crate) struct Lexer<'line> {
    line: &'line [u8],
    at: usize,
}

impl<'line> Lexer<'line> {
    pub(crate) fn new(line: &'line [u8]) -> Self {
        Self { line, at: 0 }
    }

    /// The next word, or none at the end of the line.
    pub(crate) fn word(&mut self) -> Result<Option<Word>, Fault> {
        loop {
            let Some(&byte) = self.line.get(self.at) else {
                return Ok(None);
            };
            match byte {
                b' ' | b'\t' => self.at += 1,
                b'A'..=b'Z' | b'a'..=b'z' => return self.letter(byte).map(Some),
                b'(' => self.comment()?,
                b';' => {
                    check_text(self.line, self.at)?;
                    self.at = self.line.len();
                }
                _ => return Err(self.stray(byte)),
            }
        }
    }

    fn letter(&mut self, byte: u8) -> Result<Word, Fault> {
        let start = self.at;
        self.at += 1;
        let letter = byte.to_ascii_uppercase();
        if letter == b'O' {
            return Err(self.syntax(start, "O words (subroutines and loops)"));
        }
        let value = self.number(char::from(letter), start)?;
        Ok(Word {
            letter,
            value,
            span: Span::new(start, self.at),
        })
    }

    /// A decimal number, blanks inside it allowed; `start` is where its letter stands.
    fn number(&mut self, letter: char, start: usize) -> Result<f64, Fault> {
        let mut mantissa = 0_u64;
        let mut digits = 0_u32;
        let mut decimals = 0_usize;
        let mut point = false;
        let mut negative = false;
        let mut sign_allowed = true;
        let mut end = self.at;
        let first = self.at;
        while let Some(&byte) = self.line.get(self.at) {
            match byte {
                b'0'..=b'9' => {
                    if digits < SAFE_DIGITS {
                        mantissa = mantissa * 10 + u64::from(byte - b'0');
                    }
                    digits += 1;
                    decimals += usize::from(point);
                    sign_allowed = false;
                }
                b'.' if !point => {
                    point = true;
                    sign_allowed = false;
                }
                b'+' | b'-' if sign_allowed => {
                    negative = byte == b'-';
                    sign_allowed = false;
                }
                b' ' | b'\t' => {
                    self.at += 1;
                    continue;
                }
                _ => break,
            }
            self.at += 1;
            end = self.at;
        }
        if digits == 0 {
            return Err(self.no_number(letter, start));
        }
        self.at = end;
        let magnitude = match EXACT_POWERS.get(decimals) {
            // Below 2^53 both conversions and the division are correctly rounded.
            Some(power) if digits <= SAFE_DIGITS && mantissa <= EXACT_MANTISSA => {
                mantissa as f64 / power
            }
            _ => long_number(&self.line[first..end]),
        };
        if !magnitude.is_finite() {
            let span = Span::new(start, end);
            return Err(Fault::new(span, Reason::NumberOutOfRange { letter }));
        }
        Ok(if negative { -magnitude } else { magnitude })
    }

    fn no_number(&mut self, letter: char, start: usize) -> Fault {
        match self.line.get(self.at) {
            Some(b'#') => self.syntax(self.at, "parameters"),
            Some(b'[') => self.syntax(self.at, "expressions"),
            Some(&byte) if is_control(byte) => control(self.at, byte),
            _ => Fault::new(
                Span::new(start, start + 1),
                Reason::NumberMissing { letter },
            ),
        }
    }

    /// Skips a comment in brackets.
    fn comment(&mut self) -> Result<(), Fault> {
        let start = self.at;
        for (offset, &byte) in self.line[start + 1..].iter().enumerate() {
            let here = start + 1 + offset;
            match byte {
                b')' => {
                    self.at = here + 1;
                    return Ok(());
                }
                b'(' => {
                    return Err(Fault::new(Span::new(here, here + 1), Reason::CommentNested));
                }
                _ if is_control(byte) => return Err(control(here, byte)),
                _ => {}
            }
        }
        Err(Fault::new(
            Span::new(start, start + 1),
            Reason::CommentNotClosed,
        ))
    }

    /// Something that begins no word.
    fn stray(&self, byte: u8) -> Fault {
        let start = self.at;
        let one = Span::new(start, start + 1);
        match byte {
            b'#' => self.syntax(start, "parameters"),
            b'[' | b']' => self.syntax(start, "expressions"),
            b'@' | b'^' => self.syntax(start, "polar coordinates"),
            b'$' => self.syntax(start, "spindle numbers"),
            b'%' => Fault::new(one, Reason::PercentNotAlone),
            b')' => Fault::new(one, Reason::CommentNotOpened),
            b'0'..=b'9' | b'+' | b'-' | b'.' => {
                let end = self.line[start..]
                    .iter()
                    .position(|&byte| !matches!(byte, b'0'..=b'9' | b'+' | b'-' | b'.'))
                    .map_or(self.line.len(), |length| start + length);
                Fault::new(Span::new(start, end), Reason::LetterMissing)
            }
            _ if is_control(byte) => control(start, byte),
            _ => {
                let text = String::from_utf8_lossy(&self.line[start..]);
                let character = text.chars().next().unwrap_or(char::REPLACEMENT_CHARACTER);
                let length = match std::str::from_utf8(&self.line[start..]) {
                    Ok(_) => character.len_utf8(),
                    Err(error) if error.valid_up_to() > 0 => character.len_utf8(),
                    Err(_) => 1,
                };
                Fault::new(
                    Span::new(start, start + length),
                    Reason::BadCharacter { character },
                )
            }
        }
    }

    /// Refuses a part of the language that begins at `start`, up to the next blank.
    fn syntax(&self, start: usize, what: &'static str) -> Fault {
        let end = self.line[start..]
            .iter()
            .position(|byte| matches!(byte, b' ' | b'\t'))
            .map_or(self.line.len(), |length| start + length);
        Fault::new(Span::new(start, end), Reason::SyntaxNotSupported { what })
    }
}

/// A number with more digits than the short way takes.
fn long_number(text: &[u8]) -> f64 {
    let digits: String = text
        .iter()
        .filter(|byte| matches!(byte, b'0'..=b'9' | b'.'))
        .map(|&byte| char::from(byte))
        .collect();
    // Digits and one point are always a number, so that the other branch is never taken.
    digits.parse().unwrap_or(f64::INFINITY)
}

/// Whether a byte stands in no text; a tab does.
fn is_control(byte: u8) -> bool {
    byte < b' ' && byte != b'\t' || byte == 0x7f
}

fn control(at: usize, byte: u8) -> Fault {
    Fault::new(Span::new(at, at + 1), Reason::ControlByte { byte })
}

/// Refuses control bytes from `start` on, for parts of a line that are not read otherwise.
pub(crate) fn check_text(line: &[u8], start: usize) -> Result<(), Fault> {
    match line[start..].iter().position(|&byte| is_control(byte)) {
        Some(offset) => Err(control(start + offset, line[start + offset])),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Result<Vec<(char, f64)>, Fault> {
        let mut lexer = Lexer::new(line.as_bytes());
        let mut found = Vec::new();
        while let Some(word) = lexer.word()? {
            found.push((char::from(word.letter), word.value));
        }
        Ok(found)
    }

    fn fault(line: &str) -> (u32, u32, Reason) {
        let fault = words(line).unwrap_err();
        (fault.span.start, fault.span.end, fault.reason)
    }

    #[test]
    fn blanks_may_stand_anywhere_even_in_numbers() {
        let expected = vec![('G', 1.0), ('X', 10.0), ('Y', -0.25)];
        assert_eq!(words("G 1 X1 0 y\t- .2 5  "), Ok(expected), "blanks");
    }

    #[test]
    fn numbers_may_lack_digits_on_one_side_of_the_point() {
        let expected = vec![('X', 0.5), ('Y', -3.0), ('Z', 1.0), ('I', 7.0)];
        assert_eq!(words("X+.5Y-3.Z1.I007"), Ok(expected), "numbers");
    }

    #[test]
    fn every_number_is_the_nearest_float() {
        for text in [
            "0.1",
            "2.2490",
            "123456789.987654321",
            "9007199254740993",
            "0.00000000000000000000001",
            "0.999999500000042",
            "18446744073709551616",
            "99999999999999999999.9",
            "4.35",
        ] {
            let expected: f64 = text.parse().unwrap();
            let found = words(&format!("X{text}")).unwrap()[0].1;
            assert_eq!(found.to_bits(), expected.to_bits(), "{text}");
        }
    }

    #[test]
    fn comments_are_skipped_wherever_they_stand() {
        let expected = vec![('G', 1.0), ('X', 2.0)];
        assert_eq!(
            words("(a;b) G1 (MSG, hello) X2 ; rest ( of line"),
            Ok(expected),
            "comments"
        );
        assert_eq!(words("(only; a comment)"), Ok(vec![]), "nothing else");
    }

    #[test]
    fn what_begins_no_word_is_refused_at_its_place() {
        assert_eq!(
            fault("G1 !"),
            (3, 4, Reason::BadCharacter { character: '!' }),
            "bang"
        );
        assert_eq!(
            fault("G1 µ"),
            (3, 5, Reason::BadCharacter { character: 'µ' }),
            "micro"
        );
        assert_eq!(fault("(c) -7 G1"), (4, 6, Reason::LetterMissing), "number");
        assert_eq!(
            words("G1 7"),
            Ok(vec![('G', 17.0)]),
            "a blank does not end a number"
        );
    }

    #[test]
    fn comments_that_are_not_pairs_are_refused() {
        assert_eq!(fault("G1 (abc"), (3, 4, Reason::CommentNotClosed), "open");
        assert_eq!(fault("G1 (a(b)"), (5, 6, Reason::CommentNested), "nested");
        assert_eq!(
            fault("G1 abc)").2,
            Reason::NumberMissing { letter: 'A' },
            "word first"
        );
        assert_eq!(fault("G1 )"), (3, 4, Reason::CommentNotOpened), "closed");
    }

    #[test]
    fn the_parts_of_the_language_not_read_are_named() {
        let refused = |what| Reason::SyntaxNotSupported { what };
        assert_eq!(
            fault("G0 Z#<safe>"),
            (4, 11, refused("parameters")),
            "value"
        );
        assert_eq!(fault("#1=2"), (0, 4, refused("parameters")), "assignment");
        assert_eq!(
            fault("X[1+2]"),
            (1, 6, refused("expressions")),
            "expression"
        );
        assert_eq!(
            fault("g91 g1 @-.1 ^4"),
            (7, 11, refused("polar coordinates")),
            "polar"
        );
        let subroutine = refused("O words (subroutines and loops)");
        assert_eq!(fault("o100 sub"), (0, 4, subroutine), "subroutine");
    }

    #[test]
    fn control_bytes_are_refused_even_in_comments() {
        for (line, at) in [
            ("G1\0", 2),
            ("(a\u{1}b)", 2),
            ("; a\u{7f}", 3),
            ("X\u{1}", 1),
        ] {
            let byte = line.as_bytes()[at as usize];
            assert_eq!(
                fault(line),
                (at, at + 1, Reason::ControlByte { byte }),
                "{line:?}"
            );
        }
    }

    #[test]
    fn numbers_that_are_none_are_refused() {
        let missing = |letter| Reason::NumberMissing { letter };
        assert_eq!(fault("G1 X Y1"), (3, 4, missing('X')), "no digits");
        assert_eq!(fault("X-."), (0, 1, missing('X')), "sign and point");
        assert_eq!(fault("X--1").2, missing('X'), "two signs");
        assert_eq!(fault("X1.2.3"), (4, 6, Reason::LetterMissing), "two points");
        let huge = format!("X{}", "9".repeat(400));
        assert_eq!(
            fault(&huge),
            (0, 401, Reason::NumberOutOfRange { letter: 'X' }),
            "huge"
        );
    }
}
