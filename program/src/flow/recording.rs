//! Records lines that are run more than once: loops and subroutines.
//!
//! Not here: which lines these are.

use std::sync::Arc;

/// Bytes of one loop or subroutine, and of one file of subroutines: far more than people write, far
/// less than memory holds.
pub(crate) const LONGEST_RECORDING: usize = 16 * 1024 * 1024;

/// Consecutive lines of one file.
#[derive(Debug)]
pub(crate) struct Recording {
    pub(crate) file: Arc<str>,
    /// Line of the program that moves of another file are said to come from.
    pub(crate) outer: Option<u32>,
    first: u64,
    text: Vec<u8>,
    ends: Vec<usize>,
}

impl Recording {
    /// No lines yet; the next one is line `first` of `file`.
    pub(crate) fn new(file: &Arc<str>, first: u64) -> Self {
        Self {
            file: Arc::clone(file),
            outer: None,
            first,
            text: Vec::new(),
            ends: Vec::new(),
        }
    }

    /// Appends a line; false when it would be too long.
    pub(crate) fn push(&mut self, line: &[u8]) -> bool {
        // An empty line needs memory too.
        if self.text.len() + 8 * self.ends.len() + line.len() > LONGEST_RECORDING {
            return false;
        }
        self.text.extend_from_slice(line);
        self.ends.push(self.text.len());
        true
    }

    /// How many lines there are.
    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    /// A line, empty where there is none.
    pub(crate) fn line(&self, index: usize) -> &[u8] {
        let start = index
            .checked_sub(1)
            .map_or(Some(&0), |last| self.ends.get(last));
        match (start, self.ends.get(index)) {
            (Some(&start), Some(&end)) => &self.text[start..end],
            _ => &[],
        }
    }

    /// The number of a line in its file, counted from 1.
    pub(crate) fn number(&self, index: usize) -> u64 {
        self.first + index as u64
    }
}
