//! Feedrates rise and fall in steps, so that no axis changes its velocity by more than the chain allows
//! within its longest filter; behind that filter the steps are a ramp.
//!
//! Source: ours; section 4.2 starts every block from rest, so that a chain must be as long as its
//! feedrate asks. A feedrate that falls never increases the bound of the deviation: it is as good as many
//! small dwells. Not here: that bound, and where a chain has to wait.

use super::LookAhead;
use crate::bound::TOUCH;
use crate::pulse::Pulse;

/// Most steps from rest to the largest feedrate: bounds memory.
pub(super) const STEPS: f64 = 16.0;

/// Passes over the window; one each way is enough on a straight line.
const ROUNDS: u32 = 12;

/// A feedrate is lowered when it is too high by more than this, relative: above the rounding, and far
/// below what is left for rounding in the change of velocity.
const TOO_HIGH: f64 = 1e-12;

/// A pulse is cut in two where this share of a step is left for the rest.
const WORTH_A_CUT: f64 = 0.5;

/// Feedrate below which a pulse is not lowered for another one, as a share of what it may start at.
const CRAWL: f64 = 0.02;

impl<const N: usize> LookAhead<N> {
    /// Lowers feedrates and cuts long pulses into steps, from both ends.
    pub(super) fn ramp(&mut self) {
        // Changes between velocities of which each is half of what may change are never too large.
        if self
            .pulses
            .iter()
            .all(|pulse| pulse.feed <= 0.5 * pulse.step)
        {
            return;
        }
        for round in 0..ROUNDS {
            let rising = self.rise();
            if round > 0 && !rising || !self.fall() {
                break;
            }
        }
    }

    /// Dwell between a pulse and the one after it, and whether there is one, or room for one.
    fn dwell_after(&self, pulse: &Pulse<N>) -> (f64, bool) {
        let gap = self.chain.total() - pulse.overlap;
        (gap, !pulse.pass || gap > 0.0)
    }

    /// Keeps each pulse in step with those before it; whether anything changed.
    fn rise(&mut self) -> bool {
        let long = self.chain.long();
        let mut changed = false;
        let mut clock = 0.0;
        let mut cuts = std::mem::take(&mut self.cuts);
        cuts.clear();
        self.times.clear();
        for index in 0..self.pulses.len() {
            let mut pulse = self.pulses[index];
            if index < self.fixed {
                clock += pulse.gap;
            } else if let Some(before) = cuts.last() {
                clock += self.dwell_after(before).0;
            }
            let mut left = self.pulses.len() - index;
            while index >= self.fixed {
                let feed = self.feed_after(&pulse, &cuts, clock);
                if feed >= pulse.feed * (1.0 - TOO_HIGH) {
                    break;
                }
                changed = true;
                let head = feed * long;
                if pulse.length <= (1.0 + WORTH_A_CUT) * head
                    || cuts.len() + left >= cuts.capacity()
                {
                    pulse.feed = feed;
                    break;
                }
                let (mut before, after) = pulse.split(head);
                before.overlap = self.chain.total();
                before.feed = feed;
                self.times.push((clock, clock + head / feed));
                clock += head / feed;
                cuts.push(before);
                pulse = after;
                left += 1;
            }
            let begin = clock;
            clock += pulse.length / pulse.feed;
            self.times.push((begin, clock));
            cuts.push(pulse);
        }
        std::mem::swap(&mut self.pulses, &mut cuts);
        self.cuts = cuts;
        changed
    }

    /// Largest feedrate of a pulse after those before it.
    fn feed_after(&self, pulse: &Pulse<N>, before: &[Pulse<N>], begin: f64) -> f64 {
        let long = self.chain.long();
        let mut feed = pulse.feed;
        let mut since = begin;
        for index in (0..before.len()).rev() {
            let earlier = &before[index];
            let dwells = if index + 1 < self.fixed {
                before[index + 1].gap > 0.0
            } else {
                self.dwell_after(earlier).1
            };
            if dwells {
                // What lies before a dwell waits for it.
                return if since + long > begin + TOUCH {
                    feed.min(pulse.step)
                } else {
                    feed
                };
            }
            if self.times[index].1 + long <= begin + TOUCH {
                return feed;
            }
            feed = feed.min(self.feed_beside(pulse, earlier));
            since = self.times[index].0;
        }
        if !self.underway && since + long > begin + TOUCH {
            feed = feed.min(pulse.step);
        }
        feed
    }

