//! Divides arcs into chords whose filtered motion is that of the arc.
//!
//! Source: section 4.2.3 for the arc. The chords are ours: their vertices lie outside the arc by two
//! thirds of the sagitta, so that the mean distance is none and the filters, which average over many
//! chords, see a circle of the right radius. The ends are exact. Not here: feedrates.

use core::f64::consts::FRAC_PI_4;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::{Arc, Vector, largest_multiple};

/// Sagitta of a chord as a share of the tolerance: some seventeen chords are in the window of the
/// filters where the tolerance limits the feedrate.
const SAGITTA_SHARE: f64 = 0.12;

/// The vertices of the chords of an arc, in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Chords<const N: usize> {
    arc: Arc<N>,
    count: f64,
    next: f64,
    angle: f64,
    shape: Shape,
}

/// How chords lie beside their arc; all zero where there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Shape {
    /// How far the arc bends away from a chord.
    pub(crate) sagitta: f64,
    /// Turn `|t2 - t1|` of the arc per length, 1/mm.
    pub(crate) curvature: f64,
    /// How far the vertices lie outside the arc.
    pub(crate) outward: f64,
}

/// How far an arc is from its own chord at most: second derivative times square over eight.
pub(crate) fn bulge_of<const N: usize>(arc: &Arc<N>) -> f64 {
    0.125 * arc.bending() * arc.sweep() * arc.sweep()
}

impl<const N: usize> Chords<N> {
    pub(crate) fn new(arc: Arc<N>, tolerance: f64) -> Self {
        let (start_radius, end_radius) = arc.radii();
        let (sweep, radius) = (arc.sweep().abs(), start_radius.min(end_radius));
        let bending = arc.bending();
        let angle = (8.0 * SAGITTA_SHARE * tolerance / bending)
            .sqrt()
            .min(FRAC_PI_4);
        let count = (sweep / angle).ceil().max(1.0);
        let angle = sweep / count;
        Self {
            arc,
            count,
            next: 1.0,
            angle,
            shape: Shape {
                sagitta: 0.125 * angle * angle * bending,
                curvature: radius * (sweep / arc.length()).powi(2),
                outward: angle * angle * radius / 12.0,
            },
        }
    }

    /// Largest turn `|t2 - t1|` between two of them but the first and the last.
    ///
    /// On a spiral their directions turn by more than the arc does, on a helix by as much less as they
    /// rise.
    pub(crate) fn turn(&self) -> f64 {
        let (start, end) = self.arc.radii();
        let pitch = (end - start) / (self.arc.sweep() * start.min(end));
        let angle = self.angle * (1.0 + pitch * pitch).min(2.0);
        let turn = 2.0 * (0.5 * angle).sin() * (1.0 + pitch * pitch).sqrt();
        let flat = turn * (start.max(end) + self.shape.outward);
        turn * flat / flat.hypot(self.arc.lift().norm() / self.count)
    }

    /// How they lie beside the arc.
    pub(crate) fn shape(&self) -> Shape {
        self.shape
    }

    /// Length of the shortest chord, of the first two and the last two.
    pub(crate) fn shortest(&self) -> f64 {
        let length = |first: f64, last: f64| (self.vertex(last) - self.vertex(first)).norm();
        let mut shortest = length(0.0, 1.0);
        if self.count > 1.0 {
            shortest = shortest.min(length(1.0, 2.0));
        }
        let (start, end) = self.arc.radii();
        if start > end {
            let last = self.count;
            shortest = shortest.min(length(last - 1.0, last));
            if last > 1.0 {
                shortest = shortest.min(length(last - 2.0, last - 1.0));
            }
        }
        shortest
    }

    /// The vertex of an index from 0 to the count.
    fn vertex(&self, index: f64) -> Vector<N> {
        let (arc, share) = (&self.arc, index / self.count);
        if share <= 0.0 || share >= 1.0 {
            return arc.point(share);
        }
        let ((radial, lateral), (start, end)) = (arc.frame(), arc.radii());
        let (sine, cosine) = (share * arc.sweep()).sin_cos();
        let radius = start + share * (end - start) + self.shape.outward;
        arc.center() + (radial * cosine + lateral * sine) * radius + arc.lift() * share
    }

    /// The feedrate that velocities of the axes leave on every chord.
    pub(crate) fn largest_feed(&self, velocity: &Vector<N>) -> f64 {
        let mut from = self.arc.start();
        let mut feed = f64::INFINITY;
        for vertex in self.vertices() {
            let span = vertex - from;
            feed = feed.min(largest_multiple(&span, velocity) * span.norm());
            from = vertex;
        }
        feed
    }

    /// All vertices after the start.
    fn vertices(&self) -> impl Iterator<Item = Vector<N>> {
        let mut rest = *self;
        core::iter::from_fn(move || rest.next().map(|(vertex, _)| vertex))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn arc(end: [f64; 3], counter_clockwise: bool, turns: u32) -> Arc<3> {
        let (start, end) = (Vector::from([1.0, 0.0, 0.0]), Vector::from(end));
        Arc::about(
            start,
            end,
            Vector::zeros(),
            [0, 1],
            counter_clockwise,
            turns,
        )
        .unwrap()
    }

    #[test]
    fn no_chord_turns_by_more_or_is_shorter_than_what_is_said_of_them_all() {
        for (what, arc) in [
            ("a quarter", arc([0.0, 1.0, 0.0], true, 0)),
            ("a full circle", arc([1.0, 0.0, 0.0], false, 0)),
            ("a helix", arc([0.0, -1.0, 3.0], true, 2)),
            ("a spiral outward", arc([-1.0009, 0.0, 0.0], true, 0)),
            ("a spiral inward", arc([-0.9991, 0.0, 0.0], false, 1)),
            ("a short one inward", arc([0.9992, 0.02, 0.0], true, 0)),
        ] {
            for tolerance in [1e-4, 0.01, 0.5] {
                let chords = Chords::new(arc, tolerance);
                let mut from = arc.start();
                let spans: Vec<_> = chords
                    .vertices()
                    .map(|vertex| core::mem::replace(&mut from, vertex) - vertex)
                    .collect();
                let shortest = spans
                    .iter()
                    .map(|span| span.norm())
                    .fold(f64::INFINITY, f64::min);
                let gap = chords.shortest() - shortest;
                assert!(
                    gap.abs() < 1e-12,
                    "{what} at {tolerance}: {gap} from the shortest"
                );
                let Some(inner) = spans.get(1..spans.len() - 1) else {
                    continue;
                };
                let mut largest = 0.0_f64;
                for pair in inner.windows(2) {
                    let turn = (pair[1].normalize() - pair[0].normalize()).norm();
                    let most = chords.turn();
                    assert!(
                        turn <= most * (1.0 + 1e-9),
                        "{what} at {tolerance}: {turn} > {most}"
                    );
                    largest = largest.max(turn / most);
                }
                assert!(
                    inner.len() < 2 || largest > 0.99,
                    "{what} at {tolerance}: {largest} of what is said"
                );
            }
        }
    }
}
