//! Visits the constraints of a node once per pass of an iteration.
//!
//! Source: Mehrotra's predictor-corrector method. Not here: the order of the passes, see
//! [`interior`](crate::solver::interior).

use crate::problem::Visit;
use crate::problem::b_spline::State;
use crate::problem::constraints::Rows;
use crate::solver::cone::{Centre, Reach, Sums};
use crate::solver::riccati::{Chain, Cost, Gradient};

/// Starts slacks and multipliers; notes how much more excess they need.
pub(super) struct Start<'a, const N: usize> {
    pub(super) state: &'a State<N>,
    pub(super) excess: f64,
    pub(super) needed: f64,
}

impl<const N: usize> Visit<N> for Start<'_, N> {
    #[inline(always)]
    fn rows<R: Rows<N>>(&mut self, rows: &mut R, bound: &R::Bound, chain: &Chain<N>) {
        let more = rows.reset(bound, &chain.point(self.state, 0.0), self.excess);
        self.needed = self.needed.max(more);
    }
}

/// Adds curvatures and slopes of the predicting step to the cost.
pub(super) struct Weigh<'a, const N: usize> {
    pub(super) state: &'a State<N>,
    pub(super) stretch: f64,
    pub(super) excess: f64,
    pub(super) sums: &'a mut Sums,
    pub(super) cost: &'a mut Cost<N>,
}

impl<const N: usize> Visit<N> for Weigh<'_, N> {
    #[inline(always)]
    fn rows<R: Rows<N>>(&mut self, rows: &mut R, bound: &R::Bound, chain: &Chain<N>) {
        let point = chain.point(self.state, self.stretch);
        let local = rows.weigh(bound, &point, self.excess, self.sums);
        self.cost.add(chain, &local);
    }
}

/// Takes the predicting step.
pub(super) struct Predict<'a, const N: usize> {
    pub(super) state: &'a State<N>,
    pub(super) stretch: f64,
    pub(super) excess: f64,
    pub(super) reach: &'a mut Reach,
}

impl<const N: usize> Visit<N> for Predict<'_, N> {
    #[inline(always)]
    fn rows<R: Rows<N>>(&mut self, rows: &mut R, bound: &R::Bound, chain: &Chain<N>) {
        let change = chain.point(self.state, self.stretch);
        rows.predict(bound, &change, self.excess, self.reach);
    }
}

/// Adds the slopes of the correcting step.
pub(super) struct Correct<'a, const N: usize> {
    pub(super) centre: Centre,
    pub(super) gradient: &'a mut Gradient<N>,
}

impl<const N: usize> Visit<N> for Correct<'_, N> {
    #[inline(always)]
    fn rows<R: Rows<N>>(&mut self, rows: &mut R, bound: &R::Bound, chain: &Chain<N>) {
        self.gradient.add(chain, &rows.correct(bound, self.centre));
    }
}

/// Takes the correcting step.
pub(super) struct Aim<'a, const N: usize> {
    pub(super) state: &'a State<N>,
    pub(super) stretch: f64,
    pub(super) excess: f64,
    pub(super) reach: &'a mut Reach,
}

impl<const N: usize> Visit<N> for Aim<'_, N> {
    #[inline(always)]
    fn rows<R: Rows<N>>(&mut self, rows: &mut R, bound: &R::Bound, chain: &Chain<N>) {
        let change = chain.point(self.state, self.stretch);
        rows.aim(bound, &change, self.excess, self.reach);
    }
}

/// Goes along it.
pub(super) struct Advance {
    pub(super) primal: f64,
    pub(super) dual: f64,
}

impl<const N: usize> Visit<N> for Advance {
    #[inline(always)]
    fn rows<R: Rows<N>>(&mut self, rows: &mut R, _: &R::Bound, _: &Chain<N>) {
        rows.advance(self.primal, self.dual);
    }
}
