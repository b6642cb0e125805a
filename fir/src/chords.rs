//! Arcs as sequences of chords whose filtered motion is that of the arc.
//!
//! Source: section 4.2.3 for the arc. The chords are ours: their vertices lie outside the arc by two
//! thirds of the sagitta, so that the mean distance is none and the filters, which average over many
//! chords, see a circle of the right radius. The ends are exact. Not here: feedrates.

use std::f64::consts::FRAC_PI_4;
use toolglide_kinematics::{Arc, Vector};

/// Sagitta of a chord as a share of the tolerance: some seventeen chords are in the window of the
/// filters where the tolerance limits the feedrate.
const SAGITTA_SHARE: f64 = 0.12;

/// The vertices of the chords of an arc, in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Chords<const N: usize> {
    arc: Arc<N>,
    count: f64,
    next: f64,
    outward: f64,
}

/// Largest radius of an arc, with what its change adds: the second derivative of the point after the
/// angle.
fn bending<const N: usize>(arc: &Arc<N>) -> f64 {
    let (start_radius, end_radius) = arc.radii();
    let growth = (end_radius - start_radius).abs() / arc.sweep().abs();
    start_radius.max(end_radius) + 2.0 * growth
}

/// How far an arc is from its own chord at most: second derivative times square over eight.
pub(crate) fn bulge_of<const N: usize>(arc: &Arc<N>) -> f64 {
    0.125 * bending(arc) * arc.sweep() * arc.sweep()
}

impl<const N: usize> Chords<N> {
    pub(crate) fn new(arc: Arc<N>, tolerance: f64) -> Self {
        let (start_radius, end_radius) = arc.radii();
        let sweep = arc.sweep().abs();
        let curvature = bending(&arc);
        let angle = (8.0 * SAGITTA_SHARE * tolerance / curvature)
            .sqrt()
            .min(FRAC_PI_4);
        let count = (sweep / angle).ceil().max(1.0);
        let angle = sweep / count;
        Self {
            arc,
            count,
            next: 1.0,
            outward: angle * angle * start_radius.min(end_radius) / 12.0,
        }
    }

    /// Angle of one chord, rad.
    pub(crate) fn angle(&self) -> f64 {
        self.arc.sweep().abs() / self.count
    }

    /// How far the vertices lie outside the arc.
    pub(crate) fn outward(&self) -> f64 {
        self.outward
    }

    /// Length of the longest chord.
    pub(crate) fn longest(&self) -> f64 {
        (self.vertex(2.0_f64.min(self.count)) - self.vertex(1.0))
            .norm()
            .max((self.vertex(1.0) - self.arc.start()).norm())
    }

    /// The vertex of an index from 0 to the count.
    fn vertex(&self, index: f64) -> Vector<N> {
        let share = index / self.count;
        let point = self.arc.point(share);
        if share <= 0.0 || share >= 1.0 {
            return point;
        }
        let (radial, lateral) = self.arc.frame();
        let (sine, cosine) = (share * self.arc.sweep()).sin_cos();
        point + (radial * cosine + lateral * sine) * self.outward
    }

    /// All vertices after the start.
    pub(crate) fn vertices(&self) -> impl Iterator<Item = Vector<N>> {
        let mut rest = *self;
        std::iter::from_fn(move || rest.next().map(|(vertex, _)| vertex))
    }

    /// The end of the next chord, and whether another one follows.
    pub(crate) fn next(&mut self) -> Option<(Vector<N>, bool)> {
        if self.next > self.count {
            return None;
        }
        let vertex = self.vertex(self.next);
        self.next += 1.0;
        Some((vertex, self.next <= self.count))
    }
}
