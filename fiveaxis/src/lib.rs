//! Plans tool tip and tool orientation together, inside both tolerances and the limits of every
//! axis of the machine.
//!
//! Source: chapter 5 of the dissertation, with closed forms instead of its quartics. [`PosePlanner`]
//! takes legs of poses and gives pieces of motion; [`PoseMethod`] says how corners are taken. This
//! crate knows machines by forward and inverse kinematics only, and no program.

mod axis_limits;
mod error;
mod output;
mod planner;
mod pose;
mod settings;
mod singularity;
mod timing;

pub use error::FiveAxisError;
pub use output::sampler::{PoseSampler, PoseTick};
pub use planner::{PosePlanner, Slowdown};
pub use pose::block::PoseBlock;
pub use pose::corner::PoseCorner;
pub use pose::resolve::Resolver;
pub use pose::start::start_of;
pub use pose::swing::{RotarySwing, Swing};
pub use settings::{PoseMethod, PoseSettings};
