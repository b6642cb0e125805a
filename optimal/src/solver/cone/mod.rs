//! Implements the inequality and the second-order cone of the interior-point method.
//!
//! Source: the predictor-corrector method of Mehrotra with the scaling of Nesterov and Todd. A slack
//! `s` and a multiplier `z` stay inside their cone; a weight maps changes of the slack to changes of
//! the multiplier. Not here: what is bounded, see [`rows`](crate::problem::constraints).

mod side;

use crate::solver::small_blocks::{Square, outer};
pub(crate) use side::{Centre, Reach, Side, Sums};
use toolglide_kinematics::Vector;

/// A slack starts at least this far inside, in shares of the bound.
pub(crate) const MIN_SLACK: f64 = 0.1;

/// A vector lies inside its cone by at least this share of its length: some rounding of a step that
/// would have ended nearer.
const ROUNDING: f64 = 1e-13;

/// A vector of a second-order cone: it is inside when the head is longer than the tail.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<const N: usize> {
    pub(crate) head: f64,
    pub(crate) tail: Vector<N>,
}

impl<const N: usize> Pair<N> {
    const UNIT: Self = Self {
        head: 1.0,
        tail: Vector::<N>::from_array_storage(toolglide_kinematics::nalgebra::ArrayStorage(
            [[0.0; N]; 1],
        )),
    };

    #[inline(always)]
    fn dot(&self, other: &Self) -> f64 {
        self.head * other.head + self.tail.dot(&other.tail)
    }

    /// Square of the head less that of the tail, without cancellation.
    #[inline(always)]
    fn determinant(&self) -> f64 {
        let tail = self.tail.norm();
        (self.head - tail) * (self.head + tail)
    }

    #[inline(always)]
    fn plus(&self, share: f64, other: &Self) -> Self {
        Self {
            head: self.head + share * other.head,
            tail: self.tail + other.tail * share,
        }
    }

    /// Itself, but inside by more than rounding.
    #[inline(always)]
    fn inside(&self) -> Self {
        Self {
            head: self.head.max(self.tail.norm() * (1.0 + ROUNDING)),
            tail: self.tail,
        }
    }

    /// The product in the algebra of the cone.
    #[inline(always)]
    fn product(&self, other: &Self) -> Self {
        Self {
            head: self.dot(other),
            tail: other.tail * self.head + self.tail * other.head,
        }
    }

    /// What times `self`, whose determinant is known, is `product`.
    #[inline(always)]
    fn divide(&self, determinant: f64, product: &Self) -> Self {
        let head = (self.head * product.head - self.tail.dot(&product.tail)) / determinant;
        Self {
            head,
            tail: (product.tail - self.tail * head) / self.head,
        }
    }

    /// Reciprocal of the longest step along `change` inside the cone, 0 where there is no end.
    #[inline(always)]
    fn reach(&self, determinant: f64, change: &Self) -> f64 {
        // With r the reciprocal of the step: determinant r² + 2 mixed r + square = 0.
        let mixed = self.head * change.head - self.tail.dot(&change.tail);
        let square = change.head * change.head - change.tail.norm_squared();
        let discriminant = mixed * mixed - determinant * square;
        if discriminant <= 0.0 {
            return 0.0;
        }
        let root = discriminant.sqrt();
        let larger = if mixed <= 0.0 {
            (root - mixed) / determinant
        } else {
            -square / (mixed + root)
        };
        larger.max(0.0)
    }
}

/// Scaling between slack and multiplier of a cone.
#[derive(Clone, Copy, Debug)]
struct Scaling<const N: usize> {
    point: Pair<N>,
    size: f64,
    /// Determinant of slack and multiplier in the common scale.
    determinant: f64,
}

impl<const N: usize> Scaling<N> {
    #[inline(always)]
    fn between(slack: &Pair<N>, multiplier: &Pair<N>) -> Self {
        let of_slack = slack.determinant().sqrt();
        let of_multiplier = multiplier.determinant().sqrt();
        let (by_slack, by_multiplier) = (1.0 / of_slack, 1.0 / of_multiplier);
        let cosine = slack.dot(multiplier) * by_slack * by_multiplier;
        let half = 0.5 / (0.5 * (1.0 + cosine)).sqrt();
        Self {
            point: Pair {
                head: (slack.head * by_slack + multiplier.head * by_multiplier) * half,
                tail: (slack.tail * by_slack - multiplier.tail * by_multiplier) * half,
            },
            size: (of_slack * by_multiplier).sqrt(),
            determinant: of_slack * of_multiplier,
        }
    }

