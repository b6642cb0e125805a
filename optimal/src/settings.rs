//! Holds limits and effort of a plan.
//!
//! Source: ours, from measurements. Not here: the planning.

use crate::path::spans::{Fineness, weakest};
use thiserror::Error;
use toolglide_kinematics::{AxisModes, Limits, PathSide};

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

/// How much slower than the fastest motion one may be that is smoother, as a share of its duration.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Smoothing(f64);

impl Smoothing {
    /// The usual one: a thousandth. Below it, jerk grows fast; above it, little is gained.
    pub const DEFAULT: Self = Self(1e-3);

    /// No smoothing: the fastest motion that is found.
    pub const NONE: Self = Self(0.0);

    /// Largest share.
    pub const MAX: f64 = 0.1;

    /// A share from 0 to [`Self::MAX`]; `None` for any other number.
    #[must_use]
    pub fn new(share: f64) -> Option<Self> {
        (0.0..=Self::MAX).contains(&share).then_some(Self(share))
    }

    /// The share.
    #[must_use]
    pub fn share(self) -> f64 {
        self.0
    }

    /// By which share a motion may be slower than another that has more jerk, and still take its place.
    #[must_use]
    pub fn indifference(self) -> f64 {
        INDIFFERENCE * self.0
    }
}

impl Default for Smoothing {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// A mode of vibration that no window is long enough to silence.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "mode of axis {axis} at {frequency} Hz is too slow: a window of these limits silences modes from {slowest:.2} Hz on"
)]
pub struct ModeTooSlow {
    /// The axis, counted from 0.
    pub axis: usize,
    /// Frequency of the mode, Hz.
    pub frequency: f64,
    /// The lowest frequency that is silenced, Hz.
    pub slowest: f64,
}

/// The longest period of a mode that a window of the most intervals silences, s.
fn longest_period<const N: usize>(limits: &Limits<N>, effort: Effort) -> f64 {
    let (acceleration, jerk) = weakest(limits);
    let build_up = acceleration / jerk;
    // Two periods fit into a window.
    0.9 * MAX_STEPS_OF_WINDOW * effort.fineness().0 * build_up
}

/// Intervals of the longest window.
const MAX_STEPS_OF_WINDOW: f64 = 320.0;

/// Motions whose durations differ by less than this many times the share of smoothing are taken by their jerk.
const INDIFFERENCE: f64 = 1.5;

/// What a plan must keep, and how much may be spent on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<const N: usize> {
    /// Limits of the axes.
    pub limits: Limits<N>,
    /// How much is spent.
    pub effort: Effort,
    /// How much slower than the fastest a smoother motion may be.
    pub smoothing: Smoothing,
    /// Modes of vibration that rest wherever the motion rests; none where it may leave them swinging.
    pub modes: AxisModes,
    /// On which side of straight lines the motion stays.
    pub side: PathSide,
    /// How far it may go on the other side, mm.
    pub overshoot: f64,
}

impl<const N: usize> Settings<N> {
    /// The usual effort.
    #[must_use]
    pub fn new(limits: Limits<N>) -> Self {
        Self {
            limits,
            effort: Effort::DEFAULT,
            smoothing: Smoothing::DEFAULT,
            modes: AxisModes::default(),
            side: PathSide::Both,
            overshoot: 0.0,
        }
    }

    /// The same with another effort.
    #[must_use]
    pub fn with_effort(mut self, effort: Effort) -> Self {
        self.effort = effort;
        self
    }

    /// The same with modes of vibration that rest wherever the motion rests.
    ///
    /// # Errors
    /// [`ModeTooSlow`] for a mode that no window is long enough to silence.
    pub fn with_modes(mut self, modes: AxisModes) -> Result<Self, ModeTooSlow> {
        let longest = longest_period(&self.limits, self.effort);
        for mode in modes.iter() {
            if mode.mode.period() > longest {
                return Err(ModeTooSlow {
                    axis: mode.axis,
                    frequency: mode.mode.frequency(),
                    slowest: 1.0 / longest,
                });
            }
        }
        self.modes = modes;
        Ok(self)
    }

    /// The same on one side of straight lines, with so much overshoot allowed on the other, mm; a number that is not
    /// positive and finite allows none.
    #[must_use]
    pub fn with_side(mut self, side: PathSide, overshoot: f64) -> Self {
        self.side = side;
        self.overshoot = if overshoot.is_finite() {
            overshoot.max(0.0)
        } else {
            0.0
        };
        self
    }

    /// The same with another share of smoothing.
    #[must_use]
    pub fn with_smoothing(mut self, smoothing: Smoothing) -> Self {
        self.smoothing = smoothing;
        self
    }
}
