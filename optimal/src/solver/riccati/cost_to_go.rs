//! Eliminates a coefficient and a duration from the cost to go of a node.
//!
//! Source: as [`front`](super). Not here: going forward again.

#![allow(
    clippy::needless_range_loop,
    reason = "the indices of blocks run over several arrays at once"
)]

use crate::problem::b_spline::State;
use crate::solver::riccati::{Chain, Gain, Gradient, Interval, Local, ROUNDING, Root, StretchGain};
use crate::solver::small_blocks::{Square, outer, times, transposed_product, transposed_times};
use toolglide_kinematics::Vector;

/// Quadratic of state, stretch and excess: what everything behind a node costs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cost<const N: usize> {
    /// Upper triangle of blocks.
    pub(super) blocks: [[Square<N>; 3]; 3],
    pub(super) by_stretch: State<N>,
    pub(super) by_excess: State<N>,
    pub(super) stretch: f64,
    pub(super) mixed: f64,
    pub(crate) excess: f64,
    pub(crate) slope: Gradient<N>,
}

impl<const N: usize> Default for Cost<N> {
    fn default() -> Self {
        Self {
            blocks: [[Square::zeros(); 3]; 3],
            by_stretch: [Vector::zeros(); 3],
            by_excess: [Vector::zeros(); 3],
            stretch: 0.0,
            mixed: 0.0,
            excess: 0.0,
            slope: Gradient::default(),
        }
    }
}

impl<const N: usize> Cost<N> {
    /// Adds the quadratic of a point.
    #[inline(always)]
    pub(crate) fn add(&mut self, chain: &Chain<N>, local: &Local<N>) {
        let by_stretch = chain.base * chain.ahead;
        let pull = times(&local.point, &by_stretch);
        for one in 0..3 {
            let weight = chain.weights[one];
            if weight.abs() > 0.0 {
                let row = local.point * weight;
                for two in one..3 {
                    if chain.weights[two].abs() > 0.0 {
                        self.blocks[one][two] += row * chain.weights[two];
                    }
                }
                self.by_stretch[one] += pull * weight;
                self.by_excess[one] += local.mixed * weight;
            }
        }
        self.stretch += by_stretch.dot(&pull);
        self.mixed += by_stretch.dot(&local.mixed);
        self.excess += local.excess;
        self.slope.add(chain, &local.slope);
    }

    /// What a miss adds to the slope.
    #[inline(always)]
    pub(super) fn push(&self, miss: &State<N>) -> Gradient<N> {
        let mut push = Gradient {
            state: self.times(miss),
            ..Gradient::default()
        };
        for order in 0..3 {
            push.stretch += self.by_stretch[order].dot(&miss[order]);
            push.excess += self.by_excess[order].dot(&miss[order]);
        }
        push
    }

    #[inline(always)]
    pub(super) fn times(&self, state: &State<N>) -> State<N> {
        let [[pp, pv, pa], [_, vv, va], [_, _, aa]] = &self.blocks;
        [
            times(pp, &state[0]) + times(pv, &state[1]) + times(pa, &state[2]),
            transposed_times(pv, &state[0]) + times(vv, &state[1]) + times(va, &state[2]),
            transposed_times(pa, &state[0])
                + transposed_times(va, &state[1])
                + times(aa, &state[2]),
        ]
    }

