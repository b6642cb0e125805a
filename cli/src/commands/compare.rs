//! Plans a program by several methods at once and shows them side by side.
//!
//! The program is read once: every batch of moves goes to all methods in turn, so that standard
//! input can be compared too and nothing is ever held as a whole.

use crate::commands::plan::{moves, title, warn};
use crate::error::CliError;
use crate::input::args::CompareArgs;
use crate::input::setup::Setup;
use crate::input::source::Source;
use crate::input::travel::{OnAxes, by_axes};
use crate::methods::{EXACT_STOP, Tuning, chosen, planner};
use crate::output::comparison::{Comparison, MethodRow};
use crate::output::files::OutputFile;
use crate::output::output_files::Drawing;
use crate::output::page::{PageFile, Recording};
use crate::output::report::show;
use crate::pipeline::Lane;
use crate::plot::{Caption, Feeds};
use std::io::Write;
use toolglide_kinematics::Move;

/// Runs the command.
pub(crate) fn compare(
    args: &CompareArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let setup = Setup::new(&args.job, None)?;
    by_axes!(setup.axes.len(), run(args, &setup, out, err))
}

fn run<const N: usize>(
    args: &CompareArgs,
    setup: &Setup,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError>
where
    Move<N>: OnAxes,
{
    let drawing = Drawing::begin(args.plot.as_deref(), &args.job)?;
    let source = Source::open(&args.job.program, args.job.dialect.as_deref())?;
    let name = source.name.clone();
    let chosen = chosen(&args.methods);
    let tuning = Tuning::of(&args.tuning, setup)?;
    let (start, limits) = (setup.start::<N>(), setup.limits::<N>());
    let page = PageFile::begin(args.report.as_deref(), &args.job)?;
    let mut recording = page
        .is_some()
        .then(|| Recording::new(start, limits, chosen.len()));
    let measured = page.is_some();
    let judge = |method: &str| {
        let judge = tuning.judge(method, start, limits);
        if measured {
            judge.measuring_each()
        } else {
            judge
        }
    };
    let lane = |method: &str| {
        planner(method, start, limits, &tuning).map(|planner| Lane::new(planner, judge(method)))
    };
    let mut lanes = chosen
        .iter()
        .map(|method| lane(method))
        .collect::<Result<Vec<_>, _>>()?;
    let place_of_stop = chosen.iter().position(|method| method == EXACT_STOP);
    if place_of_stop.is_none() {
        // The measure of all others, even where it is not shown.
        lanes.push(lane(EXACT_STOP)?);
    }
    let mut feeds = drawing.is_some().then(|| Feeds::new(chosen.clone()));
    let mut moves = moves::<N>(&args.job, setup, source)?;
    let mut batch = Vec::new();
    loop {
        let more = moves.fill(&mut batch)?;
        if let Some(feeds) = &mut feeds {
            batch.iter().for_each(|next| feeds.expect(next));
        }
        if let Some(recording) = &mut recording {
            recording.expect(&batch);
        }
        for (index, lane) in lanes.iter_mut().enumerate() {
            lane.run(&batch, !more, &name, |piece, deviation| {
                if let Some(recording) = &mut recording {
                    recording.observe(index, piece, deviation);
                }
                if let Some(feeds) = &mut feeds {
                    feeds.observe(index, piece);
                }
                Ok(())
            })?;
        }
        if !more {
            break;
        }
    }
    let blocks = moves.program.program().blocks();
    let results: Vec<_> = lanes.into_iter().map(Lane::finish).collect();
    let stop = place_of_stop
        .map_or(results.last(), |place| results.get(place))
        .map_or(0.0, |(report, _)| report.cycle_time);
    let rows = chosen
        .iter()
        .zip(&results)
        .map(|(method, (report, time))| MethodRow::of(method, report, *time, blocks, stop, setup))
        .collect();
    warn(moves.program.program(), err);
    let comparison = Comparison::new(&name, setup, blocks, rows);
    if let (Some(mut drawing), Some(feeds)) = (drawing, feeds) {
        let caption = Caption {
            title: title(&name),
            subtitle: format!("feedrates of {} methods on {}", chosen.len(), setup.machine),
        };
        drawing.write(&feeds.draw(&caption))?;
        drawing.commit()?;
    }
    if let (Some(mut page), Some(recording)) = (page, recording) {
        let judged = chosen.iter().zip(&results);
        let judged = judged.map(|(method, (report, _))| (method.as_str(), report));
        page.write(&name, setup, recording, judged)?;
        OutputFile::commit([page.file])?;
    }
    show(&comparison, args.job.json, out, err)
}
