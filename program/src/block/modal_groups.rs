//! Sorts the codes of a block by their modal groups.
//!
//! Source: the modal groups of RS274/NGC. Not here: which code means what, and what a meaning does.

use crate::block::code::Code;
use crate::block::code_table::{Unread, miscellaneous, of_rotary, preparatory};
use crate::block::codes::{Group, Meaning, Motion, ToolLength};
use crate::block::{Block, POINT};
use crate::error::reason::Reason;
use crate::error::{Fault, Notice, Remark};
use crate::interpreter::units::Units;
use crate::settings::Settings;
use crate::text::lexer::Word;
use crate::text::place::Span;

impl Block {
    pub(crate) fn preparatory(
        &mut self,
        word: Word,
        settings: &Settings,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        let code = code_of(word, 1, "a number from 0 to 999 with one decimal at most")?;
        self.count(0, code);
        if self.take_rotary(code, word.span)? {
            return Ok(());
        }
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

    pub(crate) fn miscellaneous(
        &mut self,
        word: Word,
        settings: &Settings,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        let code = code_of(word, 10, "a whole number from 0 to 999")?;
        self.count(1, code);
        if self.take_rotary(code, word.span)? {
            return Ok(());
        }
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

    /// Takes a code that only a machine with rotary axes has.
    fn take_rotary(&mut self, code: Code, span: Span) -> Result<bool, Fault> {
        let known = self
            .rotary
            .then(|| of_rotary(code.initial(), code.tenths().unwrap_or(0)));
        let Some((group, meaning)) = known.flatten() else {
            return Ok(false);
        };
        self.take(group, code, span)?;
        self.set(meaning);
        Ok(true)
    }

    /// Takes a cycle that RS274/NGC has not.
    pub(crate) fn take_cycle(
        &mut self,
        motion: Motion,
        code: Code,
        span: Span,
    ) -> Result<(), Fault> {
        self.note_word();
        self.take_motion(Meaning::Motion(motion), code, span)
    }

    /// Takes a tool length that is taken off.
    pub(crate) fn take_against(&mut self, code: Code, span: Span) -> Result<(), Fault> {
        self.note_word();
        self.take(Group::ToolLength, code, span)?;
        self.tool_length = Some(ToolLength::Against);
        Ok(())
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
            Meaning::EndOfNurbs => {
                self.motion = Some(Motion::Off);
                self.end_of_nurbs = true;
            }
            Meaning::Once(once) => self.once = Some(once),
            Meaning::Side(side) => self.side = Some(side),
            Meaning::ToolLength(length) => self.tool_length = Some(length),
            Meaning::Coordinates(system) => self.coordinates = Some(system),
            Meaning::ReturnToStart(back) => self.return_to_start = Some(back),
            Meaning::ToolChange => self.tool_change = true,
            Meaning::ToolTip(tip) => self.tool_tip = Some(tip),
            Meaning::Saving(saving) => self.saving = Some(saving),
            Meaning::Outside => self.outside = true,
            Meaning::Plane(plane) => self.plane = Some(plane),
            Meaning::Inch => self.units = Some(Units::Inch),
            Meaning::Millimeter => self.units = Some(Units::Millimeter),
            Meaning::Distance(distance) => self.distance = Some(distance),
            Meaning::ArcDistance(distance) => self.arc_distance = Some(distance),
            Meaning::FeedMode(mode) => self.feed_mode = Some(mode),
            Meaning::PathControl(control) => self.path_control = Some(control),
            Meaning::Stop(stop) => self.stop = Some(stop),
            Meaning::Subprogram(which) => self.subprogram = Some(which),
            Meaning::Nothing => {}
        }
    }

    /// Words of a code that is skipped must not be taken for a motion: without a motion word there
    /// is no telling whose they are.
    pub(crate) fn refuse_motion_beside_foreign(&mut self) -> Result<(), Fault> {
        let geometry = self.first_of(&POINT).or(self.first_of(b"IJKR"));
        let taken = self.once.is_some() || self.tool_length.is_some();
        if geometry.is_some()
            && self.motion.is_none()
            && !taken
            && let Some((_, fault)) = self.foreign.take()
        {
            return Err(fault);
        }
        Ok(())
    }
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
        Unread::Carried => Reason::NotSupported {
            code,
            what: "a function of another machine",
        },
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
    if settings.lenient && harmless || unread == Unread::Carried {
        remarks.push((fault.span, Notice::Skipped(fault.reason)));
        Ok(())
    } else {
        Err(fault)
    }
}
