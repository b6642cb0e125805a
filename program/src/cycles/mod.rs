//! Expands canned cycles: drilling, tapping and boring.
//!
//! Source: `G73`, `G74` and `G81` to `G89` of RS274/NGC and LinuxCNC. The words of a cycle hold until
//! another motion code; `L` for its block only. Every move of a cycle ends in rest, because a hole has
//! a bottom. Not here: the spindle, which turns as it likes.

pub(crate) mod words;

use crate::block::codes::{Distance, Motion};
use crate::block::word_usage::motion_span;
use crate::block::{AXES, Block};
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::interpreter::modal::whole;
use crate::interpreter::units::within_reach;
use crate::interpreter::{Interpreter, MAX_MOVES};
use crate::text::place::Span;
use std::collections::VecDeque;
use toolglide_kinematics::{Feedrate, Move, Vector};
use words::CycleState;

/// How far the tool is drawn back to break a chip, and how far from the bottom a deep hole is entered
/// again, mm: a hundredth of an inch, as LinuxCNC does.
const PECK_CLEARANCE: f64 = 0.254;

/// One hole.
#[derive(Clone, Copy, Debug)]
struct Hole {
    span: Span,
    /// Axis along which the tool goes, and the two others.
    depth: usize,
    sides: [usize; 2],
    retract: f64,
    bottom: f64,
    /// Height to which the tool goes back at the end.
    clear: f64,
    feedrate: Feedrate,
}

impl Interpreter {
    /// Drills the holes of a block.
    pub(crate) fn cycle(
        &mut self,
        block: &Block,
        motion: Motion,
        former: Motion,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let span = motion_span(block);
        let code = motion.code();
        let refuse = |state| Fault::new(span, MachiningError::NotNow { code, state }.into());
        if self.compensation.is_some() {
            return Err(refuse("while cutter compensation is on (G40 ends it)"));
        }
        Self::no_others(block, "in a canned cycle")?;
        if block.first_of(b"XYZ@^").is_none() {
            let reason = MachiningError::Companion {
                code,
                companion: "an axis word",
            };
            return Err(Fault::new(span, reason.into()));
        }
        let sides = self.modal.plane.axes();
        let depth = self.modal.plane.normal();
        let state = self.cycle_words(block, motion, former, depth)?;
        self.cycle = Some(state);
        // In inverse time there is no feedrate that all moves of a cycle could share.
        if block.get(b'F').is_none() && self.modal.feedrate.is_none() {
            return Err(Fault::new(span, Reason::NoFeedrate));
        }
        if self.modal.feed_mode == crate::block::codes::FeedMode::InverseTime {
            return Err(refuse("with inverse time (G93)"));
        }
        let feedrate = self.feedrate(block, 1.0)?;
        let clear = if self.modal.return_to_start {
            state.initial.max(state.retract)
        } else {
            state.retract
        };
        let hole = Hole {
            span,
            depth,
            sides,
            retract: state.retract,
            bottom: state.bottom,
            clear,
            feedrate,
        };
        let repetitions = whole(block, b'L', "number of repetitions", 0, MAX_MOVES)?.unwrap_or(1);
        let first = moves.len();
        let mut outcome = match motion {
            // Of this one the plane of R lies below.
            Motion::BackBore => Ok(()),
            _ => self.raise(&hole, moves),
        };
        let mut center = self.program;
        for _ in 0..repetitions {
            if outcome.is_err() {
                break;
            }
            outcome = self
                .next_center(block, sides, &mut center)
                .and_then(|()| self.drill(motion, &hole, &state, center, moves));
        }
        for step in moves.iter_mut().skip(first) {
            *step = step.with_exact_stop();
        }
        outcome
    }

    /// A tool below the plane of retraction goes up before it goes anywhere else.
    fn raise(&mut self, hole: &Hole, moves: &mut VecDeque<Move<3>>) -> Result<(), Fault> {
        if self.program[hole.depth] < hole.retract {
            self.go_deep(hole, hole.retract, Feedrate::RAPID, moves)?;
        }
        Ok(())
    }

    /// Where the next hole is.
    fn next_center(
        &self,
        block: &Block,
        sides: [usize; 2],
        center: &mut Vector<3>,
    ) -> Result<(), Fault> {
        if block.first_of(b"@^").is_some() {
            *center = self.polar(block, *center)?;
        }
        for axis in sides {
            let letter = AXES[axis];
            if let Some(length) = self.length(block, letter)? {
                let place = match self.modal.distance {
                    Distance::Absolute => length,
                    Distance::Incremental => center[axis] + length,
                };
                center[axis] = within_reach(char::from(letter), place)
                    .map_err(|reason| Fault::new(block.span(letter), reason))?;
            }
        }
        Ok(())
    }

