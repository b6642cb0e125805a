//! Judges anyone's set-points.
//!
//! Between two points the motion is unknown, so only what is certain counts: the points themselves
//! for the distance from the path, mean derivatives for the limits, and for corners and stops the
//! chord with as much room as the limits give the motion. A legal motion never breaks anything, however its
//! points are spaced and rounded; where they are too far apart to show that, they are called so.
//!
//! Source: the judge of pieces, weakened where points say less. Not here: where along the path they
//! are.

pub(crate) mod differences;
pub(crate) mod spacing;

use thiserror::Error;

use crate::path::chord::Chord;
use crate::path::leg::{is_measurable, length_slack};
use crate::path::route::Route;
use crate::pieces::dynamics::{Quantity, note, note_feedrate};
use crate::pieces::tracker::{Finest, Tracker};
use crate::report::{Place, Report};
use crate::violation::{LETTERS, Violation};
use differences::Recent;
use spacing::{Unseen, is_fine, unseen_limits};
use toolglide_kinematics::Limits;
use toolglide_kinematics::ToolpathError;
use toolglide_kinematics::Vector;
use toolglide_kinematics::numeric::{LARGEST_MAGNITUDE, LIMIT_SLACK};
use toolglide_kinematics::{Move, Toolpath};

/// Why set-points cannot be judged.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum VerifyError {
    /// Time must go forward.
    #[error("set-point {index}: time is {time} s, but must be after {before} s")]
    Time {
        /// The set-point, counted from 0.
        index: u64,
        /// Its time.
        time: f64,
        /// Time of the one before.
        before: f64,
    },
    /// A time or a position is not a finite number, or larger than any machine.
    #[error("set-point {index}: not a finite number")]
    NotFinite {
        /// The set-point, counted from 0.
        index: u64,
    },
    /// The first set-point must be the start of the path.
    #[error("set-point 0: it is {distance} mm from the start of the path")]
    NotAtStart {
        /// The distance.
        distance: f64,
    },
    /// The resolution must be a length.
    #[error("resolution is {value} mm, but must be finite and not negative")]
    Resolution {
        /// What was given.
        value: f64,
    },
}

/// Judges set-points one by one, not necessarily at equal times.
///
/// Moves are expected in path order and ahead of the motion: all that the motion may pass before
/// the next set-point, and [`LOOK_AHEAD_MOVES`](toolglide_kinematics::numeric::LOOK_AHEAD_MOVES) more to find a
/// motion again that has left its path. Those left behind are forgotten.
#[derive(Clone, Debug)]
pub struct SetPointJudge<const N: usize> {
    limits: Limits<N>,
    route: Route<N>,
    report: Report<N>,
    tracker: Tracker,
    recent: Recent<N>,
    start: Vector<N>,
    resolution: f64,
    first_time: f64,
    starts_moving: bool,
}

impl<const N: usize> SetPointJudge<N> {
    /// A judge of a motion from rest at `start`. The `resolution` is what rounding may have
    /// changed in a coordinate, mm: half a unit in the last decimal, 0 for numbers that were
    /// written in full.
    #[must_use]
    pub fn new(start: Vector<N>, limits: Limits<N>, resolution: f64) -> Self {
        Self {
            limits,
            route: Route::new(start),
            report: Report::new(),
            tracker: Tracker::default(),
            recent: Recent::new(&limits, resolution),
            start,
            resolution,
            first_time: 0.0,
            starts_moving: false,
        }
    }

    /// Takes the next move of the path.
    ///
    /// # Errors
    /// [`ToolpathError`] when it does not connect; the path stays as it was.
    pub fn expect(&mut self, next: &Move<N>) -> Result<(), ToolpathError> {
        self.route.expect(next)
    }

    /// The newest move that the motion may be on, counted from 0.
    #[must_use]
    pub fn reached(&self) -> u32 {
        self.tracker.reached()
    }

