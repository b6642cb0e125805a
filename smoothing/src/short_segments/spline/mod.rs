//! Holds control points in equal time steps and the motion between them.
//!
//! Source: ours. A cubic spline over equal steps has the second difference of its control points for
//! acceleration at the knots and the third for jerk between them. Not here: where the control points
//! come from.

mod check;

use crate::short_segments::Continuation;
use crate::short_segments::curve::{Control, Curve};
use crate::short_segments::feed_profile::{Filter, SwitchState};
pub(super) use check::Excess;
use toolglide_kinematics::numeric::LIMIT_SLACK;
use toolglide_kinematics::{MoveRange, Piece, Sample, Vector};

/// Change of the progress from step to step that is nothing but rounding, relative.
const STEADY: f64 = 1e-10;

/// The same on an arc, and the binary digits of the advance that are no more than that.
const ALIKE: f64 = 1e-9;
const ROUNDING_BITS: u32 = 20;

/// The mean of consecutive values up to an index; the first is repeated before it.
#[allow(clippy::cast_precision_loss, reason = "counts are small")]
pub(super) fn mean<const N: usize>(
    taps: usize,
    index: usize,
    value: impl Fn(usize) -> (Vector<N>, f64),
) -> (Vector<N>, f64) {
    let (mut point, mut distance) = value(index);
    for back in 1..taps {
        let (one, along) = value(index.saturating_sub(back));
        point += one;
        distance += along;
    }
    let share = 1.0 / taps as f64;
    (point * share, distance * share)
}

/// A cubic spline over equal time steps.
#[derive(Clone, Debug)]
pub(super) struct Spline<const N: usize> {
    pub(super) controls: Vec<Control<N>>,
    /// The progress of which each control point was made.
    pub(super) progress: Vec<f64>,
    pub(super) step: f64,
    /// Time of the first of them, since the beginning of the progress.
    pub(super) origin: f64,
    pub(super) sharpening: f64,
    pub(super) lags: bool,
    pub(super) inside: f64,
    /// Pieces beside one in which it may pass what it has on its path.
    around: usize,
    /// Where another progress may go on.
    pub(super) handover: Option<SwitchState>,
}

impl<const N: usize> Spline<N> {
    pub(super) fn with_capacity(controls: usize) -> Self {
        Self {
            controls: Vec::with_capacity(controls),
            progress: Vec::with_capacity(controls),
            step: 0.0,
            origin: 0.0,
            sharpening: 0.0,
            lags: false,
            inside: 0.0,
            around: 1,
            handover: None,
        }
    }

    /// Forgets all control points.
    pub(super) fn clear(&mut self, filter: &Filter) {
        self.controls.clear();
        self.progress.clear();
        self.step = filter.step;
        self.sharpening = filter.sharpening;
        self.lags = filter.lags;
        self.inside = filter.inside;
        self.around = filter.taps[0].max(filter.taps[1]);
        self.handover = None;
    }

    /// Adds a control point, made of a progress.
    pub(super) fn push(&mut self, control: Control<N>, progress: f64) {
        self.controls.push(control);
        self.progress.push(progress);
    }

    /// Takes means of consecutive control points, twice; what is before them, and what follows, rests.
    pub(super) fn average(&mut self, filter: &Filter, curve: &Curve<N>) {
        let settling = filter.settling();
        let Some(&end) = self.controls.last() else {
            return;
        };
        for _ in 0..settling + 2 {
            self.push(end, end.distance);
        }
        let count = self.controls.len();
        let first = |index: usize| index.saturating_sub(settling);
        for index in (0..count).rev() {
            self.controls[index].serves.first = self.controls[first(index)].serves.first;
        }
        for taps in filter.taps {
            // From the back, so that what is read has not been written.
            for index in (0..count).rev() {
                let (point, distance) = mean(taps, index, |at| {
                    (self.controls[at].point, self.controls[at].distance)
                });
                self.controls[index].point = point;
                self.controls[index].distance = distance;
            }
        }
        for (control, progress) in self.controls.iter_mut().zip(&mut self.progress) {
            control.distance = control.distance.min(curve.length());
            control.leg = curve.leg_at(control.distance, control.leg);
            *progress = control.distance;
        }
    }

