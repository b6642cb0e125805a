//! Superposed corners: many small corners smoothed at once.
//!
//! Source: ours; section 3.3.2 overlaps two corners, and a run of short moves overlaps many. The path
//! is travelled with a jerk-limited progress, and every corner's velocity jump is spread over the same
//! window of time, which makes the motion a cubic spline over equal time steps. Curvature then costs
//! no acceleration pulse a corner, so that fine curves and arcs run at their feedrate. A stretch is
//! planned from rest to rest and accepted only when every piece of it has been found inside all
//! limits and the tolerance; otherwise its corners are turned one by one. Not here: which stretches
//! are worth it.

mod curve;
mod pace;
mod spline;

use crate::leg::Leg;
use curve::Curve;
use pace::{Filter, Pace};
use spline::{Control, Spline};
use toolglide_kinematics::{Limits, Piece};

/// Most legs of one stretch.
pub(crate) const MOST_LEGS: usize = 4096;

/// Most time steps of one stretch.
const MOST_STEPS: usize = 16_384;

/// Fewest time steps of one stretch.
const FEWEST_STEPS: f64 = 4.0;

/// Share of the feedrate by which a change of speed overshoots it, for a time step as long as the ramp.
const OVERSHOOT: f64 = 0.015;

/// Rounds of slowing down where a limit or the tolerance is exceeded.
const ROUNDS: usize = 8;

/// Filters tried in this order: the time step, as a share of the time in which the jerk changes the
/// speed by the feedrate, and the sharpening.
const FILTERS: [(f64, f64); 3] = [(0.4, 1.0), (0.2, 0.0), (0.1, 0.0)];

/// A plan this near to the least conceivable time is not improved.
const GOOD_ENOUGH: f64 = 1.02;

/// Plans stretches of superposed corners.
#[derive(Clone, Debug)]
pub(crate) struct Superposer<const N: usize> {
    limits: Limits<N>,
    curve: Curve<N>,
    pace: Pace,
    spline: Spline<N>,
    best: Spline<N>,
    next: usize,
}

impl<const N: usize> Superposer<N> {
    pub(crate) fn new(limits: Limits<N>) -> Self {
        let spline = || Spline {
            controls: Vec::with_capacity(MOST_STEPS + 8),
            step: 0.0,
        };
        Self {
            limits,
            curve: Curve::with_capacity(MOST_LEGS + 1),
            pace: Pace::new(),
            spline: spline(),
            best: spline(),
            next: 0,
        }
    }

    /// Plans the legs from rest to rest in less than `most` seconds; the duration, or `None` when that
    /// cannot be done.
    ///
    /// `least` is a time that no motion can undercut.
    pub(crate) fn plan(&mut self, legs: &[Leg<N>], least: f64, most: f64) -> Option<f64> {
        self.curve.set(legs);
        self.best.controls.clear();
        self.next = 0;
        let length = self.curve.length();
        let (mut feedrate, mut jerk) = (0.0_f64, f64::INFINITY);
        for leg in legs {
            feedrate = feedrate.max(leg.limits.reachable_within(length));
            jerk = jerk.min(leg.limits.jerk);
        }
        let ramp = (feedrate / jerk).sqrt();
        let mut shortest = most;
        for (share, sharpening) in FILTERS {
            if shortest <= GOOD_ENOUGH * least {
                break;
            }
            let filter = Filter {
                step: share * ramp,
                sharpening,
            };
            if self.attempt(&filter, ramp, shortest) {
                shortest = self.spline.duration();
                std::mem::swap(&mut self.spline, &mut self.best);
            }
        }
        (self.best.pieces() > 0).then(|| self.best.duration())
    }

    /// The next piece of the stretch that was planned.
    pub(crate) fn pull(&mut self) -> Option<Piece<N>> {
        if self.next >= self.best.pieces() {
            return None;
        }
        let piece = self.best.piece(self.next, &self.curve);
        self.next += 1;
        Some(piece)
    }

    /// Whether all pieces of the stretch have been pulled.
    pub(crate) fn is_done(&self) -> bool {
        self.next >= self.best.pieces()
    }

    /// Forgets the stretch that was planned.
    pub(crate) fn discard(&mut self) {
        self.best.controls.clear();
        self.next = 0;
    }

    fn attempt(&mut self, filter: &Filter, ramp: f64, most: f64) -> bool {
        // A change of speed overshoots by about this much when the control points are sharpened.
        let share = 1.0 - OVERSHOOT * (filter.step / ramp).powi(2);
        if !self.pace.survey(&self.curve, &self.limits, filter, share) {
            return false;
        }
        for _ in 0..ROUNDS {
            if !self.propose(filter, most) {
                return false;
            }
            let mut kept = true;
            for index in 0..self.spline.pieces() {
                if let Some(excess) = self.spline.excess(index, &self.curve, &self.limits) {
                    kept = false;
                    let controls = &self.spline.controls[index..index + 4];
                    self.pace
                        .slow(controls[0].distance, controls[3].distance, &excess);
                }
            }
            if kept {
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
        reason = "the count is clamped before it is cast"
    )]
    fn propose(&mut self, filter: &Filter, most: f64) -> bool {
        let Self {
            curve,
            pace,
            spline,
            ..
        } = self;
        let legs = curve.legs();
        let (Some(first), Some(last)) = (legs.first(), legs.last()) else {
            return false;
        };
        let Some(duration) = pace.arrange(filter.step) else {
            return false;
        };
        if duration >= most {
            return false;
        }
        let steps = (duration / filter.step)
            .round()
            .clamp(FEWEST_STEPS, MOST_STEPS as f64);
        spline.step = duration / steps;
        let steps = steps as usize;
        let begin = Control {
            point: first.start,
            distance: 0.0,
            leg: 0,
        };
        let end = Control {
            point: last.end,
            distance: curve.length(),
            leg: legs.len() - 1,
        };
        let controls = &mut spline.controls;
        controls.clear();
        controls.push(begin);
        let mut near = 0;
        let complete = pace.walk(spline.step, |distance, _, _| {
            near = curve.leg_at(distance, near);
            controls.push(Control {
                point: curve.point(distance, near),
                distance,
                leg: near,
            });
            controls.len() <= steps
        });
        if !complete && controls.len() <= steps {
            return false;
        }
        controls.resize(steps + 3, end);
        controls[steps + 1] = end;
        sharpen(controls, curve, filter.sharpening);
        // Three equal control points are a rest.
        controls[..3].fill(begin);
        controls[steps..].fill(end);
        true
    }
}

/// Moves the control points so that the spline follows what they sample: along the path by all that
/// the spline lags behind, across it by a share.
fn sharpen<const N: usize>(controls: &mut [Control<N>], curve: &Curve<N>, share: f64) {
    let Some(mut before) = controls.first().copied() else {
        return;
    };
    for index in 1..controls.len() - 1 {
        let here = controls[index];
        let after = controls[index + 1];
        let second = after.point - here.point * 2.0 + before.point;
        let lag = (after.distance - 2.0 * here.distance + before.distance) / 6.0;
        before = here;
        // Rounding may not turn the order around.
        let distance = (here.distance - lag)
            .min(curve.length())
            .max(controls[index - 1].distance);
        let leg = curve.leg_at(distance, here.leg);
        let along = curve.legs()[here.leg].direction * lag;
        controls[index] = Control {
            point: curve.point(distance, leg) - (second / 6.0 - along) * share,
            distance,
            leg,
        };
    }
}
