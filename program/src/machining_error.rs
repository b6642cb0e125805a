//! What can be wrong with offsets, tools, cycles, splines and cutter compensation.
//!
//! Lengths are in mm. Not here: words and codes, see [`Reason`](crate::Reason).

use crate::codes::Code;
use thiserror::Error;

/// Why a block that is read well cannot be carried out.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MachiningError {
    /// The tool table has no such tool.
    #[error("tool {tool} is not in the tool table")]
    NoSuchTool {
        /// The tool.
        tool: u32,
    },
    /// A code that makes sense only beside another one.
    #[error("{code} needs {companion} in its block")]
    Companion {
        /// The code.
        code: Code,
        /// What must stand beside it.
        companion: &'static str,
    },
    /// A code that cannot be used in the present state.
    #[error("{code} is not possible {state}")]
    NotNow {
        /// The code.
        code: Code,
        /// The state.
        state: &'static str,
    },
    /// A cycle without what it needs.
    #[error("the first block of {code} needs a {letter} word")]
    CycleIncomplete {
        /// Code of the cycle.
        code: Code,
        /// The letter that is missing.
        letter: char,
    },
    /// A cycle whose plane of retraction lies below its bottom.
    #[error("R is at {retract} mm, below the bottom of the hole at {bottom} mm")]
    RetractBelowBottom {
        /// Height of the plane of retraction, mm.
        retract: f64,
        /// Height of the bottom, mm.
        bottom: f64,
    },
    /// One block that asks for too much motion.
    #[error("this block asks for more than {bound} moves")]
    TooManyMoves {
        /// Most moves of one block.
        bound: u32,
    },
    /// Coordinates by angle where there is no plane for them.
    #[error("{letter} needs {what}")]
    Polar {
        /// `@` or `^`.
        letter: char,
        /// What must be true for it.
        what: &'static str,
    },
    /// A lead-in or a lead-out that is not longer than the radius.
    #[error(
        "the move that begins cutter compensation is {length} mm long, but must be longer than the radius of {radius} mm"
    )]
    LeadInTooShort {
        /// Length of the move in the plane, mm.
        length: f64,
        /// Radius of the tool, mm.
        radius: f64,
    },
    /// A lead-in or a lead-out along an arc.
    #[error("cutter compensation {begins_or_ends} with a straight move, not with an arc")]
    LeadByArc {
        /// Whether it is a lead-in or a lead-out.
        begins_or_ends: &'static str,
    },
    /// A tool that is too large for an arc.
    #[error("the tool of radius {radius} mm does not fit inside the arc of radius {arc} mm")]
    ToolTooLarge {
        /// Radius of the tool, mm.
        radius: f64,
        /// Radius of the arc, mm.
        arc: f64,
    },
    /// A corner that the tool cannot reach without cutting what should stay.
    #[error(
        "the tool of radius {radius} mm would gouge: it cannot reach the corner before this move"
    )]
    Gouge {
        /// Radius of the tool, mm.
        radius: f64,
    },
    /// A spline that has too few or too many of something.
    #[error("the spline has {given} points, but its order of {order} needs at least as many")]
    TooFewPoints {
        /// How many there are.
        given: usize,
        /// Order of the spline.
        order: usize,
    },
    /// More control points than a spline may have.
    #[error("the spline has more than {bound} points")]
    TooManyPoints {
        /// Most points.
        bound: usize,
    },
    /// Offsets of a spline that are not there.
    #[error("{code} needs {words}")]
    SplineIncomplete {
        /// Code of the spline.
        code: Code,
        /// The words that are missing.
        words: &'static str,
    },
    /// The end of a spline that was not begun.
    #[error("G5.3 ends a spline, but none was begun by G5.2")]
    NoSpline,
    /// A spline that was begun, and something else before its end.
    #[error("the spline begun by G5.2 is not ended by G5.3")]
    OpenSpline,
    /// The modal state cannot be restored.
    #[error("there is no saved state to restore")]
    NothingSaved,
    /// A rotated coordinate system that would turn an arc out of all planes.
    #[error(
        "an arc outside the XY plane in a coordinate system that is rotated by {degrees} degrees"
    )]
    RotatedArc {
        /// The rotation.
        degrees: f64,
    },
}
