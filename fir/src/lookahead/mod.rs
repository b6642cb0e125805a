//! Decides when pulses begin and how fast they are: a dwell at sharp corners, a lower feedrate
//! where corners are dense.
//!
//! Corners are sorted, feedrates are brought in step with each other, and what breaks the bound is
//! corrected. What is known always ends at rest, so that there is a plan to carry out when no other one
//! goes on from what was handed out.
//!
//! Source: section 4.3; the bound over the whole window and what is done about it are ours. Not here:
//! the bound itself.

#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

mod alone;
pub(crate) mod arc_feed;
pub(crate) mod arcs;
pub(crate) mod bound;
pub(crate) mod circle_feed;
pub(crate) mod command;
mod corner_allowance;
mod corners;
mod correction;
mod feasibility;
mod feedrates;
pub(crate) mod queue;
mod staircase;
mod stops;
mod time_constants;

use crate::chords::Shape;
use crate::filter::cubic::CubicChain;
use crate::pulse::Pulse;
use crate::settings::{designed_for, largest_change};
use arc_feed::ArcFeed;
use arcs::Arcs;
use bound::Schedule;
use command::{Command, TimedPulse};
use corners::RunEnd;
use correction::Standing;
use feedrates::Corners;
use toolglide_kinematics::{Limits, Vector};

/// Pulses that wait before the first of them are handed out.
const PENDING: usize = 128;

/// Pulses that are handed out then: the fewer wait for the next time, the fewer are planned twice.
const HANDED_OUT: usize = 96;

/// Pulses that pending ones are cut into at most.
const CUT: usize = 2048;

/// Pulses that may still be in the window of the filters; when there are more, the motion rests.
const CONTEXT: usize = 384;

/// Times that steps are looked for before all corners count as passed at speed.
const TRIES: u32 = 2;

/// What turns may differ by, relative: above the rounding of vertices, below what changes of velocity may
/// exceed their bound by.
const EVEN: f64 = 1e-11;

/// What is aimed at, as a share of the tolerance, when a bound is broken.
const AIM: f64 = 0.9995;

