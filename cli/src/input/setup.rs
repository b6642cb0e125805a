//! Builds the machine of a run, with the changes of the command line.
//!
//! Not here: what the machine does with a tool pose.

use crate::error::CliError;
use crate::input::args::JobArgs;
use crate::input::source::kind_of;
use crate::input::values::PerAxis;
use std::path::Path;
use toolglide_kinematics::{
    Axis, AxisKind, AxisLimits, AxisVector, Limits, MachineKinematics, SamplePeriod, Tolerance,
    ToolPose, Vector,
};
use toolglide_machines::{
    DriveConfig, MachineConfig, MachineError, ModeConfig, find, is_plain, load,
};
use toolglide_program::{AXES_BESIDE, ToolTable};

/// Shortest period that is taken, s: below it a file of set-points has no end worth waiting for.
const SHORTEST_PERIOD: f64 = 1e-9;

/// Decimals beyond which a degree that was a rad shows its rounding.
const DECIMALS: f64 = 1e9;

/// The machine of a run.
#[derive(Debug)]
pub(crate) struct Setup {
    /// The machine as the command line asks for it: a name or a file.
    pub(crate) asked: String,
    /// Name of the machine.
    pub(crate) machine: String,
    /// Its axes, with the limits of this run.
    pub(crate) axes: Vec<Axis>,
    /// Tolerance where the program asks for none.
    pub(crate) tolerance: Tolerance,
    /// Whether the program may not ask for another.
    pub(crate) override_tolerance: bool,
    /// Period of the set-points.
    pub(crate) period: SamplePeriod,
    /// Time constants of filters that the machine file gives; none where it does not.
    pub(crate) time_constants: Vec<f64>,
    /// Modes of vibration.
    pub(crate) modes: Vec<ModeConfig>,
    /// Who says so, as messages tell it.
    pub(crate) modes_asked: String,
    /// Tools of the machine.
    pub(crate) tools: ToolTable,
    /// Its reference points: X Y Z in mm, A B C in degrees.
    pub(crate) reference_points: Vec<[f64; 6]>,
    /// What the machine file says of the drive of each axis; none where it does not.
    pub(crate) drives: Option<Vec<DriveConfig>>,
    /// Whether rotary axes are counted in degrees.
    pub(crate) counts_degrees: bool,
    start: Vec<f64>,
}

/// The description of a registered machine or of a machine file, and the machine.
pub(crate) fn machine(name: &str) -> Result<(MachineConfig, Box<dyn MachineKinematics>), CliError> {
    let path = Path::new(name);
    let is_file = path.extension().is_some_and(|ending| ending == "toml") || path.is_file();
    if !is_file {
        let model = find(name).map_err(|unknown| match std::fs::metadata(path) {
            Ok(found) => MachineError::Read {
                file: path.to_owned(),
                reason: std::io::Error::other(kind_of(&found)),
            },
            Err(_) => unknown,
        })?;
        let config = (model.preset)();
        let machine = (model.build)(&config)?;
        return Ok((config, machine));
    }
    let config = load(path)?;
    let machine = find(&config.model)
        .and_then(|model| (model.build)(&config))
        .and_then(|machine| config.modes().map(|_| machine))
        .and_then(|machine| config.reference_points().map(|_| machine))
        .map_err(|reason| MachineError::InFile {
            file: path.to_owned(),
            reason: Box::new(reason),
        })?;
    Ok((config, machine))
}

/// The drive of each axis, where the file says anything about drives.
fn drives(config: &MachineConfig) -> Option<Vec<DriveConfig>> {
    let given = config.drive.is_some() || config.axis.iter().any(|axis| axis.drive.is_some());
    let all = config.drive.unwrap_or_default();
    let of = |own: Option<DriveConfig>| own.map_or(all, |own| own.over(all));
    given.then(|| config.axis.iter().map(|axis| of(axis.drive)).collect())
}

/// Whether a machine has straight axes X Y or X Y Z alone, which planners of straight axes take.
pub(crate) fn is_straight(config: &MachineConfig, machine: &dyn MachineKinematics) -> bool {
    let linear = |axis: &Axis| axis.kind == AxisKind::Linear;
    machine.axes().iter().all(linear) && matches!(config.letters().as_str(), "XY" | "XYZ")
}

