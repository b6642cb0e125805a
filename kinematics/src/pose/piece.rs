//! Represents motion of tool or axes between two knots.
//!
//! Source: section 5.2. Two moving averages make every angle and every coordinate a polynomial of
//! the third degree between knots; the orientation is a product of rotations, so that it has unit
//! length at every instant. Not here: which method made it.

use crate::axis_vector::AxisVector;
use crate::machine::{KinematicsError, MachineKinematics};
#[cfg(not(feature = "std"))]
use crate::no_std::*;
use crate::piece::MoveRange;
use crate::pose::great_circle::turned;
use crate::pose::tool_pose::ToolPose;
use crate::sample::Sample;
use crate::vector::Vector;

/// A polynomial of the third degree in time: its coefficients by increasing powers.
pub type CubicInTime = [f64; 4];

/// Value of a polynomial at a time since the start of its piece.
#[must_use]
#[inline]
pub fn cubic_at(cubic: &CubicInTime, time: f64) -> f64 {
    cubic[0] + (cubic[1] + (cubic[2] + cubic[3] * time) * time) * time
}

/// A rotation whose angle changes with time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Axis in workpiece coordinates, of unit length.
    pub axis: Vector<3>,
    /// Angle, rad.
    pub angle: CubicInTime,
}

/// Tool tip and tool orientation over a stretch of time.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolPiece {
    /// State of the tool tip at the start; its jerk is that of the whole piece.
    pub tip: Sample<3>,
    /// Orientation before the turns, of unit length.
    pub base: Vector<3>,
    /// The turns, the one done first in front.
    pub turns: Vec<Turn>,
    /// The pose at the end, exactly.
    pub end: ToolPose,
    /// How long it lasts, s.
    pub duration: f64,
    /// The moves that it follows.
    pub serves: MoveRange,
}

impl ToolPiece {
    /// Pose at a time since the start of the piece; the end exactly when it is over.
    #[must_use]
    #[inline]
    pub fn at(&self, time: f64) -> ToolPose {
        if time >= self.duration {
            return self.end;
        }
        self.extended(time.max(0.0))
    }

    /// Pose by the polynomials of the piece at any time, outside of it, too.
    #[must_use]
    #[inline]
    pub fn extended(&self, time: f64) -> ToolPose {
        let tip = tip_at(&self.tip, time);
        let mut orientation = self.base;
        for turn in &self.turns {
            orientation = turned(&orientation, &turn.axis, cubic_at(&turn.angle, time));
        }
        ToolPose::rounded(tip, orientation)
    }
}

/// Axis positions over a stretch of time.
#[derive(Clone, Debug, PartialEq)]
pub struct AxesPiece {
    /// Position of each axis against time, in machine order.
    pub positions: Vec<CubicInTime>,
    /// Axis positions at the end, exactly.
    pub end: AxisVector,
    /// How long it lasts, s.
    pub duration: f64,
    /// The moves that it follows.
    pub serves: MoveRange,
}

impl AxesPiece {
    /// Axis positions at a time since the start of the piece; the end exactly when it is over.
    #[inline]
    pub fn at(&self, time: f64, into: &mut AxisVector) {
        if time >= self.duration {
            *into = self.end;
            return;
        }
        for (position, cubic) in into.iter_mut().zip(&self.positions) {
            *position = cubic_at(cubic, time.max(0.0));
        }
    }
}

/// Tool tip and rotary axes over a stretch of time: the linear axes follow.
#[derive(Clone, Debug, PartialEq)]
pub struct RotaryPiece {
    /// State of the tool tip at the start; its jerk is that of the whole piece.
    pub tip: Sample<3>,
    /// Position of each rotary axis against time, in machine order; none for linear axes.
    pub rotary: Vec<Option<CubicInTime>>,
    /// Tool tip at the end, exactly.
    pub end_tip: Vector<3>,
    /// Positions at the end, exactly; those of linear axes are not looked at.
    pub end: AxisVector,
    /// How long it lasts, s.
    pub duration: f64,
    /// The moves that it follows.
    pub serves: MoveRange,
}

impl RotaryPiece {
    /// Tool tip at a time since the start of the piece, and axis positions whose rotary axes are as they are then;
    /// the linear axes are as in `near`. Exactly the end when it is over.
    #[inline]
    #[must_use]
    pub fn at(&self, time: f64, near: &AxisVector) -> (Vector<3>, AxisVector) {
        if time < self.duration {
            return self.extended(time.max(0.0), near);
        }
        let mut axes = *near;
        for ((axis, end), cubic) in axes.iter_mut().zip(self.end.iter()).zip(&self.rotary) {
            if cubic.is_some() {
                *axis = *end;
            }
        }
        (self.end_tip, axes)
    }

    /// The same by the polynomials of the piece at any time, outside of it, too.
    #[inline]
    #[must_use]
    pub fn extended(&self, time: f64, near: &AxisVector) -> (Vector<3>, AxisVector) {
        let mut axes = *near;
        for (axis, cubic) in axes.iter_mut().zip(&self.rotary) {
            if let Some(cubic) = cubic {
                *axis = cubic_at(cubic, time);
            }
        }
        (tip_at(&self.tip, time), axes)
    }
}

fn tip_at(start: &Sample<3>, time: f64) -> Vector<3> {
    start.position
        + (start.velocity + (start.acceleration * 0.5 + start.jerk * (time / 6.0)) * time) * time
}

/// A stretch of motion: of the tool, which a machine follows, or of the axes themselves.
#[derive(Clone, Debug, PartialEq)]
pub enum PosePiece {
    /// Motion of the tool in workpiece coordinates.
    Tool(ToolPiece),
    /// Motion of the tool tip, with the rotary axes of a machine.
    Rotary(RotaryPiece),
    /// Motion of the axes of a machine.
    Axes(AxesPiece),
}

impl PosePiece {
    /// How long it lasts, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        match self {
            Self::Tool(piece) => piece.duration,
            Self::Rotary(piece) => piece.duration,
            Self::Axes(piece) => piece.duration,
        }
    }

    /// Axis positions by the polynomials of the piece at any time since its start, also outside of it, of a machine
    /// that is near `near`.
    ///
    /// # Errors
    /// What the machine says of the pose.
    #[inline]
    pub fn extended(
        &self,
        time: f64,
        machine: &dyn MachineKinematics,
        near: &AxisVector,
    ) -> Result<AxisVector, KinematicsError> {
        match self {
            Self::Tool(piece) => machine.follow(&piece.extended(time), near),
            Self::Rotary(piece) => {
                let (tip, at) = piece.extended(time, near);
                machine.place(&tip, &at)
            }
            Self::Axes(piece) => {
                let mut at = piece.end;
                for (position, cubic) in at.iter_mut().zip(&piece.positions) {
                    *position = cubic_at(cubic, time);
                }
                Ok(at)
            }
        }
    }

    /// The moves that it follows.
    #[must_use]
    pub fn serves(&self) -> MoveRange {
        match self {
            Self::Tool(piece) => piece.serves,
            Self::Rotary(piece) => piece.serves,
            Self::Axes(piece) => piece.serves,
        }
    }
}
