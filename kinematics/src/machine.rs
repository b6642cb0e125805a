//! Defines the seam to a machine: axes, and the map between axis positions and tool pose.
//!
//! Source: section 5.2 for the map; linear machines of chapters 2 to 4 are the identity. Not here:
//! machines themselves.

use crate::axis_vector::{AxisVector, MAX_AXES, Solutions};
use crate::limits::AxisLimits;
#[cfg(not(feature = "std"))]
use crate::no_std::*;
use crate::numeric::{ANGLE_SLACK, LENGTH_SLACK};
use crate::pose::tool_pose::ToolPose;
use crate::sample::SamplePeriod;
use crate::tolerance::Tolerance;
use crate::vector::Vector;
use core::f64::consts::{FRAC_PI_2, PI, TAU};
use nalgebra::Matrix3;
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

    /// Axis positions with every rotary axis as in `near` and the tool tip at `tip`: the linear part of the inverse
    /// kinematics, which has no branch, no pole and no turn to choose. It does not allocate.
    ///
    /// With the rotary axes at rest the tip goes straight and evenly with each linear axis, so that
    /// [`MachineKinematics::forward`] says it without any knowledge of the structure.
    ///
    /// # Errors
    /// [`KinematicsError::Unreachable`] for a machine that has not three linear axes that span space,
    /// [`KinematicsError::Travel`] when an axis would be outside its travel, and what
    /// [`MachineKinematics::forward`] says of `near`.
    fn place(&self, tip: &Vector<3>, near: &AxisVector) -> Result<AxisVector, KinematicsError> {
        placed(self.axes(), |axes| self.forward(axes), tip, near)
    }

    /// Directions in which the tool orientation moves with each rotary axis, for one radian; zero for linear axes.
    /// Their lengths are the sines of the angles between the tool and the axes.
    ///
    /// The orientation goes around a circle with each rotary axis, so that half the difference of two points of
    /// it a half turn apart is exact. It does not allocate.
    ///
    /// # Errors
    /// What [`MachineKinematics::forward`] says of `at`.
    fn swings(&self, at: &AxisVector) -> Result<[Vector<3>; MAX_AXES], KinematicsError> {
        let mut swings = [Vector::zeros(); MAX_AXES];
        for (axis, limits) in self.axes().iter().enumerate() {
            if limits.kind != AxisKind::Rotary {
                continue;
            }
            let mut turned = *at;
            turned[axis] = at[axis] + FRAC_PI_2;
            let ahead = self.forward(&turned)?.orientation();
            turned[axis] = at[axis] - FRAC_PI_2;
            swings[axis] = (ahead - self.forward(&turned)?.orientation()) * 0.5;
        }
        Ok(swings)
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

/// By how much a linear axis is moved to see where the tip goes, mm: a power of two, for the rounding.
const PROBE: f64 = 128.0;

/// How often the tip is brought nearer to where it should be: the first time leaves rounding alone.
const PLACINGS: u32 = 3;

/// Axis positions with the tip at `tip` and the rotary axes as they are.
fn placed(
    axes: &[Axis],
    forward: impl Fn(&AxisVector) -> Result<ToolPose, KinematicsError>,
    tip: &Vector<3>,
    near: &AxisVector,
) -> Result<AxisVector, KinematicsError> {
    let unreachable = KinematicsError::Unreachable {
        reason: "it has not three linear axes that take the tip everywhere",
    };
    let mut linear = [0; 3];
    let mut count = 0;
    for (index, axis) in axes.iter().enumerate() {
        if axis.kind == AxisKind::Linear {
            let Some(place) = linear.get_mut(count) else {
                return Err(unreachable);
            };
            *place = index;
            count += 1;
        }
    }
    if count < 3 {
        return Err(unreachable);
    }
    let here = forward(near)?.tip();
    let mut ways = Matrix3::zeros();
    for (column, &axis) in linear.iter().enumerate() {
        let mut moved = *near;
        moved[axis] += PROBE;
        ways.set_column(column, &((forward(&moved)?.tip() - here) / PROBE));
    }
    let Some(inverse) = ways.try_inverse() else {
        return Err(unreachable);
    };
    let mut at = *near;
    let mut miss = tip - here;
    for placing in 1..=PLACINGS {
        let steps = inverse * miss;
        for (axis, step) in linear.iter().zip(steps.iter()) {
            at[*axis] += step;
        }
        if placing < PLACINGS {
            miss = tip - forward(&at)?.tip();
        }
    }
    for (axis, &position) in axes.iter().zip(at.iter()) {
        let slack = match axis.kind {
            AxisKind::Linear => LENGTH_SLACK,
            AxisKind::Rotary => ANGLE_SLACK,
        };
        if let Some((low, high)) = axis.travel
            && !(low - slack..=high + slack).contains(&position)
        {
            return Err(KinematicsError::Travel {
                axis: axis.name,
                kind: axis.kind,
                position,
                low,
                high,
            });
        }
    }
    Ok(at)
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
