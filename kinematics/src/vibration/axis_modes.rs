//! Lists the modes of vibration of a machine, axis by axis.
//!
//! Source: ours. Not here: what a mode does.

use super::Mode;
use thiserror::Error;

/// Most modes of one axis.
pub const MAX_MODES: usize = 4;

/// Room for the modes of all axes.
const ROOM: usize = 24;

/// A mode and the axis whose acceleration excites it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisMode {
    /// The axis, counted from 0 in path order.
    pub axis: usize,
    /// The mode.
    pub mode: Mode,
}

/// Why modes are too many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum AxisModesError {
    /// An axis has more modes than are taken.
    #[error("axis {axis} has {given} modes, but at most {MAX_MODES} are taken")]
    TooMany {
        /// The axis, counted from 0.
        axis: usize,
        /// How many.
        given: usize,
    },
    /// The machine has more modes than are taken.
    #[error("the machine has {given} modes, but at most {ROOM} are taken")]
    TooManyInAll {
        /// How many.
        given: usize,
    },
}

/// Modes of vibration of all axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxisModes {
    modes: [Option<AxisMode>; ROOM],
    count: usize,
}

impl AxisModes {
    /// The modes of a machine.
    ///
    /// # Errors
    /// [`AxisModesError`] where there are too many.
    pub fn new(modes: &[AxisMode]) -> Result<Self, AxisModesError> {
        for mode in modes {
            let given = modes.iter().filter(|other| other.axis == mode.axis).count();
            if given > MAX_MODES {
                let axis = mode.axis;
                return Err(AxisModesError::TooMany { axis, given });
            }
        }
        if modes.len() > ROOM {
            let given = modes.len();
            return Err(AxisModesError::TooManyInAll { given });
        }
        let mut all = Self::default();
        for (place, mode) in all.modes.iter_mut().zip(modes) {
            *place = Some(*mode);
        }
        all.count = modes.len();
        Ok(all)
    }

    /// The modes, in the order in which they were given.
    pub fn iter(&self) -> impl Iterator<Item = AxisMode> + '_ {
        self.modes.iter().flatten().copied()
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// How long before a place motion must be without acceleration on average for all modes to rest there, s: the longest
    /// period, or half of the periods of all.
    #[must_use]
    pub fn settling_time(&self) -> f64 {
        let all: f64 = self.iter().map(|mode| mode.mode.period()).sum();
        self.longest_period().max(0.55 * all)
    }

    /// The longest period, s; 0 without modes.
    #[must_use]
    pub fn longest_period(&self) -> f64 {
        self.iter()
            .map(|mode| mode.mode.period())
            .fold(0.0, f64::max)
    }
}
