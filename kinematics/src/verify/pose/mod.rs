//! The judge of pose motion: both tolerances, and the axes of a machine behind its inverse
//! kinematics.
//!
//! Source: the meaning of [`crate::Tolerance`] and [`crate::OrientationTolerance`], and the limits of
//! every axis at every instant. Not here: any formula of any planner or machine.

mod away;
mod axes;
mod report;
mod route;
mod set_points;

pub use report::{AxisPeaks, AxisQuantity, PoseReport, PoseViolation};
pub use set_points::PoseSetPointJudge;

use super::report::{Peak, Place};
use crate::axis_vector::AxisVector;
use crate::machine::{Axis, MachineKinematics};
use crate::numeric::{JUMP_SLACK, LIMIT_SLACK, TIME_SLACK};
use crate::piece::Serves;
use crate::pose::ToolPose;
use crate::pose_leg::{PoseLeg, PosePath};
use crate::pose_piece::{PosePiece, ToolPiece};
use away::{Course, Space, approach, from_arc, from_segment};
use axes::{Derivatives, Follower};
use route::{Route, Waypoint};

/// Relative room granted to limits that were found by interpolation: its error and its rounding.
const FOUND_SLACK: f64 = 1e-4;

/// Room granted to where two pieces meet, mm and rad: the rounding of their coefficients.
const MEETING_SLACK: f64 = 1e-8;

/// Jumps of velocity and acceleration below this share of the limit are noise of interpolation.
const JUMP_SHARE: f64 = 1e-3;

/// Room granted to rest, as a share of mm/s and rad/s.
const REST_SLACK: f64 = 1e-7;

/// How far axes may leave a straight move of axes, mm and rad.
const STRAIGHT_SLACK: f64 = 1e-6;

/// Lengths of an orientation may differ from 1 by this.
const UNIT_SLACK: f64 = 1e-14;

/// Judges a motion of poses piece by piece while it is planned.
///
/// Legs are expected in path order, any number ahead of the motion. A piece is compared with the
/// legs that it says it serves, which must go forward.
pub struct PoseJudge<'m> {
    follower: Follower<'m>,
    route: Route,
    report: PoseReport,
    time: f64,
    served: Option<Serves>,
    /// State of the axes where the last piece ended.
    state: Vec<Derivatives>,
    rested: f64,
}

impl std::fmt::Debug for PoseJudge<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PoseJudge")
            .field("time", &self.time)
            .field("report", &self.report)
            .finish_non_exhaustive()
    }
}

impl<'m> PoseJudge<'m> {
    /// A judge of motion from rest at the axis positions `start`.
    ///
    /// `axes` are those of the machine, with the limits to keep.
    #[must_use]
    pub fn new(machine: &'m dyn MachineKinematics, axes: Vec<Axis>, start: &AxisVector) -> Self {
        let peaks = axes
            .iter()
            .zip(start.iter())
            .map(|(axis, &position)| AxisPeaks {
                name: axis.name,
                velocity: Peak::default(),
                acceleration: Peak::default(),
                jerk: Peak::default(),
                lowest: position,
                highest: position,
            })
            .collect();
        Self {
            state: start
                .iter()
                .map(|&position| [position, 0.0, 0.0, 0.0])
                .collect(),
            follower: Follower::new(machine, axes, start),
            route: Route::default(),
            report: PoseReport::new(peaks),
            time: 0.0,
            served: None,
            rested: 0.0,
        }
    }

    /// Takes the next leg of the path.
    pub fn expect(&mut self, leg: &PoseLeg) {
        self.report.path_length += leg.length();
        self.report.path_angle += leg.angle();
        self.route.expect(leg.clone());
    }

