//! Sweeps the quadratic cost to go from the last node of a window to the first.
//!
//! The front holds the cost of everything behind a node as a quadratic of the three coefficients
//! there, of the stretch of the segment's duration and of the excess over the bounds. One interval
//! back, a coefficient is eliminated; one segment back, a stretch. So a Newton system of any length
//! is solved in one sweep of constant size.
//!
//! Source: block elimination in the order of the nodes, as in the backward recursion of
//! linear-quadratic control. Not here: where the quadratics come from, see [`rows`](crate::problem::constraints).

#![allow(
    clippy::needless_range_loop,
    reason = "the indices of blocks run over several arrays at once"
)]

mod cholesky;
mod cost_to_go;
mod quadratic_form;

use crate::problem::b_spline::State;
use crate::solver::small_blocks::{Square, times, transposed_times};
use cholesky::Root;
pub(crate) use cost_to_go::Cost;
pub(crate) use quadratic_form::Form;
use toolglide_kinematics::Vector;

/// Share of a curvature that is kept whatever is eliminated: what rounding may have taken from it,
/// without which a sum of squares could turn negative.
const ROUNDING: f64 = 1e-14;

/// Slope of a quadratic of a point and the excess.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slope<const N: usize> {
    pub(crate) point: Vector<N>,
    pub(crate) excess: f64,
}

impl<const N: usize> Default for Slope<N> {
    fn default() -> Self {
        Self {
            point: Vector::zeros(),
            excess: 0.0,
        }
    }
}

/// Quadratic of a point and the excess.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local<const N: usize> {
    pub(crate) point: Square<N>,
    pub(crate) mixed: Vector<N>,
    pub(crate) excess: f64,
    pub(crate) slope: Slope<N>,
}

impl<const N: usize> Default for Local<N> {
    fn default() -> Self {
        Self {
            point: Square::zeros(),
            mixed: Vector::zeros(),
            excess: 0.0,
            slope: Slope::default(),
        }
    }
}

/// How a point follows from a node: a derivative of the position, and `ahead` (s) times the next
/// one, which stretches with the duration as at the `base`; or `weights` of the coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chain<const N: usize> {
    /// 0 for positions, 1 for velocities, 2 for accelerations; 2 never looks ahead.
    pub(crate) order: usize,
    pub(crate) ahead: f64,
    pub(crate) base: Vector<N>,
    pub(crate) weights: [f64; 3],
}

impl<const N: usize> Chain<N> {
    #[inline(always)]
    pub(crate) fn point(&self, state: &State<N>, stretch: f64) -> Vector<N> {
        if self.order == 2 {
            state[2]
        } else {
            state[self.order] + (state[self.order + 1] + self.base * stretch) * self.ahead
        }
    }
}

/// One interval of constant jerk: weights of its four coefficients in the jerk, and how the
/// coefficients at its end change with the stretch of its duration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interval<const N: usize> {
    pub(crate) jerk: [f64; 4],
    pub(crate) by_stretch: [Vector<N>; 3],
}

/// Slope of a quadratic of coefficients, stretch and excess.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gradient<const N: usize> {
    pub(crate) state: State<N>,
    pub(crate) stretch: f64,
    pub(crate) excess: f64,
}

impl<const N: usize> Default for Gradient<N> {
    fn default() -> Self {
        Self {
            state: [Vector::zeros(); 3],
            stretch: 0.0,
            excess: 0.0,
        }
    }
}

impl<const N: usize> Gradient<N> {
    #[inline(always)]
    pub(crate) fn add(&mut self, chain: &Chain<N>, slope: &Slope<N>) {
        for (state, weight) in self.state.iter_mut().zip(chain.weights) {
            if weight.abs() > 0.0 {
                *state += slope.point * weight;
            }
        }
        self.stretch += chain.base.dot(&slope.point) * chain.ahead;
        self.excess += slope.excess;
    }

    #[inline(always)]
    pub(crate) fn plus(&mut self, other: &Self) {
        for order in 0..3 {
            self.state[order] += other.state[order];
        }
        self.stretch += other.stretch;
        self.excess += other.excess;
    }

    /// One interval back, with the gain that [`Cost::back`] found.
    #[inline(always)]
    pub(crate) fn back(&mut self, interval: &Interval<N>, jerk: &Slope<N>, gain: &mut Gain<N>) {
        self.plus(&gain.push);
        gain.offset = self.eliminate(interval, jerk, gain);
    }

