//! What a machine is to a planner: axes, and the map between axis positions and tool pose.
//!
//! Source: section 5.2 for the map; linear machines of chapters 2 to 4 are the identity. Not here:
//! machines themselves.

use crate::limits::AxisLimits;
use crate::pose::ToolPose;
use crate::sample::SamplePeriod;
use crate::tolerance::Tolerance;
use thiserror::Error;

/// What an axis moves in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisKind {
    /// mm.
    Linear,
    /// rad.
    Rotary,
}

/// One axis of a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Letter of the axis as programs write it.
    pub name: char,
    /// What it moves in.
    pub kind: AxisKind,
    /// Its limits.
    pub limits: AxisLimits,
    /// Lowest and highest position; `None` where there is no end.
    pub travel: Option<(f64, f64)>,
}

/// A position for each axis of a machine, in machine order.
pub type AxisVector = nalgebra::DVector<f64>;

/// A machine: its axes, and the map between axis positions and tool pose.
pub trait MachineKinematics: Send + Sync {
    /// The axes, in machine order.
    fn axes(&self) -> &[Axis];

    /// Tolerance to use where a program asks for none.
    fn default_tolerance(&self) -> Tolerance;

    /// Period of the set-points where none is asked for.
    fn set_point_period(&self) -> SamplePeriod;

    /// Tool pose at axis positions (one per axis, in machine order).
    ///
    /// # Errors
    /// [`KinematicsError::AxisCount`] when the positions are not one per axis.
    fn forward(&self, axes: &AxisVector) -> Result<ToolPose, KinematicsError>;

    /// Of all axis positions that give `pose`, the one nearest to `near`.
    ///
    /// # Errors
    /// [`KinematicsError::Unreachable`] when the machine cannot take the pose,
    /// [`KinematicsError::Travel`] when an axis would leave its travel.
    fn inverse(&self, pose: &ToolPose, near: &AxisVector) -> Result<AxisVector, KinematicsError>;
}

/// Why a machine cannot take a pose or a position.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum KinematicsError {
    /// Positions must be one per axis.
    #[error("{given} axis positions were given to a machine of {axes} axes")]
    AxisCount {
        /// How many were given.
        given: usize,
        /// How many axes there are.
        axes: usize,
    },
    /// The machine has no axes for this pose.
    #[error("the machine cannot take this pose: {reason}")]
    Unreachable {
        /// What is missing.
        reason: &'static str,
    },
    /// An axis would leave its travel.
    #[error("axis {axis}: position {position} is outside the travel {low} to {high}")]
    Travel {
        /// Letter of the axis.
        axis: char,
        /// Where it would go.
        position: f64,
        /// Lowest position.
        low: f64,
        /// Highest position.
        high: f64,
    },
}
