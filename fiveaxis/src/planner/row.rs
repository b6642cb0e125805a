//! Moves in a row between two rests, and the blocks that they are cut into for a chain of filters.
//!
//! Source: ours. Not here: which chain, and when the blocks are.

use crate::axis_limits::axis_bounds::Worst;
use crate::axis_limits::axis_path::AxisPaths;
use crate::error::FiveAxisError;
use crate::pose::block::PoseBlock;
use crate::settings::PoseSettings;
use crate::timing::goes_on;
use std::sync::Arc;
use toolglide_fir::FilterChain;
use toolglide_kinematics::{Axis, MachineKinematics};

/// A move, or what is on one side of a pole of it, with the way of the axes along it. Its duration is the one that
/// was asked for.
pub(super) struct Section {
    pub(super) block: PoseBlock,
    pub(super) way: Arc<AxisPaths>,
}

impl Section {
    /// Whether two sections are of one move.
    pub(super) fn goes_on(&self, next: &Self) -> bool {
        goes_on(&self.block, &next.block)
    }
}

/// Blocks in a row between two rests, with what was asked of each.
#[derive(Default)]
pub(super) struct Cut {
    pub(super) blocks: Vec<PoseBlock>,
    pub(super) ways: Vec<Arc<AxisPaths>>,
    pub(super) asked: Vec<f64>,
    pub(super) met: Vec<Option<Worst>>,
}

impl Cut {
    /// The blocks of a row: a section whole, or in parts where one must be much slower than the others.
    pub(super) fn of(
        row: &[Section],
        machine: &dyn MachineKinematics,
        axes: &[Axis],
        settings: &PoseSettings,
        chain: &FilterChain,
    ) -> Result<Self, FiveAxisError> {
        let keeps = settings.keeps_axis_limits();
        let mut cut = Self::default();
        for Section { block, way } in row {
            let cuts = if keeps {
                way.cuts(axes, block.duration, chain)
            } else {
                Vec::new()
            };
            let slowest = |way: &AxisPaths| {
                if keeps {
                    Some(way.least_duration(axes, chain))
                } else {
                    None
                }
            };
            if cuts.is_empty() {
                cut.take(*block, Arc::clone(way), slowest(way))?;
                continue;
            }
            let mut at = *way.first();
            let mut begin = 0.0;
            for end in cuts.into_iter().chain([1.0]) {
                let part = block.part(begin, end);
                let way = AxisPaths::along(&part, machine, &at)?;
                at = *way.last();
                let slowest = slowest(&way);
                cut.take(part, Arc::new(way), slowest)?;
                begin = end;
            }
        }
        Ok(cut)
    }

    /// Adds a block, slowed down as far as it needs by itself.
    pub(super) fn take(
        &mut self,
        mut block: PoseBlock,
        way: Arc<AxisPaths>,
        slowest: Option<(f64, Worst)>,
    ) -> Result<(), FiveAxisError> {
        self.asked.push(block.duration);
        let mut limit = None;
        if let Some((least, by)) = slowest
            && least > block.duration
        {
            block.duration = least;
            limit = Some(by);
        }
        if !(block.duration > 0.0 && block.duration.is_finite()) {
            return Err(FiveAxisError::NoRate { index: block.leg });
        }
        self.met.push(limit);
        self.blocks.push(block);
        self.ways.push(way);
        Ok(())
    }
}
