//! Builds the continuous model of an axis: mass, viscous friction, current loop and flexible modes.
//!
//! Source: Pritschow (1996), Erkorkmaz and Altintas (2001, part II). Everything is per unit of mass, so that only specific
//! forces appear. Not here: friction with a limit, which is not linear.

use crate::error::DriveError;
use crate::linear::{self, Mat};
use std::f64::consts::TAU;

/// Most flexible modes of an axis.
pub const MAX_MODES: usize = 4;

/// Most states of an axis: position, velocity, force of the motor, and two of each mode.
pub(crate) const MAX_STATES: usize = 3 + 2 * MAX_MODES;

/// A flexible mode that an axis excites.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexibleMode {
    /// Natural frequency with the drive held, Hz: the antiresonance that the drive sees.
    pub frequency: f64,
    /// Damping ratio, from 0 to below 1.
    pub damping: f64,
    /// Modal mass as a share of the mass of the axis; 0 for what the drive does not feel.
    pub mass_share: f64,
    /// Share of its displacement that the encoder sees: 1 for a ball screw with a scale at the table.
    pub at_encoder: f64,
    /// Share of its displacement that the tool has along X, Y and Z; none for a beam that is only watched.
    pub at_tool: [f64; 3],
}

impl FlexibleMode {
    /// Natural frequency with the drive held, rad/s.
    #[must_use]
    pub fn natural(&self) -> f64 {
        TAU * self.frequency
    }

    /// Acceleration of the top of a beam at a displacement and velocity relative to the drive.
    #[must_use]
    pub fn acceleration(&self, displacement: f64, velocity: f64) -> f64 {
        let natural = self.natural();
        -natural * (2.0 * self.damping * velocity + natural * displacement)
    }

    /// Amplitude of the free oscillation with this displacement and velocity.
    #[must_use]
    pub fn amplitude(&self, displacement: f64, velocity: f64) -> f64 {
        let natural = self.natural();
        let damped = natural * (1.0 - self.damping * self.damping).sqrt();
        displacement.hypot((velocity + self.damping * natural * displacement) / damped)
    }
}

/// The linear part of an axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Plant {
    /// Viscous friction, 1/s.
    pub(crate) viscous: f64,
    /// Bandwidth of the current loop, Hz.
    pub(crate) current_loop: f64,
    pub(crate) modes: Vec<FlexibleMode>,
}

impl Plant {
    /// States x, v, u, q1, q1', ...; inputs: command of force, friction force.
    ///
    /// `[1 mu'; 1 I] [x''; q''] = [u - b v - f; -2 zeta w q' - w² q]`.
    pub(crate) fn continuous(&self) -> (Mat<f64>, Mat<f64>) {
        let k = self.modes.len();
        let n = 3 + 2 * k;
        let mass = Mat::from_fn(k + 1, k + 1, |i, j| match (i, j) {
            (0, 0) | (1.., 0) => 1.0,
            (0, j) => self.modes[j - 1].mass_share,
            (i, j) => f64::from(u8::from(i == j)),
        });
        let forces = Mat::from_fn(k + 1, n + 2, |i, j| {
            if i == 0 {
                return match j {
                    1 => -self.viscous,
                    2 => 1.0,
                    j if j == n + 1 => -1.0,
                    _ => 0.0,
                };
            }
            let mode = &self.modes[i - 1];
            let natural = mode.natural();
            match j {
                j if j == 1 + 2 * i => -natural * natural,
                j if j == 2 + 2 * i => -2.0 * mode.damping * natural,
                _ => 0.0,
            }
        });
        let accelerations = linear::solve(&mass, &forces);
        let rate = TAU * self.current_loop;
        let row = |i: usize, j: usize| -> f64 {
            match i {
                0 => f64::from(u8::from(j == 1)),
                1 => accelerations[(0, j)],
                2 if j == 2 => -rate,
                2 if j == n => rate,
                2 => 0.0,
                i if (i - 3).is_multiple_of(2) => f64::from(u8::from(j == i + 1)),
                i => accelerations[(1 + (i - 4) / 2, j)],
            }
        };
        (
            Mat::from_fn(n, n, row),
            Mat::from_fn(n, 2, |i, j| row(i, n + j)),
        )
    }

