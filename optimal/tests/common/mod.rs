//! Planning a path with any solver.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use crate::clarabel::Conic;
use toolglide_kinematics::{Limits, MotionPlanner, Plan, Toolpath, WindowTally};
use toolglide_optimal::{
    Budget, Settings, Solved, TimeOptimal, Unsolved, Window, WindowMotion, WindowSolver,
};

/// A solver that finds nothing, or nothing every few windows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Failing {
    conic: Conic,
    windows: u32,
    every: u32,
}

impl<const N: usize> WindowSolver<N> for Failing {
    fn solve(
        &mut self,
        window: &Window<'_, N>,
        motion: &mut WindowMotion<N>,
        budget: &mut Budget,
    ) -> Result<Solved, Unsolved> {
        self.windows += 1;
        if self.windows.is_multiple_of(self.every) {
            return Err(Unsolved::Numerical { solves: 0 });
        }
        self.conic.solve(window, motion, budget)
    }
}

impl Failing {
    /// Nothing every so many windows.
    pub(crate) fn every(every: u32) -> Self {
        Self {
            conic: Conic::default(),
            windows: 0,
            every,
        }
    }
}

/// Plans a path with a solver, and pulls after every move.
pub(crate) fn run<S: WindowSolver<N>, const N: usize>(
    solver: S,
    path: &Toolpath<N>,
    limits: Limits<N>,
) -> (Plan<N>, WindowTally) {
    run_with(solver, path, &Settings::new(limits))
}

/// The same with all settings.
pub(crate) fn run_with<S: WindowSolver<N>, const N: usize>(
    solver: S,
    path: &Toolpath<N>,
    settings: &Settings<N>,
) -> (Plan<N>, WindowTally) {
    let mut planner = TimeOptimal::with_solver(solver, path.start(), settings);
    let mut plan = Plan::starting_at(path.start());
    for step in path.moves() {
        planner.push(step).unwrap();
        plan.extend(std::iter::from_fn(|| planner.pull()));
    }
    planner.finish().unwrap();
    plan.extend(std::iter::from_fn(|| planner.pull()));
    (plan, planner.windows().unwrap())
}
