//! From legs of poses to pieces of motion, a stretch between two rests at a time.
//!
//! Source: sections 5.2 and 5.3. Not here: the formulas of corners, timing and limits.

use crate::block::PoseBlock;
use crate::error::FiveAxisError;
use crate::follow::Worst;
use crate::joint::{JointBlock, JointStretch};
use crate::lay::{intervals, knots, piece, rest};
use crate::relax::{Stretch, relax};
use crate::settings::{PoseMethod, PoseSettings};
use crate::tool::ToolStretch;
use crate::way::Way;
use std::collections::VecDeque;
use toolglide_kinematics::{
    AxesPiece, Axis, AxisVector, MachineKinematics, PoseFeed, PoseLeg, PosePath, PosePiece,
    ToolPose,
};

/// Most legs of a stretch: a longer one is planned in parts that rest in between, so that memory is
/// bounded. A rest every four thousand moves costs less than a ten-thousandth of the time.
const MOST_LEGS: usize = 4096;

/// Slower than this factor is worth a word.
const NOTABLE: f64 = 1.001;

/// A move that is slower than its feedrate, and why.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slowdown {
    /// Number of the move, counted from 0.
    pub leg: u32,
    /// Line of the program; 0 for none.
    pub line: u32,
    /// How many times as long it takes.
    pub factor: f64,
    /// Letter of the axis whose limit is met.
    pub axis: char,
    /// Which limit of it.
    pub quantity: &'static str,
}

/// Plans pose motion: legs in, pieces out.
///
/// A stretch of legs is planned when it is known to end at rest: at an exact stop, a dwell, the end
/// of the path, or after some thousand legs.
pub struct PosePlanner<'m> {
    machine: &'m dyn MachineKinematics,
    axes: Vec<Axis>,
    settings: PoseSettings,
    at: AxisVector,
    pose: ToolPose,
    pending: Vec<(u32, PoseLeg)>,
    pieces: VecDeque<PosePiece>,
    slowdowns: Vec<Slowdown>,
    count: u32,
    finished: bool,
}

impl std::fmt::Debug for PosePlanner<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PosePlanner")
            .field("settings", &self.settings)
            .field("at", &self.at)
            .field("count", &self.count)
            .finish_non_exhaustive()
    }
}

impl<'m> PosePlanner<'m> {
    /// A planner for a machine at rest at the axis positions `start`, with the limits of `axes`.
    ///
    /// # Errors
    /// [`FiveAxisError::Machine`] when the machine cannot stand there.
    pub fn new(
        machine: &'m dyn MachineKinematics,
        axes: Vec<Axis>,
        start: AxisVector,
        settings: PoseSettings,
    ) -> Result<Self, FiveAxisError> {
        let pose = machine
            .forward(&start)
            .map_err(|reason| FiveAxisError::Machine { index: 0, reason })?;
        Ok(Self {
            machine,
            axes,
            settings,
            at: start,
            pose,
            pending: Vec::new(),
            pieces: VecDeque::new(),
            slowdowns: Vec::new(),
            count: 0,
            finished: false,
        })
    }

    /// Takes the next leg of the path.
    ///
    /// # Errors
    /// [`FiveAxisError`] names the leg that cannot be planned; what was planned before stays valid.
    pub fn push(&mut self, leg: PoseLeg) -> Result<(), FiveAxisError> {
        let index = self.count;
        if self.finished {
            return Err(FiveAxisError::Finished { index });
        }
        self.count = self.count.saturating_add(1);
        let is_axes = |leg: &PoseLeg| matches!(leg.path, PosePath::Axes { .. });
        if let Some((_, before)) = self.pending.last()
            && is_axes(before) != is_axes(&leg)
        {
            self.plan()?;
        }
        if let PosePath::Dwell { duration } = leg.path {
            self.plan()?;
            if duration > 0.0 {
                self.pieces.push_back(rest(self.pose, duration, index));
            }
            return Ok(());
        }
        let stops = leg.stop;
        self.pending.push((index, leg));
        if stops || self.pending.len() >= MOST_LEGS {
            self.plan()?;
        }
        Ok(())
    }

