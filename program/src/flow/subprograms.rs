//! Calls numbered subprograms: `M98 P L` calls one that stands below in the file, `M99` ends it.
//!
//! Source: FANUC controls, and the manual of LinuxCNC, which numbers them by `O` words too. With the first
//! call the rest of the file is remembered, because that is where they stand. Parameters are those of the
//! caller. Not here: subroutines by O words with keywords, see `branch`.

use crate::error::flow::FlowError;
use crate::error::reason::Reason;
use crate::expression::parameters::DEEPEST_CALL;
use crate::flow::control::bare_number;
use crate::flow::recording::{LONGEST_RECORDING, Recording};
use crate::flow::{Call, Flow, Frame};
use std::collections::BTreeMap;
use std::io::BufRead;
use std::ops::Range;
use std::sync::Arc;

/// Largest number of a subprogram.
pub(crate) const LARGEST_NUMBER: u32 = 99_999_999;

/// Most repetitions of one call: four digits, as controls of FANUC count them.
pub(crate) const MAX_REPETITIONS: u32 = 9999;

/// The rest of a file, with the lines of each subprogram in it.
#[derive(Debug)]
pub(crate) struct Rest {
    pub(crate) recording: Arc<Recording>,
    programs: BTreeMap<u32, Range<usize>>,
}

impl<R: BufRead> Flow<R> {
    /// Calls a subprogram, as often as `times` says; false when it is not to run at all.
    pub(crate) fn call_program(&mut self, number: u32, times: u32) -> Result<bool, Reason> {
        let rest = self.rest()?;
        let Some(lines) = rest.programs.get(&number).cloned() else {
            return Err(FlowError::NoSubprogram { number }.into());
        };
        let recording = Arc::clone(&rest.recording);
        if times == 0 {
            return Ok(false);
        }
        if self.depth() >= DEEPEST_CALL {
            let bound = DEEPEST_CALL;
            return Err(FlowError::TooDeep { bound }.into());
        }
        self.frames.push(Frame {
            recording,
            next: lines.start,
            end: lines.end,
            open: Vec::new(),
            call: Call::Subprogram {
                number,
                start: lines.start,
                left: times,
            },
        });
        Ok(true)
    }

    /// Ends the innermost subprogram; true when it runs once more.
    pub(crate) fn return_program(&mut self) -> Result<bool, FlowError> {
        let call = self
            .frames
            .iter()
            .rposition(|frame| !matches!(frame.call, Call::None));
        let frame = call.and_then(|index| {
            self.frames.truncate(index + 1);
            self.frames.last_mut()
        });
        let Some(frame) = frame else {
            return Err(FlowError::EndlessProgram);
        };
        let Call::Subprogram { start, left, .. } = &mut frame.call else {
            return Err(FlowError::MixedReturn);
        };
        *left -= 1;
        if *left > 0 {
            frame.next = *start;
            frame.open.clear();
            return Ok(true);
        }
        self.frames.pop();
        Ok(false)
    }

    /// The rest of the file, which goes on from memory once it was read.
    pub(crate) fn rest(&mut self) -> Result<&Rest, Reason> {
        let rest = match self.rest.take() {
            Some(rest) => rest,
            None => self.remember_rest()?,
        };
        Ok(self.rest.insert(rest))
    }

    fn remember_rest(&mut self) -> Result<Rest, Reason> {
        let here = self.here();
        let mut recording = Recording::new(&self.file, self.lines.count() + 1);
        let mut programs = BTreeMap::new();
        let mut begun: Option<(u32, usize)> = None;
        let mut end = |begun: &mut Option<(u32, usize)>, line: usize| {
            if let Some((number, start)) = begun.take() {
                programs.entry(number).or_insert(start..line);
            }
        };
        while self.lines.advance()? {
            if !recording.push(self.lines.text()) {
                let bound = LONGEST_RECORDING;
                return Err(FlowError::TooLong { bound }.into());
            }
            if let Some(number) = bare_number(self.lines.text()) {
                end(&mut begun, recording.len() - 1);
                begun = Some((number, recording.len()));
            }
        }
        end(&mut begun, recording.len());
        let recording = Arc::new(recording);
        self.stay(here);
        self.frames.insert(
            0,
            Frame {
                next: 0,
                end: recording.len(),
                recording: Arc::clone(&recording),
                open: std::mem::take(&mut self.open),
                call: Call::None,
            },
        );
        Ok(Rest {
            recording,
            programs,
        })
    }
}
