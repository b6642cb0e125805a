//! Refuses programs that run for ever: counts the lines that are run again, and proves of a loop that it
//! comes back to a line with nothing changed.
//!
//! Source: the cycle detection of Brent: one state is kept, taken anew whenever the number of lines has
//! doubled, and held against every later one. Every language uses it, because all of them go back
//! through [`Flow`]. Not here: which line is next.

use crate::error::flow::FlowError;
use crate::expression::parameters::Parameters;
use crate::flow::{Flow, Frame, Open};
use crate::interpreter::Interpreter;
use crate::interpreter::modal::Modal;
use crate::interpreter::offsets::Offsets;
use crate::interpreter::secondary_axes::Others;
use crate::interpreter::tools::ToolTable;
use crate::settings::Settings;
use std::collections::VecDeque;
use std::io::BufRead;
use std::sync::Arc;
use toolglide_kinematics::{Move, Path, Vector};

/// A line counts once, and once more for each so many bytes of it, because long lines take longer.
const BYTES_OF_A_STEP: u64 = 64;

/// Counts lines that are run again, and keeps the state at one of them.
#[derive(Debug)]
pub(crate) struct Watch {
    /// Lines that may be run again, in all and without a move.
    most: u64,
    most_still: u64,
    steps: u64,
    still: u64,
    /// After how many lines the next state is kept.
    next_look: u64,
    seen: Option<Box<Seen>>,
}

/// Where a program was, with all that decides how it goes on from there.
#[derive(Debug)]
struct Seen {
    lines_read: u64,
    line: usize,
    frames: Vec<Frame>,
    open: Vec<Open>,
    state: State,
}

/// What the lines before have left behind. A language that remembers more belongs in here.
#[derive(Debug, PartialEq)]
struct State {
    parameters: Parameters,
    program: Vector<3>,
    position: Vector<3>,
    others: Others,
    modal: Modal,
    saved: Vec<Option<(Modal, bool)>>,
    offsets: Offsets,
    loaded: u32,
    tools: ToolTable,
}

impl Watch {
    pub(crate) fn new(settings: &Settings) -> Self {
        Self {
            most: settings.steps,
            most_still: settings.still_steps,
            steps: 0,
            still: 0,
            next_look: 1,
            seen: None,
        }
    }

    /// Counts a line of this many bytes that is run again, or passed over once more.
    pub(crate) fn step(&mut self, length: usize) -> Result<(), FlowError> {
        self.steps += 1;
        if self.steps > self.most {
            let bound = self.most;
            return Err(FlowError::TooManySteps { bound });
        }
        self.still += 1 + length as u64 / BYTES_OF_A_STEP;
        if self.still > self.most_still {
            let bound = self.most_still;
            return Err(FlowError::NoMotion { bound });
        }
        Ok(())
    }

    /// Takes note of the moves of a line, before which the machine stood at `start` and the
    /// other axes at `others`.
    #[allow(clippy::float_cmp, reason = "the very same place, not one nearby")]
    pub(crate) fn note(
        &mut self,
        (start, others): (Vector<3>, Others),
        state: &Interpreter,
        moves: &VecDeque<Move<3>>,
    ) {
        let moves_on = |next: &Move<3>| match next.path() {
            Path::Line { end } => *end != start,
            Path::Dwell { duration } => *duration > 0.0,
            _ => true,
        };
        if others != state.others || moves.iter().any(moves_on) {
            self.still = 0;
        }
    }
}

impl<R: BufRead> Flow<R> {
    /// Refuses a line that is run again with nothing changed since it was run before: from there on all
    /// happens again, without end.
    pub(crate) fn check_progress(&mut self, state: &Interpreter) -> Result<(), FlowError> {
        if self.current.is_none() && self.tape.is_none() {
            return Ok(());
        }
        if let Some(seen) = &self.watch.seen
            && seen.is(self, state)
        {
            return Err(FlowError::Endless);
        }
        if self.watch.steps >= self.watch.next_look {
            self.watch.next_look = 2 * self.watch.steps;
            self.watch.seen = Some(Box::new(Seen::of(self, state)));
        }
        Ok(())
    }

    /// Index of the line being run, in its recording or on the tape.
    fn here_index(&self) -> usize {
        match &self.current {
            Some((_, index)) => *index,
            None => self.tape_index(),
        }
    }
}

impl Seen {
    fn of<R: BufRead>(flow: &Flow<R>, state: &Interpreter) -> Self {
        Self {
            lines_read: flow.lines.count(),
            line: flow.here_index(),
            frames: flow.frames.clone(),
            open: flow.open.clone(),
            state: State::of(state),
        }
    }

    fn is<R: BufRead>(&self, flow: &Flow<R>, state: &Interpreter) -> bool {
        self.line == flow.here_index()
            && self.lines_read == flow.lines.count()
            && self.open == flow.open
            && self.frames.len() == flow.frames.len()
            && self.frames.iter().zip(&flow.frames).all(same)
            && self.state.is(state)
    }
}

fn same((one, other): (&Frame, &Frame)) -> bool {
    Arc::ptr_eq(&one.recording, &other.recording)
        && (one.next, one.end, one.call) == (other.next, other.end, other.call)
        && one.open == other.open
}

impl State {
    fn of(state: &Interpreter) -> Self {
        Self {
            parameters: state.parameters.clone(),
            program: state.program,
            position: state.position,
            others: state.others,
            modal: state.modal,
            saved: state.saved.clone(),
            offsets: state.offsets,
            loaded: state.loaded,
            tools: state.tools.clone(),
        }
    }

    #[allow(clippy::float_cmp, reason = "the very same state, not one nearby")]
    fn is(&self, state: &Interpreter) -> bool {
        self.program == state.program
            && self.position == state.position
            && self.others == state.others
            && self.modal == state.modal
            && self.loaded == state.loaded
            && self.offsets == state.offsets
            && self.saved == state.saved
            && self.parameters == state.parameters
            && self.tools == state.tools
    }
}
