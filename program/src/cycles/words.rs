//! Keeps the words of canned cycles, which hold from block to block.
//!
//! Source: RS274/NGC and LinuxCNC: they hold until another motion code. Not here: the motion.

use crate::block::codes::{Distance, Motion};
use crate::block::word_usage::motion_span;
use crate::block::{AXES, Block};
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::interpreter::Interpreter;
use crate::interpreter::modal::not_negative;
use crate::interpreter::units::within_reach;

/// What a cycle remembers from block to block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CycleState {
    pub(crate) motion: Motion,
    /// Height at which the first of consecutive cycles began, mm.
    pub(crate) initial: f64,
    pub(crate) retract: f64,
    pub(crate) bottom: f64,
    pub(crate) dwell: f64,
    pub(crate) peck: f64,
    pub(crate) offsets: [f64; 3],
}

impl Interpreter {
    /// The words of a cycle, those of its former blocks included.
    pub(crate) fn cycle_words(
        &self,
        block: &Block,
        motion: Motion,
        former: Motion,
        depth: usize,
    ) -> Result<CycleState, Fault> {
        let before = self.cycle.filter(|state| former == state.motion);
        let sticky = before.filter(|state| self.fanuc || state.motion == motion);
        let consecutive = self.cycle.filter(|_| former.is_cycle());
        let initial = consecutive.map_or(self.program[depth], |state| state.initial);
        let code = motion.code();
        let incomplete = |letter| {
            let reason = MachiningError::CycleIncomplete {
                code,
                letter: char::from(letter),
            };
            Fault::new(motion_span(block), reason.into())
        };
        let incremental = self.modal.distance == Distance::Incremental;
        let from = |letter: u8, base: f64, length: f64| {
            let sum = if incremental { base + length } else { length };
            within_reach(char::from(letter), sum)
                .map_err(|reason| Fault::new(block.span(letter), reason))
        };
        let above = if self.fanuc {
            initial
        } else {
            self.program[depth]
        };
        let retract = match (self.length(block, b'R')?, sticky) {
            (Some(length), _) => from(b'R', above, length)?,
            (None, Some(state)) => state.retract,
            (None, None) => return Err(incomplete(b'R')),
        };
        let bottom = match (self.length(block, AXES[depth])?, sticky) {
            (Some(length), _) => from(AXES[depth], retract, length)?,
            (None, Some(state)) => state.bottom,
            (None, None) => return Err(incomplete(AXES[depth])),
        };
        if retract < bottom && motion != Motion::BackBore {
            let reason = MachiningError::RetractBelowBottom { retract, bottom };
            return Err(Fault::new(motion_span(block), reason.into()));
        }
        let needs_peck = matches!(motion, Motion::Cycle(73 | 83));
        let peck = match (self.length(block, b'Q')?, sticky) {
            (Some(peck), _) if peck <= 0.0 && needs_peck => {
                let (quantity, value) = ("depth of a peck", peck);
                let reason = Reason::NotPositive { quantity, value };
                return Err(Fault::new(block.span(b'Q'), reason));
            }
            (Some(peck), _) => peck,
            (None, Some(state)) if state.peck > 0.0 || !needs_peck => state.peck,
            (None, _) if needs_peck => return Err(incomplete(b'Q')),
            (None, _) => 0.0,
        };
        let dwell = not_negative(block, b'P', "dwell")?;
        let needs_dwell = !self.fanuc && matches!(motion, Motion::Cycle(82 | 86 | 88 | 89));
        let dwell = match (dwell, sticky) {
            (Some(dwell), _) => dwell,
            (None, Some(state)) => state.dwell,
            (None, None) if needs_dwell => return Err(incomplete(b'P')),
            (None, None) => 0.0,
        };
        let mut offsets = sticky.map_or([None; 3], |state| state.offsets.map(Some));
        for (offset, letter) in offsets.iter_mut().zip(*b"IJK") {
            *offset = self.length(block, letter)?.or(*offset);
            if offset.is_none() && motion == Motion::Cycle(87) {
                return Err(incomplete(letter));
            }
        }
        Ok(CycleState {
            motion,
            initial,
            retract,
            bottom,
            dwell,
            peck,
            offsets: offsets.map(Option::unwrap_or_default),
        })
    }
}
