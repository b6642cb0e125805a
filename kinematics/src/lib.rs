//! Words and geometry of motion: limits, toolpaths, corners, timed pieces, and the judge.
//!
//! Everything is in mm, s and rad; coordinates are one per axis in path order. This crate plans
//! nothing: it holds what every method speaks of, and [`verify`](mod@verify), which judges any of
//! them.

pub mod numeric;
pub mod vector;
pub mod verify;

mod arc;
mod axis_vector;
mod corner;
mod error;
mod great_circle;
mod intake;
mod limits;
mod machine;
mod pause;
mod piece;
mod plan;
mod planner;
mod pose;
mod pose_leg;
mod pose_move;
mod pose_piece;
mod sample;
mod tolerance;
mod toolpath;

pub use arc::Arc;
pub use axis_vector::{AxisVector, MOST_AXES, MOST_SOLUTIONS, Solutions};
pub use corner::Corner;
pub use error::{LimitsError, ToolpathError};
pub use great_circle::{GreatCircle, angle_between, turned};
pub use intake::Intake;
pub use limits::{AxisLimits, Limits, Tangential, largest_multiple};
pub use machine::{Axis, AxisKind, KinematicsError, MachineKinematics};
pub use nalgebra;
pub use pause::Pause;
pub use piece::{Piece, Serves};
pub use plan::{Plan, Sampler, Trajectory};
pub use planner::{MotionPlanner, PlanError, WindowTally};
pub use pose::ToolPose;
pub use pose_leg::{PoseLeg, PosePath};
pub use pose_move::{PoseEnd, PoseFeed, PoseMove};
pub use pose_piece::{AxesPiece, CubicInTime, PosePiece, RotaryPiece, ToolPiece, Turn, cubic_at};
pub use sample::{Sample, SamplePeriod};
pub use tolerance::{Feedrate, OrientationTolerance, Tolerance};
pub use toolpath::{Move, Path, Toolpath, check_contact};
pub use vector::Vector;
pub use verify::pose::{PoseJudge, PoseReport, PoseViolation};
pub use verify::{
    Gap, Gaps, Judge, Peak, Place, Report, SetPointJudge, Unseen, VerifyError, Violation, verify,
    verify_set_points,
};
