//! Factorises the curvature of an eliminated variable by Cholesky.
//!
//! Near a tight bound and far from others a curvature is large one way and small the other. Of its inverse the
//! digits of the large one are lost; what then remains after elimination turns negative, and grows from node
//! to node. With a root, what is subtracted is a sum of squares, true to the last digits of the whole.
//!
//! Source: the factorisation of Cholesky. Not here: what is eliminated, see [`cost`](crate::solver::riccati::cost_to_go).

use crate::solver::small_blocks::Square;
use toolglide_kinematics::{Vector, nalgebra::SMatrix};

/// Lower triangle whose product with its transpose is the curvature; reciprocals on the diagonal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Root<const N: usize> {
    lower: Square<N>,
}

impl<const N: usize> Default for Root<N> {
    fn default() -> Self {
        Self {
            lower: Square::zeros(),
        }
    }
}

impl<const N: usize> Root<N> {
    /// The root of a positive semidefinite curvature and a positive `diagonal`, which no pivot falls
    /// short of but by rounding; `None` where there is no number.
    #[inline(always)]
    pub(super) fn of(curvature: &Square<N>, diagonal: &Square<N>) -> Option<Self> {
        let mut lower = Square::<N>::zeros();
        for column in 0..N {
            let own = diagonal[(column, column)];
            let mut pivot = curvature[(column, column)] + own;
            for before in 0..column {
                pivot -= lower[(column, before)] * lower[(column, before)];
            }
            let pivot = pivot.max(own);
            if pivot.is_nan() || pivot <= 0.0 {
                return None;
            }
            let by_root = 1.0 / pivot.sqrt();
            lower[(column, column)] = by_root;
            for row in column + 1..N {
                let mut value = curvature[(row, column)] + diagonal[(row, column)];
                for before in 0..column {
                    value -= lower[(row, before)] * lower[(column, before)];
                }
                lower[(row, column)] = value * by_root;
            }
        }
        Some(Self { lower })
    }

    /// What times the root is `of`.
    #[inline(always)]
    pub(super) fn share<const C: usize>(&self, mut of: SMatrix<f64, N, C>) -> SMatrix<f64, N, C> {
        for column in 0..C {
            for row in 0..N {
                let mut value = of[(row, column)];
                for before in 0..row {
                    value -= self.lower[(row, before)] * of[(before, column)];
                }
                of[(row, column)] = value * self.lower[(row, row)];
            }
        }
        of
    }

    /// What times the transpose of the root is `of`.
    #[inline(always)]
    pub(super) fn back(&self, mut of: Vector<N>) -> Vector<N> {
        for row in (0..N).rev() {
            let mut value = of[row];
            for after in row + 1..N {
                value -= self.lower[(after, row)] * of[after];
            }
            of[row] = value * self.lower[(row, row)];
        }
        of
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A curvature that is large along (3, 4) and small across.
    fn skew(large: f64, small: f64) -> Square<2> {
        let (along, across) = (Vector::<2>::new(0.6, 0.8), Vector::<2>::new(-0.8, 0.6));
        along * along.transpose() * large + across * across.transpose() * small
    }

    #[test]
    fn the_root_gives_back_the_curvature_and_solves_with_it() {
        let curvature = skew(5.0, 2.0);
        let root = Root::of(&curvature, &Square::zeros()).unwrap_or_default();
        let side = Vector::<2>::new(1.5, -0.5);
        let solution = root.back(root.share(side));
        let back = curvature * solution;
        assert!((back - side).norm() < 1e-14, "{back}");
    }

    #[test]
    fn what_is_left_after_elimination_keeps_its_digits_however_skew_the_curvature() {
        // Two points on a spring of the same skew stiffness to each other, and a soft one to the ground.
        for large in [1e3, 1e9, 1e15] {
            let stiff = skew(large, 1.0);
            let soft = Square::<2>::identity();
            let root = Root::of(&stiff, &soft).unwrap_or_default();
            let share = root.share(stiff);
            let left = stiff - share.tr_mul(&share);
            let expected = skew(large / (1.0 + large), 0.5);
            // Rounding of the whole, and no more.
            let error = (left - expected).norm();
            assert!(
                error < 4.0 * f64::EPSILON * large + 1e-15,
                "{large:e}: {error:e}"
            );
        }
    }

    #[test]
    fn where_rounding_has_taken_a_pivot_its_own_share_is_kept() {
        let curvature = Square::<2>::new(1.0, 1.0, 1.0, 1.0 - 1e-12);
        let diagonal = Square::<2>::identity() * 1e-14;
        let root = Root::of(&curvature, &diagonal).unwrap_or_default();
        let solution = root.back(root.share(Vector::<2>::new(0.0, 1.0)));
        assert!(solution[1] > 0.0, "{solution}");
        let none = Square::<2>::zeros();
        assert!(Root::of(&none, &none).is_none(), "nothing is bounded");
    }
}
