//! Finds programs by their numbers, in the file or beside it, and begins them.
//!
//! Not here: the lines of the one that runs, see `course`.

use crate::error::flow::FlowError;
use crate::error::reason::Reason;
use crate::expression::parameters::DEEPEST_CALL;
use crate::fanuc::course::{Course, Found, Frame, Kind, Text};
use crate::fanuc::labels::program_number;
use crate::flow::Flow;
use crate::flow::recording::Recording;
use std::collections::BTreeMap;
use std::io::BufRead;
use std::sync::Arc;

impl Course {
    /// The program `number`: in the file, or in one beside it.
    pub(crate) fn find<R: BufRead>(
        &mut self,
        flow: &mut Flow<R>,
        number: u32,
        outside: bool,
    ) -> Result<Option<Found>, Reason> {
        if !outside {
            if self.programs.is_none() {
                let mut programs = BTreeMap::new();
                self.look(flow, 0, 0, |index, line| {
                    if let Some(number) = program_number(line) {
                        programs.entry(number).or_insert(index);
                    }
                    None::<()>
                })?;
                self.programs = Some(programs);
            }
            let start = self
                .programs
                .as_ref()
                .and_then(|programs| programs.get(&number));
            if let Some(&start) = start {
                return Ok(Some(Found { text: 0, start }));
            }
        }
        self.load(flow, number)
    }

    /// A program in a file of its own.
    fn load<R: BufRead>(
        &mut self,
        flow: &mut Flow<R>,
        number: u32,
    ) -> Result<Option<Found>, Reason> {
        if let Some(&text) = self.by_name.get(&number) {
            let start = self.first_line(text);
            return Ok(Some(Found { text, start }));
        }
        let names = [
            format!("O{number:04}"),
            format!("O{number:05}"),
            format!("o{number:04}"),
            format!("o{number:05}"),
            format!("{number:04}"),
            format!("{number}"),
        ];
        let Some(find) = &flow.find else {
            return Ok(None);
        };
        for name in names {
            let bad = |message: String| {
                let (label, message) = (name.as_str().into(), message.into());
                Reason::from(FlowError::BadFile { label, message })
            };
            let text = find(&name).map_err(|error| bad(format!("cannot be read: {error}")))?;
            let Some(text) = text else {
                continue;
            };
            let file: Arc<str> = Arc::from(name.as_str());
            let mut recording = Recording::new(&file, 1);
            recording.outer = Some(flow.line());
            for line in text.split(|&byte| byte == b'\n') {
                let line = line.strip_suffix(b"\r").unwrap_or(line);
                if !recording.push(line) {
                    return Err(bad("is too long".to_owned()));
                }
            }
            self.files.push(Arc::new(recording));
            let text = self.files.len();
            self.by_name.insert(number, text);
            let start = self.first_line(text);
            return Ok(Some(Found { text, start }));
        }
        Ok(None)
    }

    /// Where the program of a file begins: behind its leader, with its number.
    fn first_line(&self, text: Text) -> usize {
        let Some(file) = self.files.get(text - 1) else {
            return 0;
        };
        let numbered = (0..file.len()).find(|&index| program_number(file.line(index)).is_some());
        let opened = (0..file.len()).find(|&index| file.line(index).first() == Some(&b'%'));
        numbered.or(opened.map(|index| index + 1)).unwrap_or(0)
    }

    /// Calls a program that was found, at one of its blocks where that is asked for.
    pub(crate) fn call<R: BufRead>(
        &mut self,
        flow: &mut Flow<R>,
        found: Found,
        frame: (Kind, u32, u32),
        block: Option<u32>,
    ) -> Result<(), Reason> {
        if self.frames.len() > DEEPEST_CALL {
            let bound = DEEPEST_CALL;
            return Err(FlowError::TooDeep { bound }.into());
        }
        let entry = match block {
            Some(block) => self.label(flow, found, block, found.start)?,
            None => found.start,
        };
        let (kind, number, left) = frame;
        self.frames.push(Frame {
            kind,
            number,
            text: found.text,
            start: found.start,
            entry,
            next: entry,
            left,
            loops: Vec::new(),
        });
        Ok(())
    }

    /// The program that runs, to be called at one of its own blocks.
    pub(crate) fn this(&self) -> Found {
        let frame = self.frames.last();
        Found {
            text: frame.map_or(0, |frame| frame.text),
            start: frame.map_or(0, |frame| frame.start),
        }
    }

    /// Begins the program that runs once more; false where its repetitions are used up.
    pub(crate) fn repeat(&mut self) -> bool {
        let Some(frame) = self.top() else {
            return false;
        };
        frame.left = frame.left.saturating_sub(1);
        if frame.left == 0 {
            return false;
        }
        frame.next = frame.entry;
        frame.loops.clear();
        true
    }
}
