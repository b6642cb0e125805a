//! Simulates a motion of tool poses behind the drives of the axes of a machine.
//!
//! Source: section 5.4. Axes are simulated in joint space; forward kinematics gives the tool tip and the tool orientation,
//! which are compared with the planned poses and with the programmed legs. Not here: straight axes, see
//! [`Simulator`](crate::Simulator).

use crate::axes::{Axes, DrivenAxis};
use crate::error::{DriveError, SimulationError};
use crate::foot::Foot;
use crate::outcome::{ErrorFigure, Outcome, PoseOutcome};
use crate::refine::Refiner;
use crate::serving::Serving;
use crate::simulator::{SETTLING, SimulationSettings};
use crate::zero_phase::Shapers;
use toolglide_kinematics::{
    AxisVector, MAX_AXES, MachineKinematics, MoveRange, PoseLeg, ToolPose, Vector,
};
use toolglide_verify::PoseCourse;

/// A set-point at the servo period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseSetPoint {
    /// Axis positions, mm and rad.
    pub axes: AxisVector,
    /// The pose that they give.
    pub pose: ToolPose,
    /// The legs that the plan follows there.
    pub serves: MoveRange,
}

/// One instant of a simulation of poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseInstant {
    /// Time, s.
    pub time: f64,
    /// Planned pose.
    pub planned: ToolPose,
    /// Pose of the simulated axes.
    pub actual: ToolPose,
    /// Distance of the tool tip from the planned motion, mm.
    pub servo_tip: f64,
    /// Angle of the tool from the planned motion, rad.
    pub servo_orientation: f64,
    /// Distance of the tool tip from the program, mm.
    pub part_tip: f64,
    /// Angle of the tool from the program, rad; `None` where no leg says along which great circle it turns.
    pub part_orientation: Option<f64>,
    /// Program line.
    pub line: u32,
    /// Axis that reversed shortly before, if any.
    pub reversing: Option<char>,
    /// Whether the motion is still under way.
    pub moving: bool,
}

/// Runs a planned motion of poses through the drives of a machine.
///
/// Legs are expected in path order, set-points are taken one servo period apart.
pub struct PoseSimulator<'m> {
    machine: &'m dyn MachineKinematics,
    axes: Axes,
    refiner: Refiner<MAX_AXES>,
    shapers: Shapers<MAX_AXES>,
    tip: Foot<3>,
    tool: Foot<3>,
    course: PoseCourse,
    serving: Serving,
    count: usize,
    ahead: u64,
    lag: u64,
    lead: u64,
    given: u64,
    now: u64,
    ticks: Option<u64>,
    last: Option<PoseSetPoint>,
    servo: [ErrorFigure; 2],
    part: [ErrorFigure; 2],
}

impl std::fmt::Debug for PoseSimulator<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PoseSimulator")
            .field("given", &self.given)
            .field("servo", &self.servo)
            .finish_non_exhaustive()
    }
}

impl<'m> PoseSimulator<'m> {
    /// Drives at rest at axis positions, one per axis in machine order.
    ///
    /// # Errors
    /// As [`Simulator::new`](crate::Simulator::new).
    pub fn new(
        machine: &'m dyn MachineKinematics,
        axes: &[DrivenAxis],
        start: &AxisVector,
        settings: SimulationSettings,
    ) -> Result<Self, SimulationError> {
        let count = machine.axes().len();
        if axes.len() != count {
            return Err(DriveError::new("axis", axes.len(), format!("{count} axes")).into());
        }
        let running = Axes::new(axes, start, settings.window)?;
        let (lag, lead) = Axes::windows(axes);
        let refiner = Refiner::new(settings.interpolation, settings.period, running.period)?;
        let shapers = Shapers::new(axes, start);
        let ahead = lead.max(3 * refiner.ratio() + shapers.preview());
        let kept = usize::try_from(lag + ahead).unwrap_or(usize::MAX);
        Ok(Self {
            machine,
            axes: running,
            refiner: refiner.with_room(ahead),
            shapers,
            tip: Foot::new(lag, ahead),
            tool: Foot::new(lag, ahead),
            course: PoseCourse::new(),
            serving: Serving::new(lag, kept),
            count,
            ahead,
            lag,
            lead,
            given: 0,
            now: 0,
            ticks: None,
            last: None,
            servo: [ErrorFigure::default(); 2],
            part: [ErrorFigure::default(); 2],
        })
    }

    /// Period at which set-points are taken, s.
    #[must_use]
    pub fn servo_period(&self) -> f64 {
        self.axes.period
    }

    /// Takes the next leg of the path.
    pub fn expect(&mut self, leg: PoseLeg) {
        self.course.expect(leg);
    }

