//! Proves that no motion around one corner is faster, for all time fractions.
//!
//! Source: branch and bound over the instant at which the corner is passed. For all instants within an
//! interval of time one relaxed program bounds the duration: both ends of the interval are near the
//! corner, by what the largest speed allows. Intervals that might hold something faster are halved. Not
//! here: several corners, for which this grows beyond bounds.

use crate::bound::relaxed;
use crate::course::{Course, Hold, Join, Segment};
use crate::error::ReferenceError;
use crate::grid::Grid;
use toolglide_kinematics::Vector;

/// Share of the duration below which a gap is closed.
const CLOSED: f64 = 3e-4;

/// Intervals of time on each side of the corner when it is passed half-way.
const HALF: f64 = 100.0;

/// Intervals on a side at least.
const LEAST: usize = 4;

/// Parts into which all instants are divided at first.
const PARTS: u32 = 6;

/// What was proved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// No motion of its class around the corner takes less, s.
    pub lower_bound: f64,
    /// How many programs it took.
    pub programs: usize,
}

/// Bounds the duration of all motions around the corner of a course of two legs; `upper` is the duration
/// of one of them, s. At most about `programs` programs are solved; the bound holds whenever it stops.
///
/// # Errors
/// [`ReferenceError::NotOneCorner`] for more or fewer legs.
pub fn certify<const N: usize>(
    course: &Course<N>,
    upper: f64,
    programs: usize,
) -> Result<Certificate, ReferenceError> {
    let [into, from] = course.legs.as_slice() else {
        return Err(ReferenceError::NotOneCorner {
            legs: course.legs(),
        });
    };
    // Both legs are near only this far from the corner.
    let reach = match course.joins[0] {
        Join::Within(radius) => radius,
        _ => {
            let half_turn_cosine = 0.5 * (into.direction + from.direction).norm();
            into.outer.max(from.outer) / half_turn_cosine
        }
    };
    let speed = into
        .feed
        .max(from.feed)
        .min(course.limits.velocity().norm());
    let earliest = |leg: &Segment<N>| ((leg.length - reach) / (speed * upper)).clamp(0.0, 1.0);
    let (first, last) = (earliest(into), 1.0 - earliest(from));
    let mut open: Vec<(f64, f64, f64)> = Vec::new();
    let mut solved = 0;
    let width = (last - first) / f64::from(PARTS);
    for part in 0..PARTS {
        let low = first + width * f64::from(part);
        open.push((0.0, low, low + width));
    }
    let mut bound = |low: f64, high: f64| {
        solved += 1;
        let bound = within(course, upper, speed, low, high);
        (bound, solved)
    };
    for interval in &mut open {
        interval.0 = bound(interval.1, interval.2).0;
    }
    loop {
        let weakest = (0..open.len()).min_by(|&one, &other| open[one].0.total_cmp(&open[other].0));
        let Some(weakest) = weakest else {
            // No instant is possible, so nothing is faster than what is known.
            return Ok(Certificate {
                lower_bound: upper,
                programs: open.len(),
            });
        };
        let (least, low, high) = open[weakest];
        let middle = 0.5 * (low + high);
        let (one, _) = bound(low, middle);
        let (other, count) = bound(middle, high);
        open[weakest] = (one.max(least), low, middle);
        open.push((other.max(least), middle, high));
        let least = open.iter().fold(upper, |least, part| least.min(part.0));
        if least >= upper * (1.0 - CLOSED) || count >= programs {
            return Ok(Certificate {
                lower_bound: least,
                programs: count,
            });
        }
    }
}

/// A bound for all motions that pass the corner within an interval of their time; 0 where there is
/// none.
fn within<const N: usize>(course: &Course<N>, upper: f64, speed: f64, low: f64, high: f64) -> f64 {
    let (into, from) = (&course.legs[0], &course.legs[1]);
    let passing = Segment {
        start: into.end,
        direction: Vector::zeros(),
        length: 0.0,
        hold: Hold::Free,
        feed: into.feed.max(from.feed),
        ..*into
    };
    let join = match course.joins[0] {
        Join::Within(radius) => Join::Within(radius + speed * (high - low) * upper),
        other => other,
    };
    let three = Course {
        legs: vec![*into, passing, *from],
        joins: vec![join; 2],
        ..*course
    };
    let counts = [intervals(low), 1, intervals(1.0 - high)];
    let times = [low * upper, (high - low) * upper, (1.0 - high) * upper];
    let grid = Grid::new(&times, &counts);
    relaxed(&three, &grid, None, upper).unwrap_or(0.0)
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between 0 and twice HALF"
)]
fn intervals(share: f64) -> usize {
    if share > 0.0 {
        ((2.0 * HALF * share).round() as usize).max(LEAST)
    } else {
        0
    }
}
