//! Chooses how each corner is taken: at speed, slower, or with a dwell.
//!
//! Source: section 4.3 for the dwell, whose formula is replaced by one that holds for unequal
//! feedrates; the choice is ours and is not proved: the correction makes it safe. Not here: the bound.

use super::{AIM, LookAhead};
use crate::lookahead::arc_feed::turning_feed;
use crate::pulse::Pulse;
use toolglide_kinematics::largest_multiple;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// Turns `|t2 - t1|` above this are never passed by slowing down: 2 sin 15°.
const SHARP: f64 = 0.517_638_090_205_041_5;

/// Steps in the search of a passing feedrate: each halves what is left of its error.
const PASSING_STEPS: u32 = 8;

/// A passing feedrate is close enough when its bound is within this share below the tolerance.
const PASSING_PRECISION: f64 = 0.005;

/// An end of a run of pulses along one arc.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RunEnd {
    /// How far away it is.
    distance: f64,
    /// Whether another arc is there.
    meets_arc: bool,
}

impl<const N: usize> LookAhead<N> {
    /// Overlap of a corner by itself: as much is missing before it as is gained behind it, and the
    /// tolerance bounds both.
    fn own_overlap(&self, corner: usize) -> f64 {
        self.overlap_within(corner, f64::INFINITY)
    }

    /// The same with no pulse faster than a feedrate.
    pub(super) fn overlap_within(&self, corner: usize, most: f64) -> f64 {
        let (before, after) = (&self.pulses[corner], &self.pulses[corner + 1]);
        let feeds = [before.feed.min(most), after.feed.min(most)];
        let total = self.chain.total();
        let reach = self.allowed(corner, false) / before.turn;
        if reach >= 0.5 * total * feeds[0].min(feeds[1]) {
            return total;
        }
        let side = |feed: f64| self.chain.time_to(reach / feed);
        (side(feeds[0]) + side(feeds[1])).min(total)
    }

    /// Time lost by one end of a pulse that has to be slow there.
    fn cost(&self, pulse: &Pulse<N>, slow: f64) -> f64 {
        let share = slow / pulse.feed;
        if share >= 1.0 {
            return 0.0;
        }
        let whole = (1.0 / share - 1.0) * 0.5 * pulse.length / pulse.feed;
        let window = (1.0 - share) * 0.5 * self.chain.total();
        whole.min(window + self.cost_of_steps(pulse, slow))
    }

    /// Time lost by steps between a feedrate and that of a pulse.
    fn cost_of_steps(&self, pulse: &Pulse<N>, slow: f64) -> f64 {
        let missing = pulse.feed - slow;
        if missing <= pulse.step {
            return 0.0;
        }
        let acceleration = pulse.step / self.chain.long();
        0.5 * missing * missing / (acceleration * pulse.feed)
    }

    /// Feedrate at which the turn of a corner is no more than axes may change their velocity by.
    fn turning_feed(&self, corner: usize) -> f64 {
        let (before, after) = (&self.pulses[corner], &self.pulses[corner + 1]);
        let step = largest_multiple(&(after.direction - before.direction), &self.change);
        let spacing = 0.5 * (before.length + after.length);
        turning_feed(step, spacing, self.chain.long())
    }

    /// Which corners are passed without a dwell.
    pub(super) fn sort_corners(&mut self) {
        let total = self.chain.total();
        let half = self.chain.position(0.5 * total);
        for pulse in &mut self.pulses[self.fixed..] {
            pulse.feed = pulse.limit;
            if self.capped {
                pulse.feed = pulse.step.min(pulse.limit);
            }
        }
        for corner in self.fixed.saturating_sub(1)..self.pulses.len().saturating_sub(1) {
            let before = &mut self.pulses[corner];
            if corner < self.fixed && before.sorted {
                // Its feedrate was chosen for this.
                continue;
            }
            if before.smooth {
                before.pass = true;
                before.sorted = true;
                before.overlap = total;
                continue;
            }
            let own = self.own_overlap(corner);
            let (before, after) = (&self.pulses[corner], &self.pulses[corner + 1]);
            let pass = if before.turn > SHARP {
                false
            } else if corner < self.fixed {
                own >= total
            } else {
                let slowest = before.feed.min(after.feed);
                let share = (self.allowed(corner, false) / (before.turn * half * slowest)).min(1.0);
                let passing = (share * slowest).min(self.turning_feed(corner));
                let going = self.cost(before, passing) + self.cost(after, passing);
                let starting = |pulse: &Pulse<N>| self.cost_of_steps(pulse, pulse.step);
                going < starting(before) + starting(after) + (total - own)
            };
            let pulse = &mut self.pulses[corner];
            pulse.pass = pass;
            pulse.sorted = true;
            pulse.overlap = if pass { total } else { own };
        }
    }

