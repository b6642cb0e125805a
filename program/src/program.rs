//! A part program as a stream of moves.
//!
//! Not here: the language, see the crate.

use crate::aftermath::Aftermath;
use crate::block::{Block, FEATURES, O_WORDS};
use crate::codes::{Code, Group, Subprogram};
use crate::control::o_word;
use crate::error::{Fault, ProgramError, Remark, Warning};
use crate::flow::Flow;
use crate::language::Language;
use crate::lexer::check_text;
use crate::lines::LONGEST_LINE;
use crate::lower::Lowering;
use crate::modal::whole;
use crate::once::missing_of;
use crate::place::Span;
use crate::reason::Reason;
use crate::settings::Settings;
use crate::sinumerik::Sinumerik;
use crate::sinumerik_reader::Reader;
use crate::subprograms::{LARGEST_NUMBER, MOST_REPETITIONS};
use crate::tape::Tape;
use crate::tools::ToolTable;
use std::collections::VecDeque;
use std::io::BufRead;
use std::iter::FusedIterator;
use std::sync::Arc;
use toolglide_kinematics::{Move, Vector};

/// Warnings that are kept; of more, only the number is known, because a program may deserve one
/// for each of its lines.
pub const MOST_WARNINGS: usize = 100;

/// Reads a part program and yields its moves, in order.
///
/// It holds one line at a time, and the loops and subroutines that it has met. After the first refusal
/// it yields nothing more, unless it [goes on](Self::past_refusals); the moves before it are valid.
#[derive(Debug)]
pub struct Program<R> {
    flow: Flow<R>,
    pub(crate) block: Block,
    pub(crate) lowering: Lowering,
    pub(crate) waiting: VecDeque<Move<3>>,
    remarks: Vec<Remark>,
    warnings: Vec<Warning>,
    more_warnings: u64,
    blocks: u64,
    opened: bool,
    ended: bool,
    past_refusals: bool,
    aftermath: Aftermath,
    sinumerik: Option<Sinumerik>,
}

impl<R: BufRead> Program<R> {
    /// A program read from `reader`; messages call it `file`.
    pub fn new(reader: R, file: &str, settings: Settings) -> Self {
        Self {
            flow: Flow::new(reader, file, settings.steps),
            block: Block::new(),
            lowering: Lowering::new(settings),
            waiting: VecDeque::new(),
            remarks: Vec::new(),
            warnings: Vec::new(),
            more_warnings: 0,
            blocks: 0,
            opened: false,
            ended: false,
            past_refusals: false,
            aftermath: Aftermath::default(),
            sinumerik: None,
        }
    }

    /// The same program, with the tools of the machine.
    #[must_use]
    pub fn with_tools(mut self, tools: ToolTable) -> Self {
        self.lowering.tools = tools;
        self
    }

    /// The same program, with `find` to give the text of a subroutine that stands in a file of its
    /// own, by its name without ending.
    #[must_use]
    pub fn with_subroutines(
        mut self,
        find: impl Fn(&str) -> std::io::Result<Option<Vec<u8>>> + Send + 'static,
    ) -> Self {
        self.find_subroutines(find);
        self
    }

    /// The same program, for a machine with rotary axes A, B and C: their words are read, as are the
    /// codes that make the tool tip the point that moves (`G43.4`, `M128`, `M428`).
    #[must_use]
    pub fn with_rotary_axes(mut self) -> Self {
        self.block.rotary = true;
        self
    }

    /// The same program, with the words of secondary axes U, V and W counted among its features. No
    /// machine moves them, so that this is for looking at a program only.
    #[must_use]
    pub fn with_secondary_axes(mut self) -> Self {
        self.block.secondary = true;
        self
    }

    /// The same program, for a machine of this name: refusals of axes that it has not name it.
    #[must_use]
    pub fn for_machine(mut self, name: &str) -> Self {
        self.block.machine = Arc::from(name);
        self
    }

