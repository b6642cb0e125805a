//! Plans a program and writes set-points, summary and plot.
//!
//! Files are begun before anything is planned, so that what cannot be written is refused at once,
//! and named when everything is done.

use crate::error::CliError;
use crate::input::args::{JobArgs, PlanArgs};
use crate::input::setup::Setup;
use crate::input::source::{Source, subroutines, with_parameters};
use crate::input::travel::{OnAxes, Travel, by_axes};
use crate::methods::{METHODS, Tuning, planner};
use crate::output::csv_writer::SetPoints;
use crate::output::output_files::PlanFiles;
use crate::output::page::Recording;
use crate::output::report::{show, show_beside_rows};
use crate::output::summary::{Summary, clock};
use crate::pipeline::{Moves, Pipeline};
use crate::plot::{Caption, Plot};
use crate::rounding::RoundToPeriod;
use std::io::{BufRead, Write};
use std::path::Path;
use toolglide_kinematics::Move;
use toolglide_program::{Program, Settings};

/// Runs the command.
pub(crate) fn plan(
    args: &PlanArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    if crate::commands::poses::concerns(&args.job)? {
        if args.round_to_period {
            return Err(CliError::Option {
                option: "--round-to-period",
                value: "with tool poses".to_owned(),
                bound: "it is for straight axes".to_owned(),
            });
        }
        return crate::commands::poses::plan(args, out, err);
    }
    let setup = Setup::new(&args.job, args.period)?;
    by_axes!(setup.axes.len(), run(args, &setup, out, err))
}

/// The moves of a program for the machine of a run.
pub(crate) fn moves<const N: usize>(
    job: &JobArgs,
    setup: &Setup,
    source: Source,
) -> Result<Moves<impl BufRead + use<N>, N>, CliError> {
    let settings = Settings {
        tolerance: setup.tolerance,
        override_tolerance: setup.override_tolerance,
        start: setup.start_point(),
        axes: setup.has_axes(),
        lenient: job.lenient,
        ..Settings::new(setup.tolerance)
    };
    let program = Program::new(source.reader, &source.name, settings)
        .in_language(source.language)
        .for_machine(&setup.machine)
        .with_tools(setup.tools.clone())
        .with_reference_points(&setup.reference_points)
        .with_subroutines(subroutines(&job.program));
    let (beside, start) = setup.beside();
    Ok(Moves {
        program: with_parameters(program, &job.parameters)?.on_all_axes(beside, start),
        letters: setup.letters_of(),
        name: source.name,
        travel: Travel::of(&setup.axes),
    })
}

/// Tells what the reader of the program wants known.
pub(crate) fn warn<R: BufRead>(program: &Program<R>, err: &mut dyn Write) {
    for warning in program.warnings() {
        let _ = writeln!(err, "warning: {warning}");
    }
    if program.more_warnings() > 0 {
        let _ = writeln!(err, "and {} more warnings", program.more_warnings());
    }
}

fn run<const N: usize>(
    args: &PlanArgs,
    setup: &Setup,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError>
where
    Move<N>: OnAxes,
{
    let method = args.method.as_deref().unwrap_or(METHODS[0].name);
    let mut files = PlanFiles::begin(args)?;
    let source = Source::open(&args.job.program, args.job.dialect.as_deref())?;
    let name = source.name.clone();
    let start = setup.start::<N>();
    let limits = setup.limits::<N>();
    let tuning = Tuning::of(&args.tuning, setup)?;
    let drawn = files.drawing.is_some();
    let recorded = files.page.is_some();
    let destination = files.rows.destination(out);
    let mut judge = tuning.judge(method, start, limits);
    if args.round_to_period {
        // Other durations set the modes swinging.
        judge = judge.with_modes(&tuning.all_modes, false);
    }
    if recorded {
        judge = judge.measuring_each();
    }
    let mut planner = planner(method, start, limits, &tuning)?;
    if args.round_to_period {
        planner = Box::new(RoundToPeriod::new(planner, setup.period));
    }
    let outcome = Pipeline {
        moves: moves(&args.job, setup, source)?,
        planner,
        judge,
        set_points: SetPoints::new(setup.period, &setup.axes, start, destination),
        plot: drawn.then(|| Plot::new(start, limits, setup.letters())),
        recording: recorded.then(|| Recording::new(start, limits, 1)),
    }
    .run()?;
    let blocks = outcome.program.program().blocks();
    let mut summary = Summary::of(&name, setup, &outcome.report, blocks, outcome.rows);
    summary.method = Some(method.to_owned());
    summary.period_s = Some(setup.period.seconds());
    summary.planning_time_s = Some(outcome.planning_time.as_secs_f64());
    summary.windows = outcome.windows.map(Into::into);
    warn(outcome.program.program(), err);
    if let (Some(drawing), Some(plot)) = (&mut files.drawing, outcome.plot) {
        drawing.write(&plot.draw(&caption(&summary)))?;
    }
    if let (Some(page), Some(recording)) = (&mut files.page, outcome.recording) {
        page.write(&name, setup, recording, [(method, &outcome.report)])?;
    }
    if files.commit()? {
        return show_beside_rows(&summary, err);
    }
    show(&summary, args.job.json, out, err)
}

/// A program on a picture: its name without its folder.
pub(crate) fn title(program: &str) -> String {
    Path::new(program).file_name().map_or_else(
        || program.to_owned(),
        |name| name.to_string_lossy().into_owned(),
    )
}

fn caption(summary: &Summary) -> Caption {
    Caption {
        title: title(&summary.program),
        subtitle: format!(
            "{} on {} · cycle time {} ({:.3} s) · path {:.1} mm · deviation at most {:.2} µm, {:.0} % of the tolerance",
            summary.method.as_deref().unwrap_or(""),
            summary.machine,
            clock(summary.cycle_time_s),
            summary.cycle_time_s,
            summary.path_length_mm,
            1e3 * summary.max_deviation_mm,
            100.0 * summary.max_deviation_share,
        ),
    }
}
