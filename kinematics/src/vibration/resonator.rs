//! Integrates a mode of vibration under the pieces of a motion exactly.
//!
//! Source: the oscillator `x'' + 2 d w x' + w² x = -a` of section 4.2.2, whose answer to a stretch of
//! acceleration that changes linearly is closed. Without damping its amplitude is that of the spectrum
//! of the acceleration at its frequency. Not here: the motion.

use super::{Mode, ModeError};
#[cfg(not(feature = "std"))]
use crate::no_std::*;
use nalgebra::Complex;

/// Arguments below this are summed as a series, dimensionless: above it the closed form loses fewer
/// digits.
const SERIES: f64 = 0.5;

/// Terms of that series: the next one is below the rounding.
const SERIES_TERMS: u32 = 16;

/// A damped oscillator that the acceleration of an axis drives, at rest in the beginning.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Mode, Resonator};
/// let mut resonator = Resonator::new(&Mode::new(5.0, 0.0)?);
/// // Constant acceleration for one period leaves nothing.
/// resonator.pass(100.0, 0.0, 0.2);
/// assert!(resonator.displacement() < 1e-15);
/// # Ok::<(), toolglide_kinematics::ModeError>(())
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
        let natural = mode.natural();
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
    /// [`ModeError::Frequency`] unless the frequency is positive and finite.
    pub fn at_frequency(frequency: f64) -> Result<Self, ModeError> {
        Mode::new(frequency, 0.0).map(|mode| Self::new(&mode))
    }

    /// Lets a stretch of motion pass: the acceleration at its start, its jerk, and its duration.
    pub fn pass(&mut self, acceleration: f64, jerk: f64, duration: f64) {
        let z = self.pole * duration;
        let decay = z.exp();
        let (constant, linear) = if z.re.hypot(z.im) < SERIES {
            integrals(z)
        } else {
            let one = Complex::new(1.0, 0.0);
            ((decay - one) / z, (decay - one - z) / (z * z))
        };
        self.state = self.state * decay
            - constant * (acceleration * duration)
            - linear * (jerk * duration * duration);
    }

    /// Deflection now, mm.
    #[must_use]
    pub fn deflection(&self) -> f64 {
        self.state.im / self.pole.im
    }

    /// Rate of the deflection now, mm/s.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.state.re + self.pole.re * self.deflection()
    }

    /// Undamped natural frequency, rad/s.
    #[must_use]
    pub fn natural(&self) -> f64 {
        self.natural
    }

    /// Amplitude of the free oscillation from now on, mm, before it decays.
    #[must_use]
    pub fn displacement(&self) -> f64 {
        self.state.re.hypot(self.state.im) / self.pole.im
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
        self.state.re.hypot(self.state.im)
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
    use core::f64::consts::TAU;

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
}
