//! Integrates a mode of vibration under the pieces of a motion exactly.
//!
//! Source: the oscillator `x'' + 2 d w x' + w² x = -a` of section 4.2.2, whose answer to a stretch of
//! acceleration that changes linearly is closed. Without damping its amplitude is that of the spectrum
//! of the acceleration at its frequency. Not here: the motion.

use crate::error::FirError;
use crate::filter::mode::Mode;
use std::f64::consts::TAU;
use toolglide_kinematics::nalgebra::Complex;

/// Arguments below this are summed as a series, dimensionless: above it the closed form loses fewer
/// digits.
const SERIES: f64 = 0.5;

/// Terms of that series: the next one is below the rounding.
const SERIES_TERMS: u32 = 16;

/// A damped oscillator that the acceleration of an axis drives, at rest in the beginning.
///
/// # Examples
/// ```
/// use toolglide_fir::{Mode, Resonator};
/// let mut resonator = Resonator::new(&Mode::new(5.0, 0.0)?);
/// // Constant acceleration for one period leaves nothing.
/// resonator.pass(100.0, 0.0, 0.2);
/// assert!(resonator.displacement() < 1e-15);
/// # Ok::<(), toolglide_fir::FirError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resonator {
    pole: Complex<f64>,
    natural: f64,
    state: Complex<f64>,
}

impl Resonator {
    /// The oscillator of a mode.
    #[must_use]
    pub fn new(mode: &Mode) -> Self {
        let natural = TAU * mode.frequency();
        Self {
            pole: mode.pole(),
            natural,
            state: Complex::new(0.0, 0.0),
        }
    }

    /// An oscillator without damping, whose state is the spectrum of the acceleration at a frequency
    /// in Hz.
    ///
    /// # Errors
    /// [`FirError::NotPositive`] unless the frequency is positive and finite.
    pub fn at_frequency(frequency: f64) -> Result<Self, FirError> {
        Mode::new(frequency, 0.0).map(|mode| Self::new(&mode))
    }

    /// Lets a stretch of motion pass: the acceleration at its start, its jerk, and its duration.
    pub fn pass(&mut self, acceleration: f64, jerk: f64, duration: f64) {
        let z = self.pole * duration;
        let decay = z.exp();
        let (constant, linear) = if z.norm() < SERIES {
            integrals(z)
        } else {
            let one = Complex::new(1.0, 0.0);
            ((decay - one) / z, (decay - one - z) / (z * z))
        };
        self.state = self.state * decay
            - constant * (acceleration * duration)
            - linear * (jerk * duration * duration);
    }

    /// Amplitude of the free oscillation from now on, mm, before it decays.
    #[must_use]
    pub fn displacement(&self) -> f64 {
        self.state.norm() / self.pole.im
    }

    /// The same as an acceleration, mm/s².
    #[must_use]
    pub fn acceleration(&self) -> f64 {
        self.displacement() * self.natural * self.natural
    }

    /// Magnitude of the spectrum of the acceleration that has passed, mm/s, at the frequency of an
    /// oscillator without damping.
    #[must_use]
    pub fn spectrum(&self) -> f64 {
        self.state.norm()
    }
}

/// `(exp(z) - 1) / z` and `(exp(z) - 1 - z) / z²` for a small argument.
fn integrals(z: Complex<f64>) -> (Complex<f64>, Complex<f64>) {
    let (mut term, mut count) = (Complex::new(1.0, 0.0), 1.0);
    let (mut constant, mut linear) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
    for _ in 0..SERIES_TERMS {
        constant += term;
        count += 1.0;
        linear += term / count;
        term *= z / count;
    }
    (constant, linear)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FilterChain, Settings, plan};
    use toolglide_kinematics::{Feedrate, Limits, Plan, Tolerance, Toolpath, Vector};

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
    fn it_agrees_with_small_steps_of_the_differential_equation() {
        let (natural, damping) = (TAU * 6.0, 0.05);
        let mut resonator = Resonator::new(&Mode::new(6.0, damping).unwrap());
        let (mut x, mut v) = (0.0_f64, 0.0_f64);
        for (acceleration, jerk, duration) in [
            (0.0, 2e4, 0.05),
            (1000.0, 0.0, 0.1),
            (1000.0, -3e4, 0.04),
            (0.0, 0.0, 0.003),
        ] {
            resonator.pass(acceleration, jerk, duration);
            let steps = 20_000;
            let step = duration / f64::from(steps);
            for index in 0..steps {
                let force = |x: f64, v: f64, share: f64| {
                    let time = (f64::from(index) + share) * step;
                    -(acceleration + jerk * time)
                        - 2.0 * damping * natural * v
                        - natural * natural * x
                };
                let (half_x, half_v) = (x + 0.5 * step * v, v + 0.5 * step * force(x, v, 0.0));
                x += step * half_v;
                v += step * force(half_x, half_v, 0.5);
            }
        }
        let damped = natural * (1.0 - damping * damping).sqrt();
        let amplitude = x.hypot((v + damping * natural * x) / damped);
        assert!(
            (amplitude / resonator.displacement() - 1.0).abs() < 1e-5,
            "{amplitude} mm"
        );
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
