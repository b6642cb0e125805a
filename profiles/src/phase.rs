//! Integrates phases of constant jerk forward.
//!
//! Source: section 2.2, equations 2.1 to 2.6. Not here: how long the phases must last.

use crate::profile::State;

/// A stretch of constant jerk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Phase {
    /// How long it lasts, not negative.
    pub duration: f64,
    /// Its jerk.
    pub jerk: f64,
}

/// The state after all phases, from `start`.
pub(crate) fn integrate(start: State, phases: &[Phase]) -> State {
    phases.iter().fold(start, |state, phase| {
        State {
            jerk: phase.jerk,
            ..state
        }
        .after(phase.duration)
    })
}

/// The state at `time` within the phases.
pub(crate) fn state_at(start: State, phases: &[Phase], time: f64) -> State {
    let mut state = start;
    let mut left = time.max(0.0);
    for phase in phases {
        state.jerk = phase.jerk;
        if left < phase.duration {
            return state.after(left);
        }
        state = state.after(phase.duration);
        left -= phase.duration;
    }
    state
}

/// Fills in the times at which the phases begin and end.
pub(crate) fn knots<const KNOTS: usize>(phases: &[Phase]) -> [f64; KNOTS] {
    let mut knots = [0.0; KNOTS];
    let mut time = 0.0;
    for (knot, phase) in knots.iter_mut().skip(1).zip(phases) {
        time += phase.duration;
        *knot = time;
    }
    knots
}
