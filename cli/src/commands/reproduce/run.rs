//! Plans a program of the dissertation by a method, judges it, and remembers the result.

use crate::commands::reproduce::experiments::{Course, Drives};
use crate::commands::reproduce::quantity::Planned;
use crate::error::CliError;
use crate::input::travel::Travel;
use crate::methods::{Tuning, is_baseline, planner};
use crate::output::summary::worst_first;
use crate::pipeline::{Lane, Moves};
use toolglide_fir::FilterChain;
use toolglide_kinematics::{Limits, Tolerance, Vector};
use toolglide_program::{Program, Settings};
use toolglide_simulation::{
    DriveModel, DriveSettings, DrivenAxis, ErrorFigure, FlexibleMode, Interpolation, ModeOutcome,
    SimulationError, SimulationSettings, Simulator,
};
use toolglide_verify::Judge;

/// Largest velocity of every axis, mm/s: beyond what any of the programs asks for.
const VELOCITY: f64 = 500.0;

/// Tolerance before a program says its own, mm: every program does.
const TOLERANCE: f64 = 0.01;

/// What a plan came to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outcome {
    /// How long it takes, s.
    pub(super) cycle_time: f64,
    /// Speed at the beginning of the first corner, mm/s; 0 where every corner is a stop.
    pub(super) corner_speed: f64,
    /// Largest distance from the path, mm.
    pub(super) deviation: f64,
    /// Distance from the planned motion behind the drives, where there are any.
    pub(super) contour: Option<ErrorFigure>,
    /// What the beams did, where there are any.
    pub(super) beams: [Option<ModeOutcome>; 2],
}

impl Course {
    /// Its filters, where there are any.
    pub(super) fn chain(&self) -> Result<Option<FilterChain>, CliError> {
        if self.filters.is_empty() {
            return Ok(None);
        }
        FilterChain::with_time_constants(self.filters)
            .map(Some)
            .map_err(CliError::filters(self.name))
    }
}

/// Natural frequencies of the beams of section 4.5.2, Hz, and their damping ratio, which is not printed.
const BEAMS: [f64; 2] = [7.4, 9.2];
/// As above.
const BEAM_DAMPING: f64 = 0.003;

/// The drives of both axes.
fn drives_of(start: Vector<2>, drives: Drives) -> Result<Simulator<2>, SimulationError> {
    let mut axes = Vec::with_capacity(2);
    for (name, frequency) in ['X', 'Y'].into_iter().zip(BEAMS) {
        let mut settings = match drives {
            Drives::Reference { bandwidth, encoder } => {
                DriveSettings::reference(bandwidth, encoder)
            }
            Drives::Beams { bandwidth } => DriveSettings::textbook(bandwidth),
        };
        if matches!(drives, Drives::Beams { .. }) {
            settings.modes = vec![FlexibleMode {
                frequency,
                damping: BEAM_DAMPING,
                mass_share: 0.0,
                at_encoder: 0.0,
                at_tool: [0.0; 3],
            }];
        }
        axes.push(DrivenAxis {
            name,
            model: DriveModel::new(&settings)?,
            coordinate: None,
        });
    }
    let settings = SimulationSettings {
        period: axes[0].model.settings().servo_period,
        interpolation: Interpolation::Cubic,
        window: 0.002,
    };
    Simulator::new(&axes, start, settings)
}

/// The plans made so far, and what was wrong with them.
#[derive(Debug, Default)]
pub(super) struct Runs {
    done: Vec<(&'static Course, &'static str, Outcome)>,
    complaints: Vec<String>,
}

impl Runs {
    /// A program planned by a method, once.
    pub(super) fn of(
        &mut self,
        course: &'static Course,
        method: &'static str,
    ) -> Result<Outcome, CliError> {
        let found = self
            .done
            .iter()
            .find(|run| std::ptr::eq(run.0, course) && run.1 == method);
        if let Some(&(_, _, outcome)) = found {
            return Ok(outcome);
        }
        let limits = (course.acceleration, course.jerk);
        let drives = course.drives;
        let tuning = Tuning {
            filters_asked: course.name.to_owned(),
            filters: course.chain()?,
            ..Tuning::default()
        };
        let outcome = self.plan((course.text, course.name), limits, method, &tuning, drives)?;
        self.done.push((course, method, outcome));
        Ok(outcome)
    }

