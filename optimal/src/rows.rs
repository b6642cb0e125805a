//! What a point of the motion must keep: a box, a disc, a tube.
//!
//! Source: the Bezier points of position and velocity of an interval of constant jerk; what they keep,
//! the interval keeps at every instant, because it lies in their hull and tube, ball and box are
//! convex. Acceleration and jerk are largest at nodes. Every bound may be exceeded by the same share
//! `excess`, which the solver makes as small as it can. Not here: which point keeps what, see
//! [`interior`](crate::interior).

use crate::cone::{Centre, Cone, ConeWeight, Pair, Reach, Side, Sums};
use crate::front::{Local, Slope};
use toolglide_kinematics::{Vector, nalgebra::SMatrix};

/// Rows of one point, through one iteration of the interior-point method.
///
/// The point and the excess are what they depend on; `change` are changes of both.
pub(crate) trait Rows<const N: usize> {
    /// What is kept.
    type Bound;

    /// Starts inside; gives how much more excess the point needs.
    fn reset(&mut self, bound: &Self::Bound, point: &Vector<N>, excess: f64) -> f64;

    /// Takes the point; gives curvature and slope of the predicting step.
    fn weigh(
        &mut self,
        bound: &Self::Bound,
        point: &Vector<N>,
        excess: f64,
        sums: &mut Sums,
    ) -> Local<N>;

    /// Takes the predicting step.
    fn predict(&mut self, bound: &Self::Bound, change: &Vector<N>, excess: f64, reach: &mut Reach);

    /// Slope of the correcting step towards a centre.
    fn correct(&mut self, bound: &Self::Bound, centre: Centre) -> Slope<N>;

    /// Takes the correcting step.
    fn aim(&mut self, bound: &Self::Bound, change: &Vector<N>, excess: f64, reach: &mut Reach);

    /// Goes along it.
    fn advance(&mut self, primal: f64, dual: f64);

    /// What is kept, for another solver.
    #[cfg(test)]
    fn kept(bound: &Self::Bound) -> Kept<N>;
}

/// What a point keeps.
#[cfg(test)]
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kept<const N: usize> {
    Box(Bounds<N>),
    Disc(Disc<N>),
    Tube(Tube<N>),
}

/// Every coordinate within a bound of either sign.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InBox<const N: usize> {
    upper: [Side; N],
    lower: [Side; N],
}

/// Reciprocals of the bounds.
pub(crate) type Bounds<const N: usize> = Vector<N>;

impl<const N: usize> Default for InBox<N> {
    fn default() -> Self {
        Self {
            upper: [Side::default(); N],
            lower: [Side::default(); N],
        }
    }
}

impl<const N: usize> Rows<N> for InBox<N> {
    type Bound = Bounds<N>;

    #[cfg(test)]
    fn kept(bound: &Bounds<N>) -> Kept<N> {
        Kept::Box(*bound)
    }

    fn reset(&mut self, bound: &Bounds<N>, point: &Vector<N>, excess: f64) -> f64 {
        let mut needed = 0.0_f64;
        for axis in 0..N {
            let share = point[axis] * bound[axis];
            needed = needed
                .max(self.upper[axis].reset(1.0 + excess - share))
                .max(self.lower[axis].reset(1.0 + excess + share));
        }
        needed
    }

    #[inline(always)]
    fn weigh(
        &mut self,
        bound: &Bounds<N>,
        point: &Vector<N>,
        excess: f64,
        sums: &mut Sums,
    ) -> Local<N> {
        let mut local = Local::default();
        for axis in 0..N {
            let share = point[axis] * bound[axis];
            let upper = self.upper[axis].weigh(1.0 + excess - share, sums);
            let lower = self.lower[axis].weigh(1.0 + excess + share, sums);
            local.point[(axis, axis)] = (upper.0 + lower.0) * bound[axis] * bound[axis];
            local.mixed[axis] = (lower.0 - upper.0) * bound[axis];
            local.excess += upper.0 + lower.0;
            local.slope.point[axis] = (lower.1 - upper.1) * bound[axis];
            local.slope.excess += upper.1 + lower.1;
        }
        local
    }

