//! Decides when pulses begin and how fast they are, so that the motion keeps its tolerance: a dwell at
//! sharp corners, a lower feedrate where corners are dense.
//!
//! Source: section 4.3 for the dwell, whose formula is replaced by one that holds for unequal
//! feedrates; the bound over the whole window and what is done about it are ours. Not here: the
//! bound itself, and what is done where it is broken, see the correction.

mod choice;
mod correction;
mod ramp;

use crate::arcs::Arcs;
use crate::bend::{Bend, turning_feed};
use crate::bound::Schedule;
use crate::cubic::CubicChain;
use crate::pulse::Pulse;
use crate::settings::{designed_for, largest_change};
use crate::sweep::{Command, TimedPulse};
use toolglide_kinematics::{Limits, Vector, largest_multiple};

/// Pulses that wait before the first half of them is handed out.
const PENDING: usize = 128;

/// Pulses that pending ones are cut into at most.
const CUT: usize = 2048;

/// Pulses that may still be in the window of the filters; when there are more, the motion rests.
const CONTEXT: usize = 384;

/// Turns `|t2 - t1|` above this are never passed by slowing down: 2 sin 15°.
const SHARP: f64 = 0.517_638_090_205_041_5;

/// What is aimed at, as a share of the tolerance, when a bound is broken.
const AIM: f64 = 0.9995;

/// Steps in the search of a passing feedrate: each halves what is left of its error.
const PASSING_STEPS: u32 = 8;

/// A passing feedrate is close enough when its bound is within this share below the tolerance.
const PASSING_PRECISION: f64 = 0.005;

/// Where pulses wait for their times.
#[derive(Clone, Debug)]
pub(crate) struct LookAhead<const N: usize> {
    limits: Limits<N>,
    /// Whether the chain is chosen.
    chosen: bool,
    chain: CubicChain,
    /// Largest change of velocity of each axis within the window.
    change: Vector<N>,
    pulses: Vec<Pulse<N>>,
    arcs: Arcs<N>,
    /// What waited before chains were tried.
    waiting: Vec<Pulse<N>>,
    /// What the pulses were before a trial.
    kept: Vec<Pulse<N>>,
    /// The pulses while they are cut.
    cuts: Vec<Pulse<N>>,
    /// What was planned last, and what came after it.
    before: Vec<Pulse<N>>,
    /// When pulses begin and end while their feedrates are found.
    times: Vec<(f64, f64)>,
    /// How many of them were handed out.
    fixed: usize,
    /// How many of them have a plan that ends at rest.
    planned: usize,
    /// How many were not handed out, whatever they are cut into.
    legs: usize,
    /// Whether pulses went before the first one that is kept.
    underway: bool,
    /// Whether every pulse may follow rest.
    capped: bool,
    /// The same of what was planned last.
    planned_capped: bool,
    schedule: Schedule,
    dirty: Vec<bool>,
    slower: Vec<f64>,
    longer: Vec<f64>,
}

impl<const N: usize> LookAhead<N> {
    /// Nothing waits; without a chain, time constants are chosen whenever motion begins.
    pub(crate) fn new(limits: Limits<N>, chain: Option<CubicChain>) -> Self {
        let capacity = CUT + CONTEXT;
        let chosen = chain.is_none();
        let fastest = limits.velocity().max();
        let chain = chain.unwrap_or_else(|| designed_for(&limits, fastest));
        Self {
            change: largest_change(&limits, &chain),
            limits,
            chosen,
            chain,
            arcs: Arcs::with_capacity(CONTEXT + PENDING),
            waiting: Vec::with_capacity(capacity),
            pulses: Vec::with_capacity(capacity),
            kept: Vec::with_capacity(capacity),
            cuts: Vec::with_capacity(capacity),
            before: Vec::with_capacity(capacity),
            times: Vec::with_capacity(capacity),
            fixed: 0,
            planned: 0,
            legs: 0,
            underway: false,
            capped: false,
            planned_capped: false,
            schedule: Schedule::with_capacity(capacity),
            dirty: Vec::with_capacity(capacity),
            slower: Vec::with_capacity(capacity),
            longer: Vec::with_capacity(capacity),
        }
    }

    /// The filters that are in use.
    pub(crate) fn chain(&self) -> &CubicChain {
        &self.chain
    }

    /// Takes the arc that the next pulses are part of.
    pub(crate) fn begin_arc(&mut self, bend: Bend<N>, feedrate: f64) -> u32 {
        self.arcs.push(bend, feedrate, &self.chain, &self.change)
    }

