//! Finds where a long leg divides the plan: a place at which it is passed at its velocity, whatever is before it
//! and whatever follows.
//!
//! Source: ours. A corner motion of at most the velocity `V` reaches no further along a leg than it moves in half of
//! its duration. It turns the velocity by `u`, with a corner error of at least a sixteenth of `u` times its
//! duration, so that the tolerance bounds `u`, and `u` the duration of the motions that are offered. From any speed
//! `s` the rise to `V` takes a distance of at most `(V^2 - s^2)/2A + (V + s)A/2J`, which is largest for
//! `s = A^2/2J`. A leg that is longer than twice both together has room for a corner and a rise before its middle,
//! and for a fall to rest or to any corner behind it: the fastest motion cruises in its middle. Not here: what is
//! decided there.

use crate::segment::Segment;
use toolglide_kinematics::{Limits, PathLimits};

/// What corners may take more than the bound, because they lose time with other shapes.
const MARGIN: f64 = 1.25;

/// Distance along a leg at which it divides the plan; `None` where it is too short.
pub(super) fn division_of<const N: usize>(leg: &Segment<N>, limits: &Limits<N>) -> Option<f64> {
    (leg.length > 2.0 * room_beside(leg, limits)).then_some(0.5 * leg.length)
}

/// Length that a corner and the way between rest, or the corner, and the velocity of a leg take on it at the most.
pub(crate) fn room_beside<const N: usize>(leg: &Segment<N>, limits: &Limits<N>) -> f64 {
    let PathLimits {
        velocity,
        acceleration,
        jerk,
    } = leg.limits;
    let worst = (0.5 * acceleration * acceleration / jerk).min(velocity);
    let rise = (0.5 * (velocity + worst) * (velocity + worst) / acceleration)
        .max(0.5 * velocity * leg.limits.time_to_change(velocity));
    let tolerance = leg.tolerance.length();
    let turned = (64.0 * tolerance * tolerance * limits.jerk().max()).cbrt();
    let slowest = PathLimits {
        velocity,
        acceleration: limits.acceleration().min(),
        jerk: limits.jerk().min(),
    };
    let corner = 0.5 * MARGIN * velocity * slowest.time_to_change(turned.min(2.0 * velocity));
    corner + rise
}
