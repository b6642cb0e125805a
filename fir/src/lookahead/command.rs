//! Defines the commands from the look-ahead to the sweep.
//!
//! Source: none. Not here: who decides it, and what becomes of it.

use toolglide_kinematics::{MoveRange, Vector};

/// What the look-ahead has decided.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Command<const N: usize> {
    /// A straight pulse, `gap` after the end of the one before.
    Pulse(TimedPulse<N>),
    /// The motion comes to rest.
    Rest,
    /// A pause at rest, or moves that lead nowhere.
    Pause { duration: f64, serves: MoveRange },
    /// From here on, two other filters; only at rest.
    Filters { long: f64, short: f64 },
}

/// A straight pulse with its times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TimedPulse<const N: usize> {
    pub(crate) gap: f64,
    pub(crate) duration: f64,
    pub(crate) from: Vector<N>,
    pub(crate) to: Vector<N>,
    /// That of the whole move: ends of what was cut are rounded.
    pub(crate) velocity: Vector<N>,
    pub(crate) serves: MoveRange,
}
