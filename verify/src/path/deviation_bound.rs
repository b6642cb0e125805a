//! Bounds the distance of a whole curve from an arc.
//!
//! Source: the remainder of linear interpolation, `max|f''|/8`, applied twice to the way from a
//! point that moves along the arc beside the curve. Not here: lines, whose distance is convex.

use crate::path::bernstein::Cubic;
use crate::path::helix::{Foot, Helix};
use toolglide_kinematics::Vector;

impl<const N: usize> Helix<N> {
    /// Bernstein coefficients of a cubic that is nowhere below the distance of the curve.
    ///
    /// The better of two: the distance from the point nearest to the middle, which is convex and
    /// all there is beyond the ends of the arc; and that from a point which moves along.
    pub(crate) fn majorant(&self, curve: &Cubic<N>) -> [f64; 4] {
        let middle = curve.at(0.5);
        let (share, _) = self.nearest(&middle);
        let still = self.arc.point(share);
        let still = curve.points.map(|point| (point - still).norm());
        let moving = self.moving_majorant(curve, &middle, share);
        let most = |values: &[f64; 4]| values.iter().copied().fold(0.0, f64::max);
        if most(&moving) < most(&still) {
            moving
        } else {
            still
        }
    }

    fn moving_majorant(&self, curve: &Cubic<N>, middle: &Vector<N>, share: f64) -> [f64; 4] {
        let foot = self.at(share, &self.local(middle));
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
