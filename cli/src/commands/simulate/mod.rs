//! Simulates what a motion becomes behind the drives of a machine, and what that costs or brings.
//!
//! Source: errors as the dissertation measures them. Every row of the table is a case: a method with its limits, tolerance,
//! filters and drives. Not here: drives, see `toolglide_simulation`.

mod case;
mod report;
mod rows;
mod set_points;

use crate::commands::plan::title;
use crate::error::CliError;
use crate::input::args::{JobArgs, SimulateArgs, TuningArgs};
use crate::input::drives::{DriveChanges, Drives};
use crate::input::setup::Setup;
use crate::input::travel::{OnAxes, by_axes};
use crate::input::values::{PerAxis, Sweep, Varied};
use crate::methods::Tuning;
use crate::output::files::OutputFile;
use crate::output::output_files::Drawing;
use crate::output::report::{show, show_beside_rows};
use crate::plot::{Caption, ResponseCurve, Responses, SimulationPlot};
use case::{Case, run_case};
use report::Simulation;
use rows::Rows;
use std::io::Write;
use std::path::Path;
use toolglide_kinematics::Move;

/// Frequencies of a response.
const RESPONSE_POINTS: u32 = 400;

/// A response is drawn up to this multiple of the bandwidth or of the highest mode.
const RESPONSE_TO: f64 = 4.0;

/// Runs the command.
pub(crate) fn simulate(
    args: &SimulateArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let setup = Setup::new(&args.job, args.period)?;
    by_axes!(setup.axes.len(), run(args, &setup, out, err))
}

/// What the command line changes about drives.
fn changes(args: &SimulateArgs) -> DriveChanges {
    DriveChanges {
        textbook: args.drive.is_some(),
        bandwidth: args.bandwidth,
        feedforward: args.feedforward.clone(),
        rigid: args.rigid,
        no_friction: args.no_friction,
    }
}

/// The cases of a run: every method, at every value of what is varied.
fn cases(args: &SimulateArgs) -> Result<Vec<Case>, CliError> {
    let mut methods = Vec::<&String>::new();
    for method in &args.methods {
        if !methods.contains(&method) {
            methods.push(method);
        }
    }
    let given = args.set_points.is_some();
    let values: Vec<Option<&[f64]>> = match &args.sweep {
        Some(sweep) => sweep.values.iter().map(|value| Some(&value[..])).collect(),
        None => vec![None],
    };
    let mut cases = Vec::new();
    for method in methods.iter().take(if given { 1 } else { usize::MAX }) {
        for value in &values {
            cases.push(case(
                args,
                method,
                value.and_then(|value| args.sweep.as_ref().map(|sweep| (sweep, value))),
            )?);
        }
    }
    Ok(cases)
}

/// One case.
fn case(
    args: &SimulateArgs,
    method: &str,
    varied: Option<(&Sweep, &[f64])>,
) -> Result<Case, CliError> {
    let mut job: JobArgs = args.job.clone();
    let mut tuning: TuningArgs = args.tuning.clone();
    let mut changes = changes(args);
    let mut label = match &args.set_points {
        Some(file) => title(&file.display().to_string()),
        None => method.to_owned(),
    };
    if let Some((sweep, value)) = varied {
        let (name, unit) = match sweep.varied {
            Varied::Jerk => ("jerk", "mm/s³"),
            Varied::Acceleration => ("acceleration", "mm/s²"),
            Varied::Tolerance => ("tolerance", "mm"),
            Varied::Bandwidth => ("bandwidth", "Hz"),
            Varied::Fir => ("fir", "s"),
        };
        match sweep.varied {
            Varied::Jerk => job.max_jerk = Some(PerAxis(value.to_vec())),
            Varied::Acceleration => job.max_acceleration = Some(PerAxis(value.to_vec())),
            Varied::Tolerance => job.tolerance = value.first().copied(),
            Varied::Bandwidth => changes.bandwidth = value.first().copied(),
            Varied::Fir => tuning.fir = Some(PerAxis(value.to_vec())),
        }
        let list: Vec<String> = value.iter().map(f64::to_string).collect();
        label = format!("{label}, {name} {} {unit}", list.join(" and "));
    }
    let setup = Setup::new(&job, args.period)?;
    let drives = Drives::of(&setup, &changes)?;
    // Filters on the modes are for methods that filter; others may have modes that set-points do not resolve.
    let mut filtered = Setup::new(&job, args.period)?;
    if !method.starts_with("fir") {
        filtered.modes.clear();
    }
    let tuning = Tuning::of(&tuning, &filtered)?;
    Ok(Case {
        label,
        method: method.to_owned(),
        tuning,
        drives,
        job,
        setup,
    })
}

