//! Names every fault of a statement in a cutter location file.
//!
//! Not here: words and codes, see [`Reason`](crate::Reason).

use thiserror::Error;

/// Why a statement is refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum StatementError {
    /// A statement that is not read.
    #[error("statement {name} is not supported")]
    NotSupported {
        /// Its major word.
        name: Box<str>,
    },
    /// A statement that moves an axis or the part, and is not read.
    #[error("statement {name} is not supported, nor ever skipped: {what}")]
    Moves {
        /// Its major word.
        name: Box<str>,
        /// What it asks for.
        what: &'static str,
    },
    /// Axes that are no coordinate system.
    #[error(
        "the axes of MSYS have the lengths {} and {} and a scalar product of {product}, but must be upright unit vectors",
        lengths[0],
        lengths[1]
    )]
    NoSystem {
        /// Lengths of the X axis and of the Y axis.
        lengths: [f64; 2],
        /// Their scalar product.
        product: f64,
    },
    /// A feedrate for each turn of a spindle whose speed is not known.
    #[error(
        "a feedrate for each turn of the spindle needs a speed in turns a minute before it: write SPINDL/RPM, or MMPM"
    )]
    NoSpindleSpeed,
    /// A feedrate as the inverse of a time.
    #[error("inverse time is not read in cutter location files: write a feedrate in MMPM or IPM")]
    InverseTime,
    /// Something that should be a number.
    #[error("a number is missing here")]
    NotANumber,
    /// A statement with too few or too many numbers.
    #[error("{name} has {given} numbers, but needs {wanted}")]
    WrongCount {
        /// Its major word.
        name: &'static str,
        /// How many it has.
        given: usize,
        /// How many it needs.
        wanted: &'static str,
    },
    /// A minor word that is not known.
    #[error("{name} is not followed by {wanted}")]
    WrongWord {
        /// The major word.
        name: &'static str,
        /// What may follow it.
        wanted: &'static str,
    },
    /// A circle that is not followed by the point where it ends.
    #[error("CIRCLE must be followed by the GOTO where the arc ends")]
    CircleAlone,
    /// A point that does not lie on its circle.
    #[error(
        "the {which} of the arc is {distance} mm from its axis, but the radius is {radius} mm; they may differ by {allowed} mm"
    )]
    OffCircle {
        /// Start or end.
        which: &'static str,
        /// Its distance from the axis, mm.
        distance: f64,
        /// The radius, mm.
        radius: f64,
        /// By how much they may differ, mm.
        allowed: f64,
    },
    /// A statement that goes on at the end of the file.
    #[error("the statement goes on (\"$\"), but the file ends")]
    Unfinished,
}
