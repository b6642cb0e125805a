//! Names every reason why a filter chain or a plan of filtered pulses is refused.
//!
//! Source: section 4.2. Not here: what is wrong with a path, which `kinematics` says.

use thiserror::Error;

/// Why a filter chain, or a motion through one, is refused.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FirError {
    /// A quantity must be positive and finite.
    #[error("{quantity} is {value}, but must be positive and finite")]
    NotPositive {
        /// Which quantity.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// A chain has at least one filter and at most [`MAX_FILTERS`](crate::MAX_FILTERS).
    #[error("a chain has 1 to {most} filters, but {given} were given")]
    FilterCount {
        /// How many were given.
        given: usize,
        /// Most that serve.
        most: usize,
    },
    /// Behind a single filter acceleration jumps, which no limit of jerk allows.
    #[error(
        "one filter alone, of {time_constant} s, leaves jerk without a bound; \
         motion needs a second filter"
    )]
    SingleFilter {
        /// Its time constant, s.
        time_constant: f64,
    },
    /// A time constant is at least [`SHORTEST_TIME_CONSTANT`](crate::SHORTEST_TIME_CONSTANT).
    #[error("time constant is {time_constant:e} s, but {shortest:e} s is the shortest")]
    TooShort {
        /// What was given, s.
        time_constant: f64,
        /// The shortest, s.
        shortest: f64,
    },
    /// A time constant is at most [`LONGEST_TIME_CONSTANT`](crate::LONGEST_TIME_CONSTANT).
    #[error("time constant is {time_constant} s, but {longest} s is the longest")]
    TooLong {
        /// What was given, s.
        time_constant: f64,
        /// The longest, s.
        longest: f64,
    },
    /// Nothing is left of a filter that is shorter than half a period.
    #[error(
        "time constant {time_constant} s is shorter than half the period of {period} s; \
         shorten the period or drop the filter"
    )]
    PeriodTooLong {
        /// The period, s.
        period: f64,
        /// The time constant, s.
        time_constant: f64,
    },
    /// The sums of so many ticks do not fit.
    #[error("{ticks} ticks are too many: {most} and less are held, and fewer behind many filters")]
    TooManyTicks {
        /// How many.
        ticks: usize,
        /// Most that are held.
        most: usize,
    },
    /// A move must last a tick at least.
    #[error("a move of {duration} s is shorter than the period of {period} s")]
    ShorterThanTick {
        /// How long it would last, s.
        duration: f64,
        /// The period, s.
        period: f64,
    },
    /// A circle that is smaller than its tolerance has no largest feedrate.
    #[error("tolerance {tolerance} mm is not below the radius of {radius} mm")]
    ToleranceAboveRadius {
        /// The tolerance, mm.
        tolerance: f64,
        /// The radius, mm.
        radius: f64,
    },
    /// A mode beyond half the frequency of the set-points cannot be silenced by them.
    #[error("mode at {frequency} Hz is above {nyquist} Hz, half the frequency of the set-points")]
    ModeAboveNyquist {
        /// Frequency of the mode, Hz.
        frequency: f64,
        /// Half the frequency of the set-points, Hz.
        nyquist: f64,
    },
}