    /// Feedrate at which a corner may be passed if all of its neighbours that are passed are passed
    /// as fast.
    fn passing_feed(&self, corner: usize, meets_arc: bool) -> f64 {
        let pulses = &self.pulses;
        let half = 0.5 * self.chain.total();
        let allowed = self.allowed(corner, meets_arc);
        let mut feed = pulses[corner].feed.max(pulses[corner + 1].feed);
        for _ in 0..PASSING_STEPS {
            let reach = feed * half;
            let mut bound = pulses[corner].turn * feed * self.chain.position(half);
            let mut distance = 0.0;
            for index in (0..corner).rev() {
                distance += pulses[index + 1].length;
                if distance >= reach || !pulses[index].pass {
                    break;
                }
                bound += pulses[index].turn * feed * self.chain.position(half - distance / feed);
            }
            distance = 0.0;
            for pulse in pulses.iter().take(pulses.len() - 1).skip(corner + 1) {
                distance += pulse.length;
                if distance >= reach || !pulse.pass {
                    break;
                }
                bound += pulse.turn * feed * self.chain.position(half - distance / feed);
            }
            if bound <= allowed && bound >= (1.0 - PASSING_PRECISION) * allowed {
                break;
            }
            let next = feed * (AIM * allowed / bound).sqrt();
            let most = pulses[corner].feed.max(pulses[corner + 1].feed);
            if next >= most {
                if feed >= most {
                    break;
                }
                feed = most;
            } else {
                feed = next;
            }
        }
        feed
    }

    /// Slows the pulses beside corners that are passed; of a long one only what is in the window.
    pub(super) fn slow_down(&mut self) {
        let half = 0.5 * self.chain.total();
        let last = self.pulses.len().saturating_sub(1);
        self.slower.clear();
        self.slower.resize(self.pulses.len(), f64::INFINITY);
        self.measure_runs();
        for corner in self.fixed.saturating_sub(1)..last {
            let pulse = &self.pulses[corner];
            // In the middle of an arc its own feedrate is right.
            let reach = pulse.feed * half;
            let near = |end: RunEnd| end.distance < reach;
            let (behind, ahead) = (self.behind[corner], self.ahead[corner]);
            if pulse.pass && pulse.turn > 0.0 && (near(behind) || near(ahead)) {
                let meets_arc = near(behind) && behind.meets_arc || near(ahead) && ahead.meets_arc;
                let feed = self.passing_feed(corner, meets_arc);
                self.slower[corner] = if self.capped || self.pulses[corner].smooth {
                    feed
                } else {
                    feed.min(self.turning_feed(corner))
                };
            }
        }
        for index in (self.fixed..self.pulses.len()).rev() {
            let tail = self.slower[index];
            let head = match index {
                0 => f64::INFINITY,
                _ => self.slower[index - 1],
            };
            if tail.min(head) >= self.pulses[index].feed {
                continue;
            }
            let pulse = self.pulses[index];
            let slow = |feed: f64| if feed < pulse.feed { feed * half } else { 0.0 };
            let (head_length, tail_length) = (slow(head), slow(tail));
            let whole = pulse.smooth
                || index > 0 && self.pulses[index - 1].smooth
                || pulse.length < 2.0 * (head_length + tail_length);
            if whole {
                self.pulses[index].feed = pulse.feed.min(head).min(tail);
                continue;
            }
            if tail_length > 0.0 {
                self.cut(index, pulse.length - tail_length);
                self.pulses[index + 1].feed = tail;
            }
            if head_length > 0.0 {
                self.cut(index, head_length);
                self.pulses[index].feed = head;
            }
        }
    }

    /// How far each corner is from both ends of its run of pulses along one arc, and what is there.
    fn measure_runs(&mut self) {
        let count = self.pulses.len();
        self.behind.clear();
        self.ahead.clear();
        self.ahead.resize(count, RunEnd::default());
        let mut end = RunEnd::default();
        for (index, pulse) in self.pulses.iter().enumerate() {
            end.distance += pulse.length;
            self.behind.push(end);
            let next = self.pulses.get(index + 1);
            if !next.is_some_and(|next| pulse.goes_on(next)) {
                end = RunEnd {
                    distance: 0.0,
                    meets_arc: pulse.arc.is_some(),
                };
            }
        }
        for index in (1..count).rev() {
            let (pulse, next) = (&self.pulses[index - 1], &self.pulses[index]);
            self.ahead[index - 1] = if pulse.goes_on(next) {
                RunEnd {
                    distance: self.ahead[index].distance + next.length,
                    ..self.ahead[index]
                }
            } else {
                RunEnd {
                    distance: 0.0,
                    meets_arc: next.arc.is_some(),
                }
            };
        }
    }

    pub(super) fn overlap_dwells(&mut self) {
        for corner in self.fixed.saturating_sub(1)..self.pulses.len().saturating_sub(1) {
            if !self.pulses[corner].pass {
                self.pulses[corner].overlap = self.own_overlap(corner);
            }
        }
    }
}
