//! Connects two ends of a straight segment over a distance in least time.
//!
//! Source: section 3.3.1, equations 3.11 to 3.25; the peak speed is searched on the distance that it
//! needs, which is exact in every degenerate case, instead of by the printed quadratic and quartic.
//! Not here: ends that decelerate at the start or accelerate at the end, which no corner has.

use crate::phase::Phase;
use crate::profile::State;
use crate::rise::SpeedRamp;
use toolglide_kinematics::PathLimits;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::numeric::{CLOSURE, LIMIT_SLACK, SEARCH_PRECISION};

/// Newton steps allowed to the search for the peak speed; bisection alone would need sixty, and
/// three to five are usual.
const MAX_STEPS: usize = 80;

/// The two ends of a straight stretch and the limits along it; the distance is asked for later.
///
/// An end has a speed and an acceleration, both not negative: at the start the motion is gaining
/// speed, at the end it is losing speed at that rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SCurveBoundary {
    /// Speed and acceleration at the start.
    pub from: [f64; 2],
    /// Speed and deceleration at the end.
    pub to: [f64; 2],
    /// Limits along the stretch; the velocity is the feedrate where that is lower.
    pub limits: PathLimits,
}

impl SCurveBoundary {
    /// Distance used when the motion rises to `peak` and falls again at once.
    #[must_use]
    #[inline]
    pub fn distance_at(&self, peak: f64) -> f64 {
        self.rise(peak).distance + self.fall(peak).distance
    }

    /// The lowest peak speed: where the accelerations of both ends have run out.
    #[must_use]
    #[inline]
    pub fn least_peak(&self) -> f64 {
        let PathLimits { jerk, .. } = self.limits;
        SpeedRamp::least_peak(self.from[0], self.from[1], jerk)
            .max(SpeedRamp::least_peak(self.to[0], self.to[1], jerk))
    }

    /// The least distance over which the two ends can be joined.
    #[must_use]
    #[inline]
    pub fn least_distance(&self) -> f64 {
        self.distance_at(self.least_peak())
    }

    /// Duration of the fastest motion over `distance`, to about a part in a million; `None` when it
    /// is too short or an end too fast.
    #[must_use]
    #[inline]
    pub fn duration_over(&self, distance: f64) -> Option<f64> {
        let solution = self.solve(distance, SEARCH_PRECISION)?;
        Some(solution.rise.duration() + solution.cruise + solution.fall.duration())
    }

    fn rise(&self, peak: f64) -> SpeedRamp {
        let PathLimits {
            acceleration, jerk, ..
        } = self.limits;
        SpeedRamp::to_peak(self.from[0], self.from[1], peak, acceleration, jerk)
    }

    fn fall(&self, peak: f64) -> SpeedRamp {
        let PathLimits {
            acceleration, jerk, ..
        } = self.limits;
        SpeedRamp::to_peak(self.to[0], self.to[1], peak, acceleration, jerk)
    }

    /// The highest peak whose distance fits, to a relative precision; what is left over is cruised.
    #[inline]
    pub(crate) fn solve(&self, distance: f64, precision: f64) -> Option<Solution> {
        let least = self.least_peak();
        let feedrate = self.limits.velocity;
        if least > feedrate * (1.0 + LIMIT_SLACK) {
            return None;
        }
        let feedrate = feedrate.max(least);
        let slack = CLOSURE * distance;
        // The distance is convex in the peak, so that Newton's step from either side lands to the
        // right of the root; a nudge to the left of the size of its error makes it fit. The ends of the
        // bracket are tried only when a step leads there.
        let mut fitting: Option<Solution> = None;
        let (mut low_peak, mut high_peak) = (least, feedrate);
        let mut feedrate_tried = false;
        let mut guess = self.first_guess(distance, least, feedrate);
        for _ in 0..MAX_STEPS {
            if guess >= feedrate && !feedrate_tried && feedrate.is_finite() {
                feedrate_tried = true;
                guess = feedrate;
            } else if guess <= least && fitting.is_none() {
                guess = least;
            } else if !(guess > low_peak && guess < high_peak) {
                guess = if high_peak.is_finite() {
                    0.5 * (low_peak + high_peak)
                } else {
                    2.0 * low_peak.max(f64::MIN_POSITIVE)
                };
                if guess <= low_peak || guess >= high_peak {
                    break;
                }
            }
            let trial = self.at_peak(guess, distance);
            if trial.left >= 0.0 {
                fitting = Some(trial);
                low_peak = guess;
                if guess >= feedrate || trial.left <= precision * distance {
                    break;
                }
            } else if guess <= least {
                return (trial.left >= -slack).then_some(trial);
            } else {
                high_peak = guess;
            }
            let step =
                trial.left / (trial.rise.distance_per_peak() + trial.fall.distance_per_peak());
            let nudge = (step * step / guess + f64::EPSILON * guess).min(0.25 * step.abs());
            guess += step - nudge;
        }
        // Only a peak a rounding above the least is left.
        fitting.or_else(|| {
            let at_least = self.at_peak(least, distance);
            (at_least.left >= -slack).then_some(at_least)
        })
    }