    /// A text planned by a method within an acceleration and a jerk of both axes.
    pub(super) fn plan(
        &mut self,
        (text, name): (&str, &str),
        (acceleration, jerk): (f64, f64),
        method: &str,
        tuning: &Tuning,
        drives: Option<Drives>,
    ) -> Result<Outcome, CliError> {
        let refuse = |reason: String| CliError::Line {
            program: name.to_owned(),
            line: 0,
            reason,
        };
        let limits = Limits::<2>::uniform(VELOCITY, acceleration, jerk)
            .map_err(|reason| refuse(reason.to_string()))?;
        let mut settings =
            Settings::new(Tolerance::new(TOLERANCE).map_err(|reason| refuse(reason.to_string()))?);
        settings.axes = [true, true, false];
        let mut moves = Moves::<_, 2> {
            program: Program::new(text.as_bytes(), name, settings)
                .on_all_axes([false; 6], [0.0; 6]),
            letters: ['X', 'Y'],
            name: name.to_owned(),
            travel: Travel::of(&[]),
        };
        let start = Vector::<2>::zeros();
        let mut lane = Lane::new(
            planner(method, start, limits, tuning)?,
            Judge::new(start, limits),
        );
        let mut simulator = match drives {
            Some(drives) => {
                Some(drives_of(start, drives).map_err(|reason| refuse(reason.to_string()))?)
            }
            None => None,
        };
        let mut batch = Vec::new();
        let mut corner_speed = None;
        loop {
            let more = moves.fill(&mut batch)?;
            lane.run(&batch, !more, name, |piece, _| {
                // A piece that serves two moves turns the corner between them.
                if corner_speed.is_none() && piece.serves().first < piece.serves().last {
                    corner_speed = Some(piece.at(0.0).velocity.norm());
                }
                if let Some(simulator) = &mut simulator {
                    let observed = simulator.observe(piece);
                    observed.map_err(|reason| refuse(reason.to_string()))?;
                }
                Ok(())
            })?;
            if !more {
                break;
            }
        }
        let contour = match simulator {
            Some(simulator) => {
                let finished = simulator.finish();
                Some(finished.map_err(|reason| refuse(reason.to_string()))?)
            }
            None => None,
        };
        let mode = |beam: usize| {
            contour
                .as_ref()
                .and_then(|found| found.modes.get(beam).copied())
        };
        let beams = [mode(0), mode(1)];
        let contour = contour.as_ref().map(|found| found.servo);
        let (report, _) = lane.finish();
        let worst = worst_first(&report.examples);
        // The baselines of the text break limits by what they are.
        let complaints = worst
            .iter()
            .filter(|_| !is_baseline(method))
            .map(|wrong| format!("{name}: {method}: {wrong}"));
        self.complaints.extend(complaints);
        Ok(Outcome {
            cycle_time: report.cycle_time,
            corner_speed: corner_speed.unwrap_or(0.0),
            deviation: report.deviation.value,
            contour,
            beams,
        })
    }

    /// What a beam did behind the drives of a program.
    pub(super) fn beam(&mut self, planned: Planned, beam: usize) -> Result<ModeOutcome, CliError> {
        let outcome = self.of(planned.course, planned.method)?;
        let found = outcome.beams.get(beam).copied().flatten();
        found.ok_or_else(|| CliError::Line {
            program: planned.course.name.to_owned(),
            line: 0,
            reason: "there are no beams".to_owned(),
        })
    }

    /// Distance from the planned motion behind the drives of a program.
    pub(super) fn contour(&mut self, planned: Planned) -> Result<ErrorFigure, CliError> {
        let outcome = self.of(planned.course, planned.method)?;
        outcome.contour.ok_or_else(|| CliError::Line {
            program: planned.course.name.to_owned(),
            line: 0,
            reason: "there are no drives".to_owned(),
        })
    }

    /// What was wrong with the plans, one line each; empty when nothing was.
    pub(super) fn complaints(&self) -> &[String] {
        &self.complaints
    }
}