    #[inline(always)]
    fn predict(&mut self, bound: &Bounds<N>, change: &Vector<N>, excess: f64, reach: &mut Reach) {
        for axis in 0..N {
            let share = change[axis] * bound[axis];
            self.upper[axis].predict(excess - share, reach);
            self.lower[axis].predict(excess + share, reach);
        }
    }

    #[inline(always)]
    fn correct(&mut self, bound: &Bounds<N>, centre: Centre) -> Slope<N> {
        let mut slope = Slope::default();
        for axis in 0..N {
            let upper = self.upper[axis].correct(centre);
            let lower = self.lower[axis].correct(centre);
            slope.point[axis] = (lower - upper) * bound[axis];
            slope.excess += upper + lower;
        }
        slope
    }

    #[inline(always)]
    fn aim(&mut self, bound: &Bounds<N>, change: &Vector<N>, excess: f64, reach: &mut Reach) {
        for axis in 0..N {
            let share = change[axis] * bound[axis];
            self.upper[axis].aim(excess - share, reach);
            self.lower[axis].aim(excess + share, reach);
        }
    }

    #[inline(always)]
    fn advance(&mut self, primal: f64, dual: f64) {
        for axis in 0..N {
            self.upper[axis].advance(primal, dual);
            self.lower[axis].advance(primal, dual);
        }
    }
}

/// Within a distance of a center.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InDisc<const N: usize> {
    cone: Cone<N>,
}

/// A disc (a ball with three axes).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc<const N: usize> {
    pub(crate) center: Vector<N>,
    /// Reciprocal of the radius.
    pub(crate) by_radius: f64,
    /// Share of the radius that is free; 1, or more where a fixed point needs it.
    pub(crate) room: f64,
}

impl<const N: usize> Disc<N> {
    #[inline(always)]
    fn value(&self, point: &Vector<N>, excess: f64) -> Pair<N> {
        Pair {
            head: self.room + excess,
            tail: (point - self.center) * self.by_radius,
        }
    }

    #[inline(always)]
    fn change(&self, change: &Vector<N>, excess: f64) -> Pair<N> {
        Pair {
            head: excess,
            tail: change * self.by_radius,
        }
    }
}

impl<const N: usize> Default for InDisc<N> {
    fn default() -> Self {
        Self {
            cone: Cone::default(),
        }
    }
}

impl<const N: usize> Rows<N> for InDisc<N> {
    type Bound = Disc<N>;

    #[cfg(test)]
    fn kept(bound: &Disc<N>) -> Kept<N> {
        Kept::Disc(*bound)
    }

    fn reset(&mut self, bound: &Disc<N>, point: &Vector<N>, excess: f64) -> f64 {
        self.cone.reset(&bound.value(point, excess))
    }

    #[inline(always)]
    fn weigh(
        &mut self,
        bound: &Disc<N>,
        point: &Vector<N>,
        excess: f64,
        sums: &mut Sums,
    ) -> Local<N> {
        let (weight, residual) = self.cone.weigh(&bound.value(point, excess), sums);
        Local {
            point: weight.tail * (bound.by_radius * bound.by_radius),
            mixed: weight.mixed * bound.by_radius,
            excess: weight.head,
            slope: Slope {
                point: residual.tail * bound.by_radius,
                excess: residual.head,
            },
        }
    }

    #[inline(always)]
    fn predict(&mut self, bound: &Disc<N>, change: &Vector<N>, excess: f64, reach: &mut Reach) {
        self.cone.predict(&bound.change(change, excess), reach);
    }

    #[inline(always)]
    fn correct(&mut self, bound: &Disc<N>, centre: Centre) -> Slope<N> {
        let residual = self.cone.correct(centre);
        Slope {
            point: residual.tail * bound.by_radius,
            excess: residual.head,
        }
    }

    #[inline(always)]
    fn aim(&mut self, bound: &Disc<N>, change: &Vector<N>, excess: f64, reach: &mut Reach) {
        self.cone.aim(&bound.change(change, excess), reach);
    }

