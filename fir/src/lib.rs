//! FIR interpolation: a feedrate that is commanded in rectangular pulses becomes smooth by passing
//! through moving averages, which round the corners of the path, too, and silence the modes whose
//! periods they have.
//!
//! [`FilterChain`] is a chain of moving averages with its exact responses. This crate does not know
//! kinematic corner smoothing, machines or programs.

mod chain;
mod error;
mod kernel;

pub use chain::{FilterChain, MOST_FILTERS};
pub use error::FirError;
