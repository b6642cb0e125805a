//! What comes out of a planner: motion, and what is known of it in between.
//!
//! Source: ours. Not here: who makes it, and who needs it.

use toolglide_kinematics::{Piece, Vector};

/// A piece of motion, or a place between two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Event<const N: usize> {
    /// Motion.
    Piece(Piece<N>),
    /// The motion rests at the end of this move, and all up to it has been planned.
    Rest(u32),
    /// The motion passes the middle of a long move.
    Joint(Joint<N>),
}

/// A place on the line of a move that is passed at its feedrate, without acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Joint<const N: usize> {
    /// The move.
    pub(crate) index: u32,
    /// mm.
    pub(crate) position: Vector<N>,
    /// mm/s.
    pub(crate) velocity: Vector<N>,
}