    /// Says that no leg follows: the motion comes to rest at the end of the last one.
    ///
    /// # Errors
    /// As [`PosePlanner::push`].
    pub fn finish(&mut self) -> Result<(), FiveAxisError> {
        self.finished = true;
        self.plan()
    }

    /// The next piece of finished motion: in order, contiguous, never taken back.
    pub fn pull(&mut self) -> Option<PosePiece> {
        self.pieces.pop_front()
    }

    /// Moves that are slower than their feedrates, in path order; rapids are not among them.
    #[must_use]
    pub fn slowdowns(&self) -> &[Slowdown] {
        &self.slowdowns
    }

    fn plan(&mut self) -> Result<(), FiveAxisError> {
        let legs = std::mem::take(&mut self.pending);
        let Some((_, last)) = legs.last() else {
            return Ok(());
        };
        match &last.path {
            PosePath::Axes { .. } => self.plan_axes(&legs),
            _ => self.plan_tool(&legs),
        }
    }

    fn plan_tool(&mut self, legs: &[(u32, PoseLeg)]) -> Result<(), FiveAxisError> {
        let mut blocks = Vec::with_capacity(legs.len());
        let mut ways = Vec::with_capacity(legs.len());
        let mut asked = Vec::with_capacity(legs.len());
        let mut met: Vec<Option<Worst>> = Vec::with_capacity(legs.len());
        let chain = self.settings.chain();
        for (number, leg) in legs {
            let Some(mut block) = PoseBlock::of(leg, *number, self.settings.turn_rate()) else {
                continue;
            };
            asked.push(block.duration);
            let way = Way::along(&block, self.machine, &self.at)?;
            self.at = *way.last();
            let mut limit = None;
            if self.settings.keeps_axis_limits() {
                let (least, by) = way.least_duration(&self.axes, chain);
                if least > block.duration {
                    block.duration = least;
                    limit = Some(by);
                }
            }
            met.push(limit);
            if !(block.duration > 0.0 && block.duration.is_finite()) {
                return Err(FiveAxisError::NoRate { index: *number });
            }
            blocks.push(block);
            ways.push(way);
        }
        let Some(last) = blocks.last() else {
            return Ok(());
        };
        self.pose = last.pose(1.0)?;
        if let PoseMethod::JointSpace { way_points } = self.settings.method() {
            return self.plan_joints(&blocks, &ways, way_points);
        }
        let count = blocks.len();
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
            note(&mut self.slowdowns, &self.axes, block, asked, met);
        }
        Ok(())
    }

    /// Every axis for itself between the poses of the blocks, and `way_points` between them.
    fn plan_joints(
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
                joints.push(JointBlock {
                    leg: block.leg,
                    line: block.line,
                    start,
                    end,
                    duration: block.duration / parts,
                });
                start = end;
                part += 1.0;
            }
        }
        let overlap = self.settings.chain().total_delay();
        self.lay_joints(joints, overlap)
    }

    fn plan_axes(&mut self, legs: &[(u32, PoseLeg)]) -> Result<(), FiveAxisError> {
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

fn note(
    slowdowns: &mut Vec<Slowdown>,
    axes: &[Axis],
    block: &PoseBlock,
    asked: f64,
    met: Option<Worst>,
) {
    if let Some(met) = met
        && asked > 0.0
        && block.duration > asked * NOTABLE
    {
        slowdowns.push(Slowdown {
            leg: block.leg,
            line: block.line,
            factor: block.duration / asked,
            axis: axes.get(met.axis).map_or('?', |axis| axis.name),
            quantity: met.quantity(),
        });
    }
}

/// Length of a straight move of axes for its feedrate: that of the linear axes, mm, or in degrees of
/// the rotary ones where no linear axis moves.
fn way_length(axes: &[Axis], start: &AxisVector, end: &AxisVector) -> f64 {
    use toolglide_kinematics::AxisKind;
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
