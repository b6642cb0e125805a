//! Control points in equal time steps, the motion between them, and an exact judgement of it.
//!
//! Source: ours. A cubic spline over equal steps has the second difference of its control points for
//! acceleration at the knots and the third for jerk between them, so both are judged exactly; its
//! Bezier points bound where it runs, so the tolerance is judged between the knots as well. Not here:
//! where the control points come from.

use super::Onward;
use super::curve::{Control, Curve, distance_to};
use super::pace::{Filter, Handover};
use toolglide_kinematics::numeric::LIMIT_SLACK;
use toolglide_kinematics::{Limits, Piece, Sample, Serves, Vector, largest_multiple};

/// Parts into which a piece is cut where its Bezier points are compared with the path: at first, and
/// where that is not sharp enough.
const PARTS: [usize; 2] = [4, 16];

/// Change of the progress from step to step that is nothing but rounding, relative.
const STEADY: f64 = 1e-10;

/// Share of the limits that changes of speed use at the least where they are to blame for an excess.
const ALONG: f64 = 0.6;

/// What a piece exceeds, and how much slower it would have to be, estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Excess {
    /// The feedrate.
    Feedrate(f64),
    /// Acceleration or jerk, because the speed changes.
    Changes(f64),
    /// Acceleration, jerk or tolerance, because the curve is travelled too fast.
    Curvature(f64),
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
    /// Where another progress may go on.
    pub(super) handover: Option<Handover>,
}

impl<const N: usize> Spline<N> {
    pub(super) fn with_capacity(controls: usize) -> Self {
        Self {
            controls: Vec::with_capacity(controls),
            progress: Vec::with_capacity(controls),
            step: 0.0,
            origin: 0.0,
            sharpening: 0.0,
            handover: None,
        }
    }

    /// Forgets all control points.
    pub(super) fn clear(&mut self, filter: &Filter) {
        self.controls.clear();
        self.progress.clear();
        self.step = filter.step;
        self.sharpening = filter.sharpening;
        self.handover = None;
    }

    /// Adds a control point, made of a progress.
    pub(super) fn push(&mut self, control: Control<N>, progress: f64) {
        self.controls.push(control);
        self.progress.push(progress);
    }

