//! From the lines of a program to judged, sampled and drawn motion, a batch at a time.
//!
//! What is held is a batch of moves, a batch of pieces, and the window of the planner, however long
//! the program is. The time that the planner takes is measured around batches, because a clock
//! read for every move would cost as much as planning it.

use crate::error::CliError;
use crate::interrupt::check_interrupt;
use crate::plot::Plot;
use crate::set_points::SetPoints;
use crate::travel::{OnAxes, Travel};
use std::io::BufRead;
use std::time::{Duration, Instant};
use toolglide_kinematics::verify::{Judge, Report};
use toolglide_kinematics::{MotionPlanner, Move, Piece};
use toolglide_program::Program;

/// Moves that are read before any of them is planned.
const MOVES: usize = 512;

/// Pieces that are planned before any of them is judged.
const PIECES: usize = 4096;

/// The moves of a program on the axes of a machine, checked.
pub(crate) struct Moves<R, const N: usize> {
    pub(crate) program: Program<R>,
    pub(crate) name: String,
    pub(crate) travel: Travel<N>,
}

impl<R: BufRead, const N: usize> Moves<R, N>
where
    Move<N>: OnAxes,
{
    /// The next move; `None` at the end of the program.
    pub(crate) fn next(&mut self) -> Result<Option<Move<N>>, CliError> {
        let Some(next) = self.program.next() else {
            return Ok(None);
        };
        let next = next.map_err(|refused| CliError::Program(Box::new(refused)))?;
        let on_axes = Move::<N>::on_axes(&next).ok_or_else(|| CliError::Line {
            program: self.name.clone(),
            line: next.line(),
            reason: "the move needs an axis that the machine has not".to_owned(),
        })?;
        self.travel.check(&on_axes, &self.name)?;
        Ok(Some(on_axes))
    }

    /// Fills a batch; `false` when the program is over.
    pub(crate) fn fill(&mut self, batch: &mut Vec<Move<N>>) -> Result<bool, CliError> {
        check_interrupt()?;
        batch.clear();
        while batch.len() < MOVES {
            match self.next()? {
                Some(next) => batch.push(next),
                None => return Ok(false),
            }
        }
        Ok(true)
    }
}

/// Everything that a motion passes through.
pub(crate) struct Pipeline<'a, R, const N: usize> {
    pub(crate) moves: Moves<R, N>,
    pub(crate) planner: Box<dyn MotionPlanner<N>>,
    pub(crate) judge: Judge<N>,
    pub(crate) set_points: SetPoints<'a, N>,
    pub(crate) plot: Option<Plot<N>>,
}

/// What came out.
pub(crate) struct Outcome<R, const N: usize> {
    pub(crate) program: Program<R>,
    pub(crate) report: Report<N>,
    pub(crate) rows: u64,
    pub(crate) planning_time: Duration,
    pub(crate) plot: Option<Plot<N>>,
}

impl<R: BufRead, const N: usize> Pipeline<'_, R, N>
where
    Move<N>: OnAxes,
{
    /// Runs the program to its end.
    pub(crate) fn run(mut self) -> Result<Outcome<R, N>, CliError> {
        let mut batch = Vec::with_capacity(MOVES);
        let mut pieces = Vec::with_capacity(PIECES);
        let mut planning_time = Duration::ZERO;
        let mut progress = Progress::default();
        loop {
            let more = self.moves.fill(&mut batch)?;
            for next in &batch {
                self.judge.expect(next).map_err(|reason| CliError::Line {
                    program: self.moves.name.clone(),
                    line: next.line(),
                    reason: reason.to_string(),
                })?;
                if let Some(plot) = &mut self.plot {
                    plot.expect(next);
                }
            }
            let mut waiting = batch.iter();
            let mut open = true;
            while open {
                let begin = Instant::now();
                open = self.plan(&mut waiting, &mut progress, !more, &mut pieces)?;
                planning_time += begin.elapsed();
                for piece in pieces.drain(..) {
                    self.judge.observe(&piece);
                    self.set_points.observe(&piece)?;
                    if let Some(plot) = &mut self.plot {
                        plot.observe(&piece);
                    }
                }
                check_interrupt()?;
            }
            if !more {
                break;
            }
        }
        Ok(Outcome {
            program: self.moves.program,
            report: self.judge.finish(),
            rows: self.set_points.finish()?,
            planning_time,
            plot: self.plot,
        })
    }

    /// Plans until a batch of pieces is full, or the moves are used up; then it gives `false`.
    fn plan(
        &mut self,
        waiting: &mut std::slice::Iter<'_, Move<N>>,
        progress: &mut Progress,
        last: bool,
        pieces: &mut Vec<Piece<N>>,
    ) -> Result<bool, CliError> {
        while pieces.len() < PIECES {
            if let Some(piece) = self.planner.pull() {
                pieces.push(piece);
                continue;
            }
            let outcome = if let Some(next) = waiting.next() {
                progress.line = next.line();
                self.planner.push(next)
            } else if last && !progress.finished {
                progress.finished = true;
                self.planner.finish()
            } else {
                return Ok(false);
            };
            outcome.map_err(|reason| CliError::Plan {
                program: self.moves.name.clone(),
                line: progress.line,
                reason,
            })?;
        }
        Ok(true)
    }
}

/// How far a planner was told to go.
#[derive(Clone, Copy, Debug, Default)]
struct Progress {
    /// Line of the last move that it was given.
    line: u32,
    /// Whether it knows that no move follows.
    finished: bool,
}
