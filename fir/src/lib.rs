//! Interpolates by FIR filters: moving averages smooth rectangular pulses of feedrate, round the
//! corners of the path, and silence modes of vibration.
//!
//! [`FilterChain`] is a chain of moving averages with its exact responses. [`FirInterpolation`] plans
//! while a path streams in; [`plan`] does so for a whole toolpath. This crate does not know
//! kinematic corner smoothing, machines or programs.

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

mod chords;
mod error;
mod filter;
mod lookahead;
mod planner;
mod pulse;
mod pulse_corner;
mod segment_merger;
mod settings;
mod sweep;
mod ticks;

pub use error::FirError;
pub use filter::chain::{FilterChain, LONGEST_TIME_CONSTANT, MAX_FILTERS, SHORTEST_TIME_CONSTANT};
pub use filter::train::PulseTrain;
pub use lookahead::circle_feed::largest_circle_feed;
pub use planner::{FirInterpolation, plan};
pub use pulse_corner::PulseCorner;
pub use settings::{Method, Settings};
pub use ticks::tick_clock::TickClock;
pub use ticks::tick_filter::TickFilter;
pub use ticks::tick_pulse::TickPulse;
