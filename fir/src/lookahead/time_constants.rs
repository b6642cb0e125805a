//! Chooses the filter time constants that minimise the duration of the queued moves.
//!
//! Source: section 4.2.2 designs a chain for a feedrate. A shorter chain allows less feedrate, but cuts
//! corners and curves less, and dwells less; which feedrate to design for depends on the path, so several
//! are tried whenever motion begins. Not here: how pulses are timed behind a chain.

use crate::filter::cubic::CubicChain;
use crate::lookahead::LookAhead;
use crate::lookahead::command::Command;
use crate::lookahead::staircase::STEPS;
use crate::settings::{designed_for, largest_change};

/// Feedrates that chains are designed for: that of the program, and each half of the one before.
const DESIGNS: u32 = 9;

/// A chain that takes this much longer than the best one tells that shorter ones need not be tried.
const HOPELESS: f64 = 1.25;

/// So many chains in a row that take longer than the best one tell the same.
const WORSE_IN_A_ROW: u32 = 2;

/// Time that is so little more than what the feedrates of the program ask for that no chain need be
/// tried for the rest, as their ratio.
const ENOUGH: f64 = 1.03;

/// The same once one chain took longer than the best one.
const NEARLY_ENOUGH: f64 = 1.05;

impl<const N: usize> LookAhead<N> {
    /// Times what waits; where motion begins, behind the chain that serves it best.
    pub(super) fn decide(&mut self, out: &mut impl FnMut(Command<N>)) {
        if self.chooses() {
            self.choose();
            out(Command::Filters {
                long: self.chain.long(),
                short: self.chain.short(),
            });
        } else if !self.solve_or_choose() {
            self.carry_out(out);
            if !self.pulses.is_empty() {
                self.decide(out);
            }
        }
    }

    /// Whether a chain is chosen for what waits, so that nothing depends on the one in use.
    pub(super) fn chooses(&self) -> bool {
        self.chosen && self.fixed == 0
    }

    /// What was planned last happens to its end; what came after it begins at rest.
    fn carry_out(&mut self, out: &mut impl FnMut(Command<N>)) {
        let late = self.planned - self.fixed.saturating_sub(1);
        self.pulses.truncate(self.planned);
        self.capped = self.planned_capped;
        self.time();
        self.hand_out(self.pulses.len(), out);
        self.begin_again(out);
        self.pulses.extend_from_slice(&self.before[late..]);
        self.legs = self.pulses.len();
    }

    pub(super) fn choose(&mut self) {
        self.waiting.clear();
        self.waiting.extend_from_slice(&self.pulses);
        let (mut design, mut least) = (0.0_f64, 0.0);
        for pulse in &self.pulses {
            design = design.max(pulse.feedrate);
            least += pulse.length / pulse.feedrate;
        }
        let mut best = f64::INFINITY;
        let (mut best_design, mut best_capped) = (design, false);
        let mut worse = 0;
        for number in 0..DESIGNS {
            let takes = self.try_design(design, best);
            if number == 0 || takes < best {
                (best, best_design, best_capped) = (takes, design, self.planned_capped);
                core::mem::swap(&mut self.pulses, &mut self.best);
                worse = 0;
            } else {
                worse += 1;
            }
            let enough = if worse > 0 { NEARLY_ENOUGH } else { ENOUGH };
            if worse >= WORSE_IN_A_ROW || takes > HOPELESS * best || best < enough * least {
                break;
            }
            design *= 0.5;
        }
        core::mem::swap(&mut self.pulses, &mut self.best);
        if worse > 0 {
            self.use_chain(designed_for(&self.limits, best_design));
            self.planned = self.pulses.len();
            self.planned_capped = best_capped;
            self.capped = best_capped;
            self.time();
        }
    }

    /// How long what waits takes behind the chain that is designed for a feedrate; less where it is more
    /// than what the `best` one takes.
    fn try_design(&mut self, feed: f64, best: f64) -> f64 {
        self.pulses.clear();
        self.pulses.extend_from_slice(&self.waiting);
        self.use_chain(designed_for(&self.limits, feed));
        let moving: f64 = self
            .pulses
            .iter()
            .map(|pulse| pulse.length / pulse.limit)
            .sum();
        if moving + self.chain.total() >= best {
            return moving + self.chain.total();
        }
        self.solve();
        self.schedule.end(self.pulses.len() - 1) + self.chain.total()
    }

    /// Other filters from here on; only when nothing was handed out.
    pub(super) fn use_chain(&mut self, chain: CubicChain) {
        self.change = largest_change(&self.limits, &chain);
        self.per_change = self.change.map(f64::recip);
        self.chain = chain;
        self.arcs.pace(&self.chain, &self.change);
        for index in 0..self.pulses.len() {
            self.limit(index);
        }
    }

    /// Limits the feedrate of a pulse to what the chain allows.
    pub(super) fn limit(&mut self, index: usize) {
        let pulse = &mut self.pulses[index];
        let feedrate = pulse.feedrate;
        // The axis that may change its velocity by the least, beside its share of the feedrate.
        let direction = pulse.direction.abs();
        let (axis, _) = direction.component_mul(&self.per_change).argmax();
        pulse.step = feedrate.min(self.change[axis] / direction[axis]);
        let most = feedrate.min(STEPS * pulse.step);
        pulse.limit = most;
        if let Some(arc) = pulse.arc {
            pulse.limit = most.min(self.arcs.pace_of(arc));
        }
    }
}