    /// Moves the control points from an index on so that the spline follows what they sample: along the
    /// path by all that it lags behind, unless it may lag, across it by a share.
    pub(super) fn sharpen(&mut self, first: usize, curve: &Curve<N>, filter: &Filter) {
        let controls = &mut self.controls;
        let progress = self.progress[first - 1];
        let mut before = curve.control_at(progress, controls[first - 1].leg);
        for index in first..controls.len() - 1 {
            let here = controls[index];
            let after = controls[index + 1];
            let second = (after.point - here.point * 2.0 + before.point) / 6.0;
            let around = [before.leg, after.leg];
            let inside = around.iter().all(|leg| curve.are_one_arc(*leg, here.leg));
            let share = if inside {
                filter.inside
            } else {
                filter.sharpening
            };
            let lag = (after.distance - 2.0 * here.distance + before.distance) / 6.0;
            before = here;
            let direction = curve.direction(here.distance, here.leg);
            controls[index] = if filter.lags {
                let across = second - direction * direction.dot(&second);
                Control {
                    point: here.point - across * share,
                    ..here
                }
            } else {
                // Rounding may not turn the order around.
                let distance = (here.distance - lag)
                    .min(curve.length())
                    .max(controls[index - 1].distance);
                let mut control = curve.control_at(distance, here.leg);
                control.point -= (second - direction * lag) * share;
                control
            };
        }
    }

    /// How many pieces it has.
    pub(super) fn pieces(&self) -> usize {
        self.controls.len().saturating_sub(3)
    }

    /// How long it lasts.
    pub(super) fn duration(&self) -> f64 {
        self.duration_of(self.pieces())
    }

    /// How long some of its pieces last.
    #[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
    pub(super) fn duration_of(&self, pieces: usize) -> f64 {
        pieces as f64 * self.step
    }

