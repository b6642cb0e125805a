//! Names every reason why a drive is refused or a simulation ends early.

use thiserror::Error;

/// A drive that cannot be: which field, its value, and the bound that it breaks.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{field} is {value}, but must be {bound}")]
pub struct DriveError {
    /// Which field, as machine files call it.
    pub field: String,
    /// Its value.
    pub value: String,
    /// What it must be.
    pub bound: String,
}

impl DriveError {
    /// A field that is refused.
    pub fn new(field: impl Into<String>, value: impl ToString, bound: impl Into<String>) -> Self {
        Self {
            field: field.into(),
            value: value.to_string(),
            bound: bound.into(),
        }
    }
}

/// Why a simulation ends before its motion does.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// A drive is refused.
    #[error("{0}")]
    Drive(#[from] DriveError),
    /// A set-point is no finite number.
    #[error("at {time:.6} s: a set-point is not a finite number")]
    NotFinite {
        /// When, s.
        time: f64,
    },
    /// A drive has left its set-points for good.
    #[error(
        "at {time:.6} s: axis {axis} is {error} mm or rad from its set-point; its loop diverges"
    )]
    Diverged {
        /// When, s.
        time: f64,
        /// Letter of the axis.
        axis: char,
        /// Distance from the set-point, mm or rad.
        error: f64,
    },
    /// The machine cannot take the pose of the simulated axes, or of a set-point.
    #[error("at {time:.6} s: {reason}")]
    Machine {
        /// When, s.
        time: f64,
        /// What the machine says.
        reason: toolglide_kinematics::KinematicsError,
    },
    /// A move does not connect to the path.
    #[error(transparent)]
    Path(#[from] toolglide_kinematics::ToolpathError),
}
