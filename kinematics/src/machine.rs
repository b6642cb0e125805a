//! What a machine is to a planner: axes, and the map between axis positions and tool pose.
//!
//! Source: section 5.2 for the map; linear machines of chapters 2 to 4 are the identity. Not here:
//! machines themselves.

use crate::axis_vector::{AxisVector, Solutions};
use crate::limits::AxisLimits;
use crate::numeric::ANGLE_SLACK;
use crate::pose::ToolPose;
use crate::sample::SamplePeriod;
use crate::tolerance::Tolerance;
use crate::vector::Vector;
use std::f64::consts::{PI, TAU};
use thiserror::Error;

/// What an axis moves in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisKind {
    /// mm.
    Linear,
    /// rad.
    Rotary,
}

impl AxisKind {
    /// Unit of its positions inside the libraries, "mm" or "rad".
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Linear => "mm",
            Self::Rotary => "rad",
        }
    }
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

/// A machine: its axes, and the map between axis positions and tool pose.
pub trait MachineKinematics: Send + Sync {
    /// The axes, in machine order.
    fn axes(&self) -> &[Axis];

    /// Tolerance to use where a program asks for none.
    fn default_tolerance(&self) -> Tolerance;

    /// Period of the set-points where none is asked for.
    fn set_point_period(&self) -> SamplePeriod;

    /// Tool pose at axis positions (one per axis, in machine order), whether they are within
    /// travel or not.
    ///
    /// # Errors
    /// [`KinematicsError::AxisCount`] when the positions are not one per axis,
    /// [`KinematicsError::NotFinite`] when one of them is no finite number, and
    /// [`KinematicsError::Reach`] when the structure cannot be put together at these positions.
    fn forward(&self, axes: &AxisVector) -> Result<ToolPose, KinematicsError>;

    /// Of all axis positions within travel that give `pose`, those nearest to `near`.
    ///
    /// Nearest counts the rotary axes: each is taken on the turn nearest to `near`, and among the
    /// branches the one with the least sum of squares. Where a rotary axis does not matter, as at
    /// the pole of a rotary table, it stays as in `near`. Where the nearest turn is beyond the travel,
    /// the nearest within is taken, which is right for a new start and a jump in the midst of a
    /// motion: for that there is [`MachineKinematics::follow`]. It does not allocate.
    ///
    /// # Errors
    /// [`KinematicsError::Unreachable`] or [`KinematicsError::Reach`] when the machine cannot take
    /// the pose, [`KinematicsError::Travel`] when an axis would leave its travel, and what
    /// [`MachineKinematics::forward`] says of `near`.
    fn inverse(&self, pose: &ToolPose, near: &AxisVector) -> Result<AxisVector, KinematicsError>;

    /// As [`MachineKinematics::inverse`], for a pose a small motion away from `near`: the nearest
    /// branch on the nearest turn, or nothing. An axis that could stay within its travel only by a
    /// turn back, or in another branch, has come to its end.
    ///
    /// A machine with several branches says this itself; without that, whole turns are looked for.
    ///
    /// # Errors
    /// As [`MachineKinematics::inverse`]; [`KinematicsError::Travel`] names the axis that has come
    /// to its end, and where it would have gone.
    fn follow(&self, pose: &ToolPose, near: &AxisVector) -> Result<AxisVector, KinematicsError> {
        let axes = self.inverse(pose, near)?;
        for (axis, (&position, &before)) in self.axes().iter().zip(axes.iter().zip(near.iter())) {
            let step = position - before;
            if axis.kind == AxisKind::Rotary && step.abs() > PI + ANGLE_SLACK {
                let (low, high) = axis.travel.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
                return Err(KinematicsError::Travel {
                    axis: axis.name,
                    kind: axis.kind,
                    position: position - TAU * (step / TAU).round(),
                    low,
                    high,
                });
            }
        }
        Ok(axes)
    }

    /// The pole next to a tool orientation: the orientation at which one axis may stand anywhere, and beside
    /// which it turns the faster the nearer the tool is. `None` for a machine that has none, or does not
    /// say.
    fn pole(&self, orientation: &Vector<3>) -> Option<Vector<3>> {
        let _ = orientation;
        None
    }

    /// The axis positions of every branch that can take `pose` within travel, the nearest to `near`
    /// first. It does not allocate.
    ///
    /// Each rotary axis is on the turn nearest to `near` within its travel; other turns are for the
    /// caller to try. A machine with one branch needs not say more than [`MachineKinematics::inverse`].
    ///
    /// # Errors
    /// As [`MachineKinematics::inverse`], when there is no branch.
    fn solutions(&self, pose: &ToolPose, near: &AxisVector) -> Result<Solutions, KinematicsError> {
        self.inverse(pose, near).map(Solutions::from)
    }
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
    /// A position must be a finite number.
    #[error("axis {axis}: position {position} is not a finite number")]
    NotFinite {
        /// Letter of the axis.
        axis: char,
        /// The position.
        position: f64,
    },
    /// The machine has no axes for this pose.
    #[error("the machine cannot take this pose: {reason}")]
    Unreachable {
        /// What is missing.
        reason: &'static str,
    },
    /// A part of the structure cannot span as much, or as little, as the pose asks of it.
    #[error(
        "out of reach: {part} would span {distance} mm, but can span {low} to {high} mm; {} mm too {}",
        beyond(*distance, *low, *high),
        if distance > high { "far" } else { "near" }
    )]
    Reach {
        /// Which part.
        part: &'static str,
        /// What it would have to span, mm.
        distance: f64,
        /// The least that it spans, mm.
        low: f64,
        /// The most that it spans, mm.
        high: f64,
    },
    /// An axis would leave its travel.
    #[error(
        "axis {axis}: position {position} is outside the travel {low} to {high} {} by {}",
        kind.unit(),
        beyond(*position, *low, *high)
    )]
    Travel {
        /// Letter of the axis.
        axis: char,
        /// What the axis moves in.
        kind: AxisKind,
        /// Where it would go.
        position: f64,
        /// Lowest position.
        low: f64,
        /// Highest position.
        high: f64,
    },
}

/// How far a value is outside an interval.
fn beyond(value: f64, low: f64, high: f64) -> f64 {
    (low - value).max(value - high)
}
