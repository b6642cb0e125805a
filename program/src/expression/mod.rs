//! Evaluates numbers, parameters, functions and expressions in brackets.
//!
//! Source: RS274/NGC, sections on real values, expressions, operators and functions. Angles are in
//! degrees. A truth is 1, a falsehood 0. Not here: where the values of parameters come from.

pub(crate) mod operations;
pub(crate) mod parameters;
pub(crate) mod state_parameters;

use crate::error::Fault;
use crate::error::arithmetic::ArithmeticError;
use crate::text::number::number;
use crate::text::place::Span;
use operations::{apply, operate, truth};
use parameters::{LARGEST_PARAMETER, Values};

/// Brackets, signs and `#` within each other.
const DEEPEST_EXPRESSION: u32 = 64;

/// A number as near as this to a whole one is whole: expressions are rounded.
const WHOLE: f64 = 1e-4;

/// Longest name of a parameter or a subroutine, characters.
pub(crate) const LONGEST_NAME: usize = 255;

/// Functions of one argument, and `ATAN` of two.
const FUNCTIONS: [&str; 13] = [
    "ABS", "ACOS", "ASIN", "ATAN", "COS", "EXP", "FIX", "FUP", "LN", "ROUND", "SIN", "SQRT", "TAN",
];

/// Operators by how strongly they bind, the weakest first.
const OPERATORS: [&[&str]; 5] = [
    &["AND", "OR", "XOR"],
    &["EQ", "NE", "GT", "GE", "LT", "LE"],
    &["+", "-"],
    &["*", "/", "MOD"],
    &["**"],
];

/// What a program writes behind `#`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Parameter {
    Numbered(u32),
    Named(Box<str>),
}

/// Reads values from a line.
pub(crate) struct Evaluator<'a> {
    pub(crate) line: &'a [u8],
    pub(crate) at: usize,
    values: &'a dyn Values,
    depth: u32,
}

impl<'a> Evaluator<'a> {
    pub(crate) fn new(line: &'a [u8], at: usize, values: &'a dyn Values) -> Self {
        Self {
            line,
            at,
            values,
            depth: 0,
        }
    }

    /// A value that begins here: a number, a parameter, a function or an expression.
    pub(crate) fn value(&mut self) -> Result<f64, Fault> {
        self.skip_blanks();
        let start = self.at;
        match self.peek() {
            Some(b'[') => self.brackets(),
            Some(b'#') => {
                let parameter = self.parameter()?;
                self.look_up(&parameter, start)
            }
            Some(b'+' | b'-') => match number(self.line, self.at) {
                Ok(found) => self.take(found),
                Err(_) => self.signed(),
            },
            Some(b'0'..=b'9' | b'.') => match number(self.line, self.at) {
                Ok(found) => self.take(found),
                Err(_) => Err(self.fault(start, ArithmeticError::ValueMissing)),
            },
            Some(byte) if byte.is_ascii_alphabetic() => self.function(),
            _ => Err(self.fault(start, ArithmeticError::ValueMissing)),
        }
    }

    /// Whether the name of a function stands at a place.
    pub(crate) fn function_stands(&mut self, at: usize) -> bool {
        let here = std::mem::replace(&mut self.at, at);
        let found = FUNCTIONS.into_iter().chain(["EXISTS"]).any(|name| {
            self.stands(name) && {
                let rest = &self.line[at + name.len()..];
                let next = rest.iter().find(|byte| !matches!(byte, b' ' | b'\t'));
                next == Some(&b'[')
            }
        });
        self.at = here;
        found
    }

    /// An expression in brackets that begins here.
    pub(crate) fn brackets(&mut self) -> Result<f64, Fault> {
        let start = self.at;
        self.deeper(start)?;
        self.at += 1;
        let value = self.level(0)?;
        self.skip_blanks();
        if self.peek() != Some(b']') {
            let end = self.word_end();
            let (start, reason) = if end > self.at {
                (self.at, ArithmeticError::UnknownOperator)
            } else {
                (start, ArithmeticError::NotClosed)
            };
            return Err(Fault::new(Span::new(start, end), reason.into()));
        }
        self.at += 1;
        self.depth -= 1;
        Ok(value)
    }

