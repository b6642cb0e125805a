//! Computes operators and functions of macro B.
//!
//! Source: the chapter on custom macros of the operator's manuals of FANUC and Haas. In arithmetic null
//! counts as 0. Not here: how operators bind.

use crate::error::arithmetic::ArithmeticError;
use crate::expression::operations::truth;
use crate::fanuc::value::bits;

/// Numbers whose difference is below this part of the larger one, or of 1, are equal: a loop that counts in
/// tenths ends where its programmer means.
const EQUAL: f64 = 1e-9;

/// Whole numbers of bits lie below this.
pub(crate) const BITS: f64 = 4_294_967_296.0;

/// Decimal digits of a number in `BIN` and `BCD`.
const DIGITS: u32 = 8;

/// A comparison: null equals null alone for `EQ` and `NE`, and counts as 0 for the others.
pub(crate) fn compare(name: &'static str, left: f64, right: f64) -> f64 {
    let (first, second) = (number(left), number(right));
    let near = (first - second).abs() <= EQUAL * first.abs().max(second.abs()).max(1.0);
    let equal = left.is_nan() == right.is_nan() && near;
    truth(match name {
        "EQ" => equal,
        "NE" => !equal,
        "GT" => first > second && !near,
        "GE" => first > second || near,
        "LT" => first < second && !near,
        _ => first < second || near,
    })
}

/// An operator between two values.
pub(crate) fn operate(name: &'static str, left: f64, right: f64) -> Result<f64, ArithmeticError> {
    let (left, right) = (number(left), number(right));
    let undefined = |function, value| Err(ArithmeticError::Undefined { function, value });
    let both = || bits(left).zip(bits(right));
    let value = match name {
        "+" => left + right,
        "-" => left - right,
        "*" => left * right,
        "/" if right == 0.0 => return undefined("division by zero", left),
        "/" => left / right,
        "MOD" if right == 0.0 => return undefined("MOD by zero", left),
        "MOD" => left % right,
        _ => {
            let Some((one, other)) = both() else {
                return undefined("an operator of bits", left);
            };
            f64::from(match name {
                "AND" => one & other,
                "OR" => one | other,
                _ => one ^ other,
            })
        }
    };
    finite(name, value)
}

/// A function; `increment` is what `ROUND` rounds to.
pub(crate) fn apply(
    name: &'static str,
    first: f64,
    second: Option<f64>,
    increment: f64,
) -> Result<f64, ArithmeticError> {
    let value = number(first);
    let undefined = || {
        let function = name;
        Err(ArithmeticError::Undefined { function, value })
    };
    let result = match (name, second.map(number)) {
        ("ATAN", Some(other)) => {
            let angle = value.atan2(other).to_degrees();
            // From 0 to 360, as FANUC has it where its parameters say nothing else.
            if angle < 0.0 { angle + 360.0 } else { angle }
        }
        ("POW", Some(other)) if value < 0.0 && other.fract() != 0.0 => return undefined(),
        ("POW", Some(other)) if value == 0.0 && other < 0.0 => return undefined(),
        ("POW", Some(other)) => value.powf(other),
        ("ABS", _) => value.abs(),
        ("ACOS" | "ASIN", _) if !(-1.0..=1.0).contains(&value) => return undefined(),
        ("ACOS", _) => value.acos().to_degrees(),
        ("ADP", _) => value,
        ("ASIN", _) => value.asin().to_degrees(),
        ("ATAN", _) => value.atan().to_degrees(),
        ("BCD", _) => return coded(value, 10, 16).map_or_else(undefined, Ok),
        ("BIN", _) => return coded(value, 16, 10).map_or_else(undefined, Ok),
        ("COS", _) => value.to_radians().cos(),
        ("EXP", _) => value.exp(),
        ("FIX", _) => value.trunc(),
        ("FUP", _) => value.abs().ceil().copysign(value),
        ("LN", _) if value <= 0.0 => return undefined(),
        ("LN", _) => value.ln(),
        ("ROUND", _) => {
            // Halves of decimals are below their half in binary as often as not.
            let steps = value / increment;
            (steps * (1.0 + f64::EPSILON)).round() * increment
        }
        ("SIN", _) => value.to_radians().sin(),
        ("SQRT" | "SQR", _) if value < 0.0 => return undefined(),
        ("SQRT" | "SQR", _) => value.sqrt(),
        _ => value.to_radians().tan(),
    };
    finite(name, result)
}

