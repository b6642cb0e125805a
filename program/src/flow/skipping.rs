//! Skips or remembers lines up to the end of their block.
//!
//! Not here: what comes next, see `flow`.

use crate::error::Fault;
use crate::error::flow::FlowError;
use crate::error::reason::Reason;
use crate::flow::Flow;
use crate::flow::control::{Control, Keyword, glance};
use crate::flow::recording::{LONGEST_RECORDING, Recording};
use std::io::BufRead;
use std::sync::Arc;

impl<R: BufRead> Flow<R> {
    /// Goes to the next line of the recording that is running, or of the file; false at its end.
    fn next_within(&mut self) -> Result<bool, Reason> {
        match self.frames.last_mut() {
            Some(frame) if frame.next < frame.end => {
                self.current = Some((Arc::clone(&frame.recording), frame.next));
                frame.next += 1;
                Ok(true)
            }
            Some(_) => Ok(false),
            None => self.lines.advance(),
        }
    }

    /// Passes over lines until one of `ends` with the label of `control`, which is then the line
    /// being run.
    pub(crate) fn skip(
        &mut self,
        control: &Control,
        ends: &[Keyword],
        closing: &'static str,
    ) -> Result<Keyword, Fault> {
        let opening = self.here();
        loop {
            let because = |reason| control.because(reason);
            if !self.next_within().map_err(because)? {
                self.current = Some(opening);
                return Err(control.not_closed(closing));
            }
            if !self.frames.is_empty() {
                self.step().map_err(because)?;
            }
            if let Some(keyword) = glance(self.text(), &control.label)
                && ends.contains(&keyword)
            {
                return Ok(keyword);
            }
        }
    }

    /// Remembers lines from the one being run, or from the next, to the end of the block that
    /// `control` begins.
    pub(crate) fn record(
        &mut self,
        control: &Control,
        with_first: bool,
        end: Keyword,
    ) -> Result<Arc<Recording>, Fault> {
        let outer = self
            .current
            .as_ref()
            .and_then(|(recording, _)| recording.outer);
        let (file, number) = match &self.current {
            Some((recording, index)) => (Arc::clone(&recording.file), recording.number(*index)),
            None => (Arc::clone(&self.file), self.lines.count()),
        };
        let mut recording = Recording::new(&file, number + u64::from(!with_first));
        recording.outer = outer;
        let opening = self.here();
        let mut fits = !with_first || recording.push(self.text());
        loop {
            let more = self.next_within();
            if !more.map_err(|reason| control.because(reason))? {
                self.current = Some(opening);
                return Err(control.not_closed(end.name()));
            }
            fits = fits && recording.push(self.text());
            if !fits {
                let bound = LONGEST_RECORDING;
                return Err(control.fault(FlowError::TooLong { bound }));
            }
            if glance(self.text(), &control.label) == Some(end) {
                return Ok(Arc::new(recording));
            }
        }
    }
}
