//! Names every reason why a profile cannot exist.

use thiserror::Error;

/// Why a law of motion is refused.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ProfileError {
    /// A bound must be positive.
    #[error("{quantity} is {value}, but must be positive")]
    NotPositive {
        /// Which bound.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// A quantity lies outside its range.
    #[error("{quantity} is {value}, but must lie between {low} and {high}")]
    OutOfRange {
        /// Which quantity.
        quantity: &'static str,
        /// What was given.
        value: f64,
        /// Smallest value allowed.
        low: f64,
        /// Largest value allowed.
        high: f64,
    },
    /// The distance is shorter than the change of state alone needs.
    #[error("distance is {distance} mm, but the change of speed alone needs {needed} mm")]
    TooShort {
        /// What was given.
        distance: f64,
        /// What would have sufficed.
        needed: f64,
    },
    /// An end state would make the motion exceed the feedrate.
    #[error("the end states lead to a speed of {peak} mm/s, but the feedrate is {feedrate} mm/s")]
    TooFast {
        /// Speed after the acceleration of the faster end has run out.
        peak: f64,
        /// What is allowed.
        feedrate: f64,
    },
    /// Integrated forward, the closed form does not meet its request.
    #[error("integrated forward, the {quantity} misses its request by {miss}")]
    NotClosed {
        /// Which quantity.
        quantity: &'static str,
        /// By how much.
        miss: f64,
    },
}
