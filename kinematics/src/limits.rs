//! Holds limits of velocity, acceleration and jerk per axis.
//!
//! Source: section 2.2; the projection on a direction replaces the case tables of sections 2.3
//! and 3.2. Not here: travel, which belongs to a machine.

use crate::error::LimitsError;
#[cfg(not(feature = "std"))]
use crate::no_std::*;
use crate::numeric::{LARGEST_QUANTITY, LONGEST_RAMP, MIN_ACCELERATION, MIN_QUANTITY};
use crate::reserve::Reserve;
use crate::vector::Vector;

/// The limits of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisLimits {
    velocity: f64,
    acceleration: f64,
    jerk: f64,
}

impl AxisLimits {
    /// Limits of velocity, acceleration and jerk, each positive and finite.
    ///
    /// # Errors
    /// [`LimitsError::NotPositive`] names the first quantity that is not, [`LimitsError::TooSmall`] the first
    /// one below [`MIN_QUANTITY`] or [`MIN_ACCELERATION`], [`LimitsError::TooLarge`] the first one above
    /// [`LARGEST_QUANTITY`]; [`LimitsError::TooSlow`] where acceleration or velocity takes longer than
    /// [`LONGEST_RAMP`] to reach.
    ///
    /// # Examples
    /// ```
    /// use toolglide_kinematics::AxisLimits;
    /// assert!(AxisLimits::new(500.0, 2_000.0, 5e4).is_ok());
    /// assert!(AxisLimits::new(500.0, 0.0, 5e4).is_err());
    /// ```
    pub fn new(velocity: f64, acceleration: f64, jerk: f64) -> Result<Self, LimitsError> {
        for (quantity, value, least) in [
            ("velocity", velocity, MIN_QUANTITY),
            ("acceleration", acceleration, MIN_ACCELERATION),
            ("jerk", jerk, MIN_ACCELERATION),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(LimitsError::NotPositive { quantity, value });
            }
            if value < least {
                return Err(LimitsError::TooSmall {
                    quantity,
                    value,
                    least,
                });
            }
            if value > LARGEST_QUANTITY {
                return Err(LimitsError::TooLarge { quantity, value });
            }
        }
        for (quantity, value, reached, limit) in [
            ("jerk", jerk, "acceleration", acceleration),
            ("acceleration", acceleration, "velocity", velocity),
        ] {
            let seconds = limit / value;
            if seconds > LONGEST_RAMP {
                return Err(LimitsError::TooSlow {
                    quantity,
                    value,
                    reached,
                    limit,
                    seconds,
                });
            }
        }
        Ok(Self {
            velocity,
            acceleration,
            jerk,
        })
    }

    /// Largest velocity.
    #[must_use]
    pub fn velocity(&self) -> f64 {
        self.velocity
    }

    /// Largest acceleration.
    #[must_use]
    pub fn acceleration(&self) -> f64 {
        self.acceleration
    }

    /// Largest jerk.
    #[must_use]
    pub fn jerk(&self) -> f64 {
        self.jerk
    }
}

/// The limits of all axes, in path order.
///
/// Velocity, acceleration and jerk are kept as vectors because planners ask how much of each a
/// direction may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<const N: usize> {
    velocity: Vector<N>,
    acceleration: Vector<N>,
    jerk: Vector<N>,
}

impl<const N: usize> Limits<N> {
    /// Limits from one [`AxisLimits`] per axis.
    #[must_use]
    pub fn new(axes: [AxisLimits; N]) -> Self {
        Self {
            velocity: Vector::from_fn(|axis, _| axes[axis].velocity),
            acceleration: Vector::from_fn(|axis, _| axes[axis].acceleration),
            jerk: Vector::from_fn(|axis, _| axes[axis].jerk),
        }
    }

    /// The same limits for every axis.
    ///
    /// # Errors
    /// As [`AxisLimits::new`].
    pub fn uniform(velocity: f64, acceleration: f64, jerk: f64) -> Result<Self, LimitsError> {
        Ok(Self::new(
            [AxisLimits::new(velocity, acceleration, jerk)?; N],
        ))
    }

    /// The same with every limit multiplied by `factor`.
    ///
    /// # Errors
    /// [`LimitsError`] when a product is not positive and finite.
    pub fn scaled(&self, factor: f64) -> Result<Self, LimitsError> {
        let mut scaled = *self;
        for axis in 0..N {
            let limits = AxisLimits::new(
                factor * self.velocity[axis],
                factor * self.acceleration[axis],
                factor * self.jerk[axis],
            )?;
            scaled.velocity[axis] = limits.velocity;
            scaled.acceleration[axis] = limits.acceleration;
            scaled.jerk[axis] = limits.jerk;
        }
        Ok(scaled)
    }

