//! Does for blocks what is none of their own motion: circles of pockets, reference points, remarks about dwells.
//!
//! Not here: blocks, see `lower`.

use crate::block::Block;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::error::{Fault, Notice, Remark};
use crate::interpreter::{Interpreter, MAX_MOVES};
use crate::text::place::Span;
use std::collections::VecDeque;
use toolglide_kinematics::{Arc, Feedrate, Move, Vector};

/// Dwells beyond this are said, s: a minute.
const LONG_DWELL: f64 = 60.0;

impl Interpreter {
    /// A circular move about a centre in the plane XY of the program, without cutter compensation; which
    /// way is true for counter-clockwise.
    pub(crate) fn go_round(
        &mut self,
        (end, center): (Vector<3>, Vector<3>),
        (counter_clockwise, feedrate): (bool, Feedrate),
        span: Span,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        if moves.len() >= MAX_MOVES as usize {
            let bound = MAX_MOVES;
            let reason = MachiningError::TooManyMoves { bound };
            return Err(Fault::new(span, reason.into()));
        }
        let (start, there) = (self.position, self.offsets.on_machine(end));
        let center = self.offsets.on_machine(center);
        let turned = counter_clockwise != self.offsets.frame().mirrors([0, 1]);
        let arc = Arc::about(start, there, center, [0, 1], turned, 0)
            .map_err(|error| Fault::new(span, Reason::Path(error)))?;
        (self.program, self.position) = (end, there);
        let step = Move::arc(arc, feedrate, self.modal.tolerance);
        moves.push_back(step.from_line(self.line));
        Ok(())
    }

    /// A reference point of the machine, X Y Z in mm and A B C in degrees; that of `G28` is number 0.
    pub(crate) fn reference(&self, index: usize) -> Option<[f64; 6]> {
        let stored = |first: u32| {
            let known = self.references.get(index).copied().unwrap_or_default();
            let mut point = known;
            for (axis, number) in (first..).take(3).enumerate() {
                point[axis] = self.parameters.get(number);
            }
            point
        };
        match index {
            0 => Some(stored(5161)),
            1 => Some(stored(5181)),
            // Where nobody said where they are, they are where the others are then.
            _ if self.references.is_empty() => Some([0.0; 6]),
            _ => self.references.get(index).copied(),
        }
    }

    /// Sets the offset of all coordinate systems, mm.
    pub(crate) fn set_common(&mut self, common: Vector<3>) {
        self.offsets.set_common(common);
        self.program = self.offsets.in_program(self.position);
    }

    /// Says of a dwell that is so long that its unit may be meant otherwise.
    pub(crate) fn mind_dwell(&self, block: &Block, remarks: &mut Vec<Remark>) {
        let milliseconds = self.fanuc;
        if let Some(seconds) = block.get(b'P').filter(|&seconds| seconds > LONG_DWELL) {
            let notice = Notice::LongDwell {
                seconds,
                milliseconds,
            };
            remarks.push((block.span(b'P'), notice));
        }
    }
}
