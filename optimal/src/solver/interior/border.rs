//! Holds end conditions that are linear in all jerks and stretches, beside the sweep.
//!
//! A mode of vibration comes to rest when four numbers at the end of the window are zero. Each follows from all
//! jerks, so that it does not fit into a sweep from node to node. The sweep therefore answers one more right side for
//! each condition, and a small dense system of the conditions says how much of each answer the step needs.
//!
//! Source: block elimination of a bordered system, the Schur complement of its border. Not here: the conditions of a
//! mode, see [`modes`](crate::problem::modes).

#![allow(
    clippy::needless_range_loop,
    reason = "indices of conditions run over several arrays at once"
)]

use crate::problem::Problem;
use crate::problem::b_spline::State;
use crate::solver::interior::sweep::LAST;
use crate::solver::interior::{Goal, Interior, weight_of_excess};
use crate::solver::riccati::{Gradient, Slope};
use toolglide_kinematics::Vector;

/// What is added to the diagonal of the scaled system of conditions: two that say the same share the step.
const REGULAR: f64 = 1e-11;

/// Weight of half the square of a soft condition against the excess: against the duration it is fifty times this,
/// a thousandth of which is worth some percent of a condition.
const SOFT: f64 = 4e-5;

/// Answers of the sweep to the conditions, and the system that they make.
#[derive(Clone, Debug, Default)]
pub(crate) struct Border<const N: usize> {
    /// Changes of each condition: node by node, condition by condition.
    states: Vec<State<N>>,
    jerks: Vec<Vector<N>>,
    stretches: Vec<f64>,
    excess: Vec<f64>,
    /// Scratch of the way back: offsets of the coefficients, slopes of the stretches, gradients.
    offsets: Vec<Vector<N>>,
    slopes: Vec<f64>,
    gradients: Vec<Gradient<N>>,
    coefficients: Vec<[Vector<N>; 3]>,
    stretch_now: Vec<f64>,
    /// Lower triangle of the system, then its root; and its scale.
    system: Vec<f64>,
    scale: Vec<f64>,
    shares: Vec<f64>,
}

impl<const N: usize> Border<N> {
    /// Makes room for so many conditions over windows of so many segments and intervals.
    pub(crate) fn reserve(&mut self, conditions: usize, segments: usize, steps: usize) {
        self.states.reserve((steps + 1) * conditions);
        self.jerks.reserve(steps * conditions);
        self.stretches.reserve(segments * conditions);
        self.excess.reserve(conditions);
        self.offsets.reserve(steps * conditions);
        self.slopes.reserve(segments * conditions);
        self.gradients.reserve(conditions);
        self.coefficients.reserve(conditions);
        self.stretch_now.reserve(conditions);
        self.system.reserve(conditions * conditions);
        self.scale.reserve(conditions);
        self.shares.reserve(conditions);
    }

    fn resize(&mut self, conditions: usize, segments: usize, steps: usize) {
        let zero = Vector::zeros();
        self.states.resize((steps + 1) * conditions, [zero; 3]);
        self.jerks.resize(steps * conditions, zero);
        self.stretches.resize(segments * conditions, 0.0);
        self.excess.resize(conditions, 0.0);
        self.offsets.resize(steps * conditions, zero);
        self.slopes.resize(segments * conditions, 0.0);
        self.gradients.clear();
        self.gradients.resize(conditions, Gradient::default());
        self.coefficients.clear();
        self.coefficients.resize(conditions, [zero; 3]);
        self.stretch_now.clear();
        self.stretch_now.resize(conditions, 0.0);
        self.system.clear();
        self.system.resize(conditions * conditions, 0.0);
        self.scale.resize(conditions, 0.0);
        self.shares.resize(conditions, 0.0);
    }

