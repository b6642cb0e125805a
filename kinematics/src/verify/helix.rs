//! Distance from an arc, which may climb and whose radius may change.
//!
//! Source: the foot of the perpendicular by Newton's method from the angle of the point; over a
//! whole curve, the remainder of linear interpolation, `max|f''|/8`, applied twice. Not here:
//! lines, whose distance is convex.

use std::f64::consts::TAU;

use super::bernstein::Cubic;
use crate::arc::Arc;
use crate::vector::Vector;

/// Newton steps towards the foot of a perpendicular: the start is the angle of the point itself.
const FOOT_STEPS: u32 = 6;

/// A step of the foot below this share of the turn ends the search: rounding, dimensionless.
const FOOT_PRECISION: f64 = 1e-15;

/// A point nearer than this share of the radius has its foot where the search starts, dimensionless.
const CLOSE: f64 = 0.1;

/// How many turns are surveyed for a point which is not close, and with how many points.
const SURVEYED_TURNS: f64 = 4.0;
const SURVEY_POINTS: u32 = 96;

/// Largest part of a turn between two waypoints, of a whole turn.
const WAYPOINT_SPACING: f64 = TAU / 3.0;

/// An arc, prepared for many questions.
#[derive(Clone, Debug)]
pub(super) struct Helix<const N: usize> {
    arc: Arc<N>,
    center: Vector<N>,
    radial: Vector<N>,
    lateral: Vector<N>,
    lift: Vector<N>,
    radius: f64,
    growth: f64,
    sweep: f64,
    /// Bounds of the second, third and fourth derivative by the share of the sweep.
    bends: [f64; 3],
}

/// The arc at one share of its sweep: position relative to a point, first and second derivative.
struct Foot<const N: usize> {
    offset: Vector<N>,
    slope: Vector<N>,
    bend: Vector<N>,
}

/// A point in the frame of the arc.
struct Local<const N: usize> {
    x: f64,
    y: f64,
    height: Vector<N>,
}

impl<const N: usize> Helix<N> {
    pub(super) fn new(arc: &Arc<N>) -> Self {
        let (radial, lateral) = arc.frame();
        let (radius, end_radius) = arc.radii();
        let growth = end_radius - radius;
        let turn = arc.sweep().abs();
        let (widest, change) = (radius.max(end_radius), growth.abs());
        let bend = |order: i32| {
            turn.powi(order) * widest + f64::from(order) * turn.powi(order - 1) * change
        };
        Self {
            arc: *arc,
            center: arc.center(),
            radial,
            lateral,
            lift: arc.lift(),
            radius,
            growth,
            sweep: arc.sweep(),
            bends: [bend(2), bend(3), bend(4)],
        }
    }

    pub(super) fn radius(&self) -> f64 {
        self.radius.max(self.radius + self.growth)
    }

