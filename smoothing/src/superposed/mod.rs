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

/// Rounds of slowing down where a limit or the tolerance is exceeded.
const ROUNDS: usize = 8;

/// What a place is slowed by in one round beyond what its excess asks for.
const SLOWER: f64 = 0.995;

/// The most that a place is slowed by in one round.
const SLOWEST: f64 = 0.85;

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
            if self.attempt(&filter, shortest) {
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

    fn attempt(&mut self, filter: &Filter, most: f64) -> bool {
        if !self.pace.survey(&self.curve, &self.limits, filter) {
            return false;
        }
        for _ in 0..ROUNDS {
            if !self.propose(filter, most) {
                return false;
            }
            let mut kept = true;
            for index in 0..self.spline.pieces() {
                let factor = self.spline.keeps(index, &self.curve, &self.limits);
                if factor < 1.0 {
                    kept = false;
                    let controls = &self.spline.controls[index..index + 4];
                    let factor = (factor * SLOWER).max(SLOWEST);
                    self.pace
                        .slow(controls[0].distance, controls[3].distance, factor);
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
        let steps = (most / filter.step).min(MOST_STEPS as f64) as usize;
        spline.step = filter.step;
        let controls = &mut spline.controls;
        controls.clear();
        let legs = curve.legs();
        let (Some(first), Some(last)) = (legs.first(), legs.last()) else {
            return false;
        };
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
        // Three equal control points are a rest, and sharpening moves the neighbour of a moving one.
        controls.extend([begin; 3]);
        let mut near = 0;
        let complete = pace.progress(filter.step, |distance| {
            near = curve.leg_at(distance, near);
            controls.push(Control {
                point: curve.point(distance, near),
                distance,
                leg: near,
            });
            controls.len() < steps
        });
        if !complete {
            return false;
        }
        controls.extend([end; 4]);
        if filter.sharpening > 0.0 {
            let share = filter.sharpening / 6.0;
            let mut before = controls[0].point;
            for index in 1..controls.len() - 1 {
                let here = controls[index].point;
                let second = controls[index + 1].point - here * 2.0 + before;
                before = here;
                controls[index].point = here - second * share;
            }
        }
        true
    }
}
