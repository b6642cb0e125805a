//! A part program as a stream of moves.
//!
//! Not here: the language, see the crate.

use crate::block::Block;
use crate::error::{Fault, ProgramError, Remark, Warning};
use crate::lexer::check_text;
use crate::lines::{LONGEST_LINE, Lines};
use crate::lower::Lowering;
use crate::place::{Place, Span};
use crate::reason::Reason;
use crate::settings::Settings;
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
/// It holds one line at a time. After the first refusal it yields nothing more; the moves before
/// it are valid.
#[derive(Debug)]
pub struct Program<R> {
    file: Arc<str>,
    lines: Lines<R>,
    block: Block,
    lowering: Lowering,
    waiting: VecDeque<Move<3>>,
    remarks: Vec<Remark>,
    warnings: Vec<Warning>,
    more_warnings: u64,
    blocks: u64,
    opened: bool,
    ended: bool,
}

impl<R: BufRead> Program<R> {
    /// A program read from `reader`; messages call it `file`.
    pub fn new(reader: R, file: &str, settings: Settings) -> Self {
        Self {
            file: Arc::from(file),
            lines: Lines::new(reader),
            block: Block::new(),
            lowering: Lowering::new(settings),
            waiting: VecDeque::new(),
            remarks: Vec::new(),
            warnings: Vec::new(),
            more_warnings: 0,
            blocks: 0,
            opened: false,
            ended: false,
        }
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
        self.lines.count()
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
        match self.lines.advance() {
            Ok(true) => {}
            Ok(false) => {
                self.ended = true;
                return Ok(());
            }
            Err(reason) => {
                let at = match reason {
                    Reason::LineTooLong { .. } => LONGEST_LINE,
                    _ => 0,
                };
                return Err(Fault::new(Span::new(at, at), reason));
            }
        }
        let text = self.lines.text();
        let start = text.iter().position(|byte| !matches!(byte, b' ' | b'\t'));
        match start.map(|start| (start, text[start])) {
            None => return Ok(()),
            Some((start, b'/')) => return check_text(text, start),
            Some((start, b'%')) => return self.percent(start),
            Some(_) => {}
        }
        self.block
            .read(text, &self.lowering.settings, &mut self.remarks)?;
        if self.block.words() == 0 {
            return Ok(());
        }
        self.blocks += 1;
        let line = u32::try_from(self.lines.count()).unwrap_or(u32::MAX);
        self.ended =
            self.lowering
                .block(&self.block, line, &mut self.waiting, &mut self.remarks)?;
        Ok(())
    }

    /// The first `%` before all blocks opens the program, any other ends it.
    fn percent(&mut self, start: usize) -> Result<(), Fault> {
        let rest = &self.lines.text()[start + 1..];
        if rest.iter().any(|byte| !matches!(byte, b' ' | b'\t')) {
            let span = Span::new(start, start + 1);
            return Err(Fault::new(span, Reason::PercentNotAlone));
        }
        self.ended = self.opened || self.blocks > 0;
        self.opened = true;
        Ok(())
    }

    fn place(&self, span: Span) -> Place {
        Place::new(&self.file, self.lines.count(), self.lines.text(), span)
    }

    fn keep_remarks(&mut self) {
        let mut remarks = std::mem::take(&mut self.remarks);
        for (span, notice) in remarks.drain(..) {
            if self.warnings.len() < MOST_WARNINGS {
                self.warnings.push(Warning::new(self.place(span), notice));
            } else {
                self.more_warnings += 1;
            }
        }
        self.remarks = remarks;
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
            let outcome = self.line();
            if !self.remarks.is_empty() {
                self.keep_remarks();
            }
            if let Err(fault) = outcome {
                self.ended = true;
                self.waiting.clear();
                let place = self.place(fault.span);
                return Some(Err(ProgramError::new(place, fault.reason)));
            }
        }
    }
}

impl<R: BufRead> FusedIterator for Program<R> {}
