//! Chooses the next line: from the file, or from lines that are run again.
//!
//! The file itself is read once and never held; only loops and subroutines are remembered. Not
//! here: what an O word does, see `branch`.

pub(crate) mod branch;
pub(crate) mod control;
pub(crate) mod definitions;
pub(crate) mod endless;
pub(crate) mod recording;
pub(crate) mod skipping;
pub(crate) mod subprograms;
pub(crate) mod tape;

use crate::error::Fault;
use crate::error::flow::FlowError;
use crate::error::reason::Reason;
use crate::settings::Settings;
use crate::text::lines::Lines;
use crate::text::place::{Place, Span};
use control::{Control, Keyword, Label};
use endless::Watch;
use recording::Recording;
use std::collections::BTreeMap;
use std::io::BufRead;
use std::sync::Arc;
use subprograms::Rest;
use tape::Tape;

/// A block that is running.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Open {
    pub(crate) label: Label,
    /// `If`, `While`, `Do` or `Repeat`.
    pub(crate) keyword: Keyword,
    /// Index of its first line, in a recording.
    pub(crate) start: usize,
    /// Repetitions that are left.
    pub(crate) left: f64,
}

/// A recording that is running.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    pub(crate) recording: Arc<Recording>,
    /// Index of the line that is next, and of the one behind the last.
    pub(crate) next: usize,
    pub(crate) end: usize,
    pub(crate) open: Vec<Open>,
    pub(crate) call: Call,
}

/// What called the lines that run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Call {
    /// Nothing: a loop, or the program itself.
    None,
    /// An O word.
    Subroutine,
    /// `M98`: number, first line, and how often it still runs.
    Subprogram {
        number: u32,
        start: usize,
        left: u32,
    },
}

/// Finds the text of a subroutine by its name.
pub(crate) type Find = Box<dyn Fn(&str) -> std::io::Result<Option<Vec<u8>>> + Send>;

/// Where a program is being run.
pub(crate) struct Flow<R> {
    pub(crate) file: Arc<str>,
    pub(crate) lines: Lines<R>,
    pub(crate) frames: Vec<Frame>,
    /// Conditions that are open in the file itself.
    pub(crate) open: Vec<Open>,
    pub(crate) subroutines: BTreeMap<Label, Arc<Recording>>,
    pub(crate) find: Option<Find>,
    /// All lines, where the language jumps between them.
    pub(crate) tape: Option<Tape>,
    /// The rest of the file, once a subprogram was called.
    pub(crate) rest: Option<Rest>,
    /// The line being run, if it is not the one of the file.
    pub(crate) current: Option<(Arc<Recording>, usize)>,
    pub(crate) watch: Watch,
}

impl<R> std::fmt::Debug for Flow<R> {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.debug_struct("Flow")
            .field("file", &self.file)
            .field("frames", &self.frames)
            .finish_non_exhaustive()
    }
}

impl<R: BufRead> Flow<R> {
    pub(crate) fn new(reader: R, file: &str, settings: &Settings) -> Self {
        Self {
            file: Arc::from(file),
            lines: Lines::new(reader),
            frames: Vec::new(),
            open: Vec::new(),
            subroutines: BTreeMap::new(),
            find: None,
            tape: None,
            rest: None,
            current: None,
            watch: Watch::new(settings),
        }
    }

    /// The line being run.
    pub(crate) fn text(&self) -> &[u8] {
        match (&self.current, &self.tape) {
            (Some((recording, index)), _) => recording.line(*index),
            (None, Some(tape)) => tape.text(),
            (None, None) => self.lines.text(),
        }
    }

    /// Number of the line being run that its moves carry: where it is of another file, the line of
    /// the program that called it.
    pub(crate) fn line(&self) -> u32 {
        let number = match &self.current {
            Some((recording, index)) => {
                if let Some(line) = recording.outer {
                    return line;
                }
                recording.number(*index)
            }
            None => self.number(),
        };
        u32::try_from(number).unwrap_or(u32::MAX)
    }

    /// Number of the line of the file.
    fn number(&self) -> u64 {
        self.tape.as_ref().map_or(self.lines.count(), Tape::number)
    }

    /// Where a part of the line being run stands.
    pub(crate) fn place(&self, span: Span) -> Place {
        let (file, number) = match &self.current {
            Some((recording, index)) => (&recording.file, recording.number(*index)),
            None => (&self.file, self.number()),
        };
        Place::new(file, number, self.text(), span)
    }

