//! Turns an axis in place at the singularity of a machine, where it has no influence on the tool.
//!
//! Source: ours. A move that leaves a pole in another direction than it was entered needs one axis
//! to stand elsewhere at once. The motion rests there, the tool leans by a small share of its tolerance,
//! the axis turns while the tip stands still in the workpiece, and the tool goes upright again. Not here:
//! moves that pass a pole at a distance.

use crate::axis_limits::axis_path::AxisPaths;
use crate::error::FiveAxisError;
use crate::pose::block::PoseBlock;
use crate::pose::swing::Swing;
use toolglide_kinematics::{
    Axis, AxisKind, AxisVector, GreatCircle, MachineKinematics, OrientationTolerance, ToolPose,
    Vector, angle_between, turned,
};

/// Angle by which a block has left a pole where it is asked for the axes, rad, or at its end: far enough for
/// the rounding of orientations, near enough for every direction to be that of the start.
const PROBE: f64 = 1e-5;

/// Axes that differ by less stand at the same place, rad: some hundred roundings of an angle.
const SAME_PLACE: f64 = 1e-12;

/// How far the tool leans while an axis turns, as a share of its tolerance; and at most, rad.
const LEAN: f64 = 0.2;
const MAX_LEAN: f64 = 1e-3;

/// Orientations found in two ways differ by less than this, rad.
const AGREES: f64 = 1e-12;

/// Orientations nearer to a pole than this are at the pole, rad: an arc second. Nearer to it the rounding of an
/// orientation turns an axis by more than its limits allow for.
const AT_POLE: f64 = 5e-6;

/// The same as a share of the tolerance of the orientation.
const AT_POLE_SHARE: f64 = 0.05;

/// A pose with its tool at the pole of the machine where it is as good as there.
pub(crate) fn at_pole(
    machine: &dyn MachineKinematics,
    pose: &ToolPose,
    tolerance: OrientationTolerance,
) -> ToolPose {
    let near = AT_POLE.min(AT_POLE_SHARE * tolerance.angle());
    machine
        .pole(&pose.orientation())
        .filter(|pole| angle_between(pole, &pose.orientation()) < near)
        .and_then(|pole| ToolPose::new(pose.tip(), pole).ok())
        .unwrap_or(*pose)
}

/// A turn that misses the pole by less goes through it, rad: some thousand roundings of an orientation.
const THROUGH: f64 = 1e-12;

/// The block in parts: two where it passes a pole so near that it is as good as there, each to or from the pole
/// itself; else the block.
pub(crate) fn parts_at_pole(
    block: &PoseBlock,
    machine: &dyn MachineKinematics,
) -> Result<(PoseBlock, Option<PoseBlock>), FiveAxisError> {
    let whole = Ok((*block, None));
    let Some(turn) = block.turn.circle() else {
        return whole;
    };
    let (start, end, axis) = (turn.start(), turn.end(), turn.axis());
    let near = AT_POLE.min(AT_POLE_SHARE * block.orientation_tolerance);
    let Some(pole) = machine.pole(&turn.at(0.5)) else {
        return whole;
    };
    let miss = axis.dot(&pole).abs();
    let inside = axis.cross(&start).dot(&pole) > near && end.cross(&axis).dot(&pole) > near;
    if !(THROUGH < miss && miss < near && inside) {
        return whole;
    }
    let made = || {
        let pose = |orientation| ToolPose::new(block.start, orientation);
        let to = GreatCircle::between(&pose(start)?, &pose(pole)?)?;
        let from = GreatCircle::between(&pose(pole)?, &pose(end)?)?;
        Ok((to, from))
    };
    let (to, from) = made().map_err(|reason| FiveAxisError::Path {
        index: block.leg,
        reason,
    })?;
    let share = to.angle() / (to.angle() + from.angle());
    let first = PoseBlock {
        turn: Swing::Circle(to),
        ..block.part(0.0, share)
    };
    let second = PoseBlock {
        turn: Swing::Circle(from),
        ..block.part(share, 1.0)
    };
    Ok((first, Some(second)))
}

/// A tool that comes nearer to a pole than this is beside it, rad.
const BESIDE: f64 = 0.1;

/// Shares of a block at which it is looked for a pole.
const LOOKS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

impl PoseBlock {
    /// Whether the tool comes near to a pole of the machine.
    pub(crate) fn is_beside_pole(&self, machine: &dyn MachineKinematics) -> bool {
        // Axes whose positions are given pass a pole like any other place.
        let Some(turn) = self.turn.circle() else {
            return false;
        };
        // Between two looks the tool turns by no more than to half-way.
        let near = BESIDE + 0.125 * turn.angle();
        LOOKS.iter().any(|&share| {
            let tool = turn.at(share);
            machine
                .pole(&tool)
                .is_some_and(|pole| angle_between(&pole, &tool) < near)
        })
    }
}

/// An axis that must turn at rest, because the tool does not tell where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spin {
    /// Number of the axis.
    axis: usize,
    from: AxisVector,
    to: AxisVector,
    /// Axis positions when the block has left the pole.
    beyond: AxisVector,
}

