//! States that the modes of vibration rest at the end of a window, as conditions on all jerks and stretches.
//!
//! Deflection and rate of every mode are zero at the end; what a wrong frequency would add to either is as small as
//! costs little time. They
//! follow from the state of the mode at the start, from the acceleration there, and from every jerk; how, is pulled
//! back from the end to the start. With the durations free they are linearised as the rest of the problem is.
//!
//! Source: ours; see [`Transition`]. Not here: how the conditions are met, see
//! [`border`](crate::solver::interior::border).

use crate::problem::Problem;
use crate::window::Silence;
use toolglide_kinematics::{ModeState, Transition};

/// Conditions of one mode.
const EACH: usize = 4;

/// Of which the first are met exactly: deflection and rate.
const HARD: usize = 2;

/// All conditions of a window; none where its end need not be silent.
#[derive(Clone, Debug, Default)]
pub(crate) struct Conditions {
    axes: Vec<usize>,
    /// Slopes by jerks and by stretches, condition by condition, and the values without either.
    by_jerk: Vec<f64>,
    by_stretch: Vec<f64>,
    constants: Vec<f64>,
    steps: usize,
    segments: usize,
    /// Step of the mode at hand over an interval of each segment.
    transitions: Vec<Transition>,
    /// How the state behind every interval changes with its stretch.
    by_own_stretch: Vec<ModeState>,
}

impl Conditions {
    /// Makes room for so many modes over windows of so many segments and intervals.
    pub(super) fn reserve(&mut self, modes: usize, segments: usize, steps: usize) {
        self.axes.reserve(EACH * modes);
        self.by_jerk.reserve(EACH * modes * steps);
        self.by_stretch.reserve(EACH * modes * segments);
        self.constants.reserve(EACH * modes);
        self.transitions.reserve(segments);
        self.by_own_stretch.reserve(steps);
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.axes.len()
    }

    /// The axis whose jerks a condition is about.
    pub(crate) fn axis(&self, row: usize) -> usize {
        self.axes[row]
    }

    /// Whether a condition is met only as far as that costs little: what a wrong frequency would add.
    pub(crate) fn is_soft(&self, row: usize) -> bool {
        row % EACH >= HARD
    }

    /// How a condition goes with the jerk of an interval.
    #[inline(always)]
    pub(crate) fn by_jerk(&self, row: usize, interval: usize) -> f64 {
        self.by_jerk[row * self.steps + interval]
    }

    /// How it goes with the stretch of a segment.
    #[inline(always)]
    pub(crate) fn by_stretch(&self, row: usize, segment: usize) -> f64 {
        self.by_stretch[row * self.segments + segment]
    }

    /// What it comes to without jerks and stretches.
    pub(crate) fn constant(&self, row: usize) -> f64 {
        self.constants[row]
    }
}

impl<const N: usize> Problem<N> {
    /// States the conditions for the durations and the base at hand; none without modes.
    pub(crate) fn set_silence(&mut self, silence: Option<&Silence<'_>>) {
        let mut ends = std::mem::take(&mut self.conditions);
        ends.axes.clear();
        ends.by_jerk.clear();
        ends.by_stretch.clear();
        ends.constants.clear();
        (ends.steps, ends.segments) = (self.steps(), self.segments());
        if let Some(silence) = silence {
            for (mode, start) in silence.modes.iter().zip(silence.start) {
                let h = self.tracks.iter().map(|track| track.duration);
                ends.transitions.clear();
                ends.transitions
                    .extend(h.map(|duration| Transition::new(&mode.mode, duration)));
                self.trace(&mut ends, mode.axis, start);
                self.pull_back(&mut ends, mode.axis, start);
            }
        }
        self.conditions = ends;
    }

    /// Follows a mode under the base.
    fn trace(&self, ends: &mut Conditions, axis: usize, start: &ModeState) {
        ends.by_own_stretch.clear();
        if !self.stretching {
            return;
        }
        let by_acceleration = self.by_acceleration[axis];
        let mut state = *start;
        for interval in 0..self.steps() {
            let acceleration = self.base[interval][2][axis] * by_acceleration;
            let jerk = self.base_jerks[interval][axis] * by_acceleration;
            let segment = self.segment_of[interval];
            let step = &ends.transitions[segment];
            let h = self.tracks[segment].duration;
            let by_duration = step.by_duration(&state, acceleration, jerk);
            ends.by_own_stretch.push(by_duration.map(|value| h * value));
            state = step.after(&state, acceleration, jerk);
        }
    }

    /// Slopes of the conditions of a mode, from the end to the start.
    fn pull_back(&self, ends: &mut Conditions, axis: usize, start: &ModeState) {
        let by_acceleration = self.by_acceleration[axis];
        let (steps, segments) = (self.steps(), self.segments());
        for condition in 0..EACH {
            let first_jerk = ends.by_jerk.len();
            let first_stretch = ends.by_stretch.len();
            ends.by_jerk.resize(first_jerk + steps, 0.0);
            ends.by_stretch.resize(first_stretch + segments, 0.0);
            let mut functional = ModeState::default();
            functional[condition] = 1.0;
            let mut by_acceleration_there = 0.0;
            for interval in (0..steps).rev() {
                let segment = self.segment_of[interval];
                let step = &ends.transitions[segment];
                let h = self.tracks[segment].duration;
                if let Some(by_stretch) = ends.by_own_stretch.get(interval) {
                    let jerk = self.base_jerks[interval][axis] * by_acceleration;
                    let mut slope = by_acceleration_there * h * jerk;
                    for (weight, value) in functional.iter().zip(by_stretch) {
                        slope += weight * value;
                    }
                    ends.by_stretch[first_stretch + segment] += slope;
                }
                let (before, by_acceleration_here, by_jerk) = step.pulled_back(&functional);
                ends.by_jerk[first_jerk + interval] =
                    (by_jerk + by_acceleration_there * h) * by_acceleration;
                by_acceleration_there += by_acceleration_here;
                functional = before;
            }
            let mut constant = by_acceleration_there * self.start[2][axis] * by_acceleration;
            for (weight, value) in functional.iter().zip(start) {
                constant += weight * value;
            }
            ends.constants.push(constant);
            ends.axes.push(axis);
        }
    }
}
