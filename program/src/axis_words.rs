//! Moves of axis words as moves of the tool in the workpiece.
//!
//! Source: `G43.4`, `G93` and rotary words as LinuxCNC and others read them; a feedrate of rotary axes
//! alone is in degrees a minute. Arcs become chords, and the rotary axes go evenly along them. Not here:
//! reading the words.

use crate::chords::count;
use crate::codes::{FeedMode, Motion};
use crate::error::ProgramError;
use crate::program::Program;
use crate::splines::CHORD_SHARE;
use std::collections::VecDeque;
use std::io::BufRead;
use toolglide_kinematics::{
    Feedrate, Move, Path, PoseEnd, PoseFeed, PoseMove, Tolerance, ToolpathError, Vector,
};

/// A program whose moves are those of a machine with rotary axes.
#[derive(Debug)]
pub(crate) struct AxisWords<R> {
    pub(crate) program: Program<R>,
    waiting: VecDeque<PoseMove>,
}

/// What a block says about all its moves.
#[derive(Clone, Copy)]
struct Block {
    from: [f64; 3],
    to: [f64; 3],
    /// How long a feed move of the block takes, s, if that is what it says.
    duration: Option<f64>,
    /// Speed of rotary axes alone, degrees/s.
    turning: Option<f64>,
}

impl<R: BufRead> AxisWords<R> {
    pub(crate) fn new(program: Program<R>) -> Self {
        Self {
            program: program.with_rotary_axes(),
            waiting: VecDeque::new(),
        }
    }

    /// Reads a line into poses.
    fn read_line(&mut self) -> Result<(), ProgramError> {
        let from = self.program.lowering.rotary;
        let start = self.program.lowering.position;
        self.program.read_line()?;
        let state = &self.program.lowering;
        let rate = self.program.block.get(b'F');
        let feeds = state.modal.motion != Motion::Rapid;
        let inverse = state.modal.feed_mode == FeedMode::InverseTime;
        let block = Block {
            from,
            to: state.rotary,
            duration: rate.filter(|_| inverse && feeds).map(|rate| 60.0 / rate),
            turning: state.modal.feedrate.filter(|_| feeds && !inverse),
        };
        let (tip, tool) = (state.tip, state.offsets.tool());
        let turning = block
            .turning
            .map(|speed| self.program.lowering.modal.units.written(speed));
        let block = Block { turning, ..block };
        let single = self.program.waiting.len() == 1;
        let mut at = start;
        while let Some(step) = self.program.waiting.pop_front() {
            let end = step.end(at);
            let shown = |point: Vector<3>| if tip { point - tool } else { point };
            let outcome = poses(&step, at, &block, single, tip, shown, &mut self.waiting);
            if let Err(reason) = outcome {
                return Err(self.program.refuse(reason.into()));
            }
            at = end;
        }
        Ok(())
    }
}

/// Appends the poses of a move that begins at `start`.
fn poses(
    step: &Move<3>,
    start: Vector<3>,
    block: &Block,
    single: bool,
    tip: bool,
    shown: impl Fn(Vector<3>) -> Vector<3>,
    into: &mut VecDeque<PoseMove>,
) -> Result<(), ToolpathError> {
    let turned = |share: f64| {
        std::array::from_fn(|axis| {
            let degrees = block.from[axis] + share * (block.to[axis] - block.from[axis]);
            degrees.to_radians()
        })
    };
    // Of several moves in one block the first turns.
    let end_turn = turned(1.0);
    let finished = |end, feed, tolerance| -> Result<PoseMove, ToolpathError> {
        Ok(PoseMove::new(end, feed, tolerance)?.from_line(step.line()))
    };
    match step.path() {
        Path::Dwell { duration } => {
            let duration = *duration;
            let end = PoseEnd::Dwell { duration };
            into.push_back(finished(end, PoseFeed::Rapid, step.tolerance())?);
        }
        Path::Arc(arc) => {
            let (first, last) = arc.radii();
            let tolerance = step.tolerance().length();
            let chords = count(first.max(last), arc.sweep(), CHORD_SHARE * tolerance);
            let kept = Tolerance::new(tolerance * (1.0 - CHORD_SHARE)).unwrap_or(step.tolerance());
            let feed = match block.duration {
                Some(duration) => PoseFeed::Duration(duration / f64::from(chords)),
                None => speed(step.feedrate()),
            };
            for chord in 1..=chords {
                let share = f64::from(chord) / f64::from(chords);
                let end = PoseEnd::Axes {
                    linear: shown(arc.point(share)),
                    rotary: turned(share),
                    tip,
                };
                let next = finished(end, feed, kept)?;
                let stops = chord == chords && step.stops();
                into.push_back(if stops { next.with_exact_stop() } else { next });
            }
        }
        _ => {
            let there = step.end(start);
            let still = (there - start).norm() <= 0.0;
            let largest = (0..3).fold(0.0_f64, |most, axis| {
                most.max((block.to[axis] - block.from[axis]).abs())
            });
            let feed = match (block.duration, block.turning) {
                (Some(duration), _) if single => PoseFeed::Duration(duration),
                (_, Some(speed)) if single && still && speed > 0.0 && largest > 0.0 => {
                    PoseFeed::Duration(largest / speed)
                }
                _ => speed(step.feedrate()),
            };
            let end = PoseEnd::Axes {
                linear: shown(there),
                rotary: end_turn,
                tip,
            };
            let next = finished(end, feed, step.tolerance())?;
            into.push_back(if step.stops() {
                next.with_exact_stop()
            } else {
                next
            });
        }
    }
    Ok(())
}

fn speed(feedrate: Feedrate) -> PoseFeed {
    if feedrate == Feedrate::RAPID {
        PoseFeed::Rapid
    } else {
        PoseFeed::Speed(feedrate)
    }
}

impl<R: BufRead> Iterator for AxisWords<R> {
    type Item = Result<PoseMove, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(next) = self.waiting.pop_front() {
                return Some(Ok(next));
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
