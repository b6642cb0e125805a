//! Measures the distance from an arc, which may climb and whose radius may change.
//!
//! Source: the foot of the perpendicular by Newton's method from the angle of the point. Not here:
//! the distance of a whole curve.

use std::f64::consts::TAU;

use toolglide_kinematics::Arc;
use toolglide_kinematics::Vector;

/// Newton steps towards the foot of a perpendicular: the start is the angle of the point itself.
const FOOT_STEPS: u32 = 6;

/// A step of the foot below this share of the turn ends the search: rounding, dimensionless.
const FOOT_PRECISION: f64 = 1e-15;

/// A point nearer than this share of the radius has its foot where the search starts, dimensionless.
const CLOSE: f64 = 0.1;

/// How many turns are surveyed for a point which is not close, and with how many points.
const SURVEYED_TURNS: f64 = 4.0;
const SURVEY_POINTS: u32 = 96;

/// How often the neighbourhood of a local minimum loses a third; Newton's method does the rest.
const NARROWING_STEPS: u32 = 30;

/// Largest part of a turn between two waypoints, of a whole turn.
const WAYPOINT_SPACING: f64 = TAU / 3.0;

/// An arc, prepared for many questions.
#[derive(Clone, Debug)]
pub(crate) struct Helix<const N: usize> {
    pub(crate) arc: Arc<N>,
    center: Vector<N>,
    radial: Vector<N>,
    lateral: Vector<N>,
    lift: Vector<N>,
    radius: f64,
    growth: f64,
    sweep: f64,
    /// Bounds of the second, third and fourth derivative by the share of the sweep.
    pub(crate) bends: [f64; 3],
}

/// The arc at one share of its sweep: position relative to a point, first and second derivative.
pub(crate) struct Foot<const N: usize> {
    pub(crate) offset: Vector<N>,
    pub(crate) slope: Vector<N>,
    pub(crate) bend: Vector<N>,
}

/// A point in the frame of the arc.
pub(crate) struct Local<const N: usize> {
    x: f64,
    y: f64,
    height: Vector<N>,
}

impl<const N: usize> Helix<N> {
    pub(crate) fn new(arc: &Arc<N>) -> Self {
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

    pub(crate) fn radius(&self) -> f64 {
        self.radius.max(self.radius + self.growth)
    }

    pub(crate) fn point(&self, share: f64) -> Vector<N> {
        self.arc.point(share)
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a sweep is at most a few 2^32 turns and positive here; the cast saturates"
    )]
    pub(crate) fn waypoints(&self) -> u64 {
        (self.sweep.abs() / WAYPOINT_SPACING).floor() as u64
    }

    /// Share of the sweep and distance of the nearest point.
    pub(crate) fn nearest(&self, point: &Vector<N>) -> (f64, f64) {
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

    pub(crate) fn local(&self, point: &Vector<N>) -> Local<N> {
        let offset = point - self.center;
        let (x, y) = (offset.dot(&self.radial), offset.dot(&self.lateral));
        Local {
            x,
            y,
            height: offset - self.radial * x - self.lateral * y,
        }
    }

    pub(crate) fn at(&self, share: f64, local: &Local<N>) -> Foot<N> {
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

    /// The nearest point on the turns about a share of the sweep, for a point that is not close:
    /// every local minimum among many points is narrowed down, because near the evolute there are
    /// several and Newton's method fails.
    fn survey(&self, about: f64, local: &Local<N>) -> f64 {
        let reach = (SURVEYED_TURNS * TAU / self.sweep.abs()).min(1.0);
        let from = (about - 0.5 * reach).clamp(0.0, 1.0 - reach);
        let share = |k: u32| from + reach * f64::from(k) / f64::from(SURVEY_POINTS);
        let mut best = (from, f64::INFINITY);
        let (mut before, mut here) = (f64::INFINITY, self.away(share(0), local));
        for k in 0..=SURVEY_POINTS {
            let after = if k < SURVEY_POINTS {
                self.away(share(k + 1), local)
            } else {
                f64::INFINITY
            };
            if here <= before && here <= after {
                let between = (share(k.saturating_sub(1)), share(k + 1).min(1.0));
                let narrowed = self.narrow(between, local);
                let distance = self.away(narrowed, local);
                if distance < best.1 {
                    best = (narrowed, distance);
                }
            }
            (before, here) = (here, after);
        }
        best.0
    }

    /// The lowest point of a valley.
    fn narrow(&self, (mut low, mut high): (f64, f64), local: &Local<N>) -> f64 {
        for _ in 0..NARROWING_STEPS {
            let third = (high - low) / 3.0;
            if self.away(low + third, local) < self.away(high - third, local) {
                high -= third;
            } else {
                low += third;
            }
        }
        0.5 * (low + high)
    }

    /// Foot of the perpendicular that Newton's method reaches from a guess.
    pub(crate) fn foot(&self, guess: f64, local: &Local<N>) -> f64 {
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
