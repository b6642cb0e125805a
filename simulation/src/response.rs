//! Computes the frequency response of a sampled drive, exactly.
//!
//! Source: the plant under held inputs, `C (zI - A)^-1 (B z^-d + B' z^-(d+1))`, and the difference equations of the
//! controller at `z = exp(j w T)`. Not here: the run in time, whose steady sines have these amplitudes.

use crate::gains::Gains;
use crate::linear::{Mat, c64, resolvent, zero_order_hold};
use crate::plant::Plant;
use std::f64::consts::TAU;

/// A plant under inputs that are held over a servo period, with dead time.
#[derive(Clone, Debug)]
pub(crate) struct SampledPlant {
    /// Servo period, s.
    pub(crate) period: f64,
    /// Whole servo periods of dead time, and the rest of it, s.
    pub(crate) delay: usize,
    pub(crate) rest: f64,
    a: Mat<f64>,
    /// Columns: command of this period, command of the period before, friction.
    b: Mat<f64>,
    measured: Vec<f64>,
    /// Share of the measured velocity that is taken over each period.
    pub(crate) smoothing: f64,
}

impl SampledPlant {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a dead time is at most twenty periods and not negative"
    )]
    pub(crate) fn new(
        plant: &Plant,
        period: f64,
        dead_time: f64,
        velocity_filter: Option<f64>,
    ) -> Self {
        let periods = dead_time / period;
        // A dead time that is whole but for rounding is whole.
        let whole = if (periods - periods.round()).abs() < 1e-9 {
            periods.round()
        } else {
            periods.floor()
        };
        let rest = ((periods - whole) * period).max(0.0);
        let (a, b) = plant.continuous();
        let (full, held) = zero_order_hold(&a, &b, period);
        let (after, new) = zero_order_hold(&a, &b, period - rest);
        let (_, before) = zero_order_hold(&a, &b, rest);
        let old = &after * &before;
        let n = a.nrows();
        let smoothing = velocity_filter.map_or(1.0, |corner| 1.0 - (-TAU * corner * period).exp());
        Self {
            period,
            delay: whole as usize,
            rest,
            b: Mat::from_fn(n, 3, |i, j| match j {
                0 => new[(i, 0)],
                1 => old[(i, 0)],
                _ => held[(i, 1)],
            }),
            measured: plant.measured()[..n].to_vec(),
            a: full,
            smoothing,
        }
    }

    /// The plant at a frequency, Hz.
    pub(crate) fn at(&self, frequency: f64) -> PlantAt {
        let angle = TAU * frequency * self.period;
        let z = c64::new(angle.cos(), angle.sin());
        let states = resolvent(&self.a, &self.b, z);
        let back = |periods: usize| {
            let turned = -angle * f64::from(u32::try_from(periods).unwrap_or(u32::MAX));
            c64::new(turned.cos(), turned.sin())
        };
        let (new, old) = (back(self.delay), back(self.delay + 1));
        let n = self.a.nrows();
        let seen = |column: &dyn Fn(usize) -> c64| {
            (0..n).fold(c64::new(0.0, 0.0), |sum, i| {
                sum + column(i) * self.measured[i]
            })
        };
        let force = |i: usize| states[(i, 0)] * new + states[(i, 1)] * old;
        let disturbance = |i: usize| states[(i, 2)];
        PlantAt {
            z,
            period: self.period,
            smoothing: self.smoothing,
            position: force(0),
            measured: seen(&force),
            disturbed: disturbance(0),
            disturbed_measured: seen(&disturbance),
            modes: (0..(n - 3) / 2).map(|mode| force(3 + 2 * mode)).collect(),
        }
    }
}

/// A plant at one frequency.
pub(crate) struct PlantAt {
    z: c64,
    period: f64,
    smoothing: f64,
    position: c64,
    measured: c64,
    disturbed: c64,
    disturbed_measured: c64,
    modes: Vec<c64>,
}

/// What a loop makes of a set-point of amplitude 1, and of a force of amplitude 1.
#[derive(Clone, Debug)]
pub(crate) struct LoopAt {
    /// Position over set-point.
    pub(crate) position: c64,
    /// Displacement of each mode over set-point.
    pub(crate) modes: Vec<c64>,
    /// Position over force on the axis, s².
    pub(crate) compliance: c64,
    /// Gain around the loop, broken at the force.
    pub(crate) open: c64,
}

impl PlantAt {
    /// The loop with shares of velocity and acceleration feedforward.
    pub(crate) fn closed_loop(&self, gains: &Gains, velocity: f64, acceleration: f64) -> LoopAt {
        let one = c64::new(1.0, 0.0);
        let back = one / self.z;
        let difference = (one - back) / self.period;
        let filtered = difference * self.smoothing / (one - back * (1.0 - self.smoothing));
        let integral = back * (gains.integral * self.period) / (one - back);
        let control = integral + gains.velocity;
        let feedback = control * (filtered + gains.position);
        let forward = control * (difference * velocity + gains.position)
            + difference * difference * acceleration;
        let open = self.measured * feedback;
        let force = forward / (one + open);
        LoopAt {
            position: self.position * force,
            modes: self.modes.iter().map(|mode| mode * force).collect(),
            compliance: self.disturbed
                - self.position * feedback * self.disturbed_measured / (one + open),
            open,
        }
    }
}
