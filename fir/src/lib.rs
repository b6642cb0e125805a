//! FIR interpolation: a feedrate that is commanded in rectangular pulses becomes smooth by passing
//! through moving averages, which round the corners of the path, too, and silence the modes whose
//! periods they have.
//!
//! [`FilterChain`] is a chain of moving averages with its exact responses. [`FirInterpolation`] plans
//! while a path streams in; [`plan`] does so for a whole toolpath. This crate does not know
//! kinematic corner smoothing, machines or programs.

mod arcs;
mod bend;
mod bound;
mod chain;
mod chords;
mod circle;
mod command;
mod cubic;
mod error;
mod kernel;
mod lookahead;
mod merge;
mod mode;
mod planner;
mod pulse;
mod queue;
mod resonator;
mod settings;
mod sweep;
mod taps;
mod tick_pulse;
mod ticks;
mod train;

pub use chain::{FilterChain, LONGEST_TIME_CONSTANT, MOST_FILTERS, SHORTEST_TIME_CONSTANT};
pub use circle::largest_circle_feed;
pub use error::FirError;
pub use mode::Mode;
pub use planner::{FirInterpolation, plan};
pub use resonator::Resonator;
pub use settings::{Method, Settings};
pub use tick_pulse::TickPulse;
pub use ticks::TickFilter;
pub use train::PulseTrain;
