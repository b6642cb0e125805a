//! Splits one line of a program into words: a letter and a number, with their place.
//!
//! Source: RS274/NGC, sections on the format of a line. Where a number stands, a parameter or an
//! expression may stand too. Not here: what a word means, and lines with an O word.

use crate::error::Fault;
use crate::error::arithmetic::ArithmeticError;
use crate::error::reason::Reason;
use crate::expression::parameters::Values;
use crate::expression::{Evaluator, Parameter};
use crate::text::number::number;
use crate::text::place::Span;

/// A letter in upper case and the number after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Word {
    pub(crate) letter: u8,
    pub(crate) value: f64,
    pub(crate) span: Span,
}

/// A parameter that gets a value once its line is read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Assignment {
    pub(crate) parameter: Parameter,
    pub(crate) value: f64,
    pub(crate) span: Span,
}

/// Takes the words of a line one after the other.
pub(crate) struct Lexer<'a> {
    line: &'a [u8],
    at: usize,
    values: &'a dyn Values,
    assignments: &'a mut Vec<Assignment>,
    /// Whether a value was more than a number.
    pub(crate) computed: bool,
    /// Whether an E right behind a number is a word of its own, as printers write it.
    pub(crate) extrudes: bool,
}

impl<'a> Lexer<'a> {
    /// A lexer of `line`; what it assigns is appended to `assignments`.
    pub(crate) fn new(
        line: &'a [u8],
        values: &'a dyn Values,
        assignments: &'a mut Vec<Assignment>,
    ) -> Self {
        Self {
            line,
            at: 0,
            values,
            assignments,
            computed: false,
            extrudes: false,
        }
    }

    /// The next word, or none at the end of the line.
    pub(crate) fn word(&mut self) -> Result<Option<Word>, Fault> {
        loop {
            let Some(&byte) = self.line.get(self.at) else {
                return Ok(None);
            };
            match byte {
                b' ' | b'\t' => self.at += 1,
                b'A'..=b'Z' | b'a'..=b'z' | b'@' | b'^' | b'$' => {
                    return self.letter(byte).map(Some);
                }
                b'#' => self.assignment()?,
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
            return Err(self.syntax(start, "O words behind other words"));
        }
        let value = match number(self.line, self.at) {
            Ok((value, end)) => {
                self.at = end;
                let letter = char::from(letter);
                // Behind the number of a code a word may follow without a blank.
                if !matches!(letter, 'G' | 'M' | 'N' | 'T') {
                    self.refuse_exponent(start, letter)?;
                }
                if !value.is_finite() {
                    let span = Span::new(start, end);
                    return Err(Fault::new(span, Reason::NumberOutOfRange { letter }));
                }
                value
            }
            Err(at) => self.value(char::from(letter), start, at)?,
        };
        Ok(Word {
            letter,
            value,
            span: Span::new(start, self.at),
        })
    }

    /// Refuses a number that goes on as `e-12` does, which RS274/NGC would read as a word E.
    fn refuse_exponent(&self, start: usize, letter: char) -> Result<(), Fault> {
        let rest = self.line.get(self.at..).unwrap_or_default();
        if self.extrudes || !matches!(rest.first(), Some(b'e' | b'E')) {
            return Ok(());
        }
        let signed = usize::from(matches!(rest.get(1), Some(b'+' | b'-')));
        let digits = rest[1 + signed..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        if digits == 0 {
            return Ok(());
        }
        let end = self.at + 1 + signed + digits;
        Err(Fault::new(
            Span::new(start, end),
            Reason::Exponent { letter },
        ))
    }

    /// What stands in place of a number; `met` is where the search for digits ended.
    fn value(&mut self, letter: char, start: usize, met: usize) -> Result<f64, Fault> {
        let mut evaluator = Evaluator::new(self.line, self.at, self.values);
        match self.line.get(met) {
            Some(b'#' | b'[') => {}
            Some(&byte) if is_control(byte) => return Err(control(met, byte)),
            _ if evaluator.function_stands(met) => {}
            _ => {
                let span = Span::new(start, start + 1);
                return Err(Fault::new(span, Reason::NumberMissing { letter }));
            }
        }
        let value = evaluator.value()?;
        self.at = evaluator.at;
        self.computed = true;
        Ok(value)
    }

    /// A parameter with the value that it gets.
    fn assignment(&mut self) -> Result<(), Fault> {
        let start = self.at;
        let mut evaluator = Evaluator::new(self.line, start, self.values);
        let parameter = evaluator.parameter()?;
        evaluator.skip_blanks();
        if evaluator.peek() != Some(b'=') {
            let span = Span::new(start, evaluator.at);
            return Err(Fault::new(span, ArithmeticError::NotAssigned.into()));
        }
        evaluator.at += 1;
        let value = evaluator.value()?;
        self.at = evaluator.at;
        self.refuse_exponent(start, '#')?;
        self.assignments.push(Assignment {
            parameter,
            value,
            span: Span::new(start, self.at),
        });
        Ok(())
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
    use crate::expression::parameters::Parameters;

    fn words(line: &str) -> Result<Vec<(char, f64)>, Fault> {
        let mut assignments = Vec::new();
        let mut parameters = Parameters::new();
        parameters.put(5, 2.5);
        let mut lexer = Lexer::new(line.as_bytes(), &parameters, &mut assignments);
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
    fn values_stand_where_numbers_stand() {
        let expected = vec![('X', 2.5), ('Y', -2.5), ('Z', 3.0), ('I', 2.0), ('J', -1.0)];
        let line = "X#5 Y-#5 Z[1 + 2] Isqrt[4] j-abs[-1]";
        assert_eq!(words(line), Ok(expected), "values");
        assert_eq!(words("#1 = 2 X1"), Ok(vec![('X', 1.0)]), "assignment");
        let (start, end, reason) = fault("G1 #1 2");
        assert_eq!((start, end), (3, 7), "no sign of equality");
        let expected = Reason::Arithmetic(ArithmeticError::NotAssigned);
        assert_eq!(reason, expected, "no sign of equality");
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