    /// Judges the next piece of the motion. The legs that it serves have been expected before.
    pub fn observe(&mut self, piece: &PosePiece) {
        self.report.observed += 1;
        let Some((first, last)) = self.claim(piece.serves()) else {
            return;
        };
        let place = self.route.place(first);
        let duration = piece.duration();
        if !(duration >= 0.0 && duration.is_finite()) {
            let time = self.time;
            self.report.add(PoseViolation::NotFinite { time, place });
            return;
        }
        self.judge_axes(piece, place);
        match piece {
            PosePiece::Tool(tool) => self.judge_tool(tool, first, last),
            PosePiece::Axes(moved) => {
                let machine = self.follower.machine;
                let mut position = moved.end;
                let mut pose = |time: f64| {
                    moved.at(time, &mut position);
                    machine.forward(&position).ok()
                };
                if self.straight(first, last) {
                    self.judge_straight(piece, first, last);
                } else if let Some(mut known) = pose(0.0) {
                    let mut sound = |time: f64| {
                        known = pose(time).unwrap_or(known);
                        known
                    };
                    self.judge_course(&mut sound, duration, first, last);
                }
            }
        }
        self.record_rest(piece, first, last);
        self.time += duration;
    }

    /// The report, once the motion is over.
    #[must_use]
    pub fn finish(mut self) -> PoseReport {
        self.close(u32::MAX);
        if let Some(place) = self.route.last_unfinished() {
            self.report.add(PoseViolation::StopNotMade { place });
        }
        let still = self
            .state
            .iter()
            .zip(&self.follower.axes)
            .all(|(state, axis)| {
                state[1].abs() <= JUMP_SHARE * axis.limits.velocity()
                    && state[2].abs() <= JUMP_SHARE * axis.limits.acceleration()
            });
        if !still {
            let place = self.route.place(self.route.len().saturating_sub(1));
            self.report.add(PoseViolation::StopNotMade { place });
        }
        self.report.cycle_time = self.time;
        self.report.moves = self.route.len();
        self.report
    }

    /// The legs to judge a piece by; those behind are closed.
    fn claim(&mut self, serves: Serves) -> Option<(u32, u32)> {
        let Serves { first, last } = serves;
        let before = self.served.unwrap_or(Serves { first: 0, last: 0 });
        if first > last || last >= self.route.len() || first < before.first || last < before.last {
            let time = self.time;
            self.report
                .add(PoseViolation::MovesOutOfOrder { first, last, time });
            return None;
        }
        self.served = Some(serves);
        self.close(first.saturating_sub(1));
        Some((first, last))
    }

    /// Says what is wrong with the corners of the legs before `until`, and forgets them.
    fn close(&mut self, until: u32) {
        while let Some((leg, end)) = self.route.close(until) {
            if let PosePath::Dwell { duration } = leg.path {
                if end.rested < duration - TIME_SLACK {
                    self.report.add(PoseViolation::DwellTooShort {
                        rested: end.rested,
                        duration,
                        place: end.place,
                    });
                }
                continue;
            }
            if leg.stop && !end.stopped {
                self.report
                    .add(PoseViolation::StopNotMade { place: end.place });
            }
            self.close_corner(&end);
        }
    }

    fn close_corner(&mut self, end: &Waypoint) {
        let Some((tip_tolerance, orientation_tolerance)) = end.tolerances else {
            return;
        };
        let (distance, time) = end.tip;
        if distance.is_finite() {
            let share = distance / tip_tolerance;
            self.report.tip_corner_ratio.raise(share, time, end.place);
            if share >= self.report.tip_corner_ratio.value {
                self.report.tip_corner = Peak {
                    value: distance,
                    time,
                    place: end.place,
                };
            }
        }
        if distance > tip_tolerance * (1.0 + FOUND_SLACK) + MEETING_SLACK {
            self.report.add(PoseViolation::TipCorner {
                value: distance,
                tolerance: tip_tolerance,
                place: end.place,
            });
        }
        let (angle, time) = end.orientation;
        if angle.is_finite() {
            let share = angle / orientation_tolerance;
            self.report
                .orientation_corner_ratio
                .raise(share, time, end.place);
            if share >= self.report.orientation_corner_ratio.value {
                self.report.orientation_corner = Peak {
                    value: angle,
                    time,
                    place: end.place,
                };
            }
        }
        if angle > orientation_tolerance * (1.0 + FOUND_SLACK) + MEETING_SLACK {
            self.report.add(PoseViolation::OrientationCorner {
                value: angle,
                tolerance: orientation_tolerance,
                place: end.place,
            });
        }
    }

