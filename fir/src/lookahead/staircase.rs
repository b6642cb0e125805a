//! Raises and lowers feedrates in steps, so that each axis changes its velocity by no more than the
//! chain allows within its longest filter.
//!
//! Source: ours; section 4.2 starts every block from rest, so that a chain must be as long as its
//! feedrate asks. A feedrate that falls never increases the bound of the deviation: it is as good as many
//! small dwells. Not here: that bound, and where a chain has to wait.

use crate::lookahead::LookAhead;
use crate::lookahead::bound::TOUCH;
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
    /// Lowers feedrates and cuts long pulses into steps, from both ends, unless every pulse may follow rest.
    pub(super) fn ramp(&mut self) {
        if self.capped {
            return;
        }
        // Changes between velocities of which each is half of what may change are never too large.
        if self
            .pulses
            .iter()
            .all(|pulse| pulse.feed <= 0.5 * pulse.step)
        {
            return;
        }
        self.rise(0);
        let mut until = self.pulses.len();
        for _ in 1..ROUNDS {
            let Some(first) = self.fall(until) else {
                break;
            };
            match self.rise(first) {
                Some(last) => until = last,
                None => break,
            }
        }
    }

    /// Dwell between a pulse and the one after it, and whether there is one, or room for one.
    fn dwell_after(&self, pulse: &Pulse<N>) -> (f64, bool) {
        let gap = self.chain.total() - pulse.overlap;
        (gap, !pulse.pass || gap > 0.0)
    }

    /// Keeps each pulse from one on in step with those before it; the last one that is slower now.
    fn rise(&mut self, from: usize) -> Option<usize> {
        let (long, total) = (self.chain.long(), self.chain.total());
        let count = self.pulses.len();
        let from = from.max(self.fixed);
        let mut lowered = None;
        let mut clock = 0.0;
        // When the run along one arc at one feedrate began.
        let mut since = 0.0;
        // What is gone before the first of them begins has no times.
        let first = self.first_beside(from);
        self.times.clear();
        self.times
            .resize(first, (f64::NEG_INFINITY, f64::NEG_INFINITY));
        // What comes after the first cut.
        let mut rest = core::mem::take(&mut self.cuts);
        rest.clear();
        let mut cut = None;
        for index in first..count {
            let mut at = index;
            if let Some(cut) = cut {
                at = self.pulses.len();
                self.pulses.push(rest[index - cut]);
            }
            if let Some(before) = at.checked_sub(1) {
                let before = &self.pulses[before];
                let gap = if index < self.fixed {
                    self.pulses[index].gap
                } else {
                    self.dwell_after(before).0
                };
                clock += gap;
                if gap > 0.0 || !before.turns_on(&self.pulses[at]) {
                    since = clock;
                }
            }
            // Turns of one arc are in step with each other.
            while index >= from && since + long > clock {
                let pulse = &self.pulses[at];
                let feed = self.feed_after(at, clock);
                if feed >= pulse.feed * (1.0 - TOO_HIGH) {
                    break;
                }
                lowered = Some(at);
                since = clock;
                let head = feed * long;
                if !self.is_worth_a_cut(pulse, head, at + count - index) {
                    self.pulses[at].feed = feed;
                    break;
                }
                let (mut before, after) = pulse.split(head);
                before.overlap = total;
                before.feed = feed;
                if cut.is_none() {
                    cut = Some(index + 1);
                    rest.extend(self.pulses.drain(index + 1..));
                }
                self.pulses[at] = before;
                self.pulses.push(after);
                self.times.push((clock, clock + long));
                clock += long;
                since = clock;
                at += 1;
            }
            let pulse = &self.pulses[at];
            let end = clock + pulse.length / pulse.feed;
            self.times.push((clock, end));
            clock = end;
        }
        self.cuts = rest;
        lowered
    }

    /// The first pulse that may be in the longest filter together with one.
    fn first_beside(&self, pulse: usize) -> usize {
        let mut time = 0.0;
        let mut first = pulse;
        while first > 0 && time <= self.chain.long() + TOUCH {
            first -= 1;
            time += self.pulses[first].length / self.pulses[first].feed;
        }
        first
    }

    /// Largest feedrate of a pulse after those before it.
    fn feed_after(&self, at: usize, begin: f64) -> f64 {
        let (pulses, long) = (&self.pulses, self.chain.long());
        let pulse = &pulses[at];
        let mut feed = pulse.feed;
        let mut since = begin;
        for index in (0..at).rev() {
            let earlier = &pulses[index];
            let dwells = if index + 1 < self.fixed {
                pulses[index + 1].gap > 0.0
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
            feed = self.feed_beside(feed, pulse, earlier);
            since = self.times[index].0;
        }
        if !self.underway && since + long > begin + TOUCH {
            feed = feed.min(pulse.step);
        }
        feed
    }

    /// Keeps each pulse before one in step with those after it; the first one that is slower now.
    fn fall(&mut self, last: usize) -> Option<usize> {
        let (long, total) = (self.chain.long(), self.chain.total());
        let count = self.pulses.len();
        let mut lowered = None;
        // Time runs backward from the end.
        let mut clock = 0.0;
        let mut until = 0.0;
        self.times.clear();
        // What comes before the last cut and after it, the last pulse first.
        let mut done = core::mem::take(&mut self.cuts);
        done.clear();
        let mut cut = false;
        for index in (self.fixed..count).rev() {
            let pulse = &self.pulses[index];
            let next = match cut {
                true => done.last(),
                false => self.pulses.get(index + 1),
            };
            if let Some(next) = next {
                let gap = self.dwell_after(pulse).0;
                clock += gap;
                if gap > 0.0 || !pulse.turns_on(next) {
                    until = clock;
                }
            }
            let steady = index >= last || until + long <= clock;
            if !cut {
                let in_step = |feed: f64| feed >= pulse.feed * (1.0 - TOO_HIGH);
                let after = self.pulses[index + 1..].iter();
                if steady || in_step(self.feed_before(pulse, after, clock)) {
                    let end = clock + pulse.length / pulse.feed;
                    self.times.push((clock, end));
                    clock = end;
                    continue;
                }
            }
            let mut pulse = *pulse;
            loop {
                let feed = if steady {
                    pulse.feed
                } else if cut {
                    self.feed_before(&pulse, done.iter().rev(), clock)
                } else {
                    self.feed_before(&pulse, self.pulses[index + 1..].iter(), clock)
                };
                if feed >= pulse.feed * (1.0 - TOO_HIGH) {
                    break;
                }
                lowered = Some(index);
                until = clock;
                let tail = feed * long;
                let others = if cut { done.len() } else { count - 1 - index };
                if !self.is_worth_a_cut(&pulse, tail, others + index + 1) {
                    pulse.feed = feed;
                    break;
                }
                let (mut before, mut after) = pulse.split(pulse.length - tail);
                before.overlap = total;
                after.feed = feed;
                if !cut {
                    cut = true;
                    done.extend(self.pulses.drain(index + 1..).rev());
                }
                self.times.push((clock, clock + long));
                clock += long;
                until = clock;
                done.push(after);
                pulse = before;
            }
            let end = clock + pulse.length / pulse.feed;
            self.times.push((clock, end));
            clock = end;
            if cut {
                done.push(pulse);
            } else {
                self.pulses[index].feed = pulse.feed;
            }
        }
        if cut {
            self.pulses.truncate(self.fixed);
            self.pulses.extend(done.iter().rev());
        }
        self.cuts = done;
        lowered
    }

    /// Largest feedrate of a pulse before those after it.
    fn feed_before<'a>(
        &self,
        pulse: &'a Pulse<N>,
        after: impl Iterator<Item = &'a Pulse<N>>,
        end: f64,
    ) -> f64 {
        let long = self.chain.long();
        let mut feed = pulse.feed;
        let mut since = end;
        let mut previous = pulse;
        for (later, &(begin, over)) in after.zip(self.times.iter().rev()) {
            if self.dwell_after(previous).1 {
                return if since + long > end + TOUCH {
                    feed.min(pulse.step)
                } else {
                    feed
                };
            }
            if over + long <= end + TOUCH {
                return feed;
            }
            feed = self.feed_beside(feed, pulse, later);
            since = begin;
            previous = later;
        }
        if since + long > end + TOUCH {
            feed = feed.min(pulse.step);
        }
        feed
    }

    /// Whether a pulse is long enough to be cut at a distance from one end, and there is room for one
    /// more than so many pulses.
    fn is_worth_a_cut(&self, pulse: &Pulse<N>, part: f64, count: usize) -> bool {
        pulse.length > (1.0 + WORTH_A_CUT) * part && count < self.pulses.capacity()
    }

    /// Largest feedrate up to `most` with which a pulse may be in the longest filter together with
    /// another one.
    fn feed_beside(&self, most: f64, pulse: &Pulse<N>, other: &Pulse<N>) -> f64 {
        let gap = pulse.direction * most - other.direction * other.feed;
        if (gap.abs() - self.change).max() <= 0.0 {
            return most;
        }
        let mut feed = most;
        for axis in 0..N {
            let share = pulse.direction[axis];
            let (magnitude, sign) = (share.abs(), share.signum());
            let along = other.direction[axis] * other.feed * sign + self.change[axis];
            if magnitude * feed > along {
                feed = along / magnitude;
            }
        }
        feed.max(most.min(CRAWL * pulse.step))
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
        let first = (from..self.pulses.len()).find(|&index| self.pulses[index].part);
        let Some(first) = first else {
            return;
        };
        let mut kept = first + 1;
        for index in first + 1..self.pulses.len() {
            let next = self.pulses[index];
            if self.pulses[kept - 1].part {
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
