//! Turns moves of axis words into moves of the tool in the workpiece.
//!
//! Source: `G43.4`, `G93` and rotary words as LinuxCNC and others read them; a feedrate of rotary axes
//! alone is in degrees a minute, of the root of the sum of their squares, one of U, V and W alone in mm along them. Arcs
//! become chords, and the rotary axes go evenly along them. Not here:
//! reading the words.

use crate::block::codes::{FeedMode, Motion};
use crate::curves::chords::count;
use crate::curves::splines::CHORD_SHARE;
use crate::error::ProgramError;
use crate::error::reason::Reason;
use crate::interpreter::secondary_axes::{OTHERS, ROTARY};
use crate::program::Program;
use std::collections::VecDeque;
use std::io::BufRead;
use toolglide_kinematics::{
    Feedrate, GreatCircle, Move, Path, PoseEnd, PoseFeed, PoseMove, Tolerance, ToolPose,
    ToolpathError, Vector,
};

/// A program whose moves are those of a machine with rotary axes.
#[derive(Debug)]
pub(crate) struct AxisWords<R> {
    pub(crate) program: Program<R>,
    waiting: VecDeque<PoseMove>,
}

/// What axis words mean.
#[derive(Clone, Copy)]
struct Words {
    /// Whether those of linear axes are of the tool tip.
    tip: bool,
    /// Whether those of rotary axes say where the tool points, and not how the axes turn.
    great_circle: bool,
    /// Where vectors point the tool before and after the block.
    directions: Option<[Vector<3>; 2]>,
    /// Rotary axes that are where vectors have put them.
    held: [bool; ROTARY],
}

/// What a block says about all its moves.
#[derive(Clone, Copy)]
struct Block {
    from: [f64; 6],
    to: [f64; 6],
    /// How long a feed move of the block takes, s, if that is what it says.
    duration: Option<f64>,
    /// Speed of rotary axes alone, degrees/s, and of straight axes U, V and W alone, mm/s.
    turning: Option<f64>,
    sliding: Option<f64>,
}

impl<R: BufRead> AxisWords<R> {
    pub(crate) fn new(program: Program<R>) -> Self {
        Self {
            program: program.with_rotary_axes().with_secondary_axes(),
            waiting: VecDeque::new(),
        }
    }

    /// Reads a line into poses.
    fn read_line(&mut self) -> Result<(), ProgramError> {
        let from = self.program.lowering.others.at;
        let start = self.program.lowering.position;
        let before = self.program.lowering.tool_vector.direction;
        self.program.read_line()?;
        let directions = match self.directions(before) {
            Ok(directions) => directions,
            Err(reason) => return Err(self.program.refuse(reason)),
        };
        let state = &self.program.lowering;
        let rate = self.program.block.get(b'F');
        let feeds = state.modal.motion != Motion::Rapid;
        let inverse = state.modal.feed_mode == FeedMode::InverseTime;
        let block = Block {
            from,
            to: state.others.at,
            duration: rate.filter(|_| inverse && feeds).map(|rate| 60.0 / rate),
            turning: state.modal.feedrate.filter(|_| feeds && !inverse),
            sliding: state.modal.feedrate.filter(|_| feeds && !inverse),
        };
        let tool = state.offsets.tool();
        let words = Words {
            tip: state.tip,
            great_circle: state.great_circle,
            directions,
            held: state.tool_vector.held,
        };
        let turning = block
            .turning
            .map(|speed| self.program.lowering.modal.units.written(speed));
        let block = Block { turning, ..block };
        let single = self.program.waiting.len() == 1;
        let mut at = start;
        while let Some(step) = self.program.waiting.pop_front() {
            let end = step.end(at);
            let shown = |point: Vector<3>| if words.tip { point - tool } else { point };
            let outcome = poses(&step, at, &block, single, words, shown, &mut self.waiting);
            if let Err(reason) = outcome {
                return Err(self.program.refuse(reason.into()));
            }
            at = end;
        }
        Ok(())
    }
}

