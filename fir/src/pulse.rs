//! Describes a straight pulse of feedrate to the look-ahead.
//!
//! Source: section 4.2, where a block is a rectangular pulse; arcs are sequences of chords here. Not
//! here: its filtered motion.

use toolglide_kinematics::{MoveRange, Vector};

/// Share of the largest feedrate of an arc that is nearly all of it.
pub(crate) const NEARLY: f64 = 0.9;

/// A straight stretch at constant commanded feedrate, and the corner at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pulse<const N: usize> {
    pub(crate) from: Vector<N>,
    pub(crate) to: Vector<N>,
    pub(crate) direction: Vector<N>,
    pub(crate) length: f64,
    /// Feedrate of the program.
    pub(crate) programmed: f64,
    /// Largest feedrate that the program and the axes leave.
    pub(crate) feedrate: f64,
    /// Number of the arc that it is part of.
    pub(crate) arc: Option<u32>,
    /// Largest feedrate behind the chain.
    pub(crate) limit: f64,
    /// Largest feedrate beside rest.
    pub(crate) step: f64,
    /// How far the motion may be from the stretch.
    pub(crate) tolerance: f64,
    /// Whether the next pulse goes on along the same arc, so that there is no corner in between.
    pub(crate) smooth: bool,
    /// Whether the path turns at its end by no more than the arc does between its chords.
    pub(crate) even: bool,
    pub(crate) serves: MoveRange,
    /// Feedrate that is commanded.
    pub(crate) feed: f64,
    /// Dwell before it, s; set once it is handed out.
    pub(crate) gap: f64,
    /// By how much the next pulse overlaps it behind the filters, s: the delay less the dwell.
    pub(crate) overlap: f64,
    /// `|t2 - t1|` at its end.
    pub(crate) turn: f64,
    /// Whether the corner at its end is passed without a dwell, slowly enough.
    pub(crate) pass: bool,
    /// Whether the next pulse goes on along the same stretch.
    pub(crate) part: bool,
    /// Whether the corner at its end was sorted already, and pulses before it handed out.
    pub(crate) sorted: bool,
    /// Whether steps alone do not keep the feedrate of the program beside its end.
    pub(crate) careful: bool,
}

impl<const N: usize> Pulse<N> {
    /// A pulse between two different points.
    pub(crate) fn between(
        (from, to): (Vector<N>, Vector<N>),
        feedrate: f64,
        tolerance: f64,
        serves: MoveRange,
    ) -> Self {
        let span = to - from;
        let length = span.norm();
        Self {
            from,
            to,
            direction: span / length,
            length,
            programmed: feedrate,
            feedrate,
            arc: None,
            limit: feedrate,
            step: feedrate,
            part: false,
            tolerance,
            smooth: false,
            even: false,
            serves,
            feed: feedrate,
            gap: 0.0,
            overlap: 0.0,
            turn: 0.0,
            pass: false,
            sorted: false,
            careful: false,
        }
    }

    /// Whether the next pulse goes on along the same arc, both at about its largest feedrate.
    pub(crate) fn goes_on(&self, next: &Self) -> bool {
        let fast = |pulse: &Self| pulse.feed >= NEARLY * pulse.limit && pulse.feed <= pulse.limit;
        self.smooth && fast(self) && fast(next) && same(self.tolerance, next.tolerance)
    }

    /// Whether the next pulse goes on along the same arc at the same feedrate, and the path turns no more
    /// between them than the arc does; it does where the arc begins and ends.
    pub(crate) fn turns_on(&self, next: &Self) -> bool {
        self.smooth && same(self.feed, next.feed) && next.feed <= next.limit && self.even
    }

    /// The parts before and after a distance.
    pub(crate) fn split(&self, distance: f64) -> (Self, Self) {
        let middle = self.from + self.direction * distance;
        let before = Self {
            to: middle,
            length: distance,
            smooth: false,
            turn: 0.0,
            pass: true,
            part: true,
            sorted: true,
            careful: false,
            ..*self
        };
        let after = Self {
            from: middle,
            length: self.length - distance,
            ..*self
        };
        (before, after)
    }
}

/// Whether two numbers have the same digits.
fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits()
}