    /// What the encoder sees of the states.
    pub(crate) fn measured(&self) -> [f64; MAX_STATES] {
        let mut weights = [0.0; MAX_STATES];
        weights[0] = 1.0;
        for (index, mode) in self.modes.iter().enumerate() {
            weights[3 + 2 * index] = mode.at_encoder;
        }
        weights
    }

    /// Checks modes and rates against a servo period, s.
    pub(crate) fn check(&self, period: f64) -> Result<(), DriveError> {
        not_negative("friction: viscous", self.viscous)?;
        if !(self.current_loop > 0.0 && self.current_loop.is_finite()) {
            return Err(DriveError::new(
                "current_loop_hz",
                self.current_loop,
                "positive and finite",
            ));
        }
        if self.modes.len() > MAX_MODES {
            return Err(DriveError::new(
                "mode",
                format!("a list of {}", self.modes.len()),
                format!("a list of {MAX_MODES} at most for one axis"),
            ));
        }
        let nyquist = 0.5 / period;
        for mode in &self.modes {
            if !(mode.frequency > 0.0 && mode.frequency < nyquist) {
                return Err(DriveError::new(
                    "mode: frequency_hz",
                    mode.frequency,
                    format!("positive and below half the servo rate, {nyquist} Hz"),
                ));
            }
            if !(0.0..1.0).contains(&mode.damping) {
                return Err(DriveError::new(
                    "mode: damping",
                    mode.damping,
                    "from 0 to below 1",
                ));
            }
            if !(0.0..1.0).contains(&mode.mass_share) {
                return Err(DriveError::new(
                    "mode: mass_share",
                    mode.mass_share,
                    "from 0 to below 1",
                ));
            }
            if !(0.0..=1.0).contains(&mode.at_encoder) {
                return Err(DriveError::new(
                    "mode: encoder",
                    mode.at_encoder,
                    "from 0 to 1",
                ));
            }
            if mode.at_tool.iter().any(|share| !share.is_finite()) {
                return Err(DriveError::new(
                    "mode: tool",
                    format!("{:?}", mode.at_tool),
                    "three finite numbers",
                ));
            }
        }
        let shares: f64 = self.modes.iter().map(|mode| mode.mass_share).sum();
        if shares >= 1.0 {
            return Err(DriveError::new(
                "mode: mass_share, the sum of all",
                shares,
                "below 1",
            ));
        }
        Ok(())
    }
}

/// Checks that a value is finite and not negative.
pub(crate) fn not_negative(field: &str, value: f64) -> Result<(), DriveError> {
    if value >= 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(DriveError::new(field, value, "finite and not negative"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_with_mass_has_its_antiresonance_and_resonance() {
        let mode = FlexibleMode {
            frequency: 30.0,
            damping: 0.0,
            mass_share: 0.2,
            at_encoder: 0.0,
            at_tool: [1.0, 0.0, 0.0],
        };
        let plant = Plant {
            viscous: 0.0,
            current_loop: 1e6,
            modes: vec![mode],
        };
        let (a, b) = plant.continuous();
        let natural = mode.natural();
        let pole = linear::eigenvalues(&a)
            .iter()
            .map(|pole| pole.im)
            .fold(0.0, f64::max);
        let free = natural / (1.0_f64 - 0.2).sqrt();
        assert!((pole / free - 1.0).abs() < 1e-6, "resonance {pole} {free}");
        let c = Mat::from_fn(1, a.nrows(), |_, j| f64::from(u8::from(j == 0)));
        let b = Mat::from_fn(a.nrows(), 1, |i, _| b[(i, 1)]);
        let zeros = linear::zeros(&a, &b, &c);
        let near = zeros
            .iter()
            .map(|zero| (zero.im / natural - 1.0).abs())
            .fold(f64::INFINITY, f64::min);
        assert!(near < 1e-6, "antiresonance {zeros:?}");
    }
}
