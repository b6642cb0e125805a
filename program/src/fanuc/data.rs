//! Writes data of the control: work offsets and tool offsets.
//!
//! Source: `G10` of the operator's manuals of FANUC and Haas; with `G91` values are added. Not here: parameters
//! of the control, which are refused by name.

use crate::block::codes::Distance;
use crate::error::Fault;
use crate::error::reason::Reason;
use crate::fanuc::Fanuc;
use crate::fanuc::actions::length;
use crate::fanuc::block::{Taken, axes, word};
use crate::fanuc::memory::EXTENDED;
use crate::fanuc::modes::whole;
use crate::fanuc::words::Word;
use crate::interpreter::offsets::{axis_number, origin};
use crate::interpreter::tools::Tool;
use crate::program::Program;
use std::io::BufRead;
use toolglide_kinematics::Vector;

/// Kinds of data that are written.
const KINDS: [f64; 6] = [2.0, 20.0, 10.0, 11.0, 12.0, 13.0];

/// Largest number of a tool offset.
const LARGEST_OFFSET: u32 = 9999;

impl Fanuc {
    /// `G10 L2`, `L20`, and `L10` to `L13`.
    pub(crate) fn set_data<R: BufRead>(
        &mut self,
        taken: Taken,
        words: &[Word],
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let missing = |letter| {
            let code = taken.code;
            Fault::new(taken.span, Reason::WordMissing { code, letter })
        };
        let kind = word(words, b'L').ok_or_else(|| missing('L'))?;
        if !KINDS.iter().any(|one| (one - kind.value).abs() < 0.5) {
            let code = taken.code;
            let what = "data other than work offsets (L2 L20) and tool offsets (L10 to L13)";
            return Err(Fault::new(kind.span, Reason::NotSupported { code, what }));
        }
        let number = word(words, b'P').ok_or_else(|| missing('P'))?;
        if let Some(turned) = words
            .iter()
            .find(|word| b"ABC".contains(&word.letter) && word.value != 0.0)
        {
            let word = char::from(turned.letter).to_string().into();
            let what = "work offsets of rotary axes";
            return Err(Fault::new(
                turned.span,
                Reason::WordNotSupported { word, what },
            ));
        }
        let added = program.lowering.modal.distance == Distance::Incremental;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "one of the kinds"
        )]
        let kind = kind.value.round() as u8;
        match kind {
            2 => {
                let system = whole(&number, "work offset", 0, 6)?;
                let system = u8::try_from(system).unwrap_or(0);
                for (axis, word) in axes(words).into_iter().enumerate() {
                    let Some(word) = word else {
                        continue;
                    };
                    let value = length(&word, program)?;
                    let state = &mut program.lowering;
                    if system == 0 {
                        let mut common = state.offsets.common();
                        common[axis] = value + if added { common[axis] } else { 0.0 };
                        state.set_common(common);
                    } else {
                        let place = origin(system) + axis_number(axis);
                        let before = if added {
                            state.parameters.get(place)
                        } else {
                            0.0
                        };
                        state.parameters.put(place, before + value);
                    }
                }
                if system > 0 {
                    program.lowering.take_again(system);
                    let state = &mut program.lowering;
                    state.program = state.offsets.in_program(state.position);
                }
                Ok(())
            }
            20 => {
                let index = whole(&number, "additional work offset", 1, EXTENDED)?;
                let mut origin = self
                    .memory
                    .extended
                    .get(&index)
                    .copied()
                    .unwrap_or_default();
                for (axis, word) in axes(words).into_iter().enumerate() {
                    if let Some(word) = word {
                        let before = if added { origin[axis] } else { 0.0 };
                        origin[axis] = before + length(&word, program)?;
                    }
                }
                self.memory.extended.insert(index, origin);
                if self.memory.in_force == index {
                    self.memory.select_extended(index, &mut program.lowering);
                }
                Ok(())
            }
            which => {
                let index = whole(&number, "tool offset", 1, LARGEST_OFFSET)?;
                let value = word(words, b'R').ok_or_else(|| missing('R'))?;
                let value = length(&value, program)?;
                self.set_tool(which, index, value, added, program);
                Ok(())
            }
        }
    }

    /// Length (`L10`), its wear (`L11`), radius (`L12`) or its wear (`L13`) of a tool, mm.
    fn set_tool<R: BufRead>(
        &mut self,
        which: u8,
        index: u32,
        value: f64,
        added: bool,
        program: &mut Program<R>,
    ) {
        let none = Tool {
            offset: Vector::zeros(),
            diameter: 0.0,
        };
        let tools = &mut program.lowering.tools;
        let mut tool = tools.get(index).unwrap_or(none);
        let wear = self.wear.entry(index).or_default();
        let before = |value: f64| if added { value } else { 0.0 };
        let (length, radius) = (tool.offset[2] - wear[0], 0.5 * tool.diameter - wear[1]);
        let (mut new_length, mut new_radius) = (length, radius);
        match which {
            10 => new_length = value + before(length),
            11 => wear[0] = value + before(wear[0]),
            12 => new_radius = value + before(radius),
            _ => wear[1] = value + before(wear[1]),
        }
        tool.offset[2] = new_length + wear[0];
        tool.diameter = 2.0 * (new_radius + wear[1]);
        tools.set(index, tool);
    }
}
