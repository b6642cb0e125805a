//! Bounds velocity, acceleration and jerk of the axes behind a piece of tool motion at every
//! instant.
//!
//! Source: ours. The inverse kinematics along the polynomials of the piece is interpolated, and
//! the series bounds the derivatives between the instants, too; what the series leaves out is
//! counted with what its last coefficients add. Where that is too much the stretch is halved. Not here:
//! what is done about it.

use crate::axis_limits::chebyshev::{
    AT_NODES, NODES, bound, falls, last, slope, through_nodes, value,
};
use toolglide_kinematics::{
    Axis, AxisVector, KinematicsError, MAX_AXES, MachineKinematics, PosePiece,
};

/// Shorter stretches are interpolated beyond their ends, s: the rounding of positions of a metre leaves
/// less than 1 mm/s³ of a jerk, and a motion that changes within such a time is none for a machine.
const MIN_HALF: f64 = 3e-3;

/// A share of a limit below which the value itself does not matter.
const FREE: f64 = 0.99;

/// A bound that is above what is attained by this factor at most is taken for it.
const TIGHT: f64 = 1.002;

/// A limit that is exceeded so much is not looked at more closely.
const PLENTY: f64 = 1.3;

/// What a series may leave out before it is not believed, as a share of a limit.
const BELIEVED: f64 = 0.1;

/// What the last coefficients may add to a position, mm and rad.
const RESOLVED: f64 = 1e-5;

/// Stretches are halved down to this, s.
const SHORTEST: f64 = 1e-3;

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
        let bounds = bounds(limits);
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

pub(crate) fn bounds(axis: &Axis) -> [f64; 3] {
    let limits = &axis.limits;
    [limits.velocity(), limits.acceleration(), limits.jerk()]
}

/// The limit of an axis that a piece comes nearest to, or exceeds most. The share is a bound.
pub(crate) fn worst(
    machine: &dyn MachineKinematics,
    axes: &[Axis],
    piece: &PosePiece,
    near: &AxisVector,
) -> Result<Worst, KinematicsError> {
    let mut look = Look {
        machine,
        axes,
        piece,
        near: *near,
        worst: Worst::NONE,
    };
    look.stretch([0.0, piece.duration()], MIN_HALF)?;
    Ok(look.worst)
}

/// A look at a piece.
struct Look<'a> {
    machine: &'a dyn MachineKinematics,
    axes: &'a [Axis],
    piece: &'a PosePiece,
    near: AxisVector,
    worst: Worst,
}

impl Look<'_> {
    fn halves(&mut self, [begin, middle, end]: [f64; 3]) -> Result<(), KinematicsError> {
        self.stretch([begin, middle], MIN_HALF)?;
        self.stretch([middle, end], MIN_HALF)
    }

    /// Looks at a stretch as if it lasted twice `least` at least.
    fn stretch(&mut self, [begin, end]: [f64; 2], least: f64) -> Result<(), KinematicsError> {
        let middle = 0.5 * (begin + end);
        let half = (0.5 * (end - begin)).max(least);
        let width = 0.5 * (end - begin) / half;
        let before = self.near;
        let mut values = [[0.0; NODES]; MAX_AXES];
        let mut near = before;
        for (node, at) in AT_NODES.iter().enumerate() {
            let time = middle + half * at;
            near = match self.piece.extended(time, self.machine, &near) {
                Ok(next) => next,
                // Looked at too rarely, an axis beside a pole may seem to turn the other way.
                Err(_) if end - begin > SHORTEST => return self.halves([begin, middle, end]),
                // Beyond the ends of the piece the machine need not get anywhere.
                Err(_) if !(0.0..=self.piece.duration()).contains(&time) => {
                    return self.stretch([begin, end], 0.5 * least);
                }
                Err(reason) => return Err(reason),
            };
            for (values, (now, then)) in values.iter_mut().zip(near.iter().zip(before.iter())) {
                // Differences keep the digits of large positions.
                values[node] = now - then;
            }
        }
        let mut found = Worst::NONE;
        let mut attained = Worst::NONE;
        let mut believed = true;
        for (axis, limits) in self.axes.iter().enumerate() {
            let mut series = through_nodes(&values[axis]);
            let rests = last(&series);
            believed &= falls(&series, RESOLVED);
            let mut scale = 1.0;
            for (order, limit) in bounds(limits).into_iter().enumerate() {
                series = slope(&series);
                scale /= half;
                let rest = rests[order] * scale / limit;
                let share = bound(&series, width) * scale / limit + rest;
                believed &= rest <= BELIEVED;
                if share > found.share {
                    found = Worst { share, axis, order };
                }
                if share > FREE {
                    let most = [-width, 0.0, width]
                        .iter()
                        .map(|at| value(&series, *at).abs())
                        .fold(0.0, f64::max);
                    let share = most * scale / limit;
                    if share > attained.share {
                        attained = Worst { share, axis, order };
                    }
                }
            }
        }
        let enough = FREE.max(attained.share.max(self.worst.share) * TIGHT);
        if believed && attained.share > PLENTY {
            found = attained;
        } else if (!believed || found.share > enough) && end - begin > SHORTEST {
            return self.halves([begin, middle, end]);
        }
        if found.share > self.worst.share {
            self.worst = found;
        }
        self.near = near;
        Ok(())
    }
}
