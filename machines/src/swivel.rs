//! Points two rotary axes at a direction: one spins about Z, the other tilts away from it.
//!
//! Source: the angles of section 5.2, with atan2 in place of arccos, which loses half of its digits
//! near the pole. Not here: which machine axes these are.

use std::f64::consts::PI;
use toolglide_kinematics::{AxisKind, Vector};

/// Directions nearer to the pole than this are looked at closely, dimensionless: there the rounding of
/// a direction turns the spin by more than 1e-10 rad.
const NEAR_POLE: f64 = 1e-6;

/// The spin is kept where that changes the direction by less than this, rad: some hundred roundings
/// of a unit vector, so that its noise never shows as motion of the spin.
const KEPT: f64 = 1e-13;

/// X, Y, Z, an axis that tilts, and C, in machine order.
pub(crate) const fn axes(tilt: char) -> [(char, AxisKind); 5] {
    [
        ('X', AxisKind::Linear),
        ('Y', AxisKind::Linear),
        ('Z', AxisKind::Linear),
        (tilt, AxisKind::Rotary),
        ('C', AxisKind::Rotary),
    ]
}

/// The pole next to a direction, which leaves the spin open.
#[allow(
    clippy::unnecessary_wraps,
    reason = "it is what machines answer, of which some have no pole"
)]
pub(crate) fn pole(direction: &Vector<3>) -> Option<Vector<3>> {
    Some(Vector::<3>::new(0.0, 0.0, 1.0_f64.copysign(direction.z)))
}

/// A tilt and a spin with their sines and cosines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Swivel {
    /// Angle from Z, rad; negative on one of the branches.
    pub(crate) tilt: f64,
    /// Angle about Z, rad.
    pub(crate) spin: f64,
    /// Sine and cosine of the tilt.
    pub(crate) tilted: (f64, f64),
    /// Sine and cosine of the spin.
    pub(crate) spun: (f64, f64),
}

impl Swivel {
    /// The direction (sin tilt cos spin, sin tilt sin spin, cos tilt) of given angles.
    pub(crate) fn at(tilt: f64, spin: f64) -> Self {
        Self {
            tilt,
            spin,
            tilted: tilt.sin_cos(),
            spun: spin.sin_cos(),
        }
    }

    /// Both branches that give a direction of unit length. The poles leave the spin open, which then
    /// stays at `near`.
    pub(crate) fn towards(direction: &Vector<3>, near: f64) -> [Self; 2] {
        let [x, y, z] = (*direction).into();
        // Nothing is lost to the squares of a direction this far from the pole.
        let across = (x * x + y * y).sqrt();
        let first = if across > NEAR_POLE {
            Self {
                tilt: across.atan2(z),
                spin: y.atan2(x),
                tilted: (across, z),
                spun: (y / across, x / across),
            }
        } else {
            Self::near_pole(x, y, z, near)
        };
        [first, first.flipped()]
    }

    fn near_pole(x: f64, y: f64, z: f64, near: f64) -> Self {
        let (sin, cos) = near.sin_cos();
        let beside = y * cos - x * sin;
        if beside.abs() <= KEPT {
            let along = x * cos + y * sin;
            return Self {
                tilt: along.atan2(z),
                spin: near,
                tilted: (along, z),
                spun: (sin, cos),
            };
        }
        Self::at(x.hypot(y).atan2(z), y.atan2(x))
    }

    /// The same direction, tilted to the other side with the spin turned by half a turn.
    fn flipped(self) -> Self {
        let Self {
            tilt,
            spin,
            tilted,
            spun,
        } = self;
        Self {
            tilt: -tilt,
            spin: if spin > 0.0 { spin - PI } else { spin + PI },
            tilted: (-tilted.0, tilted.1),
            spun: (-spun.0, -spun.1),
        }
    }

    /// The direction.
    pub(crate) fn direction(&self) -> Vector<3> {
        let ((tilt_sin, tilt_cos), (spin_sin, spin_cos)) = (self.tilted, self.spun);
        Vector::<3>::new(tilt_sin * spin_cos, tilt_sin * spin_sin, tilt_cos)
    }
}

/// A vector turned about X by an angle of this sine and cosine.
pub(crate) fn about_x((sin, cos): (f64, f64), v: Vector<3>) -> Vector<3> {
    Vector::<3>::new(v.x, cos * v.y - sin * v.z, sin * v.y + cos * v.z)
}

/// A vector turned about Y by an angle of this sine and cosine.
pub(crate) fn about_y((sin, cos): (f64, f64), v: Vector<3>) -> Vector<3> {
    Vector::<3>::new(cos * v.x + sin * v.z, v.y, cos * v.z - sin * v.x)
}

/// A vector turned about Z by an angle of this sine and cosine.
pub(crate) fn about_z((sin, cos): (f64, f64), v: Vector<3>) -> Vector<3> {
    Vector::<3>::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z)
}

/// Sine and cosine of the angle turned back.
pub(crate) fn back((sin, cos): (f64, f64)) -> (f64, f64) {
    (-sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_branches_give_the_direction() {
        for (tilt, spin) in [
            (0.3, 1.0),
            (1.5, -3.0),
            (3.0, 2.0),
            (1e-8, 0.4),
            (1e-12, -2.0),
            (0.0, 0.7),
            (PI, 0.7),
        ] {
            let direction = Swivel::at(tilt, spin).direction();
            for near in [-2.0, 0.0, spin] {
                for branch in Swivel::towards(&direction, near) {
                    let again = Swivel::at(branch.tilt, branch.spin).direction();
                    let miss = (again - direction).norm();
                    assert!(miss < 2e-13, "{tilt} {spin} near {near}: {miss:e}");
                    let kept = (branch.direction() - direction).norm();
                    assert!(kept < 2e-13, "{tilt} {spin} near {near}: {kept:e}");
                }
            }
        }
    }

    #[test]
    fn the_spin_stays_at_the_pole_and_through_it() {
        let [up, _] = Swivel::towards(&Vector::<3>::z(), 0.7);
        assert!(
            (up.spin - 0.7).abs() < 1e-15 && up.tilt.abs() < 1e-15,
            "{up:?}"
        );
        let noise = Vector::<3>::new(1e-17, -2e-16, 1.0);
        let [up, _] = Swivel::towards(&noise, 0.7);
        assert!((up.spin - 0.7).abs() < 1e-15, "{up:?}");
        for tilt in [-1e-3, -1e-8, -1e-11, 1e-11, 1e-8, 1e-3] {
            let direction = Swivel::at(tilt, 0.7).direction();
            let branches = Swivel::towards(&direction, 0.7);
            assert!(
                branches
                    .iter()
                    .any(|branch| (branch.tilt - tilt).abs() < 1e-15
                        && (branch.spin - 0.7).abs() < 1e-9),
                "{tilt}: {branches:?}"
            );
        }
    }
}