    /// Takes the next set-point; `see` is shown every instant that can be simulated then.
    ///
    /// # Errors
    /// [`SimulationError`] where a drive diverges, a set-point is no finite number, or the machine cannot be where its axes
    /// are.
    pub fn observe(
        &mut self,
        point: &PoseSetPoint,
        see: &mut impl FnMut(&PoseInstant),
    ) -> Result<(), SimulationError> {
        self.give(point);
        while self.now + self.ahead < self.given {
            self.step(see)?;
        }
        Ok(())
    }

    /// Ends the motion after `cycle_time`, s, watches it settle, and gives the figures.
    ///
    /// # Errors
    /// As [`PoseSimulator::observe`].
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "settling takes few ticks"
    )]
    pub fn finish(
        mut self,
        cycle_time: f64,
        see: &mut impl FnMut(&PoseInstant),
    ) -> Result<PoseOutcome, SimulationError> {
        let ticks = self.given;
        self.ticks = Some(ticks);
        let period = self.axes.period;
        let settling = (SETTLING / period).ceil() as u64;
        if let Some(last) = self.last {
            while self.now < ticks + settling {
                self.give(&last);
                while self.now + self.ahead < self.given {
                    self.step(see)?;
                }
            }
        }
        let settled = self.axes.settled();
        let since = self.now as f64 * period - cycle_time;
        Ok(PoseOutcome {
            tip: Outcome {
                cycle_time,
                servo: self.servo[0],
                part: self.part[0],
                settling: (settled < self.now)
                    .then(|| (settled as f64 * period - cycle_time).max(0.0)),
                axes: self.axes.outcomes(),
                modes: self.axes.mode_outcomes(since),
            },
            servo_orientation: self.servo[1],
            part_orientation: self.part[1],
        })
    }

    fn give(&mut self, point: &PoseSetPoint) {
        self.tip.give(point.pose.tip());
        self.tool.give(point.pose.orientation());
        self.serving.serve(self.given, point.serves);
        if self.given.is_multiple_of(self.refiner.ratio()) {
            let mut positions = [0.0; MAX_AXES];
            for (position, axis) in positions.iter_mut().zip(point.axes.iter()) {
                *position = *axis;
            }
            self.refiner.give(positions);
        }
        self.given += 1;
        self.last = Some(*point);
    }

    #[allow(clippy::cast_precision_loss, reason = "fewer than 2^53 ticks")]
    fn step(&mut self, see: &mut impl FnMut(&PoseInstant)) -> Result<(), SimulationError> {
        let now = self.now;
        let time = now as f64 * self.axes.period;
        let moving = self.ticks.is_none_or(|ticks| now < ticks);
        let actual = self.pose(time)?;
        let servo_tip = self.tip.offset(now, self.lead, &actual.tip()).norm();
        // The chord of a unit sphere: twice the sine of half the angle.
        let chord = self
            .tool
            .offset(now, self.lead, &actual.orientation())
            .norm();
        let servo_orientation = 2.0 * (0.5 * chord).min(1.0).asin();
        let serves = self.serving.around(now, self.lead);
        self.course.forget_before(serves.first);
        let last = serves.last.saturating_add(1);
        let foot = self.course.nearest(&actual, serves.first, last);
        let line = foot.map_or(0, |foot| foot.place.line);
        if moving {
            self.servo[0].add(servo_tip, time, line);
            self.servo[1].add(servo_orientation, time, line);
            if let Some(foot) = &foot {
                self.part[0].add_within(foot.tip, foot.tip_tolerance, time, line);
                if let Some(angle) = foot.orientation {
                    self.part[1].add_within(angle, foot.orientation_tolerance, time, line);
                }
            }
        }
        let planned =
            ToolPose::new(self.tip.planned(now), self.tool.planned(now)).unwrap_or(actual);
        see(&PoseInstant {
            time,
            planned,
            actual,
            servo_tip,
            servo_orientation,
            part_tip: foot.map_or(0.0, |foot| foot.tip),
            part_orientation: foot.and_then(|foot| foot.orientation),
            line,
            reversing: self.axes.reversing(self.lag),
            moving,
        });
        let refiner = &self.refiner;
        let set_points = refiner.at(now);
        let shaped = self.shapers.shape(now, set_points, |tick| refiner.at(tick));
        self.axes.tick(
            &set_points[..self.count],
            &shaped[..self.count],
            now,
            time,
            moving,
            self.lag,
        )?;
        self.now += 1;
        Ok(())
    }

    /// The pose of the simulated axes, with what the modes add to the tool tip.
    fn pose(&self, time: f64) -> Result<ToolPose, SimulationError> {
        let mut positions = AxisVector::zeros(self.count);
        for (index, position) in positions.iter_mut().enumerate() {
            *position = self.axes.table(index);
        }
        let pose = self
            .machine
            .forward(&positions)
            .map_err(|reason| SimulationError::Machine { time, reason })?;
        Ok(pose.moved_by(Vector::<3>::from(self.axes.at_tool())))
    }
}
