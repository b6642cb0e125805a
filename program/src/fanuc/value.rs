//! Reads expressions of macro B into values; a variable without a value is null.
//!
//! Source: the chapter on custom macros of the operator's manuals of FANUC and Haas. From the tightest to
//! the loosest bind functions, `* / MOD AND`, `+ - OR XOR`, comparisons. Angles are in degrees. Not here:
//! where variables have their values from.

use crate::error::Fault;
use crate::error::arithmetic::ArithmeticError;
use crate::fanuc::functions::{BITS, apply, compare, operate};
use crate::text::number::number;
use crate::text::place::Span;

/// Brackets, signs and `#` within each other.
const DEEPEST: u32 = 64;

/// Largest number of a variable.
pub(crate) const LARGEST_VARIABLE: u32 = 99_999;

/// A number as near as this to a whole one is whole.
const WHOLE: f64 = 1e-4;

/// The value of a variable that has none.
pub(crate) const NULL: f64 = f64::NAN;

/// Functions of one argument; those of two are `ATAN` and `POW`.
const FUNCTIONS: [&str; 18] = [
    "ABS", "ACOS", "ADP", "ASIN", "ATAN", "BCD", "BIN", "COS", "EXP", "FIX", "FUP", "LN", "POW",
    "ROUND", "SIN", "SQRT", "SQR", "TAN",
];

const COMPARISONS: [&str; 6] = ["EQ", "NE", "GT", "GE", "LT", "LE"];
const SUMS: [&str; 4] = ["+", "-", "OR", "XOR"];
const PRODUCTS: [&str; 4] = ["*", "/", "AND", "MOD"];

/// Gives variables their values.
pub(crate) trait Variables {
    /// A variable by its number, [`NULL`] where it has no value.
    fn value(&self, number: u32) -> Result<f64, ArithmeticError>;
}

/// Reads values from a line.
pub(crate) struct Evaluator<'a> {
    line: &'a [u8],
    pub(crate) at: usize,
    variables: &'a dyn Variables,
    /// What `ROUND` rounds to: 1 in statements, the least input increment in words.
    increment: f64,
    depth: u32,
}

impl<'a> Evaluator<'a> {
    pub(crate) fn new(line: &'a [u8], at: usize, variables: &'a dyn Variables) -> Self {
        Self {
            line,
            at,
            variables,
            increment: 1.0,
            depth: 0,
        }
    }

    /// The same reader, whose `ROUND` rounds to an increment.
    pub(crate) fn rounding_to(mut self, increment: f64) -> Self {
        self.increment = increment;
        self
    }

    /// An expression, as far as it goes; what is true is 1.
    pub(crate) fn expression(&mut self) -> Result<f64, Fault> {
        let start = self.at;
        self.deeper(start)?;
        let mut value = self.sum()?;
        while let Some(name) = self.operator(&COMPARISONS) {
            value = compare(name, value, self.sum()?);
        }
        self.depth -= 1;
        Ok(value)
    }

    fn sum(&mut self) -> Result<f64, Fault> {
        let mut value = self.product()?;
        loop {
            let start = self.at;
            let Some(name) = self.operator(&SUMS) else {
                return Ok(value);
            };
            let other = self.product()?;
            value = operate(name, value, other).map_err(|reason| self.fault(start, reason))?;
        }
    }

    fn product(&mut self) -> Result<f64, Fault> {
        let mut value = self.value()?;
        loop {
            let start = self.at;
            let Some(name) = self.operator(&PRODUCTS) else {
                return Ok(value);
            };
            let other = self.value()?;
            value = operate(name, value, other).map_err(|reason| self.fault(start, reason))?;
        }
    }