    /// Takes the next pulse; what is decided goes to `out`.
    pub(crate) fn push(&mut self, pulse: Pulse<N>, out: &mut impl FnMut(Command<N>)) {
        if let Some(before) = self.pulses.last_mut() {
            before.turn = (pulse.direction - before.direction).norm();
        }
        self.pulses.push(pulse);
        self.legs += 1;
        self.limit(self.pulses.len() - 1);
        if self.legs >= PENDING {
            self.decide(out);
            let mut half = self.fixed;
            for _ in 0..PENDING / 2 {
                while self.pulses[half].part {
                    half += 1;
                }
                half += 1;
            }
            self.legs -= PENDING / 2;
            self.hand_out(half, out);
            if self.fixed > CONTEXT {
                self.rest(out);
            }
        }
    }

    /// Decides all that waits; the motion comes to rest.
    pub(crate) fn rest(&mut self, out: &mut impl FnMut(Command<N>)) {
        if self.pulses.is_empty() {
            return;
        }
        if self.pulses.len() > self.fixed {
            self.decide(out);
            self.hand_out(self.pulses.len(), out);
        }
        self.begin_again(out);
    }

    fn begin_again(&mut self, out: &mut impl FnMut(Command<N>)) {
        self.pulses.clear();
        self.fixed = 0;
        self.planned = 0;
        self.legs = 0;
        self.underway = false;
        out(Command::Rest);
    }

    fn hand_out(&mut self, until: usize, out: &mut impl FnMut(Command<N>)) {
        for index in self.fixed..until {
            let begin = self.schedule.begin(index);
            let gap = if index == 0 {
                0.0
            } else {
                (begin - self.schedule.end(index - 1)).max(0.0)
            };
            let pulse = &mut self.pulses[index];
            pulse.gap = gap;
            out(Command::Pulse(TimedPulse {
                gap,
                duration: pulse.length / pulse.feed,
                from: pulse.from,
                to: pulse.to,
                velocity: pulse.direction * pulse.feed,
                serves: pulse.serves,
            }));
        }
        self.fixed = until;
        // What can still be in a window together with what follows.
        let oldest = self.schedule.end(until - 1) - 2.0 * self.chain.total();
        let gone = (0..until)
            .take_while(|&index| self.schedule.end(index) < oldest)
            .count();
        self.pulses.drain(..gone);
        self.fixed -= gone;
        self.planned -= gone;
        self.underway |= gone > 0;
        if let Some(oldest) = self.pulses.iter().find_map(|pulse| pulse.arc) {
            self.arcs.forget_before(oldest);
        }
    }

    /// Chooses feedrates and overlaps of all that was not handed out; `false` where none fits what was.
    fn solve(&mut self) -> bool {
        self.before.clear();
        self.before
            .extend_from_slice(&self.pulses[self.fixed.saturating_sub(1)..]);
        if self.attempt(false) {
            self.planned = self.pulses.len();
            self.planned_capped = false;
            return true;
        }
        self.restore();
        if self.attempt(true) || self.fixed == 0 {
            self.planned = self.pulses.len();
            self.planned_capped = self.capped;
            return true;
        }
        self.restore();
        false
    }

    /// What waits as it was before it was planned.
    fn restore(&mut self) {
        self.pulses.truncate(self.fixed.saturating_sub(1));
        self.pulses.extend_from_slice(&self.before);
    }

    /// One way to choose them: with feedrates that rise in steps, or with such as may follow rest.
    fn attempt(&mut self, capped: bool) -> bool {
        self.capped = capped;
        self.join(self.fixed);
        self.sort_corners();
        self.slow_down();
        if !capped {
            self.ramp();
        }
        self.overlap_dwells();
        if self.correct() && !capped {
            self.ramp();
            self.time();
        }
        self.stop_where_faster();
        self.in_step()
    }

    /// Stops at every corner where that takes less time; longer dwells are always safe.
    fn stop_where_faster(&mut self) {
        let total = self.chain.total();
        let first = self.fixed.saturating_sub(1);
        let end = if self.fixed > 0 {
            self.schedule.end(first)
        } else {
            0.0
        };
        let Some(last) = self.pulses.len().checked_sub(1) else {
            return;
        };
        let planned = self.schedule.end(last) - end;
        let is_corner = |pulse: &Pulse<N>| !pulse.smooth && pulse.turn > 0.0;
        let moving = self.least_time();
        let stops = self.pulses[first..last]
            .iter()
            .filter(|pulse| is_corner(pulse));
        let mut dwelling = 0.0;
        stops.for_each(|_| dwelling += total);
        if planned <= moving + dwelling {
            return;
        }
        self.kept.clear();
        self.kept.extend_from_slice(&self.pulses);
        // Behind the first stop nothing is left of the plan.
        let stop = if self.fixed == 0 {
            0
        } else {
            (first..last)
                .find(|&index| is_corner(&self.pulses[index]))
                .map_or(last, |corner| corner + 1)
        };
        self.join(stop.max(self.fixed));
        if let Some(before) = stop.checked_sub(1)
            && stop <= last
        {
            let corner = &mut self.pulses[before];
            corner.pass = false;
            corner.overlap = 0.0;
        }
        for pulse in &mut self.pulses[stop.max(self.fixed)..] {
            pulse.feed = pulse.limit;
            let stops = is_corner(pulse);
            pulse.pass = !stops;
            pulse.overlap = if stops { 0.0 } else { total };
        }
        let capped = std::mem::replace(&mut self.capped, false);
        self.ramp();
        self.time();
        let last = self.pulses.len() - 1;
        if self.schedule.end(last) - end > planned || !self.in_step() {
            std::mem::swap(&mut self.pulses, &mut self.kept);
            self.capped = capped;
            self.time();
        }
    }

