//! Reads one line after the other: leader, `%`, program and block numbers, and what follows them.
//!
//! Not here: statements, see `statements`, and words, see `block`.

use crate::error::flow::FlowError;
use crate::error::reason::Reason;
use crate::error::{Fault, Notice};
use crate::fanuc::Fanuc;
use crate::fanuc::course::Next;
use crate::fanuc::labels::{blanks, digits, program_number};
use crate::program::Program;
use crate::text::lexer::check_text;
use crate::text::place::Span;
use std::io::BufRead;

impl Fanuc {
    /// Reads the next line and does what it says.
    pub(crate) fn line<R: BufRead>(&mut self, program: &mut Program<R>) -> Result<(), Fault> {
        if !std::mem::replace(&mut self.started, true) {
            let leader = self.course.skip_leader(&mut program.flow);
            leader.map_err(|reason| program.unreadable(reason))?;
        }
        match self.course.advance(&mut program.flow) {
            Ok(Next::Line) => {}
            Ok(Next::EndOfFile) => {
                if let Some(number) = self.running() {
                    program.past_refusals = false;
                    return Err(Fault::new(
                        Span::default(),
                        FlowError::NoReturn { number }.into(),
                    ));
                }
                return program.end();
            }
            Err(reason) => return Err(program.unreadable(reason)),
        }
        let mut text = std::mem::take(&mut self.text);
        text.clear();
        text.extend_from_slice(program.flow.text());
        let outcome = self.obey(&text, program);
        self.text = text;
        outcome
    }

    /// The number of the subprogram that runs; none in the main program.
    fn running(&self) -> Option<u32> {
        let frame = self.course.frames.last();
        frame
            .filter(|_| !self.course.in_main())
            .map(|frame| frame.number)
    }

    fn obey<R: BufRead>(&mut self, text: &[u8], program: &mut Program<R>) -> Result<(), Fault> {
        check_text(text, 0)?;
        program.lowering.line = program.flow.line();
        let mut at = blanks(text, 0);
        if text.get(at) == Some(&b'%') {
            let numbered = program_number(text).is_some();
            if !numbered && blanks(text, at + 1) < text.len() {
                return Err(Fault::new(Span::new(at, at + 1), Reason::PercentNotAlone));
            }
            if self.opened || self.begun {
                return self.end_of_text(program);
            }
            self.opened = true;
            at = blanks(text, at + 1);
        }
        if let Some(number) = program_number(text) {
            if self.course.is_first() || self.course.in_main() && !self.begun {
                if self.course.in_main() && !self.begun {
                    self.course.begin_main(number);
                }
            } else {
                let span = Span::new(at, text.len());
                if self.course.in_main() {
                    program.remarks.push((span, Notice::NextProgram { number }));
                }
                return self.end_of_text(program);
            }
            self.begun = true;
            self.memory.set_letter(b'O', f64::from(number));
            at = blanks(text, at + 1);
            at = digits(text, at).map_or(at, |(_, end)| end);
        }
        self.statement_line(text, at, program)
    }

    /// The rest of a line behind its program number.
    fn statement_line<R: BufRead>(
        &mut self,
        text: &[u8],
        at: usize,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let mut at = blanks(text, at);
        while matches!(text.get(at), Some(b'N' | b'n')) {
            let number = blanks(text, at + 1);
            let Some((number, end)) = digits(text, number) else {
                let letter = 'N';
                let span = Span::new(at, at + 1);
                return Err(Fault::new(span, Reason::NumberMissing { letter }));
            };
            self.memory.set_letter(b'N', f64::from(number));
            at = blanks(text, end);
        }
        match text.get(at) {
            None | Some(b'/') => return Ok(()),
            Some(b';') => return super::words::nothing_behind(text, at),
            Some(_) => {}
        }
        let only_remark = text[at] == b'(' && {
            let end = super::words::comment(text, at)?;
            blanks(text, end) >= text.len()
        };
        if only_remark {
            return Ok(());
        }
        self.begun = true;
        program.blocks += 1;
        self.statement(text, at, program)
    }

    /// The program that runs ends without a word about it.
    fn end_of_text<R: BufRead>(&mut self, program: &mut Program<R>) -> Result<(), Fault> {
        if let Some(number) = self.running() {
            program.past_refusals = false;
            return Err(Fault::new(
                Span::default(),
                FlowError::NoReturn { number }.into(),
            ));
        }
        program.end()
    }
}
