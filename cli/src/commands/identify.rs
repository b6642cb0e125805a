//! Fits the drives of a machine to a recorded run and prints them as they stand in a machine file.
//!
//! Source: section 2.3.2 names the drives of its machine but not their gains and friction; a recording tells them. Not here:
//! the fit, see `toolglide_simulation::fit`.

use crate::error::CliError;
use crate::input::args::{IdentifyArgs, JobArgs};
use crate::input::drives::{DriveChanges, Drives};
use crate::input::recording::{Columns, read};
use crate::input::setup::Setup;
use crate::output::report::{Shown, show};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::Write;
use toolglide_kinematics::{Axis, AxisKind};
use toolglide_simulation::{Fit, FitError, Parameter, Recording, fit, free_oscillation};

/// Runs the command.
pub(crate) fn identify(
    args: &IdentifyArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let job = JobArgs::for_machine(&args.machine, args.json);
    let setup = Setup::new(&job, None)?;
    let changes = DriveChanges {
        textbook: args.drive.is_some(),
        bandwidth: args.bandwidth,
        ..DriveChanges::default()
    };
    let drives = Drives::of(&setup, &changes)?;
    let columns = read(&args.recording, &setup.axes)?;
    let mut found = Identified {
        recording: args.recording.display().to_string(),
        machine: setup.machine.clone(),
        axes: Vec::new(),
        modes: modes(&setup.axes, &columns),
        untold: Vec::new(),
    };
    for ((axis, driven), column) in setup.axes.iter().zip(&drives.axes).zip(&columns.axes) {
        let Some(column) = column else { continue };
        let recording = Recording {
            period: columns.period,
            set_points: column.set_points.clone(),
            positions: column.positions.clone(),
            forces: column.forces.clone(),
        };
        match fit(&recording, driven.model.settings()) {
            Ok(fitted) => found.axes.push(AxisFit::of(axis, &fitted)),
            Err(reason @ FitError::Recording { .. }) => {
                found.untold.push(format!("axis {}: {reason}", axis.name));
            }
            Err(reason) => {
                return Err(refused(args, &format!("axis {}: {reason}", axis.name)));
            }
        }
    }
    if found.axes.is_empty() {
        let reasons = if found.untold.is_empty() {
            "it has no columns planned_x and actual_x of any axis".to_owned()
        } else {
            found.untold.join("; ")
        };
        return Err(refused(args, &reasons));
    }
    show(&found, args.json, out, err)
}

fn refused(args: &IdentifyArgs, reason: &str) -> CliError {
    CliError::Row {
        file: args.recording.clone(),
        line: 0,
        reason: reason.to_owned(),
    }
}

/// What was fitted.
#[derive(Clone, Debug, Serialize)]
struct Identified {
    recording: String,
    machine: String,
    axes: Vec<AxisFit>,
    modes: Vec<ModeFit>,
    untold: Vec<String>,
}

/// The drive of one axis.
#[derive(Clone, Debug, Serialize)]
struct AxisFit {
    axis: char,
    condition: f64,
    residual_um: f64,
    parameters: Vec<ParameterFit>,
    #[serde(skip)]
    rotary: bool,
}

/// One parameter.
#[derive(Clone, Debug, Serialize)]
struct ParameterFit {
    name: &'static str,
    value: f64,
    /// Relative standard deviation; nothing where the data do not tell it.
    deviation: Option<f64>,
    #[serde(skip)]
    parameter: Parameter,
}

/// A free oscillation after the motion.
#[derive(Clone, Debug, Serialize)]
struct ModeFit {
    axis: char,
    frequency_hz: f64,
    damping: f64,
}

fn modes(axes: &[Axis], columns: &Columns) -> Vec<ModeFit> {
    axes.iter()
        .zip(&columns.axes)
        .filter_map(|(axis, column)| {
            let column = column.as_ref()?;
            let accelerations = column.accelerations.as_ref()?;
            // What swings after the set-points have come to rest swings freely.
            let last = column.set_points.last()?;
            let moving = column
                .set_points
                .iter()
                .rposition(|point| (point - last).abs() > 1e-9)?;
            let tail = accelerations.get(moving + 1..)?;
            let [frequency_hz, damping] = free_oscillation(tail, columns.period)?;
            Some(ModeFit {
                axis: axis.name,
                frequency_hz,
                damping,
            })
        })
        .collect()
}

impl AxisFit {
    fn of(axis: &Axis, fit: &Fit) -> Self {
        Self {
            axis: axis.name,
            condition: fit.condition,
            residual_um: 1e3 * fit.residual,
            parameters: fit
                .parameters
                .iter()
                .map(|found| ParameterFit {
                    name: found.parameter.name(),
                    value: found.value,
                    deviation: found.deviation.is_finite().then_some(found.deviation),
                    parameter: found.parameter,
                })
                .collect(),
            rotary: axis.kind == AxisKind::Rotary,
        }
    }

    fn value(&self, parameter: Parameter) -> f64 {
        self.parameters
            .iter()
            .find(|found| found.parameter == parameter)
            .map_or(0.0, |found| found.value)
    }

    /// The lines of a machine file.
    fn lines(&self, text: &mut String) {
        let (force, velocity_unit) = if self.rotary {
            ("rad_s2", "arcsec")
        } else {
            ("mm_s2", "um")
        };
        let presliding = self.value(Parameter::Presliding)
            * if self.rotary {
                648_000.0 / std::f64::consts::PI
            } else {
                1e3
            };
        let coulomb = self.value(Parameter::Coulomb);
        let _ = writeln!(
            text,
            "# axis {}\ndrive = {{ position_gain = {:.5}, velocity_gain = {:.5}, integral_gain = {:.1}, friction = {{ coulomb_{force} = {:.4}, static_{force} = {:.4}, presliding_{velocity_unit} = {:.4}, viscous_per_s = {:.4} }} }}",
            self.axis,
            self.value(Parameter::PositionGain),
            self.value(Parameter::VelocityGain),
            self.value(Parameter::IntegralGain),
            coulomb,
            coulomb * (1.0 + self.value(Parameter::StaticExcess)),
            presliding,
            self.value(Parameter::Viscous),
        );
    }
}

impl Shown for Identified {
    fn text(&self) -> String {
        let mut text = format!("{}: drives of {}\n", self.recording, self.machine);
        for axis in &self.axes {
            let _ = writeln!(
                text,
                "\naxis {}: positions differ by {:.3} µm RMS, condition number {:.1}",
                axis.axis, axis.residual_um, axis.condition
            );
            for found in &axis.parameters {
                let told = found.deviation.map_or_else(
                    || "held: the data do not tell it".to_owned(),
                    |deviation| format!("± {:.1} %", 100.0 * deviation),
                );
                let _ = writeln!(text, "  {:<40} {:>12.5}  {told}", found.name, found.value);
            }
        }
        text.push_str("\nIn the machine file, each below its [[axis]]:\n\n");
        for axis in &self.axes {
            axis.lines(&mut text);
        }
        for mode in &self.modes {
            let _ = writeln!(
                text,
                "\n[[mode]]\naxis = \"{}\"\nfrequency_hz = {:.4}\ndamping = {:.5}",
                mode.axis, mode.frequency_hz, mode.damping
            );
        }
        text
    }

    fn complaint(&self) -> String {
        self.untold
            .iter()
            .map(|reason| format!("{}: {reason}\n", self.recording))
            .collect()
    }

    fn passes(&self) -> bool {
        true
    }
}