    #[inline(always)]
    fn advance(&mut self, primal: f64, dual: f64) {
        self.cone.advance(primal, dual);
    }
}

/// Within a distance of a straight segment.
///
/// In a capsule the nearest point of the segment is free to move (`progress`, in shares of its
/// length); in a cylinder it is the projection, which must lie on the segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InTube<const N: usize> {
    cone: Cone<N>,
    low: Side,
    high: Side,
    progress: f64,
    progress_change: f64,
    /// How the progress of a capsule follows point and excess: curvature, its reciprocal, slope.
    by_point: Vector<N>,
    by_excess: f64,
    by_curvature: f64,
    slope: f64,
}

/// A tube around a segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tube<const N: usize> {
    pub(crate) start: Vector<N>,
    pub(crate) direction: Vector<N>,
    pub(crate) length: f64,
    /// Reciprocal of the tolerance.
    pub(crate) by_radius: f64,
    /// As of [`Disc`].
    pub(crate) room: f64,
    /// Whether its ends are round.
    pub(crate) capsule: bool,
}

impl<const N: usize> Tube<N> {
    #[inline(always)]
    fn across(&self, of: &Vector<N>) -> Vector<N> {
        if self.capsule {
            of * self.by_radius
        } else {
            (of - self.direction * self.direction.dot(of)) * self.by_radius
        }
    }

    #[inline(always)]
    fn scaled_length(&self) -> f64 {
        self.length * self.by_radius
    }

    #[inline(always)]
    fn value(&self, point: &Vector<N>, excess: f64, progress: f64) -> Pair<N> {
        let tail = self.across(&(point - self.start));
        Pair {
            head: self.room + excess,
            tail: if self.capsule {
                tail - self.direction * (progress * self.scaled_length())
            } else {
                tail
            },
        }
    }

    #[inline(always)]
    fn change(&self, change: &Vector<N>, excess: f64, progress: f64) -> Pair<N> {
        let tail = self.across(change);
        Pair {
            head: excess,
            tail: if self.capsule {
                tail - self.direction * (progress * self.scaled_length())
            } else {
                tail
            },
        }
    }

    #[inline(always)]
    fn along(&self, of: &Vector<N>) -> f64 {
        self.direction.dot(of) / self.length
    }
}

impl<const N: usize> Default for InTube<N> {
    fn default() -> Self {
        Self {
            cone: Cone::default(),
            low: Side::default(),
            high: Side::default(),
            progress: 0.5,
            progress_change: 0.0,
            by_point: Vector::zeros(),
            by_excess: 0.0,
            by_curvature: 0.0,
            slope: 0.0,
        }
    }
}

impl<const N: usize> InTube<N> {
    /// Slope of point and excess from those of the rows, with the progress of a capsule eliminated.
    #[inline(always)]
    fn gather(&mut self, bound: &Tube<N>, cone: &Pair<N>, low: f64, high: f64) -> Slope<N> {
        let mut slope = Slope {
            point: bound.across(&cone.tail),
            excess: cone.head,
        };
        if bound.capsule {
            self.slope = low - high - bound.scaled_length() * bound.direction.dot(&cone.tail);
            let share = self.slope * self.by_curvature;
            slope.point -= self.by_point * share;
            slope.excess -= self.by_excess * share;
        } else {
            slope.point += bound.direction * ((low - high) / bound.length);
            slope.excess += low + high;
        }
        slope
    }

    /// Change of the progress of a capsule that goes with the changes of point and excess.
    #[inline(always)]
    fn follow(&mut self, change: &Vector<N>, excess: f64) {
        self.progress_change =
            -(self.slope + self.by_point.dot(change) + self.by_excess * excess) * self.by_curvature;
    }

    #[inline(always)]
    fn ends(&self, bound: &Tube<N>, point: &Vector<N>, excess: f64) -> (f64, f64) {
        if bound.capsule {
            (self.progress, 1.0 - self.progress)
        } else {
            let progress = bound.along(&(point - bound.start));
            (progress + excess, 1.0 - progress + excess)
        }
    }

