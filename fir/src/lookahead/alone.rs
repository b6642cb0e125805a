//! Hands out what waits before a move that is so long that it is alone in the filters.
//!
//! Source: ours. In the middle of such a move its feedrate is reached, and neither what is before it nor what
//! is behind it is in the window. So what comes later changes nothing before it. The chain is chosen early only where all
//! that waits is such, and chosen anew where shorter moves follow that gain more than a rest costs. Not here:
//! what is handed out of shorter moves.

use super::LookAhead;
use crate::lookahead::command::Command;
use crate::pulse::Pulse;
use crate::settings::designed_for;

/// A pulse is alone in the middle of itself when it lasts so many times as long as its feedrate takes to be
/// reached and the window: once at each end, and as much in between.
const LONG: f64 = 3.0;

impl<const N: usize> LookAhead<N> {
    /// Counts the moves in a row that are alone in the filters, up to the one that came last.
    pub(super) fn count_alone(&mut self) {
        let any_chain = self.chooses() || self.early;
        if any_chain && self.alone + 1 < self.legs {
            // Something shorter waits, so nothing is handed out yet.
            return;
        }
        let alone = self.pulses.last();
        let alone = alone.is_some_and(|pulse| self.is_alone(pulse, any_chain));
        self.alone = if alone { self.alone + 1 } else { 0 };
    }

    /// Whether what waits before the last pulse depends on nothing that is still to come.
    pub(super) fn is_divided(&self) -> bool {
        let any_chain = self.chooses() || self.early;
        let known = if any_chain { self.legs } else { 1 };
        self.legs > 1 && self.alone >= known
    }

    fn is_alone(&self, pulse: &Pulse<N>, any_chain: bool) -> bool {
        if pulse.arc.is_some() {
            return false;
        }
        let (reached, window) = if any_chain {
            // Shorter chains are alone sooner, and reach the feedrate no later.
            let chain = designed_for(&self.limits, pulse.feedrate);
            (chain.long(), chain.total())
        } else {
            let steps = pulse.limit / pulse.step;
            (steps * self.chain.long(), self.chain.total())
        };
        pulse.length >= LONG * (reached + window) * pulse.feedrate
    }

    /// Decides what waits and hands all of it out but the last move.
    #[inline(never)]
    pub(super) fn divide(&mut self, out: &mut impl FnMut(Command<N>)) {
        let early = self.chooses() || self.early;
        self.decide(out);
        let mut until = self.pulses.len().saturating_sub(1);
        while until > self.fixed && self.pulses[until - 1].part {
            until -= 1;
        }
        if until > self.fixed {
            self.legs = 1;
            self.hand_out(until, out);
        }
        self.alone = 1;
        self.early = early && self.chosen;
    }

    /// Goes on behind the chain in use; `false` where that is impossible, or where it takes less time to come
    /// to rest for the chain that serves best what waits. That is asked once: where moves that are alone end.
    pub(super) fn solve_or_choose(&mut self) -> bool {
        let (planned, planned_capped) = (self.planned, self.planned_capped);
        if !self.solve() {
            return false;
        }
        if !self.early || self.alone >= self.legs || self.fixed == 0 {
            return true;
        }
        self.early = false;
        // What the plan that ends at rest has left, and behind it what came since.
        let late = planned + 1 - self.fixed;
        if late >= self.before.len() {
            return true;
        }
        let tail = self.before[1..late].iter();
        let tail: f64 = tail.map(|pulse| pulse.length / pulse.feed).sum();
        // A dwell before it at the most, and the one for other filters.
        let resting = tail + 2.0 * self.chain.total();
        let going_on = self.lasts() - self.schedule.end(self.fixed - 1);
        if resting + self.lasts_anew(late) < going_on {
            (self.planned, self.planned_capped) = (planned, planned_capped);
            self.restore();
            return false;
        }
        self.time();
        true
    }

    /// When the last pulse ends.
    fn lasts(&self) -> f64 {
        let last = self.pulses.len().checked_sub(1);
        last.map_or(0.0, |last| self.schedule.end(last))
    }

    /// How long what waits, from a place of it on, takes from rest behind the chain that serves it best, less
    /// the delay of the chain in use. All stays as it is but the times.
    fn lasts_anew(&mut self, late: usize) -> f64 {
        let chain = self.chain.clone();
        let kept = (self.fixed, self.planned, self.underway);
        let capped = (self.capped, self.planned_capped);
        self.going_on.clear();
        self.going_on.extend_from_slice(&self.pulses);
        self.pulses.clear();
        self.pulses.extend_from_slice(&self.before[late..]);
        (self.fixed, self.underway) = (0, false);
        self.choose();
        let takes = self.lasts() + self.chain.total() - chain.total();
        core::mem::swap(&mut self.pulses, &mut self.going_on);
        (self.fixed, self.planned, self.underway) = kept;
        (self.capped, self.planned_capped) = capped;
        self.use_chain(chain);
        takes
    }
}
