//! Separates the structure of a machine from what all machines share: signs, zeros, turns, travel.
//!
//! Source: the map of section 5.2 between joints and tool pose is the machine's own ([`Structure`]);
//! signs and zeros of axes, whole turns, travel, the workpiece zero and the choice among branches
//! are the same for all ([`Assembly`]). Not here: any machine.

use crate::config::{AxisConfig, MachineConfig, file_unit};
use crate::error::MachineError;
use toolglide_kinematics::numeric::{ANGLE_SLACK, LENGTH_SLACK};
use toolglide_kinematics::{
    Axis, AxisKind, AxisVector, KinematicsError, MAX_SOLUTIONS, MachineKinematics, SamplePeriod,
    Solutions, Tolerance, ToolPose, Vector,
};

/// A tool that leans by less than this points straight up, rad: some thousand roundings of a unit
/// vector.
const UPRIGHT: f64 = 1e-12;

/// The map between the `N` joints of a machine and the pose of its tool.
///
/// A joint is an axis as the mathematics likes it: its own zero, its own sign, no ends, any turn. Joints
/// are in mm and rad, in machine order; poses are in machine coordinates, from a workpiece zero
/// that [`Assembly`] adds.
pub trait Structure<const N: usize>: Send + Sync {
    /// Tool tip, mm, and tool orientation, of unit length but for rounding, at finite joints.
    ///
    /// # Errors
    /// [`KinematicsError::Reach`] when the structure cannot be put together at these joints.
    fn tool(&self, joints: &[f64; N]) -> Result<(Vector<3>, Vector<3>), KinematicsError>;

    /// All branches that give the pose; a joint that does not matter stays as in `near`.
    ///
    /// # Errors
    /// [`KinematicsError::Unreachable`] or [`KinematicsError::Reach`] when there is none.
    fn branches(&self, pose: &ToolPose, near: &[f64; N]) -> Result<Branches<N>, KinematicsError>;

    /// The pole next to an orientation, as [`MachineKinematics::pole`] says.
    fn pole(&self, orientation: &Vector<3>) -> Option<Vector<3>> {
        let _ = orientation;
        None
    }
}

/// The joints of every branch that gives one pose.
#[derive(Clone, Copy, Debug)]
pub struct Branches<const N: usize> {
    list: [[f64; N]; MAX_SOLUTIONS],
    count: usize,
}

impl<const N: usize> Branches<N> {
    /// No branch.
    #[must_use]
    pub const fn none() -> Self {
        Self {
            list: [[0.0; N]; MAX_SOLUTIONS],
            count: 0,
        }
    }

    /// A single branch.
    #[must_use]
    pub fn one(joints: [f64; N]) -> Self {
        let mut branches = Self::none();
        branches.push(joints);
        branches
    }

    /// Adds a branch.
    ///
    /// # Panics
    /// When there are [`MAX_SOLUTIONS`] already.
    pub fn push(&mut self, joints: [f64; N]) {
        self.list[self.count] = joints;
        self.count += 1;
    }

    /// The branches.
    #[must_use]
    pub fn as_slice(&self) -> &[[f64; N]] {
        &self.list[..self.count]
    }
}

/// The tip of a tool that points straight up, for machines that cannot tilt it.
///
/// # Errors
/// [`KinematicsError::Unreachable`] for any other orientation.
pub fn upright(pose: &ToolPose) -> Result<Vector<3>, KinematicsError> {
    if (pose.orientation() - Vector::<3>::z()).norm() > UPRIGHT {
        return Err(KinematicsError::Unreachable {
            reason: "no axis tilts the tool",
        });
    }
    Ok(pose.tip())
}

/// A machine of a [`Structure`]: joints become axes with signs, zeros and travel.
#[derive(Clone, Debug)]
pub struct Assembly<S, const N: usize> {
    structure: S,
    workpiece: Vector<3>,
    axes: [Axis; N],
    signs: [f64; N],
    zeros: [f64; N],
    tolerance: Tolerance,
    period: SamplePeriod,
}

