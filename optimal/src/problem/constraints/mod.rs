//! Defines the constraints on a point of the motion: box, disc, tube.
//!
//! Source: the Bezier points of position and velocity of an interval of constant jerk; what they keep,
//! the interval keeps at every instant, because it lies in their hull and tube, ball and box are
//! convex. Acceleration and jerk are largest at nodes. Every bound may be exceeded by the same share
//! `excess`, which the solver makes as small as it can. Not here: which point keeps what, see
//! [`interior`](crate::solver::interior).

mod tube;

use crate::solver::cone::{Centre, Cone, Pair, Reach, Side, Sums};
use crate::solver::riccati::{Local, Slope};
use toolglide_kinematics::Vector;
pub(crate) use tube::{InTube, Tube};

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
    fn kept(bound: &Self::Bound) -> Constraint<N>;
}

/// What a point keeps.
#[cfg(test)]
#[derive(Clone, Copy, Debug)]
pub(crate) enum Constraint<const N: usize> {
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
    fn kept(bound: &Bounds<N>) -> Constraint<N> {
        Constraint::Box(*bound)
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
    fn kept(bound: &Disc<N>) -> Constraint<N> {
        Constraint::Disc(*bound)
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
