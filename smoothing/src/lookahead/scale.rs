//! Scales two corner blends so that the segment between them has room for both.
//!
//! Source: section 3.3.1; lengths go with the cube of the scale. Not here: the order in which corners
//! are looked at, see the window.

use crate::lookahead::window::{Link, Node};
use toolglide_kinematics::numeric::{CLOSURE, SEARCH_PRECISION};
use toolglide_profiles::{BlendShape, Boundary, SCurveBoundary, SpeedRamp};

/// Speed that is reached when the acceleration at the boundary of a turn runs out on `link`.
#[inline]
fn peak(boundary: &Boundary, link: &Link) -> f64 {
    SpeedRamp::least_peak(boundary.speed, boundary.acceleration, link.limits.jerk)
}

/// Largest scale whose peak stays below the feedrate.
pub(crate) fn feed_cap(boundary: &Boundary, link: &Link) -> f64 {
    let peak = peak(boundary, link);
    if peak > link.limits.velocity {
        (link.limits.velocity / peak).sqrt()
    } else {
        1.0
    }
}

/// Length that a turn and the running out of its acceleration need on one side.
fn footprint(boundary: &Boundary, jerk: f64) -> f64 {
    let Boundary {
        distance,
        speed,
        acceleration,
    } = *boundary;
    let time = acceleration / jerk;
    time * (speed + time * acceleration / 3.0) + distance
}

/// Scales of two turns with equal peaks that together just fill the move between them; `None` where
/// one is a stop.
pub(crate) fn balance(left: &Boundary, right: &Boundary, link: &Link) -> Option<(f64, f64)> {
    let (left_peak, right_peak) = (peak(left, link), peak(right, link));
    if left_peak <= 0.0 || right_peak <= 0.0 {
        return None;
    }
    let common = left_peak.min(right_peak);
    let (left_scale, right_scale) = ((common / left_peak).sqrt(), (common / right_peak).sqrt());
    let needed = left_scale.powi(3) * footprint(left, link.limits.jerk)
        + right_scale.powi(3) * footprint(right, link.limits.jerk);
    let factor = if needed > 0.0 {
        (link.length / needed).cbrt()
    } else {
        f64::INFINITY
    };
    Some((factor * left_scale, factor * right_scale))
}

/// Length left over on `link` by two scaled turns and the shortest connection between them.
#[inline]
fn room(
    left: &BlendShape,
    left_scale: f64,
    right: &BlendShape,
    right_scale: f64,
    link: &Link,
) -> f64 {
    let left = left.exit.scaled(left_scale);
    let right = right.entry.scaled(right_scale);
    let connection = SCurveBoundary {
        from: [left.speed, left.acceleration],
        to: [right.speed, right.acceleration],
        limits: link.limits,
    };
    link.length * (1.0 - CLOSURE) - (connection.least_distance() + left.distance + right.distance)
}

/// Largest scale of `node` known to fit `link` together with some reachable scale of `next`, and that
/// scale.
pub(crate) fn reachable(node: &Node, next: &Node, link: &Link) -> (f64, f64) {
    if node.cap <= 0.0 {
        return (0.0, 0.0);
    }
    let ratio = {
        let (own, other) = (peak(&node.shape.exit, link), peak(&next.shape.entry, link));
        if other > 0.0 {
            (own / other).sqrt()
        } else {
            f64::INFINITY
        }
    };
    // With the next corner at the same peak, or at its own bound where that is lower.
    let partner = |scale: f64| {
        if next.upper > 0.0 {
            next.upper.min(scale * ratio)
        } else {
            0.0
        }
    };
    let fits = |scale: f64| room(&node.shape, scale, &next.shape, partner(scale), link);
    if fits(node.cap) >= 0.0 {
        return (node.cap, partner(node.cap));
    }
    let mut best = (0.0, 0.0);
    if next.upper > 0.0 {
        // Below the kink both scales are proportional, and lengths go with the cube.
        let kink = (next.upper / ratio).min(node.cap);
        let proportional = if fits(kink) >= 0.0 {
            largest(fits, kink, node.cap)
        } else {
            let needed = link.length - room(&node.shape, kink, &next.shape, partner(kink), link);
            kink * (link.length * (1.0 - SEARCH_PRECISION) / needed).cbrt()
        };
        best = (proportional, partner(proportional));
    }
    // With a stop at the next corner.
    let stops = |scale: f64| room(&node.shape, scale, &next.shape, 0.0, link);
    if stops(best.0) > 0.0 {
        let scale = largest(stops, best.0, node.cap);
        if scale > best.0 {
            best = (scale, 0.0);
        }
    }
    if room(&node.shape, best.0, &next.shape, best.1, link) >= 0.0 {
        best
    } else {
        (0.0, 0.0)
    }
}

/// Largest scale found for `next` that fits after `from`, whose scale is 1.
pub(crate) fn furthest(from: &Node, next: &Node, link: &Link) -> f64 {
    let fits = |scale: f64| room(&from.shape, 1.0, &next.shape, scale, link);
    if next.upper <= 0.0 || fits(next.upper) >= 0.0 {
        return next.upper;
    }
    let witness = (from.witness).min(next.upper);
    let other = peak(&next.shape.entry, link);
    let equal = if other > 0.0 {
        (peak(&from.shape.exit, link) / other)
            .sqrt()
            .min(next.upper)
    } else {
        0.0
    };
    let mut lower = witness;
    for share in [1.0, 0.9, 0.75, 0.5] {
        let scale = share * equal;
        if scale <= witness {
            break;
        }
        if fits(scale) >= 0.0 {
            lower = scale;
            break;
        }
    }
    largest(fits, lower, next.upper)
}

/// A zero of a function from its positive side, between `low`, where it is not negative, and `high`,
/// where it is negative: secant steps that keep the bracket.
fn largest(function: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let (mut at_low, mut at_high) = (function(low), function(high));
    if at_high >= 0.0 {
        return high;
    }
    let mut last_side = 0_i8;
    for _ in 0..40 {
        if high - low <= SEARCH_PRECISION * high {
            break;
        }
        let span = high - low;
        let guess = (low + span * at_low / (at_low - at_high))
            .clamp(low + 0.02 * SEARCH_PRECISION * span, high);
        // Aim a little inside, so that the bracket closes from the feasible side too.
        let guess = guess - 0.5 * SEARCH_PRECISION * guess.min(span);
        let value = function(guess);
        if value >= 0.0 {
            if last_side > 0 {
                at_high *= 0.5;
            }
            last_side = 1;
            low = guess;
            at_low = value;
        } else {
            if last_side < 0 {
                at_low *= 0.5;
            }
            last_side = -1;
            high = guess;
            at_high = value;
        }
    }
    low
}
