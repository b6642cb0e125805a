//! Solves one linearised window by a predictor-corrector interior-point method.
//!
//! Unknown are the states at the nodes, the jerks of the intervals, the stretch of each segment's
//! duration and the excess over the bounds. Each iteration weighs all rows, eliminates jerks and
//! stretches from the last node to the first ([`front`](crate::solver::riccati)), and goes back twice: once
//! to predict, once to correct.
//!
//! Source: Mehrotra's method with the scaling of Nesterov and Todd. Not here: what to do with the
//! stretches, see [`durations`](crate::solver::sequential).

pub(crate) mod border;
mod passes;
mod start;
mod sweep;

#[cfg(test)]
mod conic;

#[cfg(test)]
mod dense;

#[cfg(test)]
mod digits;

use crate::problem::b_spline::State;
use crate::problem::constraints::Rows;
use crate::problem::{NodeRows, Problem};
use crate::solver::cone::{Centre, Reach, Side, Sums};
use crate::solver::riccati::{Gain, StretchGain};
use border::Border;
use passes::{Advance, Aim, Predict};
use sweep::Tail;
use toolglide_kinematics::Vector;

/// Iterations after which a problem is given up.
const MAX_ITERATIONS: u32 = 50;

/// Where the predicted step is shorter, its second order says little about a step that can be gone.
const SHORT_STEP: f64 = 0.1;

/// After a shorter step the next one does not make up for all that the multipliers miss, but for as much as
/// it brings slacks and multipliers nearer to their bounds: what they miss may be what no longer step can
/// make up for.
const LOST_STEP: f64 = 0.05;

/// Share of the way to the nearest bound that is gone.
const STEP_SHARE: f64 = 0.995;

/// Least share of the complementarity to aim at.
const MIN_CENTERING: f64 = 1e-6;

/// Inequalities per unit of the objective: keeps multipliers near one.
const ROWS_PER_UNIT: f64 = 20.0;

/// Iterations without progress after which a problem is given up, and what steps are progress while
/// something is missed.
const MAX_STALLED: u32 = 8;
const STALLED_STEP: f64 = 0.05;
const SETTLED: f64 = 1e-6;

/// What is to be minimised.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Goal {
    /// The duration, and the excess with this weight; stretches stay below the trust of each
    /// segment.
    Shorten {
        /// Weight of the excess.
        excess: f64,
    },
    /// The excess alone, with durations fixed, until it is not above this.
    Restore {
        /// Excess that suffices.
        enough: f64,
    },
    /// The mean square of jerk and of the distance from the path, and the excess with this weight, with
    /// durations fixed.
    Smooth {
        /// Weight of the excess.
        excess: f64,
    },
}

/// When a problem counts as solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Precision {
    /// Largest gap between objective and bound of the objective, relative to the duration.
    pub(crate) gap: f64,
    /// Largest share of the first miss of the dynamics that may be left.
    pub(crate) miss: f64,
    /// Weight of the mean square of jerk against duration.
    pub(crate) smoothing: f64,
}

/// How solving ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    Solved,
    Stalled,
    Broken,
}

/// What solving came to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outcome {
    pub(crate) ending: Ending,
    pub(crate) iterations: u32,
    /// Gap that is left.
    pub(crate) gap: f64,
    /// Share of the first miss that is left.
    pub(crate) miss: f64,
}

/// The iterate and the workspace, reused between problems.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interior<const N: usize> {
    pub(crate) states: Vec<State<N>>,
    pub(crate) jerks: Vec<Vector<N>>,
    pub(crate) stretches: Vec<f64>,
    pub(crate) excess: f64,
    /// Largest stretch of each segment, either way.
    pub(crate) trust: Vec<f64>,
    rows: Vec<NodeRows<N>>,
    stretch_rows: Vec<[Side; 2]>,
    excess_row: Side,
    misses: Vec<State<N>>,
    gains: Vec<Gain<N>>,
    stretch_gains: Vec<StretchGain<N>>,
    tail: Tail<N>,
    excess_gain: [f64; 2],
    state_changes: Vec<State<N>>,
    jerk_changes: Vec<Vector<N>>,
    stretch_changes: Vec<f64>,
    excess_change: f64,
    border: Border<N>,
}

