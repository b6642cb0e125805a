//! Obeys statements of macro B: `IF`, `WHILE`, `GOTO`, `DO`, `END`, and variables that get a value.
//!
//! Source: the chapter on custom macros of the operator's manuals of FANUC and Haas. Not here: calls.

use crate::error::Fault;
use crate::error::arithmetic::ArithmeticError;
use crate::error::flow::FlowError;
use crate::error::reason::Reason;
use crate::fanuc::Fanuc;
use crate::fanuc::labels::blanks;
use crate::fanuc::memory::{Scope, Written};
use crate::fanuc::value::Evaluator;
use crate::fanuc::words::{comment, nothing_behind, stray};
use crate::program::Program;
use crate::text::place::Span;
use std::io::BufRead;

/// Loops have numbers from 1 to this.
const MAX_LOOPS: u32 = 3;

/// Largest number of a block.
const LARGEST_BLOCK: u32 = 99_999_999;

/// Longest text of an alarm that is told, bytes.
const LONGEST_ALARM: usize = 120;

impl Fanuc {
    /// Obeys what stands at a place of a line.
    pub(crate) fn statement<R: BufRead>(
        &mut self,
        text: &[u8],
        at: usize,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let mut at = blanks(text, at);
        let mut end = letters(text, at);
        let mut keyword = text[at..end].to_ascii_uppercase();
        // IF may stand before IF.
        while keyword == b"IF" {
            program.block.features |= crate::block::PARAMETERS;
            let start = at;
            let (value, behind) = self.condition(text, at, end, program)?;
            at = blanks(text, behind);
            end = letters(text, at);
            if at >= text.len() {
                let span = Span::new(start, behind);
                return Err(Fault::new(span, FlowError::ConditionAlone.into()));
            }
            if value == 0.0 || value.is_nan() {
                return Ok(());
            }
            keyword = text[at..end].to_ascii_uppercase();
            if keyword == b"THEN" {
                at = blanks(text, end);
                end = letters(text, at);
                keyword = text[at..end].to_ascii_uppercase();
            }
            if at >= text.len() {
                let span = Span::new(start, at);
                return Err(Fault::new(span, FlowError::ConditionAlone.into()));
            }
        }
        let span = Span::new(at, end);
        match keyword.as_slice() {
            b"GOTO" => {
                let (number, behind) = self.number(text, end, span, program, LARGEST_BLOCK)?;
                nothing_follows(text, behind)?;
                let jump = self.course.jump(&mut program.flow, number);
                jump.map_err(|reason| Fault::new(Span::new(at, behind), reason))
            }
            b"WHILE" => {
                program.block.features |= crate::block::PARAMETERS;
                let (value, behind) = self.condition(text, at, end, program)?;
                let next = blanks(text, behind);
                let next_end = letters(text, next);
                if !text[next..next_end].eq_ignore_ascii_case(b"DO") {
                    return Err(Fault::new(span, FlowError::WhileWithoutDo.into()));
                }
                let holds = !(value == 0.0 || value.is_nan());
                self.begin_loop(text, next_end, span, holds, program)
            }
            b"DO" => self.begin_loop(text, end, span, true, program),
            b"END" => {
                let (number, behind) = self.number(text, end, span, program, MAX_LOOPS)?;
                nothing_follows(text, behind)?;
                let outcome = self.course.end_loop(number);
                outcome.map_err(|reason| Fault::new(Span::new(at, behind), reason))
            }
            b"POPEN" | b"PCLOS" | b"DPRNT" | b"BPRNT" | b"SETVN" => {
                let word = String::from_utf8_lossy(&keyword).into_owned();
                self.note(&word, "output of the control", span, program);
                Ok(())
            }
            b"ELSE" | b"ENDIF" | b"THEN" => {
                let word = String::from_utf8_lossy(&keyword).into();
                Err(Fault::new(span, Reason::UnknownWord { word }))
            }
            _ if text.get(at) == Some(&b'#') => self.assign(text, at, program),
            _ => self.block(text, at, program),
        }
    }

    /// The value of a condition behind its keyword, and where it ends.
    fn condition<R: BufRead>(
        &self,
        text: &[u8],
        start: usize,
        at: usize,
        program: &Program<R>,
    ) -> Result<(f64, usize), Fault> {
        let scope = self.scope(program);
        let mut evaluator = Evaluator::new(text, at, &scope);
        evaluator.skip_blanks();
        if evaluator.peek() != Some(b'[') {
            return Err(Fault::new(
                Span::new(start, at),
                FlowError::ConditionMissing.into(),
            ));
        }
        let value = evaluator.expression()?;
        Ok((value, evaluator.at))
    }

    pub(crate) fn scope<'a, R>(&'a self, program: &'a Program<R>) -> Scope<'a> {
        Scope {
            memory: &self.memory,
            state: &program.lowering,
        }
    }

