//! Plans a program of the dissertation by a method, judges it, and remembers the result.

use crate::commands::reproduce::experiments::Course;
use crate::error::CliError;
use crate::input::travel::Travel;
use crate::methods::{Tuning, planner};
use crate::output::summary::worst_first;
use crate::pipeline::{Lane, Moves};
use toolglide_fir::FilterChain;
use toolglide_kinematics::{Limits, Tolerance, Vector};
use toolglide_program::{Program, Settings};
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
        let tuning = Tuning {
            filters_asked: course.name.to_owned(),
            filters: course.chain()?,
            ..Tuning::default()
        };
        let outcome = self.plan((course.text, course.name), limits, method, &tuning)?;
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
        let mut batch = Vec::new();
        let mut corner_speed = None;
        loop {
            let more = moves.fill(&mut batch)?;
            lane.run(&batch, !more, name, |piece, _| {
                // A piece that serves two moves turns the corner between them.
                if corner_speed.is_none() && piece.serves().first < piece.serves().last {
                    corner_speed = Some(piece.at(0.0).velocity.norm());
                }
                Ok(())
            })?;
            if !more {
                break;
            }
        }
        let (report, _) = lane.finish();
        let worst = worst_first(&report.examples);
        let complaints = worst
            .iter()
            .map(|wrong| format!("{name}: {method}: {wrong}"));
        self.complaints.extend(complaints);
        Ok(Outcome {
            cycle_time: report.cycle_time,
            corner_speed: corner_speed.unwrap_or(0.0),
            deviation: report.deviation.value,
        })
    }

    /// What was wrong with the plans, one line each; empty when nothing was.
    pub(super) fn complaints(&self) -> &[String] {
        &self.complaints
    }
}
