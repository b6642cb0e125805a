//! Represents quadratic forms of later states and jerks.
//!
//! Source: substitution. Not here: which states those are, see [`interior`](crate::solver::interior).

#![allow(
    clippy::needless_range_loop,
    reason = "the indices of blocks run over several arrays at once"
)]

use crate::problem::b_spline::State;
use crate::solver::riccati::{Cost, Gradient, Local, Slope};
use crate::solver::small_blocks::{Square, times};
use toolglide_kinematics::Vector;

/// A linear map from state and stretch at one node to state, or jerk, at a later one; the same for
/// every axis but for what the stretch and the misses do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form<const N: usize> {
    pub(crate) state: [f64; 3],
    pub(crate) stretch: Vector<N>,
    pub(crate) offset: Vector<N>,
}

impl<const N: usize> Default for Form<N> {
    fn default() -> Self {
        Self {
            state: [0.0; 3],
            stretch: Vector::zeros(),
            offset: Vector::zeros(),
        }
    }
}

impl<const N: usize> Form<N> {
    pub(crate) fn value(&self, state: &State<N>, stretch: f64) -> Vector<N> {
        self.offset + self.linear(state, stretch)
    }

    /// The same without its offset.
    pub(crate) fn linear(&self, state: &State<N>, stretch: f64) -> Vector<N> {
        let mut value = self.stretch * stretch;
        for order in 0..3 {
            value += state[order] * self.state[order];
        }
        value
    }

    pub(crate) fn plus(&mut self, share: f64, other: &Self) {
        for order in 0..3 {
            self.state[order] += share * other.state[order];
        }
        self.stretch += other.stretch * share;
        self.offset += other.offset * share;
    }
}

impl<const N: usize> Cost<N> {
    /// Adds the quadratic `of` a later state that follows from the state here; gives what its
    /// offset adds to the slope there.
    pub(crate) fn add_state(&mut self, of: &Self, forms: &[Form<N>; 3]) -> Gradient<N> {
        let push = of.push(&forms.each_ref().map(|form| form.offset));
        let by_stretch = forms.each_ref().map(|form| form.stretch);
        let moved = of.times(&by_stretch);
        for order in 0..3 {
            for other in order..3 {
                let mut block = Square::zeros();
                for one in 0..3 {
                    for two in 0..3 {
                        let share = forms[one].state[order] * forms[two].state[other];
                        if two < one {
                            block += of.blocks[two][one].transpose() * share;
                        } else {
                            block += of.blocks[one][two] * share;
                        }
                    }
                }
                self.blocks[order][other] += block;
            }
            for one in 0..3 {
                let share = forms[one].state[order];
                self.by_stretch[order] += (of.by_stretch[one] + moved[one]) * share;
                self.by_excess[order] += of.by_excess[one] * share;
            }
            self.stretch += (of.by_stretch[order] * 2.0 + moved[order]).dot(&by_stretch[order]);
            self.mixed += of.by_excess[order].dot(&by_stretch[order]);
        }
        self.stretch += of.stretch;
        self.mixed += of.mixed;
        self.excess += of.excess;
        let mut slope = of.slope;
        slope.plus(&push);
        self.slope.add_state(&slope, forms);
        push
    }

    /// Adds the quadratic `of` a later jerk that follows from the state here; gives what its offset
    /// adds to the slope there.
    pub(crate) fn add_jerk(&mut self, of: &Local<N>, form: &Form<N>) -> Slope<N> {
        let push = Slope {
            point: times(&of.point, &form.offset),
            excess: of.mixed.dot(&form.offset),
        };
        let moved = times(&of.point, &form.stretch);
        for order in 0..3 {
            for other in order..3 {
                self.blocks[order][other] += of.point * (form.state[order] * form.state[other]);
            }
            self.by_stretch[order] += moved * form.state[order];
            self.by_excess[order] += of.mixed * form.state[order];
        }
        self.stretch += form.stretch.dot(&moved);
        self.mixed += of.mixed.dot(&form.stretch);
        self.excess += of.excess;
        self.slope.add_jerk(
            &Slope {
                point: of.slope.point + push.point,
                excess: of.slope.excess + push.excess,
            },
            form,
        );
        push
    }
}

impl<const N: usize> Gradient<N> {
    pub(crate) fn add_state(&mut self, of: &Self, forms: &[Form<N>; 3]) {
        for one in 0..3 {
            for order in 0..3 {
                self.state[order] += of.state[one] * forms[one].state[order];
            }
            self.stretch += of.state[one].dot(&forms[one].stretch);
        }
        self.stretch += of.stretch;
        self.excess += of.excess;
    }

    pub(crate) fn add_jerk(&mut self, of: &Slope<N>, form: &Form<N>) {
        for order in 0..3 {
            self.state[order] += of.point * form.state[order];
        }
        self.stretch += of.point.dot(&form.stretch);
        self.excess += of.excess;
    }
}
