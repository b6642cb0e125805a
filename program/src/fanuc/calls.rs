//! Calls subprograms and macros, and comes back from them.
//!
//! Source: `M97` `M98` `M99` and `G65` `G66` `G67` of the operator's manuals of FANUC and Haas. Not here: where a
//! program is found, see `course`.

use crate::error::Fault;
use crate::error::flow::FlowError;
use crate::error::reason::Reason;
use crate::fanuc::Fanuc;
use crate::fanuc::arguments::{ModalMacro, locals};
use crate::fanuc::block::word;
use crate::fanuc::codes::Machine;
use crate::fanuc::course::{Found, Kind};
use crate::fanuc::modes::whole;
use crate::fanuc::words::Word;
use crate::flow::subprograms::{LARGEST_NUMBER, MAX_REPETITIONS};
use crate::program::Program;
use crate::text::place::Span;
use std::io::BufRead;

/// Beyond this the digits of a `P` word before the last four are repetitions.
const FOUR_DIGITS: u32 = 10_000;

impl Fanuc {
    /// Obeys `M97`, `M98`, `M198` or `M99`, once their block is done.
    pub(crate) fn call<R: BufRead>(
        &mut self,
        which: Machine,
        span: Span,
        words: &[Word],
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        if which == Machine::Return {
            return self.come_back(span, words, program);
        }
        let Some(called) = word(words, b'P') else {
            let code = match which {
                Machine::CallBlock => 970,
                _ => 980,
            };
            let code = crate::block::code::Code::new(b'M', code);
            return Err(Fault::new(span, Reason::WordMissing { code, letter: 'P' }));
        };
        let number = whole(&called, "number of a subprogram", 0, LARGEST_NUMBER)?;
        let repetitions = word(words, b'L');
        let times = match &repetitions {
            Some(times) => whole(times, "repetitions", 0, MAX_REPETITIONS)?,
            None => 1,
        };
        let block = match word(words, b'Q') {
            Some(block) => Some(whole(&block, "number of a block", 1, LARGEST_NUMBER)?),
            None => None,
        };
        let at = |reason| Fault::new(called.span, reason);
        let kind = Kind::Subprogram;
        if which == Machine::CallBlock {
            if times == 0 {
                return Ok(());
            }
            let running = self.course.frames.last().map_or(0, |frame| frame.number);
            let this = self.course.this();
            let frame = (kind, running, times);
            let outcome = self
                .course
                .call(&mut program.flow, this, frame, Some(number));
            return outcome
                .map_err(at)
                .map(|()| program.lowering.enter_subprogram());
        }
        let outside = which == Machine::CallOutside;
        let mut found = self
            .course
            .find(&mut program.flow, number, outside)
            .map_err(at)?;
        let (mut own, mut times) = (number, times);
        if found.is_none() && repetitions.is_none() && number >= FOUR_DIGITS {
            // The repetitions stand before the four digits of the number.
            (own, times) = (number % FOUR_DIGITS, number / FOUR_DIGITS);
            found = self
                .course
                .find(&mut program.flow, own, outside)
                .map_err(at)?;
        }
        let found = found.ok_or_else(|| at(FlowError::NoSubprogram { number: own }.into()))?;
        if times == 0 {
            return Ok(());
        }
        let frame = (kind, own, times);
        let outcome = self.course.call(&mut program.flow, found, frame, block);
        outcome
            .map_err(at)
            .map(|()| program.lowering.enter_subprogram())
    }

    /// `M99`: back to the caller, or to one of its blocks.
    fn come_back<R: BufRead>(
        &mut self,
        span: Span,
        words: &[Word],
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let target = match word(words, b'P') {
            Some(block) => Some((
                whole(&block, "number of a block", 1, LARGEST_NUMBER)?,
                block.span,
            )),
            None => None,
        };
        if self.course.in_main() {
            let Some((block, span)) = target else {
                return Err(Fault::new(span, FlowError::EndlessProgram.into()));
            };
            let jump = self.course.jump(&mut program.flow, block);
            return jump.map_err(|reason| Fault::new(span, reason));
        }
        if self.course.repeat() {
            let kind = self.course.frames.last().map(|frame| frame.kind);
            if kind == Some(Kind::Macro)
                && let (Some(level), Some(arguments)) =
                    (self.memory.locals.last_mut(), self.arguments.last())
            {
                *level = *arguments;
            }
            return Ok(());
        }
        if let Some(frame) = self.course.frames.pop() {
            program.lowering.leave_subprogram();
            if frame.kind != Kind::Subprogram {
                let left = self.memory.locals.pop();
                self.arguments.pop();
                if frame.kind == Kind::Modal
                    && let (Some(modal), Some(left)) = (&mut self.modal_macro, left)
                {
                    modal.locals = left;
                }
            }
        }
        match target {
            Some((block, span)) => {
                let jump = self.course.jump(&mut program.flow, block);
                jump.map_err(|reason| Fault::new(span, reason))
            }
            None => Ok(()),
        }
    }

