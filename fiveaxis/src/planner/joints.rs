//! Stretches in which every axis goes for itself.
//!
//! Source: section 5.4 for NS-JCB; moves in words of axes. Not here: straight motion itself, see `joint`.

use super::{NOTABLE, PosePlanner, Slowdown};
use crate::block::PoseBlock;
use crate::error::FiveAxisError;
use crate::joint::{JointBlock, JointStretch};
use crate::lay::{intervals, knots};
use crate::relax::{Stretch, relax};
use crate::way::Way;
use toolglide_kinematics::{
    AxesPiece, Axis, AxisKind, AxisVector, PoseFeed, PoseLeg, PosePath, PosePiece,
};

impl PosePlanner<'_> {
    /// Every axis for itself between the poses of the blocks, and `way_points` between them.
    pub(super) fn plan_joints(
        &mut self,
        blocks: &[PoseBlock],
        ways: &[Way],
        way_points: u32,
    ) -> Result<(), FiveAxisError> {
        let parts = f64::from(way_points) + 1.0;
        let mut joints = Vec::new();
        for (block, way) in blocks.iter().zip(ways) {
            let mut start = *way.first();
            let mut part = 1.0;
            while part <= parts {
                let share = part / parts;
                let end = if part < parts {
                    self.machine
                        .follow(&block.pose(share)?, &start)
                        .map_err(|reason| FiveAxisError::Machine {
                            index: block.leg,
                            reason,
                        })?
                } else {
                    *way.last()
                };
                let mut joint = JointBlock::between(block, start, end);
                joint.duration /= parts;
                joints.push(joint);
                start = end;
                part += 1.0;
            }
        }
        let overlap = self.settings.chain().total_delay();
        self.lay_joints(joints, overlap)
    }

    pub(super) fn plan_axes(&mut self, legs: &[(u32, PoseLeg)]) -> Result<(), FiveAxisError> {
        let mut joints = Vec::with_capacity(legs.len());
        for (number, leg) in legs {
            let PosePath::Axes { start, end } = &leg.path else {
                continue;
            };
            let mut block = JointBlock {
                leg: *number,
                line: leg.line,
                start: *start,
                end: *end,
                duration: 0.0,
            };
            let (least, _) = block.least_duration(&self.axes, self.settings.chain());
            let asked = match leg.feed {
                PoseFeed::Rapid => 0.0,
                PoseFeed::Duration(duration) => duration,
                PoseFeed::Speed(feedrate) => way_length(&self.axes, start, end) / feedrate.speed(),
            };
            block.duration = asked.max(least);
            if block.duration > 0.0 {
                joints.push(block);
            }
        }
        if let Some(last) = joints.last() {
            self.at = last.end;
            self.pose =
                self.machine
                    .forward(&last.end)
                    .map_err(|reason| FiveAxisError::Machine {
                        index: last.leg,
                        reason,
                    })?;
        }
        self.lay_joints(joints, 0.0)
    }

    fn lay_joints(&mut self, blocks: Vec<JointBlock>, overlap: f64) -> Result<(), FiveAxisError> {
        let chain = self.settings.chain();
        let asked: Vec<_> = blocks.iter().map(|block| block.duration).collect();
        let mut met = vec![None; blocks.len()];
        let mut stretch = JointStretch {
            blocks,
            chain,
            axes: &self.axes,
            overlap,
        };
        let steps = if self.settings.keeps_axis_limits() {
            relax(&mut stretch, chain, &self.axes, &mut met)?
        } else {
            stretch.steps(&[])
        };
        let knots = knots(&steps, chain);
        for (interval, range) in intervals(&steps, &knots, chain) {
            let piece: AxesPiece = stretch.piece(&steps, interval, range);
            self.pieces.push_back(PosePiece::Axes(piece));
        }
        for ((block, asked), met) in stretch.blocks.iter().zip(asked).zip(met) {
            if let Some(met) = met
                && block.duration > asked * NOTABLE
            {
                self.slowdowns.push(Slowdown {
                    leg: block.leg,
                    line: block.line,
                    factor: block.duration / asked,
                    axis: self.axes[met.axis].name,
                    quantity: met.quantity(),
                });
            }
        }
        Ok(())
    }
}

/// Length of a straight move of axes for its feedrate: that of the linear axes, mm, or in degrees of
/// the rotary ones where no linear axis moves.
fn way_length(axes: &[Axis], start: &AxisVector, end: &AxisVector) -> f64 {
    let of = |kind: AxisKind| {
        axes.iter()
            .zip(start.iter().zip(end.iter()))
            .filter(|(axis, _)| axis.kind == kind)
            .map(|(_, (start, end))| (end - start).powi(2))
            .sum::<f64>()
            .sqrt()
    };
    let linear = of(AxisKind::Linear);
    if linear > 0.0 {
        linear
    } else {
        of(AxisKind::Rotary).to_degrees()
    }
}
