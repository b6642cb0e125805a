//! Multiplies blocks as small as the number of axes.
//!
//! Not here: what the blocks are, see [`front`](crate::solver::riccati).

use toolglide_kinematics::{Vector, nalgebra::SMatrix};

pub(crate) type Square<const N: usize> = SMatrix<f64, N, N>;

/// A block times a vector.
#[inline(always)]
pub(crate) fn times<const N: usize>(block: &Square<N>, vector: &Vector<N>) -> Vector<N> {
    let mut product = Vector::zeros();
    for column in 0..N {
        for row in 0..N {
            product[row] += block[(row, column)] * vector[column];
        }
    }
    product
}

/// The transpose of a block times a vector.
#[inline(always)]
pub(crate) fn transposed_times<const N: usize>(block: &Square<N>, vector: &Vector<N>) -> Vector<N> {
    let mut product = Vector::zeros();
    for row in 0..N {
        for column in 0..N {
            product[column] += block[(row, column)] * vector[row];
        }
    }
    product
}

/// The transpose of a block times another.
#[inline(always)]
pub(crate) fn transposed_product<const N: usize>(one: &Square<N>, other: &Square<N>) -> Square<N> {
    let mut product = Square::zeros();
    for column in 0..N {
        for row in 0..N {
            let mut sum = 0.0;
            for at in 0..N {
                sum += one[(at, row)] * other[(at, column)];
            }
            product[(row, column)] = sum;
        }
    }
    product
}

/// A column times a row.
#[inline(always)]
pub(crate) fn outer<const N: usize>(column: &Vector<N>, row: &Vector<N>) -> Square<N> {
    let mut product = Square::zeros();
    for at in 0..N {
        for other in 0..N {
            product[(other, at)] = column[other] * row[at];
        }
    }
    product
}
