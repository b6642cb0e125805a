//! Streams a part program as moves.
//!
//! Not here: the language, see the crate.

pub(crate) mod setup;
pub(crate) mod state;
pub(crate) mod statistics;

use crate::block::codes::{Group, Subprogram};
use crate::block::{Block, O_WORDS};
use crate::error::cascading_errors::CascadingErrors;
use crate::error::reason::Reason;
use crate::error::{Fault, ProgramError, Remark, Warning};
use crate::fanuc::{Fanuc, explained};
use crate::flow::Flow;
use crate::flow::control::o_word;
use crate::flow::subprograms::{LARGEST_NUMBER, MAX_REPETITIONS};
use crate::interpreter::Interpreter;
use crate::interpreter::modal::whole;
use crate::interpreter::non_modal::missing_of;
use crate::settings::Settings;
use crate::sinumerik::Sinumerik;
use crate::sinumerik::reader::Reader;
use crate::text::lexer::check_text;
use crate::text::lines::LONGEST_LINE;
use crate::text::place::Span;
use std::collections::VecDeque;
use std::io::BufRead;
use std::iter::FusedIterator;
use toolglide_kinematics::Move;

/// Warnings that are kept; of more, only the number is known, because a program may deserve one
/// for each of its lines.
pub const MAX_WARNINGS: usize = 100;

/// Refusals within loops and subroutines, after which it makes no sense to go on: a loop that does not
/// count because its lines are refused has no end.
const MAX_REPEATED_REFUSALS: u32 = 1000;

/// Reads a part program and yields its moves, in order.
///
/// It holds one line at a time, and the loops and subroutines that it has met. After the first refusal
/// it yields nothing more, unless it [goes on](Self::past_refusals); the moves before it are valid.
#[derive(Debug)]
pub struct Program<R> {
    pub(crate) flow: Flow<R>,
    pub(crate) block: Block,
    pub(crate) lowering: Interpreter,
    pub(crate) waiting: VecDeque<Move<3>>,
    pub(crate) remarks: Vec<Remark>,
    pub(crate) warnings: Vec<Warning>,
    pub(crate) more_warnings: u64,
    pub(crate) blocks: u64,
    opened: bool,
    ended: bool,
    pub(crate) past_refusals: bool,
    aftermath: CascadingErrors,
    repeated_refusals: u32,
    pub(crate) sinumerik: Option<Sinumerik>,
    pub(crate) fanuc: Option<Box<Fanuc>>,
    /// The language of the program, if it is one that is not read.
    pub(crate) not_read: Option<&'static str>,
}

impl<R: BufRead> Program<R> {
    /// A program read from `reader`; messages call it `file`.
    pub fn new(reader: R, file: &str, settings: Settings) -> Self {
        Self {
            flow: Flow::new(reader, file, &settings),
            block: Block::new(),
            lowering: Interpreter::new(settings),
            waiting: VecDeque::new(),
            remarks: Vec::new(),
            warnings: Vec::new(),
            more_warnings: 0,
            blocks: 0,
            opened: false,
            ended: false,
            past_refusals: false,
            aftermath: CascadingErrors::default(),
            repeated_refusals: 0,
            sinumerik: None,
            fanuc: None,
            not_read: None,
        }
    }

    /// Ends the program.
    pub(crate) fn end(&mut self) -> Result<(), Fault> {
        self.ended = true;
        self.lowering.finish(&mut self.waiting)
    }

    /// A refusal behind which nothing can be read.
    pub(crate) fn unreadable(&mut self, reason: Reason) -> Fault {
        let at = match reason {
            Reason::LineTooLong { .. } => LONGEST_LINE,
            _ => 0,
        };
        self.past_refusals = false;
        Fault::new(Span::new(at, at), reason)
    }

    /// Reads one line.
    fn line(&mut self) -> Result<(), Fault> {
        if let Some(mut fanuc) = self.fanuc.take() {
            let outcome = fanuc.line(self);
            self.fanuc = Some(fanuc);
            return outcome;
        }
        match self.flow.advance() {
            Ok(true) => {}
            Ok(false) => return self.end(),
            Err(reason) => return Err(self.unreadable(reason)),
        }
        if let Err(endless) = self.flow.check_progress(&self.lowering) {
            self.past_refusals = false;
            return Err(Fault::new(Span::default(), endless.into()));
        }
        if let Some(language) = self.not_read {
            self.past_refusals = false;
            let span = Span::new(0, self.flow.text().len());
            return Err(Fault::new(span, Reason::LanguageNotRead { language }));
        }
        if let Some(sinumerik) = &mut self.sinumerik {
            let text = self.flow.text();
            let start = text.iter().position(|byte| !matches!(byte, b' ' | b'\t'));
            if start.is_some_and(|start| matches!(text[start], b'/' | b'%')) {
                return check_text(text, 0);
            }
            let Some(at) = self.flow.obey_order(&mut self.lowering)? else {
                self.blocks += 1;
                return Ok(());
            };
            let mut reader = Reader::new(self.flow.text());
            reader.at = at;
            let (block, state) = (&mut self.block, &mut self.lowering);
            sinumerik.read(reader, block, state, &mut self.remarks)?;
            return self.carry_out();
        }
        let mut end = self.flow.text().len();
        if self.lowering.printer.is_some() {
            let Some(words) = self.printer_line()? else {
                return Ok(());
            };
            end = words.min(end);
        }
        let text = self.flow.text();
        let start = text.iter().position(|byte| !matches!(byte, b' ' | b'\t'));
        match start.map(|start| (start, text[start])) {
            None => return Ok(()),
            Some((start, b'/')) => return check_text(text, start),
            Some((start, b'%')) => return self.percent(start),
            Some((_, b'N' | b'n' | b'O' | b'o')) => {
                if let Some(at) = o_word(text) {
                    self.blocks += 1;
                    self.block.features |= O_WORDS;
                    self.flow.obey(at, &mut self.lowering)?;
                    return Ok(());
                }
            }
            Some(_) => {}
        }
        self.lowering.line = self.flow.line();
        let text = &self.flow.text()[..end];
        let (state, remarks) = (&self.lowering, &mut self.remarks);
        self.block
            .read(text, state, &state.settings, remarks)
            .map_err(|fault| explained(fault, text))?;
        self.carry_out()
    }

