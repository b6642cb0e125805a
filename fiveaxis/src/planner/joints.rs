//! Plans sections in which every axis moves straight by itself.
//!
//! Source: section 5.4 for NS-JCB; moves in words of axes. Not here: straight motion itself, see `joint`.

use super::choice::Choice;
use super::row::Section;
use super::{NOTABLE, PosePlanner, Slowdown};
use crate::axis_limits::slow_down::{Stretch, relax};
use crate::error::FiveAxisError;
use crate::output::pieces::{intervals, knots};
use crate::pose::joint::{JointBlock, JointStretch};
use crate::timing::commanded_progress::Steps;
use toolglide_fir::FilterChain;
use toolglide_kinematics::{AxesPiece, Axis, PoseFeed, PoseLeg, PosePath, PosePiece};

impl PosePlanner<'_> {
    /// Every axis for itself between the poses of the blocks, and `way_points` between them.
    pub(super) fn plan_joints(
        &mut self,
        row: &[Section],
        way_points: u32,
    ) -> Result<(), FiveAxisError> {
        let chain = self.settings.chain().clone();
        let parts = f64::from(way_points) + 1.0;
        let mut joints = Vec::new();
        for Section { block, way } in row {
            let mut block = *block;
            if self.settings.keeps_axis_limits() {
                let straight = JointBlock::between(&block, *way.first(), *way.last());
                let (least, _) = straight.least_duration(&self.axes, &chain);
                block.duration = block.duration.max(least);
            }
            let mut start = *way.first();
            let mut part = 1.0;
            while part <= parts {
                let share = part / parts;
                let end = if part < parts {
                    block.axes(share, self.machine, &start)?
                } else {
                    *way.last()
                };
                let mut joint = JointBlock::between(&block, start, end);
                joint.duration /= parts;
                joints.push(joint);
                start = end;
                part += 1.0;
            }
        }
        let overlap = chain.total_delay();
        self.lay_joints(joints, &chain, overlap)
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
            let asked = match leg.feed {
                PoseFeed::Rapid => 0.0,
                PoseFeed::Duration(duration) => duration,
                PoseFeed::Speed(feedrate) => way_length(&self.axes, leg) / feedrate.speed(),
            };
            block.duration = asked;
            let spans = start.iter().zip(end.iter());
            if spans.fold(0.0, |most: f64, (start, end)| most.max((end - start).abs())) > 0.0 {
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
        for mut block in joints {
            let (chain, least) = self.fastest_chain(&block);
            block.duration = block.duration.max(least);
            if block.duration > 0.0 {
                self.lay_joints(vec![block], &chain, 0.0)?;
            }
        }
        Ok(())
    }

    /// The chain with which a straight move of axes is over first, and how long its pulse lasts at least.
    fn fastest_chain(&self, block: &JointBlock) -> (FilterChain, f64) {
        let mut choice = Choice::of_straight(&self.settings, &self.axes, block);
        let mut best: Option<(FilterChain, f64)> = None;
        let lasts =
            |chain: &FilterChain, least: f64| block.duration.max(least) + chain.total_delay();
        while let Some(chain) = choice.next(None) {
            let (least, _) = block.least_duration(&self.axes, &chain);
            let shorter =
                |(other, bound): &(FilterChain, f64)| lasts(&chain, least) < lasts(other, *bound);
            if best.as_ref().is_none_or(shorter) {
                best = Some((chain, least));
            }
        }
        best.unwrap_or_else(|| (self.settings.chain().clone(), 0.0))
    }

    fn lay_joints(
        &mut self,
        blocks: Vec<JointBlock>,
        chain: &FilterChain,
        overlap: f64,
    ) -> Result<(), FiveAxisError> {
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
        let took = steps.last().map_or(0.0, Steps::command_end) + chain.total_delay();
        self.usage.add(chain, took);
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
fn way_length(axes: &[Axis], leg: &PoseLeg) -> f64 {
    let (linear, rotary) = leg.way_of_axes(axes);
    if linear > 0.0 {
        linear
    } else {
        rotary.to_degrees()
    }
}