impl<R: BufRead> AxisWords<R> {
    /// Where the tool points before and after the line that was read, where vectors say so.
    fn directions(&self, before: Option<Vector<3>>) -> Result<Option<[Vector<3>; 2]>, Reason> {
        let Some(direction) = self.program.lowering.tool_vector.direction else {
            return Ok(None);
        };
        let arc = |step: &Move<3>| matches!(step.path(), Path::Arc(_));
        if before.is_none() && self.program.waiting.iter().any(arc) {
            let word = "A3= B3= C3=".into();
            let what =
                "a vector at the end of an arc at whose beginning rotary words point the tool";
            return Err(Reason::WordNotSupported { word, what });
        }
        Ok(Some([before.unwrap_or(direction), direction]))
    }
}

/// The end of a move at a share of its block.
fn end_at(
    words: &Words,
    linear: Vector<3>,
    rotary: [f64; ROTARY],
    share: f64,
) -> Result<PoseEnd, ToolpathError> {
    Ok(match words.directions {
        Some([_, last]) if share >= 1.0 => PoseEnd::Pose(ToolPose::new(linear, last)?),
        Some(directions) => {
            let [start, end] = directions.map(|way| ToolPose::new(linear, way));
            let turn = GreatCircle::between(&start?, &end?)?;
            PoseEnd::Pose(ToolPose::new(linear, turn.at(share))?)
        }
        None => PoseEnd::Axes {
            linear,
            rotary,
            tip: words.tip,
            great_circle: words.great_circle,
        },
    })
}

/// Appends the poses of a move that begins at `start`.
fn poses(
    step: &Move<3>,
    start: Vector<3>,
    block: &Block,
    single: bool,
    words: Words,
    shown: impl Fn(Vector<3>) -> Vector<3>,
    into: &mut VecDeque<PoseMove>,
) -> Result<(), ToolpathError> {
    let at =
        |share: f64, axis: usize| block.from[axis] + share * (block.to[axis] - block.from[axis]);
    let at_share = |share: f64| std::array::from_fn(|axis| at(share, axis).to_radians());
    let slid = |share: f64| std::array::from_fn(|axis| at(share, ROTARY + axis));
    // Of several moves in one block the first turns.
    let end_turn = at_share(1.0);
    let finished = |end, feed, tolerance, share| -> Result<PoseMove, ToolpathError> {
        PoseMove::new(end, feed, tolerance)?
            .from_line(step.line())
            .with_rotary_held(words.held)
            .with_secondary(slid(share))
    };
    match step.path() {
        Path::Dwell { duration } => {
            let duration = *duration;
            let end = PoseEnd::Dwell { duration };
            into.push_back(finished(end, PoseFeed::Rapid, step.tolerance(), 1.0)?);
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
                let end = end_at(&words, shown(arc.point(share)), at_share(share), share)?;
                let next = finished(end, feed, kept, share)?;
                let stops = chord == chords && step.stops();
                into.push_back(if stops { next.with_exact_stop() } else { next });
            }
        }
        _ => {
            let there = step.end(start);
            let still = (there - start).norm() <= 0.0;
            let travel = |axis: usize| (block.to[axis] - block.from[axis]).abs();
            let turned = (0..ROTARY).map(travel).fold(0.0_f64, f64::hypot);
            let slide = (ROTARY..OTHERS.len()).map(travel).fold(0.0_f64, f64::hypot);
            let feed = match (block.duration, block.turning) {
                (Some(duration), _) if single => PoseFeed::Duration(duration),
                (_, Some(speed)) if single && still && speed > 0.0 && turned > 0.0 => {
                    PoseFeed::Duration(turned / speed)
                }
                _ => match block.sliding.filter(|_| single && still && slide > 0.0) {
                    Some(speed) if speed > 0.0 && turned <= 0.0 => {
                        PoseFeed::Duration(slide / speed)
                    }
                    _ => speed(step.feedrate()),
                },
            };
            let end = end_at(&words, shown(there), end_turn, 1.0)?;
            let next = finished(end, feed, step.tolerance(), 1.0)?;
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
