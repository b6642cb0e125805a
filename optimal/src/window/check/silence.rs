//! Checks whether every mode of vibration rests where a motion through a window ends.
//!
//! Source: ours. The jerks that were accepted are integrated through every mode. Not here: limits and tolerance.

use crate::window::check::intervals;
use crate::window::swings::Swings;
use crate::window::{Window, WindowMotion};

/// What may be left of a mode, as a share of what full acceleration bends at rest.
const LEFT: f64 = 1e-3;

/// Whether every mode of a window rests at the end of an accepted motion; `swings` is scratch.
pub(crate) fn comes_to_rest<const N: usize>(
    window: &Window<'_, N>,
    motion: &WindowMotion<N>,
    swings: &mut Swings,
) -> bool {
    let Some(silence) = &window.silence else {
        return true;
    };
    swings.start_from(silence.start);
    let intervals = intervals(window.segments, &motion.durations);
    for (((_, interval), state), jerk) in intervals.zip(&motion.states).zip(&motion.jerks) {
        swings.pass(&state.acceleration, jerk, interval);
    }
    swings.largest() <= LEFT
}
