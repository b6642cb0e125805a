//! Prepares a drive for its run: gains, stability of the sampled loop, steps of the plant.
//!
//! Source: the sampled loop is found by stepping each unit state once, so that its eigenvalues are those of the loop as it
//! runs. Not here: the run itself, see [`Drive`](crate::Drive).

use crate::drive::Drive;
use crate::error::DriveError;
use crate::friction::Friction;
use crate::gains::Gains;
use crate::linear::{Mat, c64, eigenvalues, zero_order_hold};
use crate::plant::{FlexibleMode, MAX_STATES};
use crate::response::SampledPlant;
use crate::settings::{DriveSettings, Feedforward};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Frequencies at which a loop is looked at for its margins.
const FREQUENCIES: u32 = 400;

/// Lowest of them as a share of the servo rate.
const LOWEST: f64 = 1e-5;

/// Steps of the search for gains that would be stable.
const STABLE_STEPS: u32 = 24;

/// Resonance above which a loop is called lively, and gain margin below which it is, dB.
const LIVELY: f64 = 3.0;
/// As above.
const MARGIN: f64 = 6.0;

/// One substep of the plant, as fixed arrays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    /// Effect of each state.
    pub(crate) a: [[f64; MAX_STATES]; MAX_STATES],
    /// Effect of the command of the period before, of this period, and of friction.
    pub(crate) old: [f64; MAX_STATES],
    pub(crate) new: [f64; MAX_STATES],
    pub(crate) friction: [f64; MAX_STATES],
}

/// How a loop behaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopReport {
    /// Largest magnitude of the eigenvalues of the sampled loop; below 1.
    pub radius: f64,
    /// Gain margin, dB.
    pub gain_margin: f64,
    /// Largest `|x / r|` with the feedforward of the drive.
    pub resonance: f64,
    /// Frequency at which `|x / r|` without feedforward first falls to -3 dB, Hz.
    pub bandwidth: f64,
}

impl LoopReport {
    /// Whether the loop rings: a resonance above 3, or a gain margin below 6 dB.
    #[must_use]
    pub fn is_lively(&self) -> bool {
        self.resonance > LIVELY || self.gain_margin < MARGIN
    }
}

/// The response of a loop at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponsePoint {
    /// Frequency, Hz.
    pub frequency: f64,
    /// `|x / r|` without feedforward.
    pub plain: f64,
    /// `|x / r|` with the feedforward of the drive.
    pub fed: f64,
    /// `|tool / r|` along the axis of the drive, with feedforward; `own` says which share of a mode that is.
    pub tool: f64,
    /// Position over force on the axis, s².
    pub compliance: f64,
}

/// A drive that is checked, stable and ready to run.
#[derive(Clone, Debug)]
pub struct DriveModel {
    pub(crate) settings: DriveSettings,
    pub(crate) gains: Gains,
    pub(crate) sampled: SampledPlant,
    /// Substeps of a servo period; the input changes in one of them.
    pub(crate) substeps: Vec<Step>,
    pub(crate) states: usize,
    pub(crate) measured: [f64; MAX_STATES],
    report: LoopReport,
}

impl DriveModel {
    /// Checks a drive and finds its gains.
    ///
    /// # Errors
    /// [`DriveError`] for a field that is refused, a bandwidth that no gain meets, friction too steep for the servo period,
    /// and a loop that is not stable.
    ///
    /// # Examples
    /// ```
    /// use toolglide_simulation::{DriveModel, DriveSettings};
    /// let model = DriveModel::new(&DriveSettings::textbook(35.0))?;
    /// assert!((model.gains().position - 111.3).abs() < 0.1);
    /// assert!(model.report().radius < 1.0);
    /// # Ok::<(), toolglide_simulation::DriveError>(())
    /// ```
    pub fn new(settings: &DriveSettings) -> Result<Self, DriveError> {
        settings.check()?;
        let plant = settings.plant();
        let sampled = SampledPlant::new(
            &plant,
            settings.servo_period,
            settings.dead_time,
            settings.velocity_filter,
        );
        let gains = settings.gains.on(&sampled)?;
        let substeps = settings.friction.substeps(settings.servo_period)?;
        let mut model = Self {
            settings: settings.clone(),
            gains,
            substeps: steps(settings, sampled.rest, substeps),
            states: 3 + 2 * plant.modes.len(),
            measured: plant.measured(),
            sampled,
            report: LoopReport {
                radius: 0.0,
                gain_margin: f64::INFINITY,
                resonance: 0.0,
                bandwidth: 0.0,
            },
        };
        let radius = model.radius();
        if radius.is_nan() || radius >= 1.0 {
            return Err(model.unstable(radius));
        }
        model.report = LoopReport {
            radius,
            ..model.look()
        };
        Ok(model)
    }

