//! Applies programmable frames of Sinumerik.
//!
//! Source: `TRANS` `ATRANS` `ROT` `AROT` of the programming manual of Sinumerik 840D sl. Not here: what a
//! frame does to a point.

use crate::error::Fault;
use crate::error::reason::Reason;
use crate::interpreter::frame::Frame;
use crate::sinumerik::Line;
use toolglide_kinematics::Vector;

/// A frame that a line sets or adds to.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum FrameWord {
    Shift { added: bool },
    Turn { added: bool },
}

impl Line<'_> {
    /// Sets the frame that the line speaks of.
    pub(crate) fn set_frame(&mut self) -> Result<(), Fault> {
        let Some((word, span)) = self.frame else {
            return Ok(());
        };
        let state = &mut *self.state;
        let units = state.modal.units;
        let mut frame = state.offsets.frame();
        match word {
            FrameWord::Shift { added } => {
                if !added {
                    frame = Frame::NONE;
                }
                let shift =
                    Vector::<3>::from_fn(|axis, _| units.length(self.offsets[axis].unwrap_or(0.0)));
                if shift.amax() > crate::interpreter::units::FARTHEST {
                    let (value, bound) = (shift.amax(), crate::interpreter::units::FARTHEST);
                    let reason = Reason::TooFar {
                        letter: 'X',
                        value,
                        bound,
                    };
                    return Err(Fault::new(span, reason));
                }
                frame = frame.shifted(shift);
            }
            FrameWord::Turn { added } => {
                if !added {
                    frame = Frame::NONE;
                }
                // About Z, then the new Y, then the new X.
                for axis in [2, 1, 0] {
                    if let Some(degrees) = self.offsets[axis] {
                        frame = frame.turned(axis, degrees);
                    }
                }
            }
        }
        state.offsets.set_frame(frame);
        state.program = state.offsets.in_program(state.position);
        Ok(())
    }
}
