//! Turns the words of a block into a block of RS274/NGC and what it has not: actions, calls, modes.
//!
//! Source: the operator's manuals of FANUC and Haas. In a block come first the modes, then the motion, then what
//! this dialect alone has, then calls. Not here: the actions themselves.

use crate::block::code::Code;
use crate::block::codes::Motion;
use crate::block::{AXES, Block};
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::fanuc::Fanuc;
use crate::fanuc::codes::{Machine, Special};
use crate::fanuc::words::{Word, words};
use crate::interpreter::Interpreter;
use crate::program::Program;
use crate::text::lexer::Word as Plain;
use crate::text::place::Span;
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
    pub(crate) functions: bool,
    /// Code of tool length, in tenths.
    pub(crate) length: Option<u16>,
    pub(crate) side: bool,
    pub(crate) shift: Option<Taken>,
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
            program.lowering.modal.path_control = crate::block::codes::PathControl::ExactStop;
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
    pub(crate) fn refuse_compensated(taken: &Taken, state: &Interpreter) -> Result<(), Fault> {
        if state
            .compensation
            .as_ref()
            .is_some_and(|on| !on.is_ending())
        {
            let (code, state) = (taken.code, crate::interpreter::non_modal::COMPENSATED);
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

/// The duration of a `P` word, s: with a decimal point in s as Haas has it, else in ms.
pub(crate) fn seconds(word: &Word) -> f64 {
    if word.point {
        word.value
    } else {
        word.value / 1000.0
    }
}