    /// Moves the control points from an index on so that the spline follows what they sample: along the
    /// path by all that it lags behind, across it by a share.
    pub(super) fn sharpen(&mut self, first: usize, curve: &Curve<N>, share: f64) {
        let controls = &mut self.controls;
        let progress = self.progress[first - 1];
        let mut before = curve.control_at(progress, controls[first - 1].leg);
        for index in first..controls.len() - 1 {
            let here = controls[index];
            let after = controls[index + 1];
            let second = after.point - here.point * 2.0 + before.point;
            let lag = (after.distance - 2.0 * here.distance + before.distance) / 6.0;
            before = here;
            // Rounding may not turn the order around.
            let distance = (here.distance - lag)
                .min(curve.length())
                .max(controls[index - 1].distance);
            let along = curve.legs()[here.leg].direction * lag;
            let mut control = curve.control_at(distance, here.leg);
            control.point -= (second / 6.0 - along) * share;
            controls[index] = control;
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
    pub(super) fn handover(&self, curve: &Curve<N>) -> Option<(usize, Handover)> {
        let last = curve.legs().len() - 1;
        let begin = self.controls.partition_point(|control| control.leg < last) + 2;
        if let Some(index) = (begin..self.controls.len()).find(|&index| self.is_steady(index)) {
            let handover = Handover {
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

    /// Speed at a control point.
    pub(super) fn speed(&self, index: usize) -> f64 {
        (self.progress[index + 1] - self.progress[index - 1]) / (2.0 * self.step)
    }

    /// How the motion goes on after a control point, and how many legs are then no longer needed.
    #[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
    pub(super) fn onward(
        &self,
        settled: usize,
        handover: &Handover,
        curve: &Curve<N>,
    ) -> (Onward<N>, usize) {
        let mut controls = [0, 1, 2].map(|offset| self.controls[settled + offset - 2]);
        let back = 2.0 * controls[0].distance - controls[2].distance;
        let legs = curve.leg_at(back.max(0.0), controls[0].leg);
        let passed = curve.mark(legs);
        for control in &mut controls {
            control.leg -= legs;
            control.distance -= passed;
        }
        let next = self.origin + (settled as f64 + 2.0) * self.step;
        let onward = Onward {
            filter: Filter {
                step: self.step,
                sharpening: self.sharpening,
            },
            controls,
            progress: [0, 1].map(|offset| self.progress[settled + offset] - passed),
            start: Handover {
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
        let [a, b, c, d] = self.four(index);
        let [a, b, c, d] = [&a.point, &b.point, &c.point, &d.point];
        let start = Sample {
            position: b + (a - b * 2.0 + c) / 6.0,
            velocity: (c - a) / (2.0 * step),
            acceleration: (c - b * 2.0 + a) / (step * step),
            jerk: (d - c * 3.0 + b * 3.0 - a) / step.powi(3),
        };
        let end = c + (b - c * 2.0 + d) / 6.0;
        let [first, .., last] = self.four(index);
        let serves = Serves {
            first: first.serves.first,
            last: last.serves.last,
        };
        Piece::new(&start, step, end, serves)
    }

    fn four(&self, index: usize) -> [&Control<N>; 4] {
        [0, 1, 2, 3].map(|offset| &self.controls[index + offset])
    }

    /// What a piece exceeds of all limits and the tolerance at any instant of it; `None` when it keeps
    /// them.
    pub(super) fn excess(
        &self,
        index: usize,
        curve: &Curve<N>,
        limits: &Limits<N>,
    ) -> Option<Excess> {
        let step = self.step;
        let [a, b, c, d] = self.four(index);
        let feedrate = curve.legs()[a.leg..=d.leg]
            .iter()
            .fold(f64::INFINITY, |least, leg| least.min(leg.limits.velocity));
        let [a, b, c, d] = [a.point, b.point, c.point, d.point];
        let slack = 1.0 - LIMIT_SLACK;
        let accelerations = [c - b * 2.0 + a, d - c * 2.0 + b]
            .map(|second| largest_multiple(&second, limits.acceleration()) * slack * step * step);
        let jerk =
            largest_multiple(&(d - c * 3.0 + b * 3.0 - a), limits.jerk()) * slack * step.powi(3);
        // The velocity is a quadratic; its Bezier points, cut in two, bound the speed and each axis.
        let [first, middle, last] = [(c - a) * 0.5, c - b, (d - b) * 0.5];
        let mut speed = f64::INFINITY;
        for velocity in [
            first,
            (first + middle) * 0.5,
            (first + middle * 2.0 + last) * 0.25,
            (middle + last) * 0.5,
            last,
        ] {
            let multiple = largest_multiple(&velocity, limits.velocity());
            speed = speed.min(multiple.min(feedrate / velocity.norm()) * slack * step);
        }
        let [first, second] = accelerations;
        let changes = first.min(second).sqrt().min(jerk.cbrt());
        if changes < 1.0 {
            let [a, b, c, d] = self.four(index);
            let progress = [
                c.distance - 2.0 * b.distance + a.distance,
                d.distance - 2.0 * c.distance + b.distance,
                d.distance - 3.0 * c.distance + 3.0 * b.distance - a.distance,
            ];
            let limits = &curve.legs()[b.leg].limits;
            let along = (progress[0].abs().max(progress[1].abs())
                / (limits.acceleration * step * step))
                .max(progress[2].abs() / (limits.jerk * step.powi(3)));
            return Some(if along > ALONG {
                Excess::Changes(changes)
            } else {
                Excess::Curvature(changes)
            });
        }
        if speed < 1.0 {
            return Some(Excess::Feedrate(speed));
        }
        let mut nearness = 0.0_f64;
        for parts in PARTS {
            nearness = nearness.max(self.nearness(index, curve, parts));
            if nearness >= 1.0 {
                return None;
            }
        }
        Some(Excess::Curvature(nearness.sqrt()))
    }

    /// The tolerance by the distance between motion and path, bounded on parts of a piece; at least 1
    /// when the motion stays within the tolerance of the path, and the path of the motion.
    #[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
    fn nearness(&self, index: usize, curve: &Curve<N>, parts: usize) -> f64 {
        let [a, b, c, d] = self.four(index);
        let room = curve.legs()[a.leg..=d.leg]
            .iter()
            .fold(f64::INFINITY, |least, leg| least.min(leg.room().length()));
        let mut furthest = 0.0_f64;
        let mut rest = [
            (a.point + b.point * 4.0 + c.point) / 6.0,
            (b.point * 2.0 + c.point) / 3.0,
            (b.point + c.point * 2.0) / 3.0,
            (b.point + c.point * 4.0 + d.point) / 6.0,
        ];
        // Motion and curve do not advance alike; the part of the curve is taken longer by that.
        let lag = ((c.distance - 2.0 * b.distance + a.distance).abs())
            .max((d.distance - 2.0 * c.distance + b.distance).abs())
            / 6.0;
        let advance = (c.distance - b.distance) / parts as f64;
        let pad = lag + 0.5 * advance.abs() + 0.5 * room;
        for part in 0..parts {
            let (points, remaining) = split(&rest, 1.0 / (parts - part) as f64);
            rest = remaining;
            let begin = b.distance + advance * part as f64;
            let span = Span::of(curve, begin - pad, begin + advance + pad, b.leg);
            let off = points
                .iter()
                .fold(0.0_f64, |most, point| most.max(span.distance(point)));
            furthest = furthest.max(off + span.deviation);
            // Each corner of the path beside this part must be near it.
            let flat = distance_to(&points[1], &points[0], &points[3])
                .max(distance_to(&points[2], &points[0], &points[3]));
            let first = curve.leg_at(begin, b.leg);
            let last = curve.leg_at(begin + advance, b.leg);
            for leg in &curve.legs()[first..last] {
                let beside = distance_to(&leg.end, &points[0], &points[3]) + flat;
                if beside > room {
                    furthest = furthest.max(self.nearest(index, &leg.end));
                }
            }
        }
        room / furthest.max(f64::MIN_POSITIVE)
    }

    /// Least distance from a point to the motion around a piece, found on chords and so an upper
    /// bound once their sagitta is added.
    #[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
    fn nearest(&self, index: usize, point: &Vector<N>) -> f64 {
        let cuts = PARTS[1];
        let mut least = f64::INFINITY;
        for piece in index.saturating_sub(1)..(index + 2).min(self.pieces()) {
            let [a, b, c, d] = self.four(piece).map(|control| control.point);
            let second = (c - b * 2.0 + a).norm().max((d - c * 2.0 + b).norm());
            let sagitta = second / (8.0 * (cuts * cuts) as f64);
            let mut from = (a + b * 4.0 + c) / 6.0;
            for cut in 1..=cuts {
                let to = at(&[a, b, c, d], cut as f64 / cuts as f64);
                least = least.min(distance_to(point, &from, &to) + sagitta);
                from = to;
            }
        }
        least
    }
}

/// The spline between two knots, by the share of the step.
fn at<const N: usize>(controls: &[Vector<N>; 4], share: f64) -> Vector<N> {
    let [a, b, c, d] = controls;
    let rest = 1.0 - share;
    let (cube, square) = (share.powi(3), share * share);
    (a * rest.powi(3)
        + b * (3.0 * cube - 6.0 * square + 4.0)
        + c * (-3.0 * cube + 3.0 * square + 3.0 * share + 1.0)
        + d * cube)
        / 6.0
}

/// Cuts a cubic at a share of it.
fn split<const N: usize>(points: &[Vector<N>; 4], share: f64) -> ([Vector<N>; 4], [Vector<N>; 4]) {
    let between = |a: &Vector<N>, b: &Vector<N>| a + (b - a) * share;
    let [a, b, c, d] = points;
    let (ab, bc, cd) = (between(a, b), between(b, c), between(c, d));
    let (abc, bcd) = (between(&ab, &bc), between(&bc, &cd));
    let middle = between(&abc, &bcd);
    ([*a, ab, abc, middle], [middle, bcd, cd, *d])
}

/// A part of the curve as one line, and how far the curve lies from it.
struct Span<const N: usize> {
    from: Vector<N>,
    to: Vector<N>,
    deviation: f64,
}

impl<const N: usize> Span<N> {
    fn of(curve: &Curve<N>, begin: f64, end: f64, near: usize) -> Self {
        let (first, last) = (curve.leg_at(begin, near), curve.leg_at(end, near));
        let from = curve.point(begin, first);
        let to = curve.point(end, last);
        let deviation = curve.legs()[first..last].iter().fold(0.0_f64, |most, leg| {
            most.max(distance_to(&leg.end, &from, &to))
        });
        Self {
            from,
            to,
            deviation,
        }
    }

    fn distance(&self, point: &Vector<N>) -> f64 {
        distance_to(point, &self.from, &self.to)
    }
}
