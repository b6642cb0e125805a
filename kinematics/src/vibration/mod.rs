//! Describes modes of vibration of an axis and integrates them under a motion.
//!
//! Source: the oscillator `x'' + 2 d w x' + w² x = -a` of section 4.2.2, driven by the acceleration of an axis.
//! Planners, the judge and the spectrum share it. Not here: filters, and planning.

mod axis_modes;
mod mode;
mod resonator;
mod transition;

pub use axis_modes::{AxisMode, AxisModes, AxisModesError, MAX_MODES};
pub use mode::{Mode, ModeError};
pub use resonator::Resonator;
pub use transition::{ModeState, Transition};
