//! Plans time-optimal motion for whole programs in a streaming window.
//!
//! A [`Window`] of consecutive straight pieces with a state at each end is solved for the fastest
//! motion inside the tolerance and the limits by a [`WindowSolver`]. This crate does not know
//! machines or programs, and no general convex solver.

mod best_of;
mod path;
mod planner;
mod problem;
mod settings;
mod solver;
mod stream;
mod window;

pub use planner::{TimeOptimal, plan, plan_with};
pub use settings::{Effort, ModeTooSlow, Settings, Smoothing};
pub use solver::budget::Budget;
pub use solver::sequential::ScpSolver;
pub use window::{
    EndState, Follow, Silence, Solved, Unsolved, Wall, Window, WindowDefect, WindowMotion,
    WindowSegment, WindowSolver,
};