    /// Keeps each pulse in step with those after it; whether anything changed.
    fn fall(&mut self) -> bool {
        let long = self.chain.long();
        let mut changed = false;
        // Time runs backward from the end; the last pulse comes first.
        let mut clock = 0.0;
        let mut cuts = std::mem::take(&mut self.cuts);
        cuts.clear();
        self.times.clear();
        for index in (self.fixed..self.pulses.len()).rev() {
            let mut pulse = self.pulses[index];
            if !cuts.is_empty() {
                clock += self.dwell_after(&pulse).0;
            }
            let mut left = index + 1;
            loop {
                let feed = self.feed_before(&pulse, &cuts, clock);
                if feed >= pulse.feed * (1.0 - TOO_HIGH) {
                    break;
                }
                changed = true;
                let tail = feed * long;
                if pulse.length <= (1.0 + WORTH_A_CUT) * tail
                    || cuts.len() + left >= cuts.capacity()
                {
                    pulse.feed = feed;
                    break;
                }
                let (mut before, mut after) = pulse.split(pulse.length - tail);
                before.overlap = self.chain.total();
                after.feed = feed;
                self.times.push((clock, clock + tail / feed));
                clock += tail / feed;
                cuts.push(after);
                pulse = before;
                left += 1;
            }
            let begin = clock;
            clock += pulse.length / pulse.feed;
            self.times.push((begin, clock));
            cuts.push(pulse);
        }
        self.pulses.truncate(self.fixed);
        self.pulses.extend(cuts.iter().rev());
        self.cuts = cuts;
        changed
    }

    /// Largest feedrate of a pulse before those after it, of which the first comes last.
    fn feed_before(&self, pulse: &Pulse<N>, after: &[Pulse<N>], end: f64) -> f64 {
        let long = self.chain.long();
        let mut feed = pulse.feed;
        let mut since = end;
        let mut previous = pulse;
        for index in (0..after.len()).rev() {
            if self.dwell_after(previous).1 {
                return if since + long > end + TOUCH {
                    feed.min(pulse.step)
                } else {
                    feed
                };
            }
            let (begin, over) = self.times[index];
            if over + long <= end + TOUCH {
                return feed;
            }
            feed = feed.min(self.feed_beside(pulse, &after[index]));
            since = begin;
            previous = &after[index];
        }
        if since + long > end + TOUCH {
            feed = feed.min(pulse.step);
        }
        feed
    }

    /// Largest feedrate with which a pulse may be in the longest filter together with another one.
    fn feed_beside(&self, pulse: &Pulse<N>, other: &Pulse<N>) -> f64 {
        let velocity = other.direction * other.feed;
        let mut feed = f64::INFINITY;
        for axis in 0..N {
            let share = pulse.direction[axis];
            let magnitude = share.abs();
            if magnitude > 0.0 {
                let along = velocity[axis] * share.signum();
                feed = feed.min((along + self.change[axis]) / magnitude);
            }
        }
        feed.max(CRAWL * pulse.step)
    }

    /// Cuts a pulse in two at a distance.
    pub(super) fn cut(&mut self, index: usize, distance: f64) {
        let (mut before, after) = self.pulses[index].split(distance);
        before.overlap = self.chain.total();
        self.pulses[index] = before;
        self.pulses.insert(index + 1, after);
    }

    /// Makes one pulse again of what was cut, from one of them on.
    pub(super) fn join(&mut self, from: usize) {
        let mut kept = from;
        for index in from..self.pulses.len() {
            let next = self.pulses[index];
            if kept > from && self.pulses[kept - 1].part {
                let whole = &mut self.pulses[kept - 1];
                let span = next.to - whole.from;
                *whole = Pulse {
                    from: whole.from,
                    length: span.norm(),
                    ..next
                };
            } else {
                self.pulses[kept] = next;
                kept += 1;
            }
        }
        self.pulses.truncate(kept);
    }
}
