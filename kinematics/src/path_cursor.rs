//! Tracks where a planner is on its path and how many moves it has taken.
//!
//! Source: the order of [`crate::MotionPlanner`]. Not here: what becomes of the moves.

use crate::planner::PlanError;
use crate::toolpath::{Move, check_contact};
use crate::vector::Vector;

/// Counts the moves of a path in, and refuses those that cannot follow.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Feedrate, Move, PathCursor, Tolerance, Vector};
/// let mut cursor = PathCursor::new(Vector::<2>::zeros());
/// let end = Vector::<2>::new(3.0, 4.0);
/// let line = Move::line_to(end, Feedrate::new(100.0)?, Tolerance::new(0.1)?)?;
/// assert_eq!(cursor.take(&line)?, 0);
/// assert_eq!(cursor.end(), end);
/// assert!(cursor.close());
/// assert!(cursor.take(&line).is_err(), "the end was announced");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PathCursor<const N: usize> {
    end: Vector<N>,
    count: u32,
    closed: bool,
}

impl<const N: usize> PathCursor<N> {
    /// Nothing taken yet of a path from `start`.
    #[must_use]
    pub fn new(start: Vector<N>) -> Self {
        Self {
            end: start,
            count: 0,
            closed: false,
        }
    }

    /// Takes the next move and gives its number, from 0; what is refused changes nothing.
    ///
    /// # Errors
    /// [`PlanError`] when the move comes after the end, does not connect, or cannot be counted.
    pub fn take(&mut self, next: &Move<N>) -> Result<u32, PlanError> {
        let index = self.count;
        if self.closed {
            return Err(PlanError::Finished { index });
        }
        check_contact(next, self.end).map_err(|reason| PlanError::Path { index, reason })?;
        self.count = index.checked_add(1).ok_or(PlanError::TooMany { index })?;
        self.end = next.end(self.end);
        Ok(index)
    }

    /// Says that no move follows; `false` when that was known.
    pub fn close(&mut self) -> bool {
        !core::mem::replace(&mut self.closed, true)
    }

    /// Whether it is known that no move follows.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Where the path has come to.
    #[must_use]
    pub fn end(&self) -> Vector<N> {
        self.end
    }

    /// Number of moves taken.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.count
    }
}
