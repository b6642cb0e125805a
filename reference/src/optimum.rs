//! Computes the time-optimal motion along a course.
//!
//! Source: durations by the sequential scheme on samples, then once more with Bezier points in the
//! tube, so that the motion is allowed at every instant, and a bound from below at the same shares of
//! time. The motion is a [`Plan`] like any other. Not here: how each of it is found.

use crate::bound::relaxed;
use crate::course::{Course, Hold, Join};
use crate::durations::best_durations;
use crate::error::ReferenceError;
use crate::formulation::Kind;
use crate::grid::{Grid, share};
use crate::motion::{Least, least_time};
use crate::pieces::pieces;
use crate::score::Held;
use crate::straight::{Straight, along};
use toolglide_kinematics::{Plan, Trajectory};

/// Share by which the tube of the program is narrower than the tolerance: what the precision of the
/// solver and its correction move. It costs some 1e-5 of the time.
const MARGIN: f64 = 2e-4;

/// How far a Bezier point may be outside the tolerance after all, mm: rounding.
const OUTSIDE: f64 = 1e-9;

/// Intervals for each leg on the average, at least.
const PER_LEG: usize = 12;

/// Intervals beyond which legs get fewer: a program of so many takes the solver about a second.
const MAX_INTERVALS: usize = 1200;

/// Legs from which on durations are sought on a coarse grid first.
const MANY_LEGS: usize = 4;

/// How finely the optimum is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    intervals: usize,
    least: usize,
}

impl Default for Settings {
    /// 240 intervals of time, more for more than twenty legs, and no less than six on a leg: 2e-4 of
    /// the duration is left between motion and bound at a corner.
    fn default() -> Self {
        Self {
            intervals: 240,
            least: 6,
        }
    }
}

impl Settings {
    /// About as many intervals of time, at least four.
    #[must_use]
    pub fn with_intervals(mut self, intervals: usize) -> Self {
        self.intervals = intervals.max(4);
        self
    }

    /// At least so many intervals on every leg, at least one.
    #[must_use]
    pub fn with_least(mut self, least: usize) -> Self {
        self.least = least.max(1);
        self
    }

    /// How many intervals each leg has that lasts `times`: by duration, and no leg too few.
    pub(crate) fn counts(&self, times: &[f64]) -> Vec<usize> {
        let legs = times.len().max(1);
        let wanted = self.intervals.max(PER_LEG * legs);
        let intervals = wanted.min(self.intervals.max(MAX_INTERVALS));
        share(
            times,
            intervals,
            self.least.min((MAX_INTERVALS / legs).max(2)),
        )
    }

    /// About how many intervals of time there are.
    #[must_use]
    pub fn intervals(&self) -> usize {
        self.intervals
    }
}

/// The time-optimal motion along a course, and how much faster it could be at most.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum<const N: usize> {
    plan: Plan<N>,
    times: Vec<f64>,
    sampled: f64,
    lower_bound: f64,
}

impl<const N: usize> Optimum<N> {
    /// The motion.
    #[must_use]
    pub fn plan(&self) -> &Plan<N> {
        &self.plan
    }

    /// How long the motion lasts, s: a bound from above on the least time. On a single leg it is the
    /// closed form, where that is shorter than what was solved; where motions were held against it, the fastest of
    /// those, where that is shorter.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.plan.duration()
    }

    /// How long it would last if only its samples had to keep the tolerance, s: closest to the least
    /// time, but no bound.
    #[must_use]
    pub fn sampled_duration(&self) -> f64 {
        self.sampled
    }

    /// No motion with the same shares of time on the legs lasts less, s.
    #[must_use]
    pub fn lower_bound(&self) -> f64 {
        self.lower_bound
    }

    /// Another motion that is allowed and faster takes its place. What is known from below is then the bound at the
    /// shares of that motion.
    pub(crate) fn give_way_to(&mut self, motion: &Plan<N>, held: &Held) {
        self.plan = motion.clone();
        self.times.clone_from(&held.leg_times);
        self.sampled = self.sampled.min(held.duration);
        self.lower_bound = held
            .lower_bound
            .unwrap_or(self.lower_bound)
            .min(held.duration);
    }

    /// How long the motion spends on each leg, s.
    #[must_use]
    pub fn leg_times(&self) -> &[f64] {
        &self.times
    }
}

/// Finds the time-optimal motion along a course.
///
/// The search starts from durations of the legs, s: those of any plan, or
/// [`Course::stopping_times`]. Of several starts the best end counts.
///
/// # Errors
/// [`ReferenceError::Durations`] and [`ReferenceError::NotPositive`] for durations that do not fit;
/// [`ReferenceError::NotSolved`] when the solver fails; [`ReferenceError::Refused`] when what it finds
/// is not precise enough to keep the tolerance.
pub fn optimum<const N: usize>(
    course: &Course<N>,
    starts: &[Vec<f64>],
    settings: &Settings,
) -> Result<Optimum<N>, ReferenceError> {
    let mut optimum = upper_bound(course, starts, settings)?;
    let grid = Grid::new(&optimum.times, &settings.counts(&optimum.times));
    if let Some(straight) = straight(course)
        && straight.duration() < optimum.duration()
    {
        // On one leg the grid is all that the program loses to the closed form.
        optimum.times = vec![straight.duration()];
        optimum.plan = straight;
    }
    optimum.lower_bound = relaxed(course, &grid, None, optimum.duration())
        .ok_or_else(|| not_solved(course, &grid))?;
    Ok(optimum)
}

