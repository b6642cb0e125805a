//! Divides arcs in planes that are none of the machine into chords.
//!
//! Not here: arcs in its planes, see `arcs`.

use crate::block::Block;
use crate::block::codes::{Motion, PathControl, Plane};
use crate::block::word_usage::motion_span;
use crate::curves::arcs::arc;
use crate::curves::chords::count;
use crate::curves::splines::CHORD_SHARE;
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::interpreter::Interpreter;
use crate::interpreter::offsets::Offsets;
use std::collections::VecDeque;
use toolglide_kinematics::{Move, Tolerance, Vector};

impl Interpreter {
    /// Whether the plane of arcs is none of the machine.
    pub(crate) fn turns_arcs(&self) -> bool {
        let upright = self.modal.plane != Plane::Xy && self.offsets.rotation() != 0.0;
        upright
            || !self
                .offsets
                .frame()
                .keeps_arcs_across(self.modal.plane.normal())
    }

    /// An arc in a plane that is none of the machine, as chords.
    pub(crate) fn turned_arc(
        &mut self,
        block: &Block,
        motion: Motion,
        end: Vector<3>,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let span = motion_span(block);
        if self.compensation.is_some() {
            let (code, state) = (
                motion.code(),
                "in a plane that is turned, with compensation on",
            );
            return Err(Fault::new(
                span,
                MachiningError::NotNow { code, state }.into(),
            ));
        }
        // In the coordinates of the program the arc is like any other.
        let offsets = std::mem::replace(&mut self.offsets, Offsets::new());
        let found = arc(block, self, motion, self.program, end);
        self.offsets = offsets;
        let (arc, mismatch) = match found {
            Ok(found) => found,
            Err(fault) => {
                (self.program, self.position) = (end, self.offsets.on_machine(end));
                return Err(fault);
            }
        };
        self.tell_rounding(block, mismatch);
        let feedrate = self.feedrate(block, arc.length())?;
        let (first, last) = arc.radii();
        let chords = count(first.max(last), arc.sweep(), self.chord_error());
        let whole = self.modal.tolerance;
        self.modal.tolerance =
            Tolerance::new(whole.length() * (1.0 - CHORD_SHARE)).unwrap_or(whole);
        let mut outcome = Ok(());
        for chord in 1..=chords {
            let share = f64::from(chord) / f64::from(chords);
            outcome = outcome.and_then(|()| self.go(arc.point(share), feedrate, span, moves));
        }
        self.modal.tolerance = whole;
        if self.modal.path_control == PathControl::ExactStop
            && let Some(last) = moves.back_mut()
        {
            *last = last.with_exact_stop();
        }
        outcome
    }
}