impl<S: Structure<N> + 'static, const N: usize> Assembly<S, N> {
    /// The machine that a machine file describes.
    ///
    /// `workpiece` is added to every tip before the structure sees it. `wanted` are the letters and
    /// kinds of the joints, in machine order.
    ///
    /// # Errors
    /// [`MachineError::Axes`] when the file lists other axes or another order,
    /// [`MachineError::Field`] for what an axis, the tolerance or the period must not be.
    pub fn build(
        structure: S,
        workpiece: [f64; 3],
        wanted: [(char, AxisKind); N],
        config: &MachineConfig,
    ) -> Result<Box<dyn MachineKinematics>, MachineError> {
        let letters: Vec<char> = wanted.iter().map(|(letter, _)| *letter).collect();
        let given: Vec<char> = config.axis.iter().map(|axis| axis.name).collect();
        let listed: Option<[&AxisConfig; N]> =
            config.axis.iter().collect::<Vec<_>>().try_into().ok();
        let Some(listed) = listed.filter(|_| given == letters) else {
            return Err(MachineError::Axes {
                given,
                wanted: letters,
            });
        };
        let mut axes = Vec::with_capacity(N);
        for (axis, (_, kind)) in listed.iter().zip(wanted) {
            axes.push(axis.of_kind(kind)?);
        }
        let Ok(axes) = axes.try_into() else {
            return Err(MachineError::Axes {
                given,
                wanted: letters,
            });
        };
        Ok(Box::new(Self {
            structure,
            workpiece: workpiece.into(),
            axes,
            signs: listed.map(|axis| if axis.reversed { -1.0 } else { 1.0 }),
            zeros: std::array::from_fn(|axis| listed[axis].zero * file_unit(wanted[axis].1)),
            tolerance: config.tolerance()?,
            period: config.period()?,
        }))
    }

    /// The joints at axis positions.
    fn joints(&self, axes: &AxisVector) -> Result<[f64; N], KinematicsError> {
        let Ok(positions) = <[f64; N]>::try_from(&axes[..]) else {
            return Err(KinematicsError::AxisCount {
                given: axes.len(),
                axes: N,
            });
        };
        for (axis, &position) in self.axes.iter().zip(&positions) {
            if !position.is_finite() {
                return Err(KinematicsError::NotFinite {
                    axis: axis.name,
                    position,
                });
            }
        }
        Ok(std::array::from_fn(|axis| {
            self.signs[axis] * (positions[axis] - self.zeros[axis])
        }))
    }

    fn branches(&self, pose: &ToolPose, near: &AxisVector) -> Result<Branches<N>, KinematicsError> {
        let joints = self.joints(near)?;
        let on_machine = pose.moved_by(self.workpiece);
        self.structure.branches(&on_machine, &joints)
    }

    /// Axis positions of one branch on the turns nearest to `near` (those within travel, if there
    /// are, unless the motion `goes_on`), the axis that leaves its travel if there is one, and how
    /// far the rotary axes are from `near`, rad².
    fn positions(
        &self,
        joints: &[f64; N],
        near: &AxisVector,
        goes_on: bool,
    ) -> (AxisVector, Option<usize>, f64) {
        let mut positions = AxisVector::zeros(N);
        let mut outside = None;
        let mut distance = 0.0;
        for (index, axis) in self.axes.iter().enumerate() {
            let mut position = self.zeros[index] + self.signs[index] * joints[index];
            if axis.kind == AxisKind::Rotary {
                let ends = axis.travel.filter(|_| !goes_on);
                position = turned(position, near[index], ends);
                distance += (position - near[index]).powi(2);
            }
            positions[index] = position;
            if outside.is_none() && leaves(axis, position) {
                outside = Some(index);
            }
        }
        (positions, outside, distance)
    }

    fn refused(&self, index: usize, position: f64) -> KinematicsError {
        let axis = &self.axes[index];
        if !position.is_finite() {
            return KinematicsError::NotFinite {
                axis: axis.name,
                position,
            };
        }
        let (low, high) = axis.travel.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        KinematicsError::Travel {
            axis: axis.name,
            kind: axis.kind,
            position,
            low,
            high,
        }
    }
}

/// Whether a position is outside the travel of its axis, or no position.
fn leaves(axis: &Axis, position: f64) -> bool {
    let slack = match axis.kind {
        AxisKind::Linear => LENGTH_SLACK,
        AxisKind::Rotary => ANGLE_SLACK,
    };
    match axis.travel {
        Some((low, high)) => !(low - slack..=high + slack).contains(&position),
        None => !position.is_finite(),
    }
}

