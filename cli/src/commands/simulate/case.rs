//! Runs one case: plans or reads a motion, judges it, and passes it through the drives.
//!
//! Not here: how the figures are shown.

use super::report::{AxisRow, CaseRow, LeftByPlan, ModeRow};
use super::rows::Rows;
use super::set_points::SetPointMotion;
use crate::commands::plan::{moves, warn};
use crate::error::CliError;
use crate::input::args::{JobArgs, SimulateArgs};
use crate::input::drives::Drives;
use crate::input::setup::Setup;
use crate::input::source::Source;
use crate::input::travel::OnAxes;
use crate::methods::{Tuning, planner};
use crate::output::summary::worst_first;
use crate::pipeline::Lane;
use crate::plot::SimulationTrace;
use std::io::Write;
use toolglide_kinematics::{Mode, Move, Piece, Resonator};
use toolglide_simulation::{Instant, Outcome, SimulationError, SimulationSettings, Simulator};
use toolglide_verify::{Judge, Report};

/// What is simulated in one row.
pub(super) struct Case {
    /// What stands in the table.
    pub(super) label: String,
    pub(super) method: String,
    pub(super) job: JobArgs,
    pub(super) setup: Setup,
    pub(super) tuning: Tuning,
    pub(super) drives: Drives,
}

/// Everything that a motion passes through behind its planner.
pub(super) struct Bench<'a, const N: usize> {
    pub(super) simulator: Simulator<N>,
    left: LeftByPlan,
    resonators: Vec<(usize, Resonator)>,
    rows: Option<Rows<'a>>,
    pub(super) trace: Option<SimulationTrace>,
    /// The instant of the largest errors: what reverses there.
    reversing: [(f64, Option<char>); 2],
    failed: Option<CliError>,
}

impl<const N: usize> Bench<'_, N> {
    /// Passes a piece of the motion; a motion that nobody planned does not say which moves it serves.
    pub(super) fn pass(
        &mut self,
        piece: &Piece<N>,
        planned: bool,
        program: &str,
    ) -> Result<(), CliError> {
        let start = piece.at(0.0);
        for (axis, resonator) in &mut self.resonators {
            let (acceleration, jerk) = (start.acceleration[*axis], start.jerk[*axis]);
            resonator.pass(acceleration, jerk, piece.duration());
        }
        let mut see = seer(
            &mut self.rows,
            &mut self.trace,
            &mut self.reversing,
            &mut self.failed,
        );
        let passed = if planned {
            self.simulator.observe_with(piece, &mut see)
        } else {
            self.simulator.observe_unplanned(piece, &mut see)
        };
        drop(see);
        passed.map_err(|reason| refused(program, reason))?;
        self.failed.take().map_or(Ok(()), Err)
    }
}

/// Shows every instant to all that look.
fn seer<'s, const N: usize>(
    rows: &'s mut Option<Rows<'_>>,
    trace: &'s mut Option<SimulationTrace>,
    reversing: &'s mut [(f64, Option<char>); 2],
    failed: &'s mut Option<CliError>,
) -> impl FnMut(&Instant<N>) {
    move |instant| {
        if instant.moving {
            for (most, error) in reversing
                .iter_mut()
                .zip([instant.servo.norm(), instant.part.abs()])
            {
                if error > most.0 {
                    *most = (error, instant.reversing);
                }
            }
        }
        if let Some(trace) = trace {
            trace.take(instant);
        }
        if let Some(rows) = rows
            && failed.is_none()
        {
            *failed = rows.take(instant).err();
        }
    }
}

fn refused(program: &str, reason: SimulationError) -> CliError {
    CliError::Simulation {
        program: program.to_owned(),
        reason,
    }
}

