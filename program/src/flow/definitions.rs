//! Records subroutines from lines that go by without being run.
//!
//! Not here: the calls.

use crate::flow::control::{Control, Keyword, Label, NoValues, control, o_word};
use crate::flow::recording::Recording;
use std::sync::Arc;

/// Collects subroutines.
#[derive(Debug)]
pub(crate) struct Definitions {
    file: Arc<str>,
    /// Line of the program that moves of another file are said to come from.
    outer: Option<u32>,
    open: Option<(Label, Recording)>,
    found: Vec<(Label, Recording)>,
}

impl Definitions {
    pub(crate) fn of(file: &Arc<str>, outer: Option<u32>) -> Self {
        Self {
            file: Arc::clone(file),
            outer,
            open: None,
            found: Vec::new(),
        }
    }

    /// Takes a line; false when a subroutine would be too long.
    pub(crate) fn take(&mut self, line: &[u8], number: u64) -> bool {
        let met = o_word(line).and_then(|at| without_values(line, at));
        if let Some((label, lines)) = &mut self.open {
            if !lines.push(line) {
                return false;
            }
            let ends = met.is_some_and(|met| met.keyword == Keyword::EndSub && met.label == *label);
            if ends {
                self.found.extend(self.open.take());
            }
        } else if let Some(met) = met
            && met.keyword == Keyword::Sub
        {
            let mut lines = Recording::new(&self.file, number + 1);
            lines.outer = self.outer;
            self.open = Some((met.label, lines));
        }
        true
    }

    /// What was found, or the subroutine whose end is missing.
    pub(crate) fn finish(self) -> Result<Vec<(Label, Recording)>, Label> {
        match self.open {
            None => Ok(self.found),
            Some((label, _)) => Err(label),
        }
    }
}

/// A line with an O word, as far as it can be read without values.
fn without_values(line: &[u8], at: usize) -> Option<Control> {
    control(line, at, &NoValues).ok().flatten()
}