impl<const N: usize> Interior<N> {
    /// Makes room for windows of so many segments and intervals.
    pub(crate) fn reserve(&mut self, segments: usize, steps: usize) {
        self.states.reserve(steps + 1);
        self.jerks.reserve(steps);
        self.rows.reserve(steps + 1);
        self.misses.reserve(steps);
        self.gains.reserve(steps);
        self.state_changes.reserve(steps + 1);
        self.jerk_changes.reserve(steps);
        self.stretches.reserve(segments);
        self.trust.reserve(segments);
        self.stretch_rows.reserve(segments);
        self.stretch_gains.reserve(segments);
        self.stretch_changes.reserve(segments);
    }

    /// Makes room for so many end conditions.
    pub(crate) fn reserve_conditions(&mut self, conditions: usize, segments: usize, steps: usize) {
        self.border.reserve(conditions, segments, steps);
    }

    /// Solves a problem from the states and jerks at hand, in at most so many iterations.
    pub(crate) fn solve(
        &mut self,
        problem: &mut Problem<N>,
        goal: Goal,
        precision: &Precision,
        most: u32,
    ) -> Outcome {
        let most = most.min(MAX_ITERATIONS);
        let degree = problem.degree();
        let unit = degree / ROWS_PER_UNIT;
        self.prepare(problem);
        let shortening = problem.hold_durations();
        let straight = self.straighten(problem, goal);
        problem.free_durations(shortening);
        let problem = &*problem;
        let floor = self.reset(problem, goal);
        let mut outcome = Outcome {
            ending: Ending::Stalled,
            iterations: 0,
            gap: f64::INFINITY,
            miss: if straight { 0.0 } else { 1.0 },
        };
        let (mut unbound, mut best, mut stalled, mut last) = (1.0_f64, f64::INFINITY, 0, 1.0_f64);
        loop {
            let mut sums = Sums::default();
            let weighed = self.weigh(problem, goal, unit, precision.smoothing, floor, &mut sums);
            outcome.gap = sums.complementarity / unit;
            let merit = outcome.gap + outcome.miss + unbound;
            if !merit.is_finite() || !weighed {
                outcome.ending = Ending::Broken;
                return outcome;
            }
            let solved = outcome.miss < precision.miss
                && match goal {
                    Goal::Restore { enough } if self.excess <= enough => true,
                    _ => outcome.gap < precision.gap && unbound < precision.gap,
                };
            if solved {
                outcome.ending = Ending::Solved;
                return outcome;
            }
            if merit < 0.9 * best {
                best = merit;
                stalled = 0;
            } else {
                stalled += 1;
            }
            if stalled > MAX_STALLED || outcome.iterations == most {
                return outcome;
            }
            outcome.iterations += 1;
            self.go(problem);
            let mut reach = Reach::default();
            self.predict(problem, &mut reach);
            let keep = if last < LOST_STEP { unbound } else { 0.0 };
            let centre = centre(sums.complementarity, &reach, degree, keep);
            self.correct(problem, goal, unit, precision.smoothing, centre);
            self.go(problem);
            if !self.excess_change.is_finite() {
                // The excess depends on every row: the iterate is still good, its step is not.
                outcome.ending = Ending::Broken;
                return outcome;
            }
            let mut reach = Reach::default();
            self.aim(problem, &mut reach);
            let primal = (STEP_SHARE / reach.primal.max(STEP_SHARE)).min(1.0);
            let dual = (STEP_SHARE / reach.dual.max(STEP_SHARE)).min(1.0);
            last = primal.max(dual);
            self.advance(problem, primal, dual);
            if outcome.miss.max(unbound) > SETTLED && primal.max(dual) > STALLED_STEP {
                stalled = 0;
            }
            outcome.miss *= 1.0 - primal;
            unbound += dual * (centre.kept - unbound);
        }
    }

    fn each<F>(&mut self, problem: &Problem<N>, mut with: F)
    where
        F: FnMut(&mut NodeRows<N>, usize, &State<N>, &Vector<N>, [f64; 2]),
    {
        let steps = problem.steps();
        for node in 0..=steps {
            let (ahead, behind) = (
                self.stretch_changes[problem.segment_of(node)],
                self.stretch_changes[problem.segment_of(node.saturating_sub(1))],
            );
            let jerk = self
                .jerk_changes
                .get(node)
                .copied()
                .unwrap_or(Vector::zeros());
            with(
                &mut self.rows[node],
                node,
                &self.state_changes[node],
                &jerk,
                [ahead, behind],
            );
        }
    }

