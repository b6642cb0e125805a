//! Turns set-points that others made into a motion of constant jerk between rows.
//!
//! Source: cubics whose tangents are central differences, as drives refine set-points. Rows must be one period apart: a gap is
//! no motion that drives could follow. Not here: judging them.

use super::case::Bench;
use crate::error::CliError;
use crate::input::csv_reader::Table;
use crate::input::setup::Setup;
use crate::input::source::open_file;
use crate::input::travel::OnAxes;
use crate::pipeline::Moves;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;
use toolglide_kinematics::{Move, MoveRange, Piece, Sample, Vector};

/// Rows farther apart than this share of the period is a gap.
const GAP: f64 = 1e-3;

/// Moves that are known ahead of the motion.
const MOVES_AHEAD: u32 = 4096;

/// Rows of a file as a motion.
pub(super) struct SetPointMotion<const N: usize> {
    table: Table<BufReader<File>, N>,
    period: f64,
    /// Rows that are not passed yet, at most four.
    rows: Vec<(f64, Vector<N>)>,
    over: bool,
}

impl<const N: usize> SetPointMotion<N> {
    /// Opens a file and reads the first rows.
    pub(super) fn open(file: &Path, setup: &Setup) -> Result<Self, CliError> {
        let (opened, _) = open_file(file)?;
        let reader = BufReader::with_capacity(1 << 16, opened);
        let mut motion = Self {
            table: Table::open(file, reader, &setup.axes)?,
            period: 0.0,
            rows: Vec::with_capacity(4),
            over: false,
        };
        motion.fill(2)?;
        let [first, second] = motion.rows[..] else {
            return Err(motion.table.refuse("a motion needs two rows"));
        };
        let period = second.0 - first.0;
        // Times are written with as many digits as they need, so that their difference has rounding.
        motion.period = (period * 1e9).round() / 1e9;
        if motion.period <= 0.0 {
            return Err(motion.table.refuse(format!(
                "rows are {period} s apart, but must be a nanosecond"
            )));
        }
        Ok(motion)
    }

    /// Time between two rows, s.
    pub(super) fn period(&self) -> f64 {
        self.period
    }

    /// Reads until so many rows wait.
    fn fill(&mut self, count: usize) -> Result<(), CliError> {
        while self.rows.len() < count && !self.over {
            let Some((time, position)) = self.table.row()? else {
                self.over = true;
                break;
            };
            if self.period > 0.0
                && let Some((before, _)) = self.rows.last()
            {
                let step = time - before;
                // The last row may come early: a motion ends between two set-points.
                if step > self.period * (1.0 + GAP) {
                    return Err(self.table.refuse(format!(
                        "the row is {step:.6} s after the one before, but set-points are {} s apart: a gap cannot be simulated",
                        self.period
                    )));
                }
            }
            self.rows.push((time, position));
        }
        Ok(())
    }

    /// Passes all rows, with the program read alongside.
    pub(super) fn pass<R: BufRead>(
        &mut self,
        moves: &mut Moves<R, N>,
        bench: &mut Bench<'_, N>,
        name: &str,
    ) -> Result<(), CliError>
    where
        Move<N>: OnAxes,
    {
        let mut known = 0_u32;
        let mut ended = false;
        let mut before: Option<(f64, Vector<N>)> = None;
        loop {
            while !ended && known < bench.simulator.on().saturating_add(MOVES_AHEAD) {
                let Some(next) = moves.next()? else {
                    ended = true;
                    break;
                };
                bench
                    .simulator
                    .expect(&next)
                    .map_err(|reason| CliError::Line {
                        program: name.to_owned(),
                        line: next.line(),
                        reason: reason.to_string(),
                    })?;
                known += 1;
            }
            self.fill(3)?;
            let (Some(&start), Some(&end)) = (self.rows.first(), self.rows.get(1)) else {
                break;
            };
            let after = self.rows.get(2).copied();
            bench.pass(&cubic(before, start, end, after), false, name)?;
            before = Some(start);
            self.rows.remove(0);
        }
        // The rest of the program counts, too.
        while moves.next()?.is_some() {}
        Ok(())
    }
}

/// The cubic from one row to the next, at rest before the first and behind the last.
fn cubic<const N: usize>(
    before: Option<(f64, Vector<N>)>,
    start: (f64, Vector<N>),
    end: (f64, Vector<N>),
    after: Option<(f64, Vector<N>)>,
) -> Piece<N> {
    let time = end.0 - start.0;
    let slope = |from: (f64, Vector<N>), to: (f64, Vector<N>)| (to.1 - from.1) / (to.0 - from.0);
    let first = before.map_or_else(Vector::zeros, |before| slope(before, end));
    let last = after.map_or_else(Vector::zeros, |after| slope(start, after));
    let span = end.1 - start.1;
    let state = Sample {
        position: start.1,
        velocity: first,
        acceleration: (span * 6.0 - (first * 4.0 + last * 2.0) * time) / (time * time),
        jerk: ((first + last) * 6.0 * time - span * 12.0) / (time * time * time),
    };
    Piece::new(&state, time, end.1, MoveRange::one(0))
}