    /// Where another progress may go on, and the last control point that it cannot change: as soon as
    /// the motion is steady on its last leg, else where the pace has found a handover.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "counts are small and not negative"
    )]
    pub(super) fn handover(&self, curve: &Curve<N>) -> Option<(usize, SwitchState)> {
        let last = curve.legs().len() - 1;
        let begin = self.controls.partition_point(|control| control.leg < last) + 2;
        if let Some(index) = (begin..self.controls.len()).find(|&index| self.is_steady(index)) {
            let handover = SwitchState {
                time: self.origin + (index as f64 + 2.0) * self.step,
                distance: self.progress[index + 2],
                speed: self.speed(index),
            };
            return Some((index + 1, handover));
        }
        let handover = self.handover?;
        let index = ((handover.time - self.origin) / self.step).floor().max(0.0) as usize;
        (index >= 4 && index + 4 < self.controls.len()).then_some((index - 1, handover))
    }

    /// Whether the progress around a control point and for two steps after it is at constant speed.
    pub(super) fn is_steady(&self, index: usize) -> bool {
        if index < 3 || index + 5 > self.controls.len() {
            return false;
        }
        let around = &self.progress[index - 2..index + 3];
        let step = around[1] - around[0];
        step > 0.0
            && around
                .windows(2)
                .all(|pair| (pair[1] - pair[0] - step).abs() <= STEADY * step)
    }

    /// The arc on which a piece turns at constant speed, by its number and the advance from step to step; `None` where
    /// anything else has made the piece what it is.
    pub(super) fn steady_turn(&self, index: usize, curve: &Curve<N>) -> Option<(u32, u64)> {
        let (first, last) = (index.checked_sub(1)?, index + 4);
        let [from, to] = [self.controls.get(first)?.leg, self.controls.get(last)?.leg];
        if !curve.are_one_arc(from, to) {
            return None;
        }
        let around = &self.progress[first..=last];
        let step = around[1] - around[0];
        let same = around
            .windows(2)
            .all(|pair| (pair[1] - pair[0] - step).abs() <= ALIKE * step);
        // Far from zero the velocities of pieces differ by the rounding of their points: each is looked at by itself.
        let rounding = 4.0 * f64::EPSILON * self.controls[index].point.amax();
        let near = rounding <= LIMIT_SLACK * step;
        // What is left of rounding is cut off.
        (same && near).then(|| {
            (
                curve.legs()[from].serves.last,
                step.to_bits() >> ROUNDING_BITS,
            )
        })
    }

    /// Speed at a control point.
    pub(super) fn speed(&self, index: usize) -> f64 {
        (self.progress[index + 1] - self.progress[index - 1]) / (2.0 * self.step)
    }

    /// How the motion goes on after a control point, and how many legs are then no longer needed.
    #[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
    pub(super) fn onward(
        &self,
        settled: usize,
        handover: &SwitchState,
        curve: &Curve<N>,
    ) -> (Continuation<N>, usize) {
        let mut controls = [0, 1, 2].map(|offset| self.controls[settled + offset - 2]);
        let back = 2.0 * controls[0].distance - controls[2].distance;
        let legs = curve.leg_at(back.max(0.0), controls[0].leg);
        let passed = curve.mark(legs);
        for control in &mut controls {
            control.leg -= legs;
            control.distance -= passed;
        }
        let next = self.origin + (settled as f64 + 2.0) * self.step;
        let onward = Continuation {
            filter: Filter {
                lags: self.lags,
                inside: self.inside,
                ..Filter::sharp(self.step, self.sharpening)
            },
            controls,
            progress: [0, 1].map(|offset| self.progress[settled + offset] - passed),
            start: SwitchState {
                time: 0.0,
                distance: handover.distance - passed,
                speed: handover.speed,
            },
            first: next - handover.time,
        };
        (onward, legs)
    }

    /// A piece of the motion.
    pub(super) fn piece(&self, index: usize) -> Piece<N> {
        let step = self.step;
        let [_, b, c, _] = self.four(index).map(|control| &control.point);
        let differences = self.differences(index);
        let Differences { seconds, third, .. } = differences;
        let start = Sample {
            position: b + seconds[0] / 6.0,
            velocity: differences.around(0) / step,
            acceleration: seconds[0] / (step * step),
            jerk: third / step.powi(3),
        };
        let end = c + seconds[1] / 6.0;
        let [first, .., last] = self.four(index);
        let serves = MoveRange {
            first: first.serves.first,
            last: last.serves.last,
        };
        Piece::new(&start, step, end, serves)
    }

    /// The differences of the control points of a piece.
    fn differences(&self, index: usize) -> Differences<N> {
        let [a, b, c, d] = self.four(index).map(|control| control.point);
        Differences::of(&[a, b, c, d])
    }

    fn four(&self, index: usize) -> [&Control<N>; 4] {
        [0, 1, 2, 3].map(|offset| &self.controls[index + offset])
    }
}

/// First, second and third differences of four control points.
///
/// Neighbours lie so near to each other that their difference is exact, however far from zero both are; the others
/// are made of these, so that what is left of them has the rounding of steps and not that of coordinates. Two
/// pieces that share three points have the same second difference between them, to the last digit.
#[derive(Clone, Copy, Debug)]
struct Differences<const N: usize> {
    firsts: [Vector<N>; 3],
    seconds: [Vector<N>; 2],
    third: Vector<N>,
}

impl<const N: usize> Differences<N> {
    fn of([a, b, c, d]: &[Vector<N>; 4]) -> Self {
        let firsts = [b - a, c - b, d - c];
        let seconds = [firsts[1] - firsts[0], firsts[2] - firsts[1]];
        Self {
            firsts,
            seconds,
            third: seconds[1] - seconds[0],
        }
    }

    /// Velocity at a knot times the step: the mean of the differences on both sides.
    fn around(&self, knot: usize) -> Vector<N> {
        (self.firsts[knot] + self.firsts[knot + 1]) * 0.5
    }
}
