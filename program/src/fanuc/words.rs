//! Reads the words of a block: a letter and a value, with a comma before it or not.
//!
//! Source: the operator's manuals of FANUC and Haas. A number without a decimal point is in whole units
//! (calculator-type input). A word whose value is null is left out. Not here: what a word means.

use crate::error::Fault;
use crate::error::reason::Reason;
use crate::fanuc::labels::blanks;
use crate::fanuc::value::{Evaluator, Variables};
use crate::interpreter::units::Units;
use crate::text::number::number;
use crate::text::place::Span;

/// A word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Word {
    /// In upper case.
    pub(crate) letter: u8,
    /// Whether a comma stands before it.
    pub(crate) comma: bool,
    pub(crate) value: f64,
    /// Whether it is a number with a decimal point.
    pub(crate) point: bool,
    pub(crate) span: Span,
}

/// The words of a line from `at` on.
pub(crate) fn words(
    line: &[u8],
    mut at: usize,
    variables: &dyn Variables,
    units: Units,
    into: &mut Vec<Word>,
) -> Result<bool, Fault> {
    let mut computed = false;
    loop {
        at = blanks(line, at);
        let Some(&byte) = line.get(at) else {
            return Ok(computed);
        };
        match byte {
            // The rest of the block is left out.
            b'/' => return Ok(computed),
            b';' => {
                nothing_behind(line, at)?;
                return Ok(computed);
            }
            b'(' => at = comment(line, at)?,
            b'A'..=b'Z' | b'a'..=b'z' | b',' => {
                let (word, end, is_computed) = word(line, at, variables, units)?;
                computed |= is_computed;
                if !word.value.is_nan() {
                    into.push(word);
                }
                at = end;
            }
            _ => return Err(stray(line, at)),
        }
    }
}

/// The word that begins at `start`, where it ends, and whether its value is computed.
fn word(
    line: &[u8],
    start: usize,
    variables: &dyn Variables,
    units: Units,
) -> Result<(Word, usize, bool), Fault> {
    let comma = line.get(start) == Some(&b',');
    let at = if comma {
        blanks(line, start + 1)
    } else {
        start
    };
    let letter = match line.get(at) {
        Some(byte) if byte.is_ascii_alphabetic() => byte.to_ascii_uppercase(),
        _ => return Err(stray(line, start)),
    };
    let (value, end, computed) = match number(line, at + 1) {
        Ok((value, end)) => (value, end, false),
        Err(met) => {
            let mut evaluator =
                Evaluator::new(line, at + 1, variables).rounding_to(increment(letter, units));
            evaluator.at = met;
            let begins = matches!(evaluator.peek(), Some(b'#' | b'['));
            if !begins && !evaluator.function_follows() {
                let span = Span::new(start, word_end(line, start));
                let word = line.get(at..span.end as usize).unwrap_or_default();
                let reason = if word.len() > 1 {
                    let word = String::from_utf8_lossy(word).into();
                    Reason::UnknownWord { word }
                } else {
                    let letter = char::from(letter);
                    Reason::NumberMissing { letter }
                };
                return Err(Fault::new(span, reason));
            }
            evaluator.at = at + 1;
            let value = evaluator.value()?;
            (value, evaluator.at, true)
        }
    };
    let span = Span::new(start, end);
    if value.is_infinite() {
        let letter = char::from(letter);
        return Err(Fault::new(span, Reason::NumberOutOfRange { letter }));
    }
    let written = line.get(at..end).unwrap_or_default();
    if !computed && exponent_follows(line, end) {
        let end = word_end(line, end + 2).max(end + 3);
        let word = String::from_utf8_lossy(line.get(at..end).unwrap_or(written)).into();
        let what = "exponents, which programs have not";
        let reason = Reason::WordNotSupported { word, what };
        return Err(Fault::new(Span::new(start, end), reason));
    }
    let word = Word {
        letter,
        comma,
        value,
        point: !computed && written.contains(&b'.'),
        span,
    };
    Ok((word, end, computed))
}

/// Whether `E`, a sign and a digit follow a number at once.
fn exponent_follows(line: &[u8], end: usize) -> bool {
    let rest = line.get(end..).unwrap_or_default();
    let digit = rest.get(2).is_some_and(u8::is_ascii_digit);
    digit && matches!(rest, [b'E' | b'e', b'+' | b'-', ..])
}

/// What `ROUND` in a word rounds to: the least input increment.
fn increment(letter: u8, units: Units) -> f64 {
    match (letter, units) {
        (b'A'..=b'C', _) | (b'F' | b'I'..=b'K' | b'Q' | b'R' | b'U'..=b'Z', Units::Millimeter) => {
            0.001
        }
        (b'F' | b'I'..=b'K' | b'Q' | b'R' | b'U'..=b'Z', Units::Inch) => 0.0001,
        _ => 1.0,
    }
}

/// Where a comment that begins at `start` ends.
pub(crate) fn comment(line: &[u8], start: usize) -> Result<usize, Fault> {
    let inside = line.get(start + 1..).unwrap_or_default();
    match inside.iter().position(|byte| matches!(byte, b'(' | b')')) {
        Some(length) if inside[length] == b')' => Ok(start + length + 2),
        Some(length) => {
            let at = start + 1 + length;
            Err(Fault::new(Span::new(at, at + 1), Reason::CommentNested))
        }
        None => Err(Fault::new(
            Span::new(start, start + 1),
            Reason::CommentNotClosed,
        )),
    }
}

/// Refuses words behind the end of a block; a remark may stand there.
pub(crate) fn nothing_behind(line: &[u8], semicolon: usize) -> Result<(), Fault> {
    let start = blanks(line, semicolon + 1);
    let rest = line.get(start..).unwrap_or_default();
    let moves = matches!(rest.first(), Some(byte) if b"GMXYZgmxyzNn".contains(byte));
    let number = rest
        .get(1)
        .is_some_and(|byte| b"0123456789+-.#[".contains(byte));
    if moves && number {
        let what = "words behind the end of a block";
        let span = Span::new(start, word_end(line, start));
        return Err(Fault::new(span, Reason::SyntaxNotSupported { what }));
    }
    Ok(())
}

/// Refuses what begins no word.
pub(crate) fn stray(line: &[u8], start: usize) -> Fault {
    let text = String::from_utf8_lossy(line.get(start..).unwrap_or_default());
    let character = text.chars().next().unwrap_or(char::REPLACEMENT_CHARACTER);
    let one = Span::new(start, start + 1);
    match line.get(start) {
        Some(b'%') => Fault::new(one, Reason::PercentNotAlone),
        Some(b')') => Fault::new(one, Reason::CommentNotOpened),
        Some(b'0'..=b'9' | b'+' | b'-' | b'.') => {
            let span = Span::new(start, word_end(line, start));
            Fault::new(span, Reason::LetterMissing)
        }
        Some(&byte) if byte < b' ' => Fault::new(one, Reason::ControlByte { byte }),
        _ => {
            let span = Span::new(start, start + character.len_utf8());
            Fault::new(span, Reason::BadCharacter { character })
        }
    }
}

/// Where letters, digits and signs from `start` on end.
fn word_end(line: &[u8], start: usize) -> usize {
    let rest = line.get(start + 1..).unwrap_or_default();
    let length = rest
        .iter()
        .position(|byte| !(byte.is_ascii_alphanumeric() || b"+-.".contains(byte)));
    start + 1 + length.unwrap_or(rest.len())
}
