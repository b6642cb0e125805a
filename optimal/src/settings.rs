//! Holds limits and effort of a plan.
//!
//! Source: ours, from measurements. Not here: the planning.

use crate::path::spans::Fineness;
use toolglide_kinematics::Limits;

/// How much is spent on a plan: from 1, which is quick, to 9, which leaves hardly anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Effort(u8);

impl Effort {
    /// The usual one.
    pub const DEFAULT: Self = Self(5);

    /// An effort from 1 to 9; `None` for any other level.
    #[must_use]
    pub fn new(level: u8) -> Option<Self> {
        (1..=9).contains(&level).then_some(Self(level))
    }

    /// The level, 1 to 9.
    #[must_use]
    pub fn level(self) -> u8 {
        self.0
    }

    /// Linearised problems allowed for a window.
    pub(crate) fn solves(self) -> usize {
        5 + usize::from(self.0)
    }

    /// Length of a window in times to stop: the part that is handed out, and from one upwards for the way
    /// on to be free and for the stop at the end.
    pub(crate) fn window(self) -> f64 {
        4.0 + 0.3 * f64::from(self.0)
    }

    /// Interval as a share of the time in which the acceleration is built up: from a sixth down to a
    /// thirtieth. What the interval costs in cycle time goes with its square, what it saves in planning
    /// with itself.
    pub(crate) fn fineness(self) -> Fineness {
        Fineness(0.17 * 0.82_f64.powi(i32::from(self.0) - 1))
    }
}

impl Default for Effort {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// What a plan must keep, and how much may be spent on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<const N: usize> {
    /// Limits of the axes.
    pub limits: Limits<N>,
    /// How much is spent.
    pub effort: Effort,
}

impl<const N: usize> Settings<N> {
    /// The usual effort.
    #[must_use]
    pub fn new(limits: Limits<N>) -> Self {
        Self {
            limits,
            effort: Effort::DEFAULT,
        }
    }

    /// The same with another effort.
    #[must_use]
    pub fn with_effort(mut self, effort: Effort) -> Self {
        self.effort = effort;
        self
    }
}