/// The angle on the turn nearest to `near`; where that is outside the travel, on the nearest turn
/// inside, if there is one.
fn turned(angle: f64, near: f64, travel: Option<(f64, f64)>) -> f64 {
    let turn = std::f64::consts::TAU;
    let nearest = angle + turn * ((near - angle) / turn).round();
    let Some((low, high)) = travel else {
        return nearest;
    };
    let inside = if nearest > high + ANGLE_SLACK {
        nearest - turn * ((nearest - high - ANGLE_SLACK) / turn).ceil()
    } else if nearest < low - ANGLE_SLACK {
        nearest + turn * ((low - ANGLE_SLACK - nearest) / turn).ceil()
    } else {
        nearest
    };
    if (low - ANGLE_SLACK..=high + ANGLE_SLACK).contains(&inside) {
        inside
    } else {
        nearest
    }
}

impl<S: Structure<N> + 'static, const N: usize> MachineKinematics for Assembly<S, N> {
    fn axes(&self) -> &[Axis] {
        &self.axes
    }

    fn default_tolerance(&self) -> Tolerance {
        self.tolerance
    }

    fn set_point_period(&self) -> SamplePeriod {
        self.period
    }

    fn forward(&self, axes: &AxisVector) -> Result<ToolPose, KinematicsError> {
        let (tip, orientation) = self.structure.tool(&self.joints(axes)?)?;
        ToolPose::new(tip - self.workpiece, orientation).map_err(|_| KinematicsError::Unreachable {
            reason: "the tool would be farther away than numbers reach",
        })
    }

    fn inverse(&self, pose: &ToolPose, near: &AxisVector) -> Result<AxisVector, KinematicsError> {
        let branches = self.branches(pose, near)?;
        let mut best: Option<(AxisVector, f64)> = None;
        let mut refused: Option<(usize, f64, f64)> = None;
        for joints in branches.as_slice() {
            let (positions, outside, distance) = self.positions(joints, near, false);
            match outside {
                None if best.is_none_or(|(_, least)| distance < least) => {
                    best = Some((positions, distance));
                }
                Some(axis) if refused.is_none_or(|(_, _, least)| distance < least) => {
                    refused = Some((axis, positions[axis], distance));
                }
                _ => {}
            }
        }
        match (best, refused) {
            (Some((positions, _)), _) => Ok(positions),
            (None, Some((axis, position, _))) => Err(self.refused(axis, position)),
            (None, None) => Err(KinematicsError::Unreachable {
                reason: "no branch of the machine gives it",
            }),
        }
    }

    fn follow(&self, pose: &ToolPose, near: &AxisVector) -> Result<AxisVector, KinematicsError> {
        let branches = self.branches(pose, near)?;
        let mut nearest: Option<(AxisVector, Option<usize>, f64)> = None;
        for joints in branches.as_slice() {
            let found = self.positions(joints, near, true);
            if nearest.is_none_or(|(_, _, least)| found.2 < least) {
                nearest = Some(found);
            }
        }
        match nearest {
            Some((positions, None, _)) => Ok(positions),
            Some((positions, Some(axis), _)) => Err(self.refused(axis, positions[axis])),
            None => Err(KinematicsError::Unreachable {
                reason: "no branch of the machine gives it",
            }),
        }
    }

    fn pole(&self, orientation: &Vector<3>) -> Option<Vector<3>> {
        self.structure.pole(orientation)
    }

    fn solutions(&self, pose: &ToolPose, near: &AxisVector) -> Result<Solutions, KinematicsError> {
        let branches = self.branches(pose, near)?;
        let mut solutions = Solutions::none();
        let mut distances = [0.0; MAX_SOLUTIONS];
        for joints in branches.as_slice() {
            let (positions, outside, distance) = self.positions(joints, near, false);
            if outside.is_some() {
                continue;
            }
            let mut place = solutions.len();
            solutions.push(positions);
            while place > 0 && distances[place - 1] > distance {
                distances[place] = distances[place - 1];
                solutions.swap(place, place - 1);
                place -= 1;
            }
            distances[place] = distance;
        }
        if solutions.is_empty() {
            return self.inverse(pose, near).map(Solutions::from);
        }
        Ok(solutions)
    }
}
