//! Defines the violations that a motion can have.
//!
//! Source: the house style of messages: place, quantity, value, bound. Not here: finding it.

use thiserror::Error;

use super::report::Place;

/// Something that a motion broke, with its value, its bound, when, and on which move.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Violation {
    /// An axis moves too fast.
    #[error("axis {}: velocity {value} mm/s exceeds the limit of {limit} mm/s at {time:.3} s ({place})", axis_name(*.axis))]
    Velocity {
        /// The axis, counted from 0.
        axis: usize,
        /// Its velocity.
        value: f64,
        /// The limit.
        limit: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// An axis accelerates too hard.
    #[error("axis {}: acceleration {value} mm/s² exceeds the limit of {limit} mm/s² at {time:.3} s ({place})", axis_name(*.axis))]
    Acceleration {
        /// The axis, counted from 0.
        axis: usize,
        /// Its acceleration.
        value: f64,
        /// The limit.
        limit: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// The acceleration of an axis changes too fast.
    #[error("axis {}: jerk {value} mm/s³ exceeds the limit of {limit} mm/s³ at {time:.3} s ({place})", axis_name(*.axis))]
    Jerk {
        /// The axis, counted from 0.
        axis: usize,
        /// Its jerk.
        value: f64,
        /// The limit.
        limit: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// The motion is faster than programmed.
    #[error("speed {value} mm/s exceeds the feedrate of {feedrate} mm/s at {time:.3} s ({place})")]
    Feedrate {
        /// The speed.
        value: f64,
        /// The largest feedrate of the moves served.
        feedrate: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// The motion is too far from the path.
    #[error(
        "the motion is {value} mm from the path, but may be {tolerance} mm at {time:.3} s ({place})"
    )]
    Deviation {
        /// The distance.
        value: f64,
        /// The tolerance there.
        tolerance: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// The motion does not pass near enough to a corner.
    #[error(
        "the motion passes {value} mm from the corner, but may pass {tolerance} mm from it at {time:.3} s ({place})"
    )]
    CornerMissed {
        /// The closest approach.
        value: f64,
        /// The tolerance of the corner.
        tolerance: f64,
        /// When the motion is closest.
        time: f64,
        /// The move that ends in the corner.
        place: Place,
    },
    /// Corners are passed, but in another order than programmed.
    #[error("the corner is not passed in its turn; the motion is near it at {time:.3} s ({place})")]
    CornerOrder {
        /// When the motion is closest to it.
        time: f64,
        /// The move that ends in the corner.
        place: Place,
    },
    /// A part of an arc is left out.
    #[error("the arc is left out from {share:.3} of its turn on at {time:.3} s ({place})")]
    ArcCut {
        /// Share of the turn from which on the motion does not follow it.
        share: f64,
        /// When the move was over.
        time: f64,
        /// The arc.
        place: Place,
    },
    /// An exact stop is not made.
    #[error(
        "no stop: the motion passes {distance} mm from the point to stop at and does not rest there at {time:.3} s ({place})"
    )]
    StopNotMade {
        /// The closest approach.
        distance: f64,
        /// When the motion is closest.
        time: f64,
        /// The move that should end at rest.
        place: Place,
    },
    /// A dwell is cut short.
    #[error(
        "the motion rests {rested} s, but must dwell {duration} s before {time:.3} s ({place})"
    )]
    DwellTooShort {
        /// How long it rests.
        rested: f64,
        /// How long it must.
        duration: f64,
        /// When the dwell was over.
        time: f64,
        /// The dwell.
        place: Place,
    },
    /// A piece does not start where the last one ended, or does not reach its own end.
    #[error("position jumps by {value} mm at {time:.3} s ({place})")]
    PositionJump {
        /// The distance.
        value: f64,
        /// When.
        time: f64,
        /// The first move that the piece serves.
        place: Place,
    },
    /// The velocity of an axis jumps between two pieces.
    #[error("axis {}: velocity jumps by {value} mm/s at {time:.3} s ({place})", axis_name(*.axis))]
    VelocityJump {
        /// The axis, counted from 0.
        axis: usize,
        /// The change.
        value: f64,
        /// When.
        time: f64,
        /// The first move that the piece serves.
        place: Place,
    },
    /// The acceleration of an axis jumps between two pieces.
    #[error("axis {}: acceleration jumps by {value} mm/s² at {time:.3} s ({place})", axis_name(*.axis))]
    AccelerationJump {
        /// The axis, counted from 0.
        axis: usize,
        /// The change.
        value: f64,
        /// When.
        time: f64,
        /// The first move that the piece serves.
        place: Place,
    },
    /// The motion does not start where the path starts.
    #[error("the motion starts {distance} mm from the start of the path")]
    StartsElsewhere {
        /// The distance.
        distance: f64,
    },
    /// The motion does not start at rest.
    #[error("axis {}: the motion does not start at rest", axis_name(*.axis))]
    StartsMoving {
        /// An axis that moves, counted from 0.
        axis: usize,
    },
    /// The motion does not end where the path ends.
    #[error("the motion ends {distance} mm from the end of the path at {time:.3} s ({place})")]
    EndsElsewhere {
        /// The distance.
        distance: f64,
        /// When.
        time: f64,
        /// The last move.
        place: Place,
    },
    /// The motion does not end at rest.
    #[error("axis {}: the motion does not end at rest at {time:.3} s ({place})", axis_name(*.axis))]
    EndsMoving {
        /// An axis that moves, counted from 0.
        axis: usize,
        /// When.
        time: f64,
        /// The last move.
        place: Place,
    },
    /// A piece serves moves that were over, or that no one programmed.
    #[error("the motion claims moves {first} to {last}, which is not their turn at {time:.3} s")]
    MovesOutOfOrder {
        /// First move claimed.
        first: u32,
        /// Last move claimed.
        last: u32,
        /// When.
        time: f64,
    },
    /// No piece serves a move.
    #[error("the motion leaves out a move at {time:.3} s ({place})")]
    MoveSkipped {
        /// When its turn was over.
        time: f64,
        /// The move.
        place: Place,
    },
    /// A mode of vibration swings on where the motion rests, although it was promised to rest.
    #[error(
        "axis {}: the mode at {frequency} Hz is left swinging by {left} mm at a rest, where {bound} mm are allowed, by {time:.3} s ({place})",
        axis_name(*.axis)
    )]
    ModeSwings {
        /// The axis, counted from 0.
        axis: usize,
        /// Frequency of the mode, Hz.
        frequency: f64,
        /// Its largest amplitude at a rest, mm.
        left: f64,
        /// What is allowed, mm.
        bound: f64,
        /// End of the motion.
        time: f64,
        /// The last move.
        place: Place,
    },
    /// The motion goes beyond the side of a line that it was promised to keep.
    #[error(
        "the motion goes {distance} mm beyond the side that is kept, where {allowed} mm are allowed, by {time:.3} s ({place})"
    )]
    Overshoots {
        /// The largest distance, mm.
        distance: f64,
        /// What is allowed, mm.
        allowed: f64,
        /// End of the motion.
        time: f64,
        /// The last move.
        place: Place,
    },
    /// A piece is not a motion at all: numbers that are not finite or larger than any machine.
    #[error("the motion is not a finite number at {time:.3} s ({place})")]
    NotFinite {
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
}

