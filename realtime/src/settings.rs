//! Holds the numbers that an executor is made with, and checks them.

use crate::law::Ratios;
use thiserror::Error;
use toolglide_kinematics::{Limits, Reserve, SamplePeriod, Vector};

/// Steps shorter than this are joined, s: a decision costs the same whatever the step.
const SHORTEST_STEP: f64 = 0.001;

/// Greatest override that may be asked for.
const MAX_OVERRIDE: f64 = 100.0;

/// Why an executor cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// The greatest override must be at least 1.
    #[error("greatest override is {value}, but must be from 1 to {MAX_OVERRIDE}")]
    GreatestOverride {
        /// The value given.
        value: f64,
    },
    /// A feedrate must be positive.
    #[error("greatest feedrate is {value} mm/s, but must be positive")]
    Fastest {
        /// The value given, mm/s.
        value: f64,
    },
    /// A period is too long for the law.
    #[error("step is {step} s, but may be at most {most} s for these limits")]
    Step {
        /// The step, s.
        step: f64,
        /// The longest, s.
        most: f64,
    },
}

/// How an override below the greatest works.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OverrideKind {
    /// The speed along the path is capped at the override times the feedrate; corners stay as fast as planned.
    #[default]
    Capped,
    /// The rate of time is the override by the greatest: everything slows down alike.
    Uniform,
}

/// The numbers that an executor is made with.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings<const N: usize> {
    pub(crate) limits: Limits<N>,
    pub(crate) reserve: Reserve,
    pub(crate) period: SamplePeriod,
    pub(crate) ticks: u32,
    pub(crate) greatest: f64,
    pub(crate) kind: OverrideKind,
    pub(crate) fastest: Vector<N>,
    pub(crate) ahead: usize,
    pub(crate) behind: usize,
    pub(crate) patience: f64,
}

impl<const N: usize> Settings<N> {
    /// The limits of the machine, and the period of its ticks. The plan keeps the limits less the usual reserve.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a cast of a large number saturates"
    )]
    pub fn new(limits: Limits<N>, period: SamplePeriod) -> Self {
        let ticks = (SHORTEST_STEP / period.seconds() + 0.5) as u32;
        Self {
            limits,
            reserve: Reserve::default(),
            period,
            ticks: ticks.max(1),
            greatest: 1.0,
            kind: OverrideKind::default(),
            fastest: *limits.velocity(),
            ahead: 4096,
            behind: 1024,
            patience: 0.5,
        }
    }

    /// The same for a plan made with another reserve.
    #[must_use]
    pub fn with_reserve(mut self, reserve: Reserve) -> Self {
        self.reserve = reserve;
        self
    }

    /// The same with a decision every so many ticks, at least one.
    #[must_use]
    pub fn with_ticks_per_step(mut self, ticks: u32) -> Self {
        self.ticks = ticks.max(1);
        self
    }

    /// The same for a plan made at `greatest` times the programmed feedrates.
    ///
    /// # Errors
    /// [`SettingsError::GreatestOverride`] unless it is from 1 to 100.
    pub fn with_greatest_override(
        mut self,
        greatest: f64,
        kind: OverrideKind,
    ) -> Result<Self, SettingsError> {
        if !(1.0..=MAX_OVERRIDE).contains(&greatest) {
            return Err(SettingsError::GreatestOverride { value: greatest });
        }
        self.greatest = greatest;
        self.kind = kind;
        Ok(self)
    }

    /// The same for a plan whose speed along the path never exceeds `speed`, mm/s: the greatest feedrate times the
    /// greatest override. Slower plans stop sooner.
    ///
    /// # Errors
    /// [`SettingsError::Fastest`] unless it is positive.
    pub fn with_fastest(mut self, speed: f64) -> Result<Self, SettingsError> {
        if speed.is_nan() || speed <= 0.0 {
            return Err(SettingsError::Fastest { value: speed });
        }
        self.fastest = self.limits.velocity().map(|v| v.min(speed));
        Ok(self)
    }

    /// The same with room for so many pieces ahead, and as many kept behind for going backwards.
    #[must_use]
    pub fn with_room(mut self, ahead: usize, behind: usize) -> Self {
        (self.ahead, self.behind) = (ahead.max(16), behind);
        self
    }

    /// Length of a step, s.
    #[must_use]
    pub fn step(&self) -> f64 {
        f64::from(self.ticks) * self.period.seconds()
    }

    pub(crate) fn ratios(&self) -> Ratios {
        let mut ratios = Ratios {
            rise: 0.0,
            by_jerk: 0.0,
            by_acceleration: 0.0,
        };
        for axis in 0..N {
            let (v, a, j) = (
                self.fastest[axis],
                self.limits.acceleration()[axis],
                self.limits.jerk()[axis],
            );
            ratios.rise = ratios.rise.max(a / j);
            ratios.by_jerk = ratios.by_jerk.max(v / j);
            ratios.by_acceleration = ratios.by_acceleration.max(v / a);
        }
        ratios
    }
}
