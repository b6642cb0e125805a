//! Checks that every word of a block is used by exactly one code.
//!
//! Source: RS274/NGC, where a word without a use is an error. Not here: what the words say.

use crate::block::code::Code;
use crate::block::codes::{Group, Motion, Once, PathControl, Side, Subprogram, ToolLength};
use crate::block::{Block, POINT};
use crate::error::reason::Reason;
use crate::error::{Fault, Notice, Remark};
use crate::settings::Settings;
use crate::text::place::Span;

/// Letters that need a code that uses them.
const SHARED: [u8; 10] = *b"PQRIJKLDHE";

impl Motion {
    /// Whether the motion has a use for a word beside those of the axes.
    fn uses(self, letter: u8) -> bool {
        let letters: &[u8] = match self {
            Self::Off | Self::Rapid | Self::Line => b"",
            Self::Clockwise | Self::CounterClockwise => b"PIJKR",
            Self::Cubic => b"IJPQ",
            Self::Quadratic => b"IJ",
            Self::Nurbs => b"PL",
            Self::Knots => b"PKRQ",
            Self::Cycle(73 | 83) => b"RLQP",
            Self::Cycle(81 | 85) => b"RL",
            Self::Cycle(76) | Self::BackBore => b"RLPQIJ",
            Self::Cycle(87) => b"RLIJK",
            Self::Cycle(_) => b"RLP",
        };
        letters.contains(&letter)
    }
}

/// The code other than a motion that takes the axis words of a block.
fn taker_of_axes(block: &Block) -> Option<Code> {
    let once = match block.once {
        Some(Once::SetData | Once::GoHome(_) | Once::Shift | Once::LocalShift) => {
            block.taker(Group::NonModal)
        }
        _ => None,
    };
    let length = match block.tool_length {
        Some(ToolLength::Given | ToolLength::Added) => block.taker(Group::ToolLength),
        _ => None,
    };
    once.or(length).map(|(code, _)| code)
}

/// The motion that the axis words of a block make, if any; `mode` is the modal one before it.
pub(crate) fn motion_of(block: &Block, mode: Motion) -> Result<Option<Motion>, Fault> {
    let axis = block.first_of(&POINT);
    if let Some(taker) = taker_of_axes(block) {
        return match (block.motion, axis) {
            (None | Some(Motion::Off), _) => Ok(None),
            (Some(motion), Some(letter)) => Err(ambiguous(block, letter, motion.code(), taker)),
            (Some(motion), None) => Ok(motion.is_arc().then_some(motion)),
        };
    }
    match block.motion {
        Some(Motion::Off) => match axis {
            Some(letter) => Err(unused(block, letter)),
            None => Ok(None),
        },
        Some(motion) => {
            let spline = matches!(motion, Motion::Nurbs | Motion::Knots);
            let alone = motion.is_arc() || spline || motion.is_cycle();
            Ok((axis.is_some() || alone).then_some(motion))
        }
        None => {
            let offset = || block.first_of(b"IJKR").filter(|_| mode.is_arc());
            let knot = || block.first_of(b"K").filter(|_| mode == Motion::Knots);
            let Some(letter) = axis.or_else(offset).or_else(knot) else {
                return Ok(None);
            };
            if block.once == Some(Once::Dwell) {
                if !matches!(letter, b'X' | b'U') || block.has(b'P') {
                    return Err(unused(block, letter));
                }
                let word = char::from(letter).to_string().into();
                let what = "the duration of a dwell is P here; --dialect fanuc reads X and U";
                let reason = Reason::WordNotSupported { word, what };
                return Err(Fault::new(block.span(letter), reason));
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
pub(crate) fn check(
    block: &Block,
    motion: Option<Motion>,
    settings: &Settings,
    remarks: &mut Vec<Remark>,
) -> Result<(), Fault> {
    let Some(_) = block.first_of(&SHARED) else {
        return Ok(());
    };
    for letter in SHARED.into_iter().filter(|&letter| block.has(letter)) {
        let mut users = users(block, motion, letter);
        match (users.next(), users.next()) {
            (Some(_), None) => {}
            (Some(first), Some(second)) => return Err(ambiguous(block, letter, first, second)),
            (None, _) => {
                let what = match letter {
                    b'D' => "number of a cutter radius or a speed",
                    b'E' if block.printer => continue,
                    b'E' => "the extruder of a printer, which this program does not seem to be for",
                    b'H' => "number of a tool length",
                    b'L' => "count of repetitions",
                    _ => return Err(unused(block, letter)),
                };
                let code = Code::letter(letter);
                let reason = Reason::NotSupported { code, what };
                let span = block.span(letter);
                if !settings.lenient || letter == b'E' {
                    return Err(Fault::new(span, reason));
                }
                remarks.push((span, Notice::Skipped(reason)));
            }
        }
    }
    Ok(())
}

/// The codes of a block that have a use for a word.
fn users(block: &Block, motion: Option<Motion>, letter: u8) -> impl Iterator<Item = Code> {
    let group = |group, letters: &[u8]| {
        let taker = letters.contains(&letter).then(|| block.taker(group));
        taker.flatten().map(|(code, _)| code)
    };
    let once = match block.once {
        Some(Once::Dwell) => group(Group::NonModal, b"P"),
        Some(Once::SetData) => group(Group::NonModal, b"LPRIJQ"),
        _ => None,
    };
    let control = match block.path_control {
        Some(PathControl::Blend) => group(Group::PathControl, b"PQ"),
        _ => None,
    };
    let side = match block.side {
        Some(Side::Left | Side::Right) => group(Group::CutterCompensation, b"D"),
        Some(Side::LeftOf | Side::RightOf) => group(Group::CutterCompensation, b"DL"),
        _ => None,
    };
    let length = match block.tool_length {
        None if block.tool_tip == Some(true) => group(Group::ToolLength, b"H"),
        Some(ToolLength::Table | ToolLength::Added | ToolLength::Against) => {
            group(Group::ToolLength, b"H")
        }
        _ => None,
    };
    let outside = group(Group::Outside, b"PQLER").or(group(Group::Overrides, b"P"));
    let subprogram = match block.subprogram {
        Some(Subprogram::Call) => group(Group::Stop, b"PL"),
        _ => None,
    };
    let motion = motion
        .filter(|motion| motion.uses(letter))
        .map(Motion::code);
    let foreign = block.foreign().filter(|_| b"PQ".contains(&letter));
    [
        once, control, motion, side, length, outside, subprogram, foreign,
    ]
    .into_iter()
    .flatten()
}

/// Where the cause of the motion stands: its code, or its first word.
pub(crate) fn motion_span(block: &Block) -> Span {
    match (
        block.taker(Group::Motion),
        block.first_of(b"XYZ@^ABCUVWIJKR"),
    ) {
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

fn ambiguous(block: &Block, letter: u8, first: Code, second: Code) -> Fault {
    let reason = Reason::Ambiguous {
        letter: char::from(letter),
        first,
        second,
    };
    Fault::new(block.span(letter), reason)
}
