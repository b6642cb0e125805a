//! Scores motions against the optimum of their course.
//!
//! Source: a score is the duration of the optimum over that of a motion; legs dilute it, so what the
//! corners cost stands beside it. Every motion is also held against the bound at its own shares of time,
//! which no motion can pass. Not here: who planned the motions.

use crate::bound::lower_bound;
use crate::course::Course;
use crate::error::ReferenceError;
use crate::optimum::{Optimum, Settings, optimum};
use crate::straight::along;
use crate::switches::leg_times;
use toolglide_kinematics::{Plan, Trajectory};

/// Legs up to which the search starts from full stops too: a second start costs as much again.
const TWO_STARTS: usize = 8;

/// No duration to start from is below this share of the time that the leg takes at full speed: a
/// motion may pass short legs in no time.
const FAST: f64 = 0.1;

/// One motion along a course.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// How long it takes, s.
    pub duration: f64,
    /// No motion with its shares of time on the legs takes less, s; `None` where the solver failed.
    pub lower_bound: Option<f64>,
    /// How long it spends on each leg, s.
    pub leg_times: Vec<f64>,
}

/// Motions along one course, and its optimum.
#[derive(Clone, Debug, PartialEq)]
pub struct Score<const N: usize> {
    /// The optimum.
    pub optimum: Optimum<N>,
    /// The motions, in the order in which they were given.
    pub motions: Vec<Held>,
    /// What the length of the course would take without corners, s.
    pub straight_time: f64,
}

/// The share of `duration` that the `optimum` takes: 1 is the best there is.
#[must_use]
pub fn score(optimum: f64, duration: f64) -> f64 {
    if duration > 0.0 {
        optimum / duration
    } else {
        1.0
    }
}

/// What corners cost in the optimum over what they cost in a motion: 1 is the best there is. `None` where
/// a motion has nothing to lose at corners.
#[must_use]
pub fn corner_penalty_ratio(optimum: f64, duration: f64, straight_time: f64) -> Option<f64> {
    let (least, cost) = (optimum - straight_time, duration - straight_time);
    (cost > 0.0 && least > 0.0).then(|| least / cost)
}

/// Finds the optimum of a course and holds motions against it. The search starts from the fastest
/// of them, so that no motion has an advantage that the optimum could not find, and where the fastest of those
/// that are `legal` is faster still, on a finer grid of time, it is the optimum: no legal motion scores above 1.
/// `legal` says of each motion whether it keeps limits and tolerance. `done` is called after the optimum and after
/// each motion.
///
/// # Errors
/// As [`optimum()`](optimum()).
pub fn hold<const N: usize>(
    course: &Course<N>,
    motions: &[Plan<N>],
    legal: &[bool],
    settings: &Settings,
    done: &mut dyn FnMut(),
) -> Result<Score<N>, ReferenceError> {
    let times: Vec<Vec<f64>> = motions
        .iter()
        .map(|motion| leg_times(course, motion))
        .collect();
    let fastest = (0..motions.len()).min_by(|&one, &other| {
        let durations = (motions[one].duration(), motions[other].duration());
        durations.0.total_cmp(&durations.1)
    });
    let mut starts = Vec::new();
    if let Some(fastest) = fastest {
        starts.push(startable(course, &times[fastest]));
    }
    if course.legs() <= TWO_STARTS || starts.is_empty() {
        starts.push(course.stopping_times());
    }
    let mut optimum = optimum(course, &starts, settings)?;
    done();
    let held: Vec<Held> = motions
        .iter()
        .zip(times)
        .map(|(motion, leg_times)| {
            let held = Held {
                duration: motion.duration(),
                lower_bound: lower_bound(course, motion, settings.intervals()).ok(),
                leg_times,
            };
            done();
            held
        })
        .collect();
    for ((motion, held), legal) in motions.iter().zip(&held).zip(legal) {
        if *legal && held.duration < optimum.duration() {
            optimum.give_way_to(motion, held);
        }
    }
    Ok(Score {
        optimum,
        motions: held,
        straight_time: course.straight_time(),
    })
}

/// Durations from which a search can start.
fn startable<const N: usize>(course: &Course<N>, times: &[f64]) -> Vec<f64> {
    course
        .legs
        .iter()
        .zip(times)
        .map(|(leg, &time)| {
            let least = leg.length / along(&course.limits, leg).velocity;
            time.max(FAST * least)
        })
        .collect()
}

/// The part of a motion that serves the moves of a course.
#[must_use]
pub fn part<const N: usize>(motion: &Plan<N>, course: &Course<N>) -> Plan<N> {
    let (first, last) = (course.move_of(0), course.move_of(course.legs() - 1));
    let mut plan = Plan::starting_at(course.start());
    plan.extend(motion.pieces().iter().copied().filter(|piece| {
        let serves = piece.serves();
        serves.first <= last && serves.last >= first
    }));
    plan
}