    fn judge_tool(&mut self, piece: &ToolPiece, first: u32, last: u32) {
        let duration = piece.duration;
        let mut pose = |time: f64| piece.at(time);
        for share in [0.0, 0.5, 1.0] {
            let length = pose(share * duration).orientation().norm();
            self.report.unit_error = self.report.unit_error.max((length - 1.0).abs());
        }
        if self.report.unit_error.is_nan() || self.report.unit_error > UNIT_SLACK {
            self.report.add(PoseViolation::NotFinite {
                time: self.time,
                place: self.route.place(first),
            });
        }
        self.judge_course(&mut pose, duration, first, last);
        self.judge_speed(piece, first, last);
    }

    fn judge_course(
        &mut self,
        pose: &mut dyn FnMut(f64) -> ToolPose,
        duration: f64,
        first: u32,
        last: u32,
    ) {
        let (route, report, begin) = (&mut self.route, &mut self.report, self.time);
        let tip = {
            let route: &Route = route;
            Course {
                space: Space::Straight,
                point: &mut |time| pose(time).tip(),
                legs: &|point, visit| {
                    route.each(first, last, |number, leg| {
                        if let PosePath::Tool { tip, .. } = &leg.path {
                            let distance = from_segment(point, &tip[0], &tip[1]);
                            visit(number, distance, leg.tip_tolerance.length());
                        }
                    });
                },
            }
            .largest(duration, report.tip_ratio.value)
        };
        let turn = {
            let route: &Route = route;
            Course {
                space: Space::Sphere,
                point: &mut |time| pose(time).orientation(),
                legs: &|point, visit| {
                    route.each(first, last, |number, leg| {
                        if let PosePath::Tool { turn, .. } = &leg.path {
                            let distance = from_arc(point, turn);
                            visit(number, distance, leg.orientation_tolerance.angle());
                        }
                    });
                },
            }
            .largest(duration, report.orientation_ratio.value)
        };
        if let Some(leg) = route.get(tip.leg)
            && tip.bound.is_finite()
        {
            let tolerance = leg.tip_tolerance.length();
            let (value, time, place) =
                (tip.bound * tolerance, begin + tip.at, route.place(tip.leg));
            if tip.bound > report.tip_ratio.value {
                report.tip_deviation = Peak { value, time, place };
            }
            report.tip_ratio.raise(tip.bound, time, place);
            if value > tolerance * (1.0 + FOUND_SLACK) + MEETING_SLACK {
                report.add(PoseViolation::TipDeviation {
                    value,
                    tolerance,
                    time,
                    place,
                });
            }
        }
        if let Some(leg) = route.get(turn.leg)
            && turn.bound.is_finite()
        {
            let tolerance = leg.orientation_tolerance.angle();
            let (value, time, place) = (
                turn.bound * tolerance,
                begin + turn.at,
                route.place(turn.leg),
            );
            if turn.bound > report.orientation_ratio.value {
                report.orientation_deviation = Peak { value, time, place };
            }
            report.orientation_ratio.raise(turn.bound, time, place);
            if value > tolerance * (1.0 + FOUND_SLACK) + MEETING_SLACK {
                report.add(PoseViolation::OrientationDeviation {
                    value,
                    tolerance,
                    time,
                    place,
                });
            }
        }
        route.each_end(first.saturating_sub(1), last, |leg, end| {
            let PosePath::Tool { tip, turn } = &leg.path else {
                return;
            };
            let found = approach(duration, |time| (pose(time).tip() - tip[1]).norm());
            if found.0 < end.tip.0 {
                end.tip = (found.0, begin + found.1);
            }
            let found = approach(duration, |time| {
                crate::great_circle::angle_between(&pose(time).orientation(), &turn.end())
            });
            if found.0 < end.orientation.0 {
                end.orientation = (found.0, begin + found.1);
            }
        });
    }

