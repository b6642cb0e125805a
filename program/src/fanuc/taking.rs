//! Takes the codes of a block out of its words, by what becomes of each.
//!
//! Not here: what they do, and which code is which, see `codes`.

use crate::block::code::Code;
use crate::block::codes::Motion;
use crate::error::Fault;
use crate::error::reason::Reason;
use crate::fanuc::Fanuc;
use crate::fanuc::block::{Asked, Taken};
use crate::fanuc::codes::{Machine, Special, Use, miscellaneous, preparatory};
use crate::fanuc::words::Word;
use crate::program::Program;
use std::io::BufRead;

impl Fanuc {
    /// Takes all codes out of the words.
    pub(crate) fn take_codes<R: BufRead>(
        &mut self,
        list: &mut Vec<Word>,
        asked: &mut Asked,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let mut index = 0;
        while let Some(&word) = list.get(index) {
            if word.comma || !matches!(word.letter, b'G' | b'M') {
                index += 1;
                continue;
            }
            list.remove(index);
            if word.letter == b'M' {
                self.function(word, asked, program)?;
            } else {
                self.code(word, list, asked, program)?;
            }
        }
        Ok(())
    }

    fn code<R: BufRead>(
        &mut self,
        word: Word,
        list: &mut Vec<Word>,
        asked: &mut Asked,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let Some(code) = Code::of_number(b'G', word.value, 1) else {
            let (letter, value) = ('G', word.value);
            let bound = "a number from 0 to 999 with one decimal at most";
            let reason = Reason::NotACode {
                letter,
                value,
                bound,
            };
            return Err(Fault::new(word.span, reason));
        };
        let tenths = code.tenths().unwrap_or_default();
        match preparatory(tenths) {
            Use::Same(same) => {
                asked.motion = match same {
                    0 => Some(Motion::Rapid),
                    10 => Some(Motion::Line),
                    20 => Some(Motion::Clockwise),
                    30 => Some(Motion::CounterClockwise),
                    730.. if same < 900 => Some(Motion::Off),
                    _ => asked.motion,
                };
                match same {
                    430 | 434 | 435 | 490 => asked.length = Some(same),
                    400 | 410 | 420 => asked.side = same != 400,
                    _ => {}
                }
                return Self::add(b'G', f64::from(same) / 10.0, word.span, program);
            }
            Use::Noted(what, letters) => {
                program.block.count(0, code);
                list.retain(|word| word.comma || !letters.contains(&word.letter));
                self.note(&code.to_string(), what, word.span, program);
            }
            Use::Refused(what) => {
                let reason = Reason::NotSupported { code, what };
                return Err(Fault::new(word.span, reason));
            }
            Use::Unknown => return Err(Fault::new(word.span, Reason::UnknownCode { code })),
            Use::Does(special) => {
                let span = word.span;
                let taken = Taken {
                    special,
                    code,
                    span,
                };
                return self.special(taken, list, asked, program);
            }
        }
        Ok(())
    }

    fn special<R: BufRead>(
        &mut self,
        taken: Taken,
        list: &mut Vec<Word>,
        asked: &mut Asked,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let Taken { code, span, .. } = taken;
        let cycle = match taken.special {
            Special::FineBore => Some(Motion::Cycle(76)),
            Special::BackBore => Some(Motion::BackBore),
            _ => None,
        };
        // These become words of RS274/NGC, which are counted there.
        let counted = matches!(
            taken.special,
            Special::Machine | Special::Dwell | Special::System(_) | Special::Shift
        );
        if !counted {
            program.block.count(0, code);
        }
        if let Some(motion) = cycle {
            asked.motion = Some(Motion::Off);
            return program.block.take_cycle(motion, code, span);
        }
        match taken.special {
            Special::ExactStop => asked.exact_stop = true,
            Special::Dwell => asked.dwell = Some(taken),
            Special::Machine => {
                asked.machine = true;
                return Self::add(b'G', 53.0, span, program);
            }
            Special::EndCycle => asked.end_cycle = true,
            Special::AgainstLength => {
                asked.length = Some(440);
                return program.block.take_against(code, span);
            }
            Special::System(_) | Special::Extended | Special::Numbered(_) => {
                if let Some(first) = asked.system {
                    return Err(same_group(&first, &taken, "coordinate system"));
                }
                asked.system = Some(taken);
            }
            Special::Shift => asked.shift = Some(taken),
            Special::Polar(on) => self.set_polar(on, program),
            Special::EndCall => self.end_modal_macro(),
            Special::Mode(mode) => return self.mode(mode, taken, list, program),
            _ => {
                if let Some(first) = asked.action {
                    return Err(same_group(&first, &taken, "codes for one block"));
                }
                asked.action = Some(taken);
            }
        }
        Ok(())
    }

    fn function<R: BufRead>(
        &mut self,
        word: Word,
        asked: &mut Asked,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let span = word.span;
        let number = word.value.round();
        if (word.value - number).abs() > 1e-9 || !(0.0..=9999.0).contains(&number) {
            let reason = Reason::NotACode {
                letter: 'M',
                value: word.value,
                bound: "a whole number from 0 to 9999",
            };
            return Err(Fault::new(span, reason));
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and within the bounds checked above"
        )]
        let number = number as u16;
        self.memory.set_letter(b'M', f64::from(number));
        let code = Code::of_number(b'M', f64::from(number), 10);
        let which = miscellaneous(number);
        if which == Machine::Same {
            return Self::add(b'M', f64::from(number), span, program);
        }
        if let Some(code) = code {
            program.block.count(1, code);
        }
        match which {
            Machine::Refused(what) => {
                let word = format!("M{number}").into();
                return Err(Fault::new(span, Reason::WordNotSupported { word, what }));
            }
            Machine::Noted => {
                asked.functions = true;
                self.note(
                    &format!("M{number}"),
                    "a function of the machine",
                    span,
                    program,
                );
            }
            _ if asked.call.is_some() => {
                let word = format!("M{number}").into();
                let what = "two calls or returns in one block";
                return Err(Fault::new(span, Reason::WordNotSupported { word, what }));
            }
            _ => asked.call = Some((which, span)),
        }
        Ok(())
    }
}

fn same_group(first: &Taken, second: &Taken, group: &'static str) -> Fault {
    let (first, code) = (first.code, second.code);
    let reason = Reason::SameGroup {
        first,
        second: code,
        group,
    };
    Fault::new(second.span, reason)
}
