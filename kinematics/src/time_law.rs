//! Describes how planned time passes while a plan is executed.
//!
//! Source: ours. Not here: what decides it, and the motion itself.

/// How planned time passes over a stretch of time: `rate` grows by `change`, which grows by `bend`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeLaw {
    /// How long it lasts, s.
    pub duration: f64,
    /// Planned time at its start, s, counted from the first piece.
    pub planned: f64,
    /// Planned time by time at its start.
    pub rate: f64,
    /// Derivative of the rate at its start, 1/s.
    pub change: f64,
    /// Second derivative of the rate, constant, 1/s^2.
    pub bend: f64,
}
