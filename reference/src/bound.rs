//! Bounds the duration of every motion from below.
//!
//! Source: whatever jerk does inside an interval, its moments keep known bounds, and with them the
//! samples of any motion keep the relaxed program. Its dual gives a number below every such motion,
//! whatever the solver got wrong. The bound holds for all motions that spend the same shares of time
//! on the legs. Not here: all shares, see [`certificate`](crate::certify).

use crate::course::Course;
use crate::error::ReferenceError;
use crate::formulation::{Kind, Room};
use crate::grid::Grid;
use crate::motion::least_time;
use crate::optimum::Settings;
use crate::switches::{passes, times};
use toolglide_kinematics::{Plan, Trajectory};

/// Room for the rounding of the position of a motion, mm and share of a distance.
const ROUNDING: f64 = 1e-9;

/// Scales of time at which the relaxed program is tried, dimensionless.
const SCALES: [f64; 3] = [1.0, 1.3, 0.75];

/// A bound this near to the solution of its program is all that can be had, relative.
const TIGHT: f64 = 3e-5;

/// Largest distance between the ends of a motion and those of the course that it follows, mm.
const SAME_PLACE: f64 = 1e-6;

/// A bound from below on the duration, s, of every motion that spends the same shares of time on the
/// legs of its course as `motion` does: so no such motion, and above all not this one, is faster.
///
/// Nothing is asked of who planned the motion. Where it leaves its leg by more than the tolerance, or
/// leaves a slow move at the feedrate of the next, the bound allows every motion to do so there. There
/// are about as many `intervals` of time, and more where there are many legs.
///
/// # Errors
/// [`ReferenceError::Elsewhere`] for a motion along another course, [`ReferenceError::NotSolved`]
/// when the solver fails.
pub fn lower_bound<const N: usize>(
    course: &Course<N>,
    motion: &Plan<N>,
    intervals: usize,
) -> Result<f64, ReferenceError> {
    let start = (motion.start() - course.start()).norm();
    let distance = start.max((motion.end() - course.end()).norm());
    if distance.is_nan() || distance > SAME_PLACE {
        return Err(ReferenceError::Elsewhere { distance });
    }
    let passes = passes(course, motion);
    let times = times(&passes, motion.duration());
    let settings = Settings::default().with_intervals(intervals).with_least(1);
    let grid = Grid::new(&times, &settings.counts(&times));
    let room = Room {
        nodes: distances(course, motion, &grid),
        joins: passes
            .iter()
            .map(|pass| pass.distance * (1.0 + ROUNDING) + ROUNDING)
            .collect(),
        feeds: feeds(course, motion, &grid),
    };
    relaxed(course, &grid, Some(&room), motion.duration()).ok_or(ReferenceError::NotSolved {
        intervals: grid.intervals(),
        legs: course.legs(),
    })
}

/// The bound of the relaxed program on a grid; `upper` is the duration of a motion that it allows, s.
///
/// Every dual gives a bound, so where the solver stopped early another scale of time is tried, and the
/// best counts.
pub(crate) fn relaxed<const N: usize>(
    course: &Course<N>,
    grid: &Grid,
    room: Option<&Room>,
    upper: f64,
) -> Option<f64> {
    let mut best: Option<f64> = None;
    for scale in SCALES {
        let Some(least) = least_time(course, &grid.stretched(scale), Kind::Relaxed, room, 0.0)
        else {
            continue;
        };
        let bound = least.bound(upper);
        best = Some(best.map_or(bound, |best| best.max(bound)));
        if bound > least.duration.min(upper) * (1.0 - TIGHT) {
            break;
        }
    }
    best
}

/// How far the nodes of a grid are from their legs.
fn distances<const N: usize>(course: &Course<N>, motion: &Plan<N>, grid: &Grid) -> Vec<f64> {
    let mut time = 0.0;
    let mut distances = Vec::with_capacity(grid.intervals() + 1);
    distances.push(0.0);
    for node in 1..=grid.intervals() {
        time += grid.steps[node - 1];
        let position = motion.sample(time).position;
        let legs = [
            grid.serves[node - 1],
            grid.serves[node.min(grid.intervals() - 1)],
        ];
        let far = legs.map(|leg| course.legs[leg].distance(&position));
        distances.push(far[0].max(far[1]) * (1.0 + ROUNDING) + ROUNDING);
    }
    distances
}

/// The largest feedrate of the moves that the motion serves in each interval.
fn feeds<const N: usize>(course: &Course<N>, motion: &Plan<N>, grid: &Grid) -> Vec<f64> {
    let (pieces, knots) = (motion.pieces(), motion.knots());
    let shortest = ROUNDING * motion.duration();
    let mut begin = 0.0;
    grid.steps
        .iter()
        .zip(&grid.serves)
        .map(|(&step, &leg)| {
            let end = begin + step;
            let first = knots
                .partition_point(|&knot| knot <= begin - shortest)
                .max(1)
                - 1;
            let mut feed = course.legs[leg].feed;
            for (piece, &from) in pieces.iter().zip(knots).skip(first) {
                if from >= end + shortest {
                    break;
                }
                let serves = piece.serves();
                let served = course.legs.partition_point(|leg| leg.serves < serves.first);
                for leg in &course.legs[served..] {
                    if leg.serves > serves.last {
                        break;
                    }
                    feed = feed.max(leg.feed);
                }
            }
            begin = end;
            feed
        })
        .collect()
}
