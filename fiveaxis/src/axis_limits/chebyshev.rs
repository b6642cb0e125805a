//! Interpolates polynomials in Chebyshev series and bounds their derivatives.
//!
//! Source: interpolation at the zeros, or at the extrema, of a polynomial of Chebyshev. No polynomial
//! of the series exceeds 1 between -1 and 1, so that the sum of the magnitudes of the coefficients
//! bounds it at every instant. Not here: of what they are.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// Values of a polynomial in time.
pub(crate) const NODES: usize = 8;

/// Values of a polynomial along a block, those at its ends among them.
pub(crate) const STATIONS: usize = 6;

/// Coefficients of the polynomials of Chebyshev, the constant first.
pub(crate) type Series<const N: usize> = [f64; N];

/// Where the values in time are, from -1 up to 1, both excluded.
pub(crate) static AT_NODES: LazyLock<[f64; NODES]> =
    LazyLock::new(|| std::array::from_fn(|node| -angle(node, 0.5, NODES).cos()));

/// Where the values along a block are, from -1 up to 1, both included.
pub(crate) static AT_STATIONS: LazyLock<[f64; STATIONS]> =
    LazyLock::new(|| std::array::from_fn(|station| -angle(station, 0.0, STATIONS - 1).cos()));

static FROM_NODES: LazyLock<[[f64; NODES]; NODES]> = LazyLock::new(|| {
    from_fn(|order, node| {
        let share = if order == 0 { 1.0 } else { 2.0 };
        share * (number(order) * angle(node, 0.5, NODES)).cos() / number(NODES)
    })
});

static FROM_STATIONS: LazyLock<[[f64; STATIONS]; STATIONS]> = LazyLock::new(|| {
    let last = STATIONS - 1;
    from_fn(|order, station| {
        let halves = [order, station].map(|at| if at == 0 || at == last { 0.5 } else { 1.0 });
        let cosine = (number(order) * angle(station, 0.0, last)).cos();
        2.0 * halves[0] * halves[1] * cosine / number(last)
    })
});

/// A matrix whose columns go up from -1, where the formulas go down from 1: the sign of odd orders turns.
fn from_fn<const N: usize>(weight: impl Fn(usize, usize) -> f64) -> [[f64; N]; N] {
    std::array::from_fn(|order| {
        let sign = if order % 2 == 0 { 1.0 } else { -1.0 };
        std::array::from_fn(|node| sign * weight(order, node))
    })
}

fn angle(index: usize, offset: f64, count: usize) -> f64 {
    PI * (number(index) + offset) / number(count)
}

#[allow(clippy::cast_precision_loss, reason = "orders are below ten")]
fn number(count: usize) -> f64 {
    count as f64
}

fn product<const N: usize>(matrix: &[[f64; N]; N], values: &[f64; N]) -> Series<N> {
    matrix.map(|row| {
        row.iter()
            .zip(values)
            .map(|(weight, value)| weight * value)
            .sum()
    })
}

/// The series through values in time.
pub(crate) fn through_nodes(values: &[f64; NODES]) -> Series<NODES> {
    product(&FROM_NODES, values)
}

/// The series through values along a block.
pub(crate) fn through_stations(values: &[f64; STATIONS]) -> Series<STATIONS> {
    product(&FROM_STATIONS, values)
}

/// The derivative of a series.
pub(crate) fn slope<const N: usize>(series: &Series<N>) -> Series<N> {
    let mut slopes = [0.0; N];
    for order in (1..N).rev() {
        let above = slopes.get(order + 1).copied().unwrap_or(0.0);
        slopes[order - 1] = above + 2.0 * number(order) * series[order];
    }
    slopes[0] *= 0.5;
    slopes
}

/// What a series is at most in magnitude between `-width` and `width`, which is at most 1.
pub(crate) fn bound<const N: usize>(series: &Series<N>, width: f64) -> f64 {
    let higher: f64 = series[2..].iter().map(|part| part.abs()).sum();
    series[0].abs() + width * series[1].abs() + higher
}

/// The value of a series.
pub(crate) fn value<const N: usize>(series: &Series<N>, at: f64) -> f64 {
    let (mut one, mut two) = (0.0, 0.0);
    for &coefficient in series[1..].iter().rev() {
        (one, two) = (coefficient + 2.0 * at * one - two, one);
    }
    series[0] + at * one - two
}

/// Coefficients below this, mm and rad, are rounding.
const ROUNDING: f64 = 1e-9;

/// Coefficients fall when the last two are less than this share of the two before them.
const FALLING: f64 = 0.1;

/// Whether a series has said all there is: its last coefficients are less than `most` and fall.
///
/// Beside a pole axes that are looked at too rarely seem to go straight through it, while one of
/// them turns half around in between; what the looks before and after leave does not fall.
pub(crate) fn falls<const N: usize>(series: &Series<N>, most: f64) -> bool {
    let last = series[N - 2].abs().max(series[N - 1].abs());
    let before = series[N - 4].abs().max(series[N - 3].abs());
    last <= ROUNDING || (last <= most && last <= FALLING * before)
}

/// What the last two coefficients add to the first three derivatives at most: a series that gets
/// smaller from one order to the next leaves out less than that.
pub(crate) fn last<const N: usize>(series: &Series<N>) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for order in [N - 2, N - 1] {
        let (n, part) = (number(order).powi(2), series[order].abs());
        sums[0] += part * n;
        sums[1] += part * n * (n - 1.0) / 3.0;
        sums[2] += part * n * (n - 1.0) * (n - 4.0) / 15.0;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    fn derivatives_are_those_of_half_an_exponential<const N: usize>(first: Series<N>, miss: f64) {
        let mut series = first;
        let mut scale = 1.0;
        let rests = last(&first);
        for order in 0..4 {
            let rest = if order == 0 { miss } else { rests[order - 1] };
            for at in [-1.0, -0.3, 0.4, 1.0] {
                let (got, wanted) = (value(&series, at), scale * (0.5_f64 * at).exp());
                assert!(
                    (got - wanted).abs() < rest,
                    "derivative {order} at {at}: {got}"
                );
                assert!(
                    got.abs() <= bound(&series, at.abs()) + 1e-15,
                    "derivative {order} at {at}: {got} is above its bound"
                );
            }
            series = slope(&series);
            scale *= 0.5;
        }
    }

    #[test]
    fn derivatives_miss_less_than_the_last_coefficients() {
        let half = |at: f64| (0.5 * at).exp();
        derivatives_are_those_of_half_an_exponential(through_nodes(&AT_NODES.map(half)), 1e-9);
        derivatives_are_those_of_half_an_exponential(
            through_stations(&AT_STATIONS.map(half)),
            1e-5,
        );
    }
}
