//! Divides arcs into chords, one at a time.
//!
//! Source: ours. Between two points of an arc the chord lies off by at most an eighth of the square
//! of the angle times the radius, which bounds a helix and slightly unequal radii alike. Not here:
//! the joining of very short chords.

use crate::path::spans::{Fineness, SPAN_STEPS, interval_at};
use crate::window::Follow;
use std::f64::consts::{FRAC_PI_2, TAU};
use toolglide_kinematics::{Arc, Limits, PathLimits, Vector};

/// Share of the tolerance that lies between an arc and its chords. What is left is the tube around
/// the chords, in which the motion rounds them off again.
const CHORD_SHARE: f64 = 0.3;

/// A motion that follows an arc is seen to do so at points this far apart, as a share of a turn, at
/// the most; chords end there.
const WAYPOINT_SPACING: f64 = TAU / 3.0;

/// Share of acceleration and jerk that uniform motion along a circle may use, for it to be followed.
const FOLLOWED: f64 = 0.9;

/// Difference of the radii of an arc, as a share, above which it is not followed.
const UNEQUAL: f64 = 1e-3;

/// Room at the ends of an arc for the way to and from other moves, in distances to stop, and at least so much, rad.
const STOPS: f64 = 1.5;
const LEAST_END: f64 = 0.3;

/// Largest angle of a chord of an arc that is followed, rad.
const WIDEST: f64 = 0.16;

/// How near the motion comes to an arc that it follows, as a share of the tolerance, of which at least so much counts,
/// mm.
const CLOSE: f64 = 0.012;
const COARSE: f64 = 0.05;

/// The ends of the chords of an arc, in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Chords<const N: usize> {
    arc: Arc<N>,
    count: f64,
    next: f64,
    bulge: f64,
    /// Shares of the sweep between which the motion shall follow the arc, and how near, mm.
    followed: [f64; 2],
    radius: f64,
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
            followed: [1.0, 0.0],
            radius: f64::INFINITY,
        }
    }

    /// The same where the motion can follow the arc at its feedrate, within these limits, away from its ends.
    pub(crate) fn following(
        arc: Arc<N>,
        tolerance: f64,
        feedrate: f64,
        limits: &Limits<N>,
        fineness: Fineness,
    ) -> Self {
        let mut chords = Self::new(arc, tolerance);
        let (from, to) = arc.radii();
        let radius = from.max(to);
        let circle = in_circle(limits, &arc);
        let speed = feedrate.min(circle.velocity);
        let can = speed * speed <= FOLLOWED * circle.acceleration * radius
            && speed * speed * speed <= FOLLOWED * circle.jerk * radius * radius
            && (from - to).abs() <= UNEQUAL * radius;
        if !can {
            return chords;
        }
        let sweep = arc.sweep().abs();
        let (interval, weak) = interval_at(limits, speed, fineness);
        let stop = 0.5 * speed * weak.time_to_change(speed);
        let end = (STOPS * stop / radius).max(LEAST_END) / sweep;
        if end >= 0.5 {
            return chords;
        }
        // A chord is one span.
        let longest = (speed * interval * (SPAN_STEPS - 2.0) / arc.length()).min(WIDEST / sweep);
        let more = (1.0 / (longest * chords.count)).max(1.0).ceil();
        chords.count *= more;
        chords.bulge /= more * more;
        chords.followed = [end, 1.0 - end];
        chords.radius = CLOSE * tolerance.max(COARSE);
        chords
    }

    /// The arc over the chord that ended last, where the motion shall follow it.
    pub(crate) fn follow(&self) -> Option<Follow<N>> {
        let [from, to] = [self.next - 2.0, self.next - 1.0].map(|at| at / self.count);
        if from < self.followed[0] || to > self.followed[1] {
            return None;
        }
        let middle = self.arc.point(0.5 * (from + to));
        Some(Follow {
            sagitta: middle - (self.arc.point(from) + self.arc.point(to)) * 0.5,
            radius: self.radius,
        })
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

/// Largest speed, acceleration and jerk of uniform motion along an arc, by its weakest axis.
fn in_circle<const N: usize>(limits: &Limits<N>, arc: &Arc<N>) -> PathLimits {
    let (radial, lateral) = arc.frame();
    let lift = arc.lift();
    let turn = arc.length() / arc.sweep().abs();
    let mut circle = PathLimits {
        velocity: f64::INFINITY,
        acceleration: f64::INFINITY,
        jerk: f64::INFINITY,
    };
    for axis in 0..N {
        if radial[axis].abs() + lateral[axis].abs() > 0.0 {
            circle.velocity = circle.velocity.min(limits.velocity()[axis]);
            circle.acceleration = circle.acceleration.min(limits.acceleration()[axis]);
            circle.jerk = circle.jerk.min(limits.jerk()[axis]);
        } else if lift[axis].abs() > 0.0 {
            let share = (lift[axis] / arc.sweep()).abs() / turn;
            circle.velocity = circle.velocity.min(limits.velocity()[axis] / share);
        }
    }
    circle
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
