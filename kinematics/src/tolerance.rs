//! Bounds how far the motion may leave the path, and how fast it may follow it.
//!
//! Source: the corner error of sections 2.3 and 3.2. The tolerance of the orientation
//! is that of section 5.3.

use crate::error::ToolpathError;
use crate::numeric::{LARGEST_COORDINATE, LARGEST_QUANTITY, MIN_QUANTITY, MIN_SHARE};

/// Corner tolerance: every point of the motion lies within it of the path, and the motion passes
/// within it of every corner. Positive and finite, mm.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Tolerance(f64);

/// A quantity that is finite, positive, no less than anything can be, and no larger than a bound.
fn sized(quantity: &'static str, value: f64, bound: f64) -> Result<f64, ToolpathError> {
    if !(value > 0.0 && value.is_finite()) {
        return Err(ToolpathError::NotPositive { quantity, value });
    }
    if value < MIN_QUANTITY {
        return Err(ToolpathError::TooSmall { quantity, value });
    }
    if value > bound {
        return Err(ToolpathError::TooLarge {
            quantity,
            value,
            bound,
        });
    }
    Ok(value)
}

impl Tolerance {
    /// A tolerance in mm.
    ///
    /// # Errors
    /// [`ToolpathError::NotPositive`] unless it is positive and finite, [`ToolpathError::TooSmall`] below
    /// [`MIN_QUANTITY`], [`ToolpathError::TooLarge`] above [`LARGEST_COORDINATE`].
    pub fn new(length: f64) -> Result<Self, ToolpathError> {
        sized("tolerance", length, LARGEST_COORDINATE).map(Self)
    }

    /// The tolerance in mm.
    #[must_use]
    pub fn length(self) -> f64 {
        self.0
    }

    /// What is left of the tolerance after `used` mm of it; at least a thousandth.
    #[must_use]
    pub fn less(self, used: f64) -> Self {
        Self((self.0 - used.max(0.0)).max(self.0 * MIN_SHARE))
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
    /// [`ToolpathError::NotPositive`] unless it is positive and finite, [`ToolpathError::TooSmall`] below
    /// [`MIN_QUANTITY`], [`ToolpathError::TooLarge`] above [`LARGEST_QUANTITY`].
    pub fn new(speed: f64) -> Result<Self, ToolpathError> {
        sized("feedrate", speed, LARGEST_QUANTITY).map(Self)
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
    /// So many times the tolerance of the orientation may a rotary axis be from its way where the program says how far it
    /// turns: the tool tells little of an axis along which it points, but the axis has its word.
    pub const OF_AXIS: f64 = 10.0;

    /// A tolerance in rad.
    ///
    /// # Errors
    /// [`ToolpathError::NotPositive`] unless it is positive and below a half turn,
    /// [`ToolpathError::TooSmall`] below [`MIN_QUANTITY`].
    pub fn new(angle: f64) -> Result<Self, ToolpathError> {
        let (quantity, value) = ("orientation tolerance", angle);
        if angle >= core::f64::consts::PI {
            return Err(ToolpathError::NotPositive { quantity, value });
        }
        sized(quantity, value, core::f64::consts::PI).map(Self)
    }

    /// The tolerance in rad.
    #[must_use]
    pub fn angle(self) -> f64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_or_none_that_can_be_kept_is_refused_with_its_value() {
        for value in [0.0, -0.0, -1.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            for refused in [
                Tolerance::new(value).map(|_| ()),
                Feedrate::new(value).map(|_| ()),
                OrientationTolerance::new(value).map(|_| ()),
            ] {
                assert!(
                    matches!(refused, Err(ToolpathError::NotPositive { .. })),
                    "{value}: {refused:?}"
                );
            }
        }
        for value in [f64::MIN_POSITIVE, 1e-300, 9e-10] {
            for refused in [
                Tolerance::new(value).map(|_| ()),
                Feedrate::new(value).map(|_| ()),
                OrientationTolerance::new(value).map(|_| ()),
            ] {
                assert!(
                    matches!(refused, Err(ToolpathError::TooSmall { .. })),
                    "{value}: {refused:?}"
                );
            }
            assert!(
                crate::AxisLimits::new(1.0, value, 1.0).is_err(),
                "limit of {value}"
            );
        }
        assert!(Tolerance::new(MIN_QUANTITY).is_ok(), "the least");
        assert!(Tolerance::new(LARGEST_COORDINATE).is_ok(), "the largest");
        assert!(Feedrate::new(LARGEST_QUANTITY).is_ok(), "the largest");
        for (refused, bound) in [
            (Tolerance::new(1.001e7).map(|_| ()), 1e7),
            (Feedrate::new(1.001e15).map(|_| ()), 1e15),
        ] {
            assert!(
                matches!(refused, Err(ToolpathError::TooLarge { bound: told, .. }) if (told - bound).abs() < 1e-9 * bound),
                "{refused:?}"
            );
        }
        assert!(
            matches!(
                crate::AxisLimits::new(1.0, 1.001e15, 1.0),
                Err(crate::LimitsError::TooLarge { .. })
            ),
            "a limit"
        );
    }
}
