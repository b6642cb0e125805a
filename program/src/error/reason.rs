//! Names every fault of a program.
//!
//! Lengths are in mm and feedrates in mm/s where they are named so, since a refusal about geometry
//! comes after the conversion of units; anything else is as written.

use crate::block::code::Code;
use crate::error::arithmetic::ArithmeticError;
use crate::error::flow::FlowError;
use crate::error::machining::MachiningError;
use crate::error::statement::StatementError;
use std::sync::Arc;
use thiserror::Error;
use toolglide_kinematics::ToolpathError;
use toolglide_kinematics::numeric::{LARGEST_QUANTITY, MIN_QUANTITY};

/// Why a word, a line or a file is refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Reason {
    /// The file cannot be read.
    #[error("cannot be read: {message}")]
    Unreadable {
        /// Kind of the failure.
        kind: std::io::ErrorKind,
        /// What the system says.
        message: Box<str>,
    },
    /// A line is longer than a line may be.
    #[error("line is longer than {bound} bytes")]
    LineTooLong {
        /// Largest length of a line, bytes.
        bound: usize,
    },
    /// A file whose characters have two bytes.
    #[error("this is a text in UTF-16; text is read in ASCII and UTF-8, so save it as one of them")]
    Utf16,
    /// A whole file in a language that is known, and not read.
    #[error("this is {language}, which is not read")]
    LanguageNotRead {
        /// The language.
        language: &'static str,
    },
    /// A control byte: this is not a text.
    #[error(
        "byte 0x{byte:02x} does not belong into a text; {}",
        if *byte == b'\r' { "lines end in LF or CR LF, and not in CR alone" } else { "is this a binary file?" }
    )]
    ControlByte {
        /// The byte.
        byte: u8,
    },
    /// A character that begins no word.
    #[error("character {character:?} begins no word")]
    BadCharacter {
        /// The character.
        character: char,
    },
    /// A comment without its end.
    #[error("comment is not closed: \")\" is missing on this line")]
    CommentNotClosed,
    /// A comment inside a comment.
    #[error("\"(\" inside a comment: comments do not nest")]
    CommentNested,
    /// The end of a comment without its beginning.
    #[error("\")\" without \"(\"")]
    CommentNotOpened,
    /// `%` with something beside it.
    #[error("\"%\" must stand alone on its line")]
    PercentNotAlone,
    /// A number without a letter.
    #[error("a number without a letter before it")]
    LetterMissing,
    /// A letter without a number.
    #[error("{letter} needs a number after it")]
    NumberMissing {
        /// The letter.
        letter: char,
    },
    /// A number too large for a float of 64 bits.
    #[error("a number out of range after {letter}: the largest is about 1.8e308")]
    NumberOutOfRange {
        /// The letter before it.
        letter: char,
    },
    /// A number with an exponent, which would be taken for a word E.
    #[error(
        "the number after {letter} has an exponent, which numbers here have not; write its decimals, and a blank before a word E"
    )]
    Exponent {
        /// The letter before it; `#` for a parameter.
        letter: char,
    },
    /// A part of the language that is not read.
    #[error("{what} are not supported")]
    SyntaxNotSupported {
        /// Its name, in the plural.
        what: &'static str,
    },
    /// A code or a word that is known, but not read.
    #[error("{code} is not supported: {what}")]
    NotSupported {
        /// The code.
        code: Code,
        /// What it stands for.
        what: &'static str,
    },
    /// A `G` or `M` code that nobody knows.
    #[error("{code} is not known")]
    UnknownCode {
        /// The code.
        code: Code,
    },
    /// A word that the dialect of the program does not know.
    #[error("{word} is not supported in this dialect")]
    UnknownWord {
        /// The word.
        word: Box<str>,
    },
    /// A word of a dialect that is known, but not read.
    #[error("{word} is not supported: {what}")]
    WordNotSupported {
        /// The word.
        word: Box<str>,
        /// What it stands for.
        what: &'static str,
    },
    /// A `G` or `M` number that cannot be a code.
    #[error("{letter} code is {value}, but must be {bound}")]
    NotACode {
        /// `G` or `M`.
        letter: char,
        /// The number.
        value: f64,
        /// What it may be.
        bound: &'static str,
    },
    /// A word stands twice in a block.
    #[error("{letter} stands twice in this block")]
    Repeated {
        /// The letter.
        letter: char,
    },
    /// Two codes of one modal group stand in a block.
    #[error(
        "{first} and {second} are both of the group \"{group}\", of which a block may have one"
    )]
    SameGroup {
        /// The code that stands first.
        first: Code,
        /// The code that cannot stand beside it.
        second: Code,
        /// Name of the group.
        group: &'static str,
    },
    /// A word that nothing in the block uses.
    #[error("{letter} is used by nothing in this block")]
    Unused {
        /// The letter.
        letter: char,
    },
    /// A word that two codes of the block could use.
    #[error("{letter} could belong to {first} or to {second}; write two blocks")]
    Ambiguous {
        /// The letter.
        letter: char,
        /// One of the codes.
        first: Code,
        /// The other.
        second: Code,
    },
    /// A code lacks a word that it needs.
    #[error("{code} needs a {letter} word")]
    WordMissing {
        /// The code.
        code: Code,
        /// The letter.
        letter: char,
    },
    /// Axis words while no motion mode is active.
    #[error("{letter} without a motion mode: write G0, G1, G2 or G3")]
    NoMotionMode {
        /// The letter.
        letter: char,
    },
    /// The machine has no such axis.
    #[error("{} has no axis {letter}", machine_of(machine))]
    NoSuchAxis {
        /// The letter.
        letter: char,
        /// Name of the machine; empty where nobody gave one.
        machine: Arc<str>,
    },
    /// A quantity may not be negative.
    #[error("{quantity} is {value}, but must not be negative")]
    Negative {
        /// Which quantity.
        quantity: &'static str,
        /// What was written.
        value: f64,
    },
    /// A quantity must be positive.
    #[error("{quantity} is {value}, but must be positive")]
    NotPositive {
        /// Which quantity.
        quantity: &'static str,
        /// What was written.
        value: f64,
    },
    /// A number must be whole and within bounds.
    #[error("{quantity} is {value}, but must be a whole number from {least} to {most}")]
    NotWhole {
        /// Which quantity.
        quantity: &'static str,
        /// What was written.
        value: f64,
        /// Smallest allowed.
        least: u32,
        /// Largest allowed.
        most: u32,
    },
    /// A quantity must lie between two bounds.
    #[error("{quantity} is {value}, but must be from {least} to {most}")]
    OutOfBounds {
        /// Which quantity.
        quantity: &'static str,
        /// What was written.
        value: f64,
        /// Smallest allowed.
        least: f64,
        /// Largest allowed.
        most: f64,
    },
    /// A dwell longer than a dwell may be.
    #[error("dwell is {value} s, but may be {bound} s at most")]
    DwellTooLong {
        /// What was written, s.
        value: f64,
        /// Longest dwell, s.
        bound: f64,
    },
    /// A length beyond all machines.
    #[error("{letter} comes to {value} mm, beyond {bound} mm")]
    TooFar {
        /// The letter.
        letter: char,
        /// The length, mm.
        value: f64,
        /// Largest length, mm.
        bound: f64,
    },
    /// A feed move before any `F`.
    #[error("feedrate was never set, but a feed move needs one")]
    NoFeedrate,
    /// A feed move in inverse time without its own `F`.
    #[error("F is missing: with G93 every feed move needs its own")]
    NoInverseTime,
    /// A feedrate that cannot be followed.
    #[error(
        "feedrate comes to {speed} mm/s, but must be finite, at least {MIN_QUANTITY} and at most {LARGEST_QUANTITY:e} mm/s"
    )]
    Feedrate {
        /// The feedrate, mm/s.
        speed: f64,
    },
    /// An arc without centre and radius.
    #[error("arc has neither centre nor radius: write {offsets}, or R")]
    ArcCenterMissing {
        /// Offsets that would do in this plane.
        offsets: &'static str,
    },
    /// An absolute centre with one coordinate only.
    #[error("with G90.1 the centre needs {offsets}")]
    ArcCenterIncomplete {
        /// Offsets needed in this plane.
        offsets: &'static str,
    },
    /// An arc with both centre and radius.
    #[error("{letter} beside R: an arc has a centre or a radius, not both")]
    ArcCenterAndRadius {
        /// The offset beside `R`.
        letter: char,
    },
    /// An offset that does not lie in the plane of the arc.
    #[error("{letter} does not lie in the plane of the arc, {plane}")]
    OffsetOutsidePlane {
        /// The offset.
        letter: char,
        /// The plane and its code.
        plane: &'static str,
    },
    /// A radius that does not reach from start to end.
    #[error(
        "arc radius is {radius} mm, but half the distance from start to end is {half_chord} mm; it may be short by {allowed} mm"
    )]
    ArcRadiusTooShort {
        /// The radius, mm.
        radius: f64,
        /// Half the distance from start to end, mm.
        half_chord: f64,
        /// How much the radius may be too short, mm.
        allowed: f64,
    },
    /// A radius while start and end coincide, so that the centre may lie anywhere.
    #[error(
        "arc of radius {radius} mm ends where it starts, so its centre is unknown; write {offsets}"
    )]
    ArcRadiusClosed {
        /// The radius, mm.
        radius: f64,
        /// Offsets that would do in this plane.
        offsets: &'static str,
    },
    /// The move itself is impossible.
    #[error(transparent)]
    Path(#[from] ToolpathError),
    /// A parameter or an expression is wrong.
    #[error(transparent)]
    Arithmetic(#[from] ArithmeticError),
    /// A subroutine, a loop or a condition is wrong.
    #[error(transparent)]
    Flow(#[from] FlowError),
    /// A statement of a cutter location file is wrong.
    #[error(transparent)]
    Statement(#[from] StatementError),
    /// The block cannot be carried out.
    #[error(transparent)]
    Machining(#[from] MachiningError),
}

/// A machine, by its name where it has one.
fn machine_of(name: &str) -> String {
    if name.is_empty() {
        "the machine".to_owned()
    } else {
        format!("machine \"{name}\"")
    }
}
