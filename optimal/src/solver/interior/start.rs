//! Starts the iteration on a motion that obeys its dynamics, inside all relaxed bounds.
//!
//! Source: ours. What is missed at the start would have to be made up for on the way, and a bound that the way
//! runs into leaves it missed. Not here: the iterations, see [`interior`](crate::solver::interior).

use crate::problem::constraints::Rows;
use crate::problem::{NodeRows, Problem};
use crate::solver::cone::{Side, Sums};
use crate::solver::interior::passes::Start;
use crate::solver::interior::{Goal, Interior};
use crate::solver::riccati::{Gain, StretchGain};
use toolglide_kinematics::Vector;

/// The excess starts here, or so much higher that all bounds are kept.
const FIRST_EXCESS: f64 = 0.1;

impl<const N: usize> Interior<N> {
    /// Brings the workspace to size, and the ends of the motion to where they belong.
    pub(super) fn prepare(&mut self, problem: &Problem<N>) {
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
    /// bounds in the mean square. Gives whether it does.
    pub(super) fn straighten(&mut self, problem: &Problem<N>, goal: Goal) -> bool {
        let weighed = self.weigh(problem, goal, 0.0, 0.0, 0.0, &mut Sums::default());
        if weighed {
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
        weighed
    }

    /// Starts all slacks and multipliers; gives the least excess.
    pub(super) fn reset(&mut self, problem: &Problem<N>, goal: Goal) -> f64 {
        for (rows, trust) in self.stretch_rows.iter_mut().zip(&self.trust) {
            for row in rows {
                row.reset_inside(*trust, *trust);
            }
        }
        let floor = match goal {
            Goal::Shorten { .. } | Goal::Smooth { .. } => 0.0,
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
}
