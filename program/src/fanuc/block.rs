//! Turns the words of a block into a block of RS274/NGC and what it has not: actions, calls, modes.
//!
//! Source: the operator's manuals of FANUC and Haas. In a block come first the modes, then the motion, then what
//! this dialect alone has, then calls. Not here: the actions themselves.

use crate::block::{AXES, Block};
use crate::code::Code;
use crate::codes::Motion;
use crate::corners::CornerKind;
use crate::error::Fault;
use crate::fanuc::Fanuc;
use crate::fanuc::codes::{Machine, Special, Use, miscellaneous, preparatory};
use crate::fanuc::words::{Word, words};
use crate::lexer::Word as Plain;
use crate::lower::Lowering;
use crate::machining_error::MachiningError;
use crate::place::Span;
use crate::program::Program;
use crate::reason::Reason;
use std::io::BufRead;

/// A code with its place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Taken {
    pub(crate) special: Special,
    pub(crate) code: Code,
    pub(crate) span: Span,
}

/// What the codes of a block ask for beside the block itself.
#[derive(Debug, Default)]
pub(crate) struct Asked {
    /// What takes axis words for itself.
    pub(crate) action: Option<Taken>,
    pub(crate) exact_stop: bool,
    pub(crate) dwell: Option<Taken>,
    pub(crate) machine: bool,
    pub(crate) end_cycle: bool,
    pub(crate) motion: Option<Motion>,
    pub(crate) system: Option<Taken>,
    pub(crate) call: Option<(Machine, Span)>,
    /// Noted `M` codes, which may have words of their own.
    functions: bool,
    /// Code of tool length, in tenths.
    length: Option<u16>,
    side: bool,
    shift: Option<Taken>,
}

impl Fanuc {
    /// Reads the words of a block and does what they say.
    pub(crate) fn block<R: BufRead>(
        &mut self,
        text: &[u8],
        at: usize,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let mut list = std::mem::take(&mut self.words);
        list.clear();
        let units = program.lowering.modal.units;
        let scope = self.scope(program);
        let read = words(text, at, &scope, units, &mut list);
        if matches!(read, Ok(true)) {
            program.block.features |= crate::block::PARAMETERS;
        }
        let outcome = read.and_then(|_| self.obey_words(&mut list, program));
        self.words = list;
        outcome
    }

    fn obey_words<R: BufRead>(
        &mut self,
        list: &mut Vec<Word>,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        // What stands behind G65 or G66 are arguments.
        let is_call =
            |word: &Word| word.letter == b'G' && !word.comma && (word.value - 65.5).abs() < 0.75;
        if let Some(index) = list.iter().position(is_call) {
            let arguments = list.split_off(index);
            if !list.is_empty() {
                self.plain_block(list, program)?;
            }
            return self.call_macro(&arguments, program);
        }
        let before = program.waiting.len();
        let moves = list.iter().any(|word| b"XYZABC".contains(&word.letter));
        self.plain_block(list, program)?;
        if moves && program.waiting.len() > before {
            self.call_modal(program)?;
        }
        Ok(())
    }

    /// A block without `G65` and `G66`.
    fn plain_block<R: BufRead>(
        &mut self,
        list: &mut Vec<Word>,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let mut asked = Asked::default();
        program.block.begin();
        self.take_codes(list, &mut asked, program)?;
        let arguments = Self::arguments_of(list, &mut asked);
        self.before_motion(list, &mut asked, program)?;
        for word in list.iter() {
            if !Self::comma_word(word, &mut program.block)? {
                Self::add(word.letter, word.value, word.span, program)?;
            }
        }
        self.remember(&program.block);
        let ended = self.carry_out(&asked, program)?;
        if let Some(action) = asked.action {
            self.act(action, &arguments, program)?;
        }
        if ended {
            return program.end();
        }
        match asked.call {
            Some((which, span)) => self.call(which, span, &arguments, program),
            None => Ok(()),
        }
    }

