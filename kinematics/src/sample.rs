//! Represents the state of a motion at an instant, and the sample period of a controller.
//!
//! Source: section 2.2. Not here: what makes the motion.

use crate::error::ToolpathError;
use crate::vector::Vector;

/// Position, velocity, acceleration and jerk of all axes at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<const N: usize> {
    /// Position of each axis.
    pub position: Vector<N>,
    /// Velocity of each axis.
    pub velocity: Vector<N>,
    /// Acceleration of each axis.
    pub acceleration: Vector<N>,
    /// Jerk of each axis; at a knot, that of the piece that follows.
    pub jerk: Vector<N>,
}

impl<const N: usize> Sample<N> {
    /// At rest.
    #[must_use]
    pub fn at_rest(position: Vector<N>) -> Self {
        Self {
            position,
            velocity: Vector::zeros(),
            acceleration: Vector::zeros(),
            jerk: Vector::zeros(),
        }
    }
}

/// Time between two set-points, s: positive and finite.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct SamplePeriod(f64);

impl SamplePeriod {
    /// A period in seconds.
    ///
    /// # Errors
    /// [`ToolpathError::NotPositive`] unless it is positive and finite.
    pub fn new(seconds: f64) -> Result<Self, ToolpathError> {
        if seconds > 0.0 && seconds.is_finite() {
            Ok(Self(seconds))
        } else {
            Err(ToolpathError::NotPositive {
                quantity: "period",
                value: seconds,
            })
        }
    }

    /// The period in seconds.
    #[must_use]
    pub fn seconds(self) -> f64 {
        self.0
    }
}
