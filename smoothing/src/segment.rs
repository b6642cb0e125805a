//! Holds a straight segment between two corners, after merging.
//!
//! Source: the straight moves of section 3.3. Not here: how it comes about, see the merger.

use crate::bend::Bend;
use toolglide_kinematics::{MoveRange, PathLimits, Pause, Tolerance, Vector};

/// A straight stretch of path, or a part of an arc beside its chord.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<const N: usize> {
    /// Where it starts.
    pub start: Vector<N>,
    /// Where it ends.
    pub end: Vector<N>,
    /// Unit direction of its chord.
    pub direction: Vector<N>,
    /// Length of the way, mm, which is that of the arc where it bends.
    pub length: f64,
    /// The arc where it is a chord of one.
    pub bend: Option<Bend<N>>,
    /// Limits along the leg; the velocity is the feedrate where that is lower.
    pub limits: PathLimits,
    /// Largest speed of the moves that it serves.
    pub feedrate: f64,
    /// How far the motion may be from the moves that it serves.
    pub tolerance: Tolerance,
    /// How far those moves may lie from the leg.
    pub deviation: f64,
    /// The moves that it serves.
    pub serves: MoveRange,
    /// Numbers of the first of the vertices that corners are made of instead of it, and of the first
    /// after them. All those of an arc belong to its first leg.
    pub vertices: [u64; 2],
    /// Whether the motion rests at its end.
    pub stop: bool,
    /// Whether it is the first part of a longer one, which goes on at its velocity.
    pub cruises: bool,
    /// A pause at its end.
    pub dwell: Option<Pause<N>>,
}

impl<const N: usize> Segment<N> {
    /// What merging has left of the tolerance.
    #[must_use]
    pub fn room(&self) -> Tolerance {
        self.tolerance.less(self.deviation)
    }

    /// Direction of the way at its start.
    pub(crate) fn entry(&self) -> Vector<N> {
        self.bend.map_or(self.direction, |bend| bend.tangent(0.0))
    }

    /// Direction of the way at its end.
    pub(crate) fn exit(&self) -> Vector<N> {
        self.bend.map_or(self.direction, |bend| bend.tangent(1.0))
    }

    /// Its two parts before and behind a distance at which the motion cruises.
    pub(crate) fn divided(&self, distance: f64) -> (Self, Self) {
        let middle = self.start + self.direction * distance;
        let first = Self {
            end: middle,
            length: distance,
            stop: false,
            cruises: true,
            dwell: None,
            ..*self
        };
        let second = Self {
            start: middle,
            length: self.length - distance,
            ..*self
        };
        (first, second)
    }

    /// Whether the next leg begins with a move of the path.
    pub(crate) fn ends_before(&self, next: &Self) -> bool {
        self.serves.last < next.serves.first
    }
}