    /// The gains of the cascade.
    #[must_use]
    pub fn gains(&self) -> Gains {
        self.gains
    }

    /// What the drive was made of.
    #[must_use]
    pub fn settings(&self) -> &DriveSettings {
        &self.settings
    }

    /// How the loop behaves.
    #[must_use]
    pub fn report(&self) -> LoopReport {
        self.report
    }

    /// The flexible modes of the axis.
    #[must_use]
    pub fn modes(&self) -> &[FlexibleMode] {
        &self.settings.modes
    }

    /// The response at a frequency, Hz, below half the servo rate; `own` is the place of the axis among X, Y and Z, which
    /// says how much of each mode the tool has along it.
    #[must_use]
    pub fn response(&self, frequency: f64, own: Option<usize>) -> ResponsePoint {
        let place = self.sampled.at(frequency);
        let forward = self.settings.feedforward.applied();
        let plain = place.closed_loop(&self.gains, 0.0, 0.0);
        let fed = place.closed_loop(&self.gains, forward.velocity, forward.acceleration);
        let tool = self
            .settings
            .modes
            .iter()
            .zip(&fed.modes)
            .map(|(mode, moved)| moved * own.map_or(0.0, |own| mode.at_tool[own]))
            .fold(fed.position, |sum, moved| sum + moved);
        ResponsePoint {
            frequency,
            plain: plain.position.norm(),
            fed: fed.position.norm(),
            tool: tool.norm(),
            compliance: plain.compliance.norm(),
        }
    }

    /// `x / r` without feedforward at a frequency, Hz: real and imaginary part.
    #[must_use]
    pub fn position_response(&self, frequency: f64) -> [f64; 2] {
        let place = self.sampled.at(frequency);
        let position = place.closed_loop(&self.gains, 0.0, 0.0).position;
        [position.re, position.im]
    }

    /// Frequencies of the oscillating poles of the closed loop, Hz, with their damping ratios, lowest first.
    #[must_use]
    pub fn closed_loop_modes(&self) -> Vec<[f64; 2]> {
        let period = self.settings.servo_period;
        let mut found: Vec<[f64; 2]> = eigenvalues(&self.loop_matrices().0)
            .iter()
            .filter(|pole| pole.im > 1e-9 && pole.norm() > 0.1)
            .map(|pole| {
                let (rate, turn) = (pole.norm().ln() / period, pole.im.atan2(pole.re) / period);
                let natural = rate.hypot(turn);
                [natural / TAU, -rate / natural]
            })
            .collect();
        found.sort_by(|one, other| one[0].total_cmp(&other[0]));
        found
    }

    /// The sampled loop as it is stepped, without friction, encoder, limit and feedforward: `next = A state + B r`.
    pub(crate) fn loop_matrices(&self) -> (Mat<f64>, Mat<f64>) {
        let mut bare = self.clone();
        bare.settings.friction = Friction::NONE;
        bare.settings.encoder_step = 0.0;
        bare.settings.force_limit = f64::INFINITY;
        bare.settings.feedforward = Feedforward::NONE;
        let rest = Drive::new(&bare, 0.0);
        let size = rest.loop_states();
        let column = |unit: usize| {
            let mut drive = rest.clone();
            if unit < size {
                drive.set_loop_state(unit, 1.0);
            }
            drive.tick(if unit == size { 1.0 } else { 0.0 });
            drive.loop_state()
        };
        let columns: Vec<Vec<f64>> = (0..=size).map(column).collect();
        (
            Mat::from_fn(size, size, |i, j| columns[j][i]),
            Mat::from_fn(size, 1, |i, _| columns[size][i]),
        )
    }

    /// Largest magnitude of the eigenvalues of the sampled loop.
    fn radius(&self) -> f64 {
        let poles = eigenvalues(&self.loop_matrices().0);
        if poles.is_empty() {
            return f64::NAN;
        }
        poles.iter().map(|pole| pole.norm()).fold(0.0, f64::max)
    }

