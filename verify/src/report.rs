//! Reports findings: peaks with their time and place, and violations.
//!
//! Source: "did, with this result" is data, never an error. Not here: how it was found.

use super::violation::Violation;
use crate::quality::Smoothness;
use crate::set_points::spacing::Gaps;

/// How many violations of one kind a report quotes; all are counted.
const EXAMPLES_PER_KIND: u8 = 10;

/// A move of the path, and the program line that it comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The move, counted from 0 in path order.
    pub mv: u32,
    /// The program line, counted from 1; 0 when the move comes from none.
    pub line: u32,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.line == 0 {
            write!(f, "move {}", self.mv)
        } else {
            write!(f, "move {}, line {}", self.mv, self.line)
        }
    }
}

/// The largest value of a quantity over the whole motion, never negative, and where it occurs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peak {
    /// The value.
    pub value: f64,
    /// When, s from the start of the motion.
    pub time: f64,
    /// On which move.
    pub place: Place,
}

impl Peak {
    pub(crate) fn raise(&mut self, value: f64, time: f64, place: Place) {
        if value > self.value {
            *self = Self { value, time, place };
        }
    }
}

/// What a motion did: how long it took, how close to each bound it came, and what it broke.
///
/// Deviations are bounds from above, within a millionth or a picometre of the truth, whichever is
/// larger. For set-points every value is what is certain in spite of their rounding.
#[derive(Clone, Debug, PartialEq)]
pub struct Report<const N: usize> {
    /// How long the motion lasts.
    pub cycle_time: f64,
    /// Length of the path.
    pub path_length: f64,
    /// How many moves the path has.
    pub moves: u32,
    /// How many pieces of motion, or set-points, were judged.
    pub observed: u64,
    /// Largest velocity of each axis.
    pub peak_velocity: [Peak; N],
    /// Largest acceleration of each axis.
    pub peak_acceleration: [Peak; N],
    /// Largest jerk of each axis.
    pub peak_jerk: [Peak; N],
    /// Largest speed.
    pub peak_speed: Peak,
    /// Largest distance of the motion from the path.
    pub deviation: Peak,
    /// Largest distance from the path as a share of the tolerance there (with its rounding room).
    pub deviation_ratio: Peak,
    /// How far the motion passes from the corner that it misses by most.
    pub corner_error: Peak,
    /// The same as a share of the tolerance of the corner (with its rounding room).
    pub corner_ratio: Peak,
    /// Largest distance between the end of a piece and the start of the next, or between the end
    /// that a piece states and the one that it reaches. Zero for set-points.
    pub position_jump: Peak,
    /// Largest change of the velocity of an axis between two pieces. Zero for set-points.
    pub velocity_jump: Peak,
    /// Largest change of the acceleration of an axis between two pieces. Zero for set-points.
    pub acceleration_jump: Peak,
    /// Largest speed above the feedrate, mm/s; zero where the feedrate is kept.
    pub feedrate_overshoot: Peak,
    /// How smooth the motion is; `None` for set-points.
    pub smoothness: Option<Smoothness<N>>,
    /// How many violations there are.
    pub violations: u64,
    /// The first few violations of each kind, in the order found.
    pub examples: Vec<Violation>,
    /// Set-points that are too far apart to be judged; none for pieces.
    pub gaps: Gaps,
    counts: [u8; Violation::KINDS],
}

impl<const N: usize> Report<N> {
    pub(super) fn new() -> Self {
        Self {
            cycle_time: 0.0,
            path_length: 0.0,
            moves: 0,
            observed: 0,
            peak_velocity: [Peak::default(); N],
            peak_acceleration: [Peak::default(); N],
            peak_jerk: [Peak::default(); N],
            peak_speed: Peak::default(),
            deviation: Peak::default(),
            deviation_ratio: Peak::default(),
            corner_error: Peak::default(),
            corner_ratio: Peak::default(),
            position_jump: Peak::default(),
            velocity_jump: Peak::default(),
            acceleration_jump: Peak::default(),
            feedrate_overshoot: Peak::default(),
            smoothness: None,
            violations: 0,
            examples: Vec::new(),
            gaps: Gaps::default(),
            counts: [0; Violation::KINDS],
        }
    }

    /// Whether the motion breaks nothing, and its set-points show that.
    #[must_use]
    pub fn passes(&self) -> bool {
        self.violations == 0 && self.gaps.is_empty()
    }

    pub(super) fn add(&mut self, violation: Violation) {
        self.violations += 1;
        let count = &mut self.counts[violation.kind()];
        if *count < EXAMPLES_PER_KIND {
            *count += 1;
            self.examples.push(violation);
        }
    }
}