    /// The limits that a plan keeps so that the executed motion has a reserve to slow down with: velocity as it is,
    /// acceleration times `rho^2`, jerk times `rho^3`, with `rho` of the [`Reserve`].
    ///
    /// # Errors
    /// [`LimitsError`] when a product is smaller than limits may be.
    ///
    /// # Examples
    /// ```
    /// use toolglide_kinematics::{Limits, Reserve};
    /// let limits = Limits::<2>::uniform(500.0, 2_000.0, 5e4)?.reserved(Reserve::new(0.01)?)?;
    /// assert!((limits.acceleration()[0] - 1960.2).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn reserved(&self, reserve: Reserve) -> Result<Self, LimitsError> {
        let rho = reserve.rho();
        let mut reserved = *self;
        for axis in 0..N {
            let limits = AxisLimits::new(
                self.velocity[axis],
                rho * rho * self.acceleration[axis],
                rho * rho * rho * self.jerk[axis],
            )?;
            reserved.acceleration[axis] = limits.acceleration;
            reserved.jerk[axis] = limits.jerk;
        }
        Ok(reserved)
    }

    /// The limits of one axis, counted from 0; `None` for an axis that there is not.
    #[must_use]
    pub fn axis(&self, axis: usize) -> Option<AxisLimits> {
        (axis < N).then(|| AxisLimits {
            velocity: self.velocity[axis],
            acceleration: self.acceleration[axis],
            jerk: self.jerk[axis],
        })
    }

    /// Largest velocity of each axis.
    #[must_use]
    pub fn velocity(&self) -> &Vector<N> {
        &self.velocity
    }

    /// Largest acceleration of each axis.
    #[must_use]
    pub fn acceleration(&self) -> &Vector<N> {
        &self.acceleration
    }

    /// Largest jerk of each axis.
    #[must_use]
    pub fn jerk(&self) -> &Vector<N> {
        &self.jerk
    }

    /// The limits of a motion along `direction` (a unit vector): exact, because such a motion moves
    /// each axis by its share of the direction.
    #[must_use]
    pub fn along(&self, direction: &Vector<N>) -> PathLimits {
        PathLimits {
            velocity: largest_multiple(direction, &self.velocity),
            acceleration: largest_multiple(direction, &self.acceleration),
            jerk: largest_multiple(direction, &self.jerk),
        }
    }
}

/// Limits of velocity, acceleration and jerk of a motion along one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathLimits {
    /// Largest speed.
    pub velocity: f64,
    /// Largest acceleration.
    pub acceleration: f64,
    /// Largest jerk.
    pub jerk: f64,
}

impl PathLimits {
    /// How long it takes to change the speed by `change` (not negative) between zero accelerations.
    #[must_use]
    pub fn time_to_change(&self, change: f64) -> f64 {
        let knee = self.acceleration * self.acceleration / self.jerk;
        if change > knee {
            change / self.acceleration + self.acceleration / self.jerk
        } else {
            2.0 * (change / self.jerk).sqrt()
        }
    }

    /// The speed that can be reached from rest within half of `length`, at most the velocity limit;
    /// a little more than that where the acceleration limit is reached.
    #[must_use]
    pub fn reachable_within(&self, length: f64) -> f64 {
        self.velocity
            .min((self.acceleration * length).sqrt())
            .min((0.25 * self.jerk * length * length).cbrt())
    }
}

/// Largest factor by which `vector` may be multiplied so that no axis exceeds its bound; infinite
/// for the zero vector.
#[must_use]
pub fn largest_multiple<const N: usize>(vector: &Vector<N>, bound: &Vector<N>) -> f64 {
    let mut factor = f64::INFINITY;
    for axis in 0..N {
        let magnitude = vector[axis].abs();
        if magnitude > 0.0 {
            factor = factor.min(bound[axis] / magnitude);
        }
    }
    factor
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagonal_may_use_more_than_either_axis() {
        let limits = Limits::<2>::uniform(100.0, 1000.0, 1e4).unwrap();
        let diagonal = Vector::<2>::new(1.0, 1.0).normalize();
        let along = limits.along(&diagonal);
        assert!(
            (along.velocity - 100.0 * 2.0_f64.sqrt()).abs() < 1e-10,
            "{along:?}"
        );
    }

    #[test]
    fn a_resting_axis_does_not_limit() {
        let limits = Limits::new([
            AxisLimits::new(100.0, 1000.0, 1e4).unwrap(),
            AxisLimits::new(1.0, 1.0, 1.0).unwrap(),
        ]);
        assert!(
            (limits.along(&Vector::<2>::x()).jerk - 1e4).abs() < 1e-9,
            "x alone"
        );
    }

    #[test]
    fn limits_that_no_axis_has_are_refused_with_their_bound() {
        assert!(AxisLimits::new(9e-4, 1e-6, 1e-6).is_ok(), "the least");
        assert!(AxisLimits::new(1.0, 1.0, 1e-3).is_ok(), "the slowest");
        assert!(AxisLimits::new(1e15, 1e15, 1e15).is_ok(), "the largest");
        for (limits, message) in [
            (
                [1.0, 9e-7, 1.0],
                "acceleration limit is 0.0000009, but must be at least 0.000001",
            ),
            (
                [1.0, 1.0, 9.5e-4],
                "jerk limit is 0.00095, so that the acceleration of 1 takes 1053 s to reach, but it may take 1000 s",
            ),
            (
                [1.1e3, 1.0, 1.0],
                "acceleration limit is 1, so that the velocity of 1100 takes 1100 s to reach, but it may take 1000 s",
            ),
            (
                [1.1e15, 1.0, 1.0],
                "velocity limit is 1100000000000000, but may be at most 1e15",
            ),
        ] {
            let [velocity, acceleration, jerk] = limits;
            let refused = AxisLimits::new(velocity, acceleration, jerk).unwrap_err();
            assert_eq!(refused.to_string(), message);
        }
    }

    #[test]
    fn nan_and_infinity_are_refused() {
        for value in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
            assert!(
                AxisLimits::new(value, 1.0, 1.0).is_err(),
                "velocity {value}"
            );
            assert!(
                AxisLimits::new(1.0, value, 1.0).is_err(),
                "acceleration {value}"
            );
            assert!(AxisLimits::new(1.0, 1.0, value).is_err(), "jerk {value}");
        }
    }
}
