//! Divides arcs into chords, one at a time.
//!
//! Source: ours; chapter 3 plans over straight moves. Between two points of the arc the chord lies
//! off by at most an eighth of the square of the angle times the radius, which bounds a helix and
//! slightly unequal radii alike. Not here: arcs that stay arcs.

use std::f64::consts::FRAC_PI_2;
use toolglide_kinematics::{Arc, Vector};

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
