//! Does what a block says before its motion: dwells, modes of the control, work offsets.
//!
//! Source: the operator's manuals of FANUC and Haas. Not here: motion.

use crate::error::Fault;
use crate::error::reason::Reason;
use crate::fanuc::Fanuc;
use crate::fanuc::block::{Taken, position, seconds, word};
use crate::fanuc::codes::Special;
use crate::fanuc::memory::EXTENDED;
use crate::fanuc::words::Word;
use crate::program::Program;
use std::io::BufRead;

/// Modes of `G5` by `P` that are noted: buffering and high-speed machining, on and off.
const HIGH_SPEED: [f64; 6] = [0.0, 1.0, 2.0, 3.0, 4.0, 10_000.0];

impl Fanuc {
    /// `G4` with `P`, `X` or `U`; without a word it stops exactly.
    pub(crate) fn dwell<R: BufRead>(
        taken: Taken,
        list: &mut Vec<Word>,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let found = b"PXU".iter().find_map(|&letter| position(list, letter));
        let (value, span) = match found.map(|index| list.remove(index)) {
            Some(word) if word.letter == b'P' => (seconds(&word), word.span),
            Some(word) => (word.value, word.span),
            None => (0.0, taken.span),
        };
        Self::add(b'G', 4.0, taken.span, program)?;
        Self::add(b'P', value, span, program)
    }

    /// `G5`, `G5.1` and `G8`, which switch modes of the control with their word.
    pub(crate) fn mode<R: BufRead>(
        &mut self,
        mode: u8,
        taken: Taken,
        list: &mut Vec<Word>,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let refuse = |what| {
            let code = taken.code;
            Err(Fault::new(taken.span, Reason::NotSupported { code, what }))
        };
        let (letter, letters, what): (u8, &[u8], _) = match mode {
            5 => (b'P', b"PL", "high-speed machining"),
            51 => (b'Q', b"QRPXYZABC", "contour control and smoothing"),
            _ => (b'P', b"P", "look-ahead"),
        };
        let Some(found) = word(list, letter) else {
            return match mode {
                5 | 51 => refuse("splines of LinuxCNC; write P or Q of a mode"),
                _ => refuse("diameters on a lathe"),
            };
        };
        if mode == 5 && !HIGH_SPEED.iter().any(|one| (one - found.value).abs() < 0.5) {
            return refuse("motion from data of the control");
        }
        list.retain(|word| word.comma || !letters.contains(&word.letter));
        self.note(&taken.code.to_string(), what, taken.span, program);
        Ok(())
    }

    /// `G54` to `G59`, `G54.1`, `G154`, and `G110` to `G129`.
    pub(crate) fn select_system<R: BufRead>(
        &mut self,
        taken: Taken,
        list: &mut Vec<Word>,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let numbered = |list: &mut Vec<Word>| {
            position(list, b'P').map(|index| {
                let word = list.remove(index);
                whole(&word, "additional work offset", 1, EXTENDED)
            })
        };
        let index = match taken.special {
            Special::Numbered(number) => u32::from(number),
            Special::System(1) if position(list, b'P').is_some() => {
                numbered(list).transpose()?.unwrap_or(1)
            }
            Special::System(number) => {
                self.memory.in_force = 0;
                let code = 53.0 + f64::from(number);
                return Self::add(b'G', code, taken.span, program);
            }
            _ => {
                let (code, letter) = (taken.code, 'P');
                let missing = Fault::new(taken.span, Reason::WordMissing { code, letter });
                numbered(list).ok_or(missing)??
            }
        };
        Self::refuse_compensated(&taken, &program.lowering)?;
        self.memory.groups[14] = 54.1;
        self.memory.select_extended(index, &mut program.lowering);
        Ok(())
    }

    /// `G92`; with `S` alone it bounds the speed of the spindle.
    pub(crate) fn shift<R: BufRead>(
        &mut self,
        taken: Taken,
        list: &mut Vec<Word>,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let axis = list
            .iter()
            .any(|word| !word.comma && b"XYZABC".contains(&word.letter));
        match position(list, b'S') {
            Some(index) if !axis => {
                list.remove(index);
                self.note("G92 S", "largest speed of the spindle", taken.span, program);
                Ok(())
            }
            _ => Self::add(b'G', 92.0, taken.span, program),
        }
    }
}

/// The whole number of a word.
pub(crate) fn whole(
    word: &Word,
    quantity: &'static str,
    least: u32,
    most: u32,
) -> Result<u32, Fault> {
    let nearest = word.value.round();
    let legal = (f64::from(least)..=f64::from(most)).contains(&nearest);
    if !legal || (word.value - nearest).abs() > 1e-4 {
        let reason = Reason::NotWhole {
            quantity,
            value: word.value,
            least,
            most,
        };
        return Err(Fault::new(word.span, reason));
    }
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole and between two numbers of the type"
    )]
    Ok(nearest as u32)
}