impl Setup {
    /// The machine that the command line asks for, whose axes the program must name itself. Rotary ones
    /// are in degrees from here on, and a degree counts as a millimetre.
    pub(crate) fn new(job: &JobArgs, period: Option<f64>) -> Result<Self, CliError> {
        let (config, machine) = machine(&job.machine)?;
        let letters = config.letters();
        let plain = is_plain(&config);
        if !is_straight(&config, machine.as_ref()) && !plain {
            return Err(CliError::Option {
                option: "--machine",
                value: format!("\"{}\" with axes {letters}", config.name),
                bound: "this is done for machines whose axes the program moves itself: X Y, X Y Z, and A B C U V W beside them".to_owned(),
            });
        }
        let setup = Self::of(config, machine.as_ref(), job, period)?;
        if plain { setup.in_degrees() } else { Ok(setup) }
    }

    /// A machine of any axes, with what the command line changes about it.
    pub(crate) fn of(
        config: MachineConfig,
        machine: &dyn MachineKinematics,
        job: &JobArgs,
        period: Option<f64>,
    ) -> Result<Self, CliError> {
        let axes = limited(machine.axes(), job)?;
        let start = match &job.start {
            Some(given) => started(&axes, given)?,
            None if is_straight(&config, machine) || is_plain(&config) => {
                started(&axes, &PerAxis(vec![0.0; axes.len()]))?
            }
            None => at_program_zero(machine),
        };
        let tolerance = match job.tolerance {
            Some(length) => Tolerance::new(length).map_err(|reason| CliError::Option {
                option: "--tolerance",
                value: length.to_string(),
                bound: reason.to_string(),
            })?,
            None => machine.default_tolerance(),
        };
        let modes = config.modes()?.to_vec();
        let reference_points = config.reference_points()?;
        let drives = drives(&config);
        Ok(Self {
            drives,
            counts_degrees: false,
            time_constants: config.fir_s,
            modes,
            modes_asked: format!("{}: [[mode]]", job.machine),
            asked: job.machine.clone(),
            machine: config.name,
            axes,
            tolerance,
            override_tolerance: job.tolerance.is_some(),
            period: checked_period(period.unwrap_or(machine.set_point_period().seconds()))?,
            tools: crate::input::source::tools(job.tool_table.as_deref())?,
            reference_points,
            start,
        })
    }

    /// The limits of this run, for as many axes as the machine has.
    pub(crate) fn limits<const N: usize>(&self) -> Limits<N> {
        Limits::new(std::array::from_fn(|axis| self.axes[axis].limits))
    }

    /// Where each axis starts, mm and rad, in machine order.
    pub(crate) fn start_positions(&self) -> &[f64] {
        &self.start
    }

    /// Where the motion starts.
    pub(crate) fn start<const N: usize>(&self) -> Vector<N> {
        Vector::from_fn(|axis, _| self.start[axis])
    }

    /// Where an axis starts, if the machine has it.
    fn start_of(&self, letter: char) -> Option<f64> {
        let index = self.axes.iter().position(|axis| axis.name == letter);
        index.map(|index| self.start[index])
    }

    /// The start as the three coordinates of a program; an axis that is missing stays at 0.
    pub(crate) fn start_point(&self) -> Vector<3> {
        ['X', 'Y', 'Z']
            .map(|letter| self.start_of(letter).unwrap_or(0.0))
            .into()
    }

    /// Which of X, Y and Z the machine has.
    pub(crate) fn has_axes(&self) -> [bool; 3] {
        ['X', 'Y', 'Z'].map(|letter| self.start_of(letter).is_some())
    }

    /// The machine's axes beside X, Y and Z, each with its start position, degrees and mm.
    pub(crate) fn beside(&self) -> ([bool; 6], [f64; 6]) {
        let start = AXES_BESIDE.map(|letter| self.start_of(letter));
        (
            start.map(|start| start.is_some()),
            start.map(Option::unwrap_or_default),
        )
    }

    /// The same with rotary axes in degrees.
    fn in_degrees(mut self) -> Result<Self, CliError> {
        self.counts_degrees = true;
        let degrees = |angle: f64| (angle.to_degrees() * DECIMALS).round() / DECIMALS;
        for (axis, start) in self.axes.iter_mut().zip(&mut self.start) {
            if axis.kind == AxisKind::Rotary {
                let limits = axis.limits;
                axis.limits = AxisLimits::new(
                    degrees(limits.velocity()),
                    degrees(limits.acceleration()),
                    degrees(limits.jerk()),
                )
                .map_err(|reason| CliError::Option {
                    option: "--machine",
                    value: format!("a limit of axis {}", axis.name),
                    bound: reason.to_string(),
                })?;
                axis.travel = axis.travel.map(|(low, high)| (degrees(low), degrees(high)));
                *start = degrees(*start);
            }
        }
        Ok(self)
    }

