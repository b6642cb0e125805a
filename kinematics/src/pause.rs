//! Represents a rest for a time, or moves that lead nowhere, as motion.
//!
//! Source: the dwell of a program, and moves shorter than what is told apart. Not here: coming to rest.

use crate::piece::{MoveRange, Piece};
use crate::sample::Sample;
use crate::vector::Vector;

/// A pause at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pause<const N: usize> {
    /// How long it lasts; 0 for moves that led nowhere.
    pub duration: f64,
    /// The moves that it serves.
    pub serves: MoveRange,
    /// The programmed point at its end.
    pub end: Vector<N>,
}

impl<const N: usize> Pause<N> {
    /// The pause as motion, which has come to rest at `at`.
    #[must_use]
    pub fn piece(&self, at: Vector<N>) -> Piece<N> {
        Piece::new(&Sample::at_rest(at), self.duration, self.end, self.serves)
    }

    /// Two pauses, one after the other.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        Self {
            duration: self.duration + next.duration,
            serves: MoveRange {
                first: self.serves.first,
                last: next.serves.last,
            },
            end: next.end,
        }
    }
}
