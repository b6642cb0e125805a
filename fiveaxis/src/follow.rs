//! What the axes of a machine do behind a piece of tool motion.
//!
//! Source: central differences of the inverse kinematics along the polynomials of the piece, which
//! go on beyond its ends, so that a piece may be as short as it likes. Not here: what is done about
//! it.

use toolglide_kinematics::{
    Axis, AxisKind, AxisVector, KinematicsError, MachineKinematics, ToolPiece,
};

/// Distance of the instants of a difference, s: the rounding of positions of a metre leaves less than
/// 1 mm/s³ of a jerk, and a motion that changes within such a time is none for a machine.
const STEP: f64 = 1e-3;

/// Differences of seven instants: velocity, acceleration and jerk.
const VELOCITY: [f64; 7] = [-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0];
const VELOCITY_SCALE: f64 = 60.0;
const ACCELERATION: [f64; 7] = [2.0, -27.0, 270.0, -490.0, 270.0, -27.0, 2.0];
const ACCELERATION_SCALE: f64 = 180.0;
const JERK: [f64; 7] = [1.0, -8.0, 13.0, 0.0, -13.0, 8.0, -1.0];
const JERK_SCALE: f64 = 8.0;

/// Longest time and largest angle between two instants looked at, s and rad.
const LONGEST: f64 = 0.02;
const WIDEST: f64 = 0.05;

/// Most instants of a piece at a first look.
const MOST_PARTS: f64 = 64.0;

/// A piece that comes so near to a limit is looked at again, at so many times the instants.
const CLOSE: f64 = 0.7;
const FINER: f64 = 8.0;

/// Largest turn of a rotary axis from one instant to the next, rad: where it turns further, as C does
/// beside the pole, it is looked at again in finer steps, but not in more than so many.
const STRIDE: f64 = 0.05;
const FINEST: f64 = 1024.0;

/// The limit that is exceeded most: by how much, on which axis, and which.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Worst {
    /// Value as a share of the limit.
    pub(crate) share: f64,
    pub(crate) axis: usize,
    /// 0 for velocity, 1 for acceleration, 2 for jerk.
    pub(crate) order: usize,
}

impl Worst {
    pub(crate) const NONE: Self = Self {
        share: 0.0,
        axis: 0,
        order: 0,
    };

    pub(crate) fn raise(&mut self, axis: usize, limits: &Axis, derivatives: [f64; 3]) {
        let bounds = [
            limits.limits.velocity(),
            limits.limits.acceleration(),
            limits.limits.jerk(),
        ];
        for (order, (value, bound)) in derivatives.iter().zip(bounds).enumerate() {
            let share = value.abs() / bound;
            if share > self.share {
                *self = Self { share, axis, order };
            }
        }
    }

    /// What the limit is called.
    pub(crate) fn quantity(&self) -> &'static str {
        ["velocity", "acceleration", "jerk"][self.order.min(2)]
    }
}

/// The limit of an axis that a piece comes nearest to, or exceeds most.
pub(crate) fn worst(
    machine: &dyn MachineKinematics,
    axes: &[Axis],
    piece: &ToolPiece,
    near: &AxisVector,
) -> Result<Worst, KinematicsError> {
    let swing: f64 = piece
        .turns
        .iter()
        .map(|turn| (turn.angle[1] * piece.duration).abs())
        .sum();
    let mut parts = (piece.duration / LONGEST)
        .max(swing / WIDEST)
        .ceil()
        .clamp(2.0, MOST_PARTS);
    loop {
        let (found, stride) = at_instants(machine, axes, piece, near, parts)?;
        if stride > STRIDE && parts < FINEST {
            parts = (parts * FINER).min(FINEST);
        } else if found.share < CLOSE || parts >= FINEST {
            return Ok(found);
        } else {
            let (finer, _) = at_instants(machine, axes, piece, near, FINER * parts)?;
            return Ok(finer);
        }
    }
}

/// The same at equal steps of time, and the largest turn of a rotary axis in a step.
fn at_instants(
    machine: &dyn MachineKinematics,
    axes: &[Axis],
    piece: &ToolPiece,
    near: &AxisVector,
    parts: f64,
) -> Result<(Worst, f64), KinematicsError> {
    let mut worst = Worst::NONE;
    let mut near = *near;
    let mut stride = 0.0_f64;
    let mut part = 0.0;
    while part <= parts {
        let time = piece.duration * part / parts;
        let here = machine.follow(&piece.extended(time), &near)?;
        for (axis, (now, then)) in axes.iter().zip(here.iter().zip(near.iter())) {
            if part > 0.0 && axis.kind == AxisKind::Rotary {
                stride = stride.max((now - then).abs());
            }
        }
        near = here;
        let mut around = [near; 7];
        for (offset, axes) in [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]
            .iter()
            .zip(&mut around)
        {
            *axes = machine.follow(&piece.extended(time + offset * STEP), &near)?;
        }
        for (axis, limits) in axes.iter().enumerate() {
            let sum = |weights: &[f64; 7]| {
                // Differences from the middle keep the digits of large positions.
                weights
                    .iter()
                    .zip(&around)
                    .map(|(weight, at)| weight * (at[axis] - near[axis]))
                    .sum::<f64>()
            };
            worst.raise(
                axis,
                limits,
                [
                    sum(&VELOCITY) / (VELOCITY_SCALE * STEP),
                    sum(&ACCELERATION) / (ACCELERATION_SCALE * STEP.powi(2)),
                    sum(&JERK) / (JERK_SCALE * STEP.powi(3)),
                ],
            );
        }
        part += 1.0;
    }
    Ok((worst, stride))
}
