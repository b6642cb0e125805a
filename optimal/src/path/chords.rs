//! Divides arcs into chords, one at a time.
//!
//! Source: ours. Between two points of an arc the chord lies off by at most an eighth of the square
//! of the angle times the radius, which bounds a helix and slightly unequal radii alike. Not here:
//! the joining of very short chords.

use std::f64::consts::{FRAC_PI_2, TAU};
use toolglide_kinematics::{Arc, Vector};

/// Share of the tolerance that lies between an arc and its chords. What is left is the tube around
/// the chords, in which the motion rounds them off again.
const CHORD_SHARE: f64 = 0.3;

/// A motion that follows an arc is seen to do so at points this far apart, as a share of a turn, at
/// the most; chords end there.
const WAYPOINT_SPACING: f64 = TAU / 3.0;

/// The ends of the chords of an arc, in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Chords<const N: usize> {
    arc: Arc<N>,
    count: f64,
    next: f64,
    bulge: f64,
}

impl<const N: usize> Chords<N> {
    /// Chords that lie off the arc by a share of the `tolerance` at the most, mm.
    pub(crate) fn new(arc: Arc<N>, tolerance: f64) -> Self {
        let sweep = arc.sweep().abs();
        let bending = arc.bending();
        let angle = (8.0 * CHORD_SHARE * tolerance / bending)
            .sqrt()
            .min(FRAC_PI_2);
        let parts = (sweep / WAYPOINT_SPACING).floor() + 1.0;
        let count = parts * (sweep / (angle * parts)).ceil().max(1.0);
        let angle = sweep / count;
        Self {
            arc,
            count,
            next: 1.0,
            bulge: 0.125 * angle * angle * bending,
        }
    }

    /// How far the arc lies from its chords at the most, mm.
    pub(crate) fn bulge(&self) -> f64 {
        self.bulge
    }

    /// The end of the next chord.
    pub(crate) fn next(&mut self) -> Option<Vector<N>> {
        if self.next > self.count {
            return None;
        }
        let point = self.arc.point(self.next / self.count);
        self.next += 1.0;
        Some(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thirds_of_a_circle_are_ends_of_chords() {
        let at = Vector::<2>::new(5.0, 0.0);
        let arc = Arc::about(at, at, Vector::<2>::zeros(), [0, 1], true, 0).unwrap();
        let mut chords = Chords::new(arc, 0.01);
        let mut ends = Vec::new();
        while let Some(end) = chords.next() {
            ends.push(end);
        }
        for third in [1.0, 2.0] {
            let point = arc.point(third / 4.0 * 1.0);
            assert!(
                ends.iter().any(|end| (end - point).norm() < 1e-9),
                "{point}"
            );
        }
        assert!(chords.bulge() <= 0.3 * 0.01 + 1e-15, "{}", chords.bulge());
        assert_eq!(ends.last(), Some(&at), "the end is exact");
    }
}
