//! Holds a convex program as rows of three cones, in plain vectors.
//!
//! Source: the standard form of conic solvers: minimize one linear cost subject to `rows in cones`. A
//! row is an affine expression of the columns. Not here: what the rows mean, and who solves them.

/// Affine expressions, one after another.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    starts: Vec<usize>,
    columns: Vec<usize>,
    factors: Vec<f64>,
    constants: Vec<f64>,
}

impl Default for Block {
    fn default() -> Self {
        Self {
            starts: vec![0],
            columns: Vec::new(),
            factors: Vec::new(),
            constants: Vec::new(),
        }
    }
}

impl Block {
    fn row(&mut self, terms: impl IntoIterator<Item = (usize, f64)>, constant: f64) {
        for (column, factor) in terms {
            if factor != 0.0 {
                self.columns.push(column);
                self.factors.push(factor);
            }
        }
        self.starts.push(self.columns.len());
        self.constants.push(constant);
    }

    fn len(&self) -> usize {
        self.constants.len()
    }

    fn terms(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[row]..self.starts[row + 1];
        let columns = self.columns[range.clone()].iter().copied();
        columns.zip(self.factors[range].iter().copied())
    }
}

/// A convex program: minimize `cost` times the columns, such that the first rows are zero, the next
/// are not negative, and the last, in groups, have a first row not less than the norm of the others.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    zero: Block,
    nonnegative: Block,
    cones: Block,
    sizes: Vec<usize>,
    cost: Vec<f64>,
}

impl Rows {
    /// Adds `count` columns without cost and gives the first of them.
    pub(crate) fn columns(&mut self, count: usize) -> usize {
        let first = self.cost.len();
        self.cost.resize(first + count, 0.0);
        first
    }

    /// Sets what a unit of a column costs.
    pub(crate) fn set_cost(&mut self, column: usize, cost: f64) {
        self.cost[column] = cost;
    }

    /// An expression that must be zero.
    pub(crate) fn zero(&mut self, terms: impl IntoIterator<Item = (usize, f64)>, constant: f64) {
        self.zero.row(terms, constant);
    }

    /// An expression that must not be negative.
    pub(crate) fn nonnegative(
        &mut self,
        terms: impl IntoIterator<Item = (usize, f64)>,
        constant: f64,
    ) {
        self.nonnegative.row(terms, constant);
    }

    /// A column whose magnitude is at most that of another.
    pub(crate) fn magnitude(&mut self, column: usize, bound: usize) {
        self.nonnegative([(bound, 1.0), (column, -1.0)], 0.0);
        self.nonnegative([(bound, 1.0), (column, 1.0)], 0.0);
    }

    /// Begins a second-order cone, whose rows follow by [`Rows::cone_row`].
    pub(crate) fn cone(&mut self) -> &mut Self {
        self.sizes.push(0);
        self
    }

    /// The next row of the cone begun last.
    pub(crate) fn cone_row(
        &mut self,
        terms: impl IntoIterator<Item = (usize, f64)>,
        constant: f64,
    ) -> &mut Self {
        self.cones.row(terms, constant);
        if let Some(size) = self.sizes.last_mut() {
            *size += 1;
        }
        self
    }

    /// How many columns there are.
    pub(crate) fn width(&self) -> usize {
        self.cost.len()
    }

    /// How many rows there are.
    pub(crate) fn height(&self) -> usize {
        self.zero.len() + self.nonnegative.len() + self.cones.len()
    }

    /// How many rows are zero, and how many not negative.
    pub(crate) fn linear(&self) -> (usize, usize) {
        (self.zero.len(), self.nonnegative.len())
    }

    /// How many rows each second-order cone has.
    pub(crate) fn sizes(&self) -> &[usize] {
        &self.sizes
    }

    /// What a unit of each column costs.
    pub(crate) fn cost(&self) -> &[f64] {
        &self.cost
    }

    /// Constants of all rows.
    pub(crate) fn constants(&self) -> Vec<f64> {
        let blocks = [&self.zero, &self.nonnegative, &self.cones];
        blocks
            .into_iter()
            .flat_map(|block| block.constants.iter().copied())
            .collect()
    }

