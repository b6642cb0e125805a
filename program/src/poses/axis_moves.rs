//! Moves of a program on all axes of a machine whose axes no tool pose ties to each other.
//!
//! Source: the rule of RS274/NGC and LinuxCNC for the feedrate: it is that of X, Y and Z where one of them
//! moves, else that of U, V and W, else the rate at which A, B and C turn, in degrees a minute. A degree
//! counts as a millimetre of the path. Not here: reading the words, and machines with a tool pose.

use crate::block::codes::{FeedMode, Motion};
use crate::error::ProgramError;
use crate::program::Program;
use std::f64::consts::TAU;
use std::io::BufRead;
use toolglide_kinematics::{Arc, Feedrate, Move, Path, ToolpathError, Vector};

/// Letters of the axes beside X, Y and Z: rotary ones, degrees, and secondary ones, mm.
pub const AXES_BESIDE: [char; 6] = ['A', 'B', 'C', 'U', 'V', 'W'];

/// A move of X, Y and Z, and of the axes beside them meanwhile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisMove {
    step: Move<3>,
    start: Vector<3>,
    from: [f64; 6],
    to: [f64; 6],
    /// How long it takes at its feedrate, s; none for a rapid.
    duration: Option<f64>,
}

impl AxisMove {
    /// The move of X, Y and Z alone.
    #[must_use]
    pub fn step(&self) -> &Move<3> {
        &self.step
    }

    /// Line of the program, counted from 1.
    #[must_use]
    pub fn line(&self) -> u32 {
        self.step.line()
    }

    /// The move on the axes with these letters, mm and degrees, in this order. Its feedrate is along the
    /// path of all axes, so that the move lasts as long as the program says.
    ///
    /// # Errors
    /// What [`Move::line_to`] and [`Arc::about`] refuse, [`ToolpathError::TooLarge`] for a feedrate along
    /// all axes that no number holds, [`ToolpathError::ArcPlane`] for an arc of axes that are not there.
    pub fn on_axes<const N: usize>(&self, letters: &[char; N]) -> Result<Move<N>, ToolpathError> {
        let place = |straight: Vector<3>, beside: &[f64; 6]| {
            Vector::<N>::from_fn(|axis, _| {
                let letter = letters[axis];
                let of = |all: &[char]| all.iter().position(|other| *other == letter);
                match (of(&['X', 'Y', 'Z']), of(&AXES_BESIDE)) {
                    (Some(index), _) => straight[index],
                    (None, Some(index)) => beside[index],
                    (None, None) => 0.0,
                }
            })
        };
        let start = place(self.start, &self.from);
        let end = place(self.step.end(self.start), &self.to);
        let tolerance = self.step.tolerance();
        let speed = |length: f64| match self.duration {
            Some(duration) if length > 0.0 && duration > 0.0 => Feedrate::new(length / duration),
            _ => Ok(self.step.feedrate()),
        };
        let mut same = match self.step.path() {
            Path::Dwell { duration } => Move::dwell(*duration, tolerance)?,
            Path::Arc(arc) => {
                let arc = spread(arc, start, end, letters)?;
                Move::arc(arc, speed(arc.length())?, tolerance)
            }
            _ => Move::line_to(end, speed((end - start).norm())?, tolerance)?,
        };
        if self.step.stops() {
            same = same.with_exact_stop();
        }
        Ok(same.from_line(self.step.line()))
    }
}

/// The same arc while other axes move.
fn spread<const N: usize>(
    arc: &Arc<3>,
    start: Vector<N>,
    end: Vector<N>,
    letters: &[char; N],
) -> Result<Arc<N>, ToolpathError> {
    let (radial, lateral) = arc.frame();
    let size = |axis: usize| radial[axis].abs() + lateral[axis].abs();
    // The axis that takes no part in the turn.
    let normal = (0..3).fold(0, |least, axis| {
        if size(axis) < size(least) {
            axis
        } else {
            least
        }
    });
    let plane = [(normal + 1) % 3, (normal + 2) % 3];
    let of = |axis: usize| {
        letters
            .iter()
            .position(|letter| *letter == ['X', 'Y', 'Z'][axis])
    };
    let [Some(first), Some(second)] = plane.map(of) else {
        return Err(ToolpathError::ArcPlane { plane, axes: N });
    };
    let mut center = start;
    center[first] = arc.center()[plane[0]];
    center[second] = arc.center()[plane[1]];
    let about = |turns| {
        Arc::about(
            start,
            end,
            center,
            [first, second],
            arc.sweep() > 0.0,
            turns,
        )
    };
    let once = about(0)?;
    let more = ((arc.sweep().abs() - once.sweep().abs()) / TAU).round();
    if more < 1.0 {
        return Ok(once);
    }
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the number of turns came from a u32"
    )]
    about(more as u32)
}

