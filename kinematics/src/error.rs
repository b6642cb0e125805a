//! What can be wrong with limits and paths.

use crate::numeric::LEAST_QUANTITY;
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
    /// A limit is below [`LEAST_QUANTITY`].
    #[error("{quantity} limit is {value}, but must be at least {LEAST_QUANTITY}")]
    TooSmall {
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
    /// A quantity is below [`LEAST_QUANTITY`].
    #[error("{quantity} is {value}, but must be at least {LEAST_QUANTITY}")]
    TooSmall {
        /// Which quantity.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// A coordinate is not a finite number.
    #[error("a coordinate is not a finite number")]
    NotFinite,
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
