//! Gives words to what they belong to, and those that are modal to the block that needs them.
//!
//! Source: the operator's manuals of FANUC and Haas. Not here: codes, see `taking`.

use crate::block::Block;
use crate::block::code::Code;
use crate::block::codes::Motion;
use crate::curves::corner_breaks::CornerKind;
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::fanuc::Fanuc;
use crate::fanuc::block::{Asked, position, seconds};
use crate::fanuc::codes::{Machine, Special};
use crate::fanuc::words::Word;
use crate::program::Program;
use crate::text::place::Span;
use std::io::BufRead;

impl Fanuc {
    /// Takes the words of an action, of a call, and of functions of the machine out of the others.
    pub(crate) fn arguments_of(list: &mut Vec<Word>, asked: &mut Asked) -> Vec<Word> {
        let letters: &[u8] = match asked.action.map(|taken| taken.special) {
            Some(Special::SetData) => b"XYZABCLPR",
            Some(Special::Pocket { .. }) => b"XYZIJKQDL",
            Some(Special::Scaling(true)) => b"XYZIJKP",
            Some(Special::Mirror(_)) => b"XYZ",
            Some(Special::Rotation(true)) => b"XYZABCR",
            Some(Special::Scaling(false) | Special::Rotation(false)) => b"",
            Some(Special::OtherHome) => b"XYZABCP",
            Some(_) => b"XYZABC",
            None => b"",
        };
        let called: &[u8] = match asked.call {
            Some((Machine::Return, _)) => b"P",
            Some(_) => b"PLQ",
            None => b"",
        };
        let mut arguments = Vec::new();
        list.retain(|word| {
            let taken =
                !word.comma && (letters.contains(&word.letter) || called.contains(&word.letter));
            if taken {
                arguments.push(*word);
            }
            !taken
        });
        arguments
    }

    /// Words that depend on what is modal, before the block is carried out.
    pub(crate) fn before_motion<R: BufRead>(
        &mut self,
        list: &mut Vec<Word>,
        asked: &mut Asked,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        if let Some(dwell) = asked.dwell {
            Self::dwell(dwell, list, program)?;
        }
        if let Some(system) = asked.system {
            self.select_system(system, list, program)?;
        }
        if let Some(shift) = asked.shift {
            self.shift(shift, list, program)?;
        }
        let modal = program.lowering.modal.motion;
        let axis = list
            .iter()
            .any(|word| !word.comma && b"XYZ".contains(&word.letter));
        if asked.end_cycle && asked.motion.is_none() && (modal.is_cycle() || modal == Motion::Off) {
            program.lowering.modal.motion = self.straight;
        }
        let modal = program.lowering.modal.motion;
        let cycle = match program.block.motion {
            Some(motion) => motion.is_cycle(),
            None => modal.is_cycle() && axis,
        };
        let arc = program.block.motion.unwrap_or(modal).is_arc();
        if cycle {
            Self::cycle_words(list)?;
        } else if asked.functions && !arc && asked.dwell.is_none() {
            list.retain(|word| word.comma || !b"PQREL".contains(&word.letter));
        }
        self.tool_words(list, asked, program)?;
        if self.polar.is_some() && !asked.machine && axis {
            self.straighten(list, program)?;
        }
        if let Some(word) = list.iter().find(|word| !word.comma && word.letter == b'E') {
            let letter = 'E';
            return Err(Fault::new(word.span, Reason::Unused { letter }));
        }
        Ok(())
    }

    /// Repetitions by `K`, and dwells in ms, as cycles have them.
    fn cycle_words(list: &mut [Word]) -> Result<(), Fault> {
        let mut repetitions = None;
        for word in list.iter_mut().filter(|word| !word.comma) {
            match word.letter {
                b'K' | b'L' => {
                    if let Some(letter) = repetitions.replace(char::from(word.letter)) {
                        return Err(Fault::new(word.span, Reason::Repeated { letter }));
                    }
                    word.letter = b'L';
                }
                b'P' => word.value = seconds(word),
                b'Q' => word.value = word.value.abs(),
                _ => {}
            }
        }
        Ok(())
    }

    /// `D` and `H`, which are modal.
    fn tool_words<R: BufRead>(
        &mut self,
        list: &mut Vec<Word>,
        asked: &Asked,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let state = &program.lowering;
        if let Some(index) = position(list, b'D') {
            let word = list[index];
            self.memory.set_letter(b'D', word.value);
            if !asked.side {
                list.remove(index);
                if state
                    .compensation
                    .as_ref()
                    .is_some_and(|on| !on.is_ending())
                {
                    let code = Code::letter(b'D');
                    let state = crate::interpreter::non_modal::COMPENSATED;
                    let reason = MachiningError::NotNow { code, state };
                    return Err(Fault::new(word.span, reason.into()));
                }
            }
        } else if asked.side {
            let span = program
                .block
                .taker(crate::block::codes::Group::CutterCompensation);
            let span = span.map_or(Span::default(), |(_, span)| span);
            list.push(word_of(b'D', self.memory.letter(b'D'), span));
        }
        let given = position(list, b'H');
        if let Some(index) = given {
            self.memory.set_letter(b'H', list[index].value);
        }
        match (asked.length, self.length, given) {
            (Some(490), ..) => {
                self.length = None;
                if let Some(index) = given {
                    list.remove(index);
                }
            }
            (Some(code), ..) => {
                self.length = Some(code);
                if given.is_none() {
                    let span = program.block.taker(crate::block::codes::Group::ToolLength);
                    let span = span.map_or(Span::default(), |(_, span)| span);
                    list.push(word_of(b'H', self.memory.letter(b'H'), span));
                }
            }
            // Another length, of the same kind.
            (None, Some(440), Some(index)) => {
                let span = list[index].span;
                program.block.take_against(Code::new(b'G', 440), span)?;
            }
            (None, Some(code), Some(index)) => {
                let span = list[index].span;
                Self::add(b'G', f64::from(code) / 10.0, span, program)?;
            }
            (None, None, Some(index)) => {
                list.remove(index);
            }
            (None, _, None) => {}
        }
        Ok(())
    }

    /// Takes `,R` and `,C`; false for a word without a comma.
    pub(crate) fn comma_word(word: &Word, block: &mut Block) -> Result<bool, Fault> {
        if !word.comma {
            return Ok(false);
        }
        let kind = match word.letter {
            b'R' => CornerKind::Round,
            b'C' => CornerKind::Chamfer,
            letter => {
                let reason = Reason::WordNotSupported {
                    word: format!(",{}", char::from(letter)).into(),
                    what: "angles and other words of drawings",
                };
                return Err(Fault::new(word.span, reason));
            }
        };
        if block.corner.is_some() {
            let letter = char::from(word.letter);
            return Err(Fault::new(word.span, Reason::Repeated { letter }));
        }
        block.corner = Some((kind, word.value, word.span));
        Ok(true)
    }
}

fn word_of(letter: u8, value: f64, span: Span) -> Word {
    Word {
        letter,
        comma: false,
        value,
        point: false,
        span,
    }
}
