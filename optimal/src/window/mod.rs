//! Defines a window of straight segments, the motion through it, and the seam to its solver.
//!
//! Source: the receding horizon over which time optimality is sought; the motion is one of constant
//! jerk per interval, as in section 2.2. Not here: how windows follow one another, and any solver.

pub(crate) mod check;
pub(crate) mod horizon;
pub(crate) mod initial_guess;
pub(crate) mod output;
pub(crate) mod shaped_line;
pub(crate) mod straight_line;
pub(crate) mod swings;

use crate::solver::budget::Budget;
use thiserror::Error;
use toolglide_kinematics::{AxisMode, Limits, ModeState, Vector};

/// One straight piece of a window: the tube it may use and how finely its time is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowSegment<const N: usize> {
    /// Where it starts, mm; the end of the segment before.
    pub start: Vector<N>,
    /// Where it ends, mm; not the start.
    pub end: Vector<N>,
    /// How far the motion may be from the segment, mm.
    pub tolerance: f64,
    /// How near the motion passes the end, mm; `None` where the end is no corner of the path, and at
    /// the last segment.
    pub corner_tolerance: Option<f64>,
    /// Largest speed along the segment, mm/s; may be infinite.
    pub feedrate: f64,
    /// Into how many intervals of equal duration its time is cut; at least [`WindowSegment::MIN_STEPS`].
    pub steps: usize,
    /// The arc of which this is a chord, where the motion shall follow it; `None` where all of the tube serves.
    pub follow: Option<Follow<N>>,
    /// How far the motion may leave the line on one side, over the first and over the second half of its length.
    pub walls: [Option<Wall<N>>; 2],
}

/// A side of a line that the motion keeps away from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall<const N: usize> {
    /// Unit vector across the line, to the side that is kept.
    pub outward: Vector<N>,
    /// How far the motion may go there, mm.
    pub allowed: f64,
    /// Between which distances along the line from the start of its segment the side must be kept, mm. A solver may keep
    /// it wherever its half of the segment is.
    pub between: [f64; 2],
}

/// An arc over a chord that the motion shall follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow<const N: usize> {
    /// From the middle of the chord to the middle of the arc, mm.
    pub sagitta: Vector<N>,
    /// How far the motion may be from the arc, mm.
    pub radius: f64,
}

impl<const N: usize> WindowSegment<N> {
    /// Fewest intervals of a segment: from rest to rest needs four, and with four no interval touches
    /// the durations of more than two segments.
    pub const MIN_STEPS: usize = 4;
}

/// Position, velocity and acceleration at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndState<const N: usize> {
    /// Position, mm.
    pub position: Vector<N>,
    /// Velocity, mm/s.
    pub velocity: Vector<N>,
    /// Acceleration, mm/s².
    pub acceleration: Vector<N>,
}

impl<const N: usize> EndState<N> {
    /// At rest at a point.
    #[must_use]
    pub fn rest(position: Vector<N>) -> Self {
        Self {
            position,
            velocity: Vector::zeros(),
            acceleration: Vector::zeros(),
        }
    }

    /// The state after `duration` (s) of constant `jerk` (mm/s³).
    #[must_use]
    pub fn after(&self, duration: f64, jerk: &Vector<N>) -> Self {
        let h = duration;
        Self {
            position: self.position
                + (self.velocity + (self.acceleration + jerk * (h / 3.0)) * (0.5 * h)) * h,
            velocity: self.velocity + (self.acceleration + jerk * (0.5 * h)) * h,
            acceleration: self.acceleration + jerk * h,
        }
    }
}

/// Modes of vibration that must rest where a window ends, and how they swing where it starts.
#[derive(Clone, Copy, Debug)]
pub struct Silence<'a> {
    /// The modes.
    pub modes: &'a [AxisMode],
    /// The state of each at the start, scaled by the limit of acceleration of its axis.
    pub start: &'a [ModeState],
}

