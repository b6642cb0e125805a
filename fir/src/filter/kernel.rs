//! Evaluates the response of a chain to a step of velocity, at any time, and its inverse.
//!
//! Source: equations 4.3 to 4.7, replaced by one formula for any number of filters and every order
//! of durations: the sum over all subsets of the filters of truncated powers. Not here: moves.

use crate::filter::chain::FilterChain;
use toolglide_kinematics::nalgebra::Complex;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// Relative precision of the inverse, dimensionless: a few roundings.
const INVERSE_PRECISION: f64 = 4.0 * f64::EPSILON;

/// Most steps of the inverse; Newton needs about five, and bisection takes over where it stalls.
const INVERSE_STEPS: u32 = 100;

/// Angles below this are summed as a series, rad: above it the closed form loses fewer digits.
const SERIES_ANGLE: f64 = 2.0;

/// Terms of that series: the next one is below the rounding for angles up to [`SERIES_ANGLE`].
const SERIES_TERMS: u32 = 30;

impl FilterChain {
    /// Filtered position, `time` after the commanded velocity has stepped from 0 to 1.
    ///
    /// Convex; 0 before the step, `time - total_delay / 2` exactly once the step has passed.
    ///
    /// # Source
    /// `q`, the second integral of the kernel.
    #[must_use]
    pub fn position(&self, time: f64) -> f64 {
        let (total, half) = (self.total_delay(), 0.5 * self.total_delay());
        if time <= half {
            self.truncated(time, 0)
        } else {
            time - half + self.truncated(total - time, 0)
        }
    }

    /// Filtered velocity, `time` after the commanded velocity has stepped from 0 to 1.
    ///
    /// # Source
    /// `H`, the first integral of the kernel.
    #[must_use]
    pub fn velocity(&self, time: f64) -> f64 {
        let total = self.total_delay();
        if time <= 0.5 * total {
            self.truncated(time, 1)
        } else {
            1.0 - self.truncated(total - time, 1)
        }
    }

    /// Acceleration, `time` after the commanded velocity has stepped from 0 to 1: the kernel itself.
    ///
    /// # Source
    /// `h`, the convolution of the moving averages.
    #[must_use]
    pub fn acceleration(&self, time: f64) -> f64 {
        self.truncated(time.min(self.total_delay() - time), 2)
    }

    /// Jerk, `time` after the commanded velocity has stepped from 0 to 1; 0 for a single filter,
    /// whose jerk has no size. At an instant of change it is that of the time after.
    ///
    /// # Source
    /// `h'`, the slope of the kernel.
    #[must_use]
    pub fn jerk(&self, time: f64) -> f64 {
        if self.time_constants().len() < 2 {
            return 0.0;
        }
        let total = self.total_delay();
        if time <= 0.5 * total {
            self.truncated(time, 3)
        } else {
            -self.truncated(total - time, 3)
        }
    }

    /// Position, velocity, acceleration and jerk at once, `time` after the commanded velocity has stepped
    /// from 0 to 1.
    ///
    /// # Source
    /// As each by itself.
    #[must_use]
    pub fn state(&self, time: f64) -> [f64; 4] {
        let (total, half) = (self.total_delay(), 0.5 * self.total_delay());
        if time <= 0.0 {
            [0.0; 4]
        } else if time <= half {
            self.truncated_state(time)
        } else if time < total {
            let [position, velocity, acceleration, jerk] = self.truncated_state(total - time);
            [time - half + position, 1.0 - velocity, acceleration, -jerk]
        } else {
            [time - half, 1.0, 0.0, 0.0]
        }
    }

    /// The time at which [`position`](Self::position) reaches `position`; 0 for 0 or less.
    ///
    /// # Source
    /// `q` is convex, so Newton's method is safe; ours.
    #[must_use]
    pub fn time_to(&self, position: f64) -> f64 {
        let total = self.total_delay();
        if position.is_nan() || position <= 0.0 {
            return 0.0;
        }
        if position >= 0.5 * total {
            return position + 0.5 * total;
        }
        // The first power alone is more than the sum, so the root lies beyond its inverse.
        let order = self.time_constants().len() + 1;
        let (mut power, mut exponent) = (position * self.product(), 0.0);
        for _ in 0..order {
            exponent += 1.0;
            power *= exponent;
        }
        let mut low = power.powf(1.0 / exponent).min(total);
        let mut high = total;
        let mut time = low;
        for _ in 0..INVERSE_STEPS {
            let excess = self.position(time) - position;
            if excess > 0.0 {
                high = time;
            } else {
                low = time;
            }
            let slope = self.velocity(time);
            let mut next = time - excess / slope;
            if !(next >= low && next <= high) {
                next = 0.5 * (low + high);
            }
            if (next - time).abs() <= INVERSE_PRECISION * time {
                return next;
            }
            time = next;
        }
        time
    }

