//! Steps a mode and its derivative by the frequency exactly through an interval of constant jerk.
//!
//! Source: ours. The state of a mode is scaled: deflection `E = x w²/A`, rate `G = x' w/A`, with `A` any
//! acceleration; `S = w dE/dw` and `D` its rate say what a wrong frequency would add to them. In units of
//! `1/w` of time
//!
//! ```text
//! E' = G     G' = -E - 2 d G - a/A     S' = D     D' = -S - 2 d D - 2 E - 2 d G
//! ```
//!
//! The step is the exponential of that linear system with acceleration and jerk. Not here: where it must come
//! to rest.

use super::Mode;

/// Deflection, rate, and what a wrong frequency adds to either; scaled, without dimension.
pub type ModeState = [f64; 4];

/// Numbers of a state with acceleration and jerk.
const ALL: usize = 6;

/// The exponential is taken of a matrix whose argument is below this, and squared up from there.
const SMALL: f64 = 0.5;

/// Terms of its series: the next is below the rounding.
const TERMS: u32 = 14;

type Matrix = [[f64; ALL]; ALL];

/// One interval of a duration, for a mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    natural: f64,
    generator: Matrix,
    step: Matrix,
}

impl Transition {
    /// The step of a mode over a duration, s.
    #[must_use]
    pub fn new(mode: &Mode, duration: f64) -> Self {
        let generator = generator(mode.damping());
        let natural = mode.natural();
        Self {
            natural,
            generator,
            step: exponential(&generator, natural * duration),
        }
    }

    /// The state after the interval: `acceleration` (at its start) and `jerk` over the acceleration of the scale, 1 and
    /// 1/s.
    #[must_use]
    pub fn after(&self, state: &ModeState, acceleration: f64, jerk: f64) -> ModeState {
        let all = self.extended(state, acceleration, jerk);
        core::array::from_fn(|row| product(&self.step[row], &all))
    }

    /// How the state after the interval changes with its duration, 1/s, where the jerk stays.
    #[must_use]
    pub fn by_duration(&self, state: &ModeState, acceleration: f64, jerk: f64) -> ModeState {
        let all = self.extended(state, acceleration, jerk);
        let after: [f64; ALL] = core::array::from_fn(|row| product(&self.step[row], &all));
        core::array::from_fn(|row| self.natural * product(&self.generator[row], &after))
    }

    /// A functional of the state after the interval, as one of the state before it, of the acceleration before it, and
    /// of the jerk.
    #[must_use]
    pub fn pulled_back(&self, functional: &ModeState) -> (ModeState, f64, f64) {
        let column = |column: usize| -> f64 {
            functional
                .iter()
                .zip(&self.step)
                .map(|(weight, row)| weight * row[column])
                .sum()
        };
        (
            core::array::from_fn(column),
            column(4),
            column(5) / self.natural,
        )
    }

    fn extended(&self, state: &ModeState, acceleration: f64, jerk: f64) -> [f64; ALL] {
        let [deflection, rate, by_frequency, its_rate] = *state;
        [
            deflection,
            rate,
            by_frequency,
            its_rate,
            acceleration,
            jerk / self.natural,
        ]
    }
}

fn product(row: &[f64; ALL], column: &[f64; ALL]) -> f64 {
    row.iter().zip(column).map(|(one, other)| one * other).sum()
}