    /// The same program, in a language of axis words: RS274/NGC, as without this, or Sinumerik.
    #[must_use]
    pub fn in_language(mut self, language: Language) -> Self {
        let jumps = language == Language::Sinumerik;
        self.sinumerik = jumps.then(Sinumerik::default);
        self.lowering.leads_to_normal = jumps;
        self.flow.tape = jumps.then(|| Tape::new(&self.flow.file));
        self
    }

    /// Where the rotary axes A, B and C are, degrees.
    #[must_use]
    pub fn rotary(&self) -> [f64; 3] {
        self.lowering.rotary
    }

    /// The same program, going on behind refused lines so that all refusals are seen. What it yields
    /// after the first of them is not what the program says.
    #[must_use]
    pub fn past_refusals(mut self) -> Self {
        self.past_refusals = true;
        self
    }

    /// `G` and `M` codes met so far, in order, and how often each.
    pub fn codes(&self) -> impl Iterator<Item = (Code, u64)> + '_ {
        self.block.codes()
    }

    /// Parts of the language met so far that are no code.
    pub fn features(&self) -> impl Iterator<Item = &'static str> + '_ {
        FEATURES
            .into_iter()
            .filter(|(bit, _)| self.block.features & bit != 0)
            .map(|(_, name)| name)
    }

    /// Tools that were asked for so far, in order of their numbers; ten thousand at most.
    pub fn tools_used(&self) -> impl Iterator<Item = u32> + '_ {
        self.lowering.tools_used.iter().copied()
    }

    /// The line that the last refusal or the last moves came from.
    #[must_use]
    pub fn line_text(&self) -> std::borrow::Cow<'_, str> {
        String::from_utf8_lossy(self.flow.text())
    }

    /// What should be known of the lines read so far; [`MOST_WARNINGS`] at most.
    #[must_use]
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// How many warnings came after those that are kept.
    #[must_use]
    pub fn more_warnings(&self) -> u64 {
        self.more_warnings
    }

    /// Lines with at least one word, read so far.
    #[must_use]
    pub fn blocks(&self) -> u64 {
        self.blocks
    }

    /// Lines read so far.
    #[must_use]
    pub fn lines(&self) -> u64 {
        self.flow.lines.count()
    }

    /// Where the moves yielded so far, and those of the line being read, lead.
    #[must_use]
    pub fn position(&self) -> Vector<3> {
        self.lowering.position
    }

    /// Last spindle speed, as written; 0 before any.
    #[must_use]
    pub fn spindle_speed(&self) -> f64 {
        self.lowering.modal.spindle_speed
    }

    /// Last tool; 0 before any.
    #[must_use]
    pub fn tool(&self) -> u32 {
        self.lowering.modal.tool
    }

    /// Reads one line.
    fn line(&mut self) -> Result<(), Fault> {
        match self.flow.advance() {
            Ok(true) => {}
            Ok(false) => {
                self.ended = true;
                return self.lowering.finish(&mut self.waiting);
            }
            Err(reason) => {
                let at = match reason {
                    Reason::LineTooLong { .. } => LONGEST_LINE,
                    _ => 0,
                };
                // Behind these nothing can be read.
                self.past_refusals = false;
                return Err(Fault::new(Span::new(at, at), reason));
            }
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
        let text = self.flow.text();
        self.block.read(
            text,
            &self.lowering,
            &self.lowering.settings,
            &mut self.remarks,
        )?;
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
        self.ended =
            self.lowering
                .block(&self.block, line, &mut self.waiting, &mut self.remarks)?;
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
        let times = whole(block, b'L', "repetitions", 0, MOST_REPETITIONS)?.unwrap_or(1);
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
            if self.warnings.len() < MOST_WARNINGS {
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
    pub(crate) fn find_subroutines(
        &mut self,
        find: impl Fn(&str) -> std::io::Result<Option<Vec<u8>>> + Send + 'static,
    ) {
        self.flow.find = Some(Box::new(find));
    }

    pub(crate) fn set_past_refusals(&mut self) {
        self.past_refusals = true;
    }

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
        let outcome = self.line();
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