    /// Filtered integral of `exp(i w t)` begun at time 0, where `w` is an angular velocity, rad/s:
    /// a rotation that starts. With a whole turn behind it, it goes round a circle of radius
    /// `gain / w`, in s.
    ///
    /// # Source
    /// `W`; section 4.2.3, whose equation 4.14 knows the steady circle alone.
    #[must_use]
    pub fn rotation(&self, time: f64, angular_velocity: f64) -> Complex<f64> {
        let total = self.total_delay();
        let w = Complex::new(0.0, angular_velocity);
        if time >= total && angular_velocity.abs() * total > SERIES_ANGLE {
            let late = Complex::new(0.0, angular_velocity * (time - 0.5 * total));
            return (late.exp() * self.gain(angular_velocity) - Complex::new(1.0, 0.0)) / w;
        }
        let order = self.time_constants().len() + 1;
        let mut sum = Complex::new(0.0, 0.0);
        for &(shift, sign) in &self.shifts {
            if shift >= time {
                break;
            }
            sum += rotation_integral(time - shift, w, order) * sign;
        }
        sum / self.product()
    }

    /// The sum over all subsets, of the order that `derivative` leaves; 0 for negative times.
    fn truncated(&self, time: f64, derivative: u32) -> f64 {
        let filters = self.time_constants().len();
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_possible_wrap,
            reason = "there are at most eight filters"
        )]
        let power = filters as i32 + 1 - derivative as i32;
        let mut factorial = 1.0;
        for factor in 2..=power {
            factorial *= f64::from(factor);
        }
        let mut sum = 0.0;
        for &(shift, sign) in &self.shifts {
            if shift >= time {
                break;
            }
            sum += sign * (time - shift).powi(power);
        }
        sum / (factorial * self.product())
    }
}

impl FilterChain {
    /// The sums over all subsets of all orders, from the position to the jerk.
    fn truncated_state(&self, time: f64) -> [f64; 4] {
        let filters = self.time_constants().len();
        let mut state = [0.0; 4];
        for &(shift, sign) in &self.shifts {
            if shift >= time {
                break;
            }
            // Powers from 0 on, each over its factorial.
            let mut part = sign;
            let mut divisor = 0.0;
            for power in 0..=filters + 1 {
                let derivative = filters + 1 - power;
                if derivative < 4 {
                    state[derivative] += part;
                }
                divisor += 1.0;
                part *= (time - shift) / divisor;
            }
        }
        state.map(|sum| sum / self.product())
    }
}

