//! Judges planned pieces one after the other in bounded memory.
//!
//! Source: the meaning of [`toolglide_kinematics::Tolerance`], and the limits of section 2.2 at every instant. Not
//! here: any formula of any planner, and the record of corners and stops.

use crate::path::bernstein::Cubic;
use crate::path::deviation;
use crate::path::leg::length_slack;
use crate::path::route::Route;
use crate::pieces::dynamics::{Stretch, judge_continuity, judge_limits, judge_speed, moving_axis};
use crate::pieces::move_progress::Record;
use crate::quality::Quality;
use crate::report::{Place, Report};
use crate::violation::Violation;
use toolglide_kinematics::AxisModes;
use toolglide_kinematics::Limits;
use toolglide_kinematics::Move;
use toolglide_kinematics::PathSide;
use toolglide_kinematics::Sample;
use toolglide_kinematics::ToolpathError;
use toolglide_kinematics::Vector;
use toolglide_kinematics::{MoveRange, Piece};

/// Room granted to an overshoot, mm: a nanometre.
const OVERSHOOT_SLACK: f64 = 1e-6;

/// What may be left of a mode that was promised to rest, as a share of what full acceleration bends at rest.
const LEFT: f64 = 1e-2;

/// Judges a motion piece by piece while it is planned.
///
/// Moves are expected in path order, any number ahead of the motion; those that the motion has gone
/// past are forgotten. A piece is compared with the moves that it says it serves, which must go
/// forward and leave none out.
///
/// # Examples
/// ```
/// use toolglide_verify::Judge;
/// use toolglide_kinematics::{Feedrate, Limits, Move, Tolerance, Vector};
/// let limits = Limits::<2>::uniform(500.0, 2_000.0, 5e4)?;
/// let mut judge = Judge::new(Vector::<2>::zeros(), limits);
/// judge.expect(&Move::line_to(
///     Vector::<2>::new(10.0, 0.0), Feedrate::new(100.0)?, Tolerance::new(0.01)?)?)?;
/// let report = judge.finish();
/// assert!(!report.passes(), "no motion came at all");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Judge<const N: usize> {
    limits: Limits<N>,
    route: Route<N>,
    record: Record,
    report: Report<N>,
    state: Sample<N>,
    /// How long the piece before lasted.
    lasted: f64,
    time: f64,
    /// What the sum of durations has lost to rounding.
    compensation: f64,
    claimed: Option<MoveRange>,
    /// Largest distance of the last piece from the path and share of the tolerance, where each piece is measured.
    measured: Option<[f64; 2]>,
    quality: Quality<N>,
    /// What may be left of a mode at a rest, as a share of what full acceleration bends; none where nothing was
    /// promised.
    silence: Option<f64>,
    /// How far the motion may go beyond the side that is kept, mm.
    overshoot: f64,
}