/// Where pulses wait for their times.
#[derive(Clone, Debug)]
pub(crate) struct LookAhead<const N: usize> {
    limits: Limits<N>,
    /// Whether the chain is chosen.
    chosen: bool,
    chain: CubicChain,
    /// Largest change of velocity of each axis within the window.
    change: Vector<N>,
    /// One over it.
    per_change: Vector<N>,
    pulses: Vec<Pulse<N>>,
    arcs: Arcs<N>,
    /// What waited before chains were tried.
    waiting: Vec<Pulse<N>>,
    /// What the best chain makes of it.
    best: Vec<Pulse<N>>,
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
    /// How many in a row, up to the last one, are alone in the filters in their middle.
    alone: usize,
    /// Whether the chain was chosen for moves that are alone, before much of the path was known.
    early: bool,
    /// What goes on behind the chain of the moves that were alone.
    going_on: Vec<Pulse<N>>,
    /// How many came since the feedrate of the program changed.
    unchanged: usize,
    /// Whether pulses went before the first one that is kept.
    underway: bool,
    /// Whether every pulse may follow rest.
    capped: bool,
    /// The same of what was planned last.
    planned_capped: bool,
    schedule: Schedule,
    standing: Vec<Standing>,
    /// How far corners are from both ends of their runs.
    behind: Vec<RunEnd>,
    ahead: Vec<RunEnd>,
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
        let change = largest_change(&limits, &chain);
        Self {
            change,
            per_change: change.map(f64::recip),
            limits,
            chosen,
            chain,
            arcs: Arcs::with_capacity(CONTEXT + PENDING),
            waiting: Vec::with_capacity(capacity),
            best: Vec::with_capacity(capacity),
            pulses: Vec::with_capacity(capacity),
            kept: Vec::with_capacity(capacity),
            cuts: Vec::with_capacity(capacity),
            before: Vec::with_capacity(capacity),
            times: Vec::with_capacity(capacity),
            fixed: 0,
            planned: 0,
            legs: 0,
            alone: 0,
            early: false,
            going_on: Vec::with_capacity(capacity),
            unchanged: 0,
            underway: false,
            capped: false,
            planned_capped: false,
            schedule: Schedule::with_capacity(capacity),
            standing: Vec::with_capacity(capacity),
            behind: Vec::with_capacity(capacity),
            ahead: Vec::with_capacity(capacity),
            slower: Vec::with_capacity(capacity),
            longer: Vec::with_capacity(capacity),
        }
    }

    /// The filters that are in use.
    pub(crate) fn chain(&self) -> &CubicChain {
        &self.chain
    }

    /// Takes the arc that the next pulses are part of.
    pub(crate) fn begin_arc(&mut self, bend: ArcFeed<N>, shape: Shape, feedrate: f64) -> u32 {
        self.arcs
            .push((bend, shape), feedrate, &self.chain, &self.change)
    }

    /// Takes the next pulse; what is decided goes to `out`.
    #[inline]
    pub(crate) fn push(&mut self, pulse: Pulse<N>, out: &mut impl FnMut(Command<N>)) {
        self.unchanged += 1;
        if let Some(before) = self.pulses.last_mut() {
            if (before.programmed - pulse.programmed).abs() > 0.0 {
                self.unchanged = 0;
            }
            before.turn = (pulse.direction - before.direction).norm();
            before.even = match before.arc {
                Some(arc) => before.turn <= self.arcs.turn_of(arc) * (1.0 + EVEN),
                None => false,
            };
        }
        self.pulses.push(pulse);
        self.legs += 1;
        if !self.chooses() {
            self.limit(self.pulses.len() - 1);
        }
        self.count_alone();
        if self.is_divided() {
            self.divide(out);
        } else if self.legs >= PENDING {
            self.go_on(out);
        }
    }

    /// Decides what waits and hands the first of it out.
    #[inline(never)]
    fn go_on(&mut self, out: &mut impl FnMut(Command<N>)) {
        self.decide(out);
        // Fewer wait where the motion came to rest before them.
        if self.legs >= PENDING {
            let mut until = self.fixed;
            for _ in 0..HANDED_OUT {
                while self.pulses[until].part {
                    until += 1;
                }
                until += 1;
            }
            self.legs -= HANDED_OUT;
            self.hand_out(until, out);
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
        }
        if self.pulses.len() > self.fixed {
            self.hand_out(self.pulses.len(), out);
        }
        self.begin_again(out);
    }

    fn begin_again(&mut self, out: &mut impl FnMut(Command<N>)) {
        self.pulses.clear();
        self.fixed = 0;
        self.planned = 0;
        self.legs = 0;
        self.alone = 0;
        self.early = false;
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
        if self.fixed > 0 {
            self.before.clear();
            self.before
                .extend_from_slice(&self.pulses[self.fixed - 1..]);
        }
        if self.attempt(false) {
            self.planned = self.pulses.len();
            self.planned_capped = false;
            return true;
        }
        if self.fixed > 0 {
            self.restore();
        }
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
        if !self.choose_feedrates() {
            return false;
        }
        self.overlap_dwells();
        let mut in_step = false;
        if self.correct() && !capped {
            in_step = self.in_step();
            if !in_step {
                self.ramp();
                self.time();
            }
        }
        self.stop_where_faster() || in_step || self.in_step()
    }

    /// The first choice of feedrates and dwells; `false` where what was handed out is too fast for a move.
    fn choose_feedrates(&mut self) -> bool {
        if self.unchanged < self.pulses.len() {
            for pulse in &mut self.pulses {
                pulse.careful = false;
            }
        }
        for _ in 0..TRIES {
            self.sort_corners();
            self.slow_down();
            let Some(kept) = self.keep_feedrates(Corners::AtSpeed) else {
                return false;
            };
            self.ramp();
            if !kept.left_out {
                return true;
            }
            match self.keep_feedrates(Corners::All) {
                None => return false,
                Some(kept) if !kept.slower => return true,
                // Steps begin behind what has to be slow, so they are found anew.
                Some(_) => self.join(self.fixed),
            }
        }
        self.sort_corners();
        self.slow_down();
        let slow = self.keep_feedrates(Corners::All).is_some();
        self.ramp();
        slow
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
