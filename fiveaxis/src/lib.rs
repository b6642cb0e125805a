//! Tool tip and tool orientation together: pose motion without stops, inside both tolerances and the
//! limits of every axis of the machine behind.
//!
//! Source: chapter 5 of the dissertation, with closed forms instead of its quartics. [`PosePlanner`]
//! takes legs of poses and gives pieces of motion; [`PoseMethod`] says how corners are taken. This
//! crate knows machines by forward and inverse kinematics only, and no program.

mod accumulate;
mod block;
mod corner;
mod cuts;
mod error;
mod follow;
mod joint;
mod lay;
mod planner;
mod pole;
mod pulses;
mod relax;
mod resolve;
mod sampler;
mod screen;
mod series;
mod settings;
mod start;
mod steps;
mod swing;
mod timing;
mod tool;
mod way;
mod window;

pub use block::PoseBlock;
pub use corner::PoseCorner;
pub use error::FiveAxisError;
pub use planner::{PosePlanner, Slowdown};
pub use resolve::Resolver;
pub use sampler::{PoseSampler, PoseTick};
pub use settings::{PoseMethod, PoseSettings};
pub use start::start_of;
pub use swing::{RotarySwing, Swing};
