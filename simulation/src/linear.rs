//! Computes the dense linear algebra of the simulation; the only file that names faer.
//!
//! Source: faer for LU, QR, eigenvalues and generalised eigenvalues; Higham (2005) for the matrix exponential, Van Loan
//! (1978) for the zero-order hold. Not here: what the matrices mean.

use faer::linalg::solvers::{Solve, SolveLstsq};
pub(crate) use faer::{Mat, c64};

/// Numerator coefficients of the Padé approximant of degree 13 (Higham 2005, table 2.3).
const PADE: [f64; 14] = [
    64_764_752_532_480_000.0,
    32_382_376_266_240_000.0,
    7_771_770_303_897_600.0,
    1_187_353_796_428_800.0,
    129_060_195_264_000.0,
    10_559_470_521_600.0,
    670_442_572_800.0,
    33_522_128_640.0,
    1_323_241_920.0,
    40_840_800.0,
    960_960.0,
    16_380.0,
    182.0,
    1.0,
];

/// Largest 1-norm at which that approximant has a backward error below the unit roundoff.
const THETA: f64 = 5.371_920_351_148_152;

/// Sweeps of the balancing of a matrix.
const BALANCING: u32 = 100;

/// Weights below this share of a generalised eigenvalue belong to an infinite one.
const INFINITE: f64 = 1e-9;

/// Matrix exponential by scaling and squaring.
#[allow(
    clippy::cast_possible_truncation,
    reason = "the binary logarithm of a float is below 1024"
)]
pub(crate) fn exponential(a: &Mat<f64>) -> Mat<f64> {
    let n = a.nrows();
    // faer's `norm_l1` sums all entries; the induced 1-norm is the largest sum of a column.
    let norm = (0..n)
        .map(|j| (0..n).map(|i| a[(i, j)].abs()).sum::<f64>())
        .fold(0.0, f64::max);
    let halvings = if norm > THETA && norm.is_finite() {
        (norm / THETA).log2().ceil() as i32
    } else {
        0
    };
    let scale = 0.5_f64.powi(halvings);
    let a = Mat::from_fn(n, n, |i, j| a[(i, j)] * scale);
    let eye = Mat::<f64>::identity(n, n);
    let sum = |terms: &[(f64, &Mat<f64>)]| {
        Mat::from_fn(n, n, |i, j| {
            terms.iter().map(|(c, m)| c * m[(i, j)]).sum::<f64>()
        })
    };
    let a2 = &a * &a;
    let a4 = &a2 * &a2;
    let a6 = &a2 * &a4;
    let c = &PADE;
    let high = sum(&[(c[13], &a6), (c[11], &a4), (c[9], &a2)]);
    let odd = &a
        * sum(&[
            (1.0, &(&a6 * &high)),
            (c[7], &a6),
            (c[5], &a4),
            (c[3], &a2),
            (c[1], &eye),
        ]);
    let high = sum(&[(c[12], &a6), (c[10], &a4), (c[8], &a2)]);
    let even = sum(&[
        (1.0, &(&a6 * &high)),
        (c[6], &a6),
        (c[4], &a4),
        (c[2], &a2),
        (c[0], &eye),
    ]);
    let mut result = sum(&[(1.0, &even), (-1.0, &odd)])
        .partial_piv_lu()
        .solve(sum(&[(1.0, &even), (1.0, &odd)]));
    for _ in 0..halvings {
        result = &result * &result;
    }
    result
}

/// Exact discretisation under inputs held for a time, s: one exponential of a block matrix.
pub(crate) fn zero_order_hold(a: &Mat<f64>, b: &Mat<f64>, time: f64) -> (Mat<f64>, Mat<f64>) {
    let (n, m) = (a.nrows(), b.ncols());
    let block = Mat::from_fn(n + m, n + m, |i, j| match (i < n, j < n) {
        (true, true) => a[(i, j)] * time,
        (true, false) => b[(i, j - n)] * time,
        _ => 0.0,
    });
    let e = exponential(&block);
    (
        Mat::from_fn(n, n, |i, j| e[(i, j)]),
        Mat::from_fn(n, m, |i, j| e[(i, n + j)]),
    )
}

/// `(p I - a)^-1 b` at a complex place `p`.
pub(crate) fn resolvent(a: &Mat<f64>, b: &Mat<f64>, p: c64) -> Mat<c64> {
    let n = a.nrows();
    let m = Mat::from_fn(n, n, |i, j| {
        (if i == j { p } else { c64::new(0.0, 0.0) }) - a[(i, j)]
    });
    let b = Mat::from_fn(n, b.ncols(), |i, j| c64::new(b[(i, j)], 0.0));
    m.partial_piv_lu().solve(b)
}

/// Eigenvalues of a real matrix; none where the iteration fails.
///
/// States of a loop have units many powers of ten apart, and its delays have no eigenvalue but 0, whose error grows with the
/// norm; so the matrix is balanced first.
pub(crate) fn eigenvalues(a: &Mat<f64>) -> Vec<c64> {
    balanced(a).0.eigenvalues().unwrap_or_default()
}

