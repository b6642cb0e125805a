//! Measures how much of a motion would shake a machine: acceleration above a frequency.
//!
//! Not here: bounds.

use std::f64::consts::TAU;

/// Period of the set-points, s, and how many of rest are put before and behind them.
const PERIOD: f64 = 1e-3;
const BEFORE: usize = 5;
const BEHIND: usize = 200;

/// Root mean square of the part above a frequency, Hz, of the second differences of set-points every millisecond, over all
/// axes, mm/s2.
#[must_use]
pub fn acceleration_above<const N: usize>(frequency: f64, rows: &[[f64; N]]) -> f64 {
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return 0.0;
    };
    let mut points = vec![*first; BEFORE];
    points.extend_from_slice(rows);
    points.extend(vec![*last; BEHIND]);
    let size = (2 * points.len()).next_power_of_two();
    let mut energy = 0.0;
    for axis in 0..N {
        let mut values = vec![[0.0; 2]; size];
        for (value, three) in values.iter_mut().zip(points.windows(3)) {
            value[0] = (three[2][axis] - 2.0 * three[1][axis] + three[0][axis]) / (PERIOD * PERIOD);
        }
        transform(&mut values);
        energy += values
            .iter()
            .enumerate()
            .filter(|(index, _)| {
                (*index).min(size - index) as f64 / (size as f64 * PERIOD) >= frequency
            })
            .map(|(_, [real, imaginary])| real * real + imaginary * imaginary)
            .sum::<f64>()
            / size as f64;
    }
    (energy / (rows.len() - 1).max(1) as f64).sqrt()
}

/// Discrete Fourier transform of a power of two of complex numbers, by halves.
fn transform(values: &mut [[f64; 2]]) {
    let count = values.len();
    if count < 2 {
        return;
    }
    let mut even: Vec<_> = values.iter().step_by(2).copied().collect();
    let mut odd: Vec<_> = values.iter().skip(1).step_by(2).copied().collect();
    transform(&mut even);
    transform(&mut odd);
    for index in 0..count / 2 {
        let (sine, cosine) = (-TAU * index as f64 / count as f64).sin_cos();
        let [real, imaginary] = odd[index];
        let turned = [
            real * cosine - imaginary * sine,
            real * sine + imaginary * cosine,
        ];
        for part in 0..2 {
            values[index][part] = even[index][part] + turned[part];
            values[index + count / 2][part] = even[index][part] - turned[part];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_swing_counts_above_its_frequency_and_not_below() {
        // It begins and ends softly: a jump would have parts at every frequency.
        let swing = |time: f64| 0.01 * (TAU * 60.0 * time).sin() * (TAU * time / 4.0).sin().powi(2);
        let rows: Vec<_> = (0..=2_000)
            .map(|tick| [swing(f64::from(tick) * PERIOD)])
            .collect();
        // Differences over 1 ms see a little less than the acceleration.
        let seen = 0.01 * (2.0 * (0.5 * TAU * 60.0 * PERIOD).sin() / PERIOD).powi(2);
        let expected = seen * (3.0_f64 / 16.0).sqrt();
        let above = acceleration_above(50.0, &rows);
        assert!(
            (above / expected - 1.0).abs() < 0.01,
            "{above} instead of {expected}"
        );
        let beyond = acceleration_above(90.0, &rows);
        assert!(beyond < 0.1 * expected, "{beyond}");
    }
}
