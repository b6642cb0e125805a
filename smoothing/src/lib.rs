//! Plans kinematic corner smoothing: blends the axis velocities around each corner inside the
//! corner tolerance, and shares short moves between corners in a look-ahead window.
//!
//! [`KinematicSmoothing`] plans while a path streams in; [`plan`] does so for a whole toolpath. The
//! corner motions [`Interrupted`] and [`Uninterrupted`] can be used by themselves. This crate does
//! not know filters, machines or programs.

mod arc_parts;
mod bend;
mod chords;
mod corner;
mod lookahead;
mod method;
mod planner;
mod section;
mod segment;
mod segment_merger;
mod short_segments;
mod stretch;
mod work;

pub use corner::interrupted::Interrupted;
pub use corner::stop_start::StopStart;
pub use corner::uninterrupted::Uninterrupted;
pub use method::{Method, Settings};
pub use planner::{KinematicSmoothing, plan};
pub use work::Work;

/// Building blocks of the planner, for planners of other corners: chords of arcs, merged segments, the look-ahead window, and
/// how legs become pieces.
pub mod parts {
    pub use crate::bend::Bend;
    pub use crate::chords::Chords;
    pub use crate::lookahead::unroll::{MAX_PIECES, corner_between, unroll_leg};
    pub use crate::lookahead::window::{Link, Window};
    pub use crate::segment::Segment;
    pub use crate::segment_merger::{MERGE_SHARE, ROUNDING_SHARE, SegmentMerger, Vertex};

    /// Turns of a unit direction smaller than this are taken for straight, dimensionless.
    pub const STRAIGHT: f64 = crate::STRAIGHT;
}

/// Turns of a unit direction smaller than this are taken for straight: the velocity then jumps by
/// less than a billionth of the feedrate, which no drive resolves.
pub(crate) const STRAIGHT: f64 = 1e-12;
