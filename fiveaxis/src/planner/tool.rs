//! Plans sections of tool motion, with turns in place between them.
//!
//! Source: sections 5.2 and 5.3. Not here: the formulas of corners, timing and limits.

use super::race::{Contender, Race};
use super::row::Section;
use super::{NOTABLE, PosePlanner, Slowdown};
use crate::axis_limits::axis_bounds::Worst;
use crate::axis_limits::axis_path::AxisPaths;
use crate::error::FiveAxisError;
use crate::pose::block::PoseBlock;
use crate::pose::swing::weigh;
use crate::settings::PoseMethod;
use crate::singularity::{Spin, parts_at_pole};
use crate::timing::goes_on;
use std::sync::Arc;
use toolglide_kinematics::PoseLeg;

/// A turn in place is commanded for at least this share of the delay of the chain, which takes the time.
const MIN_TURN: f64 = 0.01;

impl PosePlanner<'_> {
    pub(super) fn plan_tool(&mut self, legs: &[(u32, PoseLeg)]) -> Result<(), FiveAxisError> {
        let mut row = Vec::new();
        let of =
            |(number, leg): &(u32, PoseLeg)| PoseBlock::of(leg, *number, self.settings.turn_rate());
        let mut blocks: Vec<PoseBlock> = legs.iter().filter_map(of).collect();
        weigh(&mut blocks, self.machine)?;
        for block in blocks {
            if self.goes_straight() {
                let way = AxisPaths::along(&block, self.machine, &self.at)?;
                self.take(&mut row, block, way);
                continue;
            }
            let (first, second) = parts_at_pole(&block, self.machine)?;
            for part in [Some(first), second].into_iter().flatten() {
                let way = self.way(&part, &mut row)?;
                self.take(&mut row, part, way);
            }
        }
        self.plan_row(row)
    }

    fn take(&mut self, row: &mut Vec<Section>, block: PoseBlock, way: AxisPaths) {
        self.at = *way.last();
        let way = Arc::new(way);
        row.push(Section { block, way });
    }

    /// The way along a block from where the axes are. Where one of them must turn at rest before, the row so
    /// far and that turn are planned.
    fn way(
        &mut self,
        block: &PoseBlock,
        row: &mut Vec<Section>,
    ) -> Result<AxisPaths, FiveAxisError> {
        let spin = match Spin::before(block, self.machine, &self.at)? {
            (Some(way), _) => return Ok(way),
            (None, spin) => spin,
        };
        if let Some(spin) = spin {
            self.plan_row(std::mem::take(row))?;
            for mut turn in spin.blocks(block, self.machine)? {
                turn.duration = MIN_TURN * self.settings.chain().total_delay();
                let way = AxisPaths::along(&turn, self.machine, &self.at)?;
                let mut alone = Vec::new();
                self.take(&mut alone, turn, way);
                self.plan_row(alone)?;
            }
        }
        AxisPaths::along(block, self.machine, &self.at)
    }

    /// Whether the axes go straight between the poses, whatever the tool does.
    fn goes_straight(&self) -> bool {
        matches!(self.settings.method(), PoseMethod::JointSpace { .. })
    }

    fn plan_row(&mut self, row: Vec<Section>) -> Result<(), FiveAxisError> {
        let Some(last) = row.last() else {
            return Ok(());
        };
        self.pose =
            self.machine
                .forward(last.way.last())
                .map_err(|reason| FiveAxisError::Machine {
                    index: last.block.leg,
                    reason,
                })?;
        if let PoseMethod::JointSpace { way_points } = self.settings.method() {
            return self.plan_joints(&row, way_points);
        }
        let race = Race {
            machine: self.machine,
            axes: &self.axes,
            settings: &self.settings,
        };
        for won in race.run(&row)? {
            self.lay(&won);
        }
        Ok(())
    }

    /// Makes pieces of a motion from rest to rest.
    fn lay(&mut self, won: &Contender) {
        self.pieces.extend(won.pieces(&self.axes));
        self.usage.add(&won.chain, won.duration());
        self.note(&won.blocks, &won.asked, &won.met);
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