    /// Judges the next set-point.
    ///
    /// # Errors
    /// [`VerifyError`] for a time that is not after the one before, a number that is not finite, a
    /// first point that is not the start, and a resolution that is no length. The point is not
    /// taken then.
    pub fn observe(&mut self, time: f64, position: Vector<N>) -> Result<(), VerifyError> {
        self.check(time, &position)?;
        if self.report.observed == 0 {
            self.first_time = time;
        }
        self.report.observed += 1;
        self.recent.push(time, position);
        let Some(chord) = Chord::newest(&self.recent, &self.limits, self.first_time) else {
            return Ok(());
        };
        self.tracker
            .follow(&mut self.route, &mut self.report, &chord);
        let place = self.place();
        self.judge_derivatives(place);
        self.judge_speed(place);
        if !is_fine(chord.duration) {
            self.judge_spacing(&chord, place);
        }
        self.tracker.settle(&self.route, &chord);
        self.judge_start();
        Ok(())
    }

    /// Whether the two newest points are near enough to each other.
    fn judge_spacing(&mut self, chord: &Chord<N>, place: Place) {
        let Finest { path, stop } = self.tracker.finest;
        let hardest = self.limits.acceleration();
        let leaves = (chord.sagitta > path * (1.0 + LIMIT_SLACK)).then(|| {
            let (hidden, tolerance) = (chord.sagitta, path);
            let needed = (8.0 * tolerance / hardest.norm()).sqrt();
            (Unseen::Path { hidden, tolerance }, needed)
        });
        let passes = (chord.rest_reach > stop * (1.0 + LIMIT_SLACK)).then(|| {
            let (hidden, tolerance) = (chord.rest_reach, stop);
            let needed = (2.0 * tolerance / hardest.amax()).sqrt();
            (Unseen::Stop { hidden, tolerance }, needed)
        });
        let limits = (0..N).filter_map(|axis| {
            let letter = LETTERS.get(axis).copied().unwrap_or('?');
            Some((letter, self.limits.axis(axis)?))
        });
        let duration = chord.duration;
        let unseen = limits.flat_map(|(letter, limits)| unseen_limits(letter, limits, duration));
        let unseen = unseen.chain(leaves).chain(passes);
        self.report.gaps.add(chord.begin, duration, place, unseen);
    }

    /// The report, once the motion is over.
    ///
    /// The motion must have ended at rest at the end of the path.
    #[must_use]
    pub fn finish(mut self) -> Report<N> {
        let moves = self.route.len();
        let points = self.recent.points();
        let (end_time, position) = *points.first().unwrap_or(&(self.first_time, self.start));
        let time = end_time - self.first_time;
        let rounding = self.recent.rounding(end_time, &position);
        let moving = moving_axis(&self.recent, &self.limits, 0, points.len());
        let place = match moves.checked_sub(1).and_then(|last| self.route.get(last)) {
            Some(leg) => leg.place,
            None => Place::default(),
        };
        self.tracker.finish(&mut self.route, &mut self.report, time);
        let distance = ((position - self.route.end()).norm() - rounding.norm()).max(0.0);
        if distance > length_slack(self.route.end().amax()) {
            self.report.add(Violation::EndsElsewhere {
                distance,
                time,
                place,
            });
        }
        if let Some(axis) = moving {
            self.report.add(Violation::EndsMoving { axis, time, place });
        }
        self.report.cycle_time = time;
        self.report.path_length = self.route.length;
        self.report.moves = moves;
        self.report
    }

    fn check(&self, time: f64, position: &Vector<N>) -> Result<(), VerifyError> {
        let index = self.report.observed;
        let value = self.resolution;
        if !(value >= 0.0 && value.is_finite()) {
            return Err(VerifyError::Resolution { value });
        }
        if !(time.abs() <= LARGEST_MAGNITUDE && is_measurable(position)) {
            return Err(VerifyError::NotFinite { index });
        }
        match self.recent.points().first() {
            Some((before, _)) if time <= *before => Err(VerifyError::Time {
                index,
                time,
                before: *before,
            }),
            Some(_) => Ok(()),
            None => {
                let distance = (position - self.start).norm();
                let rounding = self.recent.rounding(time, position).norm();
                if distance <= length_slack(self.start.amax()) + rounding {
                    Ok(())
                } else {
                    Err(VerifyError::NotAtStart { distance })
                }
            }
        }
    }

