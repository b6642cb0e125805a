//! Names every fault of limits and paths.

use crate::numeric::{LARGEST_COORDINATE, LARGEST_QUANTITY, LONGEST_RAMP, MIN_QUANTITY};
use thiserror::Error;

/// Why limits are refused.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LimitsError {
    /// A limit must be positive and finite.
    #[error("{quantity} limit is {value}, but must be positive and finite")]
    NotPositive {
        /// Which limit.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// A limit is below what any axis needs.
    #[error("{quantity} limit is {value}, but must be at least {least}")]
    TooSmall {
        /// Which limit.
        quantity: &'static str,
        /// What was given.
        value: f64,
        /// The least.
        least: f64,
    },
    /// One limit would take longer than [`LONGEST_RAMP`] to reach at the next.
    #[error(
        "{quantity} limit is {value}, so that the {reached} of {limit} takes {seconds:.0} s to reach, but it may take \
         {LONGEST_RAMP} s"
    )]
    TooSlow {
        /// Which limit.
        quantity: &'static str,
        /// What was given.
        value: f64,
        /// What is reached by it.
        reached: &'static str,
        /// The limit of that.
        limit: f64,
        /// One over the other, s.
        seconds: f64,
    },
    /// A reserve must be a share.
    #[error("reserve is {value}, but must be from 0 to {most}")]
    Reserve {
        /// What was given.
        value: f64,
        /// The largest.
        most: f64,
    },
    /// A limit is above [`LARGEST_QUANTITY`].
    #[error("{quantity} limit is {value}, but may be at most {LARGEST_QUANTITY:e}")]
    TooLarge {
        /// Which limit.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
}

/// Why a move or a path is refused.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ToolpathError {
    /// A quantity must be positive and finite.
    #[error("{quantity} is {value}, but must be positive and finite")]
    NotPositive {
        /// Which quantity.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// A quantity is below [`MIN_QUANTITY`].
    #[error("{quantity} is {value}, but must be at least {MIN_QUANTITY}")]
    TooSmall {
        /// Which quantity.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// A quantity is larger than planners can carry.
    #[error("{quantity} is {value:e}, but may be at most {bound:e}")]
    TooLarge {
        /// Which quantity.
        quantity: &'static str,
        /// What was given.
        value: f64,
        /// The largest.
        bound: f64,
    },
    /// A coordinate is not a finite number.
    #[error("a coordinate is not a finite number")]
    NotFinite,
    /// A coordinate is beyond [`LARGEST_COORDINATE`].
    #[error("a coordinate is {value:e} mm, but may be at most {LARGEST_COORDINATE:e} mm")]
    TooFar {
        /// The coordinate, mm.
        value: f64,
    },
    /// A path needs a point to start from.
    #[error("a path needs at least one point")]
    Empty,
    /// The plane of an arc must name two different axes.
    #[error("the plane of an arc names axes {plane:?}, but must name two different ones of {axes}")]
    ArcPlane {
        /// The axes named, counted from 0.
        plane: [usize; 2],
        /// How many axes there are.
        axes: usize,
    },
    /// An arc must have a radius.
    #[error("arc radius is {radius} mm, but must be positive")]
    ArcRadius {
        /// The radius, mm.
        radius: f64,
    },
    /// Start and end of an arc lie on different circles.
    #[error(
        "arc radius is {start_radius:.6} mm at the start and {end_radius:.6} mm at the end; they may differ by {allowed:.6} mm"
    )]
    ArcMismatch {
        /// Radius at the start, mm.
        start_radius: f64,
        /// Radius at the end, mm.
        end_radius: f64,
        /// Largest difference allowed, mm.
        allowed: f64,
    },
    /// An arc starts elsewhere than where the path has come to.
    #[error("arc starts {gap} mm from the end of the move before")]
    Gap {
        /// The distance, mm.
        gap: f64,
    },
    /// The tolerance of an arc is below [`MIN_SHARE_OF_RADIUS`](crate::numeric::MIN_SHARE_OF_RADIUS).
    #[error(
        "tolerance is {tolerance:e} mm, but must be at least {least:e} mm for an arc of radius {radius} mm"
    )]
    TooFine {
        /// The tolerance, mm.
        tolerance: f64,
        /// The least, mm.
        least: f64,
        /// The larger radius of the arc, mm.
        radius: f64,
    },
    /// A direction must have unit length.
    #[error("orientation has length {length}, but must have length 1")]
    NotUnit {
        /// Its length.
        length: f64,
    },
    /// Between opposite orientations every turn is as short.
    #[error(
        "orientations lie {angle} rad apart, so that the axis to turn about is open; give a pose between them"
    )]
    Opposite {
        /// The angle between them, rad.
        angle: f64,
    },
    /// An axis to turn about belongs to opposite orientations only.
    #[error("orientations lie {angle} rad apart, so that the axis to turn about is theirs")]
    NotOpposite {
        /// The angle between them, rad.
        angle: f64,
    },
}
