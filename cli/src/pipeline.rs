//! Plans, judges, samples and draws a program, a batch of lines at a time.
//!
//! What is held is a batch of moves, a batch of pieces, and the window of the planner, however long
//! the program is. The time that the planner takes is measured around batches, because a clock
//! read for every move would cost as much as planning it.

use crate::error::CliError;
use crate::input::travel::{OnAxes, Travel};
use crate::output::csv_writer::SetPoints;
use crate::output::page::Recording;
use crate::plot::Plot;
use std::io::BufRead;
use std::time::{Duration, Instant};
use toolglide_kinematics::{MotionPlanner, Move, Piece, WindowTally};
use toolglide_program::AxisMoves;
use toolglide_verify::{Judge, Report};

/// Moves that are read before any of them is planned.
const MOVES: usize = 512;

/// Pieces that are planned before any of them is judged.
const PIECES: usize = 512;

/// The moves of a program on the axes of a machine, checked.
pub(crate) struct Moves<R, const N: usize> {
    pub(crate) program: AxisMoves<R>,
    pub(crate) name: String,
    /// Letters of the axes.
    pub(crate) letters: [char; N],
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
        let on_axes =
            Move::<N>::on_axes(&next, &self.letters).map_err(|reason| CliError::Line {
                program: self.name.clone(),
                line: next.line(),
                reason,
            })?;
        self.travel.check(&on_axes, &self.name)?;
        Ok(Some(on_axes))
    }

    /// Fills a batch; `false` when the program is over.
    pub(crate) fn fill(&mut self, batch: &mut Vec<Move<N>>) -> Result<bool, CliError> {
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
    pub(crate) recording: Option<Recording<N>>,
}

/// What came out.
pub(crate) struct Outcome<R, const N: usize> {
    pub(crate) program: AxisMoves<R>,
    pub(crate) report: Report<N>,
    pub(crate) rows: u64,
    pub(crate) planning_time: Duration,
    pub(crate) windows: Option<WindowTally>,
    pub(crate) plot: Option<Plot<N>>,
    pub(crate) recording: Option<Recording<N>>,
}

impl<R: BufRead, const N: usize> Pipeline<'_, R, N>
where
    Move<N>: OnAxes,
{
    /// Runs the program to its end.
    pub(crate) fn run(mut self) -> Result<Outcome<R, N>, CliError> {
        let mut batch = Vec::with_capacity(MOVES);
        let mut lane = Lane::new(self.planner, self.judge);
        loop {
            let more = self.moves.fill(&mut batch)?;
            if let Some(plot) = &mut self.plot {
                for next in &batch {
                    plot.expect(next);
                }
            }
            if let Some(recording) = &mut self.recording {
                recording.expect(&batch);
            }
            lane.run(&batch, !more, &self.moves.name, |piece, deviation| {
                self.set_points.observe(piece)?;
                if let Some(plot) = &mut self.plot {
                    plot.observe(piece);
                }
                if let Some(recording) = &mut self.recording {
                    recording.observe(0, piece, deviation);
                }
                Ok(())
            })?;
            if !more {
                break;
            }
        }
        let windows = lane.windows();
        let (report, planning_time) = lane.finish();
        Ok(Outcome {
            program: self.moves.program,
            report,
            rows: self.set_points.finish()?,
            planning_time,
            windows,
            plot: self.plot,
            recording: self.recording,
        })
    }
}

/// A planner and the judge of its motion.
pub(crate) struct Lane<const N: usize> {
    planner: Box<dyn MotionPlanner<N>>,
    judge: Judge<N>,
    pieces: Vec<Piece<N>>,
    planning_time: Duration,
    /// Line of the last move that the planner was given.
    line: u32,
    /// Whether the planner knows that no move follows.
    finished: bool,
}

impl<const N: usize> Lane<N> {
    /// A planner that was given nothing yet.
    pub(crate) fn new(planner: Box<dyn MotionPlanner<N>>, judge: Judge<N>) -> Self {
        Self {
            planner,
            judge,
            pieces: Vec::with_capacity(PIECES),
            planning_time: Duration::ZERO,
            line: 0,
            finished: false,
        }
    }

    /// Plans and judges a batch of moves; after the `last` one the motion comes to rest.
    ///
    /// `program` is the name of the program in refusals; `take` sees every piece, with its largest distance from
    /// the path where the judge measures each.
    pub(crate) fn run(
        &mut self,
        batch: &[Move<N>],
        last: bool,
        program: &str,
        mut take: impl FnMut(&Piece<N>, f64) -> Result<(), CliError>,
    ) -> Result<(), CliError> {
        for next in batch {
            self.judge.expect(next).map_err(|reason| CliError::Line {
                program: program.to_owned(),
                line: next.line(),
                reason: reason.to_string(),
            })?;
        }
        let mut waiting = batch.iter();
        let mut open = true;
        while open {
            let begin = Instant::now();
            open = self.plan(&mut waiting, last, program)?;
            self.planning_time += begin.elapsed();
            for piece in self.pieces.drain(..) {
                self.judge.observe(&piece);
                let deviation = self.judge.last_deviation().map_or(0.0, |found| found[0]);
                take(&piece, deviation)?;
            }
        }
        Ok(())
    }

    /// How the windows of the planner came out, if it has any.
    pub(crate) fn windows(&self) -> Option<WindowTally> {
        self.planner.windows()
    }

    /// The verdict, and how long the planner took.
    pub(crate) fn finish(self) -> (Report<N>, Duration) {
        (self.judge.finish(), self.planning_time)
    }

    /// Plans until a batch of pieces is full, or the moves are used up; then it gives `false`.
    fn plan(
        &mut self,
        waiting: &mut std::slice::Iter<'_, Move<N>>,
        last: bool,
        program: &str,
    ) -> Result<bool, CliError> {
        while self.pieces.len() < PIECES {
            if let Some(piece) = self.planner.pull() {
                self.pieces.push(piece);
                continue;
            }
            let outcome = if let Some(next) = waiting.next() {
                self.line = next.line();
                self.planner.push(next)
            } else if last && !self.finished {
                self.finished = true;
                self.planner.finish()
            } else {
                return Ok(false);
            };
            outcome.map_err(|reason| CliError::Plan {
                program: program.to_owned(),
                line: self.line,
                reason,
            })?;
        }
        Ok(true)
    }
}
