//! Finds which line of a FANUC program comes next: jumps, loops, subprograms.
//!
//! Source: the operator's manuals of FANUC and Haas. The lines of the file stand on the tape of the flow, those
//! of files beside it in recordings. Not here: what a line says.

use crate::error::flow::FlowError;
use crate::error::reason::Reason;
use crate::fanuc::labels::{Labels, blanks, is_block, program_number, stands_loop};
use crate::flow::Flow;
use crate::flow::recording::Recording;
use std::collections::BTreeMap;
use std::io::BufRead;
use std::sync::Arc;

/// Lines before the first `%` that are looked at.
const LONGEST_LEADER: usize = 200;

/// A text with lines: 0 is the file itself, others are files beside it.
pub(crate) type Text = usize;

/// What called a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Nothing.
    Main,
    /// `M98` or `M97`.
    Subprogram,
    /// `G65`.
    Macro,
    /// A block with motion, after `G66`.
    Modal,
}

/// A loop that is running, by the lines of its head and its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Loop {
    number: u32,
    head: usize,
    end: usize,
}

/// A program that is running.
#[derive(Debug)]
pub(crate) struct Frame {
    pub(crate) kind: Kind,
    pub(crate) number: u32,
    pub(crate) text: Text,
    /// First line of the program, and the one that a call begins with.
    pub(crate) start: usize,
    pub(crate) entry: usize,
    pub(crate) next: usize,
    pub(crate) left: u32,
    pub(crate) loops: Vec<Loop>,
}

/// Where a program is found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) text: Text,
    pub(crate) start: usize,
}

/// What the next line is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Next {
    Line,
    EndOfFile,
}

/// The programs that run, and what is known of their lines.
#[derive(Debug)]
pub(crate) struct Course {
    pub(crate) frames: Vec<Frame>,
    pub(crate) files: Vec<Arc<Recording>>,
    pub(crate) by_name: BTreeMap<u32, Text>,
    /// First lines of the programs of the file, once one was called.
    pub(crate) programs: Option<BTreeMap<u32, usize>>,
    labels: BTreeMap<(Text, usize), Labels>,
    /// Ends of loops by the line of their head.
    ends: BTreeMap<(Text, usize), usize>,
}

impl Course {
    pub(crate) fn new() -> Self {
        Self {
            frames: vec![Frame {
                kind: Kind::Main,
                number: 0,
                text: 0,
                start: 0,
                entry: 0,
                next: 0,
                left: 1,
                loops: Vec::new(),
            }],
            files: Vec::new(),
            by_name: BTreeMap::new(),
            programs: None,
            labels: BTreeMap::new(),
            ends: BTreeMap::new(),
        }
    }

    pub(crate) fn top(&mut self) -> Option<&mut Frame> {
        self.frames.last_mut()
    }

    /// Whether the main program runs.
    pub(crate) fn in_main(&self) -> bool {
        self.frames.len() <= 1
    }

    /// Index of the line being run.
    fn here(&self) -> usize {
        self.frames
            .last()
            .map_or(0, |frame| frame.next.saturating_sub(1))
    }

    /// Goes to the next line of the program that runs.
    pub(crate) fn advance<R: BufRead>(&mut self, flow: &mut Flow<R>) -> Result<Next, Reason> {
        let held = self.frames.len() > 1 || self.frames.iter().any(|frame| !frame.loops.is_empty());
        let Some(frame) = self.frames.last_mut() else {
            return Ok(Next::EndOfFile);
        };
        if frame.text > 0 {
            let Some(file) = self.files.get(frame.text - 1) else {
                return Ok(Next::EndOfFile);
            };
            if frame.next >= file.len() {
                return Ok(Next::EndOfFile);
            }
            flow.current = Some((Arc::clone(file), frame.next));
            frame.next += 1;
            flow.step()?;
            return Ok(Next::Line);
        }
        flow.current = None;
        let Some(tape) = &mut flow.tape else {
            return Ok(Next::EndOfFile);
        };
        tape.looking = held;
        tape.go_before(frame.next);
        let Some(again) = tape.advance(&mut flow.lines)? else {
            return Ok(Next::EndOfFile);
        };
        if tape.index() < frame.next {
            // The lines before were forgotten.
            self.labels.clear();
            self.ends.clear();
            frame.start = 0;
        }
        frame.next = tape.index() + 1;
        if again {
            flow.step()?;
        }
        Ok(Next::Line)
    }

    /// Passes over text before the first `%`, unless a block is in it.
    pub(crate) fn skip_leader<R: BufRead>(&mut self, flow: &mut Flow<R>) -> Result<(), Reason> {
        let opening = self.look(flow, 0, 0, |index, line| {
            let opens = line.get(blanks(line, 0)) == Some(&b'%');
            if opens {
                return Some(Some(index));
            }
            (index >= LONGEST_LEADER || is_block(line)).then_some(None)
        })?;
        if let (Some(Some(index)), Some(frame)) = (opening, self.top()) {
            frame.next = index;
        }
        Ok(())
    }

