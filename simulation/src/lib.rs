//! Simulates what planned motion becomes on the part: feed drives with friction and a force limit, flexible modes, and the
//! error of the tool.
//!
//! A drive is a P-PI cascade with feedforward around an exactly discretised plant ([`Drive`]). A [`Simulator`] observes the
//! pieces of a plan and measures two errors: the servo error, to the planned motion, and the part error, to the programmed
//! path. Forces are specific: force per mass, in mm/s² or rad/s². Not here: planning, machines and text.

mod axes;
mod drive;
mod error;
mod fit;
mod foot;
mod friction;
mod gains;
mod linear;
mod model;
mod outcome;
mod plant;
mod poses;
mod refine;
mod response;
mod ring;
mod serving;
mod settings;
mod simulator;
mod zero_phase;

pub use axes::DrivenAxis;
pub use drive::Drive;
pub use error::{DriveError, SimulationError};
pub use fit::{Fit, FitError, FittedParameter, Parameter, Recording, fit, free_oscillation};
pub use friction::Friction;
pub use gains::{GainSettings, Gains};
pub use model::{DriveModel, LoopReport, ResponsePoint};
pub use outcome::{AxisOutcome, ErrorFigure, ModeOutcome, Outcome, PoseOutcome};
pub use plant::{FlexibleMode, MAX_MODES};
pub use poses::{PoseInstant, PoseSetPoint, PoseSimulator};
pub use refine::Interpolation;
pub use settings::{DriveSettings, Feedforward};
pub use simulator::{Instant, SHOWN_MODES, SimulationSettings, Simulator};

#[cfg(test)]
mod tests;
