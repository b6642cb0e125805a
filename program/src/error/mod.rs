//! Carries a refusal or a warning with its place.
//!
//! Not here: what can be wrong, see [`Reason`].

pub(crate) mod arithmetic;
pub(crate) mod cascading_errors;
pub(crate) mod flow;
pub(crate) mod machining;
pub(crate) mod reason;
pub(crate) mod statement;

use crate::text::place::{Place, Span};
use reason::Reason;
use thiserror::Error;

/// Why a program is refused, and where.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{place}: {reason}")]
pub struct ProgramError {
    place: Place,
    reason: Reason,
    consequence: bool,
}

impl ProgramError {
    pub(crate) fn new(place: Place, reason: Reason) -> Self {
        Self {
            place,
            reason,
            consequence: false,
        }
    }

    /// The same refusal, as a consequence of one before it.
    pub(crate) fn following(mut self, consequence: bool) -> Self {
        self.consequence = consequence;
        self
    }

    /// Whether it may be a mere consequence of a refusal before it: the refused line would have set what
    /// is missing here, or would have brought the tool to where this line begins.
    #[must_use]
    pub fn is_consequence(&self) -> bool {
        self.consequence
    }

    /// Where it stands, with file, line, column and word.
    #[must_use]
    pub fn place(&self) -> &Place {
        &self.place
    }

    /// What is wrong.
    #[must_use]
    pub fn reason(&self) -> &Reason {
        &self.reason
    }

    /// Name of the file, as it was given.
    #[must_use]
    pub fn file(&self) -> &str {
        self.place.file()
    }

    /// Line, counted from 1.
    #[must_use]
    pub fn line(&self) -> u64 {
        self.place.line()
    }

    /// Column, counted in characters from 1.
    #[must_use]
    pub fn column(&self) -> u32 {
        self.place.column()
    }

    /// How many characters a caret should underline, at least one.
    #[must_use]
    pub fn length(&self) -> u32 {
        self.place.length()
    }

    /// The offending word as it was written; empty where a whole line or file is at fault.
    #[must_use]
    pub fn word(&self) -> &str {
        self.place.word()
    }
}

/// What a warning says.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Notice {
    /// A word was skipped that would have been refused by strict reading; no axis depends on it.
    #[error("skipped: {0}")]
    Skipped(Reason),
    /// A word that was read and that moves no axis; said once for each.
    #[error("{word} is noted, and moves no axis: {what}")]
    Noted {
        /// The word.
        word: Box<str>,
        /// What it stands for.
        what: &'static str,
    },
    /// The program ends where the next one of the file begins.
    #[error("program O{number} begins here, so the one before it ends without M30")]
    NextProgram {
        /// Number of the program that begins.
        number: u32,
    },
    /// A dwell so long that its unit may be meant otherwise.
    #[error("stands still for {seconds} s: {}", if *milliseconds { "is that meant?" } else { "P is in seconds here; --dialect fanuc reads it in milliseconds" })]
    LongDwell {
        /// How long, s.
        seconds: f64,
        /// Whether the dialect counts in milliseconds.
        milliseconds: bool,
    },
    /// The length or the radius of a tool is asked for, but there is no tool table.
    #[error("there is no tool table, so tool {tool} counts as a point at the spindle")]
    NoToolTable {
        /// The tool.
        tool: u32,
    },
    /// A word for an axis that the machine has not says that it is where it always is.
    #[error("axis {letter} is not there, and its words that say 0 move nothing")]
    AbsentAxis {
        /// The letter.
        letter: char,
    },
    /// An arc whose coordinates were rounded so that its ends are on two circles; said once.
    #[error(
        "the radii at start and end of this arc differ by {mismatch:.4} mm, as rounded coordinates make them; the centre of such arcs is moved"
    )]
    RoundedArc {
        /// By how much they differ, mm.
        mismatch: f64,
    },
    /// A feedrate from before `G93` is used behind `G94`.
    #[error(
        "the feedrate of {feedrate} mm/min from before G93 holds again; LinuxCNC wants it written anew"
    )]
    OldFeedrate {
        /// The feedrate, mm/min.
        feedrate: f64,
    },
    /// `G64 P0`.
    #[error(
        "P0 leaves no room at corners, so that every move ends in rest, as with G61; LinuxCNC reads it as no bound at all: write G64 alone for that"
    )]
    NoTolerance,
    /// `F` stands in the block that changes the units, and is read in those before it.
    #[error(
        "F is read in {former} a minute, because it takes effect before the units of its block"
    )]
    FeedBeforeUnits {
        /// Name of the units until this block.
        former: &'static str,
    },
}

/// Something that a reader of the result should know, and where it stands.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{place}: {notice}")]
pub struct Warning {
    place: Place,
    notice: Notice,
    text: Box<str>,
}

impl Warning {
    pub(crate) fn new(place: Place, notice: Notice, line: &[u8]) -> Self {
        let text = String::from_utf8_lossy(line).into();
        Self {
            place,
            notice,
            text,
        }
    }

    /// The line that it speaks of.
    #[must_use]
    pub fn line_text(&self) -> &str {
        &self.text
    }

    /// Where it stands.
    #[must_use]
    pub fn place(&self) -> &Place {
        &self.place
    }

    /// What it says.
    #[must_use]
    pub fn notice(&self) -> &Notice {
        &self.notice
    }
}

/// A refusal inside a line, before file and line are known.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    pub(crate) span: Span,
    pub(crate) reason: Reason,
}

impl Fault {
    pub(crate) fn new(span: Span, reason: Reason) -> Self {
        Self { span, reason }
    }
}

/// A warning inside a line, before file and line are known.
pub(crate) type Remark = (Span, Notice);