impl<const N: usize> Judge<N> {
    /// A judge of motion from rest at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, limits: Limits<N>) -> Self {
        Self {
            limits,
            route: Route::new(start),
            record: Record::default(),
            report: Report::new(),
            state: Sample::at_rest(start),
            lasted: f64::INFINITY,
            time: 0.0,
            compensation: 0.0,
            claimed: None,
            measured: None,
            quality: Quality::new(&limits),
            silence: None,
            overshoot: f64::INFINITY,
        }
    }

    /// Measures the deviation of each piece, see [`Judge::last_deviation`]; without it only larger ones than any
    /// before are looked for, which is several times faster.
    #[must_use]
    pub fn measuring_each(mut self) -> Self {
        self.measured = Some([0.0; 2]);
        self
    }

    /// Largest distance of the piece observed last from the path, mm, and its largest share of the tolerance
    /// there; `None` unless each piece is measured.
    #[must_use]
    pub fn last_deviation(&self) -> Option<[f64; 2]> {
        self.measured
    }

    /// The same, holding the motion to a side of straight lines, with so much overshoot allowed, mm.
    #[must_use]
    pub fn with_side(mut self, side: PathSide, overshoot: f64) -> Self {
        self.quality.set_side(side);
        self.overshoot = overshoot;
        self
    }

    /// The same, measuring acceleration above another frequency, Hz.
    #[must_use]
    pub fn with_high_pass(mut self, frequency: f64) -> Self {
        self.quality.set_frequency(frequency);
        self
    }

    /// The same, following modes of vibration; `silent` says that they must rest wherever the motion rests.
    #[must_use]
    pub fn with_modes(mut self, modes: &AxisModes, silent: bool) -> Self {
        self.quality.set_modes(modes, &self.limits);
        self.silence = silent.then_some(LEFT);
        self
    }

    /// Takes the next move of the path.
    ///
    /// # Errors
    /// [`ToolpathError`] when it does not connect; the path stays as it was.
    pub fn expect(&mut self, next: &Move<N>) -> Result<(), ToolpathError> {
        self.route.expect(next)
    }

    /// Judges the next piece of the motion. The moves that it serves have been expected before.
    pub fn observe(&mut self, piece: &Piece<N>) {
        let stretch = Stretch::new(piece, self.time);
        let (first, last) = self.claim(piece.serves());
        let place = self.place(first);
        self.report.observed += 1;
        let curve = Cubic::of(&stretch.start, piece);
        if !(stretch.is_motion() && curve.is_measurable()) {
            let time = self.time;
            self.report.add(Violation::NotFinite { time, place });
            return;
        }
        if self.report.observed == 1 {
            self.judge_start(&stretch.start);
            self.state = stretch.start;
        }
        // Near zero at the end of a long move a position still has the rounding of its start.
        let slacks = self.route.range(first, last).map(|leg| leg.slack);
        let room = slacks.fold(0.0, f64::max);
        let before = &self.state;
        let known = (room, self.lasted);
        judge_continuity(
            &mut self.report,
            &self.limits,
            before,
            &stretch,
            known,
            place,
        );
        self.lasted = stretch.duration;
        judge_limits(&mut self.report, &self.limits, &stretch, place);
        let feedrates = self.route.range(first, last).map(|leg| leg.feedrate);
        let feedrate = feedrates.fold(0.0, f64::max);
        judge_speed(&mut self.report, &stretch, feedrate, place);
        if self.route.get(first).is_some() {
            self.judge_deviation(&stretch, &curve, first, last);
            self.record.pass(
                &mut self.route,
                &self.report,
                &self.limits,
                &stretch,
                &curve,
                (first, last),
            );
        }
        let rests = stretch.rests(&self.limits);
        self.quality
            .observe(&self.route, &stretch, (first, last), rests);
        let end = self.time + stretch.duration;
        if moving_axis(&stretch.end, &self.limits, end).is_none() {
            self.quality.rest();
        }
        self.advance(stretch.duration);
        self.state = Sample {
            position: stretch.stated_end,
            ..stretch.end
        };
    }

    /// How many moves the judge still holds: those ahead of the motion, and at most a few behind.
    #[must_use]
    pub fn moves_held(&self) -> u32 {
        self.route.len() - self.route.base()
    }

    /// The report, once the motion is over.
    ///
    /// The motion must have ended at rest at the end of the path.
    #[must_use]
    pub fn finish(mut self) -> Report<N> {
        let moves = self.route.len();
        let time = self.time;
        let served = self
            .claimed
            .map_or(0, |claimed| claimed.last.saturating_add(1));
        self.skip(served, moves);
        while self.route.base() < moves {
            self.record.close(&mut self.route, &mut self.report, time);
        }
        let place = Place {
            mv: moves.saturating_sub(1),
            line: self.record.last_line,
        };
        let distance = (self.state.position - self.route.end()).norm();
        if distance > length_slack(self.route.end().amax()) {
            self.report.add(Violation::EndsElsewhere {
                distance,
                time,
                place,
            });
        }
        if let Some(axis) = moving_axis(&self.state, &self.limits, time) {
            self.report.add(Violation::EndsMoving { axis, time, place });
        }
        self.report_smoothness(place);
        self.report.cycle_time = time;
        self.report.path_length = self.route.length;
        self.report.moves = moves;
        self.report
    }

    /// Reports how smooth the motion was, and modes that swing although they were promised to rest.
    fn report_smoothness(&mut self, place: Place) {
        let quality = std::mem::replace(&mut self.quality, Quality::new(&self.limits));
        let distance = quality.beyond();
        if distance > self.overshoot + OVERSHOOT_SLACK {
            self.report.add(Violation::Overshoots {
                distance,
                allowed: self.overshoot,
                time: self.time,
                place,
            });
        }
        let smoothness = quality.finish();
        for swing in &smoothness.modes {
            if let Some(share) = self.silence
                && swing.left > share * swing.bend
            {
                self.report.add(Violation::ModeSwings {
                    axis: swing.axis,
                    frequency: swing.mode.frequency(),
                    left: swing.left,
                    bound: share * swing.bend,
                    time: self.time,
                    place,
                });
            }
        }
        self.report.smoothness = Some(smoothness);
    }

    /// The moves to judge a piece by, once its claim has been checked; moves behind are closed.
    fn claim(&mut self, serves: MoveRange) -> (u32, u32) {
        let MoveRange { first, last } = serves;
        let known = self.route.len();
        let before = self.claimed;
        let next = before.map_or(0, |before| before.last.saturating_add(1));
        let backwards = before.is_some_and(|before| first < before.first || last < before.last);
        if first > last || last >= known || backwards {
            self.report.add(Violation::MovesOutOfOrder {
                first,
                last,
                time: self.time,
            });
        }
        let newest = known.saturating_sub(1);
        let earliest = before.map_or(0, |before| before.first);
        let first = first.clamp(earliest.min(newest), newest);
        let last = last.clamp(first.max(next.saturating_sub(1)).min(newest), newest);
        self.skip(next, first);
        self.claimed = Some(MoveRange { first, last });
        // The corner before the first move served, and moves of no length before it, still matter.
        let mut keep = first.saturating_sub(1);
        while keep > self.route.base() && self.route.get(keep).is_some_and(|leg| leg.is_empty()) {
            keep -= 1;
        }
        while self.route.base() < keep {
            self.record
                .close(&mut self.route, &mut self.report, self.time);
        }
        (first, last)
    }

    /// Reports moves that no piece serves, unless there is nothing to do on them.
    fn skip(&mut self, from: u32, to: u32) {
        for mv in from..to {
            if let Some(leg) = self.route.get(mv)
                && !leg.is_empty()
            {
                self.report.add(Violation::MoveSkipped {
                    time: self.time,
                    place: leg.place,
                });
            }
        }
    }

    fn place(&self, mv: u32) -> Place {
        self.route
            .get(mv)
            .map_or(Place { mv, line: 0 }, |leg| leg.place)
    }

    fn judge_start(&mut self, start: &Sample<N>) {
        let distance = (start.position - self.state.position).norm();
        if distance > length_slack(start.position.amax()) {
            self.report.add(Violation::StartsElsewhere { distance });
        }
        if let Some(axis) = moving_axis(start, &self.limits, 0.0) {
            self.report.add(Violation::StartsMoving { axis });
        }
    }

    fn judge_deviation(&mut self, stretch: &Stretch<N>, curve: &Cubic<N>, first: u32, last: u32) {
        let known = if self.measured.is_some() {
            [0.0; 2]
        } else {
            [
                self.report.deviation.value,
                self.report.deviation_ratio.value,
            ]
        };
        let found = deviation::largest(&self.route, curve, first, last, known);
        if let Some(measured) = &mut self.measured {
            *measured = found.bounds;
        }
        let [distance, share] = found.attained;
        let when = |at: f64| stretch.begin + at * stretch.duration;
        let place = self.place(distance.mv);
        self.report
            .deviation
            .raise(found.bounds[0], when(distance.at), place);
        let (time, place) = (when(share.at), self.place(share.mv));
        self.report
            .deviation_ratio
            .raise(found.bounds[1], time, place);
        if found.bounds[1] > 1.0
            && let Some(leg) = self.route.get(share.mv)
        {
            self.report.add(Violation::Deviation {
                value: found.bounds[1] * leg.allowed,
                tolerance: leg.tolerance,
                time,
                place,
            });
        }
    }

    fn advance(&mut self, duration: f64) {
        let step = duration - self.compensation;
        let sum = self.time + step;
        self.compensation = (sum - self.time) - step;
        self.time = sum;
    }
}
