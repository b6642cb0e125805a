//! Evaluates expressions of Sinumerik.
//!
//! Source: the programming manual of Sinumerik 840D sl: operators bind from the tightest to the loosest as
//! `NOT`, `* / DIV MOD`, `+ -`, `AND`, `XOR`, `OR`, comparisons. Not here: words, and operators of bits.

use crate::error::Fault;
use crate::error::arithmetic::ArithmeticError;
use crate::error::reason::Reason;
use crate::interpreter::Interpreter;
use crate::sinumerik::reader::Reader;
use crate::text::place::Span;

/// Brackets and signs within each other.
const DEEPEST: u32 = 64;

/// Comparisons, longer ones before those that they begin with.
const COMPARISONS: [&[u8]; 6] = [b"==", b"<>", b">=", b"<=", b">", b"<"];

impl Reader<'_> {
    /// An expression, as a number: what is true is 1.
    pub(crate) fn expression(&mut self, state: &Interpreter) -> Result<f64, Fault> {
        let start = self.at;
        self.deepen(start)?;
        let mut value = self.logic(state)?;
        while let Some(comparison) = self.comparison() {
            let other = self.logic(state)?;
            value = f64::from(u8::from(match comparison {
                b"==" => equal(value, other),
                b"<>" => !equal(value, other),
                b">=" => value >= other,
                b"<=" => value <= other,
                b">" => value > other,
                _ => value < other,
            }));
        }
        self.depth -= 1;
        if value.is_finite() {
            Ok(value)
        } else {
            let function = "an expression";
            Err(self.fault(start, ArithmeticError::Overflow { function }))
        }
    }

    fn deepen(&mut self, start: usize) -> Result<(), Fault> {
        self.depth += 1;
        if self.depth > DEEPEST {
            let bound = DEEPEST;
            return Err(self.fault(start, ArithmeticError::TooDeep { bound }));
        }
        Ok(())
    }

    fn comparison(&mut self) -> Option<&'static [u8]> {
        self.skip_blanks();
        let rest = self.rest();
        let found = COMPARISONS
            .into_iter()
            .find(|sign| rest.starts_with(sign))?;
        self.at += found.len();
        Some(found)
    }

    /// `AND` before `XOR` before `OR`.
    fn logic(&mut self, state: &Interpreter) -> Result<f64, Fault> {
        let mut either = self.exclusive(state)?;
        while self.takes("OR") {
            let other = self.exclusive(state)?;
            either = truth(either != 0.0 || other != 0.0);
        }
        Ok(either)
    }

    fn exclusive(&mut self, state: &Interpreter) -> Result<f64, Fault> {
        let mut one = self.both(state)?;
        while self.takes("XOR") {
            let other = self.both(state)?;
            one = truth((one != 0.0) != (other != 0.0));
        }
        Ok(one)
    }

    fn both(&mut self, state: &Interpreter) -> Result<f64, Fault> {
        let mut both = self.sum(state)?;
        while self.takes("AND") {
            let other = self.sum(state)?;
            both = truth(both != 0.0 && other != 0.0);
        }
        Ok(both)
    }

    fn sum(&mut self, state: &Interpreter) -> Result<f64, Fault> {
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
                _ => return Ok(sum),
            }
        }
    }

    fn product(&mut self, state: &Interpreter) -> Result<f64, Fault> {
        let mut product = self.factor(state)?;
        loop {
            self.skip_blanks();
            let start = self.at;
            let divided = |reader: &mut Self| {
                let divisor = reader.factor(state)?;
                if divisor == 0.0 {
                    let (function, value) = ("division by zero", product);
                    return Err(reader.fault(start, ArithmeticError::Undefined { function, value }));
                }
                Ok(divisor)
            };
            match self.peek() {
                Some(b'*') => {
                    self.at += 1;
                    product *= self.factor(state)?;
                }
                Some(b'/') => {
                    self.at += 1;
                    product /= divided(self)?;
                }
                Some(b'D' | b'd') if self.takes("DIV") => {
                    product = (product / divided(self)?).trunc();
                }
                Some(b'M' | b'm') if self.takes("MOD") => product %= divided(self)?,
                _ => return Ok(product),
            }
        }
    }

    fn factor(&mut self, state: &Interpreter) -> Result<f64, Fault> {
        self.skip_blanks();
        let start = self.at;
        match self.peek() {
            Some(b'(') => {
                self.at += 1;
                let value = self.expression(state)?;
                self.close(start)?;
                Ok(value)
            }
            Some(sign @ (b'+' | b'-')) => {
                self.at += 1;
                self.deepen(start)?;
                let value = self.factor(state)?;
                self.depth -= 1;
                Ok(if sign == b'-' { -value } else { value })
            }
            Some(b'0'..=b'9' | b'.') => self
                .plain_number()
                .ok_or_else(|| self.fault(start, ArithmeticError::ValueMissing)),
            Some(byte) if byte.is_ascii_alphabetic() || b"_$".contains(&byte) => {
                self.named(state, start)
            }
            _ => Err(self.fault(start, ArithmeticError::ValueMissing)),
        }
    }

    pub(crate) fn close(&mut self, start: usize) -> Result<(), Fault> {
        self.skip_blanks();
        if self.peek() != Some(b')') {
            return Err(self.fault(start, ArithmeticError::NotClosed));
        }
        self.at += 1;
        Ok(())
    }

    /// A variable, a function, or `NOT`.
    fn named(&mut self, state: &Interpreter, start: usize) -> Result<f64, Fault> {
        let mut name = self.next_name();
        match name.as_str() {
            "TRUE" => return Ok(1.0),
            "FALSE" => return Ok(0.0),
            "NOT" => {
                self.deepen(start)?;
                let value = self.factor(state)?;
                self.depth -= 1;
                return Ok(truth(value == 0.0));
            }
            name if name.starts_with('$') => {
                let what = "variables of the system";
                let reason = Reason::WordNotSupported {
                    word: name.into(),
                    what,
                };
                return Err(Fault::new(Span::new(start, self.at), reason));
            }
            "R" if self.peek() == Some(b'[') => {
                let number = self.parameter_number(state)?.unwrap_or(0);
                name = format!("R{number}");
            }
            _ => {}
        }
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
        let second = if self.peek() == Some(b',') {
            self.at += 1;
            Some(self.expression(state)?)
        } else {
            None
        };
        self.close(start)?;
        let result = match (name.as_str(), second) {
            ("SIN", None) => value.to_radians().sin(),
            ("COS", None) => value.to_radians().cos(),
            ("TAN", None) => value.to_radians().tan(),
            ("ASIN", None) => value.asin().to_degrees(),
            ("ACOS", None) => value.acos().to_degrees(),
            ("ATAN2", Some(other)) => value.atan2(other).to_degrees(),
            ("SQRT", None) => value.sqrt(),
            ("POT", None) => value * value,
            ("ABS", None) => value.abs(),
            ("TRUNC", None) => value.trunc(),
            ("ROUND", None) => value.round(),
            ("ROUNDUP", None) => value.ceil(),
            ("LN", None) => value.ln(),
            ("EXP", None) => value.exp(),
            ("MINVAL", Some(other)) => value.min(other),
            ("MAXVAL", Some(other)) => value.max(other),
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
}

/// Values are the same if nothing but the rounding of floats lies between them.
fn equal(one: f64, other: f64) -> bool {
    (one - other).abs() <= f64::EPSILON * one.abs().max(other.abs())
}

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}
