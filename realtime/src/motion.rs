//! Evaluates the executed motion between two decisions.
//!
//! Source: ours. A step is one stretch of constant `u`, or a few where it passes a rest of the plan, at which the rate may
//! jump. At constant rate time is counted from where that began, not added up, so that at rate 1 the ticks are those of
//! [`toolglide_kinematics::Sampler`] to the bit.

use crate::law::Rate;
use crate::step::{State, moved};
use crate::track::Track;
use toolglide_kinematics::{Sample, TimeLaw, Vector};

/// Stretches of a step at most; a step that passes more rests waits at the last one.
pub(crate) const MAX_STRETCHES: usize = 4;

/// A stretch of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretch {
    /// Time since the start of the step, s.
    pub(crate) begin: f64,
    pub(crate) state: State,
    pub(crate) u: f64,
}

impl Stretch {
    /// The time law of it up to `end` of the step.
    pub(crate) fn law(&self, end: f64) -> TimeLaw {
        TimeLaw {
            duration: end - self.begin,
            planned: self.state.tau,
            rate: self.state.rate.r,
            change: self.state.rate.s,
            bend: self.u,
        }
    }

    /// The state at a time of the step.
    pub(crate) fn at(&self, t: f64) -> State {
        let f = t - self.begin;
        State {
            at: self.state.at,
            tau: moved(&self.state, self.u, f),
            rate: self.state.rate.after(self.u, f),
        }
    }
}

/// Executed position, velocity, acceleration and jerk at a place of the plan.
pub(crate) fn executed<const N: usize>(
    track: &Track<N>,
    at: u64,
    tau: f64,
    rate: Rate,
    u: f64,
) -> Sample<N> {
    let entry = track.get(track.seek(at, tau));
    let planned = entry.piece.at(tau - entry.begin);
    if rate.r.to_bits() == 1.0_f64.to_bits() && rate.s.abs() <= 0.0 && u.abs() <= 0.0 {
        return planned;
    }
    let (r, s) = (rate.r, rate.s);
    Sample {
        position: planned.position,
        velocity: planned.velocity * r,
        acceleration: planned.acceleration * (r * r) + planned.velocity * s,
        jerk: planned.jerk * (r * r * r)
            + planned.acceleration * (3.0 * r * s)
            + planned.velocity * u,
    }
}

/// At rest where a piece of the plan begins or ends.
pub(crate) fn resting<const N: usize>(at: Vector<N>) -> Sample<N> {
    Sample::at_rest(at)
}
