//! Names every fault of a parameter or an expression.
//!
//! Not here: words and codes, see [`Reason`](crate::Reason).

use thiserror::Error;

/// Why a parameter or an expression has no value.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ArithmeticError {
    /// Nothing that could be a value.
    #[error("a number, a parameter, a function or \"[\" is missing here")]
    ValueMissing,
    /// An opening bracket without its end.
    #[error("\"[\" is not closed: an operator or \"]\" is missing")]
    NotClosed,
    /// Something between two values that is no operator.
    #[error("no operator: write + - * / **, MOD, AND, OR, XOR, EQ, NE, GT, GE, LT or LE")]
    UnknownOperator,
    /// A word that is no function.
    #[error(
        "no function: write ABS, ACOS, ASIN, ATAN, COS, EXISTS, EXP, FIX, FUP, LN, ROUND, SIN, SQRT or TAN"
    )]
    UnknownFunction,
    /// A function without its argument in brackets.
    #[error("{function} needs its argument in brackets{hint}")]
    ArgumentMissing {
        /// Name of the function.
        function: &'static str,
        /// What else must be known about it.
        hint: &'static str,
    },
    /// A function or an operator outside its domain.
    #[error("{function} of {value} is not a number")]
    Undefined {
        /// Name of the function or the operator.
        function: &'static str,
        /// Its argument.
        value: f64,
    },
    /// A result beyond all floats.
    #[error("the result of {function} is too large")]
    Overflow {
        /// Name of the function or the operator.
        function: &'static str,
    },
    /// Brackets within brackets.
    #[error("expression is nested deeper than {bound} levels")]
    TooDeep {
        /// Largest depth.
        bound: u32,
    },
    /// A parameter that cannot be.
    #[error("parameter number is {value}, but must be a whole number from 1 to {most}")]
    NoSuchParameter {
        /// The number.
        value: f64,
        /// Largest number.
        most: u32,
    },
    /// A word that is no function of macro B.
    #[error(
        "no function: write ABS, ACOS, ASIN, ATAN, BCD, BIN, COS, EXP, FIX, FUP, LN, POW, ROUND, SIN, SQRT or TAN"
    )]
    UnknownMacroFunction,
    /// A variable that cannot be.
    #[error("number of a variable is {value}, but must be a whole number from 0 to {most}")]
    NoSuchVariable {
        /// The number.
        value: f64,
        /// Largest number.
        most: u32,
    },
    /// A variable whose value nobody knows before the machine runs.
    #[error("{name} is not known before the machine runs: {what}")]
    NotKnown {
        /// The variable.
        name: Box<str>,
        /// What it tells.
        what: &'static str,
    },
    /// A variable of the control that a program may not write here.
    #[error("variable #{number} is one of the control and cannot be set here")]
    NotWritable {
        /// The variable.
        number: u32,
    },
    /// A parameter that a program may read only.
    #[error("parameter #{number} says where the machine is and cannot be set")]
    ReadOnly {
        /// The parameter.
        number: u32,
    },
    /// A predefined parameter that a program may read only.
    #[error("parameter #<{name}> is predefined and cannot be set")]
    Predefined {
        /// The parameter.
        name: Box<str>,
    },
    /// A parameter that has no value yet.
    #[error("parameter #<{name}> has no value: {}", why_unset(name))]
    NeverSet {
        /// The parameter.
        name: Box<str>,
    },
    /// A name without its end, or without a character.
    #[error("a name stands between \"<\" and \">\", at most {most} characters")]
    BadName {
        /// Longest name.
        most: usize,
    },
    /// A parameter on a line of its own.
    #[error("\"=\" is missing after the parameter that begins here")]
    NotAssigned,
    /// More parameters than may be held.
    #[error("more than {bound} named parameters")]
    TooMany {
        /// Most of them.
        bound: usize,
    },
}

/// Why a parameter has no value.
fn why_unset(name: &str) -> &'static str {
    if name.starts_with("_hal[") || name.starts_with("_ini[") {
        "only the machine knows it; give it with --parameter NAME=VALUE"
    } else {
        "it was never set here"
    }
}
