//! Checks velocity, acceleration, jerk and deviation of a spline exactly.
//!
//! Source: ours. Acceleration at the knots and jerk between them are differences of control points;
//! Bezier points bound the velocity, and where the motion runs, between the knots. Not here: what is done about
//! it.

use crate::bend::Bend;
use crate::segment::Segment;
use crate::short_segments::curve::{Control, Curve, distance_to};
use crate::short_segments::spline::{Differences, Spline};
use toolglide_kinematics::numeric::LIMIT_SLACK;
use toolglide_kinematics::{Limits, Vector, largest_multiple};

/// Parts into which a piece is cut where its Bezier points are compared with the path: at first, and
/// where that is not sharp enough.
const PARTS: [usize; 2] = [4, 16];

/// Places of a piece at which its height on a helix is compared.
const HEIGHTS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Legs beside a part of a piece that are compared with it one by one.
const FEW: usize = 12;

/// Share of the limits that changes of speed use at the least where they are to blame for an excess.
const ALONG: f64 = 0.6;

/// What a piece exceeds, and how much slower it would have to be, estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::short_segments) enum Excess {
    /// The feedrate.
    Feedrate(f64),
    /// Acceleration or jerk, because the speed changes.
    Changes(f64),
    /// Acceleration, jerk or tolerance, because the curve is travelled too fast.
    Curvature(f64),
}

