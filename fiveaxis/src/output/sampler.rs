//! Samples pose motion: tool pose and axis positions at exact instants.
//!
//! Source: tick `k` stands at `k` times the period. Not here: planning.

use toolglide_kinematics::{
    AxisVector, KinematicsError, MachineKinematics, PosePiece, SamplePeriod, ToolPose,
};

/// One set-point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseTick {
    /// Time since the start of the motion, s.
    pub time: f64,
    /// Axis positions, mm and rad.
    pub axes: AxisVector,
    /// Pose of the tool.
    pub pose: ToolPose,
}

/// Ticks through pose motion that arrives piece by piece, following it with the axes of a machine.
///
/// A tick does not allocate.
pub struct PoseSampler<'m> {
    machine: &'m dyn MachineKinematics,
    period: f64,
    tick: u64,
    begin: f64,
    end: f64,
    compensation: f64,
    axes: AxisVector,
    piece: Option<PosePiece>,
}

impl std::fmt::Debug for PoseSampler<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PoseSampler")
            .field("tick", &self.tick)
            .field("axes", &self.axes)
            .finish_non_exhaustive()
    }
}

impl<'m> PoseSampler<'m> {
    /// A sampler of motion from the axis positions `start`.
    #[must_use]
    pub fn new(
        machine: &'m dyn MachineKinematics,
        period: SamplePeriod,
        start: AxisVector,
    ) -> Self {
        Self {
            machine,
            period: period.seconds(),
            tick: 0,
            begin: 0.0,
            end: 0.0,
            compensation: 0.0,
            axes: start,
            piece: None,
        }
    }

    /// Takes the piece that follows, once [`PoseSampler::next_tick`] has given `None`.
    pub fn feed(&mut self, piece: PosePiece) {
        self.begin = self.end;
        // At a pole the tool does not tell where an axis is: it stays where its own move has ended, not where the
        // last tick has seen it.
        if let Some(PosePiece::Axes(before)) = &self.piece {
            self.axes = before.end;
        }
        // Compensated sum: ten million pieces add up as well as ten.
        let step = piece.duration() - self.compensation;
        let sum = self.end + step;
        self.compensation = (sum - self.end) - step;
        self.end = sum;
        self.piece = Some(piece);
    }

    /// The next set-point inside the current piece; `None` when the next piece is needed.
    ///
    /// # Errors
    /// [`KinematicsError`] when the machine cannot take the pose.
    #[inline]
    #[allow(
        clippy::cast_precision_loss,
        reason = "ticks stay below 2^53 for a hundred thousand years"
    )]
    pub fn next_tick(&mut self) -> Option<Result<PoseTick, KinematicsError>> {
        let time = self.tick as f64 * self.period;
        if time >= self.end {
            return None;
        }
        self.tick += 1;
        Some(self.at(time, time - self.begin))
    }

    /// The set-point at the end of the motion given so far; `None` before any.
    ///
    /// # Errors
    /// [`KinematicsError`] when the machine cannot take the pose.
    pub fn last(&mut self) -> Option<Result<PoseTick, KinematicsError>> {
        let duration = self.piece.as_ref()?.duration();
        Some(self.at(self.end, duration))
    }

    /// Time at which the motion given so far ends.
    #[must_use]
    pub fn end_time(&self) -> f64 {
        self.end
    }

    #[inline]
    fn at(&mut self, time: f64, since: f64) -> Result<PoseTick, KinematicsError> {
        let pose = match &self.piece {
            Some(PosePiece::Tool(piece)) => {
                let pose = piece.at(since);
                self.axes = self.machine.follow(&pose, &self.axes)?;
                pose
            }
            Some(PosePiece::Rotary(piece)) => {
                let (tip, at) = piece.at(since, &self.axes);
                self.axes = self.machine.place(&tip, &at)?;
                self.machine.forward(&self.axes)?
            }
            Some(PosePiece::Axes(piece)) => {
                piece.at(since, &mut self.axes);
                self.machine.forward(&self.axes)?
            }
            None => self.machine.forward(&self.axes)?,
        };
        Ok(PoseTick {
            time,
            axes: self.axes,
            pose,
        })
    }
}
