//! Which time constants are used: those with which what waits takes the least time.
//!
//! Source: section 4.2.2 designs a chain for a feedrate. A shorter chain allows less feedrate, but cuts
//! corners and curves less, and dwells less; which feedrate to design for depends on the path, so several
//! are tried whenever motion begins. Not here: how pulses are timed behind a chain.

use super::LookAhead;
use crate::cubic::CubicChain;
use crate::settings::{designed_for, largest_change};
use crate::sweep::Command;

/// Feedrates that chains are designed for: that of the program, and each half of the one before.
const DESIGNS: u32 = 9;

impl<const N: usize> LookAhead<N> {
    /// Times what waits; where motion begins, behind the chain that serves it best.
    pub(super) fn decide(&mut self, out: &mut impl FnMut(Command<N>)) {
        if self.chosen && self.fixed == 0 {
            let chain = self.best_chain();
            out(Command::Filters {
                long: chain.long(),
                short: chain.short(),
            });
            self.use_chain(chain);
        }
        self.solve();
    }

    fn best_chain(&mut self) -> CubicChain {
        self.waiting.clear();
        self.waiting.extend_from_slice(&self.pulses);
        let fastest = self.pulses.iter().map(|pulse| pulse.feedrate);
        let mut design = fastest.fold(0.0, f64::max);
        let mut best = (f64::INFINITY, designed_for(&self.limits, design));
        for _ in 0..DESIGNS {
            let chain = designed_for(&self.limits, design);
            self.use_chain(chain.clone());
            self.solve();
            let last = self.pulses.len() - 1;
            let takes = self.schedule.end(last) + chain.total();
            if takes < best.0 {
                best = (takes, chain);
            }
            self.pulses.clear();
            self.pulses.extend_from_slice(&self.waiting);
            design *= 0.5;
        }
        best.1
    }

    /// Other filters from here on; only when nothing was handed out.
    fn use_chain(&mut self, chain: CubicChain) {
        self.change = largest_change(&self.limits, &chain);
        self.chain = chain;
        self.bend = None;
        for index in 0..self.pulses.len() {
            self.limit(index);
        }
    }

    /// Limits the feedrate of a pulse to what the chain allows.
    pub(super) fn limit(&mut self, index: usize) {
        let pulse = &mut self.pulses[index];
        let feedrate = pulse.feedrate;
        let Some(bend) = pulse.bend else {
            let most = toolglide_kinematics::largest_multiple(&pulse.direction, &self.change);
            pulse.limit = feedrate.min(most);
            return;
        };
        let pace = match self.bend {
            #[allow(clippy::float_cmp, reason = "the same arc has the same feedrate")]
            Some((same, its_feedrate, pace)) if same == bend && its_feedrate == feedrate => pace,
            _ => bend.pace(feedrate, &self.chain, &self.change),
        };
        self.bend = Some((bend, feedrate, pace));
        pulse.limit = pace.feed;
        pulse.steady = pace.steady;
    }
}
