//! How far the motion may leave the path, and how fast it may follow it.
//!
//! Source: the corner error of sections 2.3 and 3.2. The tolerance of the orientation
//! is that of section 5.3.

use crate::error::ToolpathError;
use crate::numeric::LEAST_SHARE;

/// Corner tolerance: every point of the motion lies within it of the path, and the motion passes
/// within it of every corner. Positive and finite, mm.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Tolerance(f64);

impl Tolerance {
    /// A tolerance in mm.
    ///
    /// # Errors
    /// [`ToolpathError::NotPositive`] unless it is positive and finite.
    pub fn new(length: f64) -> Result<Self, ToolpathError> {
        if length > 0.0 && length.is_finite() {
            Ok(Self(length))
        } else {
            Err(ToolpathError::NotPositive {
                quantity: "tolerance",
                value: length,
            })
        }
    }

    /// The tolerance in mm.
    #[must_use]
    pub fn length(self) -> f64 {
        self.0
    }

    /// What is left of the tolerance after `used` mm of it; at least a thousandth.
    #[must_use]
    pub fn less(self, used: f64) -> Self {
        Self((self.0 - used.max(0.0)).max(self.0 * LEAST_SHARE))
    }

    /// The smaller of two tolerances.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }
}

/// Largest speed along a move, mm/s: positive, and infinite for a rapid, which only the machine
/// limits.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Feedrate(f64);

impl Feedrate {
    /// A rapid: no feedrate but what the axes allow.
    pub const RAPID: Self = Self(f64::INFINITY);

    /// A feedrate in mm/s.
    ///
    /// # Errors
    /// [`ToolpathError::NotPositive`] unless it is positive and finite.
    pub fn new(speed: f64) -> Result<Self, ToolpathError> {
        if speed > 0.0 && speed.is_finite() {
            Ok(Self(speed))
        } else {
            Err(ToolpathError::NotPositive {
                quantity: "feedrate",
                value: speed,
            })
        }
    }

    /// The speed in mm/s; infinite for a rapid.
    #[must_use]
    pub fn speed(self) -> f64 {
        self.0
    }

    /// Whether this is a rapid.
    #[must_use]
    pub fn is_rapid(self) -> bool {
        self.0.is_infinite()
    }
}

/// Orientation tolerance: every orientation of the tool lies within it of the path on the unit
/// sphere, and the motion passes within it of every orientation programmed. Positive and below a
/// half turn, rad.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct OrientationTolerance(f64);

impl OrientationTolerance {
    /// A tolerance in rad.
    ///
    /// # Errors
    /// [`ToolpathError::NotPositive`] unless it is positive and below a half turn.
    pub fn new(angle: f64) -> Result<Self, ToolpathError> {
        if angle > 0.0 && angle < std::f64::consts::PI {
            Ok(Self(angle))
        } else {
            Err(ToolpathError::NotPositive {
                quantity: "orientation tolerance",
                value: angle,
            })
        }
    }

    /// The tolerance in rad.
    #[must_use]
    pub fn angle(self) -> f64 {
        self.0
    }
}
