//! Blocks into moves.
//!
//! Source: `G0` to `G4` and `M0` of RS274/NGC. Not here: the modal state and the shape of arcs.

use crate::arcs::arc;
use crate::block::{AXES, Block};
use crate::codes::{Distance, FeedMode, Group, Motion, PathControl, Stop};
use crate::error::{Fault, Remark};
use crate::modal::{Modal, not_negative};
use crate::reason::Reason;
use crate::settings::Settings;
use crate::units::{inverse_time, within_reach};
use crate::uses::{check, motion_of, motion_span};
use std::collections::VecDeque;
use toolglide_kinematics::{Feedrate, Move, Vector};

/// Longest dwell, s: about eleven days, more than any process waits.
const LONGEST_DWELL: f64 = 1e6;

/// Turns blocks into moves, one after the other.
#[derive(Debug)]
pub(crate) struct Lowering {
    pub(crate) settings: Settings,
    pub(crate) modal: Modal,
    pub(crate) position: Vector<3>,
}

impl Lowering {
    pub(crate) fn new(settings: Settings) -> Self {
        Self {
            settings,
            modal: Modal::new(&settings),
            position: settings.start,
        }
    }

    /// Appends the moves of a block to `moves`; true when the program ends with it.
    pub(crate) fn block(
        &mut self,
        block: &Block,
        line: u32,
        moves: &mut VecDeque<Move<3>>,
        remarks: &mut Vec<Remark>,
    ) -> Result<bool, Fault> {
        let motion = motion_of(block, self.modal.motion)?;
        check(block, motion)?;
        self.modal.take(block, &self.settings, remarks)?;
        if block.dwell {
            moves.push_back(self.dwell(block)?.from_line(line));
        }
        if let Some(motion) = motion {
            let (step, end) = self.step(block, motion)?;
            let step = step.from_line(line);
            self.position = end;
            moves.push_back(match self.modal.path_control {
                PathControl::ExactStop => step.with_exact_stop(),
                PathControl::Blend => step,
            });
        }
        match block.stop {
            Some(Stop::Pause) => {
                let rest = Move::dwell(0.0, self.modal.tolerance)
                    .map_err(|error| Fault::new(motion_span(block), Reason::Path(error)))?;
                moves.push_back(rest.from_line(line));
                Ok(false)
            }
            Some(Stop::End) => Ok(true),
            None => Ok(false),
        }
    }

    fn dwell(&self, block: &Block) -> Result<Move<3>, Fault> {
        let Some(duration) = not_negative(block, b'P', "dwell")? else {
            let (code, span) = block
                .taker(Group::NonModal)
                .unwrap_or((Motion::Off.code(), motion_span(block)));
            return Err(Fault::new(span, Reason::WordMissing { code, letter: 'P' }));
        };
        let at = |reason| Fault::new(block.span(b'P'), reason);
        if duration > LONGEST_DWELL {
            return Err(at(Reason::DwellTooLong {
                value: duration,
                bound: LONGEST_DWELL,
            }));
        }
        Move::dwell(duration, self.modal.tolerance).map_err(|error| at(Reason::Path(error)))
    }

    /// The move of a block, and where it ends.
    fn step(&self, block: &Block, motion: Motion) -> Result<(Move<3>, Vector<3>), Fault> {
        let end = self.end(block)?;
        let tolerance = self.modal.tolerance;
        if motion.is_arc() {
            let arc = arc(
                block,
                &self.modal,
                &self.settings,
                motion,
                self.position,
                end,
            )?;
            let feedrate = self.feedrate(block, arc.length())?;
            return Ok((Move::arc(arc, feedrate, tolerance), end));
        }
        let feedrate = match motion {
            Motion::Rapid => Feedrate::RAPID,
            _ => self.feedrate(block, (end - self.position).norm())?,
        };
        let line = Move::line_to(end, feedrate, tolerance)
            .map_err(|error| Fault::new(motion_span(block), Reason::Path(error)))?;
        Ok((line, end))
    }

    fn end(&self, block: &Block) -> Result<Vector<3>, Fault> {
        let mut end = self.position;
        for (axis, letter) in AXES.into_iter().enumerate() {
            let Some(value) = block.get(letter) else {
                continue;
            };
            let length = self.modal.units.length(value);
            let coordinate = match self.modal.distance {
                Distance::Absolute => length,
                Distance::Incremental => end[axis] + length,
            };
            end[axis] = within_reach(char::from(letter), coordinate)
                .map_err(|reason| Fault::new(block.span(letter), reason))?;
        }
        Ok(end)
    }

    /// Feedrate of a feed move of `length`.
    fn feedrate(&self, block: &Block, length: f64) -> Result<Feedrate, Fault> {
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