    fn place(&self) -> Place {
        self.route
            .get(self.tracker.near)
            .map_or_else(Place::default, |leg| leg.place)
    }

    fn judge_derivatives(&mut self, place: Place) {
        for (order, quantity) in [
            (1, Quantity::Velocity),
            (2, Quantity::Acceleration),
            (3, Quantity::Jerk),
        ] {
            let Some(mean) = self.recent.mean(order) else {
                return;
            };
            let time = mean.time - self.first_time;
            for axis in 0..N {
                let found = (mean.certain(axis), time);
                note(&mut self.report, quantity, axis, found, &self.limits, place);
            }
        }
    }

    /// The mean velocity is nowhere above the largest speed.
    fn judge_speed(&mut self, place: Place) {
        let Some(mean) = self.recent.mean(1) else {
            return;
        };
        let time = mean.time - self.first_time;
        let speed = (mean.value.norm() - mean.noise.norm()).max(0.0);
        self.report.peak_speed.raise(speed, time, place);
        let feedrate = self.tracker.feedrate(&self.route);
        if feedrate > 0.0 && speed > feedrate {
            note_feedrate(&mut self.report, speed, feedrate, time, place);
        }
    }

    /// A motion from rest cannot be far yet.
    fn judge_start(&mut self) {
        let count = self.recent.points().len();
        let index = usize::try_from(self.report.observed).unwrap_or(usize::MAX);
        if self.starts_moving || index > count || count < 2 {
            return;
        }
        if let Some(axis) = moving_axis(&self.recent, &self.limits, count - 1, count) {
            self.starts_moving = true;
            self.report.add(Violation::StartsMoving { axis });
        }
    }
}

/// The first axis that is too far from one of the recent points to rest there.
fn moving_axis<const N: usize>(
    recent: &Recent<N>,
    limits: &Limits<N>,
    rest: usize,
    count: usize,
) -> Option<usize> {
    let points = recent.points();
    let (time, position) = points.get(rest)?;
    let (_, others) = (rest, points.get(..count)?);
    (0..N).find(|&axis| {
        others.iter().any(|(other_time, other)| {
            let span = (time - other_time).abs();
            let (v, a, j) = (
                limits.velocity()[axis],
                limits.acceleration()[axis],
                limits.jerk()[axis],
            );
            let reach = v.min((0.5 * a).min(j * span / 6.0) * span) * span;
            let rounding =
                recent.rounding(*time, position)[axis] + recent.rounding(*other_time, other)[axis];
            (position[axis] - other[axis]).abs() > reach * (1.0 + LIMIT_SLACK) + rounding
        })
    })
}

/// Judges set-points (time in s, position) against the path that they should follow.
///
/// # Errors
/// As [`SetPointJudge::observe`].
///
/// # Examples
/// ```
/// use toolglide_verify::verify_set_points;
/// use toolglide_kinematics::{Feedrate, Limits, Tolerance, Toolpath, Vector};
/// let ends = [Vector::<2>::zeros(), Vector::<2>::new(10.0, 0.0)];
/// let path = Toolpath::from_points(&ends, Feedrate::new(100.0)?, Tolerance::new(0.01)?)?;
/// let limits = Limits::uniform(500.0, 2_000.0, 5e4)?;
/// let leap = [(0.0, ends[0]), (0.001, ends[1])];
/// assert!(!verify_set_points(leap, &path, &limits, 0.0)?.passes());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn verify_set_points<const N: usize>(
    points: impl IntoIterator<Item = (f64, Vector<N>)>,
    path: &Toolpath<N>,
    limits: &Limits<N>,
    resolution: f64,
) -> Result<Report<N>, VerifyError> {
    let mut judge = SetPointJudge::new(path.start(), *limits, resolution);
    for next in path.moves() {
        // A toolpath has checked its moves already.
        let _ = judge.expect(next);
    }
    for (time, position) in points {
        judge.observe(time, position)?;
    }
    Ok(judge.finish())
}