    /// Takes the root of the system.
    fn factorise(&mut self, conditions: usize) {
        for row in 0..conditions {
            let own = self.system[row * conditions + row];
            self.scale[row] = if own > 0.0 { own.sqrt().recip() } else { 0.0 };
        }
        for row in 0..conditions {
            for column in 0..=row {
                let scale = self.scale[row] * self.scale[column];
                let mut value = self.system[row * conditions + column] * scale;
                if row == column {
                    value += REGULAR;
                }
                for before in 0..column {
                    value -= self.system[row * conditions + before]
                        * self.system[column * conditions + before];
                }
                self.system[row * conditions + column] = if row == column {
                    value.max(REGULAR).sqrt()
                } else {
                    value / self.system[column * conditions + column]
                };
            }
        }
    }

    /// Solves the system for the shares, whose right side they hold.
    fn solve(&mut self, conditions: usize) {
        for row in 0..conditions {
            let mut value = self.shares[row] * self.scale[row];
            for before in 0..row {
                value -= self.system[row * conditions + before] * self.shares[before];
            }
            self.shares[row] = value / self.system[row * conditions + row];
        }
        for row in (0..conditions).rev() {
            let mut value = self.shares[row];
            for after in row + 1..conditions {
                value -= self.system[after * conditions + row] * self.shares[after];
            }
            self.shares[row] = value / self.system[row * conditions + row];
        }
        for row in 0..conditions {
            self.shares[row] *= self.scale[row];
        }
    }
}

impl<const N: usize> Interior<N> {
    /// Answers every condition with the gains at hand, and prepares their system.
    pub(super) fn answer_conditions(&mut self, problem: &Problem<N>, goal: Goal, unit: f64) {
        let conditions = problem.conditions().count();
        if conditions == 0 {
            return;
        }
        let mut border = std::mem::take(&mut self.border);
        border.resize(conditions, problem.segments(), problem.steps());
        self.conditions_back(problem, &mut border);
        self.conditions_forward(problem, &mut border);
        let weight = SOFT * unit * weight_of_excess(goal);
        if weight > 0.0 {
            for row in 0..conditions {
                if problem.conditions().is_soft(row) {
                    border.system[row * conditions + row] += 1.0 / weight;
                }
            }
        }
        border.factorise(conditions);
        self.border = border;
    }

    fn conditions_back(&self, problem: &Problem<N>, border: &mut Border<N>) {
        let ends = problem.conditions();
        let conditions = ends.count();
        let first = problem.steps() - LAST;
        let slope = |row: usize, interval: usize| {
            let mut slope = Slope::default();
            slope.point[ends.axis(row)] = ends.by_jerk(row, interval);
            slope
        };
        for row in 0..conditions {
            for index in 0..LAST {
                border.gradients[row].add_jerk(&slope(row, first + index), &self.tail.jerks[index]);
            }
        }
        let mut node = first;
        loop {
            let segment = problem.segment_of(node);
            if problem.stretching() && problem.starts_segment(node) {
                let gain = &self.stretch_gains[segment];
                for row in 0..conditions {
                    let gradient = &mut border.gradients[row];
                    gradient.stretch += ends.by_stretch(row, segment);
                    border.slopes[segment * conditions + row] = gradient.stretch;
                    gain.eliminate(gradient);
                }
            }
            if node == 0 {
                break;
            }
            node -= 1;
            let (interval, gain) = (problem.interval(node), &self.gains[node]);
            for row in 0..conditions {
                border.offsets[node * conditions + row] =
                    border.gradients[row].eliminate(&interval, &slope(row, node), gain);
            }
        }
    }