    /// Notes that the line being run is the first one of the main program.
    pub(crate) fn begin_main(&mut self, number: u32) {
        let here = self.here();
        if let Some(frame) = self.top() {
            (frame.number, frame.start, frame.entry) = (number, here, here);
        }
    }

    /// Whether the line being run is the first one of the program that runs.
    pub(crate) fn is_first(&self) -> bool {
        let here = self.here();
        self.frames.last().is_some_and(|frame| frame.start == here)
    }

    /// Looks at lines of a text from an index on until one gives something.
    pub(crate) fn look<R: BufRead, T>(
        &self,
        flow: &mut Flow<R>,
        text: Text,
        from: usize,
        mut is: impl FnMut(usize, &[u8]) -> Option<T>,
    ) -> Result<Option<T>, Reason> {
        if text > 0 {
            let Some(file) = self.files.get(text - 1) else {
                return Ok(None);
            };
            return Ok((from..file.len()).find_map(|index| is(index, file.line(index))));
        }
        let Some(tape) = &mut flow.tape else {
            return Ok(None);
        };
        let mut index = from;
        loop {
            if index >= tape.len() && !tape.read_on(&mut flow.lines)? {
                return Ok(None);
            }
            if let Some(found) = is(index, tape.line(index)) {
                return Ok(Some(found));
            }
            index += 1;
        }
    }

    /// Goes on with the block `number` of the program that runs.
    pub(crate) fn jump<R: BufRead>(
        &mut self,
        flow: &mut Flow<R>,
        number: u32,
    ) -> Result<(), Reason> {
        let Some((text, start)) = self.frames.last().map(|frame| (frame.text, frame.start)) else {
            return Ok(());
        };
        let from = self.here();
        let target = self.label(flow, Found { text, start }, number, from)?;
        if let Some(frame) = self.top() {
            frame
                .loops
                .retain(|one| (one.head + 1..=one.end).contains(&target));
            frame.next = target;
        }
        Ok(())
    }

    /// The line of the block `number` of a program: the next one behind `from`, or else the first.
    pub(crate) fn label<R: BufRead>(
        &mut self,
        flow: &mut Flow<R>,
        program: Found,
        number: u32,
        from: usize,
    ) -> Result<usize, Reason> {
        let key = (program.text, program.start);
        if !self.labels.contains_key(&key) {
            let mut labels = Labels::default();
            self.look(flow, program.text, program.start, |index, line| {
                let ends = labels.take(index, index == program.start, line);
                ends.then_some(())
            })?;
            self.labels.insert(key, labels);
        }
        let found = self
            .labels
            .get(&key)
            .and_then(|labels| labels.find(number, from));
        found.ok_or_else(|| {
            let label = format!("N{number}").into();
            FlowError::NoTarget { label }.into()
        })
    }

    /// Begins or passes over the loop whose head is being run; the end of it must be there.
    pub(crate) fn enter_loop<R: BufRead>(
        &mut self,
        flow: &mut Flow<R>,
        number: u32,
        runs: bool,
    ) -> Result<(), Reason> {
        let head = self.here();
        let text = self.frames.last().map_or(0, |frame| frame.text);
        let end = match self.ends.get(&(text, head)) {
            Some(end) => *end,
            None => {
                let mut inner = false;
                let found = self.look(flow, text, head + 1, |index, line| {
                    if program_number(line).is_some() {
                        return Some(None);
                    }
                    match stands_loop(line) {
                        Some((true, other)) if other == number => {
                            inner = true;
                            Some(None)
                        }
                        Some((false, other)) if other == number => Some(Some(index)),
                        _ => None,
                    }
                })?;
                let Some(end) = found.flatten() else {
                    return Err(FlowError::LoopNotClosed { number, inner }.into());
                };
                self.ends.insert((text, head), end);
                end
            }
        };
        let Some(frame) = self.top() else {
            return Ok(());
        };
        frame.loops.retain(|one| one.head != head);
        if runs {
            frame.loops.push(Loop { number, head, end });
        } else {
            frame.next = end + 1;
        }
        Ok(())
    }

    /// Goes back to the head of the loop that the line being run ends.
    pub(crate) fn end_loop(&mut self, number: u32) -> Result<(), Reason> {
        let here = self.here();
        let open = self.top().and_then(|frame| {
            let inner = frame
                .loops
                .iter()
                .rposition(|one| one.number == number && one.end == here)?;
            frame.loops.truncate(inner + 1);
            frame.loops.last().copied().map(|found| (frame, found.head))
        });
        let Some((frame, head)) = open else {
            return Err(FlowError::LoopNotOpen { number }.into());
        };
        frame.next = head;
        Ok(())
    }
}
