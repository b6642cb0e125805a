//! One line of words as a block: what each code means, and no two that exclude each other.
//!
//! Source: the modal groups of RS274/NGC. Not here: the modal state, and which words a code needs.

use crate::codes::{
    Code, Distance, FeedMode, Group, Meaning, Motion, PathControl, Plane, Stop, Unread,
    miscellaneous, preparatory, unread_letter,
};
use crate::error::{Fault, Notice, Remark};
use crate::lexer::{Lexer, Word};
use crate::place::Span;
use crate::reason::Reason;
use crate::settings::Settings;
use crate::units::Units;

/// Letters of the axes, in the order of coordinates.
pub(crate) const AXES: [u8; 3] = *b"XYZ";

/// Letters of the offsets of a centre, in the order of coordinates.
pub(crate) const OFFSETS: [u8; 3] = *b"IJK";

/// Number of letters.
const LETTERS: usize = 26;

/// The words of one line.
///
/// One block is reused for all lines, so that reading allocates nothing.
#[derive(Debug)]
pub(crate) struct Block {
    present: u32,
    values: [f64; LETTERS],
    spans: [Span; LETTERS],
    taken: u32,
    takers: [(Code, Span); Group::COUNT],
    /// Code that strict reading refuses, with its reason; lenient reading skips it.
    foreign: Option<(Code, Fault)>,
    words: u32,
    pub(crate) motion: Option<Motion>,
    pub(crate) dwell: bool,
    pub(crate) plane: Option<Plane>,
    pub(crate) units: Option<Units>,
    pub(crate) distance: Option<Distance>,
    pub(crate) arc_distance: Option<Distance>,
    pub(crate) feed_mode: Option<FeedMode>,
    pub(crate) path_control: Option<PathControl>,
    pub(crate) stop: Option<Stop>,
}

impl Block {
    pub(crate) fn new() -> Self {
        Self {
            present: 0,
            values: [0.0; LETTERS],
            spans: [Span::default(); LETTERS],
            taken: 0,
            takers: [(Code::new(b'G', 0), Span::default()); Group::COUNT],
            foreign: None,
            words: 0,
            motion: None,
            dwell: false,
            plane: None,
            units: None,
            distance: None,
            arc_distance: None,
            feed_mode: None,
            path_control: None,
            stop: None,
        }
    }

    fn clear(&mut self) {
        self.present = 0;
        self.taken = 0;
        self.foreign = None;
        self.words = 0;
        self.motion = None;
        self.dwell = false;
        self.plane = None;
        self.units = None;
        self.distance = None;
        self.arc_distance = None;
        self.feed_mode = None;
        self.path_control = None;
        self.stop = None;
    }

    /// Replaces the block by the words of `line`.
    pub(crate) fn read(
        &mut self,
        line: &[u8],
        settings: &Settings,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        self.clear();
        let mut lexer = Lexer::new(line);
        while let Some(word) = lexer.word()? {
            self.words += 1;
            match word.letter {
                b'G' => self.preparatory(word, settings, remarks)?,
                b'M' => self.miscellaneous(word, settings, remarks)?,
                _ => self.value(word, settings, remarks)?,
            }
        }
        self.refuse_motion_beside_foreign()
    }

    /// Number of words, line number included.
    pub(crate) fn words(&self) -> u32 {
        self.words
    }

    /// Whether a word with `letter` stands in the block.
    pub(crate) fn has(&self, letter: u8) -> bool {
        self.present & bit(letter) != 0
    }

    /// The first of `letters` that stands in the block.
    pub(crate) fn first_of(&self, letters: &[u8]) -> Option<u8> {
        letters.iter().copied().find(|&letter| self.has(letter))
    }

    /// The number after `letter`, as written.
    pub(crate) fn get(&self, letter: u8) -> Option<f64> {
        self.has(letter).then(|| self.values[index(letter)])
    }

    /// Where the word with `letter` stands, if it does.
    pub(crate) fn span(&self, letter: u8) -> Span {
        self.spans[index(letter)]
    }

    /// The code of a group in this block, and where it stands.
    pub(crate) fn taker(&self, group: Group) -> Option<(Code, Span)> {
        (self.taken & 1 << group as u32 != 0).then(|| self.takers[group as usize])
    }

    /// A code skipped by lenient reading.
    pub(crate) fn foreign(&self) -> Option<Code> {
        self.foreign.as_ref().map(|(code, _)| *code)
    }

    fn value(
        &mut self,
        word: Word,
        settings: &Settings,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        let letter = char::from(word.letter);
        if self.has(word.letter) {
            return Err(Fault::new(word.span, Reason::Repeated { letter }));
        }
        let axis = AXES.iter().position(|&axis| axis == word.letter);
        if axis.is_some_and(|axis| !settings.axes[axis]) {
            return Err(Fault::new(word.span, Reason::NoSuchAxis { letter }));
        }
        if let Some(unread) = unread_letter(word.letter) {
            let fault = unread_fault(Code::letter(word.letter), word.span, unread);
            return skip(fault, unread, settings, remarks);
        }
        if word.letter == b'N' && word.value < 0.0 {
            let quantity = "line number";
            let value = word.value;
            return Err(Fault::new(word.span, Reason::Negative { quantity, value }));
        }
        self.present |= bit(word.letter);
        self.values[index(word.letter)] = word.value;
        self.spans[index(word.letter)] = word.span;
        Ok(())
    }