    pub(super) fn point(&self, share: f64) -> Vector<N> {
        self.arc.point(share)
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a sweep is at most a few 2^32 turns and positive here; the cast saturates"
    )]
    pub(super) fn waypoints(&self) -> u64 {
        (self.sweep.abs() / WAYPOINT_SPACING).floor() as u64
    }

    /// Share of the sweep and distance of the nearest point.
    pub(super) fn nearest(&self, point: &Vector<N>) -> (f64, f64) {
        let local = self.local(point);
        let mut best = (0.0, (point - self.arc.start()).norm());
        let at_end = (point - self.arc.end()).norm();
        if at_end < best.1 {
            best = (1.0, at_end);
        }
        let turn = self.sweep.abs();
        let angle = (local.y * self.sweep.signum()).atan2(local.x);
        let angle = if angle < 0.0 { angle + TAU } else { angle };
        if self.growth.abs() + self.lift.norm_squared() <= 0.0 {
            if angle <= turn {
                let across = local.x.hypot(local.y) - self.radius;
                let distance = across.hypot(local.height.norm());
                if distance < best.1 {
                    best = (angle / turn, distance);
                }
            }
            return best;
        }
        let rise = self.growth * self.growth + self.lift.norm_squared();
        let level = ((local.x.hypot(local.y) - self.radius) * self.growth
            + local.height.dot(&self.lift))
            / rise;
        let whole = ((level.clamp(0.0, 1.0) * turn - angle) / TAU).round();
        let guess = self.best_of(
            [whole, whole - 1.0, whole + 1.0].map(|k| (angle + TAU * k) / turn),
            &local,
        );
        let mut tries = [guess.0, guess.0];
        if guess.1 > CLOSE * self.radius {
            tries[1] = self.survey(level, &local);
        }
        for guess in tries {
            let guess = guess.clamp(0.0, 1.0);
            for share in [self.foot(guess, &local), guess] {
                let distance = self.away(share, &local);
                if distance < best.1 {
                    best = (share, distance);
                }
            }
        }
        best
    }

    /// Bernstein coefficients of a cubic that is nowhere below the distance of the curve.
    pub(super) fn majorant(&self, curve: &Cubic<N>) -> [f64; 4] {
        let middle = curve.at(0.5);
        let (share, _) = self.nearest(&middle);
        let foot = self.at(share, &self.local(&middle));
        let half_step = 0.5 * advance(&foot, &curve.slope(0.5));
        let [first, _, _, last] = &curve.points;
        let (from, to) = (self.local(first), self.local(last));
        let s0 = self.foot((share - half_step).clamp(0.0, 1.0), &from);
        let s1 = self.foot((share + half_step).clamp(0.0, 1.0), &to);
        let (start, end) = (self.at(s0, &from), self.at(s1, &to));
        // A cubic s(u) that stays within the arc and keeps beside the curve.
        let b1 = (s0 + advance(&start, &curve.slope(0.0)) / 3.0).clamp(0.0, 1.0);
        let b2 = (s1 - advance(&end, &curve.slope(1.0)) / 3.0).clamp(0.0, 1.0);
        let slopes = [3.0 * (b1 - s0), 3.0 * (b2 - b1), 3.0 * (s1 - b2)];
        let bends = [6.0 * (b2 - 2.0 * b1 + s0), 6.0 * (s1 - 2.0 * b2 + b1)];
        let twist = bends[1] - bends[0];
        let error_bend = |foot: &Foot<N>, bend: Vector<N>, slope: f64, s_bend: f64| {
            (bend - foot.bend * (slope * slope) - foot.slope * s_bend).norm()
        };
        let error_bends = [
            error_bend(&start, curve.bend(0.0), slopes[0], bends[0]),
            error_bend(&end, curve.bend(1.0), slopes[2], bends[1]),
        ];
        let speed = slopes
            .iter()
            .fold(0.0_f64, |most, slope| most.max(slope.abs()));
        let change = bends[0].abs().max(bends[1].abs());
        let [q2, q3, q4] = self.bends;
        let fourth = q4 * speed.powi(4)
            + 6.0 * q3 * speed * speed * change
            + q2 * (3.0 * change * change + 4.0 * speed * twist.abs());
        let bend = error_bends[0].max(error_bends[1]) + fourth / 8.0;
        let (e0, e1) = (start.offset.norm(), end.offset.norm());
        let quadratic = [e0, 0.5 * (e0 + e1) + 0.25 * bend, e1];
        [
            e0,
            (quadratic[0] + 2.0 * quadratic[1]) / 3.0,
            (2.0 * quadratic[1] + quadratic[2]) / 3.0,
            e1,
        ]
    }

    fn local(&self, point: &Vector<N>) -> Local<N> {
        let offset = point - self.center;
        let (x, y) = (offset.dot(&self.radial), offset.dot(&self.lateral));
        Local {
            x,
            y,
            height: offset - self.radial * x - self.lateral * y,
        }
    }

    fn at(&self, share: f64, local: &Local<N>) -> Foot<N> {
        let (sine, cosine) = (share * self.sweep).sin_cos();
        let outward = self.radial * cosine + self.lateral * sine;
        let along = self.lateral * cosine - self.radial * sine;
        let radius = self.radius + share * self.growth;
        let (ahead, aside) = (
            local.x * cosine + local.y * sine,
            local.y * cosine - local.x * sine,
        );
        Foot {
            offset: outward * (radius - ahead) - along * aside + (self.lift * share - local.height),
            slope: outward * self.growth + along * (radius * self.sweep) + self.lift,
            bend: along * (2.0 * self.growth * self.sweep)
                - outward * (radius * self.sweep * self.sweep),
        }
    }

    fn away(&self, share: f64, local: &Local<N>) -> f64 {
        self.at(share, local).offset.norm()
    }

    /// The candidate nearest to a point, among those within the arc.
    fn best_of(&self, shares: [f64; 3], local: &Local<N>) -> (f64, f64) {
        let mut best = (0.5, f64::INFINITY);
        for share in shares {
            let distance = self.away(share.clamp(0.0, 1.0), local);
            if distance < best.1 {
                best = (share, distance);
            }
        }
        best
    }

    /// The nearest of many points of the arc, on the turns about a share of its sweep.
    fn survey(&self, about: f64, local: &Local<N>) -> f64 {
        let reach = (SURVEYED_TURNS * TAU / self.sweep.abs()).min(1.0);
        let from = (about - 0.5 * reach).clamp(0.0, 1.0 - reach);
        let mut best = (about, f64::INFINITY);
        for k in 0..=SURVEY_POINTS {
            let share = from + reach * f64::from(k) / f64::from(SURVEY_POINTS);
            let distance = self.away(share, local);
            if distance < best.1 {
                best = (share, distance);
            }
        }
        best.0
    }

    /// Foot of the perpendicular that Newton's method reaches from a guess.
    fn foot(&self, guess: f64, local: &Local<N>) -> f64 {
        let mut share = guess;
        for _ in 0..FOOT_STEPS {
            let foot = self.at(share, local);
            let curvature = foot.slope.norm_squared() + foot.offset.dot(&foot.bend);
            let step = foot.offset.dot(&foot.slope) / curvature;
            if !(curvature > 0.0 && step.is_finite()) {
                break;
            }
            let next = (share - step).clamp(0.0, 1.0);
            let moved = (next - share).abs();
            share = next;
            if moved <= FOOT_PRECISION {
                break;
            }
        }
        share
    }
}

/// How fast the foot advances while the point moves with `velocity`.
fn advance<const N: usize>(foot: &Foot<N>, velocity: &Vector<N>) -> f64 {
    let curvature = foot.slope.norm_squared() + foot.offset.dot(&foot.bend);
    let rate = velocity.dot(&foot.slope) / curvature;
    if curvature > 0.0 && rate.is_finite() {
        rate
    } else {
        0.0
    }
}
