//! Describes a mode of vibration by frequency and damping.
//!
//! Source: section 4.2.2. Not here: its motion, see [`Resonator`](super::Resonator).

#[cfg(not(feature = "std"))]
use crate::no_std::*;
use core::f64::consts::TAU;
use nalgebra::Complex;
use thiserror::Error;

/// Why a mode is none.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ModeError {
    /// A frequency must be positive and finite.
    #[error("frequency of a mode is {value}, but must be positive and finite")]
    Frequency {
        /// What was given, Hz.
        value: f64,
    },
    /// A damping ratio lies from 0 to below 1.
    #[error(
        "damping ratio of the mode at {frequency} Hz is {damping}, but must be from 0 to below 1"
    )]
    Damping {
        /// Frequency of the mode, Hz.
        frequency: f64,
        /// What was given.
        damping: f64,
    },
}

/// A mode of vibration: a damped oscillator that the acceleration of an axis drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    frequency: f64,
    damping: f64,
}

impl Mode {
    /// A mode of an undamped natural frequency in Hz and a damping ratio from 0 to below 1.
    ///
    /// # Errors
    /// [`ModeError::Frequency`] for a frequency that is not positive and finite, [`ModeError::Damping`] for a damping
    /// ratio outside of its range.
    pub fn new(frequency: f64, damping: f64) -> Result<Self, ModeError> {
        if !(frequency > 0.0 && frequency.is_finite()) {
            return Err(ModeError::Frequency { value: frequency });
        }
        if !(0.0..1.0).contains(&damping) {
            return Err(ModeError::Damping { frequency, damping });
        }
        Ok(Self { frequency, damping })
    }

    /// Undamped natural frequency, Hz.
    #[must_use]
    pub fn frequency(&self) -> f64 {
        self.frequency
    }

    /// Damping ratio.
    #[must_use]
    pub fn damping(&self) -> f64 {
        self.damping
    }

    /// Undamped natural frequency, rad/s.
    #[must_use]
    pub fn natural(&self) -> f64 {
        TAU * self.frequency
    }

    /// Period of the damped oscillation, s.
    #[must_use]
    pub fn period(&self) -> f64 {
        1.0 / (self.frequency * self.damped_share())
    }

    /// Pole of the oscillator in the upper half-plane, 1/s.
    #[must_use]
    pub fn pole(&self) -> Complex<f64> {
        let natural = self.natural();
        Complex::new(-self.damping * natural, natural * self.damped_share())
    }

    /// The same mode at another frequency, as a share of its own.
    ///
    /// # Errors
    /// As [`Mode::new`].
    pub fn detuned(&self, share: f64) -> Result<Self, ModeError> {
        Self::new(self.frequency * share, self.damping)
    }

    /// Damped frequency as a share of the undamped one.
    fn damped_share(&self) -> f64 {
        ((1.0 - self.damping) * (1.0 + self.damping)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_that_are_none_are_refused() {
        for (frequency, damping) in [
            (0.0, 0.1),
            (-5.0, 0.1),
            (f64::NAN, 0.1),
            (f64::INFINITY, 0.1),
            (7.0, 1.0),
            (7.0, -0.1),
            (7.0, f64::NAN),
        ] {
            assert!(
                Mode::new(frequency, damping).is_err(),
                "{frequency}, {damping}"
            );
        }
    }
}
