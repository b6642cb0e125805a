//! Computes the feedrate of a move and the length of a dwell.
//!
//! Source: `F` with `G93` `G94`, and `G4` of RS274/NGC. Not here: units, see `units`.

use crate::block::Block;
use crate::block::codes::{FeedMode, Group, Motion};
use crate::block::word_usage::motion_span;
use crate::error::Fault;
use crate::error::reason::Reason;
use crate::interpreter::Interpreter;
use crate::interpreter::modal::not_negative;
use crate::interpreter::units::inverse_time;
use crate::text::place::Span;
use toolglide_kinematics::{Feedrate, Move};

/// Longest dwell, s: about eleven days, more than any process waits.
const LONGEST_DWELL: f64 = 1e6;

impl Interpreter {
    pub(crate) fn dwell(&self, block: &Block) -> Result<Move<3>, Fault> {
        let Some(duration) = not_negative(block, b'P', "dwell")? else {
            let (code, span) = block
                .taker(Group::NonModal)
                .unwrap_or((Motion::Off.code(), motion_span(block)));
            return Err(Fault::new(span, Reason::WordMissing { code, letter: 'P' }));
        };
        self.rest(duration, block.span(b'P'))
    }

    /// A dwell of a duration, s, that `span` asks for.
    pub(crate) fn rest(&self, duration: f64, span: Span) -> Result<Move<3>, Fault> {
        if duration > LONGEST_DWELL {
            let (value, bound) = (duration, LONGEST_DWELL);
            return Err(Fault::new(span, Reason::DwellTooLong { value, bound }));
        }
        Move::dwell(duration, self.modal.tolerance)
            .map(|rest| rest.from_line(self.line))
            .map_err(|error| Fault::new(span, Reason::Path(error)))
    }

    /// Feedrate of a feed move of `length`.
    pub(crate) fn feedrate(&self, block: &Block, length: f64) -> Result<Feedrate, Fault> {
        let written = block.get(b'F');
        let span = match written {
            Some(_) => block.span(b'F'),
            None => motion_span(block),
        };
        let fault = |reason| Fault::new(span, reason);
        let positive = |value: f64| {
            let quantity = "feedrate";
            if value > 0.0 {
                Ok(value)
            } else {
                Err(fault(Reason::NotPositive { quantity, value }))
            }
        };
        let speed = match self.modal.feed_mode {
            FeedMode::PerMinute => positive(self.modal.feedrate.ok_or(fault(Reason::NoFeedrate))?)?,
            FeedMode::InverseTime => {
                let rate = positive(written.ok_or(fault(Reason::NoInverseTime))?)?;
                if length <= 0.0 {
                    // Nothing moves, so there is no speed to keep.
                    return Ok(Feedrate::RAPID);
                }
                inverse_time(length, rate)
            }
        };
        Feedrate::new(speed).map_err(|_| fault(Reason::Feedrate { speed }))
    }
}
