//! Computes the time-optimal reference: how far a plan is from the best that physics allows.
//!
//! A course of straight legs is followed inside the tolerance and inside the limits of velocity,
//! acceleration and jerk of every axis, from rest to rest. [`optimum`] finds the fastest such motion, an
//! upper bound, with a bound from below; [`lower_bound`] holds any motion against what is possible with
//! its own shares of time. Slow, and for judging plans: controllers have no use for it. This is the
//! only crate that knows a convex solver.

mod bound;
mod certify;
mod columns;
mod course;
mod durations;
mod error;
mod formulation;
mod grid;
mod motion;
mod optimum;
mod pieces;
mod planner;
mod rows;
mod score;
mod sections;
mod solve;
mod straight;
mod switches;
mod tube;
mod windows;

pub use bound::lower_bound;
pub use certify::{Certificate, certify};
pub use course::{Class, Course};
pub use error::ReferenceError;
pub use optimum::{Optimum, Settings, optimum, solved_once};
pub use planner::{LONGEST, ReferencePlanner, plan};
pub use score::{Held, Score, corner_penalty_ratio, hold, part, score};
pub use sections::{Section, Sections, sections};
pub use switches::leg_times;
pub use windows::{Sampled, WHOLE, WINDOW, Window, Windows};