/// The same matrix in units of its states, powers of two, in which rows and columns are alike (Parlett and Reinsch 1969), and
/// those units.
fn balanced(a: &Mat<f64>) -> (Mat<f64>, Vec<f64>) {
    let n = a.nrows();
    let mut a = a.clone();
    let mut units = vec![1.0; n];
    for _ in 0..BALANCING {
        let mut changed = false;
        for i in 0..n {
            let others = || (0..n).filter(|&j| j != i);
            let column: f64 = others().map(|j| a[(j, i)].abs()).sum();
            let row: f64 = others().map(|j| a[(i, j)].abs()).sum();
            // A state that nothing sees, or that sees nothing, is scaled away from the rest.
            let factor = match (row > 0.0, column > 0.0) {
                (true, true) => (row / column).sqrt().log2().round().exp2(),
                _ => 1.0,
            };
            if (factor - 1.0).abs() > 0.1 && factor.is_finite() && factor > 0.0 {
                changed = true;
                units[i] *= factor;
                for j in others() {
                    a[(j, i)] *= factor;
                    a[(i, j)] /= factor;
                }
            }
        }
        if !changed {
            break;
        }
    }
    (a, units)
}

/// Finite transmission zeros of a system with one input and one output: the generalised eigenvalues of the
/// Rosenbrock pencil `[a b; c 0] - z [I 0; 0 0]`.
pub(crate) fn zeros(a: &Mat<f64>, b: &Mat<f64>, c: &Mat<f64>) -> Vec<c64> {
    let n = a.nrows();
    let (a, units) = balanced(a);
    // Rows of input and output are scaled to size 1: zeros do not change.
    let size = |values: &[f64]| {
        let most = values
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        if most > 0.0 { most } else { 1.0 }
    };
    let input: Vec<f64> = (0..n).map(|i| b[(i, 0)] / units[i]).collect();
    let output: Vec<f64> = (0..n).map(|j| c[(0, j)] * units[j]).collect();
    let (into, from) = (size(&input), size(&output));
    let pencil = Mat::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
        (true, true) => a[(i, j)],
        (true, false) => input[i] / into,
        (false, true) => output[j] / from,
        _ => 0.0,
    });
    let identity = Mat::from_fn(n + 1, n + 1, |i, j| f64::from(u8::from(i == j && i < n)));
    let Ok(found) = pencil.generalized_eigen(&identity) else {
        return Vec::new();
    };
    (0..=n)
        .map(|i| (found.S_a()[i], found.S_b()[i]))
        .filter(|(a, b)| b.norm() > INFINITE * (a.norm() + b.norm()))
        .map(|(a, b)| a / b)
        .collect()
}

/// Least squares by QR: the `x` that makes `a x - b` least.
pub(crate) fn least_squares(a: &Mat<f64>, b: &Mat<f64>) -> Mat<f64> {
    a.qr().solve_lstsq(b)
}

/// Singular values of a matrix, largest first; none where the iteration fails.
pub(crate) fn singular_values(a: &Mat<f64>) -> Vec<f64> {
    a.singular_values().unwrap_or_default()
}

/// Inverse of a square matrix.
pub(crate) fn inverse(a: &Mat<f64>) -> Mat<f64> {
    let n = a.nrows();
    solve(a, &Mat::<f64>::identity(n, n))
}

/// Solution of `a x = b`.
pub(crate) fn solve(a: &Mat<f64>, b: &Mat<f64>) -> Mat<f64> {
    a.partial_piv_lu().solve(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_of_a_rotation_and_of_a_stiff_matrix_is_exact() {
        let w = 700.0;
        let e = exponential(&Mat::from_fn(2, 2, |i, j| [[0.0, w], [-w, 0.0]][i][j]));
        assert!((e[(0, 0)] - w.cos()).abs() < 1e-11, "cosine {e:?}");
        assert!((e[(0, 1)] - w.sin()).abs() < 1e-11, "sine {e:?}");
        let stiff = Mat::from_fn(2, 2, |i, j| [[-1e4, 0.0], [0.0, -1.0]][i][j]);
        let e = exponential(&stiff);
        assert!(e[(0, 0)].abs() < 1e-300, "fast {e:?}");
        assert!(
            (e[(1, 1)] * 1.0_f64.exp() - 1.0).abs() < 1e-13,
            "slow {e:?}"
        );
    }

    #[test]
    fn eigenvalues_of_a_badly_scaled_matrix_are_found() {
        // A delay line of nilpotent states, units apart by 1e18, beside one eigenvalue of 0.5.
        let entries = [
            [0.5, 0.0, 0.0, 0.0],
            [1e9, 0.0, 0.0, 0.0],
            [0.0, 1e9, 0.0, 0.0],
            [0.0, 0.0, 1e-9, 0.0],
        ];
        let found = eigenvalues(&Mat::from_fn(4, 4, |i, j| entries[i][j]));
        let most = found.iter().map(|value| value.norm()).fold(0.0, f64::max);
        assert!((most - 0.5).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn a_hundred_short_holds_are_one_long_hold() {
        let a = Mat::from_fn(2, 2, |i, j| [[0.0, 1.0], [-2000.0, -3.0]][i][j]);
        let b = Mat::from_fn(2, 1, |i, _| [0.0, 1.0][i]);
        let (long, input) = zero_order_hold(&a, &b, 0.01);
        let (short, part) = zero_order_hold(&a, &b, 1e-4);
        let mut state = [0.0; 2];
        for _ in 0..100 {
            state = std::array::from_fn(|i| {
                short[(i, 0)] * state[0] + short[(i, 1)] * state[1] + part[(i, 0)]
            });
        }
        for i in 0..2 {
            assert!((state[i] - input[(i, 0)]).abs() < 1e-13, "{i}: {state:?}");
        }
        assert!(long[(0, 0)].is_finite(), "{long:?}");
    }
}
