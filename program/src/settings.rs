//! Holds the settings of a reader of programs.
//!
//! Not here: what the program itself says.

use toolglide_kinematics::{Tolerance, Vector};

/// How a program is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Tolerance until the program says `G64 P`, and again after a `G64` without `P`.
    pub tolerance: Tolerance,
    /// Whether every `P` of a `G64` is ignored in favour of `tolerance`.
    pub override_tolerance: bool,
    /// Where the motion begins.
    pub start: Vector<3>,
    /// Which of X, Y and Z the machine has; a word for another one is refused.
    pub axes: [bool; 3],
    /// Whether words that certainly do not move an axis become warnings where they would be
    /// refused.
    pub lenient: bool,
    /// Lines of loops and subroutines that are run before a program is taken for endless.
    pub steps: u64,
    /// Those of them that may be run without a move before a program is taken for endless; a line of
    /// more than 64 bytes counts as several.
    pub still_steps: u64,
}

/// Lines of loops and subroutines that a program may run where nobody says otherwise: about a minute
/// of reading.
pub const MAX_STEPS: u64 = 100_000_000;

/// Lines of loops and subroutines that a program may run without a move where nobody says otherwise:
/// half a second of reading.
pub const MAX_STILL_STEPS: u64 = 500_000;

impl Settings {
    /// Strict reading for a machine of three axes that starts at the origin.
    #[must_use]
    pub fn new(tolerance: Tolerance) -> Self {
        Self {
            tolerance,
            override_tolerance: false,
            start: Vector::zeros(),
            axes: [true; 3],
            lenient: false,
            steps: MAX_STEPS,
            still_steps: MAX_STILL_STEPS,
        }
    }
}
