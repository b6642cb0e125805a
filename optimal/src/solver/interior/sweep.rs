//! Sweeps through the nodes in one iteration: back with curvatures, back with slopes, forward.
//!
//! The last three intervals are special: their jerks are what the fixed end state demands.
//!
//! Source: as of [`front`](crate::solver::riccati). Not here: steps and their lengths, see
//! [`interior`](crate::solver::interior).

use crate::problem::Problem;
use crate::problem::constraints::Rows;
use crate::solver::cone::{Centre, Sums};
use crate::solver::interior::passes::{Correct, Weigh};
use crate::solver::interior::{Goal, Interior, weight_of_excess};
use crate::solver::riccati::{Cost, Form, Gradient, Interval, Local, Slope};
use toolglide_kinematics::Vector;

/// The last intervals, whose jerks the end state demands.
pub(super) const LAST: usize = 3;

/// The last intervals as what follows from the state before them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tail<const N: usize> {
    pub(super) states: [[Form<N>; 3]; LAST - 1],
    coefficients: [Form<N>; LAST],
    pub(super) jerks: [Form<N>; LAST],
    state_pushes: [Gradient<N>; LAST - 1],
    jerk_pushes: [Slope<N>; LAST],
}

impl<const N: usize> Interior<N> {
    /// Weighs all rows and eliminates; whether every pivot was positive.
    pub(super) fn weigh(
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
        if self.excess_gain[0] > 0.0 {
            self.answer_conditions(problem, goal, unit);
            return true;
        }
        false
    }

    pub(super) fn weigh_jerk(
        &mut self,
        problem: &Problem<N>,
        interval: usize,
        smoothing: f64,
        sums: &mut Sums,
    ) -> Local<N> {
        let by_jerk = problem.by_jerk();
        let smoothing = smoothing * problem.time_weight(interval);
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
    pub(super) fn go(&mut self, problem: &Problem<N>) {
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
        self.meet_conditions(problem);
    }

    /// Slopes towards a centre, eliminated with the gains at hand.
    pub(super) fn correct(
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
                whole.stretch += (1.0 - centre.kept) * unit * problem.share(segment)
                    + lower.correct(centre)
                    - upper.correct(centre);
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
        self.excess_gain[1] = whole.excess
            + self.excess_row.correct(centre)
            + (1.0 - centre.kept) * weight_of_excess(goal) * unit;
    }

    fn correct_jerk(
        &mut self,
        problem: &Problem<N>,
        interval: usize,
        smoothing: f64,
        centre: Centre,
    ) -> Slope<N> {
        let by_jerk = problem.by_jerk();
        let smoothing = smoothing * problem.time_weight(interval);
        let mut slope = self.rows[interval].jerk.correct(by_jerk, centre);
        for axis in 0..N {
            slope.point[axis] +=
                smoothing * by_jerk[axis] * by_jerk[axis] * self.jerks[interval][axis];
        }
        slope
    }
}
