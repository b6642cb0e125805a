//! Names every fault of subroutines, loops and conditions.
//!
//! Not here: words and codes, see [`Reason`](crate::Reason).

use thiserror::Error;

/// Why an O word is refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FlowError {
    /// An O word without a label.
    #[error("O needs a number, or a name in angle brackets, after it")]
    LabelMissing,
    /// An O word with something unknown behind its label.
    #[error(
        "not known after a label: write SUB, ENDSUB, CALL, RETURN, IF, ELSEIF, ELSE, ENDIF, WHILE, ENDWHILE, DO, REPEAT, ENDREPEAT, BREAK or CONTINUE"
    )]
    UnknownKeyword,
    /// A keyword without its expression.
    #[error("{keyword} needs an expression in brackets after it")]
    ExpressionMissing {
        /// The keyword.
        keyword: &'static str,
    },
    /// Something behind the end of an O word.
    #[error("nothing may follow here on the line of an O word")]
    Trailing,
    /// The end or the middle of a block that was not begun.
    #[error("{keyword} of {label} without its {opening}")]
    NotOpen {
        /// The keyword.
        keyword: &'static str,
        /// The label.
        label: Box<str>,
        /// What would have to stand before it.
        opening: &'static str,
    },
    /// A block without its end.
    #[error("{keyword} of {label} is not closed: {closing} is missing")]
    NotClosed {
        /// The keyword.
        keyword: &'static str,
        /// The label.
        label: Box<str>,
        /// What is missing.
        closing: &'static str,
    },
    /// A call of a subroutine that nobody has written.
    #[error("there is no subroutine {label}: neither in this program nor in a file of that name")]
    NoSubroutine {
        /// The label.
        label: Box<str>,
    },
    /// A call of a subprogram that does not stand below.
    #[error("there is no subprogram O{number} below this line")]
    NoSubprogram {
        /// Its number.
        number: u32,
    },
    /// A subprogram without its end.
    #[error("subprogram O{number} ends without M99")]
    NoReturn {
        /// Its number.
        number: u32,
    },
    /// `M99` where no subprogram runs.
    #[error("M99 outside a subprogram would begin the program again, without end")]
    EndlessProgram,
    /// `M99` in a subroutine by O words.
    #[error("M99 does not end a subroutine; write ENDSUB or RETURN")]
    MixedReturn,
    /// A subroutine that is written twice.
    #[error("subroutine {label} was already defined in line {line}")]
    DefinedTwice {
        /// The label.
        label: Box<str>,
        /// Where.
        line: u64,
    },
    /// A jump to a line that is not there.
    #[error("there is no line {label} to jump to")]
    NoTarget {
        /// Its mark or its block number.
        label: Box<str>,
    },
    /// The end of a block that was not begun.
    #[error("{keyword} without its {opening}")]
    BlockNotOpen {
        /// The keyword.
        keyword: &'static str,
        /// What would have to stand before it.
        opening: &'static str,
    },
    /// A block without its end.
    #[error("{keyword} is not closed: {closing} is missing")]
    BlockNotClosed {
        /// The keyword.
        keyword: &'static str,
        /// What is missing.
        closing: &'static str,
    },
    /// A condition without an expression in brackets.
    #[error("a condition in brackets is missing, as in [#1 LT 5]")]
    ConditionMissing,
    /// `IF` with nothing behind its condition.
    #[error("nothing follows the condition: write GOTO, THEN or a statement")]
    ConditionAlone,
    /// `WHILE` without its `DO`.
    #[error("WHILE needs DO and a number behind its condition, as in DO1")]
    WhileWithoutDo,
    /// A keyword without its number.
    #[error("a whole number from 1 to {most} is missing here")]
    NumberMissing {
        /// Largest number.
        most: u32,
    },
    /// Something behind a statement of macro B.
    #[error("nothing may follow here: a statement stands alone on its line")]
    BehindStatement,
    /// A loop without its end.
    #[error(
        "DO{number} is not closed: END{number} is missing{}", 
        if *inner { " before the next loop of this number" } else { "" }
    )]
    LoopNotClosed {
        /// Number of the loop.
        number: u32,
        /// Whether another loop of its number begins first.
        inner: bool,
    },
    /// The end of a loop that does not run.
    #[error("END{number} of a loop that does not run: a loop is entered by its DO{number}")]
    LoopNotOpen {
        /// Number of the loop.
        number: u32,
    },
    /// The program ends itself with an alarm.
    #[error("the program raises its alarm {number}{}{text}", if text.is_empty() { "" } else { ": " })]
    Alarm {
        /// Number of the alarm.
        number: f64,
        /// Its text.
        text: Box<str>,
    },
    /// A call of a macro that is not there.
    #[error(
        "there is no macro O{number} in this file, nor a file of it beside the program{}",
        if (9800..9900).contains(number) { "; macros of this number measure with a probe, and what it touches is not known before" } else { "" }
    )]
    NoMacro {
        /// Its number.
        number: u32,
    },
    /// A file that should hold a subroutine, but does not.
    #[error("the file of subroutine {label} {message}")]
    BadFile {
        /// The label.
        label: Box<str>,
        /// What is wrong.
        message: Box<str>,
    },
    /// A subroutine inside a subroutine.
    #[error("a subroutine cannot be defined while another one runs")]
    NestedSubroutine,
    /// Subroutines that call each other without end.
    #[error("subroutines are called more than {bound} deep")]
    TooDeep {
        /// Largest depth.
        bound: usize,
    },
    /// More arguments than local parameters.
    #[error("a call has {given} arguments, but may have {bound} at most")]
    TooManyArguments {
        /// How many there are.
        given: usize,
        /// Most of them.
        bound: usize,
    },
    /// A loop that seems to have no end.
    #[error("more than {bound} lines of loops and subroutines were run; is this loop endless?")]
    TooManySteps {
        /// Most lines.
        bound: u64,
    },
    /// A loop that does nothing but count, or waits for what never comes.
    #[error(
        "more than {bound} lines of loops and subroutines were run without a move; is this loop endless?"
    )]
    NoMotion {
        /// Most lines without a move.
        bound: u64,
    },
    /// A loop that comes round with nothing changed.
    #[error(
        "this line is run again with nothing changed since the last time: the loop around it has no end"
    )]
    Endless,
    /// A subroutine or a loop longer than may be remembered.
    #[error("a loop or a subroutine is longer than {bound} bytes")]
    TooLong {
        /// Most bytes.
        bound: usize,
    },
    /// A loop that is repeated a number of times that cannot be.
    #[error("repetitions are {value}, but may be {most} at most")]
    BadRepetitions {
        /// The number.
        value: f64,
        /// Most repetitions.
        most: f64,
    },
}
