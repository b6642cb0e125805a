//! Fits gains and friction of a drive to a recorded run.
//!
//! Source: Gauss-Newton on the simulated position, and on the force where it was recorded, with derivatives by differences
//! and steps by QR (Erkorkmaz and Altintas 2001, part II, fit friction alike). Parameters are fitted by their logarithms. What
//! the data cannot tell is not fitted but held. Not here: files.

use crate::drive::Drive;
use crate::error::DriveError;
use crate::gains::{GainSettings, Gains};
use crate::linear::{Mat, inverse, least_squares, singular_values};
use crate::model::DriveModel;
use crate::refine::{Interpolation, Refiner};
use crate::settings::DriveSettings;
use thiserror::Error;

/// Fewest rows of a recording.
const MIN_ROWS: usize = 200;

/// Least way of the set-points, mm or rad.
const MIN_WAY: f64 = 0.01;

/// Relative step of the derivatives.
const STEP: f64 = 1e-3;

/// Iterations of the fit.
const ITERATIONS: u32 = 60;

/// Parameters with a larger relative deviation are not told by the data.
const UNTOLD: f64 = 0.3;

/// Largest change of the logarithm of a parameter in one iteration.
const LONGEST_STEP: f64 = 0.7;

/// Changes below this end the fit.
const CONVERGED: f64 = 1e-5;

/// Dampings of a step that are tried.
const TRIES: u32 = 14;

/// A run of one axis: set-points and positions, mm or rad, and specific forces, mm/s² or rad/s², where they are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Time between two rows, s.
    pub period: f64,
    /// Set-points.
    pub set_points: Vec<f64>,
    /// Positions that the encoder saw.
    pub positions: Vec<f64>,
    /// Commanded specific forces, where they were recorded.
    pub forces: Option<Vec<f64>>,
}

/// What can be fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// Position gain, 1/s.
    PositionGain,
    /// Velocity gain, 1/s.
    VelocityGain,
    /// Integral gain, 1/s².
    IntegralGain,
    /// Coulomb friction, mm/s² or rad/s².
    Coulomb,
    /// Static friction over Coulomb friction, less 1.
    StaticExcess,
    /// Presliding distance, mm or rad.
    Presliding,
    /// Viscous friction, 1/s.
    Viscous,
}

impl Parameter {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::PositionGain,
        Self::VelocityGain,
        Self::IntegralGain,
        Self::Coulomb,
        Self::StaticExcess,
        Self::Presliding,
        Self::Viscous,
    ];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::PositionGain => "position gain",
            Self::VelocityGain => "velocity gain",
            Self::IntegralGain => "integral gain",
            Self::Coulomb => "Coulomb friction",
            Self::StaticExcess => "static friction beyond Coulomb friction",
            Self::Presliding => "presliding distance",
            Self::Viscous => "viscous friction",
        }
    }
}

/// A parameter as it was fitted, or held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedParameter {
    /// Which.
    pub parameter: Parameter,
    /// Its value.
    pub value: f64,
    /// Its relative standard deviation; infinite where the data do not tell it, so that it was held.
    pub deviation: f64,
}

/// A fitted drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The drive.
    pub settings: DriveSettings,
    /// The parameters, fitted and held.
    pub parameters: Vec<FittedParameter>,
    /// Condition number of the scaled Jacobian of what was fitted.
    pub condition: f64,
    /// Root mean square of the difference of positions, mm or rad.
    pub residual: f64,
}

/// Why nothing can be fitted.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FitError {
    /// A recording that tells nothing.
    #[error("{quantity} is {value}, but must be {bound}")]
    Recording {
        /// What is wrong with it.
        quantity: &'static str,
        /// Its value.
        value: String,
        /// What it must be.
        bound: String,
    },
    /// The drive to start from is refused.
    #[error(transparent)]
    Drive(#[from] DriveError),
    /// No parameter is told by the data.
    #[error("the recording tells no parameter: condition number {condition:.3e}")]
    Untold {
        /// Condition number of the scaled Jacobian of all.
        condition: f64,
    },
}

