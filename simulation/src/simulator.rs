//! Simulates a planned motion of straight axes behind its drives, piece by piece, in bounded memory.
//!
//! Source: errors as the dissertation measures them, to the planned motion (tables 2.1, 3.1 and 3.2) and to the programmed
//! path (figure 4.17). Not here: drives, see [`Drive`](crate::Drive), and tool poses, see
//! [`PoseSimulator`](crate::PoseSimulator).

use crate::axes::{Axes, DrivenAxis};
use crate::error::{DriveError, SimulationError};
use crate::foot::Foot;
use crate::outcome::{ErrorFigure, Outcome};
use crate::refine::{Interpolation, Refiner};
use crate::serving::Serving;
use crate::zero_phase::Shapers;
use toolglide_kinematics::{Move, MoveRange, Piece, SamplePeriod, Sampler, ToolpathError, Vector};
use toolglide_verify::{Course, CourseFoot};

/// Time that is watched after the end of a motion, s.
pub(crate) const SETTLING: f64 = 0.2;

/// Moves ahead among which set-points without a plan are looked for.
const MOVES_AHEAD: u32 = 8;

/// Modes whose displacement every instant shows.
pub const SHOWN_MODES: usize = 8;

/// How a motion is simulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulationSettings {
    /// Period of the set-points, s.
    pub period: f64,
    /// How they are refined to the servo period.
    pub interpolation: Interpolation,
    /// How near to its end an axis counts as settled, mm or rad.
    pub window: f64,
}

/// One instant of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant<const N: usize> {
    /// Time, s.
    pub time: f64,
    /// Planned position.
    pub planned: Vector<N>,
    /// Position of the tool.
    pub actual: Vector<N>,
    /// Offset of the tool from the planned motion.
    pub servo: Vector<N>,
    /// The nearest point of the programmed path.
    pub foot: Vector<N>,
    /// Distance from the programmed path, mm, positive to the left of travel in the plane of the first two axes.
    pub part: f64,
    /// Tolerance of the move that is nearest, mm.
    pub tolerance: f64,
    /// Its program line.
    pub line: u32,
    /// Commanded specific force of each axis.
    pub force: Vector<N>,
    /// Specific friction force of each axis.
    pub friction: Vector<N>,
    /// Displacement of the first modes relative to their drives, axis by axis; 0 beyond the last.
    pub modes: [f64; SHOWN_MODES],
    /// Axis that reversed shortly before, if any.
    pub reversing: Option<char>,
    /// Whether the motion is still under way.
    pub moving: bool,
}

/// Runs a planned motion through the drives of a machine.
///
/// Moves are expected in path order, any number ahead of the motion; pieces are observed in motion order. Memory is a window
/// of some hundred set-points and the moves within it. A tick allocates nothing.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Feedrate, Move, MoveRange, Piece, Sample, Tolerance, Vector};
/// use toolglide_simulation::{
///     DriveModel, DriveSettings, DrivenAxis, Interpolation, SimulationSettings, Simulator,
/// };
/// let model = DriveModel::new(&DriveSettings::textbook(35.0))?;
/// let axis = |name, place| DrivenAxis { name, model: model.clone(), coordinate: Some(place) };
/// let settings = SimulationSettings {
///     period: 1e-3,
///     interpolation: Interpolation::Cubic,
///     window: 0.002,
/// };
/// let start = Vector::<2>::zeros();
/// let mut simulator = Simulator::new(&[axis('X', 0), axis('Y', 1)], start, settings)?;
/// let end = Vector::<2>::new(10.0, 0.0);
/// simulator.expect(&Move::line_to(end, Feedrate::RAPID, Tolerance::new(0.1)?)?)?;
/// let mut state = Sample::at_rest(start);
/// state.velocity = end / 0.5;
/// simulator.observe(&Piece::new(&state, 0.5, end, MoveRange::one(0)))?;
/// let outcome = simulator.finish()?;
/// assert!(outcome.part.largest < 1.0, "one axis overshoots, but does not leave its line");
/// assert!(outcome.axes[0].tracking.largest > 0.03, "it starts with a jump of velocity");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Simulator<const N: usize> {
    axes: Axes,
    coordinates: [Option<usize>; N],
    course: Course<N>,
    serving: Serving,
    sampler: Sampler<N>,
    refiner: Refiner<N>,
    shapers: Shapers<N>,
    foot: Foot<N>,
    /// Ticks that the plan must be known ahead of the one that is simulated.
    ahead: u64,
    lag: u64,
    lead: u64,
    /// Set-points at the servo period that are known.
    given: u64,
    now: u64,
    /// Ticks of the motion, once it is over.
    ticks: Option<u64>,
    end: Vector<N>,
    /// The move that was nearest to the tool.
    guess: u32,
    /// The move that set-points without a plan are on.
    on: u32,
    servo: ErrorFigure,
    part: ErrorFigure,
}

