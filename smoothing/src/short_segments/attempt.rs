//! Plans a section repeatedly, each time slower where the plan before exceeded a limit.
//!
//! Source: ours. A plan counts only when every piece of it has been found inside all limits and the tolerance.
//! Not here: what a plan is needed for.

use crate::short_segments::feed_profile::{Filter, SwitchState};
use crate::short_segments::{Continuation, MAX_STEPS, ShortSegmentSmoother};
use toolglide_kinematics::numeric::LIMIT_SLACK;

/// Fewest time steps of one stretch.
const MIN_STEPS: f64 = 4.0;

/// Share of the feedrate by which a change of speed overshoots it, for a time step as long as the ramp.
const OVERSHOOT: f64 = 0.015;

/// Steps by which a motion that lags sets out later than its progress.
const LATE: f64 = 1.75;

/// Rounds of slowing down where a limit or the tolerance is exceeded.
const ROUNDS: usize = 16;

impl<const N: usize> ShortSegmentSmoother<N> {
    pub(super) fn attempt(
        &mut self,
        filter: &Filter,
        ramp: f64,
        most: f64,
        onward: Option<&Continuation<N>>,
    ) -> bool {
        // A change of speed overshoots by about this much when the control points are sharpened.
        let share = if filter.lags {
            1.0 - 4.0 * LIMIT_SLACK
        } else {
            1.0 - OVERSHOOT * (filter.step / ramp).powi(2)
        };
        let start = onward.map_or(SwitchState::AT_REST, |onward| onward.start);
        if !self
            .pace
            .survey(&self.curve, &self.limits, filter, &start, share)
        {
            return false;
        }
        let rounds = if filter.hasty { 2 * ROUNDS } else { ROUNDS };
        for _ in 0..rounds {
            if !self.propose(filter, ramp, most, onward) {
                return false;
            }
            self.proposed += self.spline.pieces() as u64;
            let Some(effort) = self.effort.checked_sub(self.spline.pieces()) else {
                return false;
            };
            self.effort = effort;
            let mut kept = true;
            let mut steady = None;
            for index in 0..self.spline.pieces() {
                // On an arc one piece is like the next, turned, as long as the speed stays.
                let turned = self.spline.steady_turn(index, &self.curve);
                if turned.is_some() && turned == steady {
                    continue;
                }
                steady = turned.filter(|_| self.spline.is_within_any(index, &self.limits));
                if let Some(excess) = self.spline.excess(index, &self.curve, &self.limits) {
                    kept = false;
                    steady = None;
                    let controls = &self.spline.controls[index..index + 4];
                    self.pace
                        .slow(controls[0].distance, controls[3].distance, &excess);
                }
            }
            if kept && filter.averages() && !self.spline.passes_in_order(&self.curve) {
                return false;
            }
            if kept {
                self.spline.handover = self.pace.handover();
                return true;
            }
            self.pace.settle();
        }
        false
    }

    /// Control points of a motion through the stretch; `false` when it takes too long.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "the count is bounded before it is cast"
    )]
    fn propose(
        &mut self,
        filter: &Filter,
        ramp: f64,
        most: f64,
        onward: Option<&Continuation<N>>,
    ) -> bool {
        let Self {
            curve,
            pace,
            spline,
            ..
        } = self;
        let Some(duration) = pace.arrange(filter.step) else {
            return false;
        };
        if duration >= most || duration > filter.step * MAX_STEPS as f64 {
            return false;
        }
        spline.clear(filter);
        let mut first = 0.0;
        let begin = curve.control_at(0.0, 0);
        let mut samples = MAX_STEPS;
        let mut settled = 1;
        if let Some(onward) = onward {
            spline.origin = onward.first - 4.0 * filter.step;
            first = onward.first;
            let [last, next] = onward.progress;
            for (control, distance) in onward.controls.iter().zip([last, last, last]) {
                spline.push(*control, distance);
            }
            spline.push(curve.control_at(next, onward.controls[2].leg), next);
            settled = spline.controls.len() - 1;
        } else if filter.lags {
            // So late that the first step gains no more speed than the jerk allows, nor more than there is.
            let late = LATE.min(1.0 + ramp / filter.step);
            let steps = (duration / filter.step - 2.0 * late).round().max(1.0);
            spline.step = duration / (steps + 2.0 * late);
            first = late * spline.step;
            spline.origin = first - 3.0 * spline.step;
            for _ in 0..3 {
                spline.push(begin, 0.0);
            }
            samples = steps as usize + 4;
            settled = 3;
        } else {
            // Whole steps from rest to rest.
            let steps = (duration / filter.step).round().max(MIN_STEPS);
            spline.step = duration / steps;
            spline.origin = -spline.step;
            spline.push(begin, 0.0);
            samples = steps as usize + 1;
        }
        let mut near = 0;
        pace.walk(first, spline.step, |distance, _, _| {
            let control = curve.control_at(distance, near);
            near = control.leg;
            spline.push(control, distance);
            spline.controls.len() <= MAX_STEPS
        });
        let end = curve.end();
        let length = curve.length();
        if onward.is_none() {
            // Rounding decides whether the last instant is among them.
            spline.controls.truncate(samples);
            spline.progress.truncate(samples);
        }
        if filter.averages() {
            spline.push(end, length);
            spline.average(filter, curve);
        } else {
            spline.push(end, length);
            spline.push(end, length);
            if filter.lags {
                spline.push(end, length);
            }
            spline.sharpen(settled, curve, filter);
        }
        // Three equal control points are a rest.
        let count = spline.controls.len();
        if onward.is_none() {
            spline.controls[..3].fill(begin);
        }
        spline.controls[count - 3..].fill(end);
        spline.duration() < most
    }
}