impl Recording {
    fn check(&self) -> Result<(), FitError> {
        let refuse = |quantity, value: String, bound: String| {
            Err(FitError::Recording {
                quantity,
                value,
                bound,
            })
        };
        let rows = self.set_points.len();
        if rows < MIN_ROWS || self.positions.len() != rows {
            let bound = format!("at least {MIN_ROWS}, with a position each");
            return refuse("the number of rows", rows.to_string(), bound);
        }
        let forces = self.forces.iter().flatten();
        if let Some(value) = self
            .set_points
            .iter()
            .chain(&self.positions)
            .chain(forces)
            .find(|value| !value.is_finite())
        {
            return refuse("a value", value.to_string(), "finite".to_owned());
        }
        let way = |values: &[f64]| {
            let first = values.first().copied().unwrap_or(0.0);
            values
                .iter()
                .fold(0.0_f64, |most, value| most.max((value - first).abs()))
        };
        for (quantity, values) in [
            ("the way of the set-points", &self.set_points),
            ("the way of the positions", &self.positions),
        ] {
            let way = way(values);
            if way < MIN_WAY {
                let bound = format!("at least {MIN_WAY} mm or rad: without motion nothing is told");
                return refuse(quantity, way.to_string(), bound);
            }
        }
        Ok(())
    }
}

/// A drive with the values of some parameters.
fn with(settings: &DriveSettings, gains: Gains, values: &[(Parameter, f64)]) -> DriveSettings {
    let mut settings = settings.clone();
    let mut gains = gains;
    let mut excess = settings.friction.static_force / settings.friction.coulomb.max(1e-9) - 1.0;
    for &(parameter, value) in values {
        match parameter {
            Parameter::PositionGain => gains.position = value,
            Parameter::VelocityGain => gains.velocity = value,
            Parameter::IntegralGain => gains.integral = value,
            Parameter::Coulomb => settings.friction.coulomb = value,
            Parameter::StaticExcess => excess = value,
            Parameter::Presliding => settings.friction.presliding = value,
            Parameter::Viscous => settings.viscous = value,
        }
    }
    settings.friction.static_force = settings.friction.coulomb * (1.0 + excess.max(0.0));
    settings.gains = GainSettings::Direct(gains);
    settings
}

/// The value of a parameter of a drive.
fn value_of(parameter: Parameter, settings: &DriveSettings, gains: &Gains) -> f64 {
    let law = &settings.friction;
    match parameter {
        Parameter::PositionGain => gains.position,
        Parameter::VelocityGain => gains.velocity,
        Parameter::IntegralGain => gains.integral,
        Parameter::Coulomb => law.coulomb,
        Parameter::StaticExcess => law.static_force / law.coulomb.max(1e-9) - 1.0,
        Parameter::Presliding => law.presliding,
        Parameter::Viscous => settings.viscous,
    }
}

/// What the fit looks at.
struct Problem<'r> {
    recording: &'r Recording,
    base: DriveSettings,
    gains: Gains,
    force_weight: f64,
}

impl Problem<'_> {
    /// Differences of positions, and of forces in units of length, between a simulated run and the recording.
    fn differences(&self, values: &[(Parameter, f64)]) -> Option<Vec<f64>> {
        let mut settings = with(&self.base, self.gains, values);
        // Steps of the encoder would make derivatives rough.
        settings.encoder_step = 0.0;
        let model = DriveModel::new(&settings).ok()?;
        let recording = self.recording;
        let rows = recording.set_points.len();
        let refiner = Refiner::<1>::new(
            Interpolation::Cubic,
            recording.period,
            settings.servo_period,
        )
        .ok()?;
        let ratio = refiner.ratio();
        let mut refiner = refiner.with_room(ratio * rows as u64);
        for &point in &recording.set_points {
            refiner.give([point]);
        }
        let mut drive = Drive::new(&model, recording.set_points[0]);
        let mut found = Vec::with_capacity(2 * rows);
        let mut forces = Vec::with_capacity(rows);
        for row in 0..rows {
            found.push(drive.position() - recording.positions[row]);
            for part in 0..ratio {
                let [point] = refiner.at(row as u64 * ratio + part);
                drive.tick(point);
                if part == 0
                    && let Some(recorded) = &recording.forces
                {
                    forces.push(self.force_weight * (drive.command() - recorded[row]));
                }
            }
            if drive.position().is_nan() || drive.position().abs() >= 1e6 {
                return None;
            }
        }
        found.extend(forces);
        Some(found)
    }
}

impl Problem<'_> {
    /// How much forces count beside positions: by the inverse of what is left of each; nothing where they were not recorded.
    fn weight(&self, values: &[(Parameter, f64)]) -> Option<f64> {
        if self.recording.forces.is_none() {
            return Some(0.0);
        }
        let alike = Problem {
            recording: self.recording,
            base: self.base.clone(),
            gains: self.gains,
            force_weight: 1.0,
        };
        let rows = self.recording.positions.len();
        let found = alike.differences(values)?;
        let (positions, forces) = found.split_at(rows.min(found.len()));
        let forces = squares(forces);
        Some(if forces > 0.0 {
            (squares(positions) / forces).sqrt()
        } else {
            0.0
        })
    }
}

