//! Plans a program: set-points, summary, plot.
//!
//! Files are begun before anything is planned, so that what cannot be written is refused at once,
//! and named when everything is done.

use crate::args::{JobArgs, PlanArgs};
use crate::error::{CliError, DONE, OUTSIDE};
use crate::output::{OutputFile, same_file};
use crate::pipeline::{Moves, Outcome, Pipeline};
use crate::planner::{METHODS, Tuning, planner};
use crate::plot::{Caption, Picture, Plot};
use crate::set_points::{Destination, SetPoints};
use crate::setup::Setup;
use crate::source::{Source, subroutines};
use crate::summary::{Summary, clock};
use crate::travel::{OnAxes, Travel};
use std::io::{BufRead, Write};
use std::path::Path;
use toolglide_kinematics::Move;
use toolglide_kinematics::verify::Judge;
use toolglide_program::{Program, Settings};

/// Runs the command.
pub(crate) fn plan(
    args: &PlanArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    if crate::poses::concerns(&args.job)? {
        return crate::poses::plan(args, out, err);
    }
    let setup = Setup::new(&args.job, args.period)?;
    match setup.axes.len() {
        2 => Job::<2>::run(args, &setup, out, err),
        _ => Job::<3>::run(args, &setup, out, err),
    }
}

/// The moves of a program for the machine of a run.
pub(crate) fn moves<const N: usize>(
    job: &JobArgs,
    setup: &Setup,
    source: Source,
) -> Moves<impl BufRead + use<N>, N> {
    let settings = Settings {
        tolerance: setup.tolerance,
        override_tolerance: setup.override_tolerance,
        start: setup.start_point(),
        axes: setup.has_axes(),
        lenient: job.lenient,
        ..Settings::new(setup.tolerance)
    };
    Moves {
        program: Program::new(source.reader, &source.name, settings)
            .with_tools(setup.tools.clone())
            .with_subroutines(subroutines(&job.program)),
        name: source.name,
        travel: Travel::of(&setup.axes),
    }
}

/// Tells what the reader of the program wants known.
pub(crate) fn warn<R: BufRead>(program: &Program<R>, err: &mut dyn Write) {
    for warning in program.warnings() {
        let _ = writeln!(err, "{warning}");
    }
    if program.more_warnings() > 0 {
        let _ = writeln!(err, "and {} more warnings", program.more_warnings());
    }
}

/// Prints what came out: JSON or text, and what is wrong with it.
pub(crate) fn report(
    summary: &Summary,
    json: bool,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let text = if json {
        summary.json()?
    } else {
        summary.text()
    };
    out.write_all(text.as_bytes())
        .map_err(|reason| CliError::write("standard output", reason))?;
    let _ = err.write_all(summary.complaint().as_bytes());
    Ok(if summary.violations == 0 {
        DONE
    } else {
        OUTSIDE
    })
}

struct Job<const N: usize>;

impl<const N: usize> Job<N>
where
    Move<N>: OnAxes,
{
    fn run(
        args: &PlanArgs,
        setup: &Setup,
        out: &mut dyn Write,
        err: &mut dyn Write,
    ) -> Result<u8, CliError> {
        let to_stdout = args.output.as_deref() == Some(Path::new("-"));
        if to_stdout && args.job.json {
            return Err(CliError::Option {
                option: "--json",
                value: "with -o -".to_owned(),
                bound: "only one of them can have standard output".to_owned(),
            });
        }
        let method = args.method.as_deref().unwrap_or(METHODS[0].name);
        let picture = args.plot.as_deref().map(Picture::of).transpose()?;
        let source = Source::open(&args.job.program)?;
        let name = source.name.clone();
        let (mut file, drawing) = begin(args, to_stdout)?;
        let start = setup.start::<N>();
        let limits = setup.limits::<N>();
        let tuning = Tuning::of(&args.tuning, setup)?;
        let destination = match &mut file {
            Some(file) => {
                let name = file.path().to_owned();
                Some(Destination { sink: file, name })
            }
            None if to_stdout => Some(Destination {
                sink: &mut *out,
                name: "standard output".into(),
            }),
            None => None,
        };
        let outcome = Pipeline {
            moves: moves(&args.job, setup, source),
            planner: planner(method, start, limits, &tuning)?,
            judge: Judge::new(start, limits),
            set_points: SetPoints::new(setup.period, &setup.axes, start, destination),
            plot: drawing
                .is_some()
                .then(|| Plot::new(start, limits, setup.letters())),
        }
        .run()?;
        let blocks = outcome.program.blocks();
        let mut summary = Summary::of(&name, setup, &outcome.report, blocks, outcome.rows);
        summary.method = Some(method.to_owned());
        summary.period_s = Some(setup.period.seconds());
        summary.planning_time_s = Some(outcome.planning_time.as_secs_f64());
        summary.windows = outcome.windows.map(Into::into);
        warn(&outcome.program, err);
        let drawing = drawing
            .zip(picture)
            .map(|(file, picture)| draw(file, picture, outcome, &summary))
            .transpose()?;
        for file in file.into_iter().chain(drawing) {
            file.commit()?;
        }
        if to_stdout {
            // The rows have standard output to themselves.
            let mut text = Vec::new();
            let code = report(&summary, false, &mut text, err)?;
            let _ = err.write_all(&text);
            return Ok(code);
        }
        report(&summary, args.job.json, out, err)
    }
}

/// Begins the files of the run, none of which may be another of them.
pub(crate) fn begin(
    args: &PlanArgs,
    to_stdout: bool,
) -> Result<(Option<OutputFile>, Option<OutputFile>), CliError> {
    let inputs = [args.job.program.as_path(), Path::new(&args.job.machine)];
    let rows = args.output.as_deref().filter(|_| !to_stdout);
    if let (Some(rows), Some(plot)) = (rows, args.plot.as_deref())
        && same_file(rows, plot)
    {
        return Err(CliError::Option {
            option: "--plot",
            value: plot.display().to_string(),
            bound: "the set-points are written there".to_owned(),
        });
    }
    let begin = |path: &Path| OutputFile::begin(path, &inputs);
    Ok((
        rows.map(begin).transpose()?,
        args.plot.as_deref().map(begin).transpose()?,
    ))
}

/// A program on a picture: its name without its folder.
pub(crate) fn title(program: &str) -> String {
    Path::new(program).file_name().map_or_else(
        || program.to_owned(),
        |name| name.to_string_lossy().into_owned(),
    )
}

fn draw<R, const N: usize>(
    mut file: OutputFile,
    picture: Picture,
    outcome: Outcome<R, N>,
    summary: &Summary,
) -> Result<OutputFile, CliError> {
    let caption = Caption {
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
    };
    if let Some(plot) = outcome.plot {
        let svg = plot.draw(&caption);
        picture.write(&svg, &mut file)?;
    }
    Ok(file)
}
