//! Judges the axes behind the tool: limits, travel, continuity.
//!
//! Source: the limits of every axis at every instant. Not here: how their motion is found, see `axes`.

use crate::poses::axes::Derivatives;
use crate::poses::{
    AxisQuantity, FOUND_SLACK, JUMP_SHARE, MEETING_SLACK, PoseJudge, PoseViolation,
};
use crate::report::Place;
use toolglide_kinematics::KinematicsError;
use toolglide_kinematics::PosePiece;

impl PoseJudge<'_> {
    pub(super) fn judge_axes(&mut self, piece: &PosePiece, place: Place) {
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
                            kind: axes[axis].kind,
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
                        kind: axes[axis].kind,
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
            PosePiece::Tool(_) | PosePiece::Rotary(_) => {
                if let Err((time, reason)) = self.follower.tool(piece, &mut take) {
                    self.report.add(PoseViolation::Unreachable {
                        reason: reason.to_string(),
                        time: begin + time,
                        place,
                    });
                }
            }
            PosePiece::Axes(moved) => self.follower.axes(moved, &mut take),
        }
        self.judge_travel(place);
    }

    /// Says which axis has left its travel, if any has.
    fn judge_travel(&mut self, place: Place) {
        for (axis, peaks) in self.follower.axes.iter().zip(&self.report.axes) {
            if let Some((low, high)) = axis.travel
                && (peaks.lowest < low - MEETING_SLACK || peaks.highest > high + MEETING_SLACK)
            {
                let reason = KinematicsError::Travel {
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
                    time: self.time,
                    place,
                });
                break;
            }
        }
    }
}