    /// The multiplier's vector in the common scale.
    #[inline(always)]
    fn up(&self, of: &Pair<N>) -> Pair<N> {
        let along = self.point.tail.dot(&of.tail);
        Pair {
            head: (self.point.head * of.head + along) * self.size,
            tail: (of.tail + self.point.tail * (of.head + along / (1.0 + self.point.head)))
                * self.size,
        }
    }

    /// The slack's vector in the common scale; also from the common scale to multipliers.
    #[inline(always)]
    fn down(&self, of: &Pair<N>) -> Pair<N> {
        let along = self.point.tail.dot(&of.tail);
        let by_size = 1.0 / self.size;
        Pair {
            head: (self.point.head * of.head - along) * by_size,
            tail: (of.tail + self.point.tail * (along / (1.0 + self.point.head) - of.head))
                * by_size,
        }
    }

    /// The weight times a vector.
    #[inline(always)]
    fn weigh(&self, of: &Pair<N>) -> Pair<N> {
        let by_square = 1.0 / (self.size * self.size);
        let along = 2.0 * (self.point.head * of.head - self.point.tail.dot(&of.tail));
        Pair {
            head: (self.point.head * along - of.head) * by_square,
            tail: (of.tail - self.point.tail * along) * by_square,
        }
    }

    #[inline(always)]
    fn weight(&self) -> ConeWeight<N> {
        let by_square = 1.0 / (self.size * self.size);
        let head = self.point.head;
        let tail = &self.point.tail;
        ConeWeight {
            head: (2.0 * head * head - 1.0) * by_square,
            mixed: tail * (-2.0 * head * by_square),
            tail: (outer(tail, &(tail * 2.0)) + Square::identity()) * by_square,
        }
    }
}

/// Maps changes of a cone's slack to changes of its multiplier.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ConeWeight<const N: usize> {
    pub(crate) head: f64,
    pub(crate) mixed: Vector<N>,
    pub(crate) tail: Square<N>,
}

/// One cone: a pair that must stay inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone<const N: usize> {
    slack: Pair<N>,
    multiplier: Pair<N>,
    first_multiplier: Pair<N>,
    residual: Pair<N>,
    target: Pair<N>,
    slack_change: Pair<N>,
    multiplier_change: Pair<N>,
    scaling: Scaling<N>,
}

impl<const N: usize> Default for Cone<N> {
    fn default() -> Self {
        Self {
            slack: Pair::UNIT,
            multiplier: Pair::UNIT,
            first_multiplier: Pair::UNIT,
            residual: Pair::UNIT,
            target: Pair::UNIT,
            slack_change: Pair::UNIT,
            multiplier_change: Pair::UNIT,
            scaling: Scaling {
                point: Pair::UNIT,
                size: 1.0,
                determinant: 1.0,
            },
        }
    }
}

impl<const N: usize> Cone<N> {
    /// As [`Side::reset`].
    pub(crate) fn reset(&mut self, value: &Pair<N>) -> f64 {
        self.slack = *value;
        self.slack.head = value.head.max(value.tail.norm() + MIN_SLACK);
        let by_determinant = 1.0 / self.slack.determinant();
        self.multiplier = Pair {
            head: self.slack.head * by_determinant,
            tail: self.slack.tail * -by_determinant,
        };
        self.first_multiplier = self.multiplier;
        self.slack.head - value.head
    }

    /// As [`Side::weigh`].
    #[inline(always)]
    pub(crate) fn weigh(&mut self, value: &Pair<N>, sums: &mut Sums) -> (ConeWeight<N>, Pair<N>) {
        self.residual = value.plus(-1.0, &self.slack);
        self.scaling = Scaling::between(&self.slack, &self.multiplier);
        let weight = self.scaling.weight();
        sums.complementarity += self.slack.dot(&self.multiplier);
        sums.residual = sums
            .residual
            .max(self.residual.head.abs())
            .max(self.residual.tail.amax());
        (weight, self.scaling.weigh(&self.residual))
    }

