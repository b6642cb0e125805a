//! Parses lines that begin with an O word.
//!
//! Source: the chapter on O codes of the manual of LinuxCNC. Not here: carrying it out.

use crate::error::Fault;
use crate::error::flow::FlowError;
use crate::expression::Evaluator;
use crate::expression::parameters::Values;
use crate::text::place::Span;
use std::fmt;

/// What stands behind a label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keyword {
    Sub,
    EndSub,
    Call,
    Return,
    If,
    ElseIf,
    Else,
    EndIf,
    While,
    EndWhile,
    Do,
    Repeat,
    EndRepeat,
    Break,
    Continue,
}

impl Keyword {
    /// Longer ones before those that they begin with.
    const ALL: [Self; 15] = [
        Self::EndSub,
        Self::Sub,
        Self::Call,
        Self::Return,
        Self::EndIf,
        Self::ElseIf,
        Self::Else,
        Self::If,
        Self::EndWhile,
        Self::While,
        Self::Do,
        Self::EndRepeat,
        Self::Repeat,
        Self::Break,
        Self::Continue,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Sub => "SUB",
            Self::EndSub => "ENDSUB",
            Self::Call => "CALL",
            Self::Return => "RETURN",
            Self::If => "IF",
            Self::ElseIf => "ELSEIF",
            Self::Else => "ELSE",
            Self::EndIf => "ENDIF",
            Self::While => "WHILE",
            Self::EndWhile => "ENDWHILE",
            Self::Do => "DO",
            Self::Repeat => "REPEAT",
            Self::EndRepeat => "ENDREPEAT",
            Self::Break => "BREAK",
            Self::Continue => "CONTINUE",
        }
    }
}

/// A line that begins with an O word.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Control {
    pub(crate) label: Label,
    pub(crate) keyword: Keyword,
    /// The O word with its keyword.
    pub(crate) span: Span,
    /// Where the line goes on.
    pub(crate) rest: usize,
}

/// Name of a subroutine or a block.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Label {
    Number(u32),
    Name(Box<str>),
}

impl fmt::Display for Label {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(out, "O{number}"),
            Self::Name(name) => write!(out, "O<{name}>"),
        }
    }
}

impl Label {
    /// Name of the file that may hold the subroutine, without its ending.
    pub(crate) fn file(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Name(name) => name.to_string(),
        }
    }
}

/// Where the O of a line stands, if it begins with one; a line number may stand before it.
pub(crate) fn o_word(line: &[u8]) -> Option<usize> {
    let mut at = skip(line, 0, |byte| matches!(byte, b' ' | b'\t'));
    if let Some(b'N' | b'n') = line.get(at) {
        at = skip(line, at + 1, |byte| {
            matches!(byte, b'0'..=b'9' | b'.' | b' ' | b'\t')
        });
    }
    matches!(line.get(at), Some(b'O' | b'o')).then_some(at)
}

/// Reads a line with an O word at `at`; none for the mere number of a program.
pub(crate) fn control(
    line: &[u8],
    at: usize,
    values: &dyn Values,
) -> Result<Option<Control>, Fault> {
    let mut reader = Evaluator::new(line, at + 1, values);
    reader.skip_blanks();
    let missing = || Fault::new(Span::new(at, at + 1), FlowError::LabelMissing.into());
    let label = match reader.peek() {
        Some(b'<') => Label::Name(reader.name()?),
        Some(b'0'..=b'9') => {
            let end = skip(line, reader.at, |byte| byte.is_ascii_digit());
            let digits = std::str::from_utf8(&line[reader.at..end]).unwrap_or_default();
            reader.at = end;
            Label::Number(digits.parse().map_err(|_| missing())?)
        }
        Some(b'#' | b'[') => {
            let value = reader.value()?.round();
            if !(0.0..=f64::from(u32::MAX)).contains(&value) {
                return Err(missing());
            }
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "whole and within the bounds checked above"
            )]
            Label::Number(value as u32)
        }
        _ => return Err(missing()),
    };
    reader.skip_blanks();
    let start = reader.at;
    match reader.peek() {
        None | Some(b'(' | b';') => return Ok(None),
        _ => {}
    }
    let rest = &line[start..];
    let stands = |keyword: &Keyword| {
        let name = keyword.name().as_bytes();
        let here = rest.get(..name.len());
        here.is_some_and(|here| here.eq_ignore_ascii_case(name))
    };
    let Some(keyword) = Keyword::ALL.into_iter().find(stands) else {
        let end = start + skip(rest, 0, |byte| byte.is_ascii_alphabetic()).max(1);
        return Err(Fault::new(
            Span::new(start, end),
            FlowError::UnknownKeyword.into(),
        ));
    };
    let end = start + keyword.name().len();
    Ok(Some(Control {
        label,
        keyword,
        span: Span::new(at, end),
        rest: end,
    }))
}

