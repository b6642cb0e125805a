//! Keeps the lines of a program that may jump.
//!
//! Lines are read from the file as they are needed and kept, 16 MiB of them; of a longer program the
//! first are forgotten, and cannot be jumped to. Not here: who jumps where.

use crate::error::flow::FlowError;
use crate::error::reason::Reason;
use crate::flow::recording::{LONGEST_RECORDING, Recording};
use crate::text::lines::Lines;
use std::io::BufRead;
use std::sync::Arc;

/// Lines, and which of them is being run.
#[derive(Debug)]
pub(crate) struct Tape {
    file: Arc<str>,
    lines: Recording,
    at: usize,
    next: usize,
    /// Whether lines are only looked through, so that none may be forgotten.
    pub(crate) looking: bool,
}

impl Tape {
    pub(crate) fn new(file: &Arc<str>) -> Self {
        Self {
            file: Arc::clone(file),
            lines: Recording::new(file, 1),
            at: 0,
            next: 0,
            looking: false,
        }
    }

    /// Goes to the next line: true where it was run before, none at the end of the program.
    pub(crate) fn advance<R: BufRead>(
        &mut self,
        file: &mut Lines<R>,
    ) -> Result<Option<bool>, Reason> {
        let again = self.next < self.lines.len();
        if !again {
            if !file.advance()? {
                return Ok(None);
            }
            if !self.lines.push(file.text()) {
                if self.looking {
                    let bound = LONGEST_RECORDING;
                    return Err(FlowError::TooLong { bound }.into());
                }
                self.lines = Recording::new(&self.file, file.count());
                self.next = 0;
                // A line is far shorter than what is kept.
                self.lines.push(file.text());
            }
        }
        self.at = self.next;
        self.next += 1;
        Ok(Some(again))
    }

    /// Reads one more line behind those that are kept, without going there; false at the end.
    pub(crate) fn read_on<R: BufRead>(&mut self, file: &mut Lines<R>) -> Result<bool, Reason> {
        if !file.advance()? {
            return Ok(false);
        }
        if !self.lines.push(file.text()) {
            let bound = LONGEST_RECORDING;
            return Err(FlowError::TooLong { bound }.into());
        }
        Ok(true)
    }

    /// A line that is kept, empty where there is none.
    pub(crate) fn line(&self, index: usize) -> &[u8] {
        self.lines.line(index)
    }

    /// How many lines are kept.
    pub(crate) fn len(&self) -> usize {
        self.lines.len()
    }

    /// The line being run.
    pub(crate) fn text(&self) -> &[u8] {
        self.lines.line(self.at)
    }

    /// Its number in the file.
    pub(crate) fn number(&self) -> u64 {
        self.lines.number(self.at)
    }

    /// Its index, to come back to.
    pub(crate) fn index(&self) -> usize {
        self.at
    }

    /// Goes on behind the line at an index, which becomes the line being run.
    pub(crate) fn go_to(&mut self, index: usize) {
        self.at = index;
        self.next = index + 1;
    }

    /// Makes the line at an index the one being run, and goes on where it is.
    pub(crate) fn show(&mut self, index: usize) {
        self.at = index;
    }

    /// Goes on with the line at an index.
    pub(crate) fn go_before(&mut self, index: usize) {
        self.next = index;
    }

    /// Whether the line being run is the last one that was read.
    pub(crate) fn at_front(&self) -> bool {
        self.next == self.lines.len()
    }

    /// Index of the nearest line before the one being run that `is` the one wanted.
    pub(crate) fn before(&self, mut is: impl FnMut(&[u8]) -> bool) -> Option<usize> {
        (0..self.at).rev().find(|&index| is(self.lines.line(index)))
    }
}