    /// The peak of the motion that starts and ends at rest with the same middle, which is near.
    #[inline]
    fn first_guess(&self, distance: f64, least: f64, feedrate: f64) -> f64 {
        let PathLimits {
            acceleration, jerk, ..
        } = self.limits;
        // Without an acceleration limit a symmetric motion from rest obeys
        // peak^3 = jerk * distance^2 / 4; raise it by the end speeds in the cubic mean.
        let ends = 0.5 * (self.from[0].powi(3) + self.to[0].powi(3));
        let free = (0.25 * jerk * distance * distance + ends).cbrt();
        let knee = acceleration * acceleration / jerk;
        let guess = if free > knee {
            // Saturated: peak^2 + peak * knee = acceleration * distance + mean square of the ends.
            let mean = 0.5 * (self.from[0] * self.from[0] + self.to[0] * self.to[0]);
            let constant = acceleration * distance + mean;
            0.5 * (-knee + (knee * knee + 4.0 * constant).sqrt())
        } else {
            free
        };
        guess.clamp(least, feedrate)
    }

    #[inline]
    fn at_peak(&self, peak: f64, distance: f64) -> Solution {
        let rise = self.rise(peak);
        let fall = self.fall(peak);
        let left = distance - (rise.distance + fall.distance);
        Solution {
            peak,
            rise,
            fall,
            left,
            cruise: if left > 0.0 && peak > 0.0 {
                left / peak
            } else {
                0.0
            },
        }
    }
}

/// A rise and a fall over a distance, with what is left between them.
#[derive(Clone, Copy)]
pub(crate) struct Solution {
    /// Speed between rise and fall.
    pub(crate) peak: f64,
    /// From the start to the peak.
    pub(crate) rise: SpeedRamp,
    /// From the end to the peak, backward in time.
    pub(crate) fall: SpeedRamp,
    /// Distance that neither uses.
    left: f64,
    /// How long the peak is kept.
    pub(crate) cruise: f64,
}

impl Solution {
    /// States at the beginning of each phase, and at the end.
    pub(crate) fn states(
        &self,
        distance: f64,
        connection: &SCurveBoundary,
        phases: &[Phase; 7],
    ) -> ([State; 7], State) {
        let mut starts = [State::default(); 7];
        starts[0] = State::moving(connection.from[0], connection.from[1]);
        for index in 0..2 {
            starts[index].jerk = phases[index].jerk;
            starts[index + 1] = starts[index].after(phases[index].duration);
            starts[index + 1].acceleration = self.rise.apex;
        }
        let cruising = State::moving(self.peak, 0.0);
        starts[3] = State {
            position: self.rise.distance,
            ..cruising
        };
        starts[4] = State {
            position: distance - self.fall.distance,
            ..cruising
        };
        let end = State {
            position: distance,
            ..State::moving(connection.to[0], -connection.to[1])
        };
        let mut later = end;
        for index in [6, 5] {
            later.jerk = phases[index].jerk;
            later = later.after(-phases[index].duration);
            later.acceleration = -self.fall.apex;
            starts[index] = later;
        }
        for (start, phase) in starts.iter_mut().zip(phases) {
            start.jerk = phase.jerk;
        }
        (starts, end)
    }

    /// Whole duration; never 0, to divide by.
    pub(crate) fn duration(&self) -> f64 {
        (self.rise.duration() + self.cruise + self.fall.duration()).max(f64::MIN_POSITIVE)
    }
}