    /// One interval back: `miss` is by how much the state at its end falls short, `jerk` the
    /// quadratic of its jerk, which is eliminated. `None` where the jerk is not bounded.
    #[inline(always)]
    pub(crate) fn back(
        &mut self,
        interval: &Interval<N>,
        miss: &State<N>,
        jerk: &Local<N>,
    ) -> Option<Gain<N>> {
        let mut gain = Gain {
            push: self.push(miss),
            ..Gain::default()
        };
        self.slope.plus(&gain.push);
        // The stretch moves the state at the end.
        let moved = self.times(&interval.by_stretch);
        for order in 0..3 {
            let by = &interval.by_stretch[order];
            self.stretch += (self.by_stretch[order] * 2.0 + moved[order]).dot(by);
            self.mixed += self.by_excess[order].dot(by);
            self.slope.stretch += self.slope.state[order].dot(by);
        }
        for order in 0..3 {
            self.by_stretch[order] += moved[order];
        }
        let weights = interval.jerk;
        let [
            [one_one, one_two, one_last],
            [_, two_two, two_last],
            [_, _, last_last],
        ] = self.blocks;
        let own = |one: usize, two: usize| jerk.point * (weights[one] * weights[two]);
        // What is eliminated, and how it goes with the other three.
        let root = Root::of(&last_last, &own(3, 3))?;
        let rows = [
            own(0, 3),
            one_last.transpose() + own(1, 3),
            two_last.transpose() + own(2, 3),
        ];
        // In shares of the root: what is subtracted below are squares, which keep their sign.
        gain.state = rows.map(|row| root.share(row));
        gain.stretch = root.share(self.by_stretch[2]);
        gain.excess = root.share(self.by_excess[2] + jerk.mixed * weights[3]);
        gain.offset = root.share(self.slope.state[2] + jerk.slope.point * weights[3]);
        gain.root = root;
        self.blocks = [
            [own(0, 0), own(0, 1), own(0, 2)],
            [Square::zeros(), one_one + own(1, 1), one_two + own(1, 2)],
            [Square::zeros(), Square::zeros(), two_two + own(2, 2)],
        ];
        self.by_stretch = [Vector::zeros(), self.by_stretch[0], self.by_stretch[1]];
        self.by_excess = [
            jerk.mixed * weights[0],
            self.by_excess[0] + jerk.mixed * weights[1],
            self.by_excess[1] + jerk.mixed * weights[2],
        ];
        self.slope.state = [
            jerk.slope.point * weights[0],
            self.slope.state[0] + jerk.slope.point * weights[1],
            self.slope.state[1] + jerk.slope.point * weights[2],
        ];
        let whole = [0, 1, 2].map(|one| self.blocks[one][one].diagonal());
        for one in 0..3 {
            for two in one..3 {
                self.blocks[one][two] -= transposed_product(&gain.state[one], &gain.state[two]);
            }
            self.by_stretch[one] -= transposed_times(&gain.state[one], &gain.stretch);
            self.by_excess[one] -= transposed_times(&gain.state[one], &gain.excess);
            self.slope.state[one] -= transposed_times(&gain.state[one], &gain.offset);
        }
        // Rounding differs on both sides of the diagonal; unchecked, the difference multiplies.
        for one in 0..3 {
            let block = self.blocks[one][one];
            let mut block = (block + block.transpose()) * 0.5;
            for axis in 0..N {
                block[(axis, axis)] += ROUNDING * whole[one][axis];
            }
            self.blocks[one][one] = block;
        }
        self.stretch -= gain.stretch.norm_squared();
        self.mixed -= gain.stretch.dot(&gain.excess);
        self.excess += jerk.excess - gain.excess.norm_squared();
        self.slope.stretch -= gain.stretch.dot(&gain.offset);
        self.slope.excess += jerk.slope.excess - gain.excess.dot(&gain.offset);
        Some(gain)
    }

    /// One segment back: its stretch is eliminated, with `curvature` and `slope` of its own rows.
    pub(crate) fn back_stretch(&mut self, curvature: f64, slope: f64) -> Option<StretchGain<N>> {
        // What is left of a sum of squares is not negative but by rounding.
        let curvature = self.stretch.max(0.0) + curvature;
        if curvature.is_nan() || curvature <= 0.0 {
            return None;
        }
        self.slope.stretch += slope;
        let mut gain = StretchGain {
            state: self.by_stretch,
            excess: self.mixed,
            by_curvature: 1.0 / curvature,
            slope: self.slope.stretch,
        };
        for order in 0..3 {
            let row = gain.state[order] * gain.by_curvature;
            for other in order..3 {
                self.blocks[order][other] -= outer(&row, &gain.state[other]);
            }
            self.by_excess[order] -= row * gain.excess;
        }
        self.excess -= gain.excess * gain.excess * gain.by_curvature;
        gain.back(&mut self.slope);
        self.by_stretch = [Vector::zeros(); 3];
        self.stretch = 0.0;
        self.mixed = 0.0;
        Some(gain)
    }
}
