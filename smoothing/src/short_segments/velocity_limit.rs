//! Computes the velocity limit curve of a section.
//!
//! Source: ours. At constant speed the filtered motion through a place of the curve has the second
//! and third differences of the points around it for acceleration and jerk, so the speed that a place
//! allows is found by trying; the rest of the limits is left to changes of speed. Not here: the
//! progress.

use crate::segment::Segment;
use crate::short_segments::curve::Curve;
use crate::short_segments::feed_profile::{Filter, Place};
use toolglide_kinematics::{Limits, PathLimits, Vector, largest_multiple};

/// Share of the acceleration that curvature may use.
const CURVATURE_ACCELERATION: f64 = 0.85;
/// Share of the jerk that changes of curvature may use.
const CURVATURE_JERK: f64 = 0.7;
/// Share of the tolerance that curvature may use.
const CURVATURE_TOLERANCE: f64 = 0.8;
/// Ratio of the speeds that are tried at a place.
const LADDER: f64 = 0.95;
/// Lowest speed tried, as a share of the feedrate.
const LOWEST: f64 = 0.01;
/// Share of acceleration and jerk that the curvature of an arc may use where nothing else bends.
const STEADY_ACCELERATION: f64 = 0.93;
const STEADY_JERK: f64 = 0.8;
/// Share of what it leaves that changes of speed may use, and of the jerk that turning these may use.
const STEADY_REST: f64 = 0.95;
const STEADY_TURNING: f64 = 0.8;
/// Share of the limits that changes of speed may use at the least.
const MIN_REST: f64 = 0.35;

/// Gives what each place of the curve from a distance on allows at a share of the feedrate; `false`
/// when `take` has had enough.
pub(super) fn survey<const N: usize>(
    curve: &Curve<N>,
    limits: &Limits<N>,
    filter: &Filter,
    from: f64,
    share: f64,
    mut take: impl FnMut(Place) -> bool,
) -> bool {
    let mut trial = Trial {
        curve,
        limits,
        filter,
        near: 0,
    };
    let mut last_speed = f64::INFINITY;
    let mut start = from;
    let (mut arc_begin, mut arc_end) = (0, 0);
    for (index, leg) in curve.legs().iter().enumerate() {
        let feedrate = leg.limits.velocity * share;
        let spacing = 0.5 * feedrate * filter.step;
        let begin = curve.mark(index);
        let pieces = (leg.length / spacing).ceil().max(1.0);
        let width = leg.length / pieces;
        if index >= arc_end {
            (arc_begin, arc_end) = curve.arc_around(index);
        }
        let lead = (begin - curve.mark(arc_begin)) / width;
        let tail = (curve.mark(arc_end) - curve.mark(index + 1)) / width;
        let steady_limits = steady_limits(leg, limits, feedrate);
        let mut piece = 0.0;
        while piece < pieces {
            // In the middle of a long leg, or of an arc, the curvature is what it is around.
            let straight = lead + piece > 6.5 && tail + pieces - piece > 8.5;
            piece = if straight {
                (pieces - (8.0 - tail).max(0.0).ceil()).max(piece + 1.0)
            } else {
                piece + 1.0
            };
            let end = begin + piece * width;
            if end <= start {
                continue;
            }
            let limits = if straight {
                last_speed = steady_limits.velocity;
                steady_limits
            } else {
                trial.near = index;
                let limits = trial.limits_at(0.5 * (start + end), feedrate, last_speed);
                last_speed = limits.velocity;
                limits
            };
            if !take(Place::new(end, limits, leg.limits.velocity)) {
                return false;
            }
            start = end;
        }
    }
    true
}

/// What the middle of a leg allows, whatever its direction: on an arc, the speed at which curvature uses no more than
/// its share, and what that speed leaves of acceleration and jerk to changes of it.
fn steady_limits<const N: usize>(
    leg: &Segment<N>,
    limits: &Limits<N>,
    feedrate: f64,
) -> PathLimits {
    let Some(bend) = &leg.bend else {
        return PathLimits {
            velocity: feedrate,
            ..leg.limits
        };
    };
    let [acceleration, jerk] = [limits.acceleration(), limits.jerk()].map(|limit| limit.min());
    let radius = bend.bending();
    let velocity = feedrate
        .min((STEADY_ACCELERATION * acceleration * radius).sqrt())
        .min((STEADY_JERK * jerk * radius * radius).cbrt());
    let inward = velocity * velocity / radius;
    let along = (acceleration * acceleration - inward * inward).sqrt() * STEADY_REST;
    // While the speed changes, the curvature changes the direction of that acceleration, and the inward one.
    let turning = |along: f64| 2.0 * velocity / radius * along;
    let fastest = (2.0 / 3.0 * jerk * velocity).sqrt();
    let along = along
        .min(fastest)
        .min(STEADY_TURNING * jerk * radius / (2.0 * velocity));
    let left = (jerk * jerk - turning(along).powi(2)).max(0.0).sqrt() - inward * velocity / radius;
    PathLimits {
        velocity,
        acceleration: along
            .max(MIN_REST * acceleration)
            .min(leg.limits.acceleration),
        jerk: (left * STEADY_REST)
            .max(MIN_REST * jerk)
            .min(leg.limits.jerk),
    }
}