impl<const N: usize> Simulator<N> {
    /// Drives at rest at the start of a path, one per axis in path order.
    ///
    /// # Errors
    /// [`SimulationError::Drive`] for another number of drives, and a servo period that does not divide the period of the
    /// set-points or differs among axes.
    pub fn new(
        axes: &[DrivenAxis],
        start: Vector<N>,
        settings: SimulationSettings,
    ) -> Result<Self, SimulationError> {
        if axes.len() != N {
            return Err(DriveError::new("axis", axes.len(), format!("{N} axes")).into());
        }
        let running = Axes::new(axes, start.as_slice(), settings.window)?;
        let (lag, lead) = Axes::windows(axes);
        let refiner = Refiner::new(settings.interpolation, settings.period, running.period)?;
        let shapers = Shapers::new(axes, start.as_slice());
        // The refiner looks at the set-point after the next but one.
        let ahead = lead.max(3 * refiner.ratio() + shapers.preview());
        let kept = usize::try_from(lag + ahead).unwrap_or(usize::MAX);
        let period = SamplePeriod::new(running.period).map_err(|_| {
            DriveError::new("servo_period_s", running.period, "positive and finite")
        })?;
        Ok(Self {
            coordinates: std::array::from_fn(|axis| axes[axis].coordinate),
            course: Course::new(start),
            serving: Serving::new(lag, kept),
            sampler: Sampler::new(period),
            refiner: refiner.with_room(ahead),
            shapers,
            foot: Foot::new(lag, ahead),
            ahead,
            lag,
            lead,
            given: 0,
            now: 0,
            ticks: None,
            end: start,
            guess: 0,
            on: 0,
            servo: ErrorFigure::default(),
            part: ErrorFigure::default(),
            axes: running,
        })
    }

    /// Takes the next move of the path.
    ///
    /// # Errors
    /// [`ToolpathError`] when it does not connect.
    pub fn expect(&mut self, next: &Move<N>) -> Result<(), ToolpathError> {
        self.course.expect(next)
    }

    /// Simulates the next piece of the motion, whose moves have been expected before.
    ///
    /// # Errors
    /// [`SimulationError`] where a drive diverges or a set-point is no finite number.
    pub fn observe(&mut self, piece: &Piece<N>) -> Result<(), SimulationError> {
        self.observe_with(piece, &mut |_| {})
    }

    /// As [`Simulator::observe`]; `see` is shown every instant of servo time.
    ///
    /// # Errors
    /// As [`Simulator::observe`].
    pub fn observe_with(
        &mut self,
        piece: &Piece<N>,
        see: &mut impl FnMut(&Instant<N>),
    ) -> Result<(), SimulationError> {
        self.sampler.feed(piece);
        self.end = piece.end();
        self.serving.serve(self.given, piece.serves());
        while let Some((_, planned)) = self.sampler.next_tick() {
            self.give(planned);
            self.advance(see)?;
        }
        Ok(())
    }

    /// As [`Simulator::observe_with`], for a piece of which nobody knows which moves it serves: set-points that others made.
    ///
    /// The motion goes forward along the moves that were expected: it is on a later move as soon as that is no farther away,
    /// and moves are skipped only where they are short beside their tolerance.
    ///
    /// # Errors
    /// As [`Simulator::observe`].
    pub fn observe_unplanned(
        &mut self,
        piece: &Piece<N>,
        see: &mut impl FnMut(&Instant<N>),
    ) -> Result<(), SimulationError> {
        let before = self.on;
        self.on = self.followed(&piece.end());
        let mut start = *piece;
        start = Piece::new(
            &start.at(0.0),
            start.duration(),
            start.end(),
            MoveRange {
                first: before,
                last: self.on,
            },
        );
        self.observe_with(&start, see)
    }

    /// The move that set-points without a plan are on, counted from 0.
    #[must_use]
    pub fn on(&self) -> u32 {
        self.on
    }

    /// The move that a point is on, when the point before was on `self.on`.
    fn followed(&self, point: &Vector<N>) -> u32 {
        let mut on = self.on;
        loop {
            let Some(here) = self.course.distance(on, point) else {
                return on;
            };
            let reach = 4.0 * self.course.tolerance(on).unwrap_or(0.0);
            let mut skipped = 0.0;
            let mut found = None;
            for ahead in 1..=MOVES_AHEAD {
                let Some(there) = self.course.distance(on + ahead, point) else {
                    break;
                };
                if there <= here + 1e-12 {
                    found = Some(on + ahead);
                    break;
                }
                skipped += self.course.length(on + ahead).unwrap_or(f64::INFINITY);
                if skipped > reach {
                    break;
                }
            }
            match found {
                Some(next) => on = next,
                None => return on,
            }
        }
    }