fn squares(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

/// Fits gains and friction of a drive to a recorded run, from a drive to start with.
///
/// # Errors
/// [`FitError`] for a recording without motion or with too few rows, a drive that cannot be, and data that tell nothing.
pub fn fit(recording: &Recording, start: &DriveSettings) -> Result<Fit, FitError> {
    recording.check()?;
    let model = DriveModel::new(start)?;
    let mut problem = Problem {
        recording,
        base: start.clone(),
        gains: model.gains(),
        force_weight: 0.0,
    };
    let mut fitted: Vec<(Parameter, f64)> = Parameter::ALL
        .iter()
        .map(|&parameter| (parameter, value_of(parameter, start, &problem.gains)))
        .filter(|(_, value)| *value > 0.0)
        .collect();
    let mut held: Vec<Parameter> = Parameter::ALL
        .iter()
        .copied()
        .filter(|parameter| fitted.iter().all(|(other, _)| other != parameter))
        .collect();
    let refused = || FitError::Untold {
        condition: f64::INFINITY,
    };
    improve(&problem, &mut fitted).ok_or_else(refused)?;
    problem.force_weight = problem.weight(&fitted).ok_or_else(refused)?;
    loop {
        improve(&problem, &mut fitted).ok_or_else(refused)?;
        let (jacobian, differences) = jacobian(&problem, &fitted).ok_or_else(refused)?;
        let deviations = deviations(&jacobian, &differences);
        let worst = deviations
            .iter()
            .enumerate()
            .max_by(|one, other| one.1.total_cmp(other.1));
        let condition = condition(&jacobian);
        if let Some((index, deviation)) = worst
            && (deviation.is_nan() || *deviation > UNTOLD)
        {
            // What is not told goes back to where it began, and the rest is fitted again.
            held.push(fitted.remove(index).0);
            if fitted.is_empty() {
                return Err(FitError::Untold { condition });
            }
            continue;
        }
        let rows = recording.positions.len();
        #[allow(clippy::cast_precision_loss, reason = "rows are fewer than 2^53")]
        let residual = (squares(&differences[..rows]) / rows as f64).sqrt();
        let settings = with(&problem.base, problem.gains, &fitted);
        let gains = match settings.gains {
            GainSettings::Direct(gains) => gains,
            _ => problem.gains,
        };
        let parameters = Parameter::ALL
            .iter()
            .map(|&parameter| FittedParameter {
                parameter,
                value: value_of(parameter, &settings, &gains),
                deviation: fitted
                    .iter()
                    .position(|(other, _)| *other == parameter)
                    .and_then(|index| deviations.get(index).copied())
                    .unwrap_or(f64::INFINITY),
            })
            .collect();
        return Ok(Fit {
            settings,
            parameters,
            condition,
            residual,
        });
    }
}

/// Gauss-Newton steps, damped as far as they must be (Levenberg and Marquardt), until nothing changes any more; `None` where
/// the drive to start from cannot be simulated.
fn improve(problem: &Problem, values: &mut Vec<(Parameter, f64)>) -> Option<()> {
    let mut error = squares(&problem.differences(values)?);
    let mut damping = 1e-2;
    for _ in 0..ITERATIONS {
        let (jacobian, differences) = jacobian(problem, values)?;
        let mut moved = 0.0_f64;
        for _ in 0..TRIES {
            let step = damped_step(&jacobian, &differences, damping);
            let tried: Vec<(Parameter, f64)> = values
                .iter()
                .zip(&step)
                .map(|(&(parameter, value), change)| {
                    let change = change.clamp(-LONGEST_STEP, LONGEST_STEP);
                    (parameter, value * change.exp())
                })
                .collect();
            let sum = problem.differences(&tried).map(|found| squares(&found));
            if let Some(sum) = sum.filter(|sum| *sum < error) {
                moved = step.iter().fold(0.0, |most, change| most.max(change.abs()));
                error = sum;
                *values = tried;
                damping = (0.3 * damping).max(1e-9);
                break;
            }
            damping *= 4.0;
        }
        if moved < CONVERGED {
            break;
        }
    }
    Some(())
}

/// The step of least squares, damped in each parameter by a share of the length of its column.
fn damped_step(jacobian: &Mat<f64>, differences: &[f64], damping: f64) -> Vec<f64> {
    let (rows, columns) = (jacobian.nrows(), jacobian.ncols());
    let lengths: Vec<f64> = (0..columns)
        .map(|j| {
            (0..rows)
                .map(|i| jacobian[(i, j)].powi(2))
                .sum::<f64>()
                .sqrt()
        })
        .collect();
    let padded = Mat::from_fn(rows + columns, columns, |i, j| {
        if i < rows {
            jacobian[(i, j)]
        } else if i - rows == j {
            damping.sqrt() * lengths[j].max(1e-12)
        } else {
            0.0
        }
    });
    let target = Mat::from_fn(rows + columns, 1, |i, _| {
        differences.get(i).map_or(0.0, |value| -value)
    });
    let step = least_squares(&padded, &target);
    (0..columns)
        .map(|j| {
            if step[(j, 0)].is_finite() {
                step[(j, 0)]
            } else {
                0.0
            }
        })
        .collect()
}

/// Derivatives of the differences by the logarithm of each parameter, and the differences.
fn jacobian(problem: &Problem, values: &[(Parameter, f64)]) -> Option<(Mat<f64>, Vec<f64>)> {
    let here = problem.differences(values)?;
    let mut columns = Vec::with_capacity(values.len());
    for index in 0..values.len() {
        let mut moved = values.to_vec();
        moved[index].1 *= 1.0 + STEP;
        let there = problem.differences(&moved)?;
        columns.push(
            there
                .iter()
                .zip(&here)
                .map(|(there, here)| (there - here) / STEP)
                .collect::<Vec<f64>>(),
        );
    }
    Some((
        Mat::from_fn(here.len(), values.len(), |i, j| columns[j][i]),
        here,
    ))
}

/// Relative standard deviation of each parameter.
fn deviations(jacobian: &Mat<f64>, differences: &[f64]) -> Vec<f64> {
    let (rows, columns) = (jacobian.nrows(), jacobian.ncols());
    let normal = Mat::from_fn(columns, columns, |i, j| {
        (0..rows)
            .map(|row| jacobian[(row, i)] * jacobian[(row, j)])
            .sum::<f64>()
    });
    #[allow(clippy::cast_precision_loss, reason = "rows are fewer than 2^53")]
    let variance = squares(differences) / rows.saturating_sub(columns).max(1) as f64;
    // Rows of one run are no independent measurements: some tens of them say as much as one.
    let variance = variance * 100.0;
    let covariance = inverse(&normal);
    (0..columns)
        .map(|index| {
            let value = (variance * covariance[(index, index)]).sqrt();
            if value.is_finite() {
                value
            } else {
                f64::INFINITY
            }
        })
        .collect()
}

/// Condition number of a Jacobian whose columns are scaled to length 1.
fn condition(jacobian: &Mat<f64>) -> f64 {
    let (rows, columns) = (jacobian.nrows(), jacobian.ncols());
    let lengths: Vec<f64> = (0..columns)
        .map(|j| {
            (0..rows)
                .map(|i| jacobian[(i, j)].powi(2))
                .sum::<f64>()
                .sqrt()
        })
        .collect();
    let scaled = Mat::from_fn(rows, columns, |i, j| {
        jacobian[(i, j)] / lengths[j].max(f64::MIN_POSITIVE)
    });
    let values = singular_values(&scaled);
    match (values.first(), values.last()) {
        (Some(&most), Some(&least)) if least > 0.0 => most / least,
        _ => f64::INFINITY,
    }
}

/// Frequency, Hz, and damping ratio of a free oscillation, from equally spaced samples; `None` where it is none.
///
/// Two samples predict the next one, `y'' = a y' + b y`, by least squares over all of them.
#[must_use]
pub fn free_oscillation(samples: &[f64], period: f64) -> Option<[f64; 2]> {
    if samples.len() < 16 {
        return None;
    }
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    // Samples a fraction of an oscillation apart are told apart best: a quarter between crossings of the mean.
    let crossings = samples
        .windows(2)
        .filter(|pair| (pair[0] - mean) * (pair[1] - mean) < 0.0)
        .count();
    if crossings < 4 {
        return None;
    }
    let stride = (samples.len() / crossings / 2).max(1);
    let rows = samples.len().checked_sub(2 * stride)?;
    let at = |index: usize| samples[index] - mean;
    let a = Mat::from_fn(rows, 2, |i, j| at(i + stride * (1 - j)));
    let b = Mat::from_fn(rows, 1, |i, _| at(i + 2 * stride));
    let found = least_squares(&a, &b);
    let (first, second) = (found[(0, 0)], found[(1, 0)]);
    let radius = (-second).sqrt();
    let cosine = 0.5 * first / radius;
    if !(radius > 0.0 && radius <= 1.0 + 1e-9 && cosine.abs() < 1.0) {
        return None;
    }
    #[allow(clippy::cast_precision_loss, reason = "a stride is short")]
    let step = period * stride as f64;
    let (turn, rate) = (cosine.acos() / step, -radius.ln() / step);
    let natural = turn.hypot(rate);
    Some([natural / std::f64::consts::TAU, (rate / natural).max(0.0)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn recorded(settings: &DriveSettings, at: impl Fn(f64) -> f64, forces: bool) -> Recording {
        let model = DriveModel::new(settings).unwrap();
        let period = 1e-3;
        let refiner = Refiner::<1>::new(Interpolation::Cubic, period, settings.servo_period);
        let mut refiner = refiner.unwrap().with_room(40_000);
        let set_points: Vec<f64> = (0..2000).map(|k| at(f64::from(k) * period)).collect();
        set_points.iter().for_each(|&point| refiner.give([point]));
        let mut drive = Drive::new(&model, set_points[0]);
        let (mut positions, mut commands) = (Vec::new(), Vec::new());
        for row in 0..2000 {
            let step = settings.encoder_step;
            positions.push((drive.position() / step).round() * step);
            for part in 0..refiner.ratio() {
                let [point] = refiner.at(row * refiner.ratio() + part);
                drive.tick(point);
                if part == 0 {
                    commands.push(drive.command());
                }
            }
        }
        Recording {
            period,
            set_points,
            positions,
            forces: forces.then_some(commands),
        }
    }

    /// To and fro at several speeds.
    fn sweep(t: f64) -> f64 {
        4.0 * (1.0 - (TAU * t).cos()) + 0.5 * (1.0 - (TAU * 7.0 * t).cos())
    }

    #[test]
    fn a_simulated_run_gives_its_drive_back() {
        let mut truth = DriveSettings::textbook(35.0);
        truth.friction.coulomb = 300.0;
        truth.friction.static_force = 420.0;
        truth.friction.presliding = 0.012;
        for forces in [false, true] {
            let recording = recorded(&truth, sweep, forces);
            let fit = fit(&recording, &DriveSettings::textbook(30.0)).unwrap();
            let found = |parameter| {
                let all = &fit.parameters;
                all.iter()
                    .find(|other| other.parameter == parameter)
                    .copied()
                    .unwrap()
            };
            let gains = DriveModel::new(&truth).unwrap().gains();
            for (parameter, expected) in [
                (Parameter::PositionGain, gains.position),
                (Parameter::VelocityGain, gains.velocity),
                (Parameter::Coulomb, 300.0),
            ] {
                let found = found(parameter);
                let off = (found.value / expected - 1.0).abs();
                assert!(
                    off < 0.03,
                    "{parameter:?}: {found:?}, but {expected}; {forces}: {:?} {} {}",
                    fit.parameters,
                    fit.residual,
                    fit.condition
                );
            }
            assert!(fit.residual < 2e-4, "{fit:?}");
            assert!(fit.condition.is_finite(), "{fit:?}");
        }
    }

    #[test]
    fn what_the_data_do_not_tell_is_held_and_no_motion_is_refused() {
        let mut truth = DriveSettings::textbook(35.0);
        truth.friction.coulomb = 300.0;
        truth.friction.static_force = 420.0;
        // One way without a reversal: the distance over which friction turns over is not seen.
        let slow = |t: f64| 10.0 * (t / 2.0).powi(2);
        let fit = fit(
            &recorded(&truth, slow, false),
            &DriveSettings::textbook(35.0),
        )
        .unwrap();
        let held = fit
            .parameters
            .iter()
            .filter(|found| found.deviation.is_infinite());
        assert!(held.count() >= 1, "{fit:?}");
        let rest = super::fit(
            &recorded(&truth, |_| 1.0, false),
            &DriveSettings::textbook(35.0),
        );
        assert!(matches!(rest, Err(FitError::Recording { .. })), "{rest:?}");
    }

    #[test]
    fn a_free_oscillation_has_its_frequency_and_damping() {
        let (natural, damping) = (TAU * 7.4, 0.02_f64);
        let damped = natural * (1.0 - damping * damping).sqrt();
        let samples: Vec<f64> = (0..3000)
            .map(|k| f64::from(k) * 1e-3)
            .map(|t| 2.0 + (-damping * natural * t).exp() * (damped * t).cos())
            .collect();
        let [frequency, found] = free_oscillation(&samples, 1e-3).unwrap();
        assert!((frequency / 7.4 - 1.0).abs() < 1e-3, "{frequency}");
        assert!((found / damping - 1.0).abs() < 0.02, "{found}");
        assert!(free_oscillation(&[1.0; 100], 1e-3).is_none(), "rest");
    }
}
