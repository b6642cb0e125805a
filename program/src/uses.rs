//! Every word of a block must be used by one code of it, and by no two.
//!
//! Source: RS274/NGC, where a word without a use is an error. Not here: what the words say.

use crate::block::{AXES, Block};
use crate::codes::{Code, Group, Motion, PathControl};
use crate::error::Fault;
use crate::place::Span;
use crate::reason::Reason;

/// The motion that the axis words of a block make, if any; `mode` is the modal one before it.
pub(crate) fn motion_of(block: &Block, mode: Motion) -> Result<Option<Motion>, Fault> {
    let axis = block.first_of(&AXES);
    match block.motion {
        Some(Motion::Off) => match axis {
            Some(letter) => Err(unused(block, letter)),
            None => Ok(None),
        },
        Some(motion) => Ok((axis.is_some() || motion.is_arc()).then_some(motion)),
        None => {
            let offset = || block.first_of(b"IJKR").filter(|_| mode.is_arc());
            let Some(letter) = axis.or_else(offset) else {
                return Ok(None);
            };
            if block.dwell {
                return Err(unused(block, letter));
            }
            if mode == Motion::Off {
                let reason = Reason::NoMotionMode {
                    letter: char::from(letter),
                };
                return Err(Fault::new(block.span(letter), reason));
            }
            Ok(Some(mode))
        }
    }
}

/// Refuses words without a use.
pub(crate) fn check(block: &Block, motion: Option<Motion>) -> Result<(), Fault> {
    let arc = motion.filter(|motion| motion.is_arc());
    if arc.is_none()
        && let Some(letter) = block.first_of(b"IJKR")
    {
        return Err(unused(block, letter));
    }
    let blends = block.path_control == Some(PathControl::Blend);
    let blend = block
        .taker(Group::PathControl)
        .filter(|_| blends)
        .map(|(code, _)| code);
    let dwell = block.dwell.then(|| Code::new(b'G', 40));
    if block.has(b'P') {
        let mut users = [dwell, blend, arc.map(Motion::code), block.foreign()]
            .into_iter()
            .flatten();
        match (users.next(), users.next()) {
            (None, _) => return Err(unused(block, b'P')),
            (Some(first), Some(second)) => {
                let letter = 'P';
                let reason = Reason::Ambiguous {
                    letter,
                    first,
                    second,
                };
                return Err(Fault::new(block.span(b'P'), reason));
            }
            (Some(_), None) => {}
        }
    }
    if block.has(b'Q') && blend.or(block.foreign()).is_none() {
        return Err(unused(block, b'Q'));
    }
    Ok(())
}

/// Where the cause of the motion stands: its code, or its first word.
pub(crate) fn motion_span(block: &Block) -> Span {
    match (block.taker(Group::Motion), block.first_of(b"XYZIJKR")) {
        (Some((_, span)), _) => span,
        (None, Some(letter)) => block.span(letter),
        (None, None) => Span::default(),
    }
}

fn unused(block: &Block, letter: u8) -> Fault {
    let reason = Reason::Unused {
        letter: char::from(letter),
    };
    Fault::new(block.span(letter), reason)
}
