//! Converts units of a program to mm and s, the only place that does.
//!
//! Source: `G20`, `G21`, `G93` and `G94` of RS274/NGC.

use crate::error::reason::Reason;

/// One inch, mm.
const INCH: f64 = 25.4;

/// One minute, s.
const MINUTE: f64 = 60.0;

/// Coordinates, radii and offsets farther than this are refused, mm: what planners carry.
pub const FARTHEST: f64 = toolglide_kinematics::numeric::LARGEST_COORDINATE;

/// Units of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Units {
    Inch,
    Millimeter,
}

impl Units {
    /// Millimetres in one unit.
    fn scale(self) -> f64 {
        match self {
            Self::Inch => INCH,
            Self::Millimeter => 1.0,
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Inch => "inch",
            Self::Millimeter => "mm",
        }
    }

    /// A length in mm, not checked for size.
    pub(crate) fn length(self, value: f64) -> f64 {
        value * self.scale()
    }

    /// A length of mm in these units.
    pub(crate) fn written(self, length: f64) -> f64 {
        length / self.scale()
    }

    /// A length in mm that may not exceed [`FARTHEST`].
    pub(crate) fn bounded_length(self, letter: char, value: f64) -> Result<f64, Reason> {
        within_reach(letter, self.length(value))
    }

    /// By how much the radii at both ends of an arc may differ for the rounding of its coordinates, mm: twice the
    /// diagonal of 0.01 mm or 0.001 inch, as LinuxCNC has it.
    pub(crate) fn arc_rounding(self) -> f64 {
        let digit = match self {
            Self::Inch => 0.001,
            Self::Millimeter => 0.01,
        };
        2.0 * std::f64::consts::SQRT_2 * self.length(digit)
    }

    /// A feedrate in mm/s from units a minute.
    pub(crate) fn feedrate(self, value: f64) -> f64 {
        self.length(value) / MINUTE
    }
}

/// A feedrate of mm/s in mm/min, to the digits in which people write it.
pub(crate) fn per_minute(speed: f64) -> f64 {
    (speed * MINUTE * 1e6).round() / 1e6
}

/// Refuses a length beyond [`FARTHEST`].
pub(crate) fn within_reach(letter: char, length: f64) -> Result<f64, Reason> {
    if length.abs() <= FARTHEST {
        Ok(length)
    } else {
        Err(Reason::TooFar {
            letter,
            value: length,
            bound: FARTHEST,
        })
    }
}

/// Speed of a move of `length` that lasts one over `rate` minutes.
pub(crate) fn inverse_time(length: f64, rate: f64) -> f64 {
    length * rate / MINUTE
}
