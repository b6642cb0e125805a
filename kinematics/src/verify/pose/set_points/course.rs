//! Where the tool of a row is on the path: the leg that it follows, and the ends that it passes.
//!
//! Source: distances from segments and arcs, less what rounding may add to them. Not here: the axes.

use super::{Expected, PoseSetPointJudge};
use crate::axis_vector::AxisVector;
use crate::pose::ToolPose;
use crate::pose_leg::{PoseLeg, PosePath};
use crate::verify::pose::away::{from_arc, from_segment};
use crate::verify::pose::course::from_straight;
use crate::verify::pose::report::PoseViolation;
use crate::verify::pose::{FOUND_SLACK, STRAIGHT_SLACK};

/// Legs ahead of the one being followed that a row may have come to.
const AHEAD: usize = 64;

/// Ends of legs ahead that a row may pass.
const ENDS_AHEAD: usize = 8;

impl PoseSetPointJudge<'_> {
    pub(super) fn judge_pose(&mut self, time: f64, pose: &ToolPose, at: &AxisVector) {
        let slack = self.slack(pose);
        let (current, shares) = self.nearest_leg(pose, at, slack);
        self.current = current;
        self.pass_ends(pose, slack);
        if self.current < self.legs.len() {
            self.judge_shares(time, self.least_shares(shares, pose, at, slack));
            if let (Some(last), Some((before, _))) = (self.last, self.rows.iter().rev().nth(1)) {
                let speed = (pose.tip() - last.tip()).norm() / (time - before);
                self.report.peak_speed.raise(speed, time, self.place());
            }
            self.before_last = self.last.replace(*pose);
        }
    }

    /// The first leg ahead in whose tolerances a row is, else the nearest, and the shares of them.
    fn nearest_leg(
        &self,
        pose: &ToolPose,
        at: &AxisVector,
        slack: (f64, f64),
    ) -> (usize, [f64; 2]) {
        let worst = |shares: [f64; 2]| shares[0].max(shares[1]);
        let mut best = (self.current, [f64::INFINITY; 2]);
        for index in self.current..self.legs.len().min(self.current + AHEAD) {
            let shares = Self::shares(&self.legs[index].leg, pose, at, slack);
            if worst(shares) < worst(best.1) {
                best = (index, shares);
            }
            if worst(shares) <= 1.0 {
                break;
            }
        }
        best
    }

    /// The shares of the nearest of the legs that a row may be on: a leg is left as late as its
    /// tolerances allow, but near a corner the next ones are nearer.
    fn least_shares(
        &self,
        mut least: [f64; 2],
        pose: &ToolPose,
        at: &AxisVector,
        slack: (f64, f64),
    ) -> [f64; 2] {
        let within = |shares: [f64; 2]| shares[0].max(shares[1]) <= 1.0;
        let of_tool = |expected: &Expected| matches!(expected.leg.path, PosePath::Tool { .. });
        if !within(least) || !of_tool(&self.legs[self.current]) {
            return least;
        }
        let ahead = self.legs.iter().skip(self.current + 1).take(AHEAD);
        for expected in ahead.take_while(|expected| of_tool(expected)) {
            let shares = Self::shares(&expected.leg, pose, at, slack);
            if !within(shares) {
                break;
            }
            least = [least[0].min(shares[0]), least[1].min(shares[1])];
        }
        least
    }

    /// Notes how near the ends of legs are passed on the way from the row before.
    fn pass_ends(&mut self, pose: &ToolPose, slack: (f64, f64)) {
        let bulge = self.bulge(pose);
        let from = self.last.unwrap_or(*pose);
        let ahead = self.legs.len().min(self.current + ENDS_AHEAD);
        for index in self.current.saturating_sub(1)..ahead {
            let expected = &mut self.legs[index];
            if let PosePath::Tool { tip, turn } = &expected.leg.path {
                let distance = from_segment(&tip[1], &from.tip(), &pose.tip()) - slack.0 - bulge[0];
                expected.tip = expected.tip.min(distance.max(0.0));
                // Between two rows the tool turns so little that its way is straight.
                let angle = from_segment(&turn.end(), &from.orientation(), &pose.orientation())
                    - slack.1
                    - bulge[1];
                expected.orientation = expected.orientation.min(angle.max(0.0));
            }
        }
    }

    /// Judges the shares of the tolerances of the leg that is followed.
    fn judge_shares(&mut self, time: f64, shares: [f64; 2]) {
        let Expected { leg, place, .. } = &self.legs[self.current];
        let (place, report) = (*place, &mut self.report);
        if !shares[0].is_finite() {
            return;
        }
        if !matches!(leg.path, PosePath::Tool { .. }) {
            if shares[0] > 1.0 + FOUND_SLACK {
                report.add(PoseViolation::AxesDeviation {
                    value: shares[0],
                    time,
                    place,
                });
            }
            return;
        }
        let tolerance = leg.tip_tolerance.length();
        let value = shares[0] * tolerance;
        report.raise_tip(shares[0], value, time, place);
        if shares[0] > 1.0 + FOUND_SLACK {
            report.add(PoseViolation::TipDeviation {
                value,
                tolerance,
                time,
                place,
            });
        }
        let tolerance = leg.orientation_tolerance.angle();
        let value = shares[1] * tolerance;
        report.raise_orientation(shares[1], value, time, place);
        if shares[1] > 1.0 + FOUND_SLACK {
            report.add(PoseViolation::OrientationDeviation {
                value,
                tolerance,
                time,
                place,
            });
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
}
