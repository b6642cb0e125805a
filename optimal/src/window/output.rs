//! Defines the output of a planner: pieces, and the places between which it may be exchanged.
//!
//! Source: ours. Not here: who makes it, and who needs it.

use toolglide_kinematics::numeric::{JUMP_SLACK, LENGTH_SLACK, TIME_SLACK};
use toolglide_kinematics::{MoveRange, Piece, Sample, Vector};

/// A piece of motion, or a place between two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Event<const N: usize> {
    /// Motion.
    Piece(Piece<N>),
    /// The motion rests at the end of this move, and all up to it has been planned.
    Rest(u32),
    /// The motion passes the middle of a long move.
    Joint(Joint<N>),
    /// No motion was found up to the next rest: lengths or limits are beyond float arithmetic.
    Lost,
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

impl<const N: usize> Joint<N> {
    /// A piece cut in two here, if it passes at the same velocity and keeps it, on that move alone.
    pub(crate) fn cut(&self, piece: &Piece<N>) -> Option<[Piece<N>; 2]> {
        let start = piece.at(0.0);
        let steady = start.acceleration.norm_squared() <= 0.0 && start.jerk.norm_squared() <= 0.0;
        let speed = self.velocity.norm();
        let alone = MoveRange::one(self.index);
        if !steady
            || piece.serves() != alone
            || (start.velocity - self.velocity).norm() > 0.1 * JUMP_SLACK * speed
        {
            return None;
        }
        let way = self.position - start.position;
        let time = way.dot(&self.velocity) / (speed * speed);
        let inside = time > TIME_SLACK && time < piece.duration() - TIME_SLACK;
        let off = (way - self.velocity * time).norm();
        if !inside || off > 0.1 * LENGTH_SLACK {
            return None;
        }
        let rest = Sample {
            position: self.position,
            ..start
        };
        Some([
            Piece::new(&start, time, self.position, alone),
            Piece::new(&rest, piece.duration() - time, piece.end(), alone),
        ])
    }
}