    /// Less time than what waits takes with a full stop at every corner, but for the dwells.
    fn least_time(&self) -> f64 {
        let (mut time, mut length) = (0.0, 0.0);
        for pulse in &self.pulses[self.fixed..] {
            time += pulse.length / pulse.limit;
            length += pulse.length;
            if pulse.part {
                continue;
            }
            let acceleration = pulse.step / self.chain.long();
            if pulse.arc.is_none() && length * acceleration > pulse.limit * pulse.limit {
                let missing = (pulse.limit - pulse.step).max(0.0);
                time += missing * missing / (acceleration * pulse.limit);
            }
            length = 0.0;
        }
        time
    }

    fn allowed(&self, corner: usize) -> f64 {
        let (before, after) = (&self.pulses[corner], &self.pulses[corner + 1]);
        let tolerance = before.tolerance.min(after.tolerance);
        if before.smooth {
            tolerance.max(before.steady)
        } else {
            tolerance
        }
    }

    /// Overlap of a corner by itself: as much is missing before it as is gained behind it, and the
    /// tolerance bounds both.
    fn own_overlap(&self, corner: usize) -> f64 {
        let (before, after) = (&self.pulses[corner], &self.pulses[corner + 1]);
        let total = self.chain.total();
        let reach = self.allowed(corner) / before.turn;
        let slowest = before.feed.min(after.feed);
        if reach >= 0.5 * total * slowest {
            return total;
        }
        let side = |feed: f64| self.chain.time_to(reach / feed);
        (side(before.feed) + side(after.feed)).min(total)
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
    fn sort_corners(&mut self) {
        let total = self.chain.total();
        let half = self.chain.position(0.5 * total);
        for pulse in &mut self.pulses[self.fixed..] {
            pulse.feed = pulse.limit;
            if self.capped {
                pulse.feed = pulse.step.min(pulse.limit);
            }
        }
        for corner in self.fixed.saturating_sub(1)..self.pulses.len().saturating_sub(1) {
            let before = self.pulses[corner];
            if corner < self.fixed && before.sorted {
                // Its feedrate was chosen for this.
                continue;
            }
            if before.smooth {
                self.pulses[corner].pass = true;
                self.pulses[corner].sorted = true;
                self.pulses[corner].overlap = total;
                continue;
            }
            let after = self.pulses[corner + 1];
            let own = self.own_overlap(corner);
            let pass = if before.turn > SHARP {
                false
            } else if corner < self.fixed {
                own >= total
            } else {
                let slowest = before.feed.min(after.feed);
                let share = (self.allowed(corner) / (before.turn * half * slowest)).min(1.0);
                let passing = (share * slowest).min(self.turning_feed(corner));
                let going = self.cost(&before, passing) + self.cost(&after, passing);
                let starting = |pulse: &Pulse<N>| self.cost_of_steps(pulse, pulse.step);
                going < starting(&before) + starting(&after) + (total - own)
            };
            let pulse = &mut self.pulses[corner];
            pulse.pass = pass;
            pulse.sorted = true;
            pulse.overlap = if pass { total } else { own };
        }
    }

    /// Feedrate at which a corner may be passed if all of its neighbours that are passed are passed
    /// as fast.
    fn passing_feed(&self, corner: usize) -> f64 {
        let pulses = &self.pulses;
        let half = 0.5 * self.chain.total();
        let allowed = self.allowed(corner);
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
    fn slow_down(&mut self) {
        let half = 0.5 * self.chain.total();
        let last = self.pulses.len().saturating_sub(1);
        self.slower.clear();
        self.slower.resize(self.pulses.len(), f64::INFINITY);
        for corner in self.fixed.saturating_sub(1)..last {
            let pulse = self.pulses[corner];
            if pulse.pass && pulse.turn > 0.0 {
                let feed = self.passing_feed(corner);
                self.slower[corner] = if self.capped || pulse.smooth {
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

    fn overlap_dwells(&mut self) {
        for corner in self.fixed.saturating_sub(1)..self.pulses.len().saturating_sub(1) {
            if !self.pulses[corner].pass {
                self.pulses[corner].overlap = self.own_overlap(corner);
            }
        }
    }

    fn time(&mut self) {
        self.schedule.time(
            &self.pulses,
            self.fixed,
            &self.chain,
            &self.change,
            self.capped,
        );
    }
}