/// Digits of base `from` as digits of base `to`.
fn coded(value: f64, from: u32, to: u32) -> Option<f64> {
    let mut rest = bits(value).filter(|_| value >= 0.0)?;
    let (mut result, mut weight) = (0.0, 1.0);
    for _ in 0..DIGITS {
        let digit = rest % from;
        if digit > 9 {
            return None;
        }
        result += f64::from(digit) * weight;
        weight *= f64::from(to);
        rest /= from;
    }
    (rest == 0).then_some(result)
}

/// Null as 0.
pub(crate) fn number(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value }
}

fn finite(function: &'static str, value: f64) -> Result<f64, ArithmeticError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(ArithmeticError::Overflow { function })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fanuc::value::{Evaluator, NULL, Variables};

    struct Given;

    impl Variables for Given {
        fn value(&self, number: u32) -> Result<f64, ArithmeticError> {
            Ok(match number {
                0 | 9 => NULL,
                _ => f64::from(number) + 0.5,
            })
        }
    }

    fn value(text: &str) -> f64 {
        let mut evaluator = Evaluator::new(text.as_bytes(), 0, &Given);
        match evaluator.expression() {
            Ok(value) if evaluator.at == text.len() => value,
            other => panic!("{text}: {other:?} at {}", evaluator.at),
        }
    }

    fn refused(text: &str) -> bool {
        Evaluator::new(text.as_bytes(), 0, &Given)
            .expression()
            .is_err()
    }

    #[test]
    fn operators_bind_as_macro_b_has_it() {
        for (text, expected) in [
            ("2+3*4", 14.0),
            ("[2+3]*4", 20.0),
            ("-2*3", -6.0),
            ("#1+#2*2", 6.5),
            ("#[#[1-1]+1]", 1.5),
            ("7 MOD 4", 3.0),
            ("-7 MOD 4", -3.0),
            ("12 AND 10", 8.0),
            ("12 OR 3", 15.0),
            ("12 XOR 10", 6.0),
            ("1 EQ 1", 1.0),
            ("[1 LT 2] AND [2 GT 3]", 0.0),
            ("2*SIN[30.]", 1.0),
        ] {
            assert!(
                (value(text) - expected).abs() < 1e-12,
                "{text}: {}",
                value(text)
            );
        }
        for text in [
            "1/0", "5 MOD 0", "SQRT[-1]", "ASIN[2]", "[1", "FOO[1]", "1+", "PRM[5]", "POW[1]",
        ] {
            assert!(refused(text), "{text}");
        }
    }

    #[test]
    fn functions_round_as_the_manuals_say() {
        for (text, expected) in [
            ("ROUND[2.5]", 3.0),
            ("ROUND[-2.5]", -3.0),
            ("FIX[-1.7]", -1.0),
            ("FUP[-1.2]", -2.0),
            ("FUP[1.2]", 2.0),
            ("ATAN[1]/[-1]", 135.0),
            ("ATAN[-1]/[1]", 315.0),
            ("ATAN[-1,0]", 270.0),
            ("ATAN[1]", 45.0),
            ("ATAN[1]/2", 22.5),
            ("BCD[25]", 37.0),
            ("BIN[37]", 25.0),
            ("POW[2,10]", 1024.0),
            ("LN[EXP[2]]", 2.0),
            ("SQR[16]", 4.0),
        ] {
            assert!(
                (value(text) - expected).abs() < 1e-12,
                "{text}: {}",
                value(text)
            );
        }
        let mut words = Evaluator::new(b"ROUND[1.0005]", 0, &Given).rounding_to(0.001);
        assert!(
            (words.value().unwrap_or(0.0) - 1.001).abs() < 1e-12,
            "increment"
        );
    }

    #[test]
    fn null_is_nothing_but_itself_and_counts_as_0() {
        for (text, expected) in [
            ("#0 EQ #9", 1.0),
            ("#0 EQ 0", 0.0),
            ("#0 NE 0", 1.0),
            ("#0 GE 0", 1.0),
            ("#0 GT 0", 0.0),
            ("#0 LE 0", 1.0),
            ("#0+#0", 0.0),
            ("#0*5+2", 2.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-12, "{text}");
        }
        assert!(
            value("#0").is_nan() && value("[-#9]").is_nan(),
            "null stays null"
        );
    }
}
