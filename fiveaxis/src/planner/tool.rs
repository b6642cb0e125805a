//! Stretches of tool motion, and turns in place between them.
//!
//! Source: sections 5.2 and 5.3. Not here: the formulas of corners, timing and limits.

use super::{NOTABLE, PosePlanner, Slowdown};
use crate::block::PoseBlock;
use crate::error::FiveAxisError;
use crate::follow::Worst;
use crate::joint::JointBlock;
use crate::lay::{intervals, knots, piece};
use crate::pole::{Spin, parts_at_pole};
use crate::relax::{Stretch, relax};
use crate::settings::PoseMethod;
use crate::timing::goes_on;
use crate::tool::ToolStretch;
use crate::way::Way;
use toolglide_kinematics::{PoseLeg, PosePiece};

/// A turn in place is commanded for at least this share of the delay of the chain, which takes the time.
const LEAST_TURN: f64 = 0.01;

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
            if self.goes_straight() {
                let way = Way::along(&block, self.machine, &self.at)?;
                self.take(&mut row, block, way)?;
                continue;
            }
            let (first, second) = parts_at_pole(&block, self.machine)?;
            for part in [Some(first), second].into_iter().flatten() {
                let way = self.way(&part, &mut row)?;
                self.take_parts(&mut row, part, way)?;
            }
        }
        self.plan_row(row)
    }

    /// The way along a block from where the axes are. Where one of them must turn at rest before, the row so
    /// far and that turn are planned.
    fn way(&mut self, block: &PoseBlock, row: &mut Row) -> Result<Way, FiveAxisError> {
        let spin = match Spin::before(block, self.machine, &self.at)? {
            (Some(way), _) => return Ok(way),
            (None, spin) => spin,
        };
        if let Some(spin) = spin {
            self.plan_row(std::mem::take(row))?;
            for mut turn in spin.blocks(block, self.machine)? {
                turn.duration = LEAST_TURN * self.settings.chain().total_delay();
                let way = Way::along(&turn, self.machine, &self.at)?;
                let mut alone = Row::default();
                self.take(&mut alone, turn, way)?;
                self.plan_row(alone)?;
            }
        }
        Way::along(block, self.machine, &self.at)
    }

    /// Whether the axes go straight between the poses, whatever the tool does.
    fn goes_straight(&self) -> bool {
        matches!(self.settings.method(), PoseMethod::JointSpace { .. })
    }

    /// Adds a block to a row: whole, or in parts where one must be much slower than the others.
    fn take_parts(
        &mut self,
        row: &mut Row,
        block: PoseBlock,
        way: Way,
    ) -> Result<(), FiveAxisError> {
        let cuts = if self.settings.keeps_axis_limits() {
            way.cuts(&self.axes, block.duration, self.settings.chain())
        } else {
            Vec::new()
        };
        if cuts.is_empty() {
            return self.take(row, block, way);
        }
        let mut begin = 0.0;
        for end in cuts.into_iter().chain([1.0]) {
            let part = block.part(begin, end);
            let way = Way::along(&part, self.machine, &self.at)?;
            self.take(row, part, way)?;
            begin = end;
        }
        Ok(())
    }

    /// Adds a block to a row, slowed down as far as it needs by itself.
    fn take(&mut self, row: &mut Row, mut block: PoseBlock, way: Way) -> Result<(), FiveAxisError> {
        row.asked.push(block.duration);
        self.at = *way.last();
        let mut limit = None;
        if self.settings.keeps_axis_limits() {
            let (axes, chain) = (&self.axes, self.settings.chain());
            let (least, by) = if self.goes_straight() {
                JointBlock::between(&block, *way.first(), *way.last()).least_duration(axes, chain)
            } else {
                way.least_duration(axes, chain)
            };
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
        let blocks = stretch.blocks;
        self.note(&blocks, &asked, &met);
        Ok(())
    }

    /// Notes the moves that are slower than they were asked to be.
    fn note(&mut self, blocks: &[PoseBlock], asked: &[f64], met: &[Option<Worst>]) {
        let mut first = 0;
        for parts in blocks.chunk_by(goes_on) {
            let range = first..first + parts.len();
            first = range.end;
            let asked: f64 = asked[range.clone()].iter().sum();
            let took: f64 = parts.iter().map(|part| part.duration).sum();
            let slowest = range
                .filter(|&index| met[index].is_some())
                .max_by(|&one, &other| blocks[one].duration.total_cmp(&blocks[other].duration));
            if let Some(worst) = slowest.and_then(|index| met[index])
                && asked > 0.0
                && took > asked * NOTABLE
            {
                self.slowdowns.push(Slowdown {
                    leg: parts[0].leg,
                    line: parts[0].line,
                    factor: took / asked,
                    axis: self.axes.get(worst.axis).map_or('?', |axis| axis.name),
                    quantity: worst.quantity(),
                });
            }
        }
    }
}