impl<const N: usize> Spline<N> {
    /// What a piece exceeds of all limits and the tolerance at any instant of it; `None` when it keeps
    /// them.
    pub(in crate::short_segments) fn excess(
        &self,
        index: usize,
        curve: &Curve<N>,
        limits: &Limits<N>,
    ) -> Option<Excess> {
        let step = self.step;
        let [a, _, _, d] = self.four(index);
        let feedrate = curve.legs()[a.leg..=d.leg]
            .iter()
            .fold(0.0_f64, |most, leg| most.max(leg.feedrate));
        let differences = self.differences(index);
        let Differences { seconds, third, .. } = differences;
        let slack = 1.0 - LIMIT_SLACK;
        let accelerations = seconds
            .map(|second| largest_multiple(&second, limits.acceleration()) * slack * step * step);
        let jerk = largest_multiple(&third, limits.jerk()) * slack * step.powi(3);
        // The velocity is a quadratic; its Bezier points, cut in two, bound the speed and each axis.
        let middle = differences.firsts[1];
        let [first, last] = [0, 1].map(|knot| differences.around(knot));
        let round = [a, d]
            .iter()
            .any(|end| curve.legs()[end.leg].bend.is_some());
        let fastest = if round {
            largest_norm(&first, &middle, &last)
        } else {
            f64::INFINITY
        };
        let mut speed = f64::INFINITY;
        for velocity in [
            first,
            (first + middle) * 0.5,
            (first + middle * 2.0 + last) * 0.25,
            (middle + last) * 0.5,
            last,
        ] {
            let multiple = largest_multiple(&velocity, limits.velocity());
            speed = speed.min(multiple.min(feedrate / velocity.norm().min(fastest)) * slack * step);
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

    /// Whether a piece keeps the limits of all axes in whatever direction it is turned.
    pub(in crate::short_segments) fn is_within_any(
        &self,
        index: usize,
        limits: &Limits<N>,
    ) -> bool {
        let step = self.step;
        let slack = 1.0 - 2.0 * LIMIT_SLACK;
        let Differences {
            firsts,
            seconds,
            third,
        } = self.differences(index);
        let speed = firsts
            .iter()
            .fold(0.0_f64, |most, first| most.max(first.norm()));
        let acceleration = seconds[0].norm().max(seconds[1].norm());
        speed <= slack * step * limits.velocity().min()
            && acceleration <= slack * step * step * limits.acceleration().min()
            && third.norm() <= slack * step.powi(3) * limits.jerk().min()
    }

    /// The tolerance by the distance between motion and path, bounded on parts of a piece; at least 1
    /// when the motion stays within the tolerance of the path, and the path of the motion.
    #[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
    fn nearness(&self, index: usize, curve: &Curve<N>, parts: usize) -> f64 {
        let four = self.four(index);
        let [a, b, c, d] = four;
        // Motion and curve do not advance alike; the part of the curve is taken longer by that.
        let lag = ((c.distance - 2.0 * b.distance + a.distance).abs())
            .max((d.distance - 2.0 * c.distance + b.distance).abs())
            / 6.0;
        let spread = 0.25 * (self.around - 1) as f64 * (c.distance - b.distance).abs();
        let first = curve.leg_at(a.distance - spread, a.leg);
        let last = curve.leg_at(d.distance + spread, d.leg);
        let room = curve.legs()[first..=last]
            .iter()
            .fold(f64::INFINITY, |least, leg| least.min(leg.room().length()));
        let beside = &curve.legs()[b.leg];
        if let Some(bend) = &beside.bend
            && curve.are_one_arc(first, last)
        {
            let uneven = curve.unevenness(first, last);
            return room / (off_arc(&four, bend) + uneven).max(f64::MIN_POSITIVE);
        }
        if b.leg == c.leg && beside.bend.is_none() {
            // The piece lies among its control points.
            let off = four.iter().fold(0.0_f64, |most, control| {
                most.max(distance_to(&control.point, &beside.start, &beside.end))
            });
            if off <= room {
                return room / off.max(f64::MIN_POSITIVE);
            }
        }
        let mut furthest = 0.0_f64;
        let mut rest = bezier(&four);
        let advance = (c.distance - b.distance) / parts as f64;
        let pad = lag + 0.5 * advance.abs() + 0.5 * room + spread;
        for part in 0..parts {
            let (points, remaining) = split(&rest, 1.0 / (parts - part) as f64);
            rest = remaining;
            let begin = b.distance + advance * part as f64;
            let span = Span::of(curve, begin - pad, begin + advance + pad, b.leg);
            let off = points
                .iter()
                .fold(0.0_f64, |most, point| most.max(span.distance(point)));
            let mut off = off + span.deviation;
            if off > room && span.legs.len() <= FEW {
                // Beside a sharp corner the part is near one of the legs.
                let lines = span.legs.iter().filter(|leg| leg.bend.is_none());
                off = lines.fold(off, |least, leg| {
                    let beside = points.iter().fold(0.0_f64, |most, point| {
                        most.max(distance_to(point, &leg.start, &leg.end))
                    });
                    least.min(beside)
                });
            }
            furthest = furthest.max(off);
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

    /// Whether the motion passes all corners of the curve within their tolerance one after the other.
    pub(in crate::short_segments) fn passes_in_order(&self, curve: &Curve<N>) -> bool {
        let last = curve.legs().len().saturating_sub(1);
        let corners = curve.legs()[..last].iter();
        self.passes(corners.map(|leg| (leg.end, leg.room().length(), u32::MAX)))
    }

    /// Whether the motion comes as near to points as is said, one after the other, while it serves their moves.
    #[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
    pub(in crate::short_segments) fn passes(
        &self,
        points: impl Iterator<Item = (Vector<N>, f64, u32)>,
    ) -> bool {
        let cuts = PARTS[1];
        let mut corners = points.peekable();
        for piece in 0..self.pieces() {
            let serves = self.four(piece)[0].serves.first;
            if corners.peek().is_some_and(|(_, _, step)| *step < serves) {
                return false;
            }
            let [a, b, c, d] = self.four(piece).map(|control| control.point);
            let second = (c - b * 2.0 + a).norm().max((d - c * 2.0 + b).norm());
            let sagitta = second / (8.0 * (cuts * cuts) as f64);
            let mut from = (a + b * 4.0 + c) / 6.0;
            for cut in 1..=cuts {
                let to = at(&[a, b, c, d], cut as f64 / cuts as f64);
                let mut since = 0.0;
                while let Some((point, room, _)) = corners.peek()
                    && let Some(share) = enters(point, room - sagitta, [&from, &to], since)
                {
                    since = share;
                    corners.next();
                }
                from = to;
            }
        }
        corners.peek().is_none()
    }

    /// Least distance from a point to the motion around a piece, found on chords and so an upper
    /// bound once their sagitta is added.
    #[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
    fn nearest(&self, index: usize, point: &Vector<N>) -> f64 {
        let cuts = PARTS[1];
        let mut least = f64::INFINITY;
        let around = self.around;
        for piece in index.saturating_sub(around)..(index + around + 1).min(self.pieces()) {
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

/// The first share of a chord, from `since` on, at which it is within a radius of a point.
fn enters<const N: usize>(
    point: &Vector<N>,
    radius: f64,
    [from, to]: [&Vector<N>; 2],
    since: f64,
) -> Option<f64> {
    let (chord, offset) = (to - from, from - point);
    if radius < 0.0 {
        return None;
    }
    if (offset + chord * since).norm() <= radius {
        return Some(since);
    }
    let (square, half) = (chord.norm_squared(), chord.dot(&offset));
    let root = half * half - square * (offset.norm_squared() - radius * radius);
    if square <= 0.0 || root < 0.0 {
        return None;
    }
    let share = (-half - root.sqrt()) / square;
    (since..=1.0).contains(&share).then_some(share)
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

/// Largest length of a quadratic with these Bezier points: its square is a polynomial of fourth degree, which lies among
/// its Bezier coefficients. Where it turns at constant length that is far less than the length of the middle point.
fn largest_norm<const N: usize>(first: &Vector<N>, middle: &Vector<N>, last: &Vector<N>) -> f64 {
    [
        first.dot(first),
        first.dot(middle),
        (first.dot(last) + 2.0 * middle.dot(middle)) / 3.0,
        middle.dot(last),
        last.dot(last),
    ]
    .into_iter()
    .fold(0.0, f64::max)
    .sqrt()
}

/// The Bezier points of a piece.
fn bezier<const N: usize>([a, b, c, d]: &[&Control<N>; 4]) -> [Vector<N>; 4] {
    let [a, b, c, d] = [a.point, b.point, c.point, d.point];
    [
        (a + b * 4.0 + c) / 6.0,
        (b * 2.0 + c) / 3.0,
        (b + c * 2.0) / 3.0,
        (b + c * 4.0 + d) / 6.0,
    ]
}

/// How far a piece is from the arc to which its control points belong, bounded.
///
/// The square of the distance from the axis is a polynomial of sixth degree, which lies among its Bezier
/// coefficients. Along the axis the piece is compared at a few places with the height that its angle asks for.
fn off_arc<const N: usize>(four: &[&Control<N>; 4], bend: &Bend<N>) -> f64 {
    let points = bezier(four).map(|point| bend.around_axis(&point));
    let dot = |one: usize, other: usize| {
        points[one].planar[0] * points[other].planar[0]
            + points[one].planar[1] * points[other].planar[1]
    };
    let squares = [
        dot(0, 0),
        dot(0, 1),
        (6.0 * dot(0, 2) + 9.0 * dot(1, 1)) / 15.0,
        (2.0 * dot(0, 3) + 18.0 * dot(1, 2)) / 20.0,
        (6.0 * dot(1, 3) + 9.0 * dot(2, 2)) / 15.0,
        dot(2, 3),
        dot(3, 3),
    ];
    let (least, most) = squares
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(least, most), square| {
            (least.min(*square), most.max(*square))
        });
    let radius = bend.radius();
    let radial = (most.sqrt() - radius)
        .abs()
        .max((radius - least.max(0.0).sqrt()).abs());
    let Some(slope) = bend.slope() else {
        let flat = points.iter().map(|point| point.height.norm());
        return radial.hypot(flat.fold(0.0, f64::max));
    };
    let [a, b, c, d] = four.map(|control| control.point);
    let mut axial = 0.0_f64;
    for share in HEIGHTS {
        let place = bend.around_axis(&at(&[a, b, c, d], share));
        let [along, outward] = place.planar;
        axial = axial.max((place.height - slope * along.atan2(outward)).norm());
    }
    let second = (c - b * 2.0 + a).norm().max((d - c * 2.0 + b).norm());
    let between = 0.125 * (HEIGHTS[1] * HEIGHTS[1]) * second * (1.0 + slope.norm() / radius);
    radial.hypot(axial + between)
}

/// A part of the curve as one line, and how far the curve lies from it.
struct Span<'a, const N: usize> {
    from: Vector<N>,
    to: Vector<N>,
    deviation: f64,
    legs: &'a [Segment<N>],
}

impl<'a, const N: usize> Span<'a, N> {
    fn of(curve: &'a Curve<N>, begin: f64, end: f64, near: usize) -> Self {
        let (first, last) = (curve.leg_at(begin, near), curve.leg_at(end, near));
        let from = curve.point(begin, first);
        let to = curve.point(end, last);
        let corners = curve.legs()[first..last].iter().fold(0.0_f64, |most, leg| {
            most.max(distance_to(&leg.end, &from, &to))
        });
        let deviation = corners + curve.sagitta(begin, end, first, last);
        Self {
            from,
            to,
            deviation,
            legs: &curve.legs()[first..=last],
        }
    }

    fn distance(&self, point: &Vector<N>) -> f64 {
        distance_to(point, &self.from, &self.to)
    }
}
