//! Solves a convex program with Clarabel, the only file that names the solver.
//!
//! Source: the interior-point method of Clarabel, one thread, no clock, so that the same rows give
//! the same columns. Its verdict on infeasibility is never trusted near a boundary: a program of this
//! crate is either feasible by construction, or its failure means "not this one" and no more.

use crate::rows::Rows;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT::NonnegativeConeT,
    SupportedConeT::SecondOrderConeT, SupportedConeT::ZeroConeT,
};

/// Relative precision of the solver: durations change by less than 1e-7 below it.
const PRECISION: f64 = 1e-8;

/// What the solver falls back on where it can do no better; bounds correct what is left.
const REDUCED_PRECISION: f64 = 1e-5;

/// Steps of the solver at most; programs of this crate need 15 to 60.
const STEPS: u32 = 200;

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// To the full precision.
    Solved,
    /// To the reduced precision.
    Nearly,
    /// Not at all.
    Failed,
}

/// The end of a solve.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// How it ended.
    pub(crate) outcome: Outcome,
    /// The columns.
    pub(crate) columns: Vec<f64>,
    /// One multiplier for each row.
    pub(crate) dual: Vec<f64>,
}

impl Solution {
    /// Whether the columns may be used.
    pub(crate) fn usable(&self) -> bool {
        self.outcome != Outcome::Failed && self.columns.iter().all(|value| value.is_finite())
    }
}

/// Solves the program of some rows.
pub(crate) fn solve(rows: &Rows) -> Solution {
    let (width, height) = (rows.width(), rows.height());
    let failed = || Solution {
        outcome: Outcome::Failed,
        columns: vec![0.0; width],
        dual: vec![0.0; height],
    };
    let (starts, places, mut factors) = rows.by_column();
    // The solver wants `factors · columns + slack = constants`, with the slack in the cones.
    factors.iter_mut().for_each(|factor| *factor = -*factor);
    let matrix = CscMatrix::new(height, width, starts, places, factors);
    let (zero, nonnegative) = rows.linear();
    let mut cones = vec![ZeroConeT(zero), NonnegativeConeT(nonnegative)];
    cones.extend(rows.sizes().iter().map(|&size| SecondOrderConeT(size)));
    let settings = DefaultSettings::<f64> {
        verbose: false,
        max_iter: STEPS,
        max_threads: 1,
        tol_gap_abs: PRECISION,
        tol_gap_rel: PRECISION,
        tol_feas: PRECISION,
        reduced_tol_gap_abs: REDUCED_PRECISION,
        reduced_tol_gap_rel: REDUCED_PRECISION,
        reduced_tol_feas: REDUCED_PRECISION,
        ..DefaultSettings::default()
    };
    let none = CscMatrix::<f64>::zeros((width, width));
    let constants = rows.constants();
    let Ok(mut solver) =
        DefaultSolver::new(&none, rows.cost(), &matrix, &constants, &cones, settings)
    else {
        return failed();
    };
    solver.solve();
    let outcome = match solver.solution.status {
        SolverStatus::Solved => Outcome::Solved,
        SolverStatus::AlmostSolved => Outcome::Nearly,
        _ => Outcome::Failed,
    };
    Solution {
        outcome,
        columns: std::mem::take(&mut solver.solution.x),
        dual: std::mem::take(&mut solver.solution.z),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_of_a_line_is_found_and_bounded() {
        // Least r with |(x, y)| <= r and x + y = 2.
        let mut rows = Rows::default();
        let x = rows.columns(3);
        rows.set_cost(x + 2, 1.0);
        rows.zero([(x, 1.0), (x + 1, 1.0)], -2.0);
        rows.cone()
            .cone_row([(x + 2, 1.0)], 0.0)
            .cone_row([(x, 1.0)], 0.0)
            .cone_row([(x + 1, 1.0)], 0.0);
        let solution = solve(&rows);
        assert_eq!(solution.outcome, Outcome::Solved);
        let exact = 2.0_f64.sqrt();
        assert!(
            (solution.columns[x + 2] - exact).abs() < 1e-7,
            "{solution:?}"
        );
        let bound = rows.bound(&solution.dual, &[4.0; 3]);
        assert!(bound <= exact && bound > exact - 1e-6, "{bound}");
    }

    #[test]
    fn contradicting_rows_fail() {
        let mut rows = Rows::default();
        let x = rows.columns(1);
        rows.nonnegative([(x, 1.0)], -3.0);
        rows.nonnegative([(x, -1.0)], 2.0);
        assert!(!solve(&rows).usable(), "x is at least 3 and at most 2");
    }
}
