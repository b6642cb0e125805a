//! Does what takes axis words for itself: mirror, scaling, rotation, local coordinates.
//!
//! Source: `G50` `G51`, `G50.1` `G51.1`, `G52`, `G68` `G69` of the operator's manuals of FANUC and Haas. A centre is
//! in absolute coordinates; without one it is where the tool is. Not here: data, reference points, pockets.

use crate::block::AXES;
use crate::error::reason::Reason;
use crate::error::{Fault, Notice};
use crate::fanuc::Fanuc;
use crate::fanuc::block::{Taken, axes, word};
use crate::fanuc::codes::Special;
use crate::fanuc::transforms::Turn;
use crate::fanuc::words::Word;
use crate::program::Program;
use std::io::BufRead;

/// A factor without a decimal point from here on is in thousandths.
const THOUSANDTHS: f64 = 100.0;

/// Factors of scaling lie between these.
const SMALLEST_FACTOR: f64 = 1e-5;
const LARGEST_FACTOR: f64 = 1e5;

impl Fanuc {
    /// Does an action with its words.
    pub(crate) fn act<R: BufRead>(
        &mut self,
        taken: Taken,
        words: &[Word],
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        Self::refuse_compensated(&taken, &program.lowering)?;
        if program.lowering.corner.is_some() {
            return Err(program.lowering.corner_left(taken.span));
        }
        match taken.special {
            Special::SetData => return self.set_data(taken, words, program),
            Special::Pocket { counter_clockwise } => {
                return self.pocket(taken, counter_clockwise, words, program);
            }
            Special::CheckReference | Special::Home | Special::OtherHome | Special::FromHome => {
                return self.reference(taken, words, program);
            }
            Special::Scaling(on) => self.scale(taken, on, words, program)?,
            Special::Mirror(on) => self.mirror(taken, on, words, program)?,
            Special::Rotation(on) => self.rotate(taken, on, words, program)?,
            _ => {
                for (axis, word) in axes(words).into_iter().enumerate() {
                    if let Some(word) = word {
                        self.transforms.local[axis] = length(&word, program)?;
                    }
                }
            }
        }
        let state = &mut program.lowering;
        state.offsets.set_frame(self.transforms.frame());
        state.program = state.offsets.in_program(state.position);
        Ok(())
    }

    fn scale<R: BufRead>(
        &mut self,
        taken: Taken,
        on: bool,
        words: &[Word],
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        self.memory.groups[11] = if on { 51.0 } else { 50.0 };
        if !on {
            self.transforms.scaling = None;
            return Ok(());
        }
        let mut center = self.transforms.mirrored(program.lowering.program);
        for (axis, word) in axes(words).into_iter().enumerate() {
            if let Some(word) = word {
                center[axis] = length(&word, program)?;
            }
        }
        let mut factors = [1.0; 3];
        let mut any = false;
        for (index, letter) in (0..).zip(*b"PIJK") {
            let Some(word) = word(words, letter) else {
                continue;
            };
            any = true;
            let factor = factor(&word, program)?;
            match index {
                0 => factors = [factor; 3],
                _ => factors[index - 1] = factor,
            }
        }
        if !any {
            let (code, letter) = (taken.code, 'P');
            return Err(Fault::new(taken.span, Reason::WordMissing { code, letter }));
        }
        self.transforms.scaling = Some((center, factors));
        Ok(())
    }

    fn mirror<R: BufRead>(
        &mut self,
        taken: Taken,
        on: bool,
        words: &[Word],
        program: &Program<R>,
    ) -> Result<(), Fault> {
        let words = axes(words);
        if words.iter().all(Option::is_none) {
            if on {
                let (code, letter) = (taken.code, 'X');
                return Err(Fault::new(taken.span, Reason::WordMissing { code, letter }));
            }
            self.transforms.mirror = [None; 3];
        }
        for (axis, word) in words.into_iter().enumerate() {
            if let Some(word) = word {
                let center = length(&word, program)?;
                self.transforms.mirror[axis] = on.then_some(center);
            }
        }
        let any = self.transforms.mirror.iter().any(Option::is_some);
        self.memory.groups[22] = if any { 51.1 } else { 50.1 };
        Ok(())
    }

    fn rotate<R: BufRead>(
        &mut self,
        taken: Taken,
        on: bool,
        words: &[Word],
        program: &Program<R>,
    ) -> Result<(), Fault> {
        self.memory.groups[16] = if on { 68.0 } else { 69.0 };
        let before = self.transforms.turn.take();
        if !on {
            return Ok(());
        }
        let Some(angle) = word(words, b'R') else {
            let (code, letter) = (taken.code, 'R');
            return Err(Fault::new(taken.span, Reason::WordMissing { code, letter }));
        };
        let plane = program.lowering.modal.plane;
        let mut center = program.lowering.program;
        // Haas writes the centre with A and B too.
        for (axis, other) in plane.axes().into_iter().zip(*b"AB") {
            if let Some(word) = word(words, AXES[axis]).or(word(words, other)) {
                center[axis] = length(&word, program)?;
            }
        }
        let incremental =
            program.lowering.modal.distance == crate::block::codes::Distance::Incremental;
        let from = before
            .filter(|_| incremental)
            .map_or(0.0, |turn| turn.degrees);
        self.transforms.turn = Some(Turn {
            about: plane.normal(),
            center: self.transforms.scaled(center),
            degrees: (from + angle.value) % 360.0,
        });
        Ok(())
    }
}

/// A length in mm within reach.
pub(crate) fn length<R>(word: &Word, program: &Program<R>) -> Result<f64, Fault> {
    let units = program.lowering.modal.units;
    let letter = char::from(word.letter);
    let length = units.bounded_length(letter, word.value);
    length.map_err(|reason| Fault::new(word.span, reason))
}

/// A factor of scaling.
fn factor<R>(word: &Word, program: &mut Program<R>) -> Result<f64, Fault> {
    let mut factor = word.value;
    if !word.point && factor.abs() >= THOUSANDTHS {
        factor /= 1000.0;
        let name = format!("{}{}", char::from(word.letter), word.value).into();
        let what = "a factor in thousandths, because it has no decimal point";
        program
            .remarks
            .push((word.span, Notice::Noted { word: name, what }));
    }
    if !(SMALLEST_FACTOR..=LARGEST_FACTOR).contains(&factor.abs()) {
        let quantity = "factor of scaling";
        let value = word.value;
        return Err(Fault::new(
            word.span,
            Reason::OutOfBounds {
                quantity,
                value,
                least: SMALLEST_FACTOR,
                most: LARGEST_FACTOR,
            },
        ));
    }
    Ok(factor)
}
