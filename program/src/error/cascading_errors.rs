//! Recognises refusals that may be mere consequences of one before them.
//!
//! A line that is refused does not do what it says: it sets no feedrate, no motion mode and no name, it
//! opens no block, and the tool does not get to its end. Not here: the refusals.

use crate::error::arithmetic::ArithmeticError;
use crate::error::flow::FlowError;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;

/// Bytes of refused lines that are remembered, in all: enough for every name they may have set.
const MAX_TEXT: usize = 16 * 1024;

/// What refused lines may have left undone.
#[derive(Debug, Default)]
pub(crate) struct CascadingErrors {
    any: bool,
    feedrate: bool,
    code: bool,
    /// Whether the tool may not be where the reader believes it to be.
    pub(crate) place: bool,
    /// Refused lines with parameters or O words, in lower case, without blanks.
    text: Vec<u8>,
}

impl CascadingErrors {
    /// Remembers a refused line; `arrived` says that its end was taken all the same.
    pub(crate) fn take(&mut self, line: &[u8], arrived: bool) {
        self.any = true;
        let has = |letters: &[u8]| line.iter().any(|byte| letters.contains(byte));
        self.feedrate |= has(b"Ff");
        self.code |= has(b"Gg");
        // Of O words nobody knows what they would have run.
        self.place |= !arrived && has(b"XYZxyz@^Oo");
        if has(b"#Oo=") && self.text.len() + line.len() < MAX_TEXT {
            let kept = line.iter().filter(|byte| !byte.is_ascii_whitespace());
            self.text.extend(kept.map(u8::to_ascii_lowercase));
            self.text.push(b'\n');
        }
    }

    /// Whether a refusal may follow from one of these lines; `lost` says that the tool may have been
    /// somewhere else before.
    pub(crate) fn explains(&self, reason: &Reason, lost: bool) -> bool {
        match reason {
            // A line that would have ended the loop may be among them.
            Reason::Flow(
                FlowError::Endless | FlowError::NoMotion { .. } | FlowError::TooManySteps { .. },
            ) => self.any,
            Reason::NoFeedrate => self.feedrate || self.code,
            Reason::NoInverseTime | Reason::NoMotionMode { .. } => self.code,
            Reason::Arithmetic(ArithmeticError::NeverSet { name }) => self.names(name),
            Reason::Flow(FlowError::NotOpen { label, .. }) => self.names(label),
            Reason::Path(_)
            | Reason::ArcRadiusTooShort { .. }
            | Reason::ArcRadiusClosed { .. }
            | Reason::Machining(
                MachiningError::LeadInTooShort { .. }
                | MachiningError::ToolTooLarge { .. }
                | MachiningError::Gouge { .. }
                | MachiningError::SplineStart { .. }
                | MachiningError::RetractBelowBottom { .. },
            ) => lost,
            Reason::Machining(MachiningError::NoSpline) => self.code,
            _ => false,
        }
    }

    fn names(&self, name: &str) -> bool {
        let name = name.to_ascii_lowercase();
        let text = String::from_utf8_lossy(&self.text);
        text.contains(&name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_a_refused_line_may_have_done_is_its_consequence() {
        let mut aftermath = CascadingErrors::default();
        assert!(
            !aftermath.explains(&Reason::NoFeedrate, false),
            "nothing yet"
        );
        let endless = Reason::Flow(FlowError::Endless);
        assert!(!aftermath.explains(&endless, false), "endless by itself");
        aftermath.take(b"#<Deep> = [1 +", true);
        let never = |name: &str| {
            let name = name.into();
            Reason::Arithmetic(ArithmeticError::NeverSet { name })
        };
        assert!(aftermath.explains(&never("deep"), false), "its name");
        assert!(aftermath.explains(&endless, false), "its end");
        assert!(!aftermath.explains(&never("wide"), false), "another name");
        assert!(!aftermath.explains(&Reason::NoFeedrate, false), "no F");
        aftermath.take(b"X1 F100 ~", false);
        assert!(aftermath.explains(&Reason::NoFeedrate, false), "F");
        assert!(aftermath.place, "the tool is lost");
    }
}
