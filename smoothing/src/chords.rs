//! Divides arcs into chords, one at a time.
//!
//! Source: ours; chapter 3 plans over straight moves. Between two points of the arc the chord lies
//! off by at most an eighth of the square of the angle times the radius, which bounds a helix and
//! slightly unequal radii alike. Not here: arcs that stay arcs, which chapter 4 filters.

use std::f64::consts::FRAC_PI_2;
use toolglide_kinematics::{Arc, Vector};

/// Largest angle of a fine chord, rad: below what stretches take for a sharp turn.
const SMOOTH: f64 = 0.4;

/// An arc up to so many times as long as its deviation is a trifle.
const TRIFLE: f64 = 8.0;

/// The ends of the chords of an arc, in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chords<const N: usize> {
    arc: Arc<N>,
    count: f64,
    next: f64,
    bulge: f64,
}

impl<const N: usize> Chords<N> {
    /// Chords that lie off the arc by `deviation` at the most.
    #[must_use]
    pub fn new(arc: Arc<N>, deviation: f64) -> Self {
        let sweep = arc.sweep().abs();
        let bending = arc.bending();
        let angle = (8.0 * deviation / bending).sqrt().min(FRAC_PI_2);
        let count = (sweep / angle).ceil().max(1.0);
        let angle = sweep / count;
        Self {
            arc,
            count,
            next: 1.0,
            bulge: 0.125 * angle * angle * bending,
        }
    }

    /// The same, with chords that turn little from one to the next, where the arc is no trifle.
    pub(crate) fn fine(arc: Arc<N>, deviation: f64) -> Self {
        let coarse = Self::new(arc, deviation);
        let count = (arc.sweep().abs() / SMOOTH).ceil();
        if count <= coarse.count || arc.length() <= TRIFLE * deviation {
            return coarse;
        }
        Self {
            count,
            // So that chords are not merged again.
            bulge: deviation,
            ..coarse
        }
    }

    /// How many chords there are.
    pub(crate) fn count(&self) -> f64 {
        self.count
    }

    /// How far the arc lies from its chords at the most.
    #[must_use]
    pub fn bulge(&self) -> f64 {
        self.bulge
    }

    /// The end of the next chord; `None` after the last.
    #[allow(
        clippy::should_implement_trait,
        reason = "the chords of an arc are counted, not iterated"
    )]
    pub fn next(&mut self) -> Option<Vector<N>> {
        if self.next > self.count {
            return None;
        }
        let point = self.arc.point(self.next / self.count);
        self.next += 1.0;
        Some(point)
    }
}
