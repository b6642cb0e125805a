//! Chooses branch and turns of the axes at the first pose of a program.
//!
//! Source: ours. A pose can be taken in several branches and on several turns of an axis; once the motion
//! has begun it can only go on in its own. So the moves ahead are followed from each, the
//! nearest first, until one stays within travel. Not here: motion.

use crate::pose::block::PoseBlock;
use crate::singularity::{Spin, at_pole};
use std::f64::consts::TAU;
use toolglide_kinematics::{
    AxisKind, AxisVector, GreatCircle, KinematicsError, MachineKinematics, OrientationTolerance,
    PoseEnd, PoseFeed, PoseLeg, PoseMove, Tolerance, ToolPose,
};

/// How far towards the second pose the way on is looked for, as a share.
const BEYOND: f64 = 1e-3;

/// Axis positions from which a machine can follow the moves to tool poses, of which the first is
/// where it starts.
///
/// Of all branches and turns the nearest to `near` is taken from which the most moves can be followed within
/// travel. At a pole of the machine an axis stands where the way on begins.
///
/// # Errors
/// [`KinematicsError`] when the machine cannot take the first pose.
///
/// # Examples
/// ```
/// use toolglide_fiveaxis::start_of;
/// use toolglide_kinematics::{
///     AxisVector, OrientationTolerance, PoseEnd, PoseFeed, PoseMove, Tolerance, ToolPose, Vector,
/// };
///
/// let model = toolglide_machines::find("head-table-bc")?;
/// let machine = (model.build)(&(model.preset)())?;
/// // The head tilts by 30 degrees at most to one side, but by 110 to the other.
/// let leaning = |angle: f64| -> Result<PoseMove, Box<dyn std::error::Error>> {
///     let tool = Vector::<3>::new(-angle.sin(), 0.0, angle.cos());
///     let end = PoseEnd::Pose(ToolPose::new(Vector::<3>::zeros(), tool)?);
///     Ok(PoseMove::new(end, PoseFeed::Duration(1.0), Tolerance::new(0.01)?)?)
/// };
/// let near = AxisVector::zeros(5);
/// let within = OrientationTolerance::new(0.001)?;
/// let start = start_of(machine.as_ref(), &[leaning(0.2)?, leaning(0.4)?], &near, within)?;
/// assert!((start[3] + 0.2).abs() < 1e-9, "B stays on its side: {start:?}");
/// let start = start_of(machine.as_ref(), &[leaning(0.2)?, leaning(1.0)?], &near, within)?;
/// assert!((start[3] - 0.2).abs() < 1e-9, "B could not go on there: {start:?}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn start_of(
    machine: &dyn MachineKinematics,
    moves: &[PoseMove],
    near: &AxisVector,
    tolerance: OrientationTolerance,
) -> Result<AxisVector, KinematicsError> {
    let mut poses = moves.iter().filter_map(|next| match next.end() {
        PoseEnd::Pose(pose) => Some(at_pole(machine, pose, tolerance)),
        _ => None,
    });
    let Some(first) = poses.next() else {
        return Ok(*near);
    };
    let beyond = poses
        .next()
        .and_then(|second| GreatCircle::between(&first, &second).ok())
        .and_then(|turn| ToolPose::new(first.tip(), turn.at(BEYOND)).ok())
        .unwrap_or(first);
    let mut best: Option<(AxisVector, usize)> = None;
    for at in candidates(machine, &beyond, near)? {
        let Ok(at) = machine.follow(&first, &at) else {
            continue;
        };
        let followed = followed(machine, moves, at, tolerance);
        if best.is_none_or(|(_, most)| followed > most) {
            best = Some((at, followed));
        }
        if followed == moves.len() {
            break;
        }
    }
    match best {
        Some((at, _)) => Ok(at),
        None => machine.inverse(&first, near),
    }
}

/// All branches that give a pose, each on all turns within travel, the nearest to `near` first.
fn candidates(
    machine: &dyn MachineKinematics,
    pose: &ToolPose,
    near: &AxisVector,
) -> Result<Vec<AxisVector>, KinematicsError> {
    let mut candidates = machine.solutions(pose, near)?.to_vec();
    for (axis, limits) in machine.axes().iter().enumerate() {
        // Without an end an axis is as well off on any turn.
        let Some((low, high)) = limits.travel.filter(|_| limits.kind == AxisKind::Rotary) else {
            continue;
        };
        for index in 0..candidates.len() {
            let here = candidates[index];
            for step in [TAU, -TAU] {
                let mut other = here;
                other[axis] += step;
                while (low..=high).contains(&other[axis]) {
                    candidates.push(other);
                    other[axis] += step;
                }
            }
        }
    }
    let far = |at: &AxisVector| {
        machine
            .axes()
            .iter()
            .zip(at.iter().zip(near.iter()))
            .filter(|(axis, _)| axis.kind == AxisKind::Rotary)
            .map(|(_, (at, near))| (at - near).powi(2))
            .sum::<f64>()
    };
    candidates.sort_by(|one, other| far(one).total_cmp(&far(other)));
    Ok(candidates)
}

/// How many moves can be followed from axis positions that take the first pose.
fn followed(
    machine: &dyn MachineKinematics,
    moves: &[PoseMove],
    start: AxisVector,
    tolerance: OrientationTolerance,
) -> usize {
    let mut at = start;
    let mut pose: Option<ToolPose> = None;
    for (index, next) in moves.iter().enumerate() {
        let end = match next.end() {
            PoseEnd::Pose(end) => at_pole(machine, end, tolerance),
            PoseEnd::Dwell { .. } => continue,
            // Words of axes say themselves where the axes go.
            _ => return moves.len(),
        };
        if let Some(start) = pose.replace(end) {
            at = match arrive(machine, &start, &end, &at) {
                Some(at) => at,
                // A rapid takes the axes another way round.
                None if next.feed() == PoseFeed::Rapid => match machine.inverse(&end, &at) {
                    Ok(at) => at,
                    Err(_) => return index,
                },
                None => return index,
            };
        }
    }
    moves.len()
}

fn arrive(
    machine: &dyn MachineKinematics,
    start: &ToolPose,
    end: &ToolPose,
    at: &AxisVector,
) -> Option<AxisVector> {
    // Neither feed nor tolerances move where the axes arrive.
    let leg = PoseLeg::between(
        start,
        end,
        PoseFeed::Rapid,
        Tolerance::new(1.0).ok()?,
        OrientationTolerance::new(1.0).ok()?,
    )
    .ok()?;
    let Some(block) = PoseBlock::of(&leg, 0, f64::INFINITY) else {
        return Some(*at);
    };
    Spin::arrival(&block, machine, at).ok()
}
