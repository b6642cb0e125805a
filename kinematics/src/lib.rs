//! Defines the shared types of motion: limits, toolpaths, corners, tool poses and timed pieces.
//!
//! Everything is in mm, s and rad; coordinates are one per axis in path order. This crate plans
//! nothing and judges nothing: every planner emits its [`Piece`]s, and the crate `verify` judges them.

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

mod arc;
mod axis_vector;
mod corner;
mod error;
mod limits;
mod machine;
#[cfg(not(feature = "std"))]
#[doc(hidden)]
pub mod no_std;
pub mod numeric;
mod path_cursor;
mod path_side;
mod pause;
mod piece;
mod plan;
mod planner;
mod pose;
mod reserve;
mod sample;
mod time_law;
mod tolerance;
mod toolpath;
pub mod vector;
mod vibration;

pub use arc::Arc;
pub use axis_vector::{AxisVector, MAX_AXES, MAX_SOLUTIONS, Solutions};
pub use corner::Corner;
pub use error::{LimitsError, ToolpathError};
pub use limits::{AxisLimits, Limits, PathLimits, largest_multiple};
pub use machine::{Axis, AxisKind, KinematicsError, MachineKinematics};
pub use nalgebra;
pub use path_cursor::PathCursor;
pub use path_side::PathSide;
pub use pause::Pause;
pub use piece::{MoveRange, Piece};
pub use plan::{Plan, Sampler, Trajectory};
pub use planner::{MotionPlanner, PlanError, WindowTally};
pub use pose::great_circle::{GreatCircle, angle_between, turned};
pub use pose::leg::{PoseLeg, PosePath};
pub use pose::moves::{PoseEnd, PoseFeed, PoseMove};
pub use pose::piece::{AxesPiece, CubicInTime, PosePiece, RotaryPiece, ToolPiece, Turn, cubic_at};
pub use pose::tool_pose::ToolPose;
pub use reserve::Reserve;
pub use sample::{Sample, SamplePeriod};
pub use time_law::TimeLaw;
pub use tolerance::{Feedrate, OrientationTolerance, Tolerance};
pub use toolpath::{Move, Path, Toolpath, check_contact};
pub use vector::Vector;
pub use vibration::{
    AxisMode, AxisModes, AxisModesError, MAX_MODES, Mode, ModeError, ModeState, Resonator,
    Transition,
};