    /// Does what the block says.
    fn carry_out(&mut self) -> Result<(), Fault> {
        if self.block.is_empty() {
            return Ok(());
        }
        self.blocks += 1;
        let line = self.flow.line();
        // Parameters get their values once the whole line is read.
        if !self.block.assignments.is_empty() {
            self.lowering.assign(&mut self.block.assignments)?;
        }
        let outcome = self
            .lowering
            .block(&self.block, line, &mut self.waiting, &mut self.remarks);
        self.remarks.extend(self.lowering.own_remark.take());
        self.ended = outcome?;
        if self.ended {
            self.lowering.finish(&mut self.waiting)?;
        }
        match self.block.subprogram {
            Some(which) => self.subprogram(which),
            None => Ok(()),
        }
    }

    /// `M98` and `M99`, once their block is done.
    fn subprogram(&mut self, which: Subprogram) -> Result<(), Fault> {
        let block = &self.block;
        let span = block.taker(Group::Stop).map(|(_, span)| span);
        let span = span.unwrap_or_default();
        let fault = |reason| Fault::new(span, reason);
        if which == Subprogram::Return {
            let again = self.flow.return_program();
            let again = again.map_err(|reason| fault(reason.into()))?;
            self.lowering.leave_subprogram();
            if again {
                self.lowering.enter_subprogram();
            }
            return Ok(());
        }
        let number = whole(block, b'P', "number of a subprogram", 0, LARGEST_NUMBER)?
            .ok_or_else(|| missing_of(block, Group::Stop, 'P'))?;
        let times = whole(block, b'L', "number of repetitions", 0, MAX_REPETITIONS)?.unwrap_or(1);
        if self.flow.call_program(number, times).map_err(fault)? {
            self.lowering.enter_subprogram();
        }
        Ok(())
    }

    /// The first `%` before all blocks opens the program, any other ends it.
    fn percent(&mut self, start: usize) -> Result<(), Fault> {
        let rest = &self.flow.text()[start + 1..];
        if rest.iter().any(|byte| !matches!(byte, b' ' | b'\t')) {
            let span = Span::new(start, start + 1);
            return Err(Fault::new(span, Reason::PercentNotAlone));
        }
        self.ended = self.opened || self.blocks > 0;
        self.opened = true;
        if self.ended {
            self.lowering.finish(&mut self.waiting)?;
        }
        Ok(())
    }

    fn keep_remarks(&mut self) {
        let mut remarks = std::mem::take(&mut self.remarks);
        for (span, notice) in remarks.drain(..) {
            if self.warnings.len() < MAX_WARNINGS {
                let place = self.flow.place(span);
                let warning = Warning::new(place, notice, self.flow.text());
                self.warnings.push(warning);
            } else {
                self.more_warnings += 1;
            }
        }
        self.remarks = remarks;
    }
}

impl<R: BufRead> Program<R> {
    /// A refusal of the line being read.
    pub(crate) fn refuse(&mut self, reason: Reason) -> ProgramError {
        if !self.past_refusals {
            self.ended = true;
        }
        self.waiting.clear();
        ProgramError::new(self.flow.place(Span::default()), reason)
    }

    /// Whether nothing more will be read.
    pub(crate) fn is_over(&self) -> bool {
        self.ended
    }

    /// Reads one line, and takes what it says.
    pub(crate) fn read_line(&mut self) -> Result<(), ProgramError> {
        let lost = self.aftermath.place;
        self.lowering.arrived = false;
        let before = (self.lowering.position, self.lowering.others);
        let outcome = self.line();
        let watch = &mut self.flow.watch;
        watch.note(before, &self.lowering, &self.waiting);
        if lost && self.lowering.arrived {
            self.aftermath.place = false;
        }
        if !self.remarks.is_empty() {
            self.keep_remarks();
        }
        outcome.map_err(|fault| {
            if !self.past_refusals {
                self.ended = true;
            }
            self.waiting.clear();
            if self.flow.repeats() {
                self.repeated_refusals += 1;
                if self.repeated_refusals >= MAX_REPEATED_REFUSALS {
                    self.ended = true;
                }
            }
            let consequence = self.aftermath.explains(&fault.reason, lost);
            let arrived = self.lowering.arrived;
            self.aftermath.take(self.flow.text(), arrived);
            let place = self.flow.place(fault.span);
            ProgramError::new(place, fault.reason).following(consequence)
        })
    }
}

impl<R: BufRead> Iterator for Program<R> {
    type Item = Result<Move<3>, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(next) = self.waiting.pop_front() {
                return Some(Ok(next));
            }
            if self.ended {
                return None;
            }
            if let Err(refusal) = self.read_line() {
                return Some(Err(refusal));
            }
        }
    }
}

impl<R: BufRead> FusedIterator for Program<R> {}
