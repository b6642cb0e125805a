//! Locates each row of the tool along the path once the next row is known.
//!
//! Source: the way between two rows is at most so far from its chord as its acceleration bends it, which the
//! second differences of the rows on both sides show. Not here: the axes, and which part of the path a row is
//! on.

use crate::poses::set_points::PoseSetPointJudge;
use crate::poses::set_points::parts::Row;
use toolglide_kinematics::AxisKind;
use toolglide_kinematics::AxisVector;
use toolglide_kinematics::ToolPose;
use toolglide_kinematics::Vector;

/// Share of the second difference by which the way between two rows may leave its chord: an eighth where the
/// acceleration is even, twice over because it changes.
const BULGE: f64 = 0.25;

/// Accelerations of tip and tool about a row.
type Bends = [Vector<3>; 2];

impl PoseSetPointJudge<'_> {
    pub(super) fn judge_pose(&mut self, time: f64, pose: &ToolPose, at: &AxisVector) {
        let slack = self.slack(pose);
        let next = Row {
            time,
            axes: *at,
            pose: *pose,
            from: *pose,
            rotary: std::array::from_fn(|axis| {
                let axis = self.axes.get(axis);
                axis.is_some_and(|axis| axis.kind == AxisKind::Rotary)
            }),
            swings: self.machine.swings(at).unwrap_or_default(),
            axes_before: *at,
            slack,
            bulge: [0.0; 2],
        };
        let Some(held) = self.held.replace(next) else {
            return;
        };
        let lasts = time - held.time;
        let speed = (pose.tip() - held.pose.tip()).norm() / lasts;
        let place = self.place();
        self.report.peak_speed.raise(speed, time, place);
        let bends = self
            .before
            .map_or([Vector::zeros(); 2], |before| bends(&before, &held, &next));
        self.follow(&held, bends);
        if let Some(next) = &mut self.held {
            next.from = held.pose;
            next.axes_before = held.axes;
        }
        self.before = Some(held);
        self.bends = bends;
    }

    /// Judges a row, between whose predecessor and successor the tool bends so.
    pub(super) fn follow(&mut self, row: &Row, after: Bends) {
        let lasts = self.before.map_or(0.0, |before| row.time - before.time);
        let mut row = *row;
        for (index, bulge) in row.bulge.iter_mut().enumerate() {
            let most = self.bends[index].norm().max(after[index].norm());
            *bulge = BULGE * most * lasts * lasts;
        }
        let spacing = self.spacing(row.time);
        if let Some(spacing) = &spacing {
            for (bulge, shown) in row.bulge.iter_mut().zip(spacing.shown) {
                *bulge += shown;
            }
        }
        let (tip, tool) = (self.tip.span(), self.tool.span());
        self.tip.advance(&row);
        self.tool.advance(&row);
        if let Some(spacing) = spacing {
            let tolerances = [self.tip.finest(tip), self.tool.finest(tool)];
            self.judge_spacing(&spacing, tolerances);
        }
    }
}

/// Accelerations that three rows show.
fn bends(one: &Row, two: &Row, three: &Row) -> Bends {
    let (before, after) = (two.time - one.time, three.time - two.time);
    let bend = |of: fn(&ToolPose) -> Vector<3>| {
        let [one, two, three] = [one, two, three].map(|row| of(&row.pose));
        ((three - two) / after - (two - one) / before) * (2.0 / (before + after))
    };
    [bend(ToolPose::tip), bend(ToolPose::orientation)]
}
