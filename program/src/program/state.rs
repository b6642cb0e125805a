//! Answers questions about a program while it is read.
//!
//! Not here: its moves.

use crate::block::FEATURES;
use crate::block::code::Code;
use crate::error::Warning;
use crate::program::Program;
use std::io::BufRead;
use toolglide_kinematics::Vector;

impl<R: BufRead> Program<R> {
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

    /// What should be known of the lines read so far; [`MAX_WARNINGS`](crate::MAX_WARNINGS)
    /// at most.
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

    /// Where the rotary axes A, B and C are, degrees.
    #[must_use]
    pub fn rotary(&self) -> [f64; 3] {
        let [a, b, c, ..] = self.lowering.others.at;
        [a, b, c]
    }

    /// Where the straight axes U, V and W are, mm.
    #[must_use]
    pub fn secondary(&self) -> [f64; 3] {
        let [.., u, v, w] = self.lowering.others.at;
        [u, v, w]
    }
}
