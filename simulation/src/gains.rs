//! Computes the gains of a P-PI cascade from a bandwidth, or from how controls show them.
//!
//! Source: a velocity loop `s² + kv s + ki` of natural frequency `rho kp` and damping ratio `zeta`, as three equal poles have
//! no real solution. Not here: whether the loop is stable.

use crate::error::DriveError;
use crate::response::SampledPlant;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Halvings of the bracket of the position gain.
const HALVINGS: u32 = 60;

/// Frequencies below the bandwidth at which the response is looked at.
const LOOKS: u32 = 64;

/// Gains of the cascade: `force = (kv + ki / s) (kp (r - x) + feedforward - v)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gains {
    /// Position gain `kp`, 1/s.
    pub position: f64,
    /// Velocity gain `kv`, 1/s.
    pub velocity: f64,
    /// Integral gain of the velocity loop `ki`, 1/s².
    pub integral: f64,
}

impl Gains {
    /// A velocity loop of natural frequency `ratio * position` and this damping ratio around a position gain, 1/s.
    #[must_use]
    pub fn scaled(position: f64, ratio: f64, damping: f64) -> Self {
        let natural = ratio * position;
        Self {
            position,
            velocity: 2.0 * damping * natural,
            integral: natural * natural,
        }
    }
}

/// How gains are given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GainSettings {
    /// Directly.
    Direct(Gains),
    /// As controls show them: Kv factor, 1/s; velocity loop, Hz; integral time, s, 0 for none.
    Controls {
        /// Position gain, 1/s.
        position_gain: f64,
        /// Bandwidth of the velocity loop, Hz: its gain is 2 pi times that.
        velocity_loop: f64,
        /// Integral time of the velocity loop, s.
        integral_time: f64,
    },
    /// The frequency at which `|x / r|` without feedforward first falls to -3 dB.
    Bandwidth {
        /// Bandwidth, Hz.
        frequency: f64,
        /// Natural frequency of the velocity loop over the position gain.
        velocity_ratio: f64,
        /// Damping ratio of the velocity loop.
        velocity_damping: f64,
    },
}

impl GainSettings {
    /// Checks every value by itself.
    pub(crate) fn check(&self) -> Result<(), DriveError> {
        let fields = match *self {
            Self::Direct(gains) => [
                ("position_gain", gains.position, true),
                ("velocity_gain", gains.velocity, true),
                ("integral_gain", gains.integral, false),
            ],
            Self::Controls {
                position_gain,
                velocity_loop,
                integral_time,
            } => [
                ("position_gain", position_gain, true),
                ("velocity_loop_hz", velocity_loop, true),
                ("integral_time_s", integral_time, false),
            ],
            Self::Bandwidth {
                frequency,
                velocity_ratio,
                velocity_damping,
            } => [
                ("bandwidth_hz", frequency, true),
                ("velocity_ratio", velocity_ratio, true),
                ("velocity_damping", velocity_damping, true),
            ],
        };
        for (field, value, positive) in fields {
            let (fine, bound) = if positive {
                (value > 0.0 && value.is_finite(), "positive and finite")
            } else {
                (value >= 0.0 && value.is_finite(), "finite and not negative")
            };
            if !fine {
                return Err(DriveError::new(field, value, bound));
            }
        }
        Ok(())
    }

    /// The gains on a sampled plant.
    pub(crate) fn on(&self, plant: &SampledPlant) -> Result<Gains, DriveError> {
        match *self {
            Self::Direct(gains) => Ok(gains),
            Self::Controls {
                position_gain,
                velocity_loop,
                integral_time,
            } => {
                let velocity = TAU * velocity_loop;
                let integral = if integral_time > 0.0 {
                    velocity / integral_time
                } else {
                    0.0
                };
                Ok(Gains {
                    position: position_gain,
                    velocity,
                    integral,
                })
            }
            Self::Bandwidth {
                frequency,
                velocity_ratio,
                velocity_damping,
            } => of_bandwidth(frequency, velocity_ratio, velocity_damping, plant),
        }
    }
}

/// The gains with which the position loop without feedforward falls to -3 dB at a frequency, Hz.
fn of_bandwidth(
    frequency: f64,
    ratio: f64,
    damping: f64,
    plant: &SampledPlant,
) -> Result<Gains, DriveError> {
    let refuse = |bound: &str| Err(DriveError::new("bandwidth_hz", frequency, bound));
    if frequency >= 0.5 / plant.period {
        return refuse(&format!(
            "below half the servo rate, {} Hz",
            0.5 / plant.period
        ));
    }
    let place = plant.at(frequency);
    let (mut low, mut high) = (1e-3 * frequency, 4.0 * TAU * frequency);
    let magnitude = |gain: f64| {
        place
            .closed_loop(&Gains::scaled(gain, ratio, damping), 0.0, 0.0)
            .position
            .norm()
    };
    if magnitude(high) < FRAC_1_SQRT_2 {
        return refuse("a frequency at which some gain gives -3 dB");
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if magnitude(middle) < FRAC_1_SQRT_2 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let gains = Gains::scaled(0.5 * (low + high), ratio, damping);
    let first = (1..LOOKS)
        .map(|look| frequency * f64::from(look) / f64::from(LOOKS))
        .find(|&lower| {
            plant
                .at(lower)
                .closed_loop(&gains, 0.0, 0.0)
                .position
                .norm()
                < 0.98 * FRAC_1_SQRT_2
        });
    if let Some(lower) = first {
        return refuse(&format!(
            "reached before any dip: the response falls to -3 dB at {lower:.1} Hz already"
        ));
    }
    Ok(gains)
}
