//! Defines a chain of moving averages: time constants, delay, transfer function.
//!
//! Source: sections 4.2.1 and 4.2.2, equations 4.1, 4.2, 4.10 and 4.11. Not here: responses against
//! time, see the kernel.

use crate::error::FirError;
use toolglide_kinematics::SamplePeriod;
use toolglide_kinematics::nalgebra::Complex;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// Most filters in a chain: a chain of eight has 256 corners in its response, and each filter more
/// doubles them.
pub const MAX_FILTERS: usize = 8;

/// Longest time constant, s: one period of 0.1 Hz, far below the modes of any machine. Positions are
/// cubic in time, so that behind much longer filters they would lose nanometres.
pub const LONGEST_TIME_CONSTANT: f64 = 10.0;

/// Shortest time constant, s: a microsecond, far below any servo period. The jerk of a chain goes with one over the
/// product of two, and times are told apart by a picosecond.
pub const SHORTEST_TIME_CONSTANT: f64 = 1e-6;

/// A product of angular frequency and time constant below this leaves a filter without effect: its
/// gain differs from 1 by less than the rounding.
const NO_EFFECT: f64 = 1e-8;

/// Moving averages in a row, each of unit gain: their order does not matter.
///
/// Whatever passes through the chain becomes the average of itself over the last
/// [`total_delay`](Self::total_delay) seconds, weighted by the kernel of the chain. So a filtered
/// position is a mean of commanded positions, a filtered velocity one of commanded velocities.
///
/// # Source
/// Equations 4.1 and 4.2.
///
/// # Examples
/// ```
/// use toolglide_fir::FilterChain;
/// let chain = FilterChain::with_time_constants(&[0.06, 0.1])?;
/// assert_eq!(chain.time_constants(), [0.1, 0.06]);
/// assert!(chain.gain(core::f64::consts::TAU * 10.0).abs() < 1e-15, "10 Hz is a notch");
/// # Ok::<(), toolglide_fir::FirError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FilterChain {
    time_constants: Vec<f64>,
    total_delay: f64,
    product: f64,
    /// Sums of the time constants of all subsets with the signs of their sizes, in increasing order.
    pub(crate) shifts: Vec<(f64, f64)>,
}

impl FilterChain {
    /// A chain of moving averages of the given lengths in seconds, in any order.
    ///
    /// # Errors
    /// [`FirError::FilterCount`] for none or for more than [`MAX_FILTERS`],
    /// [`FirError::NotPositive`] for a time constant that is not positive and finite,
    /// [`FirError::TooShort`] for one below [`SHORTEST_TIME_CONSTANT`],
    /// [`FirError::TooLong`] for one above [`LONGEST_TIME_CONSTANT`].
    pub fn with_time_constants(time_constants: &[f64]) -> Result<Self, FirError> {
        let given = time_constants.len();
        if !(1..=MAX_FILTERS).contains(&given) {
            return Err(FirError::FilterCount {
                given,
                most: MAX_FILTERS,
            });
        }
        for &value in time_constants {
            if !(value > 0.0 && value.is_finite()) {
                return Err(FirError::NotPositive {
                    quantity: "time constant",
                    value,
                });
            }
        }
        for &time_constant in time_constants {
            if time_constant < SHORTEST_TIME_CONSTANT {
                return Err(FirError::TooShort {
                    time_constant,
                    shortest: SHORTEST_TIME_CONSTANT,
                });
            }
            if time_constant > LONGEST_TIME_CONSTANT {
                return Err(FirError::TooLong {
                    time_constant,
                    longest: LONGEST_TIME_CONSTANT,
                });
            }
        }
        let mut sorted = time_constants.to_vec();
        sorted.sort_by(|one, other| other.total_cmp(one));
        let mut shifts = vec![(0.0, 1.0)];
        for &length in &sorted {
            for index in 0..shifts.len() {
                let (shift, sign): (f64, f64) = shifts[index];
                shifts.push((shift + length, -sign));
            }
        }
        shifts.sort_by(|one, other| one.0.total_cmp(&other.0));
        Ok(Self {
            total_delay: sorted.iter().sum(),
            product: sorted.iter().product(),
            time_constants: sorted,
            shifts,
        })
    }

    /// The same chain with every time constant a whole number of periods, rounded to the nearest.
    ///
    /// # Source
    /// Equation 4.35 truncates, which loses a period for one length in six; it must round.
    ///
    /// # Errors
    /// [`FirError::PeriodTooLong`] when a filter would vanish.
    pub fn rounded_to(&self, period: SamplePeriod) -> Result<Self, FirError> {
        let period = period.seconds();
        let rounded: Result<Vec<_>, _> = self
            .time_constants
            .iter()
            .map(|&time_constant| {
                let ticks = (time_constant / period).round();
                if ticks >= 1.0 {
                    Ok(ticks * period)
                } else {
                    Err(FirError::PeriodTooLong {
                        period,
                        time_constant,
                    })
                }
            })
            .collect();
        Self::with_time_constants(&rounded?)
    }

