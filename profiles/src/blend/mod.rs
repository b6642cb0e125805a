//! Defines the seam between a kind of corner blend and the planner that uses it.
//!
//! Source: chapters 2, 3 and 4 blend corners differently. All of their motions are phases of constant
//! jerk along the two moves, so one [`BlendShape`] describes each of them. Not here: any kind of
//! corner.

mod shape;
mod unroll;

pub use shape::{BlendPhase, BlendShape, MAX_PHASES};
pub use unroll::Part;

use core::fmt::Debug;
use thiserror::Error;
use toolglide_kinematics::Corner;

/// Blends one corner between two straight moves without a stop.
///
/// The corner holds geometry, speeds and tolerance. The blender holds what belongs to the machine,
/// its limits first of all. `docs/adding-a-blender.md` tells how to write one.
pub trait Blender<const N: usize>: Debug + Send + Sync {
    /// The fastest motion of this kind through the corner, as if both moves were endless: the planner
    /// scales it down where they are not, and where it is faster than the speeds of the corner. It must
    /// keep the tolerance, and at every scale the limits of acceleration and jerk.
    ///
    /// `before` and `after` are the lengths of the moves beside the corner, mm. They may lead to the
    /// choice of a motion, but do not bound it.
    ///
    /// # Errors
    /// [`BlendError`] when this kind of motion cannot blend the corner. The planner then takes another
    /// kind, or stops.
    fn blend(&self, corner: &Corner<N>, before: f64, after: f64) -> Result<BlendShape, BlendError>;
}

/// State of a motion where straight move and corner meet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Boundary {
    /// Distance from the corner, along the move, mm.
    pub distance: f64,
    /// Speed along the move, mm/s.
    pub speed: f64,
    /// Rate at which the speed falls on the way in, or rises on the way out, mm/s²; not negative.
    pub acceleration: f64,
}

/// Why a corner cannot be blended in this way.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BlendError {
    /// There is no corner: the path goes straight on.
    #[error("the path goes straight on: a turn of {turn_angle} rad needs no blend of this kind")]
    Straight {
        /// The turn angle, rad.
        turn_angle: f64,
    },
    /// No speed however small keeps the motion inside its bounds.
    #[error("the turn of {turn_angle} rad cannot be blended in this way: {reason}")]
    Impossible {
        /// The turn angle, rad.
        turn_angle: f64,
        /// What prevents it.
        reason: &'static str,
    },
    /// A blend has more phases than a shape can hold.
    #[error("a blend of {count} phases is refused: {MAX_PHASES} are the most")]
    TooManyPhases {
        /// How many there are.
        count: usize,
    },
    /// A phase lasts a negative time, or one of its quantities is no number.
    #[error("the {quantity} of a phase is {value}, which no motion can have")]
    NoMotion {
        /// Which quantity.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// The phases do not lead from one boundary to the other.
    #[error("the phases lead to a {quantity} that misses the boundary by {miss}")]
    NotClosed {
        /// Which quantity.
        quantity: &'static str,
        /// By how much.
        miss: f64,
    },
}
