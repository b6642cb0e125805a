//! A predictor-corrector interior-point method for one linearised window.
//!
//! Unknown are the states at the nodes, the jerks of the intervals, the stretch of each segment's
//! duration and the excess over the bounds. Each iteration weighs all rows, eliminates jerks and
//! stretches from the last node to the first ([`front`](crate::front)), and goes back twice: once
//! to predict, once to correct.
//!
//! Source: Mehrotra's method with the scaling of Nesterov and Todd. Not here: what to do with the
//! stretches, see [`durations`](crate::durations).

#[cfg(test)]
mod conic;
#[cfg(test)]
mod dense;
mod passes;

use self::passes::{Advance, Aim, Correct, Predict, Start, Weigh};
use crate::cone::{Centre, Reach, Side, Sums};
use crate::front::{Cost, Form, Gain, Gradient, Interval, Local, Slope, StretchGain};
use crate::problem::{NodeRows, Problem};
use crate::rows::Rows;
use crate::spline::State;
use toolglide_kinematics::Vector;

/// The last intervals, whose jerks the end state demands.
const LAST: usize = 3;

/// Iterations after which a problem is given up.
const MOST_ITERATIONS: u32 = 50;

/// Where the predicted step is shorter, its second order says little about a step that can be gone.
const SHORT_STEP: f64 = 0.1;

/// Share of the way to the nearest bound that is gone.
const STEP_SHARE: f64 = 0.995;

/// The excess starts here, or so much higher that all bounds are kept.
const FIRST_EXCESS: f64 = 0.1;

/// Least share of the complementarity to aim at.
const LEAST_CENTERING: f64 = 1e-6;

/// Inequalities per unit of the objective: keeps multipliers near one.
const ROWS_PER_UNIT: f64 = 20.0;

/// Iterations without progress after which a problem is given up, and what steps are progress while
/// something is missed.
const MOST_STALLED: u32 = 8;
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
}

/// The last intervals as what follows from the state before them.
#[derive(Clone, Copy, Debug, Default)]
struct Tail<const N: usize> {
    states: [[Form<N>; 3]; LAST - 1],
    coefficients: [Form<N>; LAST],
    jerks: [Form<N>; LAST],
    state_pushes: [Gradient<N>; LAST - 1],
    jerk_pushes: [Slope<N>; LAST],
}

