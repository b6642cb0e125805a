//! Defines the seam between a stream of moves and a stream of pieces.
//!
//! Source: the look-ahead windowing of section 3.3 plans while it reads. Not here: any method.

use crate::error::ToolpathError;
use crate::piece::Piece;
use crate::plan::Plan;
use crate::toolpath::{Move, Toolpath};

/// Plans motion while the path is still being read.
///
/// Moves are pushed in path order, pieces are pulled in motion order. Whoever pulls until `None`
/// after each push holds no more than the planner's window.
pub trait MotionPlanner<const N: usize> {
    /// Takes the next move of the path.
    ///
    /// # Errors
    /// [`PlanError`] when the move cannot follow; the motion planned before stays valid.
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError>;

    /// Says that no move follows: the motion comes to rest at the end of the last one.
    ///
    /// # Errors
    /// [`PlanError`] as for `push`.
    fn finish(&mut self) -> Result<(), PlanError>;

    /// The next piece of finished motion: in order, contiguous, never taken back.
    fn pull(&mut self) -> Option<Piece<N>>;

    /// How the windows came out so far, for a planner that solves windows and may keep an older plan.
    fn windows(&self) -> Option<WindowTally> {
        None
    }
}

impl<const N: usize> Plan<N> {
    /// The motion that a planner, at rest at the start of `path`, makes of all of it.
    ///
    /// # Errors
    /// As [`MotionPlanner::push`].
    pub fn of(path: &Toolpath<N>, planner: &mut impl MotionPlanner<N>) -> Result<Self, PlanError> {
        let mut plan = Self::starting_at(path.start());
        for step in path.moves() {
            planner.push(step)?;
            plan.extend(core::iter::from_fn(|| planner.pull()));
        }
        planner.finish()?;
        plan.extend(core::iter::from_fn(|| planner.pull()));
        Ok(plan)
    }
}

/// How the windows of a planner came out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WindowTally {
    /// Windows that were planned.
    pub windows: u64,
    /// Those that were solved twice, because the first motion was worse than the plan before.
    pub retried: u64,
    /// Those that kept the plan before, with its stop.
    pub kept: u64,
    /// Stretches between places where one motion may take the place of another: stops, and the middle of
    /// long moves.
    pub stretches: u64,
    /// Those that are travelled by another method, which is faster there.
    pub yielded: u64,
    /// What all windows cost: intervals times steps of their solver.
    pub work: u64,
}

/// Why a planner cannot take a move.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// The move does not connect to the path.
    #[error("move {index}: {reason}")]
    Path {
        /// The move, counted from 0.
        index: u32,
        /// What is wrong.
        reason: ToolpathError,
    },
    /// A move came after the end was announced.
    #[error("move {index}: it comes after the end of the path")]
    Finished {
        /// The move, counted from 0.
        index: u32,
    },
    /// No motion was found: lengths or limits are beyond what float arithmetic can carry.
    #[error("move {index}: no motion was found for lengths and limits of this size")]
    Magnitude {
        /// The move that was to be taken, counted from 0; the one that could not be planned came before.
        index: u32,
    },
    /// More moves than can be counted.
    #[error("move {index}: a path may have no more moves")]
    TooMany {
        /// The move, counted from 0.
        index: u32,
    },
}
