//! Finds the times at which a motion passes each corner.
//!
//! Source: the tolerance of a corner is the distance at which the motion passes it, so the closest
//! approach is the change of legs, in path order. Only positions are asked for: whoever planned the
//! motion, the times are found in the same way. Not here: whether the motion is allowed.

use crate::course::Course;
use toolglide_kinematics::{Piece, Plan, Trajectory, Vector};

/// Within a ball around a corner, each step of the search moves by this share of its radius at most.
const STEP: f64 = 1.0 / 16.0;

/// Share by which the ball around a corner is larger than its tolerance: an approach that uses all of
/// it must not be stepped over.
const LARGER: f64 = 0.5;

/// How often the place of the closest approach is narrowed: to 1e-9 of a step.
const NARROWINGS: usize = 43;

/// Golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// A duration shorter than this share of the motion counts as none.
pub(crate) const NO_TIME: f64 = 1e-6;

/// A corner passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pass {
    /// When, s.
    pub(crate) time: f64,
    /// At which distance, mm.
    pub(crate) distance: f64,
}

/// How long a motion spends on each leg of its course, s: from corner to corner, each counted when
/// it is passed most closely.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Feedrate, Limits, Tolerance, Vector};
/// use toolglide_reference::{Course, Settings, leg_times, optimum};
/// let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].map(Vector::<2>::from);
/// let limits = Limits::uniform(500.0, 2500.0, 2e5)?;
/// let course = Course::through(&points, limits, Feedrate::new(100.0)?, Tolerance::new(0.01)?)?;
/// let best = optimum(&course, &[course.stopping_times()], &Settings::default())?;
/// let times = leg_times(&course, best.plan());
/// assert!((times[0] - times[1]).abs() < 1e-4, "the two legs mirror each other: {times:?}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn leg_times<const N: usize>(course: &Course<N>, motion: &Plan<N>) -> Vec<f64> {
    times(&passes(course, motion), motion.duration())
}

pub(crate) fn times(passes: &[Pass], duration: f64) -> Vec<f64> {
    let mut last = 0.0;
    passes
        .iter()
        .map(|pass| pass.time)
        .chain([duration])
        .map(|time| {
            let spent = time - last;
            last = time;
            spent
        })
        .collect()
}

/// The closest approach to each corner, in path order: the first visit to the ball around a corner
/// after the corner before was passed.
pub(crate) fn passes<const N: usize>(course: &Course<N>, motion: &Plan<N>) -> Vec<Pass> {
    let shortest = NO_TIME * motion.duration();
    let mut found: Vec<Pass> = Vec::new();
    for (index, pair) in course.legs.windows(2).enumerate() {
        let corner = pair[0].end;
        let radius = match course.joins[index] {
            crate::course::Join::Within(radius) => radius,
            _ => pair[0].outer.max(pair[1].outer),
        };
        let earliest = found.last().map_or(0.0, |pass| pass.time);
        let mut pass = closest(motion, &corner, radius * (1.0 + LARGER), earliest);
        if pass.time - earliest < shortest {
            let distance = (motion.sample(earliest).position - corner).norm();
            pass = Pass {
                time: earliest,
                distance,
            };
        }
        found.push(pass);
    }
    // Nothing is left for the last leg: the same at the other end.
    let latest = motion.duration() - shortest;
    for (pass, pair) in found.iter_mut().zip(course.legs.windows(2)).rev() {
        if pass.time <= latest {
            break;
        }
        pass.time = latest;
        pass.distance = (motion.sample(latest).position - pair[0].end).norm();
    }
    found
}

fn closest<const N: usize>(
    motion: &Plan<N>,
    corner: &Vector<N>,
    radius: f64,
    earliest: f64,
) -> Pass {
    let knots = motion.knots();
    let mut best = Pass {
        time: earliest,
        distance: f64::INFINITY,
    };
    let (mut visited, mut step_taken) = (false, 0.0);
    let first = knots.partition_point(|&knot| knot <= earliest).max(1) - 1;
    'search: for (piece, ends) in motion.pieces().iter().zip(knots.windows(2)).skip(first) {
        let speed = fastest(piece);
        let mut time = earliest.max(ends[0]);
        loop {
            let distance = (piece.position_at(time - ends[0]) - corner).norm();
            if visited && distance > radius {
                break 'search;
            }
            if distance < best.distance {
                best = Pass { time, distance };
            }
            visited |= distance <= radius;
            // Outside the ball it cannot be reached sooner; inside, small steps.
            let way = (distance - radius).max(STEP * radius);
            let step = way / speed;
            step_taken = f64::max(
                step_taken,
                if visited {
                    step.min(ends[1] - ends[0])
                } else {
                    step
                },
            );
            time += step;
            if time.is_nan() || time >= ends[1] {
                break;
            }
        }
    }
    narrowed(motion, corner, best, step_taken, earliest)
}

/// The closest approach near one that was found in steps.
fn narrowed<const N: usize>(
    motion: &Plan<N>,
    corner: &Vector<N>,
    best: Pass,
    step: f64,
    earliest: f64,
) -> Pass {
    let distance = |time: f64| (motion.sample(time).position - corner).norm();
    let step = step.min(motion.duration());
    let (mut low, mut high) = (
        (best.time - step).max(earliest),
        (best.time + step).min(motion.duration()),
    );
    for _ in 0..NARROWINGS {
        let reach = GOLDEN * (high - low);
        let (left, right) = (high - reach, low + reach);
        if distance(left) <= distance(right) {
            high = right;
        } else {
            low = left;
        }
    }
    let time = 0.5 * (low + high);
    let distance = distance(time);
    if distance <= best.distance {
        Pass { time, distance }
    } else {
        best
    }
}

/// A bound on the speed within a piece: its Bezier points enclose the velocity.
fn fastest<const N: usize>(piece: &Piece<N>) -> f64 {
    let (start, end) = (piece.at(0.0), piece.at(piece.duration()));
    let between = start.velocity + start.acceleration * (0.5 * piece.duration());
    start
        .velocity
        .norm()
        .max(between.norm())
        .max(end.velocity.norm())
}
