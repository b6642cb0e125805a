//! Names every reason why a pose motion cannot be planned.
//!
//! Source: the house style of messages: place, quantity, value, bound. Not here: what a motion
//! breaks, which the judge says.

use thiserror::Error;
use toolglide_fir::FirError;
use toolglide_kinematics::{KinematicsError, ToolpathError};

/// Why a pose motion cannot be planned.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FiveAxisError {
    /// Motion of constant jerk needs a chain of two filters.
    #[error("the chain has {given} filters, but tool poses are planned with 2")]
    FilterCount {
        /// How many it has.
        given: usize,
    },
    /// The chain is refused.
    #[error(transparent)]
    Chain(#[from] FirError),
    /// A pose or a move is refused.
    #[error("move {index}: {reason}")]
    Path {
        /// The move, counted from 0.
        index: u32,
        /// What is wrong.
        reason: ToolpathError,
    },
    /// The machine cannot take a pose.
    #[error("move {index}: {reason}")]
    Machine {
        /// The move that leads there, counted from 0.
        index: u32,
        /// What the machine says.
        reason: KinematicsError,
    },
    /// A move names an axis that the machine has not.
    #[error("move {index}: axis {axis} is programmed, but the machine has {axes}")]
    NoAxis {
        /// The move, counted from 0.
        index: u32,
        /// The letter.
        axis: char,
        /// Letters of the axes that there are.
        axes: String,
    },
    /// A limit cannot be kept at any speed.
    #[error(
        "move {index}: axis {axis} exceeds its limit of {quantity} {factor:.3} times even when the move is slowed down; \
         does the tool pass the pole of the machine?"
    )]
    AxisLimit {
        /// The move, counted from 0.
        index: u32,
        /// Letter of the axis.
        axis: char,
        /// Which limit.
        quantity: &'static str,
        /// How much of it remains needed.
        factor: f64,
    },
    /// The tool points along an axis that would have to jump.
    #[error(
        "move {index}: at its start the tool points along axis {axis}, which stands at {from} rad and must be at {to} rad for \
         the tool to go on, {} rad away; tip {tip:.6?} mm, orientation {tool:.6?}",
        (to - from).abs()
    )]
    Pole {
        /// The move, counted from 0.
        index: u32,
        /// Letter of the axis.
        axis: char,
        /// Where the axis stands, rad.
        from: f64,
        /// Where it must be, rad.
        to: f64,
        /// Tool tip, mm.
        tip: [f64; 3],
        /// Tool orientation.
        tool: [f64; 3],
    },
    /// Two orientations in a row point opposite ways.
    #[error(
        "move {index}: from orientation {from:.6?} to orientation {to:.6?} the tool turns around, about an axis that is open; give a \
         pose between them, or the axis"
    )]
    Opposite {
        /// The move, counted from 0.
        index: u32,
        /// Orientation before.
        from: [f64; 3],
        /// Orientation after.
        to: [f64; 3],
    },
    /// A turn of the tool alone needs a rate.
    #[error(
        "move {index}: the tool turns without a way of its tip, so a rate or a duration must be given"
    )]
    NoRate {
        /// The move, counted from 0.
        index: u32,
    },
    /// A move came after the end was announced.
    #[error("move {index}: it comes after the end of the path")]
    Finished {
        /// The move, counted from 0.
        index: u32,
    },
}

impl FiveAxisError {
    /// The move that is refused, counted from 0, where there is one.
    #[must_use]
    pub fn index(&self) -> Option<u32> {
        match self {
            Self::FilterCount { .. } | Self::Chain(_) => None,
            Self::Path { index, .. }
            | Self::Machine { index, .. }
            | Self::NoAxis { index, .. }
            | Self::AxisLimit { index, .. }
            | Self::Pole { index, .. }
            | Self::Opposite { index, .. }
            | Self::NoRate { index }
            | Self::Finished { index } => Some(*index),
        }
    }
}
