//! FIR interpolation: a feedrate that is commanded in rectangular pulses becomes smooth by passing
//! through moving averages, which round the corners of the path, too, and silence the modes whose
//! periods they have.
//!
//! [`FilterChain`] is a chain of moving averages with its exact responses. [`FirInterpolation`] plans
//! while a path streams in; [`plan`] does so for a whole toolpath. This crate does not know
//! kinematic corner smoothing, machines or programs.

mod chords;
mod error;
mod filter;
mod lookahead;
mod planner;
mod pulse;
mod segment_merger;
mod settings;
mod sweep;
mod ticks;

pub use error::FirError;
pub use filter::chain::{FilterChain, LONGEST_TIME_CONSTANT, MAX_FILTERS, SHORTEST_TIME_CONSTANT};
pub use filter::mode::Mode;
pub use filter::resonator::Resonator;
pub use filter::train::PulseTrain;
pub use lookahead::circle_feed::largest_circle_feed;
pub use planner::{FirInterpolation, plan};
pub use settings::{Method, Settings};
pub use ticks::tick_filter::TickFilter;
pub use ticks::tick_pulse::TickPulse;
