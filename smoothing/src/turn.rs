//! A corner motion in numbers: what the window scales and the plan unrolls into pieces.
//!
//! Source: sections 2.3 and 3.2, in the vector form where a corner is a mixture of the incoming and
//! the outgoing direction. Not here: how large it may be, see the blenders.

use toolglide_kinematics::{Corner, Piece, Sample, Serves, Vector};
use toolglide_profiles::{Boundary, CornerMotion};

/// A corner motion without its geometry, symmetric about the corner.
///
/// With `ramp > 0`, or with neither ramp nor duration, the velocity goes from the incoming to the
/// outgoing direction along an S-curve that raises the acceleration for `ramp`, holds it, and lowers
/// it for `ramp` again. With `ramp = 0` the jerk is constant over the whole corner.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TurnShape {
    /// Speed at both boundaries.
    pub speed: f64,
    /// Acceleration at both boundaries: deceleration on the way in.
    pub acceleration: f64,
    /// Distance of both boundaries from the corner.
    pub reach: f64,
    /// How long the corner takes.
    pub duration: f64,
    /// Duration of each of the two ramps of the acceleration; zero when the jerk is constant.
    pub ramp: f64,
}

impl TurnShape {
    /// A full stop at the corner itself.
    pub const STOP: Self = Self {
        speed: 0.0,
        acceleration: 0.0,
        reach: 0.0,
        duration: 0.0,
        ramp: 0.0,
    };

    /// The same turn with all times multiplied by `scale` (0 to 1) at the same jerk.
    ///
    /// Accelerations shrink with the scale, speeds with its square, lengths and the corner error with
    /// its cube, so that a smaller turn keeps every limit that the full one keeps.
    #[must_use]
    #[inline]
    pub fn scaled(&self, scale: f64) -> Self {
        let square = scale * scale;
        Self {
            speed: self.speed * square,
            acceleration: self.acceleration * scale,
            reach: self.reach * square * scale,
            duration: self.duration * scale,
            ramp: self.ramp * scale,
        }
    }

    /// Whether the motion rests at the corner.
    #[must_use]
    pub fn is_stop(&self) -> bool {
        self.speed <= 0.0
    }

    /// Whether the jerk is constant over the whole corner.
    #[must_use]
    pub fn has_constant_jerk(&self) -> bool {
        self.ramp <= 0.0
    }
}

/// A corner motion with its geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn<const N: usize> {
    shape: TurnShape,
    corner: Corner<N>,
}

impl<const N: usize> Turn<N> {
    pub(crate) fn new(shape: TurnShape, corner: Corner<N>) -> Self {
        Self { shape, corner }
    }

    /// The motion without its geometry.
    #[must_use]
    pub fn shape(&self) -> &TurnShape {
        &self.shape
    }

    /// The corner that it turns.
    #[must_use]
    pub fn corner(&self) -> &Corner<N> {
        &self.corner
    }

    /// Unrolls the motion, phase by phase; nothing for a full stop.
    pub fn pieces(&self, serves: Serves, mut take: impl FnMut(Piece<N>)) {
        let TurnShape {
            speed,
            acceleration,
            reach,
            duration,
            ramp,
        } = self.shape;
        if duration <= 0.0 {
            return;
        }
        let Corner {
            point,
            incoming,
            outgoing,
            ..
        } = self.corner;
        let start = Sample {
            position: point - incoming * reach,
            velocity: incoming * speed,
            acceleration: incoming * -acceleration,
            jerk: Vector::zeros(),
        };
        let end = point + outgoing * reach;
        if self.shape.has_constant_jerk() {
            let jerk = (incoming + outgoing) * (acceleration / duration);
            take(Piece::new(&Sample { jerk, ..start }, duration, end, serves));
            return;
        }
        let hold = (duration - 2.0 * ramp).max(0.0);
        let turned = outgoing - incoming;
        let held = turned * (speed / (ramp + hold));
        let jerk = held / ramp;
        let after_ramp = start.position + (start.velocity + jerk * (ramp * ramp / 6.0)) * ramp;
        let velocity_after_ramp = start.velocity + held * (0.5 * ramp);
        let after_hold = after_ramp + (velocity_after_ramp + held * (0.5 * hold)) * hold;
        let velocity_after_hold = velocity_after_ramp + held * hold;
        take(Piece::new(
            &Sample { jerk, ..start },
            ramp,
            after_ramp,
            serves,
        ));
        if hold > 0.0 {
            let state = Sample {
                position: after_ramp,
                velocity: velocity_after_ramp,
                acceleration: held,
                jerk: Vector::zeros(),
            };
            take(Piece::new(&state, hold, after_hold, serves));
        }
        let state = Sample {
            position: after_hold,
            velocity: velocity_after_hold,
            acceleration: held,
            jerk: -jerk,
        };
        take(Piece::new(&state, ramp, end, serves));
    }
}

impl<const N: usize> CornerMotion for Turn<N> {
    fn duration(&self) -> f64 {
        self.shape.duration
    }

    fn entry(&self) -> Boundary {
        Boundary {
            distance: self.shape.reach,
            speed: self.shape.speed,
            acceleration: self.shape.acceleration,
        }
    }

    fn exit(&self) -> Boundary {
        self.entry()
    }

    fn corner_error(&self) -> f64 {
        let TurnShape {
            speed,
            duration,
            reach,
            ramp,
            ..
        } = self.shape;
        if duration <= 0.0 {
            return 0.0;
        }
        if self.shape.has_constant_jerk() {
            return 0.25 * reach * self.corner.half_turn_sine();
        }
        // Half-way the S-curve has covered this much less than the straight line would have.
        let hold = (duration - 2.0 * ramp).max(0.0);
        let held = speed / (ramp + hold);
        let turned = 2.0 * self.corner.half_turn_sine();
        turned * (speed * speed / (8.0 * held) + held * ramp * ramp / 24.0)
    }
}