fn run<const N: usize>(
    args: &SimulateArgs,
    setup: &Setup,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError>
where
    Move<N>: OnAxes,
{
    let cases = cases(args)?;
    let alone = cases.len() == 1;
    let refuse = |option, value: String, bound: &str| CliError::Option {
        option,
        value,
        bound: bound.to_owned(),
    };
    if !alone && args.job.program == Path::new("-") {
        let bound = "standard input is read once, so it takes one method and one value";
        return Err(refuse("PROGRAM", "-".to_owned(), bound));
    }
    if !alone && let Some(file) = &args.output {
        let bound = "one motion is written, so it takes one method and one value";
        return Err(refuse("--output", file.display().to_string(), bound));
    }
    let to_stdout = args.output.as_deref() == Some(Path::new("-"));
    if to_stdout && args.job.json {
        let bound = "only one of them can have standard output";
        return Err(refuse("--json", "with -o -".to_owned(), bound));
    }
    let inputs = [args.job.program.as_path(), Path::new(&args.job.machine)];
    let inputs: Vec<&Path> = inputs
        .into_iter()
        .chain(args.job.tool_table.as_deref())
        .chain(args.set_points.as_deref())
        .collect();
    let mut file = match args.output.as_deref().filter(|_| !to_stdout) {
        Some(path) => Some(OutputFile::begin(path, &inputs)?),
        None => None,
    };
    let drawing = Drawing::begin(args.plot.as_deref(), &args.job)?;
    let response = Drawing::begin(args.response.as_deref(), &args.job)?;
    let mut simulation = Simulation::new(setup, args.require);
    simulation.textbook = cases.iter().any(|case| case.drives.textbook);
    let mut plot = drawing
        .is_some()
        .then(|| SimulationPlot::new(setup.letters()));
    for case in &cases {
        let rows = match (&mut file, to_stdout) {
            (Some(file), _) => {
                let name = file.path().to_owned();
                Some(Rows::new(case, file, name))
            }
            (None, true) => Some(Rows::new(case, out, "standard output".into())),
            (None, false) => None,
        };
        let (row, trace) = run_case::<N>(args, case, rows, plot.is_some(), err)?;
        simulation.program.clone_from(&row.program);
        if let (Some(plot), Some(trace)) = (&mut plot, trace) {
            plot.add(&case.label, row.cycle_time_s, row.part_mm(), trace);
        }
        simulation.add(row);
    }
    if let (Some(mut drawing), Some(plot)) = (drawing, plot) {
        drawing.write(&plot.draw(&Caption {
            title: title(&simulation.program),
            subtitle: simulation.subtitle(),
        }))?;
        drawing.commit()?;
    }
    if let (Some(mut drawing), Some(case)) = (response, cases.first()) {
        drawing.write(&Responses::draw(
            &responses(case),
            &Caption {
                title: format!("drives of {}", setup.machine),
                subtitle:
                    "response of the position to the set-point, sampled loop without friction"
                        .to_owned(),
            },
        ))?;
        drawing.commit()?;
    }
    if let Some(file) = file {
        OutputFile::commit([file])?;
    }
    if to_stdout {
        return show_beside_rows(&simulation, err);
    }
    show(&simulation, args.job.json, out, err)
}

/// The responses of all drives of a case.
fn responses(case: &Case) -> Vec<ResponseCurve> {
    case.drives
        .axes
        .iter()
        .map(|axis| {
            let report = axis.model.report();
            let modes: Vec<f64> = axis
                .model
                .modes()
                .iter()
                .map(|mode| mode.frequency)
                .collect();
            let nyquist = 0.49 / axis.model.settings().servo_period;
            let highest = modes.iter().copied().fold(report.bandwidth, f64::max);
            let top = (RESPONSE_TO * highest).min(nyquist);
            let points = (1..=RESPONSE_POINTS)
                .map(|index| {
                    let frequency = top * f64::from(index) / f64::from(RESPONSE_POINTS);
                    axis.model.response(frequency, axis.coordinate)
                })
                .collect();
            ResponseCurve {
                axis: axis.name,
                bandwidth: report.bandwidth,
                modes,
                points,
            }
        })
        .collect()
}