    #[inline(always)]
    fn changes(&self, bound: &Tube<N>, change: &Vector<N>, excess: f64) -> (f64, f64) {
        if bound.capsule {
            (self.progress_change, -self.progress_change)
        } else {
            let progress = bound.along(change);
            (progress + excess, excess - progress)
        }
    }
}

impl<const N: usize> Rows<N> for InTube<N> {
    type Bound = Tube<N>;

    #[cfg(test)]
    fn kept(bound: &Tube<N>) -> Kept<N> {
        Kept::Tube(*bound)
    }

    fn reset(&mut self, bound: &Tube<N>, point: &Vector<N>, excess: f64) -> f64 {
        self.progress = bound.along(&(point - bound.start)).clamp(0.0, 1.0);
        let (low, high) = self.ends(bound, point, excess);
        let beyond = self.low.reset(low).max(self.high.reset(high));
        let outside = self.cone.reset(&bound.value(point, excess, self.progress));
        // The excess is of no use to the progress of a capsule.
        outside.max(if bound.capsule { 0.0 } else { beyond })
    }

    #[inline(always)]
    fn weigh(
        &mut self,
        bound: &Tube<N>,
        point: &Vector<N>,
        excess: f64,
        sums: &mut Sums,
    ) -> Local<N> {
        let value = bound.value(point, excess, self.progress);
        let (weight, residual) = self.cone.weigh(&value, sums);
        let ends = self.ends(bound, point, excess);
        let low = self.low.weigh(ends.0, sums);
        let high = self.high.weigh(ends.1, sums);
        let ConeWeight { head, mixed, tail } = weight;
        let mut local = Local::default();
        if bound.capsule {
            let by_radius = bound.by_radius;
            let across = tail * bound.direction;
            let length = bound.scaled_length();
            self.by_point = across * (-length * by_radius);
            self.by_excess = -length * mixed.dot(&bound.direction);
            self.by_curvature =
                1.0 / (length * length * across.dot(&bound.direction) + low.0 + high.0);
            local.point = tail * (by_radius * by_radius)
                - self.by_point * (self.by_point * self.by_curvature).transpose();
            local.mixed = mixed * by_radius - self.by_point * (self.by_excess * self.by_curvature);
            local.excess = head - self.by_excess * self.by_excess * self.by_curvature;
        } else {
            let by_length = 1.0 / bound.length;
            let across =
                SMatrix::<f64, N, N>::identity() - bound.direction * bound.direction.transpose();
            let along = bound.direction * by_length;
            local.point = across * tail * across * (bound.by_radius * bound.by_radius)
                + along * (along * (low.0 + high.0)).transpose();
            local.mixed = bound.across(&mixed) + along * (low.0 - high.0);
            local.excess = head + low.0 + high.0;
        }
        local.slope = self.gather(bound, &residual, low.1, high.1);
        local
    }

    #[inline(always)]
    fn predict(&mut self, bound: &Tube<N>, change: &Vector<N>, excess: f64, reach: &mut Reach) {
        self.follow(change, excess);
        let ends = self.changes(bound, change, excess);
        self.low.predict(ends.0, reach);
        self.high.predict(ends.1, reach);
        self.cone
            .predict(&bound.change(change, excess, self.progress_change), reach);
    }

    #[inline(always)]
    fn correct(&mut self, bound: &Tube<N>, centre: Centre) -> Slope<N> {
        let low = self.low.correct(centre);
        let high = self.high.correct(centre);
        let cone = self.cone.correct(centre);
        self.gather(bound, &cone, low, high)
    }

    #[inline(always)]
    fn aim(&mut self, bound: &Tube<N>, change: &Vector<N>, excess: f64, reach: &mut Reach) {
        self.follow(change, excess);
        let ends = self.changes(bound, change, excess);
        self.low.aim(ends.0, reach);
        self.high.aim(ends.1, reach);
        self.cone
            .aim(&bound.change(change, excess, self.progress_change), reach);
    }

    #[inline(always)]
    fn advance(&mut self, primal: f64, dual: f64) {
        self.progress += primal * self.progress_change;
        self.low.advance(primal, dual);
        self.high.advance(primal, dual);
        self.cone.advance(primal, dual);
    }
}