    /// All factors column by column: where each column starts, then row and factor, rows rising.
    /// Factors of the same place are added.
    pub(crate) fn by_column(&self) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
        let mut starts = vec![0_usize; self.width() + 1];
        self.each_row(|_, terms| {
            for &(column, _) in terms {
                starts[column + 1] += 1;
            }
        });
        for column in 0..self.width() {
            starts[column + 1] += starts[column];
        }
        let total = starts[self.width()];
        let (mut rows, mut factors) = (vec![0; total], vec![0.0; total]);
        let mut next = starts.clone();
        self.each_row(|row, terms| {
            for &(column, factor) in terms {
                rows[next[column]] = row;
                factors[next[column]] = factor;
                next[column] += 1;
            }
        });
        (starts, rows, factors)
    }

    /// Gives every row with its terms, each column once.
    fn each_row(&self, mut take: impl FnMut(usize, &[(usize, f64)])) {
        let mut terms: Vec<(usize, f64)> = Vec::new();
        let mut row = 0;
        for block in [&self.zero, &self.nonnegative, &self.cones] {
            for index in 0..block.len() {
                terms.clear();
                for (column, factor) in block.terms(index) {
                    match terms.iter_mut().find(|known| known.0 == column) {
                        Some(known) => known.1 += factor,
                        None => terms.push((column, factor)),
                    }
                }
                take(row, &terms);
                row += 1;
            }
        }
    }

    /// A bound from below on the cost of everything that keeps the rows, whatever `dual` is.
    ///
    /// The dual point is put into the cones first. What then remains of its equations is paid for
    /// by the `largest` magnitude that each column may have. Only rounding of one multiplication by
    /// the matrix is left out: some 1e-14 of the cost.
    pub(crate) fn bound(&self, dual: &[f64], largest: &[f64]) -> f64 {
        let mut dual = dual.to_vec();
        let (zero, nonnegative) = self.linear();
        for value in &mut dual[zero..zero + nonnegative] {
            *value = value.max(0.0);
        }
        let mut first = zero + nonnegative;
        for &size in &self.sizes {
            let others = &dual[first + 1..first + size];
            let norm = others.iter().map(|value| value * value).sum::<f64>().sqrt();
            // A little more, so that the rounding of the norm cannot leave the cone.
            dual[first] = dual[first].max(norm * (1.0 + 4.0 * f64::EPSILON));
            first += size;
        }
        // cost = remainder · columns + dual · rows - dual · constants, and dual · rows >= 0.
        let mut remainder = self.cost.clone();
        let mut bound = 0.0;
        self.each_row(|row, terms| {
            for &(column, factor) in terms {
                remainder[column] -= factor * dual[row];
            }
        });
        for (value, constant) in dual.iter().zip(self.constants()) {
            bound -= value * constant;
        }
        let paid: f64 = remainder
            .iter()
            .zip(largest)
            .map(|(rest, most)| rest.abs() * most)
            .sum();
        bound - paid
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The least `x` that is not less than 3 and not less than 5 times one.
    fn least_above_five() -> Rows {
        let mut rows = Rows::default();
        let x = rows.columns(1);
        rows.set_cost(x, 1.0);
        rows.nonnegative([(x, 1.0)], -3.0);
        rows.cone().cone_row([(x, 1.0)], 0.0).cone_row([], 5.0);
        rows
    }

    #[test]
    fn an_exact_dual_gives_the_exact_bound_and_a_poor_one_a_smaller_bound() {
        let rows = least_above_five();
        let exact = rows.bound(&[0.0, 1.0, -1.0], &[10.0]);
        assert!((exact - 5.0).abs() < 1e-12, "{exact}");
        for poor in [
            [0.3, 0.7, -0.7],
            [0.0, 0.9, -1.0],
            [-1.0, 1.0, 0.0],
            [0.0, 0.99, -0.99],
        ] {
            let bound = rows.bound(&poor, &[10.0]);
            assert!(bound <= 5.0 + 1e-12, "{poor:?} gives {bound}");
        }
    }

    #[test]
    fn factors_of_one_place_are_added() {
        let mut rows = Rows::default();
        let x = rows.columns(2);
        rows.zero([(x, 1.0), (x + 1, 2.0), (x, 3.0)], 0.0);
        let (starts, places, factors) = rows.by_column();
        assert_eq!((starts, places), (vec![0, 1, 2], vec![0, 0]));
        assert_eq!(factors, [4.0, 2.0]);
    }
}
