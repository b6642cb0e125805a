//! Solves jerk-limited motion along one coordinate, and defines the seam of corner blends.
//!
//! A law of motion is solved by its constructor and evaluated through [`Profile`]; every closed form
//! is accepted only after it has been integrated forward and found to meet its request. This crate
//! knows no axes and no path: it works along one coordinate, in mm, s and rad.

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

mod blend;
mod connection;
mod error;
mod feed;
mod jlap;
mod phase;
mod piecewise;
mod profile;
mod rise;

pub use blend::{BlendError, BlendPhase, BlendShape, Blender, Boundary, MAX_PHASES, Part};
pub use connection::SCurveBoundary;
pub use error::ProfileError;
pub use feed::SCurve;
pub use jlap::Jlap;
pub use phase::Phase;
pub use piecewise::{Piecewise, Polynomial};
pub use profile::{Profile, State};
pub use rise::SpeedRamp;
