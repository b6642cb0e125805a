//! Judges tool and axes between the ends of legs: deviation and speed.
//!
//! Source: the meaning of [`toolglide_kinematics::Tolerance`] and [`toolglide_kinematics::OrientationTolerance`] along the path. Not here: how the
//! largest deviation is found, see `away`.

use crate::poses::route;
use crate::poses::route::Route;
use crate::poses::tool_deviation::{Course, Space, approach, from_arc, from_segment};
use crate::poses::{FOUND_SLACK, MEETING_SLACK, PoseJudge, PoseViolation, STRAIGHT_SLACK};
use toolglide_kinematics::PosePath;
use toolglide_kinematics::Sample;
use toolglide_kinematics::ToolPose;
use toolglide_kinematics::angle_between;
use toolglide_kinematics::numeric::LIMIT_SLACK;
use toolglide_kinematics::{AxesPiece, PosePiece, ToolPiece};

/// Lengths of an orientation may differ from 1 by this.
const UNIT_SLACK: f64 = 1e-14;

impl PoseJudge<'_> {
    pub(super) fn judge_tool(&mut self, piece: &ToolPiece, first: u32, last: u32) {
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
        self.judge_speed(&piece.tip, duration, first, last);
    }

    pub(super) fn judge_course(
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
                        if let Some(tip) = leg.tip() {
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
            report.raise_tip(tip.bound, value, time, place);
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
            report.raise_orientation(turn.bound, value, time, place);
            if value > tolerance * (1.0 + FOUND_SLACK) + MEETING_SLACK {
                report.add(PoseViolation::OrientationDeviation {
                    value,
                    tolerance,
                    time,
                    place,
                });
            }
        }
        self.approach_ends(pose, duration, first, last);
    }

    /// Notes how near the motion comes to the ends of the legs that it serves, and to the one before.
    fn approach_ends(
        &mut self,
        pose: &mut dyn FnMut(f64) -> ToolPose,
        duration: f64,
        first: u32,
        last: u32,
    ) {
        let begin = self.time;
        self.route
            .each_end(first.saturating_sub(1), last, |leg, end| {
                let Some(tip) = leg.tip() else {
                    return;
                };
                let found = approach(duration, |time| (pose(time).tip() - tip[1]).norm());
                if found.0 < end.tip.0 {
                    end.tip = (found.0, begin + found.1);
                }
                let PosePath::Tool { turn, .. } = &leg.path else {
                    return;
                };
                let found = approach(duration, |time| {
                    angle_between(&pose(time).orientation(), &turn.end())
                });
                if found.0 < end.orientation.0 {
                    end.orientation = (found.0, begin + found.1);
                }
            });
    }

    pub(super) fn straight(&self, first: u32, last: u32) -> bool {
        let mut straight = false;
        self.route.each(first, last, |_, leg| {
            straight |= matches!(leg.path, PosePath::Axes { .. });
        });
        straight
    }

    /// How far axes leave the straight moves of axes that they serve.
    pub(super) fn judge_straight(&mut self, piece: &PosePiece, first: u32, last: u32) {
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

    /// Notes how fast the tool tip is while the axes go straight. No feedrate of the tip is asked for then.
    pub(super) fn see_speed(&mut self, moved: &AxesPiece, first: u32) {
        let (machine, place) = (self.follower.machine, self.route.place(first));
        let mut position = moved.end;
        let half = GLANCE * moved.duration;
        let mut tip = |time: f64| {
            moved.at(time, &mut position);
            machine.forward(&position).ok().map(|pose| pose.tip())
        };
        for step in 0..=SPEEDS {
            let time = moved.duration * f64::from(step) / f64::from(SPEEDS);
            let time = time.max(half).min(moved.duration - half);
            if let (Some(before), Some(after)) = (tip(time - half), tip(time + half))
                && half > 0.0
            {
                let speed = (after - before).norm() / (2.0 * half);
                self.report.peak_speed.raise(speed, self.time + time, place);
            }
        }
    }

    pub(super) fn judge_speed(&mut self, start: &Sample<3>, duration: f64, first: u32, last: u32) {
        let mut feedrate: f64 = 0.0;
        self.route.each(first, last, |_, leg| {
            feedrate = feedrate.max(route::feedrate(leg));
        });
        for step in 0..=16 {
            let time = duration * f64::from(step) / 16.0;
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
}

/// Instants at which the speed of the tool tip is looked at while axes go straight.
const SPEEDS: u32 = 16;

/// Half of the time over which it is seen, as a share of the duration of a piece: small enough for the tip to go straight,
/// large enough for the rounding of positions.
const GLANCE: f64 = 1e-3;

/// Largest distance of an axis from a straight move of all axes.
pub(super) fn from_straight(position: &[f64], start: &[f64], end: &[f64]) -> f64 {
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
