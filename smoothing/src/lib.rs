//! Kinematic corner smoothing: the axis velocities are blended around each corner inside the corner
//! tolerance, without splines, and a look-ahead window shares short moves between the corners.
//!
//! [`KinematicSmoothing`] plans while a path streams in; [`plan`] does so for a whole toolpath. The
//! corner motions [`Interrupted`] and [`Uninterrupted`] can be used by themselves. This crate does
//! not know filters, machines or programs.

mod bezier;
mod chords;
mod corners;
mod interrupted;
mod lattice;
mod leg;
mod merge;
mod method;
mod overlap;
mod pieces;
mod planner;
mod scale;
mod section;
mod select;
mod stop_start;
mod stretch;
mod superposed;
mod turn;
mod two_jerks;
mod uninterrupted;
mod window;

pub use bezier::{BezierSmoothing, plan_bezier};
pub use interrupted::Interrupted;
pub use method::{Method, Settings};
pub use planner::{KinematicSmoothing, plan};
pub use stop_start::StopStart;
pub use turn::{Form, Part, Turn, TurnShape};
pub use uninterrupted::Uninterrupted;

/// Turns of a unit direction smaller than this are taken for straight: the velocity then jumps by
/// less than a billionth of the feedrate, which no drive resolves.
pub(crate) const STRAIGHT: f64 = 1e-12;