    /// Ends the motion, watches it settle, and gives the figures.
    ///
    /// # Errors
    /// As [`Simulator::observe`].
    pub fn finish(self) -> Result<Outcome, SimulationError> {
        self.finish_with(&mut |_| {})
    }

    /// As [`Simulator::finish`]; `see` is shown every instant of servo time.
    ///
    /// # Errors
    /// As [`Simulator::observe`].
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "settling takes few ticks"
    )]
    pub fn finish_with(
        mut self,
        see: &mut impl FnMut(&Instant<N>),
    ) -> Result<Outcome, SimulationError> {
        let ticks = self.given;
        self.ticks = Some(ticks);
        let period = self.axes.period;
        let settling = (SETTLING / period).ceil() as u64;
        while self.now < ticks + settling {
            self.give(self.end);
            self.advance(see)?;
        }
        let cycle_time = self.sampler.end_time();
        let settled = self.axes.settled();
        let since = self.now as f64 * period - cycle_time;
        Ok(Outcome {
            cycle_time,
            servo: self.servo,
            part: self.part,
            settling: (settled < self.now).then(|| (settled as f64 * period - cycle_time).max(0.0)),
            axes: self.axes.outcomes(),
            modes: self.axes.mode_outcomes(since),
        })
    }

    /// Takes the next set-point at the servo period.
    #[inline]
    fn give(&mut self, planned: Vector<N>) {
        self.foot.give(planned);
        if self.given.is_multiple_of(self.refiner.ratio()) {
            self.refiner.give(planned.into());
        }
        self.given += 1;
    }

    /// Simulates as far as the plan is known.
    #[inline]
    fn advance(&mut self, see: &mut impl FnMut(&Instant<N>)) -> Result<(), SimulationError> {
        while self.now + self.ahead < self.given {
            self.step(see)?;
        }
        Ok(())
    }

    #[inline]
    #[allow(clippy::cast_precision_loss, reason = "fewer than 2^53 ticks")]
    fn step(&mut self, see: &mut impl FnMut(&Instant<N>)) -> Result<(), SimulationError> {
        let now = self.now;
        let time = now as f64 * self.axes.period;
        let moving = self.ticks.is_none_or(|ticks| now < ticks);
        let actual = self.tool();
        let servo = self.foot.offset(now, self.lead, &actual);
        let serves = self.serving.around(now, self.lead);
        self.course.forget_before(serves.first);
        let last = serves.last.saturating_add(1);
        let foot = self.course.nearest(&actual, serves.first, last, self.guess);
        if let Some(foot) = &foot {
            self.guess = foot.place.mv;
        }
        if moving {
            let line = foot.map_or(0, |foot| foot.place.line);
            self.servo.add(servo.norm(), time, line);
            if let Some(foot) = &foot {
                self.part
                    .add_within(foot.distance, foot.tolerance, time, line);
            }
        }
        let refiner = &self.refiner;
        let set_points = refiner.at(now);
        let shaped = self.shapers.shape(now, set_points, |tick| refiner.at(tick));
        see(&self.instant(time, actual, servo, foot.as_ref(), moving));
        self.axes
            .tick(&set_points, &shaped, now, time, moving, self.lag)?;
        self.now += 1;
        Ok(())
    }

    /// Position of the tool.
    #[inline]
    fn tool(&self) -> Vector<N> {
        let shares = self.axes.at_tool();
        Vector::from_fn(|axis, _| {
            let moved = self.coordinates[axis].map_or(0.0, |place| shares[place]);
            self.axes.table(axis) + moved
        })
    }

    #[inline]
    fn instant(
        &self,
        time: f64,
        actual: Vector<N>,
        servo: Vector<N>,
        foot: Option<&CourseFoot<N>>,
        moving: bool,
    ) -> Instant<N> {
        let planned = self.foot.planned(self.now);
        Instant {
            time,
            planned,
            actual,
            servo,
            foot: foot.map_or(planned, |foot| foot.point),
            part: foot.map_or(0.0, |foot| signed(foot, &actual)),
            tolerance: foot.map_or(0.0, |foot| foot.tolerance),
            line: foot.map_or(0, |foot| foot.place.line),
            force: Vector::from_fn(|axis, _| self.axes.force(axis)),
            friction: Vector::from_fn(|axis, _| self.axes.friction(axis)),
            modes: self.axes.mode_displacements(),
            reversing: self.axes.reversing(self.lag),
            moving,
        }
    }
}

/// Distance from a path, positive to the left of travel in the plane of the first two axes.
fn signed<const N: usize>(foot: &CourseFoot<N>, actual: &Vector<N>) -> f64 {
    if N < 2 {
        return foot.distance;
    }
    let off = actual - foot.point;
    let side = foot.direction[0] * off[1] - foot.direction[1] * off[0];
    if side < 0.0 {
        -foot.distance
    } else {
        foot.distance
    }
}
