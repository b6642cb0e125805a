//! Lengthens dwells and lowers feedrates until the bound holds at every corner.
//!
//! Source: ours. Feedrates only fall and dwells only grow; since a longer dwell anywhere never increases
//! the bound anywhere, full stops end the search. Not here: the first choice of both.

use super::{AIM, LookAhead};
use toolglide_kinematics::numeric::LIMIT_SLACK;

/// Corners that contribute less than this share of the tolerance are left as they are.
const SHARE_THAT_COUNTS: f64 = 0.02;

/// Rounds of corrections; after that dwells are lengthened only, which always succeeds.
const ROUNDS: u32 = 40;

/// Rounds after which a dwell is made behind what was handed out at speed: no plan unless it was slow.
const ROUNDS_TO_DWELL: u32 = 12;

/// Rounds after which a dwell that still does not suffice becomes a full stop.
const ROUNDS_TO_STOP: u32 = 56;

/// Rounds after which nothing is left to be lengthened.
const LAST_ROUND: u32 = ROUNDS_TO_STOP + 8;

impl<const N: usize> LookAhead<N> {
    /// Lengthens dwells and slows pulses until the bound holds at every corner; whether any had to be.
    pub(super) fn correct(&mut self) -> bool {
        self.time();
        let count = self.pulses.len();
        let corners = count.saturating_sub(1);
        self.dirty.clear();
        self.dirty.resize(count, true);
        for round in 0.. {
            self.slower.clear();
            self.slower.resize(count, 1.0);
            self.longer.clear();
            self.longer.resize(count, 1.0);
            let mut broken = false;
            for corner in 0..corners {
                if !self.dirty[corner] || self.is_settled(corner) {
                    continue;
                }
                self.dirty[corner] = false;
                if self.pulses[corner].part {
                    // The bound is largest where the path turns.
                    continue;
                }
                let bound = self.schedule.at_corner(&self.pulses, &self.chain, corner);
                let allowed = self.room(corner, bound);
                if bound > allowed * (1.0 + LIMIT_SLACK) {
                    broken = true;
                    self.dirty[corner] = true;
                    self.blame(bound / (AIM * allowed), allowed, round);
                }
            }
            // Beyond the last round every corner in question is a full stop, whose bound is rounding.
            if !broken || round > LAST_ROUND {
                return round > 0;
            }
            self.apply(round);
            self.time();
        }
        false
    }

    /// Whether the bound holds at every corner.
    pub(super) fn holds(&mut self) -> bool {
        (0..self.pulses.len().saturating_sub(1)).all(|corner| {
            if self.pulses[corner].part || self.is_settled(corner) {
                return true;
            }
            let bound = self.schedule.at_corner(&self.pulses, &self.chain, corner);
            bound <= self.room(corner, bound) * (1.0 + LIMIT_SLACK)
        })
    }

    /// Whether nothing that may still change is in the window of a corner, or nothing but one arc.
    fn is_settled(&self, corner: usize) -> bool {
        let total = self.chain.total();
        if self.fixed > 0
            && corner + 1 < self.fixed
            && self.schedule.begin(corner + 1) + total <= self.schedule.end(self.fixed - 1)
        {
            return true;
        }
        let pulses = &self.pulses;
        let same = |index: usize| {
            let pulse = &pulses[index];
            pulse.smooth && pulse.pass && pulse.overlap >= total && pulse.feed >= pulse.limit
        };
        if !same(corner) {
            return false;
        }
        // Where feedrates differ, the instant in question is anywhere in the window.
        let reach = total;
        let mut index = corner;
        while self.schedule.end(corner) - self.schedule.begin(index) < reach {
            if index == 0 || !same(index - 1) {
                return false;
            }
            index -= 1;
        }
        index = corner + 1;
        while self.schedule.end(index) - self.schedule.end(corner) < reach {
            if !same(index) || index + 1 >= pulses.len() {
                return false;
            }
            index += 1;
        }
        true
    }

    /// Notes what the corners in the window must do about a bound that is broken by a factor.
    fn blame(&mut self, excess: f64, allowed: f64, round: u32) {
        let least = SHARE_THAT_COUNTS * allowed;
        let excess = excess.min(4.0);
        let mut anything = false;
        let first_free = self.fixed.saturating_sub(1);
        for (corner, contribution) in self.schedule.contributions() {
            if corner < first_free || contribution <= least {
                continue;
            }
            anything = true;
            let pulse = &self.pulses[corner];
            if pulse.pass && round < ROUNDS {
                for index in [corner, corner + 1] {
                    self.slower[index] = self.slower[index].max(excess.sqrt());
                }
                if corner < self.fixed && (self.capped || round >= ROUNDS_TO_DWELL) {
                    // What was handed out cannot be slowed any more.
                    self.longer[corner] = self.longer[corner].max(excess.cbrt());
                }
            } else {
                let factor = if round < ROUNDS { excess.cbrt() } else { 2.0 };
                self.longer[corner] = self.longer[corner].max(factor);
            }
        }
        if !anything {
            self.longer[first_free] = self.longer[first_free].max(excess.max(1.25));
        }
    }

    fn apply(&mut self, round: u32) {
        let total = self.chain.total();
        for index in 0..self.pulses.len() {
            let slower = self.slower[index].min(2.0);
            if index >= self.fixed && slower > 1.0 {
                self.pulses[index].feed /= slower;
                self.mark(index, total);
            }
            let longer = self.longer[index];
            if index + 1 >= self.fixed && longer > 1.0 {
                let pulse = &mut self.pulses[index];
                pulse.overlap /= longer;
                if round >= ROUNDS {
                    pulse.pass = false;
                }
                if round >= ROUNDS_TO_STOP {
                    pulse.overlap = 0.0;
                }
                self.mark(index, total);
            }
        }
    }

    /// The corners whose bound depends on a pulse.
    fn mark(&mut self, index: usize, total: f64) {
        let reach = 2.0 * total;
        let (begin, end) = (self.schedule.begin(index), self.schedule.end(index));
        for corner in (0..=index).rev() {
            if begin - self.schedule.end(corner) > reach {
                break;
            }
            self.dirty[corner] = true;
        }
        for corner in index..self.pulses.len() {
            if self.schedule.begin(corner) - end > reach {
                break;
            }
            self.dirty[corner] = true;
        }
    }
}
