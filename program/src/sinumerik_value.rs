//! Words and values of a line for Sinumerik.
//!
//! Not here: what they mean, see `sinumerik`.

use crate::arithmetic_error::ArithmeticError;
use crate::codes::Distance;
use crate::error::Fault;
use crate::lower::Lowering;
use crate::number::number;
use crate::place::Span;
use crate::reason::Reason;

/// Brackets and signs within each other.
const DEEPEST: u32 = 64;

/// Reads a line from left to right.
pub(crate) struct Reader<'a> {
    line: &'a [u8],
    pub(crate) at: usize,
    depth: u32,
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
                crate::lexer::check_text(self.line, self.at)?;
                Ok(None)
            }
            Some(_) => Ok(Some(self.at)),
        }
    }

    /// The name that begins here, in upper case: one letter before a number or `=`, else all letters,
    /// digits and `_`.
    pub(crate) fn name(&mut self) -> String {
        let rest = &self.line[self.at..];
        let letters = length(rest, |byte| byte.is_ascii_alphabetic() || byte == b'_');
        let whole = length(rest, |byte| byte.is_ascii_alphanumeric() || byte == b'_');
        let length = if letters == 1 && rest[0] != b'_' {
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
        let rest = &self.line[self.at..];
        let whole = length(rest, |byte| byte.is_ascii_alphanumeric() || byte == b'_');
        let name = String::from_utf8_lossy(&rest[..whole]).to_ascii_uppercase();
        self.at += whole;
        name
    }

    /// Whether a number or `=` follows.
    pub(crate) fn address_follows(&mut self) -> bool {
        self.skip_blanks();
        matches!(self.peek(), Some(b'0'..=b'9' | b'+' | b'-' | b'.' | b'='))
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

    /// The number between a letter and `=`, as in `R12=`.
    pub(crate) fn extension(&mut self) -> Option<u32> {
        let digits = length(&self.line[self.at..], |byte| byte.is_ascii_digit());
        let end = self.at + digits;
        let rest = &self.line[end..];
        let blanks = length(rest, |byte| matches!(byte, b' ' | b'\t'));
        if digits == 0 || rest.get(blanks) != Some(&b'=') {
            return None;
        }
        let number = std::str::from_utf8(&self.line[self.at..end])
            .ok()?
            .parse()
            .ok()?;
        self.at = end + blanks + 1;
        Some(number)
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

    /// The value of an address: a number, or an expression behind `=`; `AC( )` and `IC( )` say that
    /// it is absolute or incremental.
    pub(crate) fn address_value(
        &mut self,
        state: &Lowering,
        start: usize,
    ) -> Result<(f64, Option<Distance>), Fault> {
        self.skip_blanks();
        if self.peek() == Some(b'=') {
            self.at += 1;
            self.skip_blanks();
            let here = self.at;
            let distance = match self.next_name().as_str() {
                "AC" => Some(Distance::Absolute),
                "IC" => Some(Distance::Incremental),
                _ => None,
            };
            if distance.is_none() {
                self.at = here;
            }
            return Ok((self.expression(state)?, distance));
        }
        match number(self.line, self.at) {
            Ok((value, end)) if value.is_finite() => {
                self.at = end;
                Ok((value, None))
            }
            _ => {
                let letter = self.line.get(start).map_or('?', |&byte| char::from(byte));
                let span = Span::new(start, start + 1);
                Err(Fault::new(span, Reason::NumberMissing { letter }))
            }
        }
    }

    /// Values in round brackets, separated by commas; empty places are 0.
    pub(crate) fn arguments(&mut self, state: &Lowering) -> Result<Vec<f64>, Fault> {
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

    /// Passes over a text in round brackets, if one follows.
    pub(crate) fn skip_brackets(&mut self) {
        self.skip_blanks();
        if self.peek() == Some(b'(') {
            let rest = &self.line[self.at..];
            let end = rest.iter().rposition(|&byte| byte == b')');
            self.at += end.map_or(rest.len(), |end| end + 1);
        }
    }

    /// Sums of products.
    pub(crate) fn expression(&mut self, state: &Lowering) -> Result<f64, Fault> {
        let start = self.at;
        self.depth += 1;
        if self.depth > DEEPEST {
            let bound = DEEPEST;
            return Err(self.fault(start, ArithmeticError::TooDeep { bound }));
        }
        let mut sum = self.product(state)?;
        loop {
            self.skip_blanks();
            match self.peek() {
                Some(b'+') => {
                    self.at += 1;
                    sum += self.product(state)?;
                }
                Some(b'-') => {
                    self.at += 1;
                    sum -= self.product(state)?;
                }
                _ => break,
            }
        }
        self.depth -= 1;
        if sum.is_finite() {
            Ok(sum)
        } else {
            let function = "an expression";
            Err(self.fault(start, ArithmeticError::Overflow { function }))
        }
    }

    fn product(&mut self, state: &Lowering) -> Result<f64, Fault> {
        let mut product = self.factor(state)?;
        loop {
            self.skip_blanks();
            let start = self.at;
            match self.peek() {
                Some(b'*') => {
                    self.at += 1;
                    product *= self.factor(state)?;
                }
                Some(b'/') => {
                    self.at += 1;
                    let divisor = self.factor(state)?;
                    if divisor == 0.0 {
                        let (function, value) = ("division by zero", product);
                        return Err(
                            self.fault(start, ArithmeticError::Undefined { function, value })
                        );
                    }
                    product /= divisor;
                }
                _ => return Ok(product),
            }
        }
    }

    fn factor(&mut self, state: &Lowering) -> Result<f64, Fault> {
        self.skip_blanks();
        let start = self.at;
        match self.peek() {
            Some(b'(') => {
                self.at += 1;
                let value = self.expression(state)?;
                self.skip_blanks();
                if self.peek() != Some(b')') {
                    return Err(self.fault(start, ArithmeticError::NotClosed));
                }
                self.at += 1;
                Ok(value)
            }
            Some(sign @ (b'+' | b'-')) => {
                self.at += 1;
                self.depth += 1;
                if self.depth > DEEPEST {
                    let bound = DEEPEST;
                    return Err(self.fault(start, ArithmeticError::TooDeep { bound }));
                }
                let value = self.factor(state)?;
                self.depth -= 1;
                Ok(if sign == b'-' { -value } else { value })
            }
            Some(b'0'..=b'9' | b'.') => match number(self.line, self.at) {
                Ok((value, end)) => {
                    self.at = end;
                    Ok(value)
                }
                Err(_) => Err(self.fault(start, ArithmeticError::ValueMissing)),
            },
            Some(byte) if byte.is_ascii_alphabetic() || byte == b'_' => self.named(state, start),
            _ => Err(self.fault(start, ArithmeticError::ValueMissing)),
        }
    }

    /// A variable or a function.
    fn named(&mut self, state: &Lowering, start: usize) -> Result<f64, Fault> {
        let name = self.next_name();
        self.skip_blanks();
        if self.peek() != Some(b'(') {
            let name = name.to_ascii_lowercase();
            return state.parameters.get_named(&name).ok_or_else(|| {
                let name = name.into();
                self.fault(start, ArithmeticError::NeverSet { name })
            });
        }
        self.at += 1;
        let value = self.expression(state)?;
        self.skip_blanks();
        if self.peek() != Some(b')') {
            return Err(self.fault(start, ArithmeticError::NotClosed));
        }
        self.at += 1;
        let result = match name.as_str() {
            "SIN" => value.to_radians().sin(),
            "COS" => value.to_radians().cos(),
            "TAN" => value.to_radians().tan(),
            "SQRT" => value.sqrt(),
            "ABS" => value.abs(),
            "TRUNC" => value.trunc(),
            "ROUND" => value.round(),
            _ => {
                let word = name.into();
                let span = Span::new(start, self.at);
                return Err(Fault::new(span, Reason::UnknownWord { word }));
            }
        };
        if result.is_finite() {
            Ok(result)
        } else {
            let function = "a function";
            Err(self.fault(start, ArithmeticError::Undefined { function, value }))
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

    fn skip_blanks(&mut self) {
        while let Some(b' ' | b'\t') = self.peek() {
            self.at += 1;
        }
    }

    fn peek(&self) -> Option<u8> {
        self.line.get(self.at).copied()
    }

    fn fault(&self, start: usize, reason: ArithmeticError) -> Fault {
        Fault::new(Span::new(start, self.at.max(start + 1)), reason.into())
    }
}

/// How many bytes at the beginning pass.
fn length(text: &[u8], pass: impl Fn(u8) -> bool) -> usize {
    text.iter()
        .position(|&byte| !pass(byte))
        .unwrap_or(text.len())
}
