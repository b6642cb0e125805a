//! Time-optimal motion for whole programs, planned in a streaming window.
//!
//! A [`Window`] of consecutive straight pieces with a state at each end is solved for the fastest
//! motion inside the tolerance and the limits by a [`WindowSolver`]. This crate does not know
//! machines or programs, and no general convex solver.

mod accept;
mod block;
mod budget;
mod chords;
mod cone;
mod durations;
mod event;
mod front;
mod guess;
mod horizon;
mod interior;
mod planner;
mod problem;
mod race;
mod rows;
mod runs;
mod safe;
mod settings;
mod span;
mod spline;
mod stream;
mod window;

pub use budget::Budget;
pub use durations::SequentialSolver;
pub use planner::{TimeOptimal, plan, plan_with};
pub use settings::{Effort, Settings};
pub use window::{
    EndState, Segment, Solved, Unsolved, Window, WindowDefect, WindowMotion, WindowSolver,
};
