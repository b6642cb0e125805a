//! Splits a Sinumerik line into words: names, addresses, brackets.
//!
//! Not here: what they mean, see `sinumerik`, and expressions, see `sinumerik_value`.

use crate::block::codes::Way;
use crate::error::Fault;
use crate::error::arithmetic::ArithmeticError;
use crate::error::reason::Reason;
use crate::interpreter::Interpreter;
use crate::text::number::number;
use crate::text::place::Span;

/// Largest number of an R parameter that an expression may give.
const LARGEST_R: u32 = 99_999;

/// Reads a line from left to right.
pub(crate) struct Reader<'a> {
    line: &'a [u8],
    pub(crate) at: usize,
    /// Brackets and signs that are open.
    pub(crate) depth: u32,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(line: &'a [u8]) -> Self {
        Self {
            line,
            at: 0,
            depth: 0,
        }
    }

    /// Where the next word begins; none at a remark or the end of the line.
    pub(crate) fn next_item(&mut self) -> Result<Option<usize>, Fault> {
        self.skip_blanks();
        match self.peek() {
            None | Some(b';') => {
                crate::text::lexer::check_text(self.line, self.at)?;
                Ok(None)
            }
            Some(_) => Ok(Some(self.at)),
        }
    }

    /// The name that begins here, in upper case: one letter before a number or `=`, else all letters,
    /// digits and `_`.
    pub(crate) fn name(&mut self) -> String {
        let rest = self.rest();
        let letters = length(rest, |byte| {
            byte.is_ascii_alphabetic() || b"_$".contains(&byte)
        });
        let whole = length(rest, |byte| {
            byte.is_ascii_alphanumeric() || b"_$".contains(&byte)
        });
        let length = if letters == 1 && rest[0].is_ascii_alphabetic() {
            1
        } else if letters == 0 {
            0
        } else {
            whole
        };
        let name = String::from_utf8_lossy(&rest[..length]).to_ascii_uppercase();
        self.at += length;
        name
    }

    /// The name behind blanks.
    pub(crate) fn next_name(&mut self) -> String {
        self.skip_blanks();
        let rest = self.rest();
        let whole = length(rest, |byte| {
            byte.is_ascii_alphanumeric() || b"_$".contains(&byte)
        });
        let name = String::from_utf8_lossy(&rest[..whole]).to_ascii_uppercase();
        self.at += whole;
        name
    }

    /// Whether a number or `=` follows.
    pub(crate) fn address_follows(&mut self) -> bool {
        self.skip_blanks();
        matches!(
            self.peek(),
            Some(b'0'..=b'9' | b'+' | b'-' | b'.' | b'=' | b'[')
        )
    }

    /// Takes `=` if it follows.
    pub(crate) fn equals_follows(&mut self) -> bool {
        self.skip_blanks();
        let follows = self.peek() == Some(b'=');
        self.at += usize::from(follows);
        follows
    }

    /// Takes `,` if it follows.
    pub(crate) fn comma_follows(&mut self) -> bool {
        self.skip_blanks();
        let follows = self.peek() == Some(b',');
        self.at += usize::from(follows);
        follows
    }

    /// The number between a letter and `=`, as in `R12=` and `R[2]=`.
    pub(crate) fn extension(&mut self, state: &Interpreter) -> Result<Option<u32>, Fault> {
        let start = self.at;
        let number = self.parameter_number(state)?;
        if number.is_some() && self.equals_follows() {
            return Ok(number);
        }
        self.at = start;
        Ok(None)
    }

    /// Whether a digit and `=` stand here, as in `A3=`; they are read then.
    pub(crate) fn extension_is(&mut self, digit: u8) -> bool {
        let start = self.at;
        if self.peek() == Some(b'0' + digit) {
            self.at += 1;
            if self.equals_follows() {
                return true;
            }
        }
        self.at = start;
        false
    }

    /// A text in quotes behind `=`.
    pub(crate) fn quoted_after_equals(&mut self) -> Option<String> {
        let rest = &self.line[self.at..];
        let blank = |byte| matches!(byte, b' ' | b'\t');
        let before = length(rest, blank);
        let rest = rest.get(before..)?.strip_prefix(b"=")?;
        let between = length(rest, blank);
        let text = rest.get(between..)?.strip_prefix(b"\"")?;
        let end = text.iter().position(|&byte| byte == b'"')?;
        self.at += before + 1 + between + 1 + end + 1;
        Some(String::from_utf8_lossy(&text[..end]).into_owned())
    }

    /// The value of an address: a number, or an expression behind `=`; `AC( )`, `IC( )`, `DC( )`, `ACP( )` and
    /// `ACN( )` say whether it is a place or a step, and which way a rotary axis goes there.
    pub(crate) fn address_value(
        &mut self,
        state: &Interpreter,
        start: usize,
    ) -> Result<(f64, Option<Way>), Fault> {
        self.skip_blanks();
        if self.peek() == Some(b'=') {
            self.at += 1;
            return self.way_value(state);
        }
        match self.plain_number() {
            Some(value) if value.is_finite() => {
                self.refuse_exponent(start)?;
                Ok((value, None))
            }
            _ => {
                let letter = self.line.get(start).map_or('?', |&byte| char::from(byte));
                let span = Span::new(start, start + 1);
                Err(Fault::new(span, Reason::NumberMissing { letter }))
            }
        }
    }

    /// Refuses a number that goes on as `e-12` does: exponents are written with `EX`.
    fn refuse_exponent(&self, start: usize) -> Result<(), Fault> {
        let [b'e' | b'E', rest @ ..] = self.rest() else {
            return Ok(());
        };
        let signed = length(rest, |byte| matches!(byte, b'+' | b'-')).min(1);
        let digits = length(&rest[signed..], |byte| byte.is_ascii_digit());
        if digits == 0 {
            return Ok(());
        }
        let letter = self.line.get(start).map_or('?', |&byte| char::from(byte));
        let span = Span::new(start, self.at + 1 + signed + digits);
        let letter = letter.to_ascii_uppercase();
        Err(Fault::new(span, Reason::Exponent { letter }))
    }

    /// An expression, or one within a way.
    pub(crate) fn way_value(&mut self, state: &Interpreter) -> Result<(f64, Option<Way>), Fault> {
        self.skip_blanks();
        let here = self.at;
        let way = match self.next_name().as_str() {
            "AC" => Some(Way::Absolute),
            "IC" => Some(Way::Incremental),
            "DC" => Some(Way::Shortest),
            "ACP" => Some(Way::Positive),
            "ACN" => Some(Way::Negative),
            _ => None,
        };
        self.skip_blanks();
        let way = way.filter(|_| self.peek() == Some(b'('));
        let Some(way) = way else {
            self.at = here;
            return Ok((self.expression(state)?, None));
        };
        let start = self.at;
        self.at += 1;
        let value = self.expression(state)?;
        self.close(start)?;
        Ok((value, Some(way)))
    }

    /// Values in round brackets, separated by commas; empty places are 0.
    pub(crate) fn arguments(&mut self, state: &Interpreter) -> Result<Vec<f64>, Fault> {
        let mut list = Vec::new();
        self.skip_blanks();
        if self.peek() != Some(b'(') {
            return Ok(list);
        }
        self.at += 1;
        loop {
            self.skip_blanks();
            match self.peek() {
                Some(b')') => {
                    self.at += 1;
                    return Ok(list);
                }
                Some(b',') => self.at += 1,
                _ => list.push(self.expression(state)?),
            }
        }
    }

    /// Passes over the rest of the line.
    pub(crate) fn skip_line(&mut self) {
        self.at = self.line.len();
    }

    /// Passes over a text in round brackets, if one follows.
    pub(crate) fn skip_brackets(&mut self) {
        self.skip_blanks();
        if self.peek() == Some(b'(') {
            let rest = &self.line[self.at..];
            let end = rest.iter().rposition(|&byte| byte == b')');
            self.at += end.map_or(rest.len(), |end| end + 1);
        }
    }

    /// A refusal of what begins no word.
    pub(crate) fn stray(&self, start: usize) -> Fault {
        let text = String::from_utf8_lossy(&self.line[start.min(self.line.len())..]);
        let character = text.chars().next().unwrap_or(char::REPLACEMENT_CHARACTER);
        let span = Span::new(start, start + character.len_utf8());
        match self.line.get(start) {
            Some(&byte) if byte < b' ' => Fault::new(span, Reason::ControlByte { byte }),
            _ => Fault::new(span, Reason::BadCharacter { character }),
        }
    }

    pub(crate) fn skip_blanks(&mut self) {
        while let Some(b' ' | b'\t') = self.peek() {
            self.at += 1;
        }
    }

    pub(crate) fn peek(&self) -> Option<u8> {
        self.line.get(self.at).copied()
    }

    /// What is still to be read.
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.line.get(self.at..).unwrap_or_default()
    }

    /// Takes a number, if one stands here.
    pub(crate) fn plain_number(&mut self) -> Option<f64> {
        // Blanks end a number here, and `EX` begins its exponent.
        let blanks = length(self.rest(), |byte| matches!(byte, b' ' | b'\t'));
        let from = self.at + blanks;
        let digits = length(&self.line[from..], |byte| !matches!(byte, b' ' | b'\t'));
        let word = &self.line[..from + digits];
        let (value, end) = number(word, from).ok()?;
        self.at = end;
        let exponent = self.rest().strip_prefix(b"EX");
        let Some(exponent) = exponent.or_else(|| self.rest().strip_prefix(b"ex")) else {
            return Some(value);
        };
        let signed = length(exponent, |byte| matches!(byte, b'+' | b'-')).min(1);
        let digits = length(&exponent[signed..], |byte| byte.is_ascii_digit());
        if digits == 0 {
            return Some(value);
        }
        let power = std::str::from_utf8(&exponent[..signed + digits]).ok()?;
        self.at += 2 + signed + digits;
        // As one number, so that it is rounded once.
        let mantissa = std::str::from_utf8(&self.line[from..end]).ok()?;
        format!("{mantissa}e{power}").parse().ok().or(Some(value))
    }

    /// Takes a name behind blanks if it is the one wanted.
    pub(crate) fn takes(&mut self, wanted: &str) -> bool {
        let start = self.at;
        let found = self.next_name() == wanted;
        if !found {
            self.at = start;
        }
        found
    }

    /// The number of an R parameter: digits, or an expression in square brackets.
    pub(crate) fn parameter_number(&mut self, state: &Interpreter) -> Result<Option<u32>, Fault> {
        let start = self.at;
        if self.peek() != Some(b'[') {
            let digits = length(self.rest(), |byte| byte.is_ascii_digit());
            let text = std::str::from_utf8(&self.rest()[..digits]).unwrap_or_default();
            self.at += digits;
            return Ok(text.parse().ok());
        }
        self.at += 1;
        let value = self.expression(state)?.round();
        self.skip_blanks();
        if self.peek() != Some(b']') {
            return Err(self.fault(start, ArithmeticError::NotClosed));
        }
        self.at += 1;
        let most = LARGEST_R;
        if !(0.0..=f64::from(most)).contains(&value) {
            return Err(self.fault(start, ArithmeticError::NoSuchParameter { value, most }));
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and within the bounds checked above"
        )]
        let number = value as u32;
        Ok(Some(number))
    }

    pub(crate) fn fault(&self, start: usize, reason: ArithmeticError) -> Fault {
        Fault::new(Span::new(start, self.at.max(start + 1)), reason.into())
    }
}

/// How many bytes at the beginning pass.
fn length(text: &[u8], pass: impl Fn(u8) -> bool) -> usize {
    text.iter()
        .position(|&byte| !pass(byte))
        .unwrap_or(text.len())
}