    /// Takes all codes out of the words.
    fn take_codes<R: BufRead>(
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

    /// Takes the words of an action, of a call, and of functions of the machine out of the others.
    fn arguments_of(list: &mut Vec<Word>, asked: &mut Asked) -> Vec<Word> {
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
    fn before_motion<R: BufRead>(
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
                    let state = crate::once::COMPENSATED;
                    let reason = MachiningError::NotNow { code, state };
                    return Err(Fault::new(word.span, reason.into()));
                }
            }
        } else if asked.side {
            let span = program.block.taker(crate::codes::Group::CutterCompensation);
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
                    let span = program.block.taker(crate::codes::Group::ToolLength);
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
    fn comma_word(word: &Word, block: &mut Block) -> Result<bool, Fault> {
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

    pub(crate) fn add<R: BufRead>(
        letter: u8,
        value: f64,
        span: Span,
        program: &mut Program<R>,
    ) -> Result<(), Fault> {
        let word = Plain {
            letter,
            value,
            span,
        };
        let settings = program.lowering.settings;
        program.block.add(word, &settings, &mut program.remarks)
    }

    /// Carries out the block of RS274/NGC; true when the program ends with it.
    fn carry_out<R: BufRead>(
        &mut self,
        asked: &Asked,
        program: &mut Program<R>,
    ) -> Result<bool, Fault> {
        let line = program.flow.line();
        let modal = program.lowering.modal;
        if asked.exact_stop {
            program.lowering.modal.path_control = crate::codes::PathControl::ExactStop;
        }
        // Machine coordinates are reached at rapid.
        let rapid = asked.machine && program.block.motion.is_none();
        if rapid {
            program.lowering.modal.motion = Motion::Rapid;
        }
        let outcome = if program.block.is_empty() {
            Ok(false)
        } else {
            let (block, waiting, remarks) =
                (&program.block, &mut program.waiting, &mut program.remarks);
            program.lowering.block(block, line, waiting, remarks)
        };
        let after = &mut program.lowering.modal;
        if asked.exact_stop {
            let control = program.block.path_control.unwrap_or(modal.path_control);
            after.path_control = control;
        }
        if rapid {
            after.motion = modal.motion;
        }
        if matches!(after.motion, Motion::Rapid | Motion::Line) && !rapid {
            self.straight = after.motion;
        }
        outcome
    }

    /// Keeps what variables tell of the codes and letters of a block.
    fn remember(&mut self, block: &Block) {
        for letter in *b"BFST" {
            if let Some(value) = block.get(letter) {
                self.memory.set_letter(letter, value);
            }
        }
        for (code, group) in block.codes_taken() {
            let number = f64::from(code.tenths().unwrap_or(0)) / 10.0;
            if let Some(index) = group {
                self.memory.groups[index] = number;
            }
        }
        if block.motion.is_some_and(|motion| !motion.is_cycle()) {
            self.memory.groups[9] = 80.0;
        }
    }

    /// Refuses an action while cutter compensation is on.
    pub(crate) fn refuse_compensated(taken: &Taken, state: &Lowering) -> Result<(), Fault> {
        if state
            .compensation
            .as_ref()
            .is_some_and(|on| !on.is_ending())
        {
            let (code, state) = (taken.code, crate::once::COMPENSATED);
            let reason = MachiningError::NotNow { code, state };
            return Err(Fault::new(taken.span, reason.into()));
        }
        Ok(())
    }
}

/// Where a word with a letter stands among words.
pub(crate) fn position(list: &[Word], letter: u8) -> Option<usize> {
    list.iter()
        .position(|word| !word.comma && word.letter == letter)
}

/// The word with a letter among words.
pub(crate) fn word(list: &[Word], letter: u8) -> Option<Word> {
    position(list, letter).map(|index| list[index])
}

/// The axis words among words, in the order of coordinates.
pub(crate) fn axes(list: &[Word]) -> [Option<Word>; 3] {
    AXES.map(|letter| word(list, letter))
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

/// The duration of a `P` word, s: with a decimal point in s as Haas has it, else in ms.
pub(crate) fn seconds(word: &Word) -> f64 {
    if word.point {
        word.value
    } else {
        word.value / 1000.0
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