/// The duration of the best motion on samples at given durations of the legs up to a common factor, s:
/// one convex program, without a search.
///
/// # Errors
/// As [`optimum`].
pub fn solved_once<const N: usize>(
    course: &Course<N>,
    times: &[f64],
    settings: &Settings,
) -> Result<f64, ReferenceError> {
    check(course, times)?;
    let grid = Grid::new(times, &settings.counts(times));
    least_time(course, &grid, Kind::Sampled, None, 0.0)
        .map(|least| least.duration)
        .ok_or_else(|| not_solved(course, &grid))
}

/// The motion exactly along a course of one leg.
fn straight<const N: usize>(course: &Course<N>) -> Option<Plan<N>> {
    let [leg] = course.legs.as_slice() else {
        return None;
    };
    let mut plan = Plan::starting_at(leg.start);
    plan.extend(Straight::over(leg.length, &along(&course.limits, leg)).pieces(leg));
    Some(plan)
}

/// The motion alone, with a bound of 0.
pub(crate) fn upper_bound<const N: usize>(
    course: &Course<N>,
    starts: &[Vec<f64>],
    settings: &Settings,
) -> Result<Optimum<N>, ReferenceError> {
    let mut best: Option<Least<N>> = None;
    let mut tried = Grid::new(&[], &[]);
    for times in starts {
        check(course, times)?;
        let counts = settings.counts(times);
        tried = Grid::new(times, &counts);
        if course.legs() >= MANY_LEGS {
            let coarse: Vec<_> = counts.iter().map(|count| count.div_ceil(2)).collect();
            let coarse = Grid::new(times, &coarse);
            if let Some(found) = best_durations(course, &coarse, Kind::Sampled, 0.0) {
                let times = found.grid.leg_times();
                tried = Grid::new(&times, &settings.counts(&times));
            }
        }
        let found = best_durations(course, &tried, Kind::Sampled, 0.0);
        best = match (best, found) {
            (Some(best), Some(found)) if found.duration < best.duration => Some(found),
            (None, found) => found,
            (best, _) => best,
        };
    }
    let sampled = best.ok_or_else(|| not_solved(course, &tried))?;
    let enclosed = least_time(course, &sampled.grid, Kind::Enclosed, None, MARGIN)
        .ok_or_else(|| not_solved(course, &sampled.grid))?;
    let plan = pieces(course, &enclosed.motion, &enclosed.grid.serves);
    keeps(course, &plan, &enclosed.grid)?;
    let slower = plan.duration() / enclosed.grid.duration();
    let times = enclosed.grid.stretched(slower).leg_times();
    Ok(Optimum {
        plan,
        times,
        sampled: sampled.duration,
        lower_bound: 0.0,
    })
}

fn not_solved<const N: usize>(course: &Course<N>, grid: &Grid) -> ReferenceError {
    ReferenceError::NotSolved {
        intervals: grid.intervals(),
        legs: course.legs(),
    }
}

fn check<const N: usize>(course: &Course<N>, times: &[f64]) -> Result<(), ReferenceError> {
    if times.len() != course.legs() {
        return Err(ReferenceError::Durations {
            given: times.len(),
            legs: course.legs(),
        });
    }
    match times
        .iter()
        .position(|&time| !(time > 0.0 && time.is_finite()))
    {
        Some(leg) => Err(ReferenceError::NotPositive {
            leg,
            quantity: "duration",
            value: times[leg],
        }),
        None => Ok(()),
    }
}

/// Whether the Bezier points of all pieces keep the tolerance of their legs, and the motion that of
/// the corners; the program said so, but only to the precision of its solver.
fn keeps<const N: usize>(
    course: &Course<N>,
    plan: &Plan<N>,
    grid: &Grid,
) -> Result<(), ReferenceError> {
    let refuse = |leg: usize, what: &str, by: f64| {
        Err(ReferenceError::Refused {
            legs: course.legs(),
            reason: format!("leg {leg}: {what} by {by:.3e} mm"),
        })
    };
    for (k, (piece, &index)) in plan.pieces().iter().zip(&grid.serves).enumerate() {
        let leg = &course.legs[index];
        let third = piece.duration() / 3.0;
        let (start, end) = (piece.at(0.0), piece.at(piece.duration()));
        let points = [
            start.position,
            start.position + start.velocity * third,
            end.position - end.velocity * third,
            end.position,
        ];
        for (place, point) in points.iter().enumerate() {
            // Nodes at corners are near the corner.
            let shared = (place == 0 && k > 0 && grid.serves[k - 1] != index)
                || (place == 3 && grid.serves.get(k + 1).is_some_and(|&next| next != index));
            let beyond = leg.distance(point) - leg.inner;
            if leg.hold != Hold::Free && !shared && beyond > OUTSIDE {
                return refuse(index, "the tolerance is exceeded", beyond);
            }
        }
        if let Some(&next) = grid.serves.get(k + 1)
            && next != index
            && let Join::Within(radius) = course.joins[index]
        {
            let beyond = (end.position - leg.end).norm() - radius;
            if beyond > OUTSIDE {
                return refuse(index, "the corner at its end is missed", beyond);
            }
        }
    }
    Ok(())
}