    fn conditions_forward(&self, problem: &Problem<N>, border: &mut Border<N>) {
        let ends = problem.conditions();
        let conditions = ends.count();
        let steps = problem.steps();
        let first = steps - LAST;
        for row in 0..conditions {
            border.excess[row] = -border.gradients[row].excess / self.excess_gain[0];
        }
        for node in 0..=first {
            let segment = problem.segment_of(node);
            if problem.stretching() && problem.starts_segment(node) {
                let gain = &self.stretch_gains[segment];
                for row in 0..conditions {
                    let slope = border.slopes[segment * conditions + row];
                    let state = &border.coefficients[row];
                    let stretch = gain.answer(slope, state, border.excess[row]);
                    border.stretch_now[row] = stretch;
                    border.stretches[segment * conditions + row] = stretch;
                }
            }
            let basis = problem.basis(node);
            for row in 0..conditions {
                border.states[node * conditions + row] = basis.state(&border.coefficients[row]);
            }
            if node < first {
                let (interval, gain) = (problem.interval(node), &self.gains[node]);
                for row in 0..conditions {
                    let at = node * conditions + row;
                    (border.jerks[at], border.coefficients[row]) = gain.answer(
                        &interval,
                        &border.coefficients[row],
                        border.stretch_now[row],
                        border.excess[row],
                        &border.offsets[at],
                    );
                }
            }
        }
        for index in 0..LAST {
            for row in 0..conditions {
                let (state, stretch) = (&border.coefficients[row], border.stretch_now[row]);
                border.jerks[(first + index) * conditions + row] =
                    self.tail.jerks[index].linear(state, stretch);
            }
        }
        for index in 0..LAST - 1 {
            let node = first + 1 + index;
            for row in 0..conditions {
                let (state, stretch) = (&border.coefficients[row], border.stretch_now[row]);
                let later = self.tail.states[index]
                    .each_ref()
                    .map(|form| form.linear(state, stretch));
                border.states[node * conditions + row] = problem.basis(node).state(&later);
            }
        }
        for row in 0..conditions {
            border.states[steps * conditions + row] = [Vector::zeros(); 3];
        }
        for interval in 0..steps {
            let answers = &border.jerks[interval * conditions..(interval + 1) * conditions];
            for row in 0..conditions {
                let (axis, weight) = (ends.axis(row), ends.by_jerk(row, interval));
                for column in 0..=row {
                    border.system[row * conditions + column] -= weight * answers[column][axis];
                }
            }
        }
        if problem.stretching() {
            for segment in 0..problem.segments() {
                for row in 0..conditions {
                    let weight = ends.by_stretch(row, segment);
                    for column in 0..=row {
                        let answer = border.stretches[segment * conditions + column];
                        border.system[row * conditions + column] -= weight * answer;
                    }
                }
            }
        }
    }

    /// Adds as much of each answer to the changes at hand as brings every condition to what it asks for.
    pub(super) fn meet_conditions(&mut self, problem: &Problem<N>) {
        let ends = problem.conditions();
        let conditions = ends.count();
        if conditions == 0 {
            return;
        }
        let (steps, segments) = (problem.steps(), problem.segments());
        for row in 0..conditions {
            let axis = ends.axis(row);
            let mut value = ends.constant(row);
            for interval in 0..steps {
                let jerk = self.jerks[interval][axis] + self.jerk_changes[interval][axis];
                value += ends.by_jerk(row, interval) * jerk;
            }
            if problem.stretching() {
                for segment in 0..segments {
                    let stretch = self.stretches[segment] + self.stretch_changes[segment];
                    value += ends.by_stretch(row, segment) * stretch;
                }
            }
            self.border.shares[row] = value;
        }
        self.border.solve(conditions);
        let border = &self.border;
        for node in 0..=steps {
            for row in 0..conditions {
                let (share, at) = (border.shares[row], node * conditions + row);
                for order in 0..3 {
                    self.state_changes[node][order] += border.states[at][order] * share;
                }
                if node < steps {
                    self.jerk_changes[node] += border.jerks[at] * share;
                }
            }
        }
        if problem.stretching() {
            for segment in 0..segments {
                for row in 0..conditions {
                    self.stretch_changes[segment] +=
                        border.stretches[segment * conditions + row] * border.shares[row];
                }
            }
        }
        for row in 0..conditions {
            self.excess_change += border.excess[row] * border.shares[row];
        }
    }
}