    fn drill(
        &mut self,
        motion: Motion,
        hole: &Hole,
        state: &CycleState,
        center: Vector<3>,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let rapid = Feedrate::RAPID;
        let feed = hole.feedrate;
        let (bottom, retract) = (hole.bottom, hole.retract);
        if motion == Motion::BackBore {
            return self.bore_from_below(hole, state, center, moves);
        }
        // Returning to where the cycles began means going across there too.
        let mut above = center;
        let height = self.program[hole.depth];
        above[hole.depth] = if self.modal.return_to_start {
            hole.clear
        } else {
            height
        };
        self.go_where_needed(above, rapid, hole.span, moves)?;
        self.go_deep(hole, retract, rapid, moves)?;
        match motion {
            Motion::Cycle(73 | 83) => {
                let mut depth = retract;
                loop {
                    depth -= state.peck;
                    if depth <= bottom {
                        break;
                    }
                    self.go_deep(hole, depth, feed, moves)?;
                    if motion == Motion::Cycle(83) {
                        self.go_deep(hole, retract, rapid, moves)?;
                    }
                    self.go_deep(hole, depth + PECK_CLEARANCE, rapid, moves)?;
                }
                self.go_deep(hole, bottom, feed, moves)?;
            }
            Motion::Cycle(87) => return self.bore_back(hole, state, center, moves),
            Motion::Cycle(76) => return self.bore_fine(hole, state, center, moves),
            _ => self.go_deep(hole, bottom, feed, moves)?,
        }
        if state.dwell > 0.0 {
            moves.push_back(self.rest(state.dwell, hole.span)?);
        }
        match motion {
            Motion::Cycle(74 | 84 | 85) => {
                self.go_deep(hole, retract, feed, moves)?;
                self.go_deep(hole, hole.clear, rapid, moves)
            }
            Motion::Cycle(89) => self.go_deep(hole, hole.clear, feed, moves),
            Motion::Cycle(88) => {
                moves.push_back(self.rest(0.0, hole.span)?);
                self.go_deep(hole, hole.clear, rapid, moves)
            }
            _ => self.go_deep(hole, hole.clear, rapid, moves),
        }
    }

    /// Where a bored hole is left without touching it, beside its centre: by `I` and `J`, or by `Q` along the
    /// first axis.
    fn beside(hole: &Hole, state: &CycleState, center: Vector<3>) -> Vector<3> {
        let [first, second, _] = state.offsets;
        let first = if first == 0.0 && second == 0.0 {
            state.peck
        } else {
            first
        };
        let mut beside = center;
        beside[hole.sides[0]] += first;
        beside[hole.sides[1]] += second;
        beside
    }

    /// `G76` of FANUC: the tool bores down, and goes up beside the wall.
    fn bore_fine(
        &mut self,
        hole: &Hole,
        state: &CycleState,
        center: Vector<3>,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let rapid = Feedrate::RAPID;
        let beside = Self::beside(hole, state, center);
        self.go_deep(hole, hole.bottom, hole.feedrate, moves)?;
        if state.dwell > 0.0 {
            moves.push_back(self.rest(state.dwell, hole.span)?);
        }
        self.go_aside(hole, beside, rapid, moves)?;
        self.go_deep(hole, hole.clear, rapid, moves)?;
        self.go_aside(hole, center, rapid, moves)
    }

    /// `G87` of FANUC: the tool goes down beside the hole to `R`, bores up to `Z`, and leaves beside it; it
    /// always returns to where the cycles began.
    fn bore_from_below(
        &mut self,
        hole: &Hole,
        state: &CycleState,
        center: Vector<3>,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let rapid = Feedrate::RAPID;
        let beside = Self::beside(hole, state, center);
        self.go_deep(hole, state.initial, rapid, moves)?;
        self.go_aside(hole, center, rapid, moves)?;
        self.go_aside(hole, beside, rapid, moves)?;
        self.go_deep(hole, hole.retract, rapid, moves)?;
        self.go_aside(hole, center, hole.feedrate, moves)?;
        self.go_deep(hole, hole.bottom, hole.feedrate, moves)?;
        if state.dwell > 0.0 {
            moves.push_back(self.rest(state.dwell, hole.span)?);
        }
        self.go_aside(hole, beside, rapid, moves)?;
        self.go_deep(hole, state.initial, rapid, moves)?;
        self.go_aside(hole, center, rapid, moves)
    }

    /// `G87`: the tool goes down beside the hole, and cuts upwards.
    fn bore_back(
        &mut self,
        hole: &Hole,
        state: &CycleState,
        center: Vector<3>,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let rapid = Feedrate::RAPID;
        let [first, second, third] = state.offsets;
        let mut beside = center;
        beside[hole.sides[0]] += first;
        beside[hole.sides[1]] += second;
        let top = match self.modal.distance {
            Distance::Absolute => third,
            Distance::Incremental => hole.bottom + third,
        };
        self.go_aside(hole, beside, rapid, moves)?;
        self.go_deep(hole, hole.bottom, rapid, moves)?;
        self.go_aside(hole, center, rapid, moves)?;
        self.go_deep(hole, top, hole.feedrate, moves)?;
        self.go_deep(hole, hole.bottom, hole.feedrate, moves)?;
        self.go_aside(hole, beside, rapid, moves)?;
        self.go_deep(hole, hole.clear, rapid, moves)?;
        self.go_aside(hole, center, rapid, moves)
    }

    fn go_deep(
        &mut self,
        hole: &Hole,
        height: f64,
        feedrate: Feedrate,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let mut end = self.program;
        end[hole.depth] = height;
        self.go_where_needed(end, feedrate, hole.span, moves)
    }

    fn go_aside(
        &mut self,
        hole: &Hole,
        center: Vector<3>,
        feedrate: Feedrate,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let mut end = center;
        end[hole.depth] = self.program[hole.depth];
        self.go_where_needed(end, feedrate, hole.span, moves)
    }

    /// A move that leads nowhere is none.
    fn go_where_needed(
        &mut self,
        end: Vector<3>,
        feedrate: Feedrate,
        span: Span,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        if end == self.program {
            return Ok(());
        }
        self.go(end, feedrate, span, moves)
    }
}