    fn straight(&self, first: u32, last: u32) -> bool {
        let mut straight = false;
        self.route.each(first, last, |_, leg| {
            straight |= matches!(leg.path, PosePath::Axes { .. });
        });
        straight
    }

    /// How far axes leave the straight moves of axes that they serve.
    fn judge_straight(&mut self, piece: &PosePiece, first: u32, last: u32) {
        let PosePiece::Axes(moved) = piece else {
            return;
        };
        let mut position = moved.end;
        for share in [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0] {
            moved.at(share * moved.duration, &mut position);
            let mut nearest = f64::INFINITY;
            self.route.each(first, last, |_, leg| {
                if let PosePath::Axes { start, end } = &leg.path {
                    nearest = nearest.min(from_straight(&position, start, end));
                }
            });
            if nearest > STRAIGHT_SLACK {
                self.report.add(PoseViolation::AxesDeviation {
                    value: nearest,
                    time: self.time + share * moved.duration,
                    place: self.route.place(first),
                });
                return;
            }
        }
    }

    fn judge_speed(&mut self, piece: &ToolPiece, first: u32, last: u32) {
        let mut feedrate: f64 = 0.0;
        self.route.each(first, last, |_, leg| {
            feedrate = feedrate.max(route::feedrate(leg));
        });
        let start = &piece.tip;
        for step in 0..=16 {
            let time = piece.duration * f64::from(step) / 16.0;
            let velocity = start.velocity + (start.acceleration + start.jerk * (0.5 * time)) * time;
            let (speed, place) = (velocity.norm(), self.route.place(first));
            self.report.peak_speed.raise(speed, self.time + time, place);
            if speed > feedrate * (1.0 + LIMIT_SLACK) + MEETING_SLACK {
                self.report.add(PoseViolation::Feedrate {
                    value: speed,
                    feedrate,
                    time: self.time + time,
                    place,
                });
                return;
            }
        }
    }

    fn judge_axes(&mut self, piece: &PosePiece, place: Place) {
        let (begin, report, state) = (self.time, &mut self.report, &mut self.state);
        let axes = self.follower.axes.clone();
        let mut fresh = vec![true; axes.len()];
        let mut take = |time: f64, axis: usize, found: Derivatives| {
            let limits = &axes[axis].limits;
            let bounds = [limits.velocity(), limits.acceleration(), limits.jerk()];
            if fresh[axis] {
                fresh[axis] = false;
                let room = [
                    MEETING_SLACK,
                    JUMP_SHARE * bounds[0],
                    JUMP_SHARE * bounds[1],
                ];
                let what = ["position", "velocity", "acceleration"];
                for order in 0..3 {
                    let value = (found[order] - state[axis][order]).abs();
                    if value > room[order] {
                        report.add(PoseViolation::Jump {
                            axis: axes[axis].name,
                            what: what[order],
                            value,
                            time: begin + time,
                            place,
                        });
                    }
                }
            }
            state[axis] = found;
            let when = begin + time;
            let peaks = &mut report.axes[axis];
            peaks.lowest = peaks.lowest.min(found[0]);
            peaks.highest = peaks.highest.max(found[0]);
            peaks.velocity.raise(found[1].abs(), when, place);
            peaks.acceleration.raise(found[2].abs(), when, place);
            peaks.jerk.raise(found[3].abs(), when, place);
            let quantities = [
                AxisQuantity::Velocity,
                AxisQuantity::Acceleration,
                AxisQuantity::Jerk,
            ];
            for (order, quantity) in quantities.into_iter().enumerate() {
                let (value, limit) = (found[order + 1].abs(), bounds[order]);
                if value.is_nan() || value > limit * (1.0 + FOUND_SLACK) {
                    report.add(PoseViolation::Axis {
                        axis: axes[axis].name,
                        quantity,
                        value,
                        limit,
                        time: when,
                        place,
                    });
                }
            }
        };
        match piece {
            PosePiece::Tool(tool) => {
                if let Err((time, reason)) = self.follower.tool(tool, &mut take) {
                    self.report.add(PoseViolation::Unreachable {
                        reason: reason.to_string(),
                        time: begin + time,
                        place,
                    });
                }
            }
            PosePiece::Axes(moved) => self.follower.axes(moved, &mut take),
        }
        for (axis, peaks) in self.follower.axes.iter().zip(&self.report.axes) {
            if let Some((low, high)) = axis.travel
                && (peaks.lowest < low - MEETING_SLACK || peaks.highest > high + MEETING_SLACK)
            {
                let reason = crate::machine::KinematicsError::Travel {
                    axis: axis.name,
                    kind: axis.kind,
                    position: if peaks.lowest < low {
                        peaks.lowest
                    } else {
                        peaks.highest
                    },
                    low,
                    high,
                };
                self.report.add(PoseViolation::Unreachable {
                    reason: reason.to_string(),
                    time: begin,
                    place,
                });
                break;
            }
        }
    }