    /// As [`Side::predict`].
    #[inline(always)]
    pub(crate) fn predict(&mut self, change: &Pair<N>, reach: &mut Reach) {
        let slack_change = change.plus(1.0, &self.residual);
        let scaled_slack_change = self.scaling.down(&slack_change);
        let scaled = self.scaling.up(&self.multiplier);
        let scaled_multiplier_change = Pair {
            head: -scaled.head - scaled_slack_change.head,
            tail: -scaled.tail - scaled_slack_change.tail,
        };
        // In the common scale slack and multiplier are the same.
        let determinant = self.scaling.determinant;
        reach.primal = reach
            .primal
            .max(scaled.reach(determinant, &scaled_slack_change));
        reach.dual = reach
            .dual
            .max(scaled.reach(determinant, &scaled_multiplier_change));
        reach.by_slack += scaled.dot(&scaled_slack_change);
        reach.by_multiplier += scaled.dot(&scaled_multiplier_change);
        reach.by_both += scaled_slack_change.dot(&scaled_multiplier_change);
        self.target = scaled_slack_change.product(&scaled_multiplier_change);
    }

    /// As [`Side::correct`].
    #[inline(always)]
    pub(crate) fn correct(&mut self, centre: Centre) -> Pair<N> {
        let scaled = self.scaling.up(&self.multiplier);
        let product = Pair {
            head: centre.complementarity - centre.second_order * self.target.head,
            tail: self.target.tail * -centre.second_order,
        };
        self.target = self
            .scaling
            .down(&scaled.divide(self.scaling.determinant, &product));
        let residual = self.scaling.weigh(&self.residual);
        residual
            .plus(-1.0, &self.target)
            .plus(centre.kept, &self.first_multiplier)
    }

    /// As [`Side::aim`].
    #[inline(always)]
    pub(crate) fn aim(&mut self, change: &Pair<N>, reach: &mut Reach) {
        self.slack_change = change.plus(1.0, &self.residual);
        let weighted = self.scaling.weigh(&self.slack_change);
        self.multiplier_change = self
            .target
            .plus(-1.0, &self.multiplier)
            .plus(-1.0, &weighted);
        reach.primal = reach.primal.max(
            self.slack
                .reach(self.slack.determinant(), &self.slack_change),
        );
        reach.dual = reach.dual.max(
            self.multiplier
                .reach(self.multiplier.determinant(), &self.multiplier_change),
        );
    }

    /// As [`Side::advance`].
    #[inline(always)]
    pub(crate) fn advance(&mut self, primal: f64, dual: f64) {
        self.slack = self.slack.plus(primal, &self.slack_change).inside();
        self.multiplier = self.multiplier.plus(dual, &self.multiplier_change).inside();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(head: f64, tail: [f64; 2]) -> Pair<2> {
        Pair {
            head,
            tail: Vector::from(tail),
        }
    }

    #[test]
    fn the_scaling_maps_slack_and_multiplier_to_the_same() {
        let (slack, multiplier) = (pair(2.0, [0.5, -1.2]), pair(1.1, [0.9, 0.2]));
        let scaling = Scaling::between(&slack, &multiplier);
        let (one, other) = (scaling.down(&slack), scaling.up(&multiplier));
        assert!((one.head - other.head).abs() < 1e-14, "{one:?} {other:?}");
        assert!((one.tail - other.tail).norm() < 1e-14, "{one:?} {other:?}");
        let weighted = scaling.weigh(&slack);
        assert!(
            (weighted.head - multiplier.head).abs() < 1e-13,
            "{weighted:?}"
        );
        assert!(
            (weighted.tail - multiplier.tail).norm() < 1e-13,
            "{weighted:?}"
        );
    }

    #[test]
    fn dividing_undoes_the_product() {
        let (one, other) = (pair(2.0, [0.5, -1.2]), pair(-0.3, [0.9, 2.0]));
        let back = one.divide(one.determinant(), &one.product(&other));
        assert!((back.head - other.head).abs() < 1e-14, "{back:?}");
        assert!((back.tail - other.tail).norm() < 1e-14, "{back:?}");
    }

    #[test]
    fn the_longest_step_ends_on_the_cone() {
        let from = pair(2.0, [0.5, -1.2]);
        for change in [
            pair(-1.0, [0.2, 0.3]),
            pair(0.5, [3.0, 0.3]),
            pair(-3.0, [0.0, 0.0]),
        ] {
            let end = from.plus(1.0 / from.reach(from.determinant(), &change), &change);
            assert!((end.head - end.tail.norm()).abs() < 1e-13, "{end:?}");
        }
        assert!(
            from.reach(from.determinant(), &pair(1.0, [0.2, 0.3])) < 1e-15,
            "no end that way"
        );
    }
}
