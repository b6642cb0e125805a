//! Plans legs of poses into pieces of motion, one section between two rests at a time.
//!
//! Source: sections 5.2 and 5.3. Not here: the formulas of corners, timing and limits.

mod choice;
mod joints;
mod race;
mod row;
mod tool;
mod usage;

use crate::error::FiveAxisError;
use crate::output::pieces::rest;
use crate::settings::PoseSettings;
use std::collections::VecDeque;
use toolglide_kinematics::{
    Axis, AxisVector, MachineKinematics, PoseLeg, PosePath, PosePiece, ToolPose,
};
use usage::Usage;

/// Most legs of a stretch: a longer one is planned in parts that rest in between, so that memory is
/// bounded. A rest every four thousand moves costs less than a ten-thousandth of the time.
const MAX_LEGS: usize = 4096;

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
    usage: Usage,
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
            usage: Usage::default(),
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
        let kind = |leg: &PoseLeg| std::mem::discriminant(&leg.path);
        if let Some((_, before)) = self.pending.last()
            && kind(before) != kind(&leg)
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
        if stops || self.pending.len() >= MAX_LEGS {
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

    /// Time constants of the filters that the motion passed through for the longest time, s, the longer first; `None`
    /// before any motion.
    #[must_use]
    pub fn usual_filters(&self) -> Option<[f64; 2]> {
        self.usage.most()
    }

    /// Whether all motion passed through the same filters.
    #[must_use]
    pub fn has_one_chain(&self) -> bool {
        self.usage.is_one()
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
}
