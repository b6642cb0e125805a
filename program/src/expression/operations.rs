//! Implements the operators and functions of expressions.
//!
//! Source: RS274/NGC and the manual of LinuxCNC; angles are in degrees. Not here: how they bind.

use crate::error::arithmetic::ArithmeticError;

/// Numbers nearer than this are equal for `EQ`, `NE`, `GE` and `LE`, as they are for LinuxCNC.
const EQUAL: f64 = 1e-4;

pub(crate) fn operate(name: &'static str, left: f64, right: f64) -> Result<f64, ArithmeticError> {
    let undefined = |function, value| Err(ArithmeticError::Undefined { function, value });
    let equal = (left - right).abs() < EQUAL;
    let (first, second) = (left != 0.0, right != 0.0);
    let value = match name {
        "AND" => truth(first && second),
        "OR" => truth(first || second),
        "XOR" => truth(first != second),
        "EQ" => truth(equal),
        "NE" => truth(!equal),
        "GT" => truth(left > right),
        "GE" => truth(left >= right),
        "LT" => truth(left < right),
        "LE" => truth(left <= right),
        "+" => left + right,
        "-" => left - right,
        "*" => left * right,
        "/" if second => left / right,
        "/" => return undefined("division by zero", left),
        "MOD" if second => {
            let rest = left % right;
            if rest < 0.0 { rest + right.abs() } else { rest }
        }
        "MOD" => return undefined("MOD by zero", left),
        _ if left < 0.0 && right.fract() != 0.0 => return undefined("a broken power", left),
        _ if left == 0.0 && right < 0.0 => return undefined("a negative power", left),
        _ => left.powf(right),
    };
    finite(name, value)
}

pub(crate) fn apply(name: &'static str, argument: f64) -> Result<f64, ArithmeticError> {
    let undefined = || {
        Err(ArithmeticError::Undefined {
            function: name,
            value: argument,
        })
    };
    let value = match name {
        "ABS" => argument.abs(),
        "ACOS" | "ASIN" if !(-1.0..=1.0).contains(&argument) => return undefined(),
        "ACOS" => argument.acos().to_degrees(),
        "ASIN" => argument.asin().to_degrees(),
        "COS" => argument.to_radians().cos(),
        "EXP" => argument.exp(),
        "FIX" => argument.floor(),
        "FUP" => argument.ceil(),
        "LN" if argument <= 0.0 => return undefined(),
        "LN" => argument.ln(),
        "ROUND" => argument.round(),
        "SIN" => argument.to_radians().sin(),
        "SQRT" if argument < 0.0 => return undefined(),
        "SQRT" => argument.sqrt(),
        _ => argument.to_radians().tan(),
    };
    finite(name, value)
}

fn finite(function: &'static str, value: f64) -> Result<f64, ArithmeticError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(ArithmeticError::Overflow { function })
    }
}

pub(crate) fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}
