//! Judges the ends of legs: corners, stops and dwells.
//!
//! Source: the meaning of [`toolglide_kinematics::Tolerance`] at corners; a stop is exact, and a dwell lasts. Not here: what
//! is between the ends.

use crate::poses::course::from_straight;
use crate::poses::route::Waypoint;
use crate::poses::swing::{are_at, from_position};
use crate::poses::{FOUND_SLACK, MEETING_SLACK, PoseJudge, PoseViolation};
use crate::report::Peak;
use toolglide_kinematics::PosePath;
use toolglide_kinematics::PosePiece;
use toolglide_kinematics::ToolPose;
use toolglide_kinematics::angle_between;
use toolglide_kinematics::numeric::{JUMP_SLACK, TIME_SLACK};

/// Room granted to rest, as a share of mm/s and rad/s.
const REST_SLACK: f64 = 1e-7;

impl PoseJudge<'_> {
    /// Says what is wrong with the corners of the legs before `until`, and forgets them.
    pub(super) fn close(&mut self, until: u32) {
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

    pub(super) fn close_corner(&mut self, end: &Waypoint) {
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

    /// Notes rest at the end of a piece, and whether it is where a leg ends.
    pub(super) fn record_rest(&mut self, piece: &PosePiece, first: u32, last: u32) {
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
            PosePiece::Rotary(moved) => {
                let start = &moved.tip;
                let end = start.velocity
                    + (start.acceleration + start.jerk * (0.5 * duration)) * duration;
                let rotary = || moved.rotary.iter().flatten();
                let rates: f64 = rotary().map(|cubic| slope(cubic, duration).abs()).sum();
                let of_tip = [start.velocity, start.acceleration, start.jerk];
                (
                    end.norm() + rates,
                    of_tip.iter().map(|vector| vector.norm()).sum::<f64>()
                        + rotary().map(swing).sum::<f64>(),
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
        self.moving = moving;
        self.pose = match piece {
            PosePiece::Tool(tool) => Some(tool.end),
            PosePiece::Rotary(moved) => {
                let (tip, at) = moved.at(duration, &self.follower.near);
                let tool = self.follower.machine.forward(&at).ok();
                tool.map(|tool| ToolPose::rounded(tip, tool.orientation()))
            }
            PosePiece::Axes(moved) => self.follower.machine.forward(&moved.end).ok(),
        };
        self.stand(first.saturating_sub(1), last, self.rested);
    }

    /// Notes that no piece serves the legs behind those served so far and before `until`: the motion has
    /// done nothing for them, and passes their ends where it is.
    pub(super) fn pass(&mut self, until: u32) {
        let first = self
            .served
            .map_or(0, |served| served.last.saturating_add(1));
        let Some(last) = until.checked_sub(1).filter(|last| first <= *last) else {
            return;
        };
        let time = self.time;
        if let Some(pose) = self.pose {
            let follower = &self.follower;
            self.route.each_end(first, last, |leg, end| {
                let Some(tip) = leg.tip() else {
                    return;
                };
                end.tip = ((pose.tip() - tip[1]).norm(), time);
                let angle = match &leg.path {
                    PosePath::Rotary { axes, .. } => {
                        from_position(follower.machine, &follower.near, &axes[1])
                    }
                    PosePath::Tool { turn, .. } => angle_between(&pose.orientation(), &turn.end()),
                    _ => return,
                };
                end.orientation = (angle, time);
            });
        }
        self.stand(first, last, 0.0);
    }

    /// Notes of the ends of legs whether the motion rests there now.
    fn stand(&mut self, first: u32, last: u32, rested: f64) {
        let (machine, near) = (self.follower.machine, self.follower.near);
        let (pose, moving) = (self.pose, self.moving);
        self.route.each_end(first, last, |leg, end| {
            let there = match &leg.path {
                PosePath::Tool { tip, turn } => pose.is_some_and(|pose| {
                    (pose.tip() - tip[1]).norm() < MEETING_SLACK
                        && (pose.orientation() - turn.end()).norm() < MEETING_SLACK
                }),
                PosePath::Rotary { tip, axes, .. } => {
                    pose.is_some_and(|pose| (pose.tip() - tip[1]).norm() < MEETING_SLACK)
                        && are_at(machine, &near, &axes[1])
                }
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

fn slope(cubic: &[f64; 4], time: f64) -> f64 {
    cubic[1] + (2.0 * cubic[2] + 3.0 * cubic[3] * time) * time
}

/// How much a polynomial moves, as the sum of its coefficients but the first.
fn swing(cubic: &[f64; 4]) -> f64 {
    cubic[1..].iter().map(|coefficient| coefficient.abs()).sum()
}