impl<const N: usize> Interior<N> {
    /// Solves a problem from the states and jerks at hand.
    pub(crate) fn solve(
        &mut self,
        problem: &mut Problem<N>,
        goal: Goal,
        precision: &Precision,
    ) -> Outcome {
        let degree = problem.degree();
        let unit = degree / ROWS_PER_UNIT;
        self.prepare(problem);
        let shortening = problem.hold_durations();
        self.straighten(problem, goal);
        problem.free_durations(shortening);
        let problem = &*problem;
        let floor = self.reset(problem, goal);
        let mut outcome = Outcome {
            ending: Ending::Stalled,
            iterations: 0,
            gap: f64::INFINITY,
            miss: 1.0,
        };
        let (mut unbound, mut best, mut stalled) = (1.0_f64, f64::INFINITY, 0);
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
            if stalled > MOST_STALLED || outcome.iterations == MOST_ITERATIONS {
                return outcome;
            }
            outcome.iterations += 1;
            self.go(problem);
            let mut reach = Reach::default();
            self.predict(problem, &mut reach);
            let (primal, dual) = (1.0 / reach.primal.max(1.0), 1.0 / reach.dual.max(1.0));
            let predicted = sums.complementarity
                + primal * reach.by_slack
                + dual * reach.by_multiplier
                + primal * dual * reach.by_both;
            let share = (predicted / sums.complementarity).clamp(0.0, 1.0).powi(3);
            let centre = Centre {
                complementarity: share.max(LEAST_CENTERING) * sums.complementarity / degree,
                second_order: if primal.min(dual) < SHORT_STEP {
                    primal * dual
                } else {
                    1.0
                },
            };
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
            self.advance(problem, primal, dual);
            if outcome.miss.max(unbound) > SETTLED && primal.max(dual) > STALLED_STEP {
                stalled = 0;
            }
            outcome.miss *= 1.0 - primal;
            unbound *= 1.0 - dual;
        }
    }

    /// Brings the workspace to size, and the ends of the motion to where they belong.
    fn prepare(&mut self, problem: &Problem<N>) {
        let (steps, segments) = (problem.steps(), problem.segments());
        self.rows.clear();
        self.rows.resize(steps + 1, NodeRows::default());
        self.misses.resize(steps, [Vector::zeros(); 3]);
        self.gains.resize(steps, Gain::default());
        self.state_changes.clear();
        self.state_changes.resize(steps + 1, [Vector::zeros(); 3]);
        self.jerk_changes.resize(steps, Vector::zeros());
        self.states[0] = *problem.start();
        self.states[steps] = *problem.end();
        self.stretches.clear();
        self.stretches.resize(segments, 0.0);
        self.stretch_changes.clear();
        self.stretch_changes.resize(segments, 0.0);
        self.stretch_gains.resize(segments, StretchGain::default());
        self.stretch_rows.resize(segments, [Side::default(); 2]);
        self.excess = 0.0;
        self.excess_row = Side::default();
    }

    /// Makes the motion obey its dynamics: of all that do, the one that lies deepest inside its
    /// bounds in the mean square.
    fn straighten(&mut self, problem: &Problem<N>, goal: Goal) {
        if self.weigh(problem, goal, 0.0, 0.0, 0.0, &mut Sums::default()) {
            self.go(problem);
            for (state, change) in self.states.iter_mut().zip(&self.state_changes) {
                for (value, change) in state.iter_mut().zip(change) {
                    *value += change;
                }
            }
            for (jerk, change) in self.jerks.iter_mut().zip(&self.jerk_changes) {
                *jerk += change;
            }
        }
    }

    /// Starts all slacks and multipliers; gives the least excess.
    fn reset(&mut self, problem: &Problem<N>, goal: Goal) -> f64 {
        for (rows, trust) in self.stretch_rows.iter_mut().zip(&self.trust) {
            for row in rows {
                row.reset(*trust);
            }
        }
        let floor = match goal {
            Goal::Shorten { .. } => 0.0,
            Goal::Restore { .. } => -0.5,
        };
        self.excess = FIRST_EXCESS;
        self.excess += self.reset_rows(problem);
        self.reset_rows(problem);
        self.excess_row.reset(self.excess - floor);
        floor
    }

    /// Starts the rows of all nodes at the excess; gives how much more they need.
    fn reset_rows(&mut self, problem: &Problem<N>) -> f64 {
        let steps = problem.steps();
        let mut needed = 0.0_f64;
        for node in 0..=steps {
            let mut start = Start {
                state: &self.states[node],
                excess: self.excess,
                needed,
            };
            let rows = &mut self.rows[node];
            if node < steps {
                let jerk = &self.jerks[node];
                let more = rows.jerk.reset(problem.by_jerk(), jerk, self.excess);
                start.needed = start.needed.max(more);
                problem.visit_ahead(node, rows, &mut start);
            }
            if node > 0 {
                problem.visit_behind(node, rows, &mut start);
            }
            needed = start.needed;
        }
        needed
    }

    /// Weighs all rows and eliminates; whether every pivot was positive.
    fn weigh(
        &mut self,
        problem: &Problem<N>,
        goal: Goal,
        unit: f64,
        smoothing: f64,
        floor: f64,
        sums: &mut Sums,
    ) -> bool {
        let steps = problem.steps();
        let excess = self.excess;
        for interval in 0..steps {
            let stretch = self.stretches[problem.segment_of(interval)];
            let mut end = problem.after(
                interval,
                &self.states[interval],
                &self.jerks[interval],
                stretch,
            );
            for (end, next) in end.iter_mut().zip(&self.states[interval + 1]) {
                *end -= next;
            }
            self.misses[interval] = problem.basis(interval + 1).coefficients(&end);
        }
        let mut cost = self.weigh_tail(problem, smoothing, sums);
        let mut node = steps - LAST;
        loop {
            let segment = problem.segment_of(node);
            let mut weigh = Weigh {
                state: &self.states[node],
                stretch: self.stretches[segment],
                excess,
                sums,
                cost: &mut cost,
            };
            problem.visit_ahead(node, &mut self.rows[node], &mut weigh);
            if problem.stretching() && problem.starts_segment(node) {
                let stretch = self.stretches[segment];
                let trust = self.trust[segment];
                let [upper, lower] = &mut self.stretch_rows[segment];
                let upper = upper.weigh(trust - stretch, sums);
                let lower = lower.weigh(trust + stretch, sums);
                let slope = unit * problem.share(segment) + lower.1 - upper.1;
                match cost.back_stretch(upper.0 + lower.0, slope) {
                    Some(gain) => self.stretch_gains[segment] = gain,
                    None => return false,
                }
            }
            if node == 0 {
                break;
            }
            let mut weigh = Weigh {
                state: &self.states[node],
                stretch: self.stretches[problem.segment_of(node - 1)],
                excess,
                sums,
                cost: &mut cost,
            };
            problem.visit_behind(node, &mut self.rows[node], &mut weigh);
            node -= 1;
            let jerk = self.weigh_jerk(problem, node, smoothing, sums);
            match cost.back(&problem.interval(node), &self.misses[node], &jerk) {
                Some(gain) => self.gains[node] = gain,
                None => return false,
            }
        }
        let row = self.excess_row.weigh(excess - floor, sums);
        self.excess_gain = [
            cost.excess.max(0.0) + row.0,
            cost.slope.excess + row.1 + weight_of_excess(goal) * unit,
        ];
        self.excess_gain[0] > 0.0
    }

    fn weigh_jerk(
        &mut self,
        problem: &Problem<N>,
        interval: usize,
        smoothing: f64,
        sums: &mut Sums,
    ) -> Local<N> {
        let by_jerk = problem.by_jerk();
        let jerk = self.jerks[interval];
        let mut local = self.rows[interval]
            .jerk
            .weigh(by_jerk, &jerk, self.excess, sums);
        for axis in 0..N {
            let weight = smoothing * by_jerk[axis] * by_jerk[axis];
            local.point[(axis, axis)] += weight;
            local.slope.point[axis] += weight * jerk[axis];
        }
        local
    }

    /// The cost of the last intervals, and how they follow from the state before them.
    fn weigh_tail(&mut self, problem: &Problem<N>, smoothing: f64, sums: &mut Sums) -> Cost<N> {
        let steps = problem.steps();
        let first = steps - LAST;
        let stretch = self.stretches[problem.segments() - 1];
        let misses = &self.misses[first..];
        let intervals: [Interval<N>; LAST] =
            std::array::from_fn(|index| problem.interval(first + index));
        let identity: [Form<N>; 3] = std::array::from_fn(|order| {
            let mut form = Form::default();
            form.state[order] = 1.0;
            form
        });
        // The last coefficients are those of the end state; what moves the nodes moves them back.
        for index in 0..LAST {
            let mut form = Form::default();
            for later in index..LAST {
                let order = index + 2 - later;
                if order < 3 {
                    form.stretch -= intervals[later].by_stretch[order];
                    form.offset -= misses[later][order];
                }
            }
            self.tail.coefficients[index] = form;
        }
        let mut forms = identity;
        for index in 0..LAST {
            let last = self.tail.coefficients[index];
            let mut jerk = Form::default();
            for (weight, form) in intervals[index].jerk.iter().zip(&forms) {
                jerk.plus(*weight, form);
            }
            jerk.plus(intervals[index].jerk[3], &last);
            self.tail.jerks[index] = jerk;
            let mut next = [forms[1], forms[2], last];
            for order in 0..3 {
                next[order].stretch += intervals[index].by_stretch[order];
                next[order].offset += misses[index][order];
            }
            if index < LAST - 1 {
                self.tail.states[index] = next;
            }
            forms = next;
        }
        let mut whole = Cost::default();
        // Of the rows at the end only stretch and excess are free.
        let mut cost = Cost::default();
        let mut weigh = Weigh {
            state: &self.states[steps],
            stretch,
            excess: self.excess,
            sums,
            cost: &mut cost,
        };
        problem.visit_behind(steps, &mut self.rows[steps], &mut weigh);
        whole.add_state(&cost, &[Form::default(); 3]);
        for index in 0..LAST - 1 {
            let node = first + 1 + index;
            let mut cost = Cost::default();
            let mut weigh = Weigh {
                state: &self.states[node],
                stretch,
                excess: self.excess,
                sums,
                cost: &mut cost,
            };
            problem.visit_ahead(node, &mut self.rows[node], &mut weigh);
            problem.visit_behind(node, &mut self.rows[node], &mut weigh);
            self.tail.state_pushes[index] = whole.add_state(&cost, &self.tail.states[index]);
        }
        for index in 0..LAST {
            let jerk = self.weigh_jerk(problem, first + index, smoothing, sums);
            self.tail.jerk_pushes[index] = whole.add_jerk(&jerk, &self.tail.jerks[index]);
        }
        whole
    }

    /// Goes forward: the changes that follow from gains and offsets.
    fn go(&mut self, problem: &Problem<N>) {
        let steps = problem.steps();
        let first = steps - LAST;
        self.excess_change = -self.excess_gain[1] / self.excess_gain[0];
        let mut state = [Vector::zeros(); 3];
        let mut stretch = 0.0;
        for node in 0..=first {
            let segment = problem.segment_of(node);
            if problem.stretching() && problem.starts_segment(node) {
                stretch = self.stretch_gains[segment].forward(&state, self.excess_change);
                self.stretch_changes[segment] = stretch;
            }
            self.state_changes[node] = problem.basis(node).state(&state);
            if node < first {
                (self.jerk_changes[node], state) = self.gains[node].forward(
                    &problem.interval(node),
                    &state,
                    stretch,
                    self.excess_change,
                    &self.misses[node],
                );
            }
        }
        for index in 0..LAST {
            self.jerk_changes[first + index] = self.tail.jerks[index].value(&state, stretch);
        }
        for index in 0..LAST - 1 {
            let node = first + 1 + index;
            let later = self.tail.states[index]
                .each_ref()
                .map(|form| form.value(&state, stretch));
            self.state_changes[node] = problem.basis(node).state(&later);
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

    /// Slopes towards a centre, eliminated with the gains at hand.
    fn correct(
        &mut self,
        problem: &Problem<N>,
        goal: Goal,
        unit: f64,
        smoothing: f64,
        centre: Centre,
    ) {
        let steps = problem.steps();
        let first = steps - LAST;
        let mut whole = Gradient::default();
        let mut gradient = Gradient::default();
        let mut correct = Correct {
            centre,
            gradient: &mut gradient,
        };
        problem.visit_behind(steps, &mut self.rows[steps], &mut correct);
        whole.add_state(&gradient, &[Form::default(); 3]);
        for index in 0..LAST - 1 {
            let node = first + 1 + index;
            let mut gradient = self.tail.state_pushes[index];
            let mut correct = Correct {
                centre,
                gradient: &mut gradient,
            };
            problem.visit_ahead(node, &mut self.rows[node], &mut correct);
            problem.visit_behind(node, &mut self.rows[node], &mut correct);
            whole.add_state(&gradient, &self.tail.states[index]);
        }
        for index in 0..LAST {
            let mut slope = self.correct_jerk(problem, first + index, smoothing, centre);
            slope.point += self.tail.jerk_pushes[index].point;
            slope.excess += self.tail.jerk_pushes[index].excess;
            whole.add_jerk(&slope, &self.tail.jerks[index]);
        }
        let mut node = first;
        loop {
            let segment = problem.segment_of(node);
            let mut correct = Correct {
                centre,
                gradient: &mut whole,
            };
            problem.visit_ahead(node, &mut self.rows[node], &mut correct);
            if problem.stretching() && problem.starts_segment(node) {
                let [upper, lower] = &mut self.stretch_rows[segment];
                whole.stretch +=
                    unit * problem.share(segment) + lower.correct(centre) - upper.correct(centre);
                self.stretch_gains[segment].back(&mut whole);
            }
            if node == 0 {
                break;
            }
            let mut correct = Correct {
                centre,
                gradient: &mut whole,
            };
            problem.visit_behind(node, &mut self.rows[node], &mut correct);
            node -= 1;
            let slope = self.correct_jerk(problem, node, smoothing, centre);
            whole.back(&problem.interval(node), &slope, &mut self.gains[node]);
        }
        self.excess_gain[1] =
            whole.excess + self.excess_row.correct(centre) + weight_of_excess(goal) * unit;
    }

    fn correct_jerk(
        &mut self,
        problem: &Problem<N>,
        interval: usize,
        smoothing: f64,
        centre: Centre,
    ) -> Slope<N> {
        let by_jerk = problem.by_jerk();
        let mut slope = self.rows[interval].jerk.correct(by_jerk, centre);
        for axis in 0..N {
            slope.point[axis] +=
                smoothing * by_jerk[axis] * by_jerk[axis] * self.jerks[interval][axis];
        }
        slope
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

fn weight_of_excess(goal: Goal) -> f64 {
    match goal {
        Goal::Shorten { excess } => excess,
        Goal::Restore { .. } => 1.0,
    }
}