fn generator(damping: f64) -> Matrix {
    let twice = 2.0 * damping;
    [
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [-1.0, -twice, 0.0, 0.0, -1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        [-2.0, -twice, -1.0, -twice, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        [0.0; ALL],
    ]
}

fn times(one: &Matrix, other: &Matrix) -> Matrix {
    let mut product = [[0.0; ALL]; ALL];
    for (row, one) in product.iter_mut().zip(one) {
        for (share, other) in one.iter().zip(other) {
            for (value, factor) in row.iter_mut().zip(other) {
                *value += share * factor;
            }
        }
    }
    product
}

/// The exponential of a matrix times an argument, which is not negative.
fn exponential(generator: &Matrix, argument: f64) -> Matrix {
    let mut halvings = 0;
    let mut small = argument;
    while small > SMALL && halvings < 60 {
        small *= 0.5;
        halvings += 1;
    }
    let mut power: Matrix = core::array::from_fn(|row| {
        core::array::from_fn(|column| f64::from(u8::from(row == column)))
    });
    let mut sum = power;
    for term in 1..=TERMS {
        power = times(&power, generator);
        let share = small / f64::from(term);
        for (sum, power) in sum.iter_mut().flatten().zip(power.iter_mut().flatten()) {
            *power *= share;
            *sum += *power;
        }
    }
    for _ in 0..halvings {
        sum = times(&sum, &sum);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vibration::Resonator;

    /// Motion: acceleration at the start, jerk and duration of each interval.
    const MOTION: [[f64; 3]; 4] = [
        [0.0, 2e4, 0.05],
        [1000.0, 0.0, 0.1],
        [1000.0, -3e4, 0.04],
        [-200.0, 5e4, 0.004],
    ];

    fn through(mode: &Mode, scale: f64) -> ModeState {
        let mut state = [0.0; 4];
        for [acceleration, jerk, duration] in MOTION {
            let step = Transition::new(mode, duration);
            state = step.after(&state, acceleration / scale, jerk / scale);
        }
        state
    }

    #[test]
    fn the_step_agrees_with_the_closed_form_of_the_oscillator() {
        for (frequency, damping) in [(6.0, 0.0), (25.0, 0.02), (80.0, 0.3), (400.0, 0.01)] {
            let mode = Mode::new(frequency, damping).unwrap();
            let mut resonator = Resonator::new(&mode);
            for [acceleration, jerk, duration] in MOTION {
                resonator.pass(acceleration, jerk, duration);
            }
            let [deflection, rate, ..] = through(&mode, 2000.0);
            let natural = mode.natural();
            let own = deflection * 2000.0 / (natural * natural);
            let scale = 1000.0 / (natural * natural);
            assert!(
                (own - resonator.deflection()).abs() < 1e-12 * scale,
                "{frequency} Hz: {own}"
            );
            let own = rate * 2000.0 / natural;
            assert!(
                (own - resonator.rate()).abs() < 1e-12 * scale * natural,
                "{frequency} Hz: {own}"
            );
        }
    }

    #[test]
    fn the_derivative_by_frequency_is_that_of_differences() {
        let at = |share: f64| through(&Mode::new(25.0, 0.02).unwrap().detuned(share).unwrap(), 1.0);
        let step = 1e-5;
        let [low, middle, high] = [1.0 - step, 1.0, 1.0 + step].map(at);
        // The deflection is E / w², whose scale goes with the frequency: the derivative is that at a fixed scale.
        let deflection = |state: &ModeState, share: f64| state[0] / (share * share);
        let difference =
            (deflection(&high, 1.0 + step) - deflection(&low, 1.0 - step)) / (2.0 * step);
        assert!(
            (difference - middle[2]).abs() < 1e-6 * middle[2].abs().max(1.0),
            "{difference} against {}",
            middle[2]
        );
    }

    #[test]
    fn the_derivative_by_duration_is_that_of_differences_and_functionals_go_back() {
        let mode = Mode::new(25.0, 0.02).unwrap();
        let state = [0.3, -0.7, 0.2, 1.1];
        let (duration, step) = (0.011, 1e-7);
        let after = |duration: f64| Transition::new(&mode, duration).after(&state, 0.4, -30.0);
        let exact = Transition::new(&mode, duration).by_duration(&state, 0.4, -30.0);
        for (row, exact) in exact.iter().enumerate() {
            let difference =
                (after(duration + step)[row] - after(duration - step)[row]) / (2.0 * step);
            assert!(
                (difference - exact).abs() < 1e-5 * natural_of(&mode),
                "{row}"
            );
        }
        let functional = [0.2, 0.5, -1.0, 0.1];
        let value: f64 = functional
            .iter()
            .zip(after(duration))
            .map(|(w, v)| w * v)
            .sum();
        let (before, by_acceleration, by_jerk) =
            Transition::new(&mode, duration).pulled_back(&functional);
        let pulled: f64 = before.iter().zip(state).map(|(w, v)| w * v).sum::<f64>()
            + by_acceleration * 0.4
            + by_jerk * -30.0;
        assert!((value - pulled).abs() < 1e-13, "{value} {pulled}");
    }

    fn natural_of(mode: &Mode) -> f64 {
        mode.natural()
    }
}
