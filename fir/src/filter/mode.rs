//! Describes modes of vibration: the residual behind a chain, and the chain that silences them.
//!
//! Source: section 4.2.2, equations 4.10 to 4.12; the damped residual is ours. Not here: simulation.

use crate::error::FirError;
use crate::filter::chain::FilterChain;
use std::f64::consts::TAU;
use toolglide_kinematics::SamplePeriod;
use toolglide_kinematics::nalgebra::Complex;

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
    /// [`FirError::NotPositive`] for a frequency that is not positive and finite,
    /// [`FirError::Damping`] for a damping ratio outside of its range.
    pub fn new(frequency: f64, damping: f64) -> Result<Self, FirError> {
        if !(frequency > 0.0 && frequency.is_finite()) {
            return Err(FirError::NotPositive {
                quantity: "frequency of a mode",
                value: frequency,
            });
        }
        if !(0.0..1.0).contains(&damping) {
            return Err(FirError::Damping { frequency, damping });
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

    /// Period of the damped oscillation, s.
    #[must_use]
    pub fn period(&self) -> f64 {
        1.0 / (self.frequency * self.damped_share())
    }

    /// What of the oscillation after an unfiltered step of velocity is left at the end of a filtered
    /// one, as a share of its amplitude.
    ///
    /// # Source
    /// The transfer function at the pole of the mode; without damping it is the magnitude of the
    /// [gain](FilterChain::gain).
    #[must_use]
    pub fn residual(&self, chain: &FilterChain) -> f64 {
        let natural = TAU * self.frequency;
        let pole = self.pole();
        (-self.damping * natural * chain.total_delay()).exp() * chain.transfer(pole).norm()
    }

    /// Pole of the oscillator in the upper half-plane, 1/s.
    pub(crate) fn pole(&self) -> Complex<f64> {
        let natural = TAU * self.frequency;
        Complex::new(-self.damping * natural, natural * self.damped_share())
    }

    fn damped_share(&self) -> f64 {
        ((1.0 - self.damping) * (1.0 + self.damping)).sqrt()
    }
}

impl FilterChain {
    /// A chain with one notch on each mode and as many further filters as are given.
    ///
    /// A filter is as long as one period of its mode, rounded to `period`, so that set-points keep the
    /// notch.
    ///
    /// # Source
    /// Section 4.2.2.
    ///
    /// # Errors
    /// [`FirError::ModeAboveNyquist`] for a mode that set-points of this period cannot shape, and as
    /// [`FilterChain::with_time_constants`].
    ///
    /// # Examples
    /// ```
    /// use toolglide_fir::{FilterChain, Mode};
    /// use toolglide_kinematics::SamplePeriod;
    /// let modes = [Mode::new(7.4, 0.0)?, Mode::new(9.2, 0.0)?];
    /// let chain = FilterChain::silencing(&modes, &[], SamplePeriod::new(0.0001)?)?;
    /// assert_eq!(chain.time_constants(), [0.1351, 0.1087]);
    /// assert!(modes.iter().all(|mode| mode.residual(&chain) < 0.001));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn silencing(
        modes: &[Mode],
        further: &[f64],
        period: SamplePeriod,
    ) -> Result<Self, FirError> {
        let nyquist = 0.5 / period.seconds();
        let mut time_constants = Vec::with_capacity(modes.len() + further.len());
        for mode in modes {
            if mode.frequency >= nyquist {
                return Err(FirError::ModeAboveNyquist {
                    frequency: mode.frequency,
                    nyquist,
                });
            }
            time_constants.push(mode.period());
        }
        time_constants.extend_from_slice(further);
        Self::with_time_constants(&time_constants)?.rounded_to(period)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_residual_of_a_damped_mode_is_that_of_print() {
        let chain = FilterChain::with_time_constants(&[0.1361, 0.1109]).unwrap();
        let residual = Mode::new(7.4, 0.01).unwrap().residual(&chain);
        assert!((residual - 0.002_395_404_848).abs() < 1e-12, "{residual}");
    }

    #[test]
    fn a_mode_that_is_off_by_a_twentieth_leaves_a_twentieth() {
        let chain = FilterChain::with_time_constants(&[1.0 / 7.4]).unwrap();
        for off in [0.95, 1.05] {
            let residual = Mode::new(7.4 * off, 0.0).unwrap().residual(&chain);
            assert!(residual < 0.0535, "{off}: {residual}");
        }
    }

    #[test]
    fn a_simulated_mode_is_left_with_the_residual() {
        // The pulse response of the oscillator against the velocity step, added up numerically.
        let chain = FilterChain::with_time_constants(&[0.11, 0.07]).unwrap();
        let mode = Mode::new(6.1, 0.02).unwrap();
        let natural = TAU * mode.frequency();
        let damped = natural * mode.damped_share();
        let parts = 200_000;
        let step = chain.total_delay() / f64::from(parts);
        let mut sum = Complex::new(0.0, 0.0);
        for part in 0..parts {
            let time = (f64::from(part) + 0.5) * step;
            let left = chain.total_delay() - time;
            sum += Complex::new(-mode.damping() * natural * left, damped * left).exp()
                * (chain.acceleration(time) * step);
        }
        assert!(
            (sum.norm() - mode.residual(&chain)).abs() < 1e-8,
            "{}",
            sum.norm()
        );
    }

    #[test]
    fn modes_that_are_none_or_too_fast_are_refused() {
        for (frequency, damping) in [
            (0.0, 0.1),
            (f64::NAN, 0.1),
            (7.0, 1.0),
            (7.0, -0.1),
            (7.0, f64::NAN),
        ] {
            assert!(
                Mode::new(frequency, damping).is_err(),
                "{frequency}, {damping}"
            );
        }
        let period = SamplePeriod::new(0.001).unwrap();
        assert_eq!(
            FilterChain::silencing(&[Mode::new(600.0, 0.0).unwrap()], &[], period),
            Err(FirError::ModeAboveNyquist {
                frequency: 600.0,
                nyquist: 500.0
            }),
            "above"
        );
    }
}
