//! Defines the seam between a kind of corner blend and the planner that uses it.
//!
//! Source: chapters 2, 3 and 5 turn corners differently and are planned alike. Not here: any corner.

use thiserror::Error;

/// Turns one corner without stopping.
///
/// `C` is the kind of corner, which holds geometry, speeds and tolerance; the blender holds what
/// belongs to the machine.
pub trait Blender<C> {
    /// The motion it makes.
    type Motion: CornerMotion;

    /// The fastest motion of this kind through the corner.
    ///
    /// # Errors
    /// [`BlendError`] when this kind of motion cannot turn the corner; stopping always can.
    fn blend(&self, corner: &C) -> Result<Self::Motion, BlendError>;
}

/// What a planner must know of a corner motion, whichever way it turns.
pub trait CornerMotion {
    /// How long it takes.
    fn duration(&self) -> f64;
    /// Where and how it leaves the incoming move.
    fn entry(&self) -> Boundary;
    /// Where and how it joins the outgoing move.
    fn exit(&self) -> Boundary;
    /// Least distance between the motion and the corner itself.
    fn corner_error(&self) -> f64;
}

/// State of a motion where straight move and corner meet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Boundary {
    /// Distance from the corner, along the move.
    pub distance: f64,
    /// Speed along the move.
    pub speed: f64,
    /// Rate at which the speed falls on the way in, or rises on the way out; not negative.
    pub acceleration: f64,
}

/// Why a corner cannot be turned in this way.
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
}