/// The integral of `exp(w t)` from 0 on, taken `order` times.
fn rotation_integral(time: f64, w: Complex<f64>, order: usize) -> Complex<f64> {
    let z = w * time;
    let mut term = Complex::new(1.0, 0.0);
    let mut index = 0.0;
    if z.re.hypot(z.im) < SERIES_ANGLE {
        for _ in 0..order {
            index += 1.0;
            term *= time / index;
        }
        let mut sum = term;
        for _ in 0..SERIES_TERMS {
            index += 1.0;
            term *= z / index;
            sum += term;
        }
        return sum;
    }
    let mut sum = Complex::new(0.0, 0.0);
    let mut scale = Complex::new(1.0, 0.0);
    for _ in 0..order {
        sum += term;
        index += 1.0;
        term *= z / index;
        scale *= w;
    }
    (z.exp() - sum) / scale
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn chain(lengths: &[f64]) -> FilterChain {
        FilterChain::with_time_constants(lengths).unwrap()
    }

    fn close(ours: f64, golden: f64, what: &str) {
        assert!(
            (ours - golden).abs() <= 1e-12 * golden.abs(),
            "{what}: {ours} is not {golden}"
        );
    }

    #[test]
    fn values_computed_by_other_means_are_met() {
        let two = chain(&[0.1, 0.06]);
        for (time, golden) in [
            (0.01, 2.777777777777777e-5),
            (0.05, 3.472222222222222e-3),
            (0.06, 6e-3),
            (0.08, 1.4e-2),
            (0.1, 2.6e-2),
            (0.13, 5.075e-2),
            (0.16, 8e-2),
            (0.2, 0.12),
        ] {
            close(two.position(time), golden, "position");
        }
        close(two.velocity(0.05), 0.2083333333333333, "velocity");
        close(two.velocity(0.13), 0.925, "velocity");
        close(two.acceleration(0.08), 10.0, "acceleration");
        for (position, golden) in [
            (1e-5, 7.113786608980e-3),
            (1e-3, 3.301927248895e-2),
            (0.02, 9.082762530298e-2),
            (0.079, 0.1589999722199),
        ] {
            close(two.time_to(position), golden, "time");
        }
        let three = chain(&[0.03, 0.1, 0.06]);
        close(three.position(0.05), 1.409722222222e-3, "three filters");
        close(three.position(0.12), 2.996296296296e-2, "three filters");
        close(three.velocity(0.095), 0.5, "three filters");
        for (time, real, imaginary) in [
            (0.1, 0.02565838958781, 0.00335464539884),
            (0.2, 0.11133721365191, 0.03725884604603),
        ] {
            let rotation = two.rotation(time, 5.0);
            close(rotation.re, real, "rotation");
            close(rotation.im, imaginary, "rotation");
        }
    }

    #[test]
    fn a_circle_that_has_lasted_is_smaller_by_the_gain_and_late_by_half_the_delay() {
        let two = chain(&[0.1, 0.06]);
        for w in [5.0, 60.0, -60.0] {
            let steady = (Complex::new(0.0, w * (0.3 - 0.08)).exp() * two.gain(w)
                - Complex::new(1.0, 0.0))
                / Complex::new(0.0, w);
            assert!((two.rotation(0.3, w) - steady).norm() < 1e-14, "{w} rad/s");
        }
    }

    /// The moving averages applied one after the other, numerically.
    fn by_force(lengths: &[f64], time: f64) -> f64 {
        match lengths {
            [] => time.max(0.0),
            [first, rest @ ..] => {
                let parts = if rest.is_empty() { 2000 } else { 60 };
                (0..parts)
                    .map(|part| (f64::from(part) + 0.5) / f64::from(parts))
                    .map(|share| by_force(rest, time - share * first))
                    .sum::<f64>()
                    / f64::from(parts)
            }
        }
    }

    #[test]
    fn the_formula_is_the_average_of_averages() {
        for lengths in [&[0.1][..], &[0.1, 0.06], &[0.03, 0.1, 0.02]] {
            let filters = chain(lengths);
            for time in [0.005, 0.03, 0.07, 0.1, 0.14, 0.3] {
                let gap = filters.position(time) - by_force(lengths, time);
                assert!(gap.abs() < 1e-5, "{lengths:?} at {time}: {gap}");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn each_response_is_the_slope_of_the_one_before(
            lengths in prop::collection::vec(0.01..0.2_f64, 1..6),
            share in -0.2..1.2_f64,
        ) {
            let filters = chain(&lengths);
            let time = share * filters.total_delay();
            let step = 1e-6;
            let slope = |of: fn(&FilterChain, f64) -> f64| {
                (of(&filters, time + step) - of(&filters, time - step)) / (2.0 * step)
            };
            let scale = filters.acceleration(0.5 * filters.total_delay());
            prop_assert!((slope(FilterChain::position) - filters.velocity(time)).abs() < 1e-4);
            prop_assert!(
                (slope(FilterChain::velocity) - filters.acceleration(time)).abs() < 1e-3 * scale
                    || lengths.len() == 1
            );
        }

        #[test]
        fn all_responses_at_once_are_those_one_by_one(
            lengths in prop::collection::vec(0.01..0.2_f64, 1..6),
            share in -0.2..1.2_f64,
        ) {
            let filters = chain(&lengths);
            let time = share * filters.total_delay();
            let state = filters.state(time);
            let each = [
                filters.position(time),
                filters.velocity(time),
                filters.acceleration(time),
                filters.jerk(time),
            ];
            for (at_once, alone) in state.into_iter().zip(each) {
                prop_assert!((at_once - alone).abs() <= 1e-9 * alone.abs().max(1.0), "{at_once} is not {alone}");
            }
        }

        #[test]
        fn the_inverse_undoes_the_position(
            lengths in prop::collection::vec(0.01..0.2_f64, 1..6),
            exponent in -9.0..0.0_f64,
        ) {
            let filters = chain(&lengths);
            let position = 10.0_f64.powf(exponent);
            let again = filters.position(filters.time_to(position));
            prop_assert!((again / position - 1.0).abs() < 1e-11, "{position} became {again}");
        }

        #[test]
        fn the_kernel_is_even_about_half_the_delay(
            lengths in prop::collection::vec(0.01..0.2_f64, 2..8),
            share in 0.0..1.0_f64,
        ) {
            let filters = chain(&lengths);
            let total = filters.total_delay();
            let time = share * total;
            let scale = filters.acceleration(0.5 * total);
            prop_assert!((filters.acceleration(time) - filters.acceleration(total - time)).abs() < 1e-9 * scale);
            prop_assert!((filters.velocity(time) + filters.velocity(total - time) - 1.0).abs() < 1e-12);
        }
    }
}