    /// Takes an operator if one of a list follows.
    fn operator(&mut self, list: &[&'static str]) -> Option<&'static str> {
        self.skip_blanks();
        let found = list.iter().copied().find(|name| self.stands(name))?;
        self.at += found.len();
        Some(found)
    }

    /// A value that begins here: a number, a variable, a function or an expression in brackets.
    pub(crate) fn value(&mut self) -> Result<f64, Fault> {
        self.skip_blanks();
        let start = self.at;
        match self.peek() {
            Some(b'[') => self.brackets(),
            Some(b'#') => {
                let number = self.variable()?;
                self.variables
                    .value(number)
                    .map_err(|reason| self.fault(start, reason))
            }
            Some(sign @ (b'+' | b'-')) => {
                self.at += 1;
                self.deeper(start)?;
                let value = self.value()?;
                self.depth -= 1;
                Ok(if sign == b'-' { -value } else { value })
            }
            Some(b'0'..=b'9' | b'.') => match number(self.line, self.at) {
                Ok((value, end)) if value.is_finite() => {
                    self.at = end;
                    Ok(value)
                }
                Ok(_) => {
                    let function = "reading a number";
                    Err(self.fault(start, ArithmeticError::Overflow { function }))
                }
                Err(_) => Err(self.fault(start, ArithmeticError::ValueMissing)),
            },
            Some(byte) if byte.is_ascii_alphabetic() => self.function(),
            _ => Err(self.fault(start, ArithmeticError::ValueMissing)),
        }
    }

    /// The number of the variable whose `#` stands here.
    pub(crate) fn variable(&mut self) -> Result<u32, Fault> {
        let start = self.at;
        self.deeper(start)?;
        self.at += 1;
        let value = self.value()?;
        self.depth -= 1;
        let nearest = value.round();
        let most = LARGEST_VARIABLE;
        if !(0.0..=f64::from(most)).contains(&nearest) || (value - nearest).abs() > WHOLE {
            return Err(self.fault(start, ArithmeticError::NoSuchVariable { value, most }));
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and within the bounds checked above"
        )]
        Ok(nearest as u32)
    }

    fn brackets(&mut self) -> Result<f64, Fault> {
        let start = self.at;
        self.at += 1;
        let value = self.expression()?;
        self.close(start)?;
        Ok(value)
    }

    fn close(&mut self, start: usize) -> Result<(), Fault> {
        self.skip_blanks();
        if self.peek() == Some(b']') {
            self.at += 1;
            return Ok(());
        }
        let end = self.word_end();
        let (from, reason) = if end > self.at {
            (self.at, ArithmeticError::UnknownOperator)
        } else {
            (start, ArithmeticError::NotClosed)
        };
        Err(Fault::new(Span::new(from, end), reason.into()))
    }

    /// Whether the name of a function with its bracket stands here.
    pub(crate) fn function_follows(&self) -> bool {
        self.function_here().is_some_and(|name| {
            let rest = &self.line[self.at + name.len()..];
            let next = rest.iter().find(|byte| !matches!(byte, b' ' | b'\t'));
            next == Some(&b'[')
        })
    }

    fn function_here(&self) -> Option<&'static str> {
        FUNCTIONS.into_iter().find(|name| self.stands(name))
    }

    fn function(&mut self) -> Result<f64, Fault> {
        let start = self.at;
        let Some(name) = self.function_here() else {
            let end = self.word_end();
            let word = String::from_utf8_lossy(&self.line[start..end]).to_ascii_uppercase();
            let span = Span::new(start, end);
            let reason = if word == "PRM" {
                ArithmeticError::NotKnown {
                    name: "PRM".into(),
                    what: "parameters of the control",
                }
            } else {
                ArithmeticError::UnknownMacroFunction
            };
            return Err(Fault::new(span, reason.into()));
        };
        self.at += name.len();
        self.skip_blanks();
        let missing = |hint| ArithmeticError::ArgumentMissing {
            function: name,
            hint,
        };
        if self.peek() != Some(b'[') {
            return Err(self.fault(start, missing("")));
        }
        let open = self.at;
        self.at += 1;
        let first = self.expression()?;
        self.skip_blanks();
        let mut second = None;
        if matches!(name, "ATAN" | "POW") && self.peek() == Some(b',') {
            self.at += 1;
            second = Some(self.expression()?);
        }
        self.close(open)?;
        let after = self.at;
        self.skip_blanks();
        if name == "ATAN" && second.is_none() && self.peek() == Some(b'/') {
            self.at += 1;
            self.skip_blanks();
            if self.peek() == Some(b'[') {
                second = Some(self.brackets()?);
            } else {
                // The quotient of an angle and something else.
                self.at = after;
            }
        }
        if name == "POW" && second.is_none() {
            return Err(self.fault(start, missing(", as in POW[2,3]")));
        }
        apply(name, first, second, self.increment).map_err(|reason| self.fault(start, reason))
    }

    pub(crate) fn skip_blanks(&mut self) {
        while let Some(b' ' | b'\t') = self.peek() {
            self.at += 1;
        }
    }

    pub(crate) fn peek(&self) -> Option<u8> {
        self.line.get(self.at).copied()
    }

    /// Whether a name stands here, in either case.
    fn stands(&self, name: &str) -> bool {
        let here = self.line.get(self.at..self.at + name.len());
        here.is_some_and(|here| here.eq_ignore_ascii_case(name.as_bytes()))
    }

    fn deeper(&mut self, start: usize) -> Result<(), Fault> {
        self.depth += 1;
        if self.depth > DEEPEST {
            let bound = DEEPEST;
            self.at = start + 1;
            return Err(self.fault(start, ArithmeticError::TooDeep { bound }));
        }
        Ok(())
    }

    /// Where the word or the character that begins here ends.
    fn word_end(&self) -> usize {
        let rest = self.line.get(self.at..).unwrap_or_default();
        let letters = rest
            .iter()
            .position(|byte| !byte.is_ascii_alphabetic())
            .unwrap_or(rest.len());
        self.at + letters.max(usize::from(!rest.is_empty()))
    }

    fn fault(&self, start: usize, reason: ArithmeticError) -> Fault {
        Fault::new(Span::new(start, self.at.max(start + 1)), reason.into())
    }
}

/// A value where a whole number of 32 bits is asked for.
pub(crate) fn bits(value: f64) -> Option<u32> {
    let whole = value.round();
    if !(-BITS..BITS).contains(&whole) {
        return None;
    }
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole and within the bounds checked above; negative numbers are two's complement"
    )]
    Some(whole as i64 as u32)
}