    /// The lengths of the filters, the longest first.
    #[must_use]
    pub fn time_constants(&self) -> &[f64] {
        &self.time_constants
    }

    /// Sum of the time constants: how long the chain remembers. What passes through is late by half
    /// of it.
    #[must_use]
    pub fn total_delay(&self) -> f64 {
        self.total_delay
    }

    /// Product of the time constants.
    #[must_use]
    pub(crate) fn product(&self) -> f64 {
        self.product
    }

    /// Variance of the kernel, s²: a curve that is followed at constant speed `F` with radius `R` is
    /// cut by `F²/2R` times this, to first order.
    #[must_use]
    pub fn variance(&self) -> f64 {
        self.time_constants.iter().map(|t| t * t).sum::<f64>() / 12.0
    }

    /// Gain at an angular frequency, rad/s, with the sign that it has once the delay is taken off.
    ///
    /// # Source
    /// Equations 4.10 and 4.11; the printed one lacks the magnitude and halves a denominator.
    #[must_use]
    pub fn gain(&self, angular_frequency: f64) -> f64 {
        self.time_constants
            .iter()
            .map(|length| {
                let half = 0.5 * angular_frequency * length;
                if half.abs() < NO_EFFECT {
                    1.0
                } else {
                    half.sin() / half
                }
            })
            .product()
    }

    /// Transfer function at a complex frequency `s`, 1/s.
    ///
    /// # Source
    /// Equation 4.2: the product of `(1 - exp(-s T)) / (s T)`.
    #[must_use]
    pub fn transfer(&self, s: Complex<f64>) -> Complex<f64> {
        self.time_constants
            .iter()
            .map(|&length| {
                let z = s * length;
                if z.re.hypot(z.im) < NO_EFFECT {
                    Complex::new(1.0, 0.0) - z * 0.5
                } else {
                    (Complex::new(1.0, 0.0) - (-z).exp()) / z
                }
            })
            .product()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;

    #[test]
    fn lengths_that_are_no_lengths_are_refused_with_their_value() {
        for value in [0.0, -0.1, f64::INFINITY] {
            assert_eq!(
                FilterChain::with_time_constants(&[0.1, value]),
                Err(FirError::NotPositive {
                    quantity: "time constant",
                    value
                }),
                "{value}"
            );
        }
        assert!(
            FilterChain::with_time_constants(&[f64::NAN]).is_err(),
            "NaN"
        );
        assert_eq!(
            FilterChain::with_time_constants(&[0.1, 1e9]),
            Err(FirError::TooLong {
                time_constant: 1e9,
                longest: LONGEST_TIME_CONSTANT
            }),
            "too long"
        );
        for given in [0, 9] {
            assert!(
                matches!(
                    FilterChain::with_time_constants(&vec![0.1; given]),
                    Err(FirError::FilterCount { .. })
                ),
                "{given} filters"
            );
        }
    }

    #[test]
    fn lengths_are_rounded_and_not_truncated() {
        let period = SamplePeriod::new(1e-4).unwrap();
        let chain = FilterChain::with_time_constants(&[0.009]).unwrap();
        let rounded = chain.rounded_to(period).unwrap();
        assert!(
            (rounded.time_constants()[0] - 0.009).abs() < 1e-15,
            "0.009 / 1e-4 is 89.99… in binary"
        );
        let short = FilterChain::with_time_constants(&[4e-5]).unwrap();
        assert!(
            matches!(
                short.rounded_to(period),
                Err(FirError::PeriodTooLong { .. })
            ),
            "nothing would be left"
        );
    }

    #[test]
    fn the_printed_gains_are_reproduced() {
        let chain = FilterChain::with_time_constants(&[0.05, 0.03]).unwrap();
        assert!(
            (chain.gain(8.42) - 0.989994382309284).abs() < 1e-14,
            "8.42 rad/s"
        );
        let starfish = FilterChain::with_time_constants(&[0.1361, 0.1109]).unwrap();
        assert!(
            (starfish.gain(TAU * 7.4).abs() - 0.00147).abs() < 5e-6,
            "7.4 Hz"
        );
        assert!(
            (starfish.gain(TAU * 9.2).abs() - 0.00359).abs() < 5e-6,
            "9.2 Hz"
        );
    }

    #[test]
    fn gain_is_the_transfer_function_without_its_delay() {
        let chain = FilterChain::with_time_constants(&[0.1, 0.06, 0.03]).unwrap();
        for frequency in [0.0, 1e-9, 1.0, 7.0, 40.0, 300.0] {
            let advanced = chain.transfer(Complex::new(0.0, frequency))
                * Complex::new(0.0, 0.5 * frequency * chain.total_delay()).exp();
            assert!(
                (advanced - Complex::new(chain.gain(frequency), 0.0)).norm() < 1e-13,
                "{frequency} rad/s"
            );
        }
    }
}