    /// The whole number from 1 on behind a keyword, and where it ends.
    fn number<R: BufRead>(
        &self,
        text: &[u8],
        at: usize,
        keyword: Span,
        program: &Program<R>,
        most: u32,
    ) -> Result<(u32, usize), Fault> {
        let scope = self.scope(program);
        let mut evaluator = Evaluator::new(text, at, &scope);
        evaluator.skip_blanks();
        if !matches!(evaluator.peek(), Some(b'0'..=b'9' | b'#' | b'[')) {
            let reason = FlowError::NumberMissing { most };
            return Err(Fault::new(keyword, reason.into()));
        }
        let value = evaluator.value()?;
        let behind = evaluator.at;
        let nearest = value.round();
        if !(1.0..=f64::from(most)).contains(&nearest) || (value - nearest).abs() > 1e-4 {
            let reason = Reason::NotWhole {
                quantity: if most == MAX_LOOPS {
                    "number of a loop"
                } else {
                    "number of a block"
                },
                value: super::functions::number(value),
                least: 1,
                most,
            };
            return Err(Fault::new(Span::new(at, behind), reason));
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and within the bounds checked above"
        )]
        Ok((nearest as u32, behind))
    }

    fn begin_loop<R: BufRead>(
        &mut self,
        text: &[u8],
        at: usize,
        keyword: Span,
        runs: bool,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let (number, behind) = self.number(text, at, keyword, program, MAX_LOOPS)?;
        nothing_follows(text, behind)?;
        let outcome = self.course.enter_loop(&mut program.flow, number, runs);
        outcome.map_err(|reason| Fault::new(keyword, reason))
    }

    /// Variables that get a value, one after the other.
    fn assign<R: BufRead>(
        &mut self,
        text: &[u8],
        mut at: usize,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        program.block.features |= crate::block::PARAMETERS;
        loop {
            let start = at;
            let scope = self.scope(program);
            let mut evaluator = Evaluator::new(text, at, &scope);
            let variable = evaluator.variable()?;
            evaluator.skip_blanks();
            if evaluator.peek() != Some(b'=') {
                let span = Span::new(start, evaluator.at);
                return Err(Fault::new(span, ArithmeticError::NotAssigned.into()));
            }
            evaluator.at += 1;
            let value = evaluator.expression()?;
            at = evaluator.at;
            let span = Span::new(start, at);
            let written = self.memory.set(variable, value, &mut program.lowering);
            match written.map_err(|reason| Fault::new(span, reason.into()))? {
                Written::Done => {}
                Written::Alarm => {
                    let number = super::functions::number(value);
                    let text = message(text, at);
                    return Err(Fault::new(span, FlowError::Alarm { number, text }.into()));
                }
                Written::Stop => {
                    let rest = program.lowering.rest(0.0, span)?;
                    program.lowering.emit(rest, &mut program.waiting)?;
                }
                Written::Noted(what) => self.note(&format!("#{variable}"), what, span, program),
            }
            at = blanks(text, at);
            if text.get(at) != Some(&b'#') {
                return nothing_follows(text, at);
            }
        }
    }

    /// Gives a variable its value before the program begins.
    pub(crate) fn give(
        &mut self,
        variable: u32,
        value: f64,
        state: &mut crate::interpreter::Interpreter,
    ) -> Result<(), ArithmeticError> {
        match self.memory.set(variable, value, state)? {
            Written::Alarm | Written::Stop => {
                Err(ArithmeticError::NotWritable { number: variable })
            }
            Written::Done | Written::Noted(_) => Ok(()),
        }
    }

    /// Says once that a word is of no effect on the motion.
    pub(crate) fn note<R: BufRead>(
        &mut self,
        word: &str,
        what: &'static str,
        span: Span,
        program: &mut Program<R>,
    ) {
        if self.noted.insert(word.into()) {
            let word = word.into();
            let notice = crate::error::Notice::Noted { word, what };
            program.remarks.push((span, notice));
        }
    }
}

/// Where the letters that begin at a place end.
fn letters(text: &[u8], from: usize) -> usize {
    let rest = text.get(from..).unwrap_or_default();
    let length = rest.iter().position(|byte| !byte.is_ascii_alphabetic());
    from + length.unwrap_or(rest.len())
}

/// Refuses what stands behind a statement; a remark may.
fn nothing_follows(text: &[u8], at: usize) -> Result<(), Fault> {
    let mut at = blanks(text, at);
    while text.get(at) == Some(&b'(') {
        at = blanks(text, comment(text, at)?);
    }
    match text.get(at) {
        None => Ok(()),
        Some(b';') => nothing_behind(text, at),
        Some(byte) if byte.is_ascii_alphanumeric() || *byte == b'[' => {
            let span = Span::new(at, text.len());
            Err(Fault::new(span, FlowError::BehindStatement.into()))
        }
        Some(_) => Err(stray(text, at)),
    }
}

/// The remark behind an alarm.
fn message(text: &[u8], at: usize) -> Box<str> {
    let rest = text.get(at..).unwrap_or_default();
    let begin = rest.iter().position(|&byte| byte == b'(');
    let inside = begin.map_or(&rest[..0], |begin| &rest[begin + 1..]);
    let end = inside.iter().position(|&byte| byte == b')');
    let inside = &inside[..end.unwrap_or(inside.len()).min(LONGEST_ALARM)];
    String::from_utf8_lossy(inside).trim().into()
}