    /// Margins and resonance over frequencies up to half the servo rate.
    fn look(&self) -> LoopReport {
        let rate = 1.0 / self.settings.servo_period;
        let forward = self.settings.feedforward.applied();
        let spread = (0.499 / LOWEST).ln();
        let mut report = LoopReport {
            radius: 0.0,
            gain_margin: f64::INFINITY,
            resonance: 0.0,
            bandwidth: 0.5 * rate,
        };
        let mut before: Option<c64> = None;
        let mut found = false;
        let (mut last_frequency, mut last_magnitude) = (0.0, 1.0);
        for index in 0..FREQUENCIES {
            let share = f64::from(index) / f64::from(FREQUENCIES - 1);
            let frequency = rate * LOWEST * (spread * share).exp();
            let place = self.sampled.at(frequency);
            let plain = place.closed_loop(&self.gains, 0.0, 0.0);
            let fed = place.closed_loop(&self.gains, forward.velocity, forward.acceleration);
            report.resonance = report.resonance.max(fed.position.norm());
            let magnitude = plain.position.norm();
            if !found && magnitude < FRAC_1_SQRT_2 {
                found = true;
                let share = (last_magnitude - FRAC_1_SQRT_2) / (last_magnitude - magnitude);
                report.bandwidth = last_frequency + share * (frequency - last_frequency);
            }
            (last_frequency, last_magnitude) = (frequency, magnitude);
            if let Some(last) = before
                && last.im * plain.open.im < 0.0
                && last.re < 0.0
                && plain.open.re < 0.0
            {
                let share = last.im / (last.im - plain.open.im);
                let crossing = -(last.re + share * (plain.open.re - last.re));
                if crossing < 1.0 {
                    report.gain_margin = report.gain_margin.min(-20.0 * crossing.log10());
                }
            }
            before = Some(plain.open);
        }
        report
    }

    /// The refusal of a loop that is not stable, with what would be.
    fn unstable(&self, radius: f64) -> DriveError {
        // With all gains lowered together the loop is slower, and stable at last.
        let scaled = |factor: f64| {
            let mut slower = self.clone();
            slower.gains = Gains {
                position: self.gains.position * factor,
                velocity: self.gains.velocity * factor,
                integral: self.gains.integral * factor * factor,
            };
            slower.radius()
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..STABLE_STEPS {
            let middle = 0.5 * (low + high);
            if scaled(middle) < 1.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let velocity = self.gains.velocity;
        let bound = if low > 1e-6 {
            format!(
                "stable: the sampled loop has radius {radius:.4}; at a servo period of {} s it is stable with a velocity loop of at most {:.1} Hz and a position gain of at most {:.1} 1/s",
                self.settings.servo_period,
                velocity * low / TAU,
                self.gains.position * low
            )
        } else {
            format!("stable: the sampled loop has radius {radius:.4}")
        };
        DriveError::new(
            "gains",
            format!(
                "position {:.1} 1/s, velocity {velocity:.1} 1/s, integral {:.0} 1/s²",
                self.gains.position, self.gains.integral
            ),
            bound,
        )
    }
}

/// The substeps of a servo period whose input changes after `rest`, s.
fn steps(settings: &DriveSettings, rest: f64, count: u32) -> Vec<Step> {
    let (a, b) = settings.plant().continuous();
    let n = a.nrows();
    let length = settings.servo_period / f64::from(count);
    let (full, held) = zero_order_hold(&a, &b, length);
    (0..count)
        .map(|index| {
            let until = (rest - f64::from(index) * length).clamp(0.0, length);
            let (after, new) = zero_order_hold(&a, &b, length - until);
            let (_, before) = zero_order_hold(&a, &b, until);
            let old = &after * &before;
            let mut step = Step {
                a: [[0.0; MAX_STATES]; MAX_STATES],
                old: [0.0; MAX_STATES],
                new: [0.0; MAX_STATES],
                friction: [0.0; MAX_STATES],
            };
            for i in 0..n {
                for j in 0..n {
                    step.a[i][j] = full[(i, j)];
                }
                step.old[i] = old[(i, 0)];
                step.new[i] = new[(i, 0)];
                step.friction[i] = held[(i, 1)];
            }
            step
        })
        .collect()
}