    /// Letters of the axes; `N` is their number.
    pub(crate) fn letters_of<const N: usize>(&self) -> [char; N] {
        std::array::from_fn(|axis| self.axes.get(axis).map_or('?', |axis| axis.name))
    }

    /// Unit of a length along the path of all axes.
    pub(crate) fn path_unit(&self) -> &'static str {
        let turns = self.axes.iter().any(|axis| axis.kind == AxisKind::Rotary);
        if turns { "mm and degrees" } else { "mm" }
    }

    /// Letters of the axes.
    pub(crate) fn letters(&self) -> Vec<char> {
        self.axes.iter().map(|axis| axis.name).collect()
    }
}

/// Where the command line says that the axes start, mm and rad.
fn started(axes: &[Axis], given: &PerAxis) -> Result<Vec<f64>, CliError> {
    let mut start = one_per_axis("--start", given, axes.len())?;
    for (axis, position) in axes.iter().zip(&mut start) {
        let unit = match axis.kind {
            AxisKind::Linear => 1.0,
            AxisKind::Rotary => 1.0_f64.to_radians(),
        };
        let written = *position;
        *position *= unit;
        if let Some((low, high)) = axis.travel
            && !(low..=high).contains(position)
        {
            return Err(CliError::Option {
                option: "--start",
                value: format!("{} = {written}", axis.name),
                bound: format!(
                    "the travel of this axis is {} to {}",
                    low / unit,
                    high / unit
                ),
            });
        }
    }
    Ok(start)
}

/// The axes with the tool upright and its tip at program zero; where the machine cannot have it
/// there, as near to 0 as they can be.
fn at_program_zero(machine: &dyn MachineKinematics) -> Vec<f64> {
    let axes = machine.axes();
    let near: Vec<f64> = axes
        .iter()
        .map(|axis| {
            axis.travel
                .map_or(0.0, |(low, high)| 0.0_f64.clamp(low, high))
        })
        .collect();
    let tool = ToolPose::upright(Vector::zeros()).ok();
    AxisVector::from_slice(&near)
        .ok()
        .zip(tool)
        .and_then(|(near, tool)| machine.inverse(&tool, &near).ok())
        .map_or(near, |start| start.to_vec())
}

fn checked_period(seconds: f64) -> Result<SamplePeriod, CliError> {
    let refused = |bound: String| CliError::Option {
        option: "--period",
        value: format!("{seconds} s"),
        bound,
    };
    if seconds < SHORTEST_PERIOD {
        return Err(refused(format!("it must be at least {SHORTEST_PERIOD} s")));
    }
    SamplePeriod::new(seconds).map_err(|reason| refused(reason.to_string()))
}

fn limited(axes: &[Axis], job: &JobArgs) -> Result<Vec<Axis>, CliError> {
    let given = |option, values: &Option<PerAxis>| match values {
        Some(values) => one_per_axis(option, values, axes.len()).map(Some),
        None => Ok(None),
    };
    let velocity = given("--max-velocity", &job.max_velocity)?;
    let acceleration = given("--max-acceleration", &job.max_acceleration)?;
    let jerk = given("--max-jerk", &job.max_jerk)?;
    let pick = |values: &Option<Vec<f64>>, index: usize, usual: f64| {
        let given = values.as_ref().and_then(|values| values.get(index));
        match (given, axes[index].kind) {
            (Some(degrees), AxisKind::Rotary) => degrees.to_radians(),
            (Some(given), AxisKind::Linear) => *given,
            (None, _) => usual,
        }
    };
    axes.iter()
        .enumerate()
        .map(|(index, axis)| {
            let limits = AxisLimits::new(
                pick(&velocity, index, axis.limits.velocity()),
                pick(&acceleration, index, axis.limits.acceleration()),
                pick(&jerk, index, axis.limits.jerk()),
            )
            .map_err(|reason| CliError::Option {
                option: "--max-...",
                value: format!("a limit of axis {}", axis.name),
                bound: reason.to_string(),
            })?;
            Ok(Axis {
                limits,
                ..axis.clone()
            })
        })
        .collect()
}

fn one_per_axis(option: &'static str, values: &PerAxis, axes: usize) -> Result<Vec<f64>, CliError> {
    let list = &values.0;
    match list.len() {
        1 if option != "--start" => Ok(vec![list[0]; axes]),
        given if given == axes => Ok(list.clone()),
        given => Err(CliError::Option {
            option,
            value: format!("a list of {given}"),
            bound: format!("the machine has {axes} axes"),
        }),
    }
}