/// Tries speeds at places of a curve.
struct Trial<'a, const N: usize> {
    curve: &'a Curve<N>,
    limits: &'a Limits<N>,
    filter: &'a Filter,
    near: usize,
}

impl<const N: usize> Trial<'_, N> {
    /// The largest speed of the ladder that the place allows, and what it leaves to changes of speed.
    fn limits_at(&self, distance: f64, feedrate: f64, guess: f64) -> PathLimits {
        let try_at = |speed: f64| {
            let [second, third] = self.differences(distance, speed);
            self.fits(distance, &second, &third)
                .then(|| self.rest(distance, speed, &second, &third))
        };
        let mut speed = guess.min(feedrate);
        if let Some(mut found) = try_at(speed) {
            while speed < feedrate {
                let faster = (speed / LADDER).min(feedrate);
                let Some(better) = try_at(faster) else {
                    return try_at(0.5 * (speed + faster)).unwrap_or(found);
                };
                found = better;
                speed = faster;
            }
            return found;
        }
        loop {
            speed *= LADDER;
            if let Some(found) = try_at(speed) {
                return try_at(0.5 * speed * (1.0 + 1.0 / LADDER)).unwrap_or(found);
            }
            if speed < LOWEST * feedrate {
                let [second, third] = self.differences(distance, speed);
                return self.rest(distance, speed, &second, &third);
            }
        }
    }

    /// Second and third difference of the control points around a distance. Stopping at an end is a change of
    /// speed, and no curvature.
    fn differences(&self, distance: f64, speed: f64) -> [Vector<N>; 2] {
        let reach = speed * self.filter.reach();
        let at = |share: f64| {
            let distance = distance + share * reach;
            self.curve
                .point_beyond(distance, self.curve.leg_at(distance, self.near))
        };
        let second = at(1.0) - at(0.0) * 2.0 + at(-1.0);
        let third = at(1.5) - at(0.5) * 3.0 + at(-0.5) * 3.0 - at(-1.5);
        let amplified = self.filter.sharpening;
        [
            second * (1.0 + amplified / 3.0),
            third * (1.0 + 0.5 * amplified),
        ]
    }

    fn fits(&self, distance: f64, second: &Vector<N>, third: &Vector<N>) -> bool {
        let step = self.filter.reach();
        let leg = &self.curve.legs()[self.curve.leg_at(distance, self.near)];
        let off = second.norm() * (1.0 - self.filter.sharpening).max(0.25) / 6.0;
        largest_multiple(second, self.limits.acceleration()) * CURVATURE_ACCELERATION * step * step
            >= 1.0
            && largest_multiple(third, self.limits.jerk()) * CURVATURE_JERK * step.powi(3) >= 1.0
            && off <= CURVATURE_TOLERANCE * leg.room().length()
    }

    /// What curvature leaves of the limits along the path.
    fn rest(&self, distance: f64, speed: f64, second: &Vector<N>, third: &Vector<N>) -> PathLimits {
        let step = self.filter.reach();
        let leg = &self.curve.legs()[self.curve.leg_at(distance, self.near)];
        let mut rest = PathLimits {
            velocity: speed,
            ..leg.limits
        };
        let used = |difference: f64, bound: f64| (bound - difference.abs()).max(MIN_REST * bound);
        for axis in 0..N {
            let share = leg.direction[axis].abs();
            if share > 0.0 {
                let acceleration = used(
                    second[axis] / (step * step),
                    self.limits.acceleration()[axis],
                );
                let jerk = used(third[axis] / step.powi(3), self.limits.jerk()[axis]);
                rest.acceleration = rest.acceleration.min(acceleration / share);
                rest.jerk = rest.jerk.min(jerk / share);
            }
        }
        rest
    }
}
