//! Plans a program of tool poses and writes set-points, summary and plot.
//!
//! Files are begun before anything is planned and named when everything is done.

use crate::commands::plan::title;
use crate::commands::poses::METHODS;
use crate::commands::poses::inputs::{Inputs, Legs, refused};
use crate::commands::poses::plot::PosePlot;
use crate::commands::poses::rows::Rows;
use crate::commands::poses::summary::PoseSummary;
use crate::error::CliError;
use crate::input::args::PlanArgs;
use crate::output::output_files::PlanFiles;
use crate::output::report::{show, show_beside_rows};
use crate::output::summary::clock;
use crate::plot::Caption;
use std::io::Write;
use std::time::{Duration, Instant};
use toolglide_fiveaxis::{
    FiveAxisError, PoseMethod, PosePlanner, PoseSampler, PoseSettings, PoseTick,
};
use toolglide_kinematics::{PoseFeed, PosePiece};
use toolglide_verify::PoseJudge;

/// The method by its name.
fn method(name: &str, way_points: u32) -> Result<PoseMethod, CliError> {
    Ok(match name {
        "ns-dcb" => PoseMethod::DwellControlled,
        "ns-vcb" => PoseMethod::VelocityControlled,
        "ns-jcb" => PoseMethod::JointSpace { way_points },
        "p2p" => PoseMethod::PointToPoint,
        other => {
            let names: Vec<_> = METHODS.iter().map(|method| method.name).collect();
            return Err(CliError::Option {
                option: "--method",
                value: format!("\"{other}\""),
                bound: format!("for tool poses there are {}", names.join(", ")),
            });
        }
    })
}

/// Runs the command.
pub(crate) fn plan(
    args: &PlanArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let name = args.method.as_deref().unwrap_or(METHODS[0].name);
    let method = method(name, args.poses.way_points)?;
    let inputs = Inputs::new(
        &args.job,
        args.poses.tip_tolerance,
        args.poses.orientation_tolerance,
        args.poses.turn_about.as_ref(),
        args.period,
    )?;
    let (chain, asked) = inputs.chain(&args.tuning)?;
    let time_constants = chain.time_constants().to_vec();
    let mut settings = PoseSettings::new(chain, method).map_err(|reason| CliError::Option {
        option: "--fir",
        value: format!("{} time constants", time_constants.len()),
        bound: reason.to_string(),
    })?;
    if !asked {
        settings = settings.choosing_filters(inputs.setup.period);
    }
    if let Some(rate) = args.poses.turn_rate {
        settings = settings.with_turn_rate(rate);
    }
    if let Some(report) = &args.report {
        return Err(CliError::Option {
            option: "--report",
            value: report.display().to_string(),
            bound: "pages are written for programs of straight axes, not of tool poses".to_owned(),
        });
    }
    let mut files = PlanFiles::begin(args)?;
    let legs = inputs.open(&args.job)?;
    let drawn = files.drawing.is_some();
    let destination = files.rows.destination(out);
    let rows = Rows::new(
        inputs.setup.period,
        &inputs.setup.axes,
        args.pose,
        destination,
    );
    let plot = drawn.then(|| {
        PosePlot::new(
            inputs.machine.as_ref(),
            &inputs.setup.axes,
            inputs.setup.period,
        )
    });
    let mut run = Run::new(&inputs, legs, settings, rows, plot)?;
    run.read()?;
    let done = run.finish(&inputs)?;
    let mut summary = done.summary;
    summary.method = Some(name.to_owned());
    summary.period_s = Some(inputs.setup.period.seconds());
    done.legs.warn(err);
    if let (Some(drawing), Some(plot)) = (&mut files.drawing, done.plot) {
        drawing.write(&plot.draw(&caption(&summary)))?;
    }
    if files.commit()? {
        return show_beside_rows(&summary, err);
    }
    show(&summary, args.job.json, out, err)
}

fn caption(summary: &PoseSummary) -> Caption {
    Caption {
        title: title(&summary.program),
        subtitle: format!(
            "{} on {} · cycle time {} ({:.3} s) · path {:.1} mm and {:.0}° · tool tip within {:.0} %, orientation within {:.0} % of the tolerance",
            summary.method.as_deref().unwrap_or(""),
            summary.machine,
            clock(summary.cycle_time_s),
            summary.cycle_time_s,
            summary.path_length_mm,
            summary.path_angle_deg,
            100.0
                * summary
                    .tip_deviation_share
                    .max(summary.tip_corner_error_share),
            100.0
                * summary
                    .orientation_deviation_share
                    .max(summary.orientation_corner_error_share),
        ),
    }
}