impl Spin {
    /// The way along a block where it goes on from axis positions `at`; or the turn that it needs
    /// before.
    pub(crate) fn before(
        block: &PoseBlock,
        machine: &dyn MachineKinematics,
        at: &AxisVector,
    ) -> Result<(Option<AxisPaths>, Option<Self>), FiveAxisError> {
        let way = AxisPaths::along(block, machine, at);
        let Some(turn) = block.turn.circle() else {
            return way.map(|way| (Some(way), None));
        };
        let start = turn.start();
        let at_pole = machine
            .pole(&start)
            .is_some_and(|pole| angle_between(&pole, &start) < THROUGH);
        match way {
            Ok(way) if way.known().is_some() && !at_pole => return Ok((Some(way), None)),
            _ if turn.angle() <= 0.0 => return way.map(|way| (Some(way), None)),
            _ => {}
        }
        let refused = |reason| FiveAxisError::Machine {
            index: block.leg,
            reason,
        };
        let pose = |share: f64| {
            ToolPose::new(block.tip(share), turn.at(share)).map_err(|reason| FiveAxisError::Path {
                index: block.leg,
                reason,
            })
        };
        let start = pose(0.0)?;
        let from = machine.follow(&start, at).map_err(refused)?;
        let leaving = pose((PROBE / turn.angle()).min(1.0))?;
        let beyond = machine.inverse(&leaving, &from).map_err(refused)?;
        let to = machine.inverse(&start, &beyond).map_err(refused)?;
        let axes = machine.axes();
        let moved = |axis: &usize| {
            axes[*axis].kind == AxisKind::Rotary && (to[*axis] - from[*axis]).abs() > SAME_PLACE
        };
        let mut turning = (0..axes.len()).filter(moved);
        let Some(axis) = turning.next() else {
            return way.map(|way| (Some(way), None));
        };
        let spin = Self {
            axis,
            from,
            to,
            beyond,
        };
        if turning.next().is_some() {
            return Err(spin.refused(block, axes));
        }
        Ok((None, Some(spin)))
    }

    /// Where the axes come to along a block from axis positions `at`.
    pub(crate) fn arrival(
        block: &PoseBlock,
        machine: &dyn MachineKinematics,
        at: &AxisVector,
    ) -> Result<AxisVector, FiveAxisError> {
        let (first, second) = parts_at_pole(block, machine)?;
        let mut at = *at;
        for part in [Some(first), second].into_iter().flatten() {
            let way = match Self::before(&part, machine, &at)? {
                (Some(way), _) => way,
                (None, spin) => {
                    AxisPaths::along(&part, machine, spin.as_ref().map_or(&at, |spin| &spin.to))?
                }
            };
            at = *way.last();
        }
        Ok(at)
    }

    fn refused(&self, block: &PoseBlock, axes: &[Axis]) -> FiveAxisError {
        let tool = block
            .turn
            .circle()
            .map_or_else(Vector::<3>::z, GreatCircle::start);
        let tip = block.start;
        FiveAxisError::Pole {
            index: block.leg,
            axis: axes[self.axis].name,
            from: self.from[self.axis],
            to: self.to[self.axis],
            tip: tip.into(),
            tool: tool.into(),
        }
    }

    /// The moves of the turn before a block: leaning, turning, and upright again.
    pub(crate) fn blocks(
        &self,
        block: &PoseBlock,
        machine: &dyn MachineKinematics,
    ) -> Result<[PoseBlock; 3], FiveAxisError> {
        let axes = machine.axes();
        let refused = || self.refused(block, axes);
        let lean = (LEAN * block.orientation_tolerance).min(MAX_LEAN);
        let upright = block
            .turn
            .circle()
            .map_or_else(Vector::<3>::z, GreatCircle::start);
        let tool = |axes: &AxisVector| {
            machine
                .forward(axes)
                .map(|pose| pose.orientation())
                .map_err(|_| refused())
        };
        // The axis that leans the tool is the one that has moved beyond the pole.
        let tilt = (0..axes.len())
            .filter(|axis| axes[*axis].kind == AxisKind::Rotary && *axis != self.axis)
            .max_by(|one, other| {
                let gone = |axis: usize| (self.beyond[axis] - self.to[axis]).abs();
                gone(*one).total_cmp(&gone(*other))
            })
            .ok_or_else(refused)?;
        let leaning = |at: &AxisVector| {
            let mut at = *at;
            at[tilt] += lean.copysign(self.beyond[tilt] - self.to[tilt]);
            tool(&at)
        };
        let (first, last) = (leaning(&self.from)?, leaning(&self.to)?);
        let angle = self.to[self.axis] - self.from[self.axis];
        let miss = |angle: f64| (turned(&first, &upright, angle) - last).norm();
        let sense = if miss(angle) <= miss(-angle) {
            angle
        } else {
            -angle
        };
        if miss(sense) > AGREES {
            return Err(refused());
        }
        let pose = |orientation: Vector<3>| ToolPose::new(block.start, orientation);
        let made = |turn| PoseBlock {
            end: block.start,
            length: 0.0,
            duration: 0.0,
            turn: Swing::Circle(turn),
            ..*block
        };
        let circles = || {
            Ok([
                GreatCircle::between(&pose(upright)?, &pose(first)?)?,
                GreatCircle::along_parallel(&pose(first)?, &pose(last)?, &upright, sense),
                GreatCircle::between(&pose(last)?, &pose(upright)?)?,
            ])
        };
        circles()
            .map(|circles| circles.map(made))
            .map_err(|reason| FiveAxisError::Path {
                index: block.leg,
                reason,
            })
    }
}