impl Control {
    /// The expressions in brackets that follow; a comment may stand behind them.
    pub(crate) fn arguments(
        &self,
        line: &[u8],
        values: &dyn Values,
        into: &mut Vec<f64>,
    ) -> Result<(), Fault> {
        into.clear();
        let mut reader = Evaluator::new(line, self.rest, values);
        loop {
            reader.skip_blanks();
            match reader.peek() {
                Some(b'[') => into.push(reader.brackets()?),
                None | Some(b'(' | b';') => return Ok(()),
                Some(_) => {
                    let span = Span::new(reader.at, line.len());
                    return Err(Fault::new(span, FlowError::Trailing.into()));
                }
            }
        }
    }

    /// The one expression that must follow.
    pub(crate) fn argument(&self, line: &[u8], values: &dyn Values) -> Result<f64, Fault> {
        let mut list = Vec::new();
        self.arguments(line, values, &mut list)?;
        match list[..] {
            [value] => Ok(value),
            [] => {
                let keyword = self.keyword.name();
                Err(self.fault(FlowError::ExpressionMissing { keyword }))
            }
            [_, ..] => Err(self.fault(FlowError::Trailing)),
        }
    }

    pub(crate) fn fault(&self, reason: FlowError) -> Fault {
        Fault::new(self.span, reason.into())
    }

    /// A refusal because this keyword stands where its block is not open.
    pub(crate) fn not_open(&self, opening: &'static str) -> Fault {
        self.fault(FlowError::NotOpen {
            keyword: self.keyword.name(),
            label: self.label.to_string().into(),
            opening,
        })
    }
}

/// The number of a line that has an O word and nothing else: the beginning of a program.
pub(crate) fn bare_number(line: &[u8]) -> Option<u32> {
    let start = o_word(line)? + 1;
    let end = skip(line, start, |byte| byte.is_ascii_digit());
    let behind = skip(line, end, |byte| matches!(byte, b' ' | b'\t'));
    let alone = matches!(line.get(behind), None | Some(b'(' | b';'));
    let digits = std::str::from_utf8(&line[start..end]).ok()?;
    digits.parse().ok().filter(|_| alone)
}

/// Only the label and the keyword of a line, for lines that are passed over.
pub(crate) fn glance(line: &[u8], label: &Label) -> Option<Keyword> {
    let at = o_word(line)?;
    let control = control(line, at, &NoValues).ok()??;
    (control.label == *label).then_some(control.keyword)
}

/// While lines are passed over, nothing has a value.
pub(crate) struct NoValues;

impl Values for NoValues {
    fn numbered(&self, _: u32) -> f64 {
        f64::NAN
    }

    fn named(&self, _: &str) -> Option<f64> {
        None
    }
}

fn skip(line: &[u8], from: usize, pass: impl Fn(u8) -> bool) -> usize {
    let rest = line.get(from..).unwrap_or_default();
    let length = rest.iter().position(|&byte| !pass(byte));
    from + length.unwrap_or(rest.len())
}