/// Everything that a motion passes through.
struct Run<'a> {
    legs: Legs<'a>,
    planner: PosePlanner<'a>,
    judge: PoseJudge<'a>,
    sampler: PoseSampler<'a>,
    rows: Rows<'a>,
    plot: Option<PosePlot<'a>>,
    planning_time: Duration,
    /// Feed moves that turn the tool alone, and how far, rad.
    turning: (u32, f64),
    /// Lines of the legs, to say where a refusal is.
    lines: Vec<u32>,
}

/// What came out.
struct Finished<'a> {
    legs: Legs<'a>,
    summary: PoseSummary,
    plot: Option<PosePlot<'a>>,
}

impl<'a> Run<'a> {
    fn new(
        inputs: &'a Inputs,
        legs: Legs<'a>,
        settings: PoseSettings,
        rows: Rows<'a>,
        plot: Option<PosePlot<'a>>,
    ) -> Result<Self, CliError> {
        let machine = inputs.machine.as_ref();
        let axes = &inputs.setup.axes;
        let start = legs.start;
        let planner = PosePlanner::new(machine, axes.clone(), start, settings)
            .map_err(|reason| refused(&legs.name, 0, reason))?;
        Ok(Self {
            planner,
            judge: PoseJudge::new(machine, axes.clone(), &start),
            sampler: PoseSampler::new(machine, inputs.setup.period, start),
            legs,
            rows,
            plot,
            planning_time: Duration::ZERO,
            turning: (0, 0.0),
            lines: Vec::new(),
        })
    }

    fn read(&mut self) -> Result<(), CliError> {
        while let Some(leg) = self.legs.next()? {
            self.judge.expect(&leg);
            if let Some(turned) = leg.turns_alone().filter(|_| leg.feed != PoseFeed::Rapid) {
                self.turning = (self.turning.0 + 1, self.turning.1 + turned);
            }
            if let Some(plot) = &mut self.plot {
                plot.expect(&leg);
            }
            self.lines.push(leg.line);
            self.timed(|planner| planner.push(leg))?;
            self.hand_on()?;
        }
        self.timed(PosePlanner::finish)?;
        self.hand_on()
    }

    fn timed(
        &mut self,
        work: impl FnOnce(&mut PosePlanner<'a>) -> Result<(), FiveAxisError>,
    ) -> Result<(), CliError> {
        let begin = Instant::now();
        let done = work(&mut self.planner);
        self.planning_time += begin.elapsed();
        done.map_err(|reason| {
            let line = reason
                .index()
                .and_then(|index| self.lines.get(usize::try_from(index).ok()?).copied());
            refused(&self.legs.name, line.unwrap_or(0), reason)
        })
    }

    fn hand_on(&mut self) -> Result<(), CliError> {
        while let Some(piece) = self.planner.pull() {
            self.take(piece)?;
        }
        Ok(())
    }

    fn take(&mut self, piece: PosePiece) -> Result<(), CliError> {
        self.judge.observe(&piece);
        if let Some(plot) = &mut self.plot {
            plot.observe(&piece);
        }
        self.sampler.feed(piece);
        while let Some(tick) = self.sampler.next_tick() {
            let tick = tick.map_err(|reason| self.unreachable(reason))?;
            self.rows.tick(&tick)?;
            if let Some(plot) = &mut self.plot {
                plot.tick(&tick);
            }
        }
        Ok(())
    }

    fn unreachable(&self, reason: toolglide_kinematics::KinematicsError) -> CliError {
        let index = 0;
        refused(&self.legs.name, 0, FiveAxisError::Machine { index, reason })
    }

    fn finish(mut self, inputs: &Inputs) -> Result<Finished<'a>, CliError> {
        let last = match self.sampler.last() {
            Some(last) => last.map_err(|reason| self.unreachable(reason))?,
            None => {
                let pose = inputs
                    .machine
                    .forward(&self.legs.start)
                    .map_err(|reason| self.unreachable(reason))?;
                PoseTick {
                    time: 0.0,
                    axes: self.legs.start,
                    pose,
                }
            }
        };
        if let Some(plot) = &mut self.plot {
            plot.tick(&last);
        }
        let rows = self.rows.finish(&last)?;
        let report = self.judge.finish();
        let blocks = self.legs.program.blocks();
        let mut summary = PoseSummary::of(&self.legs.name, &inputs.setup, &report, blocks, rows);
        summary.slowed(self.planner.slowdowns());
        summary.fir_s = self
            .planner
            .usual_filters()
            .map_or_else(Vec::new, |pair| pair.to_vec());
        summary.turning_moves = self.turning.0;
        summary.turning_deg = self.turning.1.to_degrees();
        summary.fir_varies = !self.planner.has_one_chain();
        summary.planning_time_s = Some(self.planning_time.as_secs_f64());
        Ok(Finished {
            legs: self.legs,
            summary,
            plot: self.plot,
        })
    }
}
