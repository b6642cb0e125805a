//! Sets notches of filter chains on modes of vibration, and tells what a chain leaves of one.
//!
//! Source: section 4.2.2, equations 4.10 to 4.12; the damped residual is ours. Not here: the modes themselves, which
//! `kinematics` defines.

use crate::error::FirError;
use crate::filter::chain::FilterChain;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::{Mode, SamplePeriod};

impl FilterChain {
    /// What of the oscillation of a mode after an unfiltered step of velocity is left at the end of a
    /// filtered one, as a share of its amplitude.
    ///
    /// # Source
    /// The transfer function at the pole of the mode; without damping it is the magnitude of the
    /// [gain](FilterChain::gain).
    #[must_use]
    pub fn residual(&self, mode: &Mode) -> f64 {
        (-mode.damping() * mode.natural() * self.total_delay()).exp()
            * modulus(self.transfer(mode.pole()))
    }

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
    /// use toolglide_fir::FilterChain;
    /// use toolglide_kinematics::{Mode, SamplePeriod};
    /// let modes = [Mode::new(7.4, 0.0)?, Mode::new(9.2, 0.0)?];
    /// let chain = FilterChain::silencing(&modes, &[], SamplePeriod::new(0.0001)?)?;
    /// assert_eq!(chain.time_constants(), [0.1351, 0.1087]);
    /// assert!(modes.iter().all(|mode| chain.residual(mode) < 0.001));
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
            if mode.frequency() >= nyquist {
                return Err(FirError::ModeAboveNyquist {
                    frequency: mode.frequency(),
                    nyquist,
                });
            }
            time_constants.push(mode.period());
        }
        time_constants.extend_from_slice(further);
        Self::with_time_constants(&time_constants)?.rounded_to(period)
    }
}

/// Modulus of a complex number, also where there is no standard library.
fn modulus(z: toolglide_kinematics::nalgebra::Complex<f64>) -> f64 {
    z.re.hypot(z.im)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Settings, plan};
    use toolglide_kinematics::nalgebra::Complex;
    use toolglide_kinematics::{Feedrate, Limits, Plan, Resonator, Tolerance, Toolpath, Vector};

    #[test]
    fn the_residual_of_a_damped_mode_is_that_of_print() {
        let chain = FilterChain::with_time_constants(&[0.1361, 0.1109]).unwrap();
        let residual = chain.residual(&Mode::new(7.4, 0.01).unwrap());
        assert!((residual - 0.002_395_404_848).abs() < 1e-12, "{residual}");
    }

    #[test]
    fn a_mode_that_is_off_by_a_twentieth_leaves_a_twentieth() {
        let chain = FilterChain::with_time_constants(&[1.0 / 7.4]).unwrap();
        for off in [0.95, 1.05] {
            let residual = chain.residual(&Mode::new(7.4 * off, 0.0).unwrap());
            assert!(residual < 0.0535, "{off}: {residual}");
        }
    }

    #[test]
    fn a_simulated_mode_is_left_with_the_residual() {
        // The pulse response of the oscillator against the velocity step, added up numerically.
        let chain = FilterChain::with_time_constants(&[0.11, 0.07]).unwrap();
        let mode = Mode::new(6.1, 0.02).unwrap();
        let natural = mode.natural();
        let damped = mode.pole().im;
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
            (sum.norm() - chain.residual(&mode)).abs() < 1e-8,
            "{}",
            sum.norm()
        );
    }

    #[test]
    fn modes_above_half_the_frequency_of_the_set_points_are_refused() {
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

    fn straight(lengths: &[f64]) -> Plan<1> {
        let points = [0.0, 80.0].map(|x| Vector::<1>::from([x]));
        let path = Toolpath::from_points(
            &points,
            Feedrate::new(50.0).unwrap(),
            Tolerance::new(0.03).unwrap(),
        )
        .unwrap();
        let chain = FilterChain::with_time_constants(lengths).unwrap();
        let limits = Limits::uniform(500.0, 1e5, 1e9).unwrap();
        plan(&path, &Settings::new(limits).with_chain(&chain).unwrap()).unwrap()
    }

    fn left(motion: &Plan<1>, frequency: f64, damping: f64) -> f64 {
        let mut resonator = Resonator::new(&Mode::new(frequency, damping).unwrap());
        for piece in motion.pieces() {
            let start = piece.at(0.0);
            resonator.pass(start.acceleration[0], start.jerk[0], piece.duration());
        }
        resonator.displacement()
    }

    #[test]
    fn a_matched_mode_is_left_with_less_than_a_hundredth() {
        // Nearly unfiltered: a hundredth of a period.
        let unfiltered = left(&straight(&[1e-3, 1e-3]), 7.4, 0.0);
        for (mode, most) in [(7.4, 0.01), (0.95 * 7.4, 0.05), (1.05 * 7.4, 0.05)] {
            let share = left(&straight(&[1.0 / 7.4, 0.1087]), mode, 0.0) / unfiltered;
            assert!(share <= most, "{mode} Hz: {share}");
        }
    }
}