    /// Goes to the next line; false at the end of the program.
    pub(crate) fn advance(&mut self) -> Result<bool, Reason> {
        while let Some(frame) = self.frames.last_mut() {
            if frame.next < frame.end {
                self.current = Some((Arc::clone(&frame.recording), frame.next));
                frame.next += 1;
                return self.step().map(|()| true);
            }
            let call = frame.call;
            if self.frames.len() == 1 && self.rest.is_some() {
                // The file goes on from memory, so this was its end; its last line stays in sight.
                return Ok(false);
            }
            self.frames.pop();
            if let Call::Subprogram { number, .. } = call {
                return Err(FlowError::NoReturn { number }.into());
            }
        }
        self.current = None;
        let Some(tape) = &mut self.tape else {
            return self.lines.advance();
        };
        match tape.advance(&mut self.lines)? {
            Some(true) => self.step().map(|()| true),
            Some(false) => Ok(true),
            None => Ok(false),
        }
    }

    /// Whether the line being run may run again.
    pub(crate) fn repeats(&self) -> bool {
        self.current.is_some() || self.tape.as_ref().is_some_and(|tape| !tape.at_front())
    }

    /// Index of the line being run on the tape.
    pub(crate) fn tape_index(&self) -> usize {
        self.tape.as_ref().map_or(0, Tape::index)
    }

    /// Goes on behind a line of the tape.
    pub(crate) fn tape_to(&mut self, index: usize) {
        if let Some(tape) = &mut self.tape {
            tape.go_to(index);
        }
    }

    /// Goes on with a line of the tape.
    pub(crate) fn tape_back(&mut self, index: usize) {
        if let Some(tape) = &mut self.tape {
            tape.go_before(index);
        }
    }

    /// The nearest line of the tape before the one being run that `is` the one wanted.
    pub(crate) fn tape_before(&self, is: impl FnMut(&[u8]) -> bool) -> Option<usize> {
        self.tape.as_ref().and_then(|tape| tape.before(is))
    }

    /// Counts a line that is run again.
    pub(crate) fn step(&mut self) -> Result<(), Reason> {
        let length = self.text().len();
        Ok(self.watch.step(length)?)
    }

    /// Blocks that are open where the program is.
    pub(crate) fn open(&mut self) -> &mut Vec<Open> {
        match self.frames.last_mut() {
            Some(frame) => &mut frame.open,
            None => &mut self.open,
        }
    }

    /// Goes on behind the line at an index of the recording that is running.
    pub(crate) fn jump_to(&mut self, index: usize) {
        if let Some(frame) = self.frames.last_mut() {
            frame.next = index;
        }
    }

    /// Index of the line being run in its recording.
    pub(crate) fn index(&self) -> usize {
        self.current.as_ref().map_or(0, |(_, index)| *index)
    }

    /// The line being run, to be shown when the end of its block is missing.
    pub(crate) fn here(&self) -> (Arc<Recording>, usize) {
        self.current.clone().unwrap_or_else(|| {
            let mut line = Recording::new(&self.file, self.lines.count());
            line.push(self.lines.text());
            (Arc::new(line), 0)
        })
    }

    /// Runs a recording from its first line.
    pub(crate) fn run(&mut self, recording: Arc<Recording>, call: Call) {
        self.frames.push(Frame {
            next: 0,
            end: recording.len(),
            recording,
            open: Vec::new(),
            call,
        });
    }

    /// Shows a line as the one being run.
    pub(crate) fn stay(&mut self, line: (Arc<Recording>, usize)) {
        self.current = Some(line);
    }

    /// Ends the innermost subroutine; false when none runs, or a subprogram within it.
    pub(crate) fn leave(&mut self) -> bool {
        let calls = |frame: &Frame| !matches!(frame.call, Call::None);
        let Some(call) = self.frames.iter().rposition(calls) else {
            return false;
        };
        let subroutine = matches!(self.frames[call].call, Call::Subroutine);
        if subroutine {
            self.frames.truncate(call);
        }
        subroutine
    }

    /// Subroutines and subprograms that are running.
    pub(crate) fn depth(&self) -> usize {
        let calls = |frame: &&Frame| !matches!(frame.call, Call::None);
        self.frames.iter().filter(calls).count()
    }
}

impl Control {
    /// A refusal of something met on the way to the end of this block.
    pub(crate) fn because(&self, reason: Reason) -> Fault {
        Fault::new(self.span, reason)
    }

    pub(crate) fn not_closed(&self, closing: &'static str) -> Fault {
        self.fault(FlowError::NotClosed {
            keyword: self.keyword.name(),
            label: self.label.to_string().into(),
            closing,
        })
    }
}
