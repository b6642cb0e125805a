//! Names every fault of offsets, tools, cycles, splines and cutter compensation.
//!
//! Lengths are in mm. Not here: words and codes, see [`Reason`](crate::Reason).

use crate::block::code::Code;
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
    /// A corner that cannot be broken by `,R` or `,C`.
    #[error("a corner broken by ,R or ,C needs {what}")]
    CornerNeeds {
        /// What it needs.
        what: &'static str,
    },
    /// Factors of scaling that would make an arc an ellipse.
    #[error("an arc is not possible in a plane whose axes are scaled unequally")]
    UnevenArc,
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
    /// A spline with knots that was begun, and something else before its last knot.
    #[error("the spline begun by G6.2 has {given} of the {wanted} knots that its points need")]
    KnotsMissing {
        /// How many knots there are.
        given: usize,
        /// Points and order together.
        wanted: usize,
    },
    /// A block of a spline without its knot.
    #[error("every block of a spline by G6.2 needs its knot, a K word")]
    NoKnot,
    /// An order behind the first block of a spline.
    #[error("the order P stands in the block of G6.2 only")]
    NoKnotOrder,
    /// A control point behind a block that had a knot alone.
    #[error("a point of the spline behind its last knots")]
    LatePoint,
    /// A knot that lies below the one before it.
    #[error("the knot is {knot}, but the one before it is {before}: knots never fall")]
    KnotFalls {
        /// The knot.
        knot: f64,
        /// The one before it.
        before: f64,
    },
    /// A spline that would not begin at its first point and end at its last.
    #[error("the first {order} knots of the spline must be equal, and so must its last {order}")]
    KnotsNotClamped {
        /// Order of the spline.
        order: usize,
    },
    /// A knot that would tear the spline apart.
    #[error("knot {knot} stands more than {most} times, which would tear the spline apart")]
    KnotRepeated {
        /// The knot.
        knot: f64,
        /// How often it may stand there.
        most: usize,
    },
    /// A spline that begins somewhere else.
    #[error(
        "the first point of the spline is {distance} mm from where the tool is, but may be {allowed} mm"
    )]
    SplineStart {
        /// The distance, mm.
        distance: f64,
        /// Largest distance, mm.
        allowed: f64,
    },
    /// A place of a rotary axis that goes there a certain way.
    #[error("a place by DC( ), ACP( ) or ACN( ) is {value} degrees, but must be from 0 to 360")]
    OutsideTurn {
        /// The place, degrees.
        value: f64,
    },
    /// The modal state cannot be restored.
    #[error("there is no saved state to restore")]
    NothingSaved,
}
