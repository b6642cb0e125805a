//! Names every reason why there is no optimum.
//!
//! Not here: what is wrong with a path or a limit, which their own crate refuses.

use thiserror::Error;

/// Why there is no optimum.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ReferenceError {
    /// Nothing to move along.
    #[error("the course has no leg that is longer than {shortest} mm")]
    Empty {
        /// Shortest length that counts, mm.
        shortest: f64,
    },
    /// Durations of legs that do not fit the course.
    #[error("{given} durations were given for {legs} legs")]
    Durations {
        /// How many were given.
        given: usize,
        /// How many legs there are.
        legs: usize,
    },
    /// A duration or a length that must be positive and finite.
    #[error("leg {leg}: {quantity} is {value}, but must be positive and finite")]
    NotPositive {
        /// The leg, counted from 0.
        leg: usize,
        /// Which quantity.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// Zones around two corners that overlap.
    #[error("leg {leg}: it is {length} mm long, but the zones around its corners need {needed} mm")]
    Zones {
        /// The leg, counted from 0.
        leg: usize,
        /// Its length, mm.
        length: f64,
        /// What the zones take of it, mm.
        needed: f64,
    },
    /// The search over all assignments is for one corner.
    #[error("the course has {legs} legs, but a certificate is for two")]
    NotOneCorner {
        /// How many legs it has.
        legs: usize,
    },
    /// The solver found no solution that can be used.
    #[error("the program of {intervals} intervals over {legs} legs was not solved")]
    NotSolved {
        /// Intervals of time.
        intervals: usize,
        /// Legs.
        legs: usize,
    },
    /// The motion that was found did not pass the judge.
    #[error("the motion over {legs} legs was refused by the judge: {reason}")]
    Refused {
        /// Legs.
        legs: usize,
        /// What the judge says first.
        reason: String,
    },
    /// A motion that belongs to another course.
    #[error("the motion starts or ends {distance} mm away from the course")]
    Elsewhere {
        /// How far away, mm.
        distance: f64,
    },
}
