//! Represents motion of constant jerk between two knots.
//!
//! Source: the phases of chapters 2 and 3, each of constant jerk. Not here: which method made it.

use crate::sample::Sample;
use crate::vector::Vector;

/// The moves of a toolpath that a stretch of motion follows, counted from 0 in path order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MoveRange {
    /// First move that it follows.
    pub first: u32,
    /// Last move that it follows: the same on a straight stretch, the next one in a corner.
    pub last: u32,
}

impl MoveRange {
    /// One move alone.
    #[must_use]
    pub fn one(index: u32) -> Self {
        Self {
            first: index,
            last: index,
        }
    }
}

/// A stretch of motion of constant jerk, the moves it serves, and its exact end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece<const N: usize> {
    position: Vector<N>,
    velocity: Vector<N>,
    acceleration: Vector<N>,
    jerk: Vector<N>,
    end: Vector<N>,
    duration: f64,
    serves: MoveRange,
}

impl<const N: usize> Piece<N> {
    /// A piece from its state at the start, its jerk and its duration (s, not negative), which ends
    /// at `end`: the programmed point where there is one, so that rounding never adds up.
    #[must_use]
    pub fn new(start: &Sample<N>, duration: f64, end: Vector<N>, serves: MoveRange) -> Self {
        debug_assert!(
            duration >= 0.0 && duration.is_finite(),
            "a piece must not last {duration} s"
        );
        Self {
            position: start.position,
            velocity: start.velocity,
            acceleration: start.acceleration,
            jerk: start.jerk,
            end,
            duration,
            serves,
        }
    }

    /// How long it lasts.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The moves that it follows.
    #[must_use]
    pub fn serves(&self) -> MoveRange {
        self.serves
    }

    /// Where it starts.
    #[must_use]
    pub fn start(&self) -> Vector<N> {
        self.position
    }

    /// Where it ends.
    #[must_use]
    pub fn end(&self) -> Vector<N> {
        self.end
    }

    /// Position alone, at a time since the start of the piece; the end exactly when it is over.
    #[must_use]
    #[inline]
    pub fn position_at(&self, time: f64) -> Vector<N> {
        if time >= self.duration {
            return self.end;
        }
        let t = time.max(0.0);
        self.position + (self.velocity + (self.acceleration * 0.5 + self.jerk * (t / 6.0)) * t) * t
    }

    /// State at a time since the start of the piece; a time outside gives the nearer end.
    #[must_use]
    pub fn at(&self, time: f64) -> Sample<N> {
        let t = time.clamp(0.0, self.duration);
        Sample {
            position: self.position_at(t),
            velocity: self.velocity + (self.acceleration + self.jerk * (0.5 * t)) * t,
            acceleration: self.acceleration + self.jerk * t,
            jerk: self.jerk,
        }
    }
}