    /// A parameter that begins with the `#` here.
    pub(crate) fn parameter(&mut self) -> Result<Parameter, Fault> {
        let start = self.at;
        self.deeper(start)?;
        self.at += 1;
        self.skip_blanks();
        let parameter = if self.peek() == Some(b'<') {
            Parameter::Named(self.name()?)
        } else {
            let value = self.value()?;
            let nearest = value.round();
            let legal = (1.0..=f64::from(LARGEST_PARAMETER)).contains(&nearest);
            if !legal || (value - nearest).abs() > WHOLE {
                let most = LARGEST_PARAMETER;
                return Err(self.fault(start, ArithmeticError::NoSuchParameter { value, most }));
            }
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "whole and within the bounds checked above"
            )]
            Parameter::Numbered(nearest as u32)
        };
        self.depth -= 1;
        Ok(parameter)
    }

    /// A name in angle brackets, in lower case and without blanks.
    pub(crate) fn name(&mut self) -> Result<Box<str>, Fault> {
        let start = self.at;
        let most = LONGEST_NAME;
        let inside = &self.line[start + 1..];
        let end = inside.iter().position(|&byte| byte == b'>');
        let Some(end) = end else {
            self.at = self.line.len();
            return Err(self.fault(start, ArithmeticError::BadName { most }));
        };
        self.at = start + end + 2;
        let name: String = String::from_utf8_lossy(&inside[..end])
            .chars()
            .filter(|letter| !matches!(letter, ' ' | '\t'))
            .map(|letter| letter.to_ascii_lowercase())
            .collect();
        let bad = |letter: char| matches!(letter, '<' | '(') || letter.is_control();
        if name.is_empty() || name.len() > most || name.contains(bad) {
            return Err(self.fault(start, ArithmeticError::BadName { most }));
        }
        Ok(name.into())
    }

    pub(crate) fn skip_blanks(&mut self) {
        while let Some(b' ' | b'\t') = self.peek() {
            self.at += 1;
        }
    }

    pub(crate) fn peek(&self) -> Option<u8> {
        self.line.get(self.at).copied()
    }

    fn take(&mut self, (value, end): (f64, usize)) -> Result<f64, Fault> {
        let start = self.at;
        self.at = end;
        if value.is_finite() {
            Ok(value)
        } else {
            let function = "reading a number";
            Err(self.fault(start, ArithmeticError::Overflow { function }))
        }
    }

    /// A sign before something that is no number.
    fn signed(&mut self) -> Result<f64, Fault> {
        let negative = self.peek() == Some(b'-');
        self.deeper(self.at)?;
        self.at += 1;
        let value = self.value()?;
        self.depth -= 1;
        Ok(if negative { -value } else { value })
    }

    fn look_up(&self, parameter: &Parameter, start: usize) -> Result<f64, Fault> {
        match parameter {
            Parameter::Numbered(number) => Ok(self.values.numbered(*number)),
            Parameter::Named(name) => self.values.named(name).ok_or_else(|| {
                let name = name.clone();
                self.fault(start, ArithmeticError::NeverSet { name })
            }),
        }
    }

    /// Values joined by operators that bind at least as strongly as those of `level`.
    fn level(&mut self, level: usize) -> Result<f64, Fault> {
        let Some(operators) = OPERATORS.get(level) else {
            return self.value();
        };
        let mut left = self.level(level + 1)?;
        loop {
            self.skip_blanks();
            let start = self.at;
            let Some(operator) = operators.iter().copied().find(|name| self.stands(name)) else {
                return Ok(left);
            };
            self.at += operator.len();
            let right = self.level(level + 1)?;
            left = operate(operator, left, right).map_err(|reason| self.fault(start, reason))?;
        }
    }

    /// Whether a name stands here, in either case; `*` is not the beginning of `**`.
    fn stands(&self, name: &str) -> bool {
        let rest = &self.line[self.at..];
        let here = rest
            .get(..name.len())
            .is_some_and(|here| here.eq_ignore_ascii_case(name.as_bytes()));
        here && !(name == "*" && rest.get(1) == Some(&b'*'))
    }

    fn function(&mut self) -> Result<f64, Fault> {
        let start = self.at;
        if self.stands("EXISTS") {
            return self.exists();
        }
        let Some(name) = FUNCTIONS.into_iter().find(|name| self.stands(name)) else {
            let end = self.word_end();
            let reason = ArithmeticError::UnknownFunction;
            return Err(Fault::new(Span::new(start, end), reason.into()));
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
        let argument = self.brackets()?;
        if name != "ATAN" {
            return apply(name, argument).map_err(|reason| self.fault(start, reason));
        }
        self.skip_blanks();
        if self.peek() != Some(b'/') {
            return Err(self.fault(start, missing(", as in ATAN[1]/[2]")));
        }
        self.at += 1;
        self.skip_blanks();
        if self.peek() != Some(b'[') {
            return Err(self.fault(start, missing(", as in ATAN[1]/[2]")));
        }
        let other = self.brackets()?;
        Ok(argument.atan2(other).to_degrees())
    }

    /// `EXISTS[#<name>]`: whether a parameter has a value.
    fn exists(&mut self) -> Result<f64, Fault> {
        let start = self.at;
        self.at += "EXISTS".len();
        let missing = ArithmeticError::ArgumentMissing {
            function: "EXISTS",
            hint: ", as in EXISTS[#<name>]",
        };
        self.skip_blanks();
        if self.peek() != Some(b'[') {
            return Err(self.fault(start, missing));
        }
        self.at += 1;
        self.skip_blanks();
        if self.peek() != Some(b'#') {
            return Err(self.fault(start, missing));
        }
        let parameter = self.parameter()?;
        self.skip_blanks();
        if self.peek() != Some(b']') {
            return Err(self.fault(start, missing));
        }
        self.at += 1;
        Ok(truth(match parameter {
            Parameter::Numbered(_) => true,
            Parameter::Named(name) => self.values.named(&name).is_some(),
        }))
    }

    fn deeper(&mut self, start: usize) -> Result<(), Fault> {
        self.depth += 1;
        if self.depth > DEEPEST_EXPRESSION {
            let bound = DEEPEST_EXPRESSION;
            self.at = start + 1;
            return Err(self.fault(start, ArithmeticError::TooDeep { bound }));
        }
        Ok(())
    }

    /// Where the word or the character that begins here ends.
    fn word_end(&self) -> usize {
        let rest = &self.line[self.at..];
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