    /// Notes rest at the end of a piece, and whether it is where a leg ends.
    fn record_rest(&mut self, piece: &PosePiece, first: u32, last: u32) {
        let duration = piece.duration();
        let (moving, throughout) = match piece {
            PosePiece::Tool(tool) => {
                let start = &tool.tip;
                let end = start.velocity
                    + (start.acceleration + start.jerk * (0.5 * duration)) * duration;
                let rates = |time: f64| {
                    tool.turns
                        .iter()
                        .map(|turn| slope(&turn.angle, time).abs())
                        .sum::<f64>()
                };
                (
                    end.norm() + rates(duration),
                    [start.velocity, start.acceleration, start.jerk]
                        .iter()
                        .map(|vector| vector.norm())
                        .sum::<f64>()
                        + tool
                            .turns
                            .iter()
                            .map(|turn| swing(&turn.angle))
                            .sum::<f64>(),
                )
            }
            PosePiece::Axes(moved) => (
                moved
                    .positions
                    .iter()
                    .map(|cubic| slope(cubic, duration).abs())
                    .sum(),
                moved.positions.iter().map(swing).sum(),
            ),
        };
        if throughout <= JUMP_SLACK {
            self.rested += duration;
        } else {
            self.rested = 0.0;
        }
        let rested = self.rested;
        let near = self.follower.near;
        let machine = self.follower.machine;
        let pose = match piece {
            PosePiece::Tool(tool) => Some(tool.end),
            PosePiece::Axes(moved) => machine.forward(&moved.end).ok(),
        };
        self.route
            .each_end(first.saturating_sub(1), last, |leg, end| {
                let there = match &leg.path {
                    PosePath::Tool { tip, turn } => pose.is_some_and(|pose| {
                        (pose.tip() - tip[1]).norm() < MEETING_SLACK
                            && (pose.orientation() - turn.end()).norm() < MEETING_SLACK
                    }),
                    PosePath::Axes { end, .. } => from_straight(&near, end, end) < MEETING_SLACK,
                    PosePath::Dwell { .. } => true,
                };
                if there && moving <= REST_SLACK {
                    end.stopped = true;
                }
                end.rested = end.rested.max(rested);
            });
    }
}

/// Largest distance of an axis from a straight move of all axes.
fn from_straight(position: &[f64], start: &[f64], end: &[f64]) -> f64 {
    let spans = || start.iter().zip(end).map(|(start, end)| end - start);
    let squared: f64 = spans().map(|span| span * span).sum();
    let gone = || position.iter().zip(start).map(|(at, start)| at - start);
    let along = if squared > 0.0 {
        let product: f64 = gone().zip(spans()).map(|(gone, span)| gone * span).sum();
        (product / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    gone()
        .zip(spans())
        .map(|(gone, span)| (gone - along * span).abs())
        .fold(0.0, f64::max)
}

fn slope(cubic: &[f64; 4], time: f64) -> f64 {
    cubic[1] + (2.0 * cubic[2] + 3.0 * cubic[3] * time) * time
}

/// How much a polynomial moves, as the sum of its coefficients but the first.
fn swing(cubic: &[f64; 4]) -> f64 {
    cubic[1..].iter().map(|coefficient| coefficient.abs()).sum()
}
