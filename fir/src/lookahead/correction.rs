//! Lengthens dwells and lowers feedrates until the bound holds at every corner.
//!
//! Source: ours. Feedrates only fall and dwells only grow, which never increases the bound anywhere: of
//! two motions along the path with the same mean, the slower one passes the other once, from ahead to
//! behind, so it is nowhere further spread. So what holds stays so, and full stops end the search. Not
//! here: the first choice of both.

use super::{AIM, LookAhead};
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
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

/// What is known of the bound at a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Standing {
    /// Nothing.
    Open,
    /// It holds as long as what is in its window stays as it is.
    Holds,
    /// It holds whatever is slower.
    Settled,
}

impl<const N: usize> LookAhead<N> {
    /// Lengthens dwells and slows pulses until the bound holds at every corner; whether any had to be.
    pub(super) fn correct(&mut self) -> bool {
        self.time();
        let count = self.pulses.len();
        let corners = count.saturating_sub(1);
        self.standing.clear();
        self.standing.resize(count, Standing::Open);
        for round in 0.. {
            self.slower.clear();
            self.slower.resize(count, 1.0);
            self.longer.clear();
            self.longer.resize(count, 1.0);
            let mut broken = false;
            let mut ahead = 0;
            for corner in 0..corners {
                if self.standing[corner] != Standing::Open {
                    continue;
                }
                // The bound is largest where the path turns.
                if self.pulses[corner].part || self.is_settled(corner, &mut ahead) {
                    self.standing[corner] = Standing::Settled;
                    continue;
                }
                let bound = self.schedule.at_corner(&self.pulses, &self.chain, corner);
                let (allowed, depends) = self.room(corner, bound);
                if bound > allowed * (1.0 + LIMIT_SLACK) {
                    broken = true;
                    self.blame(bound / (AIM * allowed), allowed, round);
                } else {
                    self.standing[corner] = match depends {
                        true => Standing::Holds,
                        false => Standing::Settled,
                    };
                }
            }
            // Beyond the last round every corner in question is a full stop, whose bound is rounding.
            if !broken || round > LAST_ROUND {
                debug_assert!(broken || self.holds(), "what held holds no longer");
                return round > 0;
            }
            self.apply(round);
            self.time();
        }
        false
    }

    /// Whether the bound holds at every corner.
    pub(super) fn holds(&mut self) -> bool {
        let mut ahead = 0;
        (0..self.pulses.len().saturating_sub(1)).all(|corner| {
            if self.pulses[corner].part || self.is_settled(corner, &mut ahead) {
                return true;
            }
            let bound = self.schedule.at_corner(&self.pulses, &self.chain, corner);
            bound <= self.room(corner, bound).0 * (1.0 + LIMIT_SLACK)
        })
    }

    /// Whether nothing that may still change is in the window of a corner, or nothing but one arc.
    fn is_settled(&self, corner: usize, ahead: &mut usize) -> bool {
        let total = self.chain.total();
        if self.fixed > 0
            && corner + 1 < self.fixed
            && self.schedule.begin(corner + 1) + total <= self.schedule.end(self.fixed - 1)
        {
            return true;
        }
        self.schedule.is_steady(corner, &self.chain, ahead)
    }

    /// Notes what the corners in the window must do about a bound that is broken by a factor.
    fn blame(&mut self, excess: f64, allowed: f64, round: u32) {
        let least = SHARE_THAT_COUNTS * allowed;
        let excess = excess.min(4.0);
        let mut anything = false;
        let first_free = self.fixed.saturating_sub(1);
        // Behind the last pulse there is no corner.
        let corners = self.pulses.len().saturating_sub(1);
        for (corner, contribution) in self.schedule.contributions() {
            if corner < first_free || corner >= corners || contribution <= least {
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
        for index in 0..self.pulses.len() {
            let slower = self.slower[index].min(2.0);
            if index >= self.fixed && slower > 1.0 {
                self.pulses[index].feed /= slower;
                self.mark(index);
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
                self.mark(index);
            }
        }
    }

    /// Opens the corners to which it matters that a pulse is slower, or the dwell behind it longer.
    fn mark(&mut self, index: usize) {
        // Where a pulse waits no longer, what is behind it is nearer to what is before it.
        let nearer = self.schedule.waits();
        let reach = if nearer { 2.0 } else { 1.0 } * self.chain.total();
        let (begin, end) = (self.schedule.begin(index), self.schedule.end(index));
        let open = |standing: &mut Standing| {
            if nearer || *standing == Standing::Holds {
                *standing = Standing::Open;
            }
        };
        let corners = self.pulses.len() - 1;
        for corner in (0..corners.min(index + 1)).rev() {
            if begin - self.schedule.begin(corner + 1) > reach {
                break;
            }
            open(&mut self.standing[corner]);
        }
        for corner in index..corners {
            if self.schedule.end(corner) - end > reach {
                break;
            }
            open(&mut self.standing[corner]);
        }
    }
}
