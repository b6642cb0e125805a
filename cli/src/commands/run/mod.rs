//! Executes a part program under the commands of a simulated operator and judges what was executed.
//!
//! Time is counted in ticks, so that every run of the same program and events writes the same bytes.

mod events;
mod report;
mod responses;
mod rows;
mod simulation;

use crate::commands::plan::{moves, title, warn};
use crate::error::CliError;
use crate::input::args::RunArgs;
use crate::input::setup::Setup;
use crate::input::source::Source;
use crate::input::travel::{OnAxes, by_axes};
use crate::methods::{METHODS, Tuning, planner};
use crate::output::output_files::PlanFiles;
use crate::output::report::{show, show_beside_rows};
use crate::output::summary::Summary;
use crate::pipeline::Lane;
use crate::plot::{Caption, ExecutedPlot};
use report::{Executed, RunReport};
use rows::Rows;
use simulation::Simulation;
use std::io::Write;
use toolglide_kinematics::{Move, Reserve};
use toolglide_realtime::{Executor, OverrideKind, Settings};
use toolglide_verify::{EXECUTED_SLACK, ExecutedJudge, Judge};

/// Largest distance from the planned path, mm.
const OFF_PATH: f64 = 1e-9;

/// Runs the command.
pub(crate) fn run(
    args: &RunArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let setup = Setup::new(&args.job, args.period)?;
    by_axes!(setup.axes.len(), execute(args, &setup, out, err))
}

fn execute<const N: usize>(
    args: &RunArgs,
    setup: &Setup,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError>
where
    Move<N>: OnAxes,
{
    let events = events::events(args.events.as_deref())?;
    let method = args.method.as_deref().unwrap_or(METHODS[0].name);
    let mut files = PlanFiles::begin_for(
        args.output.as_deref(),
        args.plot.as_deref(),
        None,
        &args.job,
    )?;
    let source = Source::open(&args.job.program, args.job.dialect.as_deref())?;
    let name = source.name.clone();
    let (start, limits) = (setup.start::<N>(), setup.limits::<N>());
    let mut tuning = Tuning::of(&args.tuning, setup)?;
    let reserve = *tuning.reserve.get_or_insert(Reserve::default());
    let kind = if args.uniform {
        OverrideKind::Uniform
    } else {
        OverrideKind::Capped
    };
    let settings = Settings::new(limits, setup.period)
        .with_reserve(reserve)
        .with_greatest_override(args.max_override, kind)
        .map_err(|reason| CliError::Option {
            option: "--max-override",
            value: args.max_override.to_string(),
            bound: reason.to_string(),
        })?;
    let drawn = files.drawing.is_some();
    let destination = files.rows.destination(out);
    let outcome = Simulation::new(
        moves(&args.job, setup, source)?,
        Lane::new(
            planner(method, start, limits, &tuning)?,
            Judge::new(start, limits),
        ),
        Executor::new(start, &settings),
        ExecutedJudge::new(limits),
        Rows::new(setup.period, &setup.axes, args.rate, destination),
        drawn.then(|| ExecutedPlot::new(limits, setup.letters())),
        events,
        args.max_override,
        setup.period.seconds(),
    )
    .run()?;
    let blocks = outcome.program.program().blocks();
    let mut summary = Summary::of(&name, setup, &outcome.report, blocks, outcome.rows);
    summary.method = Some(method.to_owned());
    summary.period_s = Some(setup.period.seconds());
    summary.planning_time_s = Some(outcome.planning_time.as_secs_f64());
    if outcome.cut_short {
        // A motion that was aborted has not been judged to its end.
        summary.violations = 0;
        summary.worst.clear();
    }
    warn(outcome.program.program(), err);
    let [velocity, acceleration, jerk] = outcome.peaks;
    let mut faults = Vec::new();
    for (quantity, share) in [
        ("velocity", velocity),
        ("acceleration", acceleration),
        ("jerk", jerk),
    ] {
        if share > 1.0 + EXECUTED_SLACK {
            faults.push(format!("executed {quantity} is {share:.9} of the limit"));
        }
    }
    if outcome.off_path > OFF_PATH {
        faults.push(format!(
            "set-points are up to {:e} mm off the planned path",
            outcome.off_path
        ));
    }
    if outcome.infeasible > 0 {
        faults.push(format!(
            "{} steps had no rate that keeps the limits",
            outcome.infeasible
        ));
    }
    for late in outcome.responses.iter().filter(|response| response.late) {
        faults.push(format!(
            "{} at {:.3} s was over too late",
            late.command, late.time_s
        ));
    }
    let report = RunReport {
        plan: summary,
        executed: Executed {
            reserve: reserve.share(),
            max_override: args.max_override,
            duration_s: outcome.duration,
            rows: outcome.rows,
            first_piece_after_moves: outcome.first_piece,
            motion_after_moves: outcome.first_motion,
            needs_in_hand_s: outcome.needs,
            stops_within_s: outcome
                .stops_within
                .is_finite()
                .then_some(outcome.stops_within),
            velocity_share: velocity,
            acceleration_share: acceleration,
            jerk_share: jerk,
            off_path_mm: outcome.off_path,
            steps_without_a_rate: outcome.infeasible,
            end: outcome.end.iter().copied().collect(),
            end_line: outcome.end_line,
            state: rows::name(outcome.state),
            faults,
        },
        commands: outcome.responses,
    };
    if let (Some(drawing), Some(plot)) = (&mut files.drawing, outcome.plot) {
        drawing.write(&plot.draw(&caption(&report)))?;
    }
    if files.commit()? {
        return show_beside_rows(&report, err);
    }
    show(&report, args.job.json, out, err)
}

fn caption(report: &RunReport) -> Caption {
    Caption {
        title: title(&report.plan.program),
        subtitle: format!(
            "{} on {} · executed in {:.3} s · {} commands · jerk at most {:.2} % of the limit",
            report.plan.method.as_deref().unwrap_or(""),
            report.plan.machine,
            report.executed.duration_s,
            report.commands.len(),
            100.0 * report.executed.jerk_share,
        ),
    }
}
