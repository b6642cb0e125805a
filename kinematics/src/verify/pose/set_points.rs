//! The judge of set-points of axes against a path of poses.
//!
//! Source: forward kinematics of every row; divided differences for the limits, of which rounding takes
//! its part, so that what is reported is certain. Not here: motion between the rows, and stops inside
//! the path.

use super::away::{from_arc, from_segment};
use super::course::from_straight;
use super::report::{AxisPeaks, AxisQuantity, PoseReport, PoseViolation};
use super::{FOUND_SLACK, MEETING_SLACK, STRAIGHT_SLACK};
use crate::axis_vector::AxisVector;
use crate::great_circle::angle_between;
use crate::machine::{Axis, KinematicsError, MachineKinematics};
use crate::pose::ToolPose;
use crate::pose_leg::{PoseLeg, PosePath};
use crate::verify::VerifyError;
use crate::verify::report::{Peak, Place};
use std::collections::VecDeque;

/// Legs ahead of the one being followed that a row may have come to.
const AHEAD: usize = 64;

/// Ends of legs ahead that a row may pass.
const ENDS_AHEAD: usize = 8;

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
            let tip = expected
                .leg
                .tip_tolerance
                .length()
                .min(next.leg.tip_tolerance.length());
            let turn = expected
                .leg
                .orientation_tolerance
                .angle()
                .min(next.leg.orientation_tolerance.angle());
            let place = expected.place;
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
        self.report
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

    /// How far tip and orientation may be from the chord between two rows: an eighth of the second
    /// difference, twice over because it changes.
    fn bulge(&self, pose: &ToolPose) -> [f64; 2] {
        let (Some(one), Some(two)) = (self.before_last, self.last) else {
            return [0.0; 2];
        };
        [
            0.25 * (one.tip() - two.tip() * 2.0 + pose.tip()).norm(),
            0.25 * (one.orientation() - two.orientation() * 2.0 + pose.orientation()).norm(),
        ]
    }

    fn judge_axes(&mut self, place: Place) {
        let rows = &self.rows;
        let newest = rows.len() - 1;
        let (time, at) = rows[newest];
        for (index, axis) in self.axes.iter().enumerate() {
            let rounding = self.rounding[index];
            if let Some((low, high)) = axis.travel
                && !(low - rounding..=high + rounding).contains(&at[index])
            {
                let reason = KinematicsError::Travel {
                    axis: axis.name,
                    kind: axis.kind,
                    position: at[index],
                    low,
                    high,
                };
                self.report.add(PoseViolation::Unreachable {
                    reason: reason.to_string(),
                    time,
                    place,
                });
            }
            let peaks = &mut self.report.axes[index];
            peaks.lowest = peaks.lowest.min(at[index]);
            peaks.highest = peaks.highest.max(at[index]);
            let limits = [
                axis.limits.velocity(),
                axis.limits.acceleration(),
                axis.limits.jerk(),
            ];
            let quantities = [
                AxisQuantity::Velocity,
                AxisQuantity::Acceleration,
                AxisQuantity::Jerk,
            ];
            let mut factorial = 1.0;
            let mut order = 0;
            for ((limit, quantity), peak) in limits.into_iter().zip(quantities).zip([
                &mut peaks.velocity,
                &mut peaks.acceleration,
                &mut peaks.jerk,
            ]) {
                order += 1;
                factorial *= f64::from(order);
                let count = usize::try_from(order).unwrap_or(0) + 1;
                if rows.len() < count {
                    break;
                }
                let recent = rows.range(rows.len() - count..);
                let (mut sum, mut noise) = (0.0, 0.0);
                for (one, (when, positions)) in recent.clone().enumerate() {
                    let mut product = 1.0;
                    for (other, (instant, _)) in recent.clone().enumerate() {
                        if other != one {
                            product *= when - instant;
                        }
                    }
                    // Differences from the newest row keep the digits of large positions.
                    sum += (positions[index] - at[index]) / product;
                    noise += rounding / product.abs();
                }
                let certain = factorial * (sum.abs() - noise).max(0.0);
                peak.raise(certain, time, place);
                if certain > limit * (1.0 + FOUND_SLACK) {
                    self.report.violations += 1;
                    if self.report.examples.len() < 10 {
                        self.report.examples.push(PoseViolation::Axis {
                            axis: axis.name,
                            quantity,
                            value: certain,
                            limit,
                            time,
                            place,
                        });
                    }
                }
            }
        }
    }

    /// How far a row is from a leg: tip and orientation as shares of their tolerances.
    fn shares(leg: &PoseLeg, pose: &ToolPose, at: &AxisVector, slack: (f64, f64)) -> [f64; 2] {
        match &leg.path {
            PosePath::Tool { tip, turn } => [
                (from_segment(&pose.tip(), &tip[0], &tip[1]) - slack.0).max(0.0)
                    / leg.tip_tolerance.length(),
                (from_arc(&pose.orientation(), turn) - slack.1).max(0.0)
                    / leg.orientation_tolerance.angle(),
            ],
            PosePath::Axes { start, end } => {
                let away = from_straight(at, start, end);
                [away / (STRAIGHT_SLACK + slack.1 + slack.0); 2]
            }
            PosePath::Dwell { .. } => [f64::INFINITY; 2],
        }
    }

    fn judge_pose(&mut self, time: f64, pose: &ToolPose, at: &AxisVector) {
        let slack = self.slack(pose);
        let mut best = (self.current, [f64::INFINITY; 2]);
        for index in self.current..self.legs.len().min(self.current + AHEAD) {
            let shares = Self::shares(&self.legs[index].leg, pose, at, slack);
            let worst = |shares: [f64; 2]| shares[0].max(shares[1]);
            if worst(shares) < worst(best.1) {
                best = (index, shares);
            }
            if worst(shares) <= 1.0 {
                break;
            }
        }
        self.current = best.0;
        let place = self.place();
        let bulge = self.bulge(pose);
        for index in self.current.saturating_sub(1)..self.legs.len().min(self.current + ENDS_AHEAD)
        {
            let expected = &mut self.legs[index];
            if let PosePath::Tool { tip, turn } = &expected.leg.path {
                let from = self.last.map_or(pose.tip(), |last| last.tip());
                let distance = from_segment(&tip[1], &from, &pose.tip()) - slack.0 - bulge[0];
                expected.tip = expected.tip.min(distance.max(0.0));
                let from = self
                    .last
                    .map_or(pose.orientation(), |last| last.orientation());
                // Between two rows the tool turns so little that its way is straight.
                let angle =
                    from_segment(&turn.end(), &from, &pose.orientation()) - slack.1 - bulge[1];
                expected.orientation = expected.orientation.min(angle.max(0.0));
            }
        }
        let Some(expected) = self.legs.get(self.current) else {
            return;
        };
        let bounds = [
            expected.leg.tip_tolerance.length(),
            expected.leg.orientation_tolerance.angle(),
        ];
        if best.1[0].is_finite() && matches!(expected.leg.path, PosePath::Tool { .. }) {
            if best.1[0] > self.report.tip_ratio.value {
                self.report.tip_deviation = Peak {
                    value: best.1[0] * bounds[0],
                    time,
                    place,
                };
            }
            self.report.tip_ratio.raise(best.1[0], time, place);
            if best.1[1] > self.report.orientation_ratio.value {
                self.report.orientation_deviation = Peak {
                    value: best.1[1] * bounds[1],
                    time,
                    place,
                };
            }
            self.report.orientation_ratio.raise(best.1[1], time, place);
            if best.1[0] > 1.0 + FOUND_SLACK {
                self.report.add(PoseViolation::TipDeviation {
                    value: best.1[0] * bounds[0],
                    tolerance: bounds[0],
                    time,
                    place,
                });
            }
            if best.1[1] > 1.0 + FOUND_SLACK {
                self.report.add(PoseViolation::OrientationDeviation {
                    value: best.1[1] * bounds[1],
                    tolerance: bounds[1],
                    time,
                    place,
                });
            }
        } else if best.1[0] > 1.0 + FOUND_SLACK && best.1[0].is_finite() {
            self.report.add(PoseViolation::AxesDeviation {
                value: best.1[0],
                time,
                place,
            });
        }
        if let (Some(last), Some((before, _))) = (self.last, self.rows.iter().rev().nth(1).copied())
        {
            let speed = (pose.tip() - last.tip()).norm() / (time - before);
            self.report.peak_speed.raise(speed, time, place);
        }
        self.before_last = self.last.replace(*pose);
    }
}