/// What is to be passed: segments end to end, and the states before the first and after the last.
#[derive(Clone, Copy, Debug)]
pub struct Window<'a, const N: usize> {
    /// State at the start of the first segment; fixed.
    pub start: EndState<N>,
    /// State at the end of the last segment; fixed.
    pub end: EndState<N>,
    /// The segments, each starting where the one before ends.
    pub segments: &'a [WindowSegment<N>],
    /// Limits of each axis.
    pub limits: &'a Limits<N>,
    /// What must rest at the end beside the motion.
    pub silence: Option<Silence<'a>>,
}

impl<const N: usize> Window<'_, N> {
    /// Number of intervals of all segments.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.segments.iter().map(|segment| segment.steps).sum()
    }
}

/// A motion through a window: a duration per segment, constant jerk per interval.
///
/// Reused between solves, so that nothing is allocated once it has grown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WindowMotion<const N: usize> {
    /// Duration of each segment, s.
    pub durations: Vec<f64>,
    /// States between the intervals, one more than [`Window::steps`]; or none where unknown.
    pub states: Vec<EndState<N>>,
    /// Jerk of each interval, mm/s³; or none where unknown.
    pub jerks: Vec<Vector<N>>,
}

impl<const N: usize> WindowMotion<N> {
    /// No motion yet.
    #[must_use]
    pub fn new() -> Self {
        Self {
            durations: Vec::new(),
            states: Vec::new(),
            jerks: Vec::new(),
        }
    }

    /// Duration of the whole window, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.durations.iter().sum()
    }
}

/// What finding a motion took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solved {
    /// Duration of the motion, s.
    pub duration: f64,
    /// Convex problems solved.
    pub solves: u32,
    /// Steps of the interior-point method in all of them.
    pub iterations: u32,
}

/// What a window lacks to be one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum WindowDefect {
    /// There is no segment.
    #[error("it has no segment")]
    Empty,
    /// A segment has fewer intervals than [`WindowSegment::MIN_STEPS`].
    #[error("segment {segment} has too few intervals")]
    TooFewSteps {
        /// The segment, counted from 0.
        segment: usize,
    },
    /// Start and end of a segment coincide.
    #[error("segment {segment} has no length")]
    NoLength {
        /// The segment, counted from 0.
        segment: usize,
    },
    /// A tolerance or a feedrate is not positive.
    #[error("segment {segment} has a tolerance or a feedrate that is not positive")]
    NotPositive {
        /// The segment, counted from 0.
        segment: usize,
    },
    /// The guess has another shape than the window, or durations that are not positive.
    #[error("the guess does not fit its segments")]
    Guess,
}

/// Why no motion was found. The motion that was handed in is then of no use.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Unsolved {
    /// What was asked is no window.
    #[error("the window cannot be solved: {0}")]
    Window(#[from] WindowDefect),
    /// No motion inside limits and tolerance was found within the budget.
    #[error("after {solves} solves the motion still exceeds a bound by the share {excess}")]
    NotConverged {
        /// Convex problems solved.
        solves: u32,
        /// By which share the best motion exceeds a bound.
        excess: f64,
    },
    /// The arithmetic broke down.
    #[error("after {solves} solves the arithmetic broke down")]
    Numerical {
        /// Convex problems solved.
        solves: u32,
    },
}

/// Finds a fast motion through a window, starting from a guess.
pub trait WindowSolver<const N: usize> {
    /// Finds a motion within a budget, and takes away from it what it has done.
    ///
    /// `motion` holds the guess on entry: durations always; states and jerks all or none, and they
    /// need not fit each other. It holds the answer on success.
    ///
    /// # Errors
    /// [`Unsolved`] when there is no answer; `motion` is then of no use.
    fn solve(
        &mut self,
        window: &Window<'_, N>,
        motion: &mut WindowMotion<N>,
        budget: &mut Budget,
    ) -> Result<Solved, Unsolved>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constant_jerk_from_rest_goes_with_the_third_power_of_time() {
        let from = EndState::rest(Vector::<1>::new(2.0));
        let state = from.after(0.5, &Vector::<1>::new(48.0));
        assert!((state.position[0] - 3.0).abs() < 1e-14, "{state:?}");
        assert!((state.velocity[0] - 6.0).abs() < 1e-14, "{state:?}");
        assert!((state.acceleration[0] - 24.0).abs() < 1e-14, "{state:?}");
    }
}
