//! Limits each move to its own feedrate while the filters see other moves with it.
//!
//! Source: ours; the overlap of section 4.3 lets a feedrate that falls do so half before the corner and half
//! behind it. While the mean of the window is on a move, all that is in the window must be as slow as that
//! move. At its feedrate the window reaches half the delay to either side, less half of a dwell there, and
//! no further where it is slower. Not here: where dwells are.

use super::LookAhead;

/// A pulse is cut where it is so much longer than what has to be slow.
const WORTH_A_CUT: f64 = 1.2;

/// Beside which corners feedrates are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Corners {
    /// All, and those where anything had to be slower are remembered.
    All,
    /// Those where no steps are wanted, and those that are remembered.
    AtSpeed,
}

/// What became of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Kept {
    /// Whether anything had to be slower.
    pub(super) slower: bool,
    /// Whether a corner was left out.
    pub(super) left_out: bool,
}

impl<const N: usize> LookAhead<N> {
    /// Slows what is in the window together with a slower move; `None` where that was handed out.
    pub(super) fn keep_feedrates(&mut self, corners: Corners) -> Option<Kept> {
        let mut kept = Kept::default();
        if self.unchanged >= self.pulses.len() {
            return Some(kept);
        }
        let mut corner = self.pulses.len() - 1;
        while corner > 0 {
            corner -= 1;
            let feed = self.pulses[corner + 1].programmed;
            if feed < self.pulses[corner].programmed {
                if !self.is_asked_for(corner, corners) {
                    kept.left_out = true;
                    continue;
                }
                let count = self.pulses.len();
                let here = self.slow_before(corner, feed)?;
                corner += self.pulses.len() - count;
                self.pulses[corner].careful |= here;
                kept.slower |= here;
            }
        }
        while corner + 1 < self.pulses.len() {
            let feed = self.pulses[corner].programmed;
            if feed < self.pulses[corner + 1].programmed {
                if self.is_asked_for(corner, corners) {
                    let here = self.slow_behind(corner, feed);
                    self.pulses[corner].careful |= here;
                    kept.slower |= here;
                } else {
                    kept.left_out = true;
                }
            }
            corner += 1;
        }
        Some(kept)
    }

    fn is_asked_for(&self, corner: usize, corners: Corners) -> bool {
        let (before, after) = (&self.pulses[corner], &self.pulses[corner + 1]);
        let feed = before.programmed.min(after.programmed);
        let at_speed = before.pass || before.turn <= 0.0 || feed <= before.step.min(after.step);
        corners == Corners::All || before.careful || at_speed
    }

    /// How far the window reaches to either side of a corner at a feedrate.
    fn reach_beside(&self, corner: usize, feed: f64) -> f64 {
        let pulse = &self.pulses[corner];
        let stops = !pulse.pass && pulse.overlap <= 0.0;
        let overlap = if pulse.pass || corner < self.fixed || stops {
            pulse.overlap
        } else {
            self.overlap_within(corner, feed)
        };
        0.5 * overlap * feed
    }

    /// Slows what lies before a corner; whether anything had to be, `None` where it was handed out.
    fn slow_before(&mut self, corner: usize, feed: f64) -> Option<bool> {
        let mut slower = false;
        let mut left = self.reach_beside(corner, feed);
        let mut index = corner;
        while left > 0.0 {
            let pulse = &self.pulses[index];
            let length = pulse.length;
            if pulse.feed > feed {
                if index < self.fixed {
                    return None;
                }
                slower = true;
                if length > WORTH_A_CUT * left {
                    self.cut(index, length - left);
                    self.pulses[index + 1].feed = feed;
                } else {
                    self.pulses[index].feed = feed;
                }
            }
            if index == 0 {
                break;
            }
            index -= 1;
            left -= length + feed * (self.chain.total() - self.pulses[index].overlap);
        }
        Some(slower)
    }

    /// Slows what lies behind a corner; whether anything had to be. What was handed out is slow.
    fn slow_behind(&mut self, corner: usize, feed: f64) -> bool {
        let mut slower = false;
        let mut left = self.reach_beside(corner, feed);
        let mut index = corner + 1;
        while left > 0.0 && index < self.pulses.len() {
            let pulse = &self.pulses[index];
            if index >= self.fixed && pulse.feed > feed {
                slower = true;
                if pulse.length > WORTH_A_CUT * left {
                    self.cut(index, left);
                }
                self.pulses[index].feed = feed;
            }
            let pulse = &self.pulses[index];
            left -= pulse.length + feed * (self.chain.total() - pulse.overlap);
            index += 1;
        }
        slower
    }
}
