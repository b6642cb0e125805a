//! Moves axes to their reference points and back.
//!
//! Source: `G27` to `G30` of the operator's manuals of FANUC and Haas. The reference points are those of the
//! machine. Not here: switches, which no axis meets here.

use crate::block::codes::Distance;
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::fanuc::Fanuc;
use crate::fanuc::actions::length;
use crate::fanuc::block::{Taken, axes, word};
use crate::fanuc::codes::Special;
use crate::fanuc::modes::whole;
use crate::fanuc::words::Word;
use crate::interpreter::frame::Frame;
use crate::interpreter::secondary_axes::{OTHERS, ROTARY};
use crate::interpreter::units::within_reach;
use crate::program::Program;
use std::io::BufRead;
use toolglide_kinematics::{Feedrate, Vector};

impl Fanuc {
    /// `G27`, `G28`, `G29` and `G30`.
    pub(crate) fn reference<R: BufRead>(
        &mut self,
        taken: Taken,
        words: &[Word],
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let refuse = |state| {
            let code = taken.code;
            let reason = MachiningError::NotNow { code, state };
            Err(Fault::new(taken.span, reason.into()))
        };
        let frame = program.lowering.offsets.frame();
        if frame.without_shift() != Frame::NONE {
            return refuse("while the program is mirrored, scaled or turned");
        }
        let turned = program.lowering.others.at;
        self.named_rotary(words, program)?;
        let here = program.lowering.program;
        let point = Self::point(words, program)?;
        let named = axes(words).map(|word| word.is_some());
        match taken.special {
            Special::CheckReference => Self::rapid(point, taken, program),
            Special::FromHome => {
                let Some(via) = self.via else {
                    return refuse("before G28 or G30");
                };
                let by =
                    Vector::from_fn(|axis, _| if named[axis] { via[axis] } else { here[axis] });
                Self::rapid(by, taken, program)?;
                let end =
                    Vector::from_fn(|axis, _| if named[axis] { point[axis] } else { by[axis] });
                Self::rapid(end, taken, program)
            }
            _ => {
                let index = match (taken.special, word(words, b'P')) {
                    (Special::OtherHome, Some(number)) => {
                        whole(&number, "number of a reference point", 2, 4)? as usize - 1
                    }
                    (Special::OtherHome, None) => 1,
                    _ => 0,
                };
                let Some(home) = program.lowering.reference(index) else {
                    return refuse("on a machine without this reference point");
                };
                self.via = Some(point);
                Self::rapid(point, taken, program)?;
                let state = &mut program.lowering;
                let any = words.iter().any(|word| b"XYZABC".contains(&word.letter));
                let mut there = state.position;
                for axis in 0..3 {
                    if state.settings.axes[axis] && (named[axis] || !any) {
                        there[axis] = home[axis];
                    }
                }
                for (axis, letter) in OTHERS.into_iter().take(ROTARY).enumerate() {
                    if word(words, letter).is_some() || !any && program.block.rotary {
                        state.others.at[axis] = home[axis + 3];
                    }
                }
                let end = state.offsets.in_program(there);
                // Rotary axes turn with a move, even if it leads nowhere.
                let turns = state
                    .others
                    .at
                    .iter()
                    .zip(&turned)
                    .any(|(now, before)| (now - before).abs() > 0.0);
                if end == here && program.waiting.is_empty() && turns {
                    let waiting = &mut program.waiting;
                    return state.go(end, Feedrate::RAPID, taken.span, waiting);
                }
                Self::rapid(end, taken, program)
            }
        }
    }

    /// Takes words of rotary axes that the machine has.
    fn named_rotary<R: BufRead>(
        &self,
        words: &[Word],
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        for (axis, letter) in OTHERS.into_iter().take(ROTARY).enumerate() {
            let Some(word) = word(words, letter) else {
                continue;
            };
            if !program.block.rotary && word.value == 0.0 {
                // Where the axis is not, it is at 0.
                continue;
            }
            if !program.block.rotary {
                let reason = program.block.no_axis(char::from(letter));
                return Err(Fault::new(word.span, reason));
            }
            let state = &mut program.lowering;
            let from = match state.modal.distance {
                Distance::Absolute => state.others.zero(axis),
                Distance::Incremental => state.others.at[axis],
            };
            state.others.at[axis] = within_reach(char::from(letter), from + word.value)
                .map_err(|reason| Fault::new(word.span, reason))?;
        }
        Ok(())
    }

    /// The point that axis words name, mm in the program.
    fn point<R: BufRead>(words: &[Word], program: &Program<R>) -> Result<Vector<3>, Fault> {
        let state = &program.lowering;
        let mut point = state.program;
        for (axis, word) in axes(words).into_iter().enumerate() {
            let Some(word) = word else {
                continue;
            };
            let letter = char::from(word.letter);
            if !state.settings.axes[axis] {
                let reason: Reason = program.block.no_axis(letter);
                return Err(Fault::new(word.span, reason));
            }
            let from = match state.modal.distance {
                Distance::Absolute => 0.0,
                Distance::Incremental => point[axis],
            };
            point[axis] = within_reach(letter, from + length(&word, program)?)
                .map_err(|reason| Fault::new(word.span, reason))?;
        }
        Ok(point)
    }

    /// A rapid move to a point of the program; one that leads nowhere is none.
    fn rapid<R: BufRead>(
        end: Vector<3>,
        taken: Taken,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        if end == program.lowering.program {
            return Ok(());
        }
        let (state, waiting) = (&mut program.lowering, &mut program.waiting);
        state.go(end, Feedrate::RAPID, taken.span, waiting)
    }
}
