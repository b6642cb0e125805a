//! Stretches of tool motion, and turns in place between them.
//!
//! Source: sections 5.2 and 5.3. Not here: the formulas of corners, timing and limits.

use super::{NOTABLE, PosePlanner, Slowdown};
use crate::block::PoseBlock;
use crate::error::FiveAxisError;
use crate::follow::Worst;
use crate::lay::{intervals, knots, piece};
use crate::pole::Spin;
use crate::relax::{Stretch, relax};
use crate::settings::PoseMethod;
use crate::tool::ToolStretch;
use crate::way::Way;
use toolglide_kinematics::{PoseLeg, PosePiece};

/// Blocks in a row between two rests, with what was asked of each.
#[derive(Default)]
struct Row {
    blocks: Vec<PoseBlock>,
    ways: Vec<Way>,
    asked: Vec<f64>,
    met: Vec<Option<Worst>>,
}

impl PosePlanner<'_> {
    pub(super) fn plan_tool(&mut self, legs: &[(u32, PoseLeg)]) -> Result<(), FiveAxisError> {
        let mut row = Row::default();
        for (number, leg) in legs {
            let Some(block) = PoseBlock::of(leg, *number, self.settings.turn_rate()) else {
                continue;
            };
            let way = match Spin::before(&block, self.machine, &self.at)? {
                (Some(way), _) => way,
                (None, None) => Way::along(&block, self.machine, &self.at)?,
                (None, Some(spin)) => {
                    self.plan_row(std::mem::take(&mut row))?;
                    for mut turn in spin.blocks(&block, self.machine)? {
                        if !self.settings.keeps_axis_limits() {
                            turn.duration = self.settings.chain().total_delay();
                        }
                        let way = Way::along(&turn, self.machine, &self.at)?;
                        let mut alone = Row::default();
                        self.take(&mut alone, turn, way)?;
                        self.plan_row(alone)?;
                    }
                    Way::along(&block, self.machine, &self.at)?
                }
            };
            self.take(&mut row, block, way)?;
        }
        self.plan_row(row)
    }

    /// Adds a block to a row, slowed down as far as it needs by itself.
    fn take(&mut self, row: &mut Row, mut block: PoseBlock, way: Way) -> Result<(), FiveAxisError> {
        row.asked.push(block.duration);
        self.at = *way.last();
        let mut limit = None;
        if self.settings.keeps_axis_limits() {
            let (least, by) = way.least_duration(&self.axes, self.settings.chain());
            if least > block.duration {
                block.duration = least;
                limit = Some(by);
            }
        }
        row.met.push(limit);
        if !(block.duration > 0.0 && block.duration.is_finite()) {
            return Err(FiveAxisError::NoRate { index: block.leg });
        }
        row.blocks.push(block);
        row.ways.push(way);
        Ok(())
    }

    fn plan_row(&mut self, row: Row) -> Result<(), FiveAxisError> {
        let Row {
            blocks,
            ways,
            asked,
            mut met,
        } = row;
        let Some(last) = blocks.last() else {
            return Ok(());
        };
        self.pose = last.pose(1.0)?;
        if let PoseMethod::JointSpace { way_points } = self.settings.method() {
            return self.plan_joints(&blocks, &ways, way_points);
        }
        let (count, chain) = (blocks.len(), self.settings.chain());
        let mut stretch = ToolStretch::new(self.machine, &self.axes, &self.settings, blocks, ways)?;
        let steps = if self.settings.keeps_axis_limits() {
            relax(&mut stretch, chain, &self.axes, &mut met)?
        } else {
            stretch.steps(&vec![true; count])
        };
        let knots = knots(&steps, chain);
        for (interval, range) in intervals(&steps, &knots, chain) {
            self.pieces.push_back(PosePiece::Tool(piece(
                &stretch.blocks,
                &steps,
                chain,
                interval,
                range,
            )));
        }
        for ((block, asked), met) in stretch.blocks.iter().zip(asked).zip(met) {
            if let Some(met) = met
                && asked > 0.0
                && block.duration > asked * NOTABLE
            {
                self.slowdowns.push(Slowdown {
                    leg: block.leg,
                    line: block.line,
                    factor: block.duration / asked,
                    axis: self.axes.get(met.axis).map_or('?', |axis| axis.name),
                    quantity: met.quantity(),
                });
            }
        }
        Ok(())
    }
}