    fn preparatory(
        &mut self,
        word: Word,
        settings: &Settings,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        let code = code_of(word, 1, "a number from 0 to 999 with one decimal at most")?;
        match preparatory(code.tenths().unwrap_or_default()) {
            Ok((Group::Motion, meaning)) => self.take_motion(meaning, code, word.span),
            Ok((group, meaning)) => {
                self.take(group, code, word.span)?;
                self.set(meaning);
                Ok(())
            }
            Err(unread) => {
                let fault = unread_fault(code, word.span, unread);
                skip(fault, unread, settings, remarks)
            }
        }
    }

    fn miscellaneous(
        &mut self,
        word: Word,
        settings: &Settings,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        let code = code_of(word, 10, "a whole number from 0 to 999")?;
        match miscellaneous(code.tenths().unwrap_or_default()) {
            Ok((group, meaning)) => {
                self.take(group, code, word.span)?;
                if code == Code::new(b'M', 90) {
                    // Off excludes both kinds of coolant.
                    self.take(Group::SecondCoolant, code, word.span)?;
                }
                self.set(meaning);
                Ok(())
            }
            Err(unread) => {
                let fault = unread_fault(code, word.span, unread);
                skip(fault.clone(), unread, settings, remarks)?;
                self.foreign.get_or_insert((code, fault));
                Ok(())
            }
        }
    }

    fn take(&mut self, group: Group, code: Code, span: Span) -> Result<(), Fault> {
        if let Some((first, _)) = self.taker(group) {
            return Err(Fault::new(
                span,
                Reason::SameGroup {
                    first,
                    second: code,
                    group: group.name(),
                },
            ));
        }
        self.taken |= 1 << group as u32;
        self.takers[group as usize] = (code, span);
        Ok(())
    }

    /// Beside another motion code `G80` has nothing to say: headers of programs often cancel a
    /// cycle and begin a motion in one block.
    fn take_motion(&mut self, meaning: Meaning, code: Code, span: Span) -> Result<(), Fault> {
        let cancels = meaning == Meaning::Motion(Motion::Off);
        if cancels && self.motion.is_some() {
            return Ok(());
        }
        if self.motion == Some(Motion::Off) {
            self.taken &= !(1 << Group::Motion as u32);
        }
        self.take(Group::Motion, code, span)?;
        self.set(meaning);
        Ok(())
    }

    fn set(&mut self, meaning: Meaning) {
        match meaning {
            Meaning::Motion(motion) => self.motion = Some(motion),
            Meaning::Dwell => self.dwell = true,
            Meaning::Plane(plane) => self.plane = Some(plane),
            Meaning::Inch => self.units = Some(Units::Inch),
            Meaning::Millimeter => self.units = Some(Units::Millimeter),
            Meaning::Distance(distance) => self.distance = Some(distance),
            Meaning::ArcDistance(distance) => self.arc_distance = Some(distance),
            Meaning::FeedMode(mode) => self.feed_mode = Some(mode),
            Meaning::PathControl(control) => self.path_control = Some(control),
            Meaning::Stop(stop) => self.stop = Some(stop),
            Meaning::Nothing => {}
        }
    }

    /// Words of a code that is skipped must not be taken for a motion: without a motion word there
    /// is no telling whose they are.
    fn refuse_motion_beside_foreign(&mut self) -> Result<(), Fault> {
        let geometry = self.first_of(&AXES).or(self.first_of(b"IJKR"));
        if geometry.is_some()
            && self.motion.is_none()
            && let Some((_, fault)) = self.foreign.take()
        {
            return Err(fault);
        }
        Ok(())
    }
}

/// Letters come from the lexer in upper case.
fn index(letter: u8) -> usize {
    usize::from(letter.wrapping_sub(b'A')).min(LETTERS - 1)
}

fn bit(letter: u8) -> u32 {
    1 << index(letter)
}

fn code_of(word: Word, step: u16, bound: &'static str) -> Result<Code, Fault> {
    Code::of_number(word.letter, word.value, step).ok_or_else(|| {
        Fault::new(
            word.span,
            Reason::NotACode {
                letter: char::from(word.letter),
                value: word.value,
                bound,
            },
        )
    })
}

fn unread_fault(code: Code, span: Span, unread: Unread) -> Fault {
    let reason = match unread {
        Unread::Known(what) | Unread::Harmless(what) => Reason::NotSupported { code, what },
        Unread::Unknown | Unread::UnknownHarmless => Reason::UnknownCode { code },
    };
    Fault::new(span, reason)
}

/// Turns a refusal into a remark where that is wanted and cannot change the motion.
fn skip(
    fault: Fault,
    unread: Unread,
    settings: &Settings,
    remarks: &mut Vec<Remark>,
) -> Result<(), Fault> {
    let harmless = matches!(unread, Unread::Harmless(_) | Unread::UnknownHarmless);
    if settings.lenient && harmless {
        remarks.push((fault.span, Notice::Skipped(fault.reason)));
        Ok(())
    } else {
        Err(fault)
    }
}