    /// `G65` and `G66`, with the words behind them.
    pub(crate) fn call_macro<R: BufRead>(
        &mut self,
        words: &[Word],
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let Some(code) = words.first() else {
            return Ok(());
        };
        let tenths = (code.value * 10.0).round();
        let modal = tenths > 655.0;
        let code_of = crate::block::code::Code::of_number(b'G', code.value, 1);
        if (tenths - 650.0).abs() > 0.5 && (tenths - 660.0).abs() > 0.5 {
            let what = "macros called by every block, with arguments of its own";
            let reason = match code_of {
                Some(code) => Reason::NotSupported { code, what },
                None => Reason::NotACode {
                    letter: 'G',
                    value: code.value,
                    bound: "a number from 0 to 999 with one decimal at most",
                },
            };
            return Err(Fault::new(code.span, reason));
        }
        let Some(called) = word(words, b'P') else {
            let code_of = code_of.unwrap_or(crate::block::code::Code::letter(b'G'));
            let reason = Reason::WordMissing {
                code: code_of,
                letter: 'P',
            };
            return Err(Fault::new(code.span, reason));
        };
        if let Some(other) = words[1..].iter().find(|word| word.letter == b'G') {
            let letter = 'G';
            return Err(Fault::new(other.span, Reason::Repeated { letter }));
        }
        let number = whole(&called, "number of a macro", 0, LARGEST_NUMBER)?;
        let times = match word(words, b'L') {
            Some(times) => whole(&times, "repetitions", 0, MAX_REPETITIONS)?,
            None => 1,
        };
        let locals = locals(words)?;
        let found = self.find_macro(number, called.span, program)?;
        if !modal {
            return self.run_macro(
                (Kind::Macro, number, times),
                found,
                locals,
                called.span,
                program,
            );
        }
        if self.modal_macro.is_some() {
            let word = "G66".into();
            let what = "a modal macro within another; G67 ends it";
            return Err(Fault::new(
                code.span,
                Reason::WordNotSupported { word, what },
            ));
        }
        self.memory.groups[12] = 66.0;
        self.modal_macro = Some(ModalMacro {
            number,
            times,
            locals,
        });
        Ok(())
    }

    fn find_macro<R: BufRead>(
        &mut self,
        number: u32,
        span: Span,
        program: &mut Program<R>,
    ) -> Result<Found, Fault> {
        let found = self.course.find(&mut program.flow, number, false);
        let found = found.map_err(|reason| Fault::new(span, reason))?;
        found.ok_or_else(|| Fault::new(span, FlowError::NoMacro { number }.into()))
    }

    fn run_macro<R: BufRead>(
        &mut self,
        frame: (Kind, u32, u32),
        found: Found,
        locals: crate::fanuc::memory::Locals,
        span: Span,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        if frame.2 == 0 {
            return Ok(());
        }
        let outcome = self.course.call(&mut program.flow, found, frame, None);
        outcome.map_err(|reason| Fault::new(span, reason))?;
        self.memory.locals.push(locals);
        self.arguments.push(locals);
        program.lowering.enter_subprogram();
        Ok(())
    }

    /// Calls the macro of `G66` after a motion, but not from within it.
    pub(crate) fn call_modal<R: BufRead>(&mut self, program: &mut Program<R>) -> Result<(), Fault> {
        let within = self
            .course
            .frames
            .iter()
            .any(|frame| frame.kind == Kind::Modal);
        let Some(modal) = self.modal_macro.clone().filter(|_| !within) else {
            return Ok(());
        };
        let span = Span::default();
        let found = self.find_macro(modal.number, span, program)?;
        let frame = (Kind::Modal, modal.number, modal.times);
        self.run_macro(frame, found, modal.locals, span, program)
    }

    /// `G67`.
    pub(crate) fn end_modal_macro(&mut self) {
        self.memory.groups[12] = 67.0;
        self.modal_macro = None;
    }
}
