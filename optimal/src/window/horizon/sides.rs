//! Finds the sides that the spans of a window keep: the outer side of the corner at either end of a line, or one side.
//!
//! Source: ours. A third of a line belongs to the corner at either end, as for the judge. A line is one span or several;
//! a span next to one corner alone keeps its side all along. Not here: how a solver or a check keeps a side.

use crate::window::horizon::Horizon;
use crate::window::{Wall, WindowSolver};
use toolglide_kinematics::{PathSide, Vector};

/// Share of a line that belongs to the corner at either end.
const NEAR: f64 = 1.0 / 3.0;

/// Sine of a turn below which there is no corner.
const STRAIGHT: f64 = 1e-6;

impl<S: WindowSolver<N>, const N: usize> Horizon<S, N> {
    /// Sides that a span keeps over its two halves.
    pub(super) fn walls(&self, index: usize) -> [Option<Wall<N>>; 2] {
        let span = &self.spans[index];
        if self.side == PathSide::Both || span.curved {
            return [None; 2];
        }
        let allowed = self.overshoot;
        if let Some(outward) = self.side.across(&span.direction) {
            let wall = Wall {
                outward,
                allowed,
                between: [f64::NEG_INFINITY, f64::INFINITY],
            };
            return [Some(wall); 2];
        }
        if self.side != PathSide::Inside {
            return [None; 2];
        }
        let [first, last] = self.corners(index);
        // The start may have left the first corner behind.
        let along = (self.start.position - span.start).dot(&span.direction);
        let first = first.filter(|wall| index > 0 || along < wall.between[1]);
        [first.or(last), last.or(first)]
    }

    /// The outer sides of the corners at either end of the line to which a span belongs, where they matter on the span.
    fn corners(&self, index: usize) -> [Option<Wall<N>>; 2] {
        let span = &self.spans[index];
        let before = (0..index)
            .rev()
            .map(|before| &self.spans[before])
            .find(|before| !before.goes_on)
            .map_or(self.direction_before, |before| Some(before.direction));
        let behind = (index..self.spans.len())
            .find(|behind| !self.spans[*behind].goes_on)
            .and_then(|last| match self.spans.get(last + 1) {
                Some(next) => Some(next.direction),
                None => self.direction_after,
            });
        let near = NEAR * span.line_length;
        let first = [f64::NEG_INFINITY, near - span.from];
        let last = [span.line_length - near - span.from, f64::INFINITY];
        let wall = |other: Option<Vector<N>>, between: [f64; 2]| {
            let other = other.filter(|_| between[0] < span.length && between[1] > 0.0)?;
            let inside = other - span.direction * span.direction.dot(&other);
            let sine = inside.norm();
            (sine > STRAIGHT).then(|| Wall {
                outward: inside / -sine,
                allowed: self.overshoot,
                between,
            })
        };
        [
            wall(before.map(|before| -before), first),
            wall(behind, last),
        ]
    }

    /// Keeps the direction of the line that ends last within the first `count` spans.
    pub(super) fn leave_behind(&mut self, count: usize) {
        if let Some(span) = self.spans.range(..count).rfind(|span| !span.goes_on) {
            self.direction_before = Some(span.direction);
        }
    }
}