impl Violation {
    /// How many kinds there are.
    pub(super) const KINDS: usize = 22;

    pub(super) fn kind(&self) -> usize {
        match self {
            Self::Velocity { .. } => 0,
            Self::Acceleration { .. } => 1,
            Self::Jerk { .. } => 2,
            Self::Feedrate { .. } => 3,
            Self::Deviation { .. } => 4,
            Self::CornerMissed { .. } => 5,
            Self::CornerOrder { .. } => 6,
            Self::ArcCut { .. } => 7,
            Self::StopNotMade { .. } => 8,
            Self::DwellTooShort { .. } => 9,
            Self::PositionJump { .. } => 10,
            Self::VelocityJump { .. } => 11,
            Self::AccelerationJump { .. } => 12,
            Self::StartsElsewhere { .. } => 13,
            Self::StartsMoving { .. } => 14,
            Self::EndsElsewhere { .. } => 15,
            Self::EndsMoving { .. } => 16,
            Self::MovesOutOfOrder { .. } => 17,
            Self::MoveSkipped { .. } => 18,
            Self::NotFinite { .. } => 19,
            Self::ModeSwings { .. } => 20,
            Self::Overshoots { .. } => 21,
        }
    }
}

/// Letters of the axes in path order.
pub(super) const LETTERS: [char; 6] = ['X', 'Y', 'Z', 'A', 'B', 'C'];

/// Letter of an axis in path order; the number of those beyond the six that have letters.
fn axis_name(axis: usize) -> String {
    match LETTERS.get(axis) {
        Some(letter) => letter.to_string(),
        None => axis.to_string(),
    }
}