/// Runs a case; the trace is for a plot.
pub(super) fn run_case<const N: usize>(
    args: &SimulateArgs,
    case: &Case,
    rows: Option<Rows<'_>>,
    traced: bool,
    err: &mut dyn Write,
) -> Result<(CaseRow, Option<SimulationTrace>), CliError>
where
    Move<N>: OnAxes,
{
    let setup = &case.setup;
    let source = Source::open(&case.job.program, case.job.dialect.as_deref())?;
    let name = source.name.clone();
    let start = setup.start::<N>();
    let period = match &args.set_points {
        Some(file) => set_point_period::<N>(file, setup)?,
        None => setup.period.seconds(),
    };
    let settings = SimulationSettings {
        period,
        interpolation: case.drives.interpolation,
        window: 1e-3 * args.window_um,
    };
    let simulator = Simulator::new(&case.drives.axes, start, settings)
        .map_err(|reason| refused(&setup.asked, reason))?;
    let mut bench = Bench {
        simulator,
        left: LeftByPlan::default(),
        resonators: resonators(case)?,
        rows,
        trace: traced.then(|| SimulationTrace::new(N)),
        reversing: [(0.0, None); 2],
        failed: None,
    };
    let mut moves = moves::<N>(&case.job, setup, source)?;
    let report = if let Some(file) = &args.set_points {
        let mut motion = SetPointMotion::<N>::open(file, setup)?;
        motion.pass(&mut moves, &mut bench, &name)?;
        None
    } else {
        let limits = setup.limits::<N>();
        let planner = planner(&case.method, start, limits, &case.tuning)?;
        let mut lane = Lane::new(planner, Judge::new(start, limits));
        let mut batch = Vec::new();
        loop {
            let more = moves.fill(&mut batch)?;
            for next in &batch {
                bench
                    .simulator
                    .expect(next)
                    .map_err(|reason| CliError::Line {
                        program: name.clone(),
                        line: next.line(),
                        reason: reason.to_string(),
                    })?;
            }
            lane.run(&batch, !more, &name, |piece, _| {
                bench.pass(piece, true, &name)
            })?;
            if !more {
                break;
            }
        }
        Some(lane.finish().0)
    };
    warn(moves.program.program(), err);
    bench.left = LeftByPlan {
        modes: bench
            .resonators
            .iter()
            .map(|(_, resonator)| resonator.displacement())
            .collect(),
    };
    let Bench {
        simulator,
        left,
        mut rows,
        mut trace,
        mut reversing,
        mut failed,
        ..
    } = bench;
    let outcome = {
        let mut see = seer(&mut rows, &mut trace, &mut reversing, &mut failed);
        simulator
            .finish_with(&mut see)
            .map_err(|reason| refused(&name, reason))?
    };
    if let Some(failed) = failed {
        return Err(failed);
    }
    if let Some(rows) = rows {
        rows.finish()?;
    }
    let row = row(case, &name, &outcome, report.as_ref(), &left, reversing);
    Ok((row, trace))
}

/// The period of the rows of a file.
fn set_point_period<const N: usize>(
    file: &std::path::Path,
    setup: &Setup,
) -> Result<f64, CliError> {
    SetPointMotion::<N>::open(file, setup).map(|motion| motion.period())
}

/// Oscillators under the plan alone, one for each mode that the machine file names, in the order of the axes.
fn resonators(case: &Case) -> Result<Vec<(usize, Resonator)>, CliError> {
    let mut found = Vec::new();
    for (index, axis) in case.drives.axes.iter().enumerate() {
        for mode in axis.model.modes() {
            let mode = Mode::new(mode.frequency, mode.damping)
                .map_err(CliError::mode(&case.setup.modes_asked))?;
            found.push((index, Resonator::new(&mode)));
        }
    }
    Ok(found)
}

fn row<const N: usize>(
    case: &Case,
    program: &str,
    outcome: &Outcome,
    report: Option<&Report<N>>,
    left: &LeftByPlan,
    reversing: [(f64, Option<char>); 2],
) -> CaseRow {
    let modes = outcome
        .modes
        .iter()
        .zip(&left.modes)
        .map(|(mode, &plan)| {
            let axis = case.drives.axes.iter().find(|axis| axis.name == mode.axis);
            let closed = axis.and_then(|axis| {
                let share = axis
                    .model
                    .modes()
                    .iter()
                    .find(|other| (other.frequency - mode.frequency).abs() < 1e-9)?
                    .mass_share;
                (share > 0.0).then(|| nearest(&axis.model.closed_loop_modes(), mode.frequency))?
            });
            ModeRow::of(mode, plan, closed)
        })
        .collect();
    CaseRow {
        label: case.label.clone(),
        program: program.to_owned(),
        cycle_time_s: outcome.cycle_time,
        settled_s: outcome.settling,
        servo: (&outcome.servo, reversing[0].1).into(),
        part: (&outcome.part, reversing[1].1).into(),
        axes: outcome.axes.iter().map(AxisRow::of).collect(),
        modes,
        violations: report.map_or(0, |report| report.violations),
        worst: report.map_or_else(Vec::new, |report| worst_first(&report.examples)),
    }
}

/// Of the oscillating poles of a closed loop, [Hz, damping ratio], the frequency nearest to another.
fn nearest(poles: &[[f64; 2]], frequency: f64) -> Option<f64> {
    poles.iter().map(|[pole, _]| *pole).min_by(|one, other| {
        (one - frequency)
            .abs()
            .total_cmp(&(other - frequency).abs())
    })
}
