//! Smooths many short segments at once: a cubic B-spline over equal time steps.
//!
//! Source: ours; section 3.3.2 overlaps two corners, and a run of short moves overlaps many. The path
//! is travelled with a jerk-limited progress, and every corner's velocity jump is spread over the same
//! window of time, which makes the motion a cubic spline over equal time steps. Curvature then costs
//! no acceleration pulse a corner, so that fine curves and arcs run at their feedrate. A stretch is
//! planned from rest to rest and accepted only when every piece of it has been found inside all
//! limits and the tolerance; otherwise its corners are turned one by one. Not here: which stretches
//! are worth it.

mod attempt;
mod curve;
mod feed_profile;
mod pulses;
mod spline;
mod velocity_limit;
mod whole;

use crate::segment::Segment;
use curve::{Control, Curve};
use feed_profile::{FeedProfile, Filter, SwitchState};
use pulses::Commands;
use spline::Spline;
use toolglide_kinematics::{Limits, Piece, Vector};
pub(crate) use whole::Effort;

/// Most time steps of one stretch.
const MAX_STEPS: usize = 16_384;

/// Filters tried in this order: the time step, as a share of the time in which the jerk changes the
/// speed by the feedrate, and the sharpening.
const FILTERS: [(f64, f64); 3] = [(0.4, 1.0), (0.2, 0.0), (0.1, 0.0)];

/// A plan this near to the least conceivable time is not improved.
const GOOD_ENOUGH: f64 = 1.02;

/// How a motion goes on from a place where it neither gains nor loses speed.
#[derive(Clone, Copy, Debug)]
struct Continuation<const N: usize> {
    filter: Filter,
    /// The last control points that are settled.
    controls: [Control<N>; 3],
    /// Progress at the last of them and one step later.
    progress: [f64; 2],
    /// From where the progress may be another; its time is counted from there.
    start: SwitchState,
    /// Time from there to the next step.
    first: f64,
}

/// Plans stretches of superposed corners.
#[derive(Clone, Debug)]
pub(crate) struct ShortSegmentSmoother<const N: usize> {
    limits: Limits<N>,
    curve: Curve<N>,
    pace: FeedProfile,
    spline: Spline<N>,
    /// The fastest plan of the stretch that was planned last.
    best: Spline<N>,
    /// The plan that is travelled, the piece to be pulled next, and the first that may still become
    /// another.
    run: Spline<N>,
    next: usize,
    until: usize,
    onward: Option<Continuation<N>>,
    commands: Commands<N>,
    /// Pieces of trials that may still be judged.
    effort: usize,
}

impl<const N: usize> ShortSegmentSmoother<N> {
    /// A planner of stretches of so many legs at the most.
    pub(crate) fn new(limits: Limits<N>, legs: usize) -> Self {
        Self {
            limits,
            curve: Curve::with_capacity(legs + 1),
            pace: FeedProfile::new(),
            spline: Spline::with_capacity(MAX_STEPS + 64),
            best: Spline::with_capacity(MAX_STEPS + 64),
            run: Spline::with_capacity(MAX_STEPS + 64),
            next: 0,
            until: 0,
            onward: None,
            commands: Commands::new(),
            effort: usize::MAX,
        }
    }

    /// Plans the legs from rest to rest in less than `most` seconds; the duration, or `None` when that
    /// cannot be done.
    ///
    /// `least` is a time that no motion can undercut.
    pub(crate) fn plan(&mut self, legs: &[Segment<N>], least: f64, most: f64) -> Option<f64> {
        self.curve.set(legs);
        let ramp = self.ramp(legs);
        let mut shortest = None;
        for (share, sharpening) in FILTERS {
            let most = shortest.unwrap_or(most);
            if shortest.is_some() && most <= GOOD_ENOUGH * least {
                break;
            }
            let filter = Filter::sharp(share * ramp, sharpening);
            if self.attempt(&filter, ramp, most, None) {
                shortest = Some(self.spline.duration());
                std::mem::swap(&mut self.spline, &mut self.best);
            }
        }
        shortest
    }

