//! Executes planned motion in real time: hold, override, resume, reverse and abort, inside every limit.
//!
//! Planned pieces stay as they are; the [`Executor`] changes the rate at which their time passes, so that the path is the
//! planned one to the last bit. It finds the strongest change that velocity, acceleration and jerk of every axis allow, and
//! promises the longest time to a stop before it is needed. It knows no planner, no program and no clock.

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

mod backup;
mod commands;
mod decide;
mod event;
mod executor;
mod feeding;
mod law;
mod micro_move;
mod motion;
mod pose;
mod rests;
mod settings;
mod step;
mod terms;
mod track;

pub use commands::{CommandError, Commands, Taken};
pub use event::Event;
pub use executor::{Activity, Executor, Tick};
pub use feeding::FeedError;
pub use pose::{ExecutedPose, PoseExecutor, PoseSettings};
pub use settings::{OverrideKind, Settings, SettingsError};
pub use terms::{Class, Terms};

/// Compiles and runs the code of the guide.
#[cfg(doctest)]
#[doc = include_str!("../../docs/embedding.md")]
struct Guide;
