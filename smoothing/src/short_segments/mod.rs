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

/// Time steps where arcs are tiny.
const TINY_FILTERS: [f64; 2] = [0.8, 0.4];

/// Share of the jerk that the progress has where time steps are so short that nothing of it is smoothed: setting out
/// takes the rest.
const MILD: f64 = 0.93;
const WIDE: f64 = 0.3;

/// How much longer than the first of them a time step is that arcs are tried with before, as a share of the time that
/// they take, and the largest angle that it may turn by.
const SLOW: f64 = 1.5;
const SLOW_SHARE: f64 = 5e-4;
const SLOW_ANGLE: f64 = 0.25;

/// How much longer than enough a plan takes that is improved without leaving the arcs.
const FOLLOWED: f64 = 1.04;

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
    /// Pieces that have been proposed since it was made.
    proposed: u64,
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
            proposed: 0,
        }
    }

    /// Plans the legs from rest to rest in less than `most` seconds; the duration, or `None` when that
    /// cannot be done.
    ///
    /// A plan of no more than `enough` seconds is not improved.
    pub(crate) fn plan(&mut self, legs: &[Segment<N>], enough: f64, most: f64) -> Option<f64> {
        self.curve.set(legs);
        let ramp = self.ramp(legs);
        let mut shortest = None;
        for (share, sharpening) in FILTERS {
            let most = shortest.unwrap_or(most);
            if shortest.is_some() && most <= enough {
                break;
            }
            let filter = Filter::sharp(share * ramp, sharpening);
            if self.attempt(&filter, ramp, most, None) {
                shortest = Some(self.keep());
            }
        }
        shortest
    }

    /// The same for legs with arcs, which are followed as they are where that takes little longer.
    pub(crate) fn plan_round(&mut self, legs: &[Segment<N>], enough: f64) -> Option<f64> {
        self.curve.set(legs);
        let ramp = self.ramp(legs);
        let slow = self.slow_share(legs, ramp);
        let slow = (slow > SLOW * FILTERS[0].0).then_some((slow, 1.0));
        let mut shortest: Option<f64> = None;
        for (share, sharpening) in slow.into_iter().chain(FILTERS) {
            let most = shortest.unwrap_or(f64::INFINITY);
            if most <= enough || (shortest.is_some() && most > FOLLOWED * enough) {
                break;
            }
            let filter = Filter {
                lags: true,
                inside: 1.0,
                stiffness: if share > WIDE { 1.0 } else { MILD },
                ..Filter::sharp(share * ramp, sharpening)
            };
            if self.attempt(&filter, ramp, most, None) {
                shortest = Some(self.keep());
            }
        }
        if shortest.is_some_and(|most| most <= FOLLOWED * enough) {
            return shortest;
        }
        // Limits of the axes bind, so that the tolerance is worth more.
        for (share, sharpening) in FILTERS {
            let most = shortest.unwrap_or(f64::INFINITY);
            let filter = Filter::sharp(share * ramp, sharpening);
            if self.attempt(&filter, ramp, most, None) {
                shortest = Some(self.keep());
            }
        }
        shortest
    }

    /// The same for legs of arcs so small that the tolerance and the axes bind, in less than `most` seconds: the first way
    /// that is found counts.
    pub(crate) fn plan_tiny(&mut self, legs: &[Segment<N>], most: f64) -> Option<f64> {
        self.curve.set(legs);
        let ramp = self.ramp(legs);
        TINY_FILTERS.into_iter().find_map(|share| {
            let filter = Filter {
                hasty: true,
                ..Filter::sharp(share * ramp, 0.0)
            };
            self.attempt(&filter, ramp, most, None).then(|| self.keep())
        })
    }

    /// A time step that loses little of the time that arcs take anyway, as a share of the ramp.
    fn slow_share(&self, legs: &[Segment<N>], ramp: f64) -> f64 {
        let (mut time, mut step) = (0.0, f64::INFINITY);
        for leg in legs {
            let speed = leg.limits.velocity;
            time += leg.length / speed;
            if let Some(bend) = &leg.bend {
                let inward = speed * speed / bend.bending();
                step = step
                    .min(SLOW_ANGLE * bend.radius() / speed)
                    .min((leg.room().length() / inward).sqrt());
            }
        }
        step.min(SLOW_SHARE * time) / ramp
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
            filter: Filter {
                lags: self.best.lags,
                inside: self.best.inside,
                ..Filter::sharp(step, self.best.sharpening)
            },
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

    /// Pieces that have been proposed since it was made.
    pub(crate) fn proposed(&self) -> u64 {
        self.proposed
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