    /// The same where nothing is missed; gives the offset of what is eliminated.
    #[inline(always)]
    pub(crate) fn eliminate(
        &mut self,
        interval: &Interval<N>,
        jerk: &Slope<N>,
        gain: &Gain<N>,
    ) -> Vector<N> {
        for (state, by_stretch) in self.state.iter().zip(&interval.by_stretch) {
            self.stretch += state.dot(by_stretch);
        }
        let weights = interval.jerk;
        let last = self.state[2] + jerk.point * weights[3];
        let offset = gain.root.share(last);
        self.state = [
            jerk.point * weights[0] - transposed_times(&gain.state[0], &offset),
            self.state[0] + jerk.point * weights[1] - transposed_times(&gain.state[1], &offset),
            self.state[1] + jerk.point * weights[2] - transposed_times(&gain.state[2], &offset),
        ];
        self.stretch -= gain.stretch.dot(&offset);
        self.excess += jerk.excess - gain.excess.dot(&offset);
        offset
    }
}

/// The last coefficient of one interval as what follows from those before it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gain<const N: usize> {
    state: [Square<N>; 3],
    stretch: Vector<N>,
    excess: Vector<N>,
    root: Root<N>,
    offset: Vector<N>,
    /// What the miss of the interval adds to the slope.
    push: Gradient<N>,
}

impl<const N: usize> Default for Gain<N> {
    fn default() -> Self {
        Self {
            state: [Square::zeros(); 3],
            stretch: Vector::zeros(),
            excess: Vector::zeros(),
            root: Root::default(),
            offset: Vector::zeros(),
            push: Gradient::default(),
        }
    }
}

impl<const N: usize> Gain<N> {
    /// Changes of the jerk, and of the coefficients at the end of the interval.
    #[inline(always)]
    pub(crate) fn forward(
        &self,
        interval: &Interval<N>,
        state: &[Vector<N>; 3],
        stretch: f64,
        excess: f64,
        miss: &[Vector<N>; 3],
    ) -> (Vector<N>, [Vector<N>; 3]) {
        let (jerk, mut end) = self.answer(interval, state, stretch, excess, &self.offset);
        for (end, miss) in end.iter_mut().zip(miss) {
            *end += miss;
        }
        (jerk, end)
    }

    /// The same with another offset, where nothing is missed.
    #[inline(always)]
    pub(crate) fn answer(
        &self,
        interval: &Interval<N>,
        state: &[Vector<N>; 3],
        stretch: f64,
        excess: f64,
        offset: &Vector<N>,
    ) -> (Vector<N>, [Vector<N>; 3]) {
        let mut last = offset + self.stretch * stretch + self.excess * excess;
        for (gain, state) in self.state.iter().zip(state) {
            last += times(gain, state);
        }
        let last = -self.root.back(last);
        let weights = interval.jerk;
        let jerk = state[0] * weights[0]
            + state[1] * weights[1]
            + state[2] * weights[2]
            + last * weights[3];
        let mut end = [state[1], state[2], last];
        for index in 0..3 {
            end[index] += interval.by_stretch[index] * stretch;
        }
        (jerk, end)
    }
}

/// The stretch of one segment as what follows from the state at its start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StretchGain<const N: usize> {
    state: State<N>,
    excess: f64,
    by_curvature: f64,
    slope: f64,
}

impl<const N: usize> Default for StretchGain<N> {
    fn default() -> Self {
        Self {
            state: [Vector::zeros(); 3],
            excess: 0.0,
            by_curvature: 0.0,
            slope: 0.0,
        }
    }
}

impl<const N: usize> StretchGain<N> {
    pub(crate) fn back(&mut self, gradient: &mut Gradient<N>) {
        self.slope = gradient.stretch;
        self.eliminate(gradient);
    }

    /// The same with the slope that the gradient has, which is not kept.
    #[inline(always)]
    pub(crate) fn eliminate(&self, gradient: &mut Gradient<N>) {
        let share = gradient.stretch * self.by_curvature;
        for order in 0..3 {
            gradient.state[order] -= self.state[order] * share;
        }
        gradient.excess -= self.excess * share;
        gradient.stretch = 0.0;
    }

    pub(crate) fn forward(&self, state: &State<N>, excess: f64) -> f64 {
        self.answer(self.slope, state, excess)
    }

    /// The same with another slope.
    #[inline(always)]
    pub(crate) fn answer(&self, slope: f64, state: &State<N>, excess: f64) -> f64 {
        let mut slope = slope + self.excess * excess;
        for order in 0..3 {
            slope += self.state[order].dot(&state[order]);
        }
        -slope * self.by_curvature
    }
}