    fn predict(&mut self, problem: &Problem<N>, reach: &mut Reach) {
        let (steps, excess) = (problem.steps(), self.excess_change);
        self.each(problem, |rows, node, state, jerk, [ahead, behind]| {
            let mut predict = Predict {
                state,
                stretch: ahead,
                excess,
                reach,
            };
            if node < steps {
                rows.jerk
                    .predict(problem.by_jerk(), jerk, excess, predict.reach);
                problem.visit_ahead(node, rows, &mut predict);
            }
            if node > 0 {
                predict.stretch = behind;
                problem.visit_behind(node, rows, &mut predict);
            }
        });
        if problem.stretching() {
            for (rows, change) in self.stretch_rows.iter_mut().zip(&self.stretch_changes) {
                rows[0].predict(-change, reach);
                rows[1].predict(*change, reach);
            }
        }
        self.excess_row.predict(excess, reach);
    }

    fn aim(&mut self, problem: &Problem<N>, reach: &mut Reach) {
        let (steps, excess) = (problem.steps(), self.excess_change);
        self.each(problem, |rows, node, state, jerk, [ahead, behind]| {
            let mut aim = Aim {
                state,
                stretch: ahead,
                excess,
                reach,
            };
            if node < steps {
                rows.jerk.aim(problem.by_jerk(), jerk, excess, aim.reach);
                problem.visit_ahead(node, rows, &mut aim);
            }
            if node > 0 {
                aim.stretch = behind;
                problem.visit_behind(node, rows, &mut aim);
            }
        });
        if problem.stretching() {
            for (rows, change) in self.stretch_rows.iter_mut().zip(&self.stretch_changes) {
                rows[0].aim(-change, reach);
                rows[1].aim(*change, reach);
            }
        }
        self.excess_row.aim(excess, reach);
    }

    fn advance(&mut self, problem: &Problem<N>, primal: f64, dual: f64) {
        let steps = problem.steps();
        self.each(problem, |rows, node, _, _, _| {
            let mut advance = Advance { primal, dual };
            if node < steps {
                rows.jerk.advance(primal, dual);
                problem.visit_ahead(node, rows, &mut advance);
            }
            if node > 0 {
                problem.visit_behind(node, rows, &mut advance);
            }
        });
        if problem.stretching() {
            for row in self.stretch_rows.iter_mut().flatten() {
                row.advance(primal, dual);
            }
        }
        self.excess_row.advance(primal, dual);
        self.excess += primal * self.excess_change;
        for (stretch, change) in self.stretches.iter_mut().zip(&self.stretch_changes) {
            *stretch += primal * change;
        }
        for (state, change) in self.states.iter_mut().zip(&self.state_changes) {
            for order in 0..3 {
                state[order] += change[order] * primal;
            }
        }
        for (jerk, change) in self.jerks.iter_mut().zip(&self.jerk_changes) {
            *jerk += change * primal;
        }
    }
}

/// What the correcting step aims at after a predicted one: the less that one gains, the nearer to the middle,
/// and the more it keeps of what the first multipliers missed.
fn centre(complementarity: f64, reach: &Reach, degree: f64, keep: f64) -> Centre {
    let (primal, dual) = (1.0 / reach.primal.max(1.0), 1.0 / reach.dual.max(1.0));
    let predicted = complementarity
        + primal * reach.by_slack
        + dual * reach.by_multiplier
        + primal * dual * reach.by_both;
    let left = (predicted / complementarity).clamp(0.0, 1.0);
    let share = (left * left * left).max(MIN_CENTERING);
    Centre {
        complementarity: share * complementarity / degree,
        second_order: if primal.min(dual) < SHORT_STEP {
            primal * dual
        } else {
            1.0
        },
        kept: share * keep,
    }
}

fn weight_of_excess(goal: Goal) -> f64 {
    match goal {
        Goal::Shorten { excess } | Goal::Smooth { excess } => excess,
        Goal::Restore { .. } => 1.0,
    }
}
