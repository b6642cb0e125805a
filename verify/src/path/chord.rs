//! Bounds how far the motion may leave the chord between two set-points.
//!
//! Source: a motion of acceleration at most `a` leaves the chord of a time `t` by at most
//! `a t^2 / 8`, and one that rests at a point within a time `t` is at most `j t^3 / 6` away from it.
//! Not here: the path.

use crate::path::leg::Leg;
use crate::set_points::differences::Recent;
use crate::set_points::spacing::bend_distance;
use toolglide_kinematics::Limits;
use toolglide_kinematics::Vector;
use toolglide_kinematics::numeric::LIMIT_SLACK;

/// Two set-points in a row; the first point of all is a chord of no length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chord<const N: usize> {
    from: Vector<N>,
    pub(crate) to: Vector<N>,
    pub(crate) begin: f64,
    pub(crate) duration: f64,
    /// How far the motion may be from the chord.
    pub(crate) sagitta: f64,
    /// The same, rounding included.
    pub(crate) slack: f64,
    /// How far rounding may have moved the newer point.
    pub(crate) rounding: f64,
    /// How far each axis may move from rest, or to rest, within the time, rounding included.
    reach: Vector<N>,
    /// The most of any axis, without rounding.
    pub(crate) rest_reach: f64,
}

impl<const N: usize> Chord<N> {
    /// The chord between the two newest points, of a motion that began at `first_time`.
    pub(crate) fn newest(recent: &Recent<N>, limits: &Limits<N>, first_time: f64) -> Option<Self> {
        let points = recent.points();
        let (end, to) = *points.first()?;
        let (begin, from) = *points.get(1).unwrap_or(&points[0]);
        let duration = end - begin;
        let mean = recent.mean(2);
        let rounding = recent.rounding(end, &to);
        // Until two chords are known the motion has only just left its rest.
        let distance = mean.map_or(duration, |mean| {
            bend_distance(mean.span - duration, duration)
        });
        let bend = Vector::<N>::from_fn(|axis, _| {
            let (a, j) = (limits.acceleration()[axis], limits.jerk()[axis]);
            let seen = mean.map_or(0.0, |mean| mean.value[axis].abs() + mean.noise[axis]);
            let near = seen + j * distance;
            if near < a { near } else { a }
        });
        let sagitta = bend.norm() * duration * duration / 8.0;
        let far = Vector::<N>::from_fn(|axis, _| {
            let (a, j) = (limits.acceleration()[axis], limits.jerk()[axis]);
            (0.5 * a).min(j * duration / 6.0) * duration * duration
        });
        Some(Self {
            from,
            to,
            begin: begin - first_time,
            duration,
            sagitta,
            slack: sagitta * (1.0 + LIMIT_SLACK) + rounding.norm(),
            rounding: rounding.norm(),
            reach: far * (1.0 + LIMIT_SLACK) + rounding,
            rest_reach: far.amax(),
        })
    }

    pub(crate) fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }

    /// Whether the motion moves away from a point and is farther than a distance already; never
    /// where the points are so far apart that it may have been nowhere near.
    pub(crate) fn leaves(&self, point: &Vector<N>, distance: f64) -> bool {
        let away = (self.to - point).norm();
        self.slack <= distance && away > distance + self.slack && away > (self.from - point).norm()
    }

    /// How far a point certainly is from the motion, and when it is closest.
    pub(crate) fn distance(&self, point: &Vector<N>) -> (f64, f64) {
        let span = self.to - self.from;
        let offset = point - self.from;
        let square = span.norm_squared();
        let share = if square > 0.0 {
            (offset.dot(&span) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let distance = (offset - span * share).norm() - self.slack;
        (distance.max(0.0), self.begin + share * self.duration)
    }

    /// The first share of the chord from `from` on that may be within `distance` of a point.
    pub(crate) fn enters(&self, point: &Vector<N>, distance: f64, from: f64) -> Option<f64> {
        let span = self.to - self.from;
        let offset = self.from - point;
        let room = distance + self.slack;
        if (offset + span * from).norm() <= room {
            return Some(from);
        }
        let square = span.norm_squared();
        let nearest = -offset.dot(&span) / square;
        // Not a number for a chord of no length.
        if nearest.is_nan() || nearest < from {
            return None;
        }
        let nearest = nearest.min(1.0);
        if (offset + span * nearest).norm() > room {
            return None;
        }
        let foot = -offset.dot(&span) / square;
        let height = (offset + span * foot).norm_squared();
        let half = ((room * room - height).max(0.0) / square).sqrt();
        Some((foot - half).clamp(from, nearest))
    }

    /// Whether the motion may have rested at the end of a move within this time.
    pub(crate) fn may_rest_at(&self, leg: &Leg<N>) -> bool {
        (0..N).all(|axis| {
            let room = self.reach[axis] + leg.slack;
            (self.from[axis] - leg.end[axis]).abs() <= room
                && (self.to[axis] - leg.end[axis]).abs() <= room
        })
    }
}
