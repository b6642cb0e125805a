//! The judge of set-points of axes against a path of poses.
//!
//! Source: forward kinematics of every row; divided differences for the limits, of which rounding takes
//! its part, so that what is reported is certain. The axes are judged in `axes`, the tool in `course`. Not
//! here: motion between the rows, and stops inside the path.

mod axes;
mod course;

use super::report::{AxisPeaks, PoseReport, PoseViolation};
use super::{FOUND_SLACK, MEETING_SLACK};
use crate::axis_vector::AxisVector;
use crate::great_circle::angle_between;
use crate::machine::{Axis, MachineKinematics};
use crate::pose::ToolPose;
use crate::pose_leg::{PoseLeg, PosePath};
use crate::verify::VerifyError;
use crate::verify::report::{Peak, Place};
use std::collections::VecDeque;

/// How far from the machine's zero a tip may be beyond its own distance, for rounding of angles, mm.
const LEVER: f64 = 500.0;

/// A leg and how near its end was passed.
struct Expected {
    leg: PoseLeg,
    place: Place,
    tip: f64,
    orientation: f64,
}

/// Judges set-points of the axes of a machine row by row.
pub struct PoseSetPointJudge<'m> {
    machine: &'m dyn MachineKinematics,
    axes: Vec<Axis>,
    rounding: Vec<f64>,
    legs: Vec<Expected>,
    current: usize,
    rows: VecDeque<(f64, AxisVector)>,
    last: Option<ToolPose>,
    before_last: Option<ToolPose>,
    start: f64,
    report: PoseReport,
}

impl std::fmt::Debug for PoseSetPointJudge<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PoseSetPointJudge")
            .field("current", &self.current)
            .field("report", &self.report)
            .finish_non_exhaustive()
    }
}

impl<'m> PoseSetPointJudge<'m> {
    /// A judge for a machine with the limits of `axes`, whose set-points are rounded by at most
    /// `rounding`, one per axis, mm and rad.
    #[must_use]
    pub fn new(machine: &'m dyn MachineKinematics, axes: Vec<Axis>, rounding: &[f64]) -> Self {
        let peaks = axes
            .iter()
            .map(|axis| AxisPeaks {
                name: axis.name,
                velocity: Peak::default(),
                acceleration: Peak::default(),
                jerk: Peak::default(),
                lowest: f64::INFINITY,
                highest: f64::NEG_INFINITY,
            })
            .collect();
        Self {
            machine,
            axes,
            rounding: rounding.to_vec(),
            legs: Vec::new(),
            current: 0,
            rows: VecDeque::with_capacity(4),
            last: None,
            before_last: None,
            start: 0.0,
            report: PoseReport::new(peaks),
        }
    }

    /// Takes the next leg of the path; all of them before the first row.
    pub fn expect(&mut self, leg: &PoseLeg) {
        self.report.path_length += leg.length();
        self.report.path_angle += leg.angle();
        let mv = u32::try_from(self.legs.len()).unwrap_or(u32::MAX);
        self.legs.push(Expected {
            leg: leg.clone(),
            place: Place { mv, line: leg.line },
            tip: f64::INFINITY,
            orientation: f64::INFINITY,
        });
    }

    /// Judges the next row.
    ///
    /// # Errors
    /// [`VerifyError::Time`] for a time that does not come after the one before.
    pub fn observe(&mut self, time: f64, at: &AxisVector) -> Result<(), VerifyError> {
        if let Some((before, _)) = self.rows.back() {
            if !(time > *before && time.is_finite()) {
                return Err(VerifyError::Time {
                    index: self.report.observed,
                    time,
                    before: *before,
                });
            }
        } else {
            self.start = time;
        }
        self.report.observed += 1;
        self.report.cycle_time = time - self.start;
        let place = self.place();
        if self.rows.len() == 4 {
            self.rows.pop_front();
        }
        self.rows.push_back((time, *at));
        self.judge_axes(place);
        match self.machine.forward(at) {
            Ok(pose) => self.judge_pose(time, &pose, at),
            Err(reason) => self.report.add(PoseViolation::Unreachable {
                reason: reason.to_string(),
                time,
                place,
            }),
        }
        Ok(())
    }

    /// The report, once all rows were seen.
    #[must_use]
    pub fn finish(mut self) -> PoseReport {
        self.report.moves = u32::try_from(self.legs.len()).unwrap_or(u32::MAX);
        if let (Some(pose), Some(last)) = (self.last, self.legs.last())
            && let PosePath::Tool { tip, turn } = &last.leg.path
        {
            let slack = self.slack(&pose);
            let there = (pose.tip() - tip[1]).norm() <= slack.0 + MEETING_SLACK
                && angle_between(&pose.orientation(), &turn.end()) <= slack.1 + MEETING_SLACK;
            if !there {
                let place = last.place;
                self.report.add(PoseViolation::StopNotMade { place });
            }
        }
        let legs = std::mem::take(&mut self.legs);
        for (index, expected) in legs.iter().enumerate() {
            if !matches!(expected.leg.path, PosePath::Tool { .. }) {
                continue;
            }
            let next = legs.get(index + 1).unwrap_or(expected);
            self.close_corner(expected, &next.leg);
        }
        self.report
    }

    /// Says how near the end of a leg was passed, and whether it was near enough for it and the leg behind.
    fn close_corner(&mut self, expected: &Expected, next: &PoseLeg) {
        let (leg, place) = (&expected.leg, expected.place);
        let tip = leg.tip_tolerance.length().min(next.tip_tolerance.length());
        let turn = leg
            .orientation_tolerance
            .angle()
            .min(next.orientation_tolerance.angle());
        let peak = |value: f64| Peak {
            value,
            time: 0.0,
            place,
        };
        if expected.tip / tip > self.report.tip_corner_ratio.value {
            self.report.tip_corner_ratio = peak(expected.tip / tip);
            self.report.tip_corner = peak(expected.tip);
        }
        if expected.orientation / turn > self.report.orientation_corner_ratio.value {
            self.report.orientation_corner_ratio = peak(expected.orientation / turn);
            self.report.orientation_corner = peak(expected.orientation);
        }
        if expected.tip > tip * (1.0 + FOUND_SLACK) {
            self.report.add(PoseViolation::TipCorner {
                value: expected.tip,
                tolerance: tip,
                place,
            });
        }
        if expected.orientation > turn * (1.0 + FOUND_SLACK) {
            self.report.add(PoseViolation::OrientationCorner {
                value: expected.orientation,
                tolerance: turn,
                place,
            });
        }
    }

    fn place(&self) -> Place {
        self.legs
            .get(self.current)
            .map_or(Place::default(), |expected| expected.place)
    }

    /// What rounding of the axes may do to the tip and to the orientation.
    fn slack(&self, pose: &ToolPose) -> (f64, f64) {
        let rounding = self
            .rounding
            .iter()
            .fold(0.0, |most: f64, one| most.max(*one));
        let angle = 3.0 * rounding;
        (angle * (1.0 + pose.tip().norm() + LEVER), angle)
    }
}