/// A program whose moves are those of all axes.
#[derive(Debug)]
pub struct AxisMoves<R> {
    program: Program<R>,
    at: Vector<3>,
    from: [f64; 6],
    to: [f64; 6],
    feed: Feed,
    /// Whether no move of the line was handed on.
    first: bool,
    /// Of moves in an arc that became chords: how long they are together, and how far they have come.
    chords: Option<(f64, f64)>,
}

/// How fast a line goes.
#[derive(Clone, Copy, Debug, Default)]
struct Feed {
    /// How long its only move takes, s, if the line says so.
    duration: Option<f64>,
    /// Feedrate of secondary axes, mm/s, and of rotary ones, degrees/s.
    beside: Option<(f64, f64)>,
}

impl<R: BufRead> AxisMoves<R> {
    pub(crate) fn new(program: Program<R>) -> Self {
        let at = program.lowering.position;
        let beside = program.lowering.others.at;
        Self {
            program,
            at,
            from: beside,
            to: beside,
            feed: Feed::default(),
            first: true,
            chords: None,
        }
    }

    /// The program, for what it knows beside its moves.
    pub fn program(&self) -> &Program<R> {
        &self.program
    }

    fn read_line(&mut self) -> Result<(), ProgramError> {
        self.from = self.program.lowering.others.at;
        self.program.read_line()?;
        let (state, block) = (&self.program.lowering, &self.program.block);
        self.to = state.others.at;
        self.first = true;
        let waiting = &self.program.waiting;
        let feeds = state.modal.motion != Motion::Rapid;
        let inverse = state.modal.feed_mode == FeedMode::InverseTime;
        let rate = block
            .get(b'F')
            .filter(|_| feeds && inverse && waiting.len() == 1);
        let per_minute = state.modal.feedrate.filter(|_| feeds && !inverse);
        self.feed = Feed {
            duration: rate.filter(|&rate| rate > 0.0).map(|rate| 60.0 / rate),
            beside: per_minute.map(|speed| (speed, state.modal.units.written(speed))),
        };
        self.chords = None;
        if state.modal.motion.is_arc() && waiting.len() > 1 {
            let mut at = self.at;
            let mut length = 0.0;
            for step in waiting {
                let end = step.end(at);
                length += (end - at).norm();
                at = end;
            }
            self.chords = Some((length, 0.0)).filter(|_| length > 0.0);
        }
        Ok(())
    }

    /// The axes beside, before and behind the next move of the line.
    fn beside(&mut self, length: f64) -> ([f64; 6], [f64; 6]) {
        let first = std::mem::replace(&mut self.first, false);
        match &mut self.chords {
            Some((all, come)) => {
                let (from, to) = (self.from, self.to);
                let at = |come: f64| {
                    let share = (come / *all).min(1.0);
                    std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]))
                };
                let before = at(*come);
                *come += length;
                let last = self.program.waiting.is_empty();
                (before, if last { to } else { at(*come) })
            }
            // Of several moves in one line the first takes the others along.
            None if first => (self.from, self.to),
            None => (self.to, self.to),
        }
    }

    fn complete(&mut self, step: Move<3>) -> AxisMove {
        let start = self.at;
        self.at = step.end(start);
        let length = match step.path() {
            Path::Arc(arc) => arc.length(),
            _ => (self.at - start).norm(),
        };
        let (from, to) = self.beside(length);
        let norm = |axes: std::ops::Range<usize>| {
            let squares = axes.map(|axis| (to[axis] - from[axis]).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let rapid = step.feedrate() == Feedrate::RAPID;
        let beside = || {
            let (straight, turning) = self.feed.beside?;
            let (secondary, rotary) = (norm(3..6), norm(0..3));
            if secondary > 0.0 {
                Some(secondary / straight)
            } else {
                Some(rotary / turning).filter(|&duration| duration > 0.0)
            }
        };
        let duration = match self.feed.duration {
            Some(duration) => Some(duration),
            None if length > 0.0 && !rapid => Some(length / step.feedrate().speed()),
            None if length > 0.0 => None,
            None => beside(),
        };
        AxisMove {
            step,
            start,
            from,
            to,
            duration,
        }
    }
}

impl<R: BufRead> Iterator for AxisMoves<R> {
    type Item = Result<AxisMove, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(step) = self.program.waiting.pop_front() {
                return Some(Ok(self.complete(step)));
            }
            if self.program.is_over() {
                return None;
            }
            if let Err(refusal) = self.read_line() {
                return Some(Err(refusal));
            }
        }
    }
}