    /// Plans the legs from where the motion that is travelled may still become another to rest, in less
    /// than `most` seconds; the duration, or `None` when that cannot be done.
    pub(crate) fn plan_onward(&mut self, legs: &[Segment<N>], most: f64) -> Option<f64> {
        let onward = self.onward?;
        self.curve.set(legs);
        let ramp = self.ramp(legs);
        if !self.attempt(&onward.filter, ramp, most, Some(&onward)) {
            return None;
        }
        std::mem::swap(&mut self.spline, &mut self.best);
        Some(self.best.duration())
    }

    /// Plans the legs as what was planned last, but entering at a distance on the first one at a constant
    /// speed, in less than `most` seconds; the duration, or `None` when that cannot be done.
    pub(crate) fn plan_entering(
        &mut self,
        legs: &[Segment<N>],
        distance: f64,
        speed: f64,
        most: f64,
    ) -> Option<f64> {
        let step = self.best.step;
        let advance = step * speed;
        self.curve.set(legs);
        if distance < advance || distance + 3.0 * advance > legs.first()?.length {
            return None;
        }
        let ramp = self.ramp(legs);
        let entering = Continuation {
            filter: Filter::sharp(step, self.best.sharpening),
            controls: [-1.0, 0.0, 1.0]
                .map(|ticks| self.curve.control_at(distance + ticks * advance, 0)),
            progress: [1.0, 2.0].map(|ticks| distance + ticks * advance),
            start: SwitchState {
                time: 0.0,
                distance: distance + 2.0 * advance,
                speed,
            },
            first: step,
        };
        if !self.attempt(&entering.filter, ramp, most, Some(&entering)) {
            return None;
        }
        std::mem::swap(&mut self.spline, &mut self.best);
        Some(self.best.duration())
    }

    /// Time in which the jerk changes the speed by what the legs allow.
    fn ramp(&self, legs: &[Segment<N>]) -> f64 {
        let length = self.curve.length();
        let (mut feedrate, mut jerk) = (0.0_f64, f64::INFINITY);
        for leg in legs {
            feedrate = feedrate.max(leg.limits.reachable_within(length));
            jerk = jerk.min(leg.limits.jerk);
        }
        (feedrate / jerk).sqrt()
    }

    /// Travels what was planned last, to its end.
    pub(crate) fn travel(&mut self) {
        std::mem::swap(&mut self.run, &mut self.best);
        self.next = 0;
        self.finish();
    }

    /// Travels what was planned last, as far as it does not matter what follows; the number of legs that
    /// are then no longer needed. `None` when it is travelled to its end.
    pub(crate) fn travel_openly(&mut self) -> Option<usize> {
        self.travel();
        let (settled, handover) = self.run.handover(&self.curve)?;
        let (onward, legs) = self.run.onward(settled, &handover, &self.curve);
        self.onward = Some(onward);
        self.until = settled.saturating_sub(2);
        Some(legs)
    }

    /// Travels the motion no further than to where it may still become another, when there it is on its
    /// last leg and neither gains nor loses speed; the point and the speed.
    pub(crate) fn leave(&mut self) -> Option<(Vector<N>, f64)> {
        // Of the control points before it, the first would still bend the way here.
        let straight = self.run.controls.get(self.until.checked_sub(1)?)?;
        let control = self.run.controls.get(self.until + 1)?;
        let last = self.run.controls.last()?;
        let steady =
            self.onward.is_some() && straight.leg == last.leg && self.run.is_steady(self.until + 1);
        steady.then(|| {
            self.onward = None;
            (control.point, self.run.speed(self.until + 1))
        })
    }

    /// Travels the motion to its end after all.
    pub(crate) fn finish(&mut self) {
        self.until = self.run.pieces();
        self.onward = None;
    }

    /// Duration of what was planned last.
    pub(crate) fn planned(&self) -> f64 {
        self.best.duration()
    }

    /// Duration of what may still become another motion.
    pub(crate) fn remaining(&self) -> f64 {
        self.run.duration_of(self.run.pieces() - self.until)
    }

    /// The next piece of the motion that is travelled.
    pub(crate) fn pull(&mut self) -> Option<Piece<N>> {
        if self.is_done() {
            return None;
        }
        let piece = self.run.piece(self.next);
        self.next += 1;
        Some(piece)
    }

    /// Whether all pieces that will not become others have been pulled.
    pub(crate) fn is_done(&self) -> bool {
        self.next >= self.until
    }
}
