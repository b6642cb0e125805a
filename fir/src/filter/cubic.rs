//! Represents a chain as motion of constant jerk between knots: two filters exactly, the others as
//! a comb of delays.
//!
//! Source: section 4.2; two moving averages make a pulse piecewise constant in jerk. The comb is ours:
//! it is a kernel of its own, non-negative and even as that of the chain, so everything that is
//! proved of moving averages holds for it, and plans use its responses, not those of the chain.
//! Not here: moves.

use crate::error::FirError;
use crate::filter::chain::FilterChain;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// Teeth of the comb: the third filter and those after it differ from it in position by the square
/// of a tooth times the acceleration over 24, a tenth of a micrometre where parts are machined.
const TEETH: u32 = 32;

/// Most steps of the inverse.
const INVERSE_STEPS: u32 = 60;

/// A product of angular frequency and time constant below this leaves a filter without effect.
const NO_EFFECT: f64 = 1e-8;

/// Relative precision of the inverse, dimensionless.
const INVERSE_PRECISION: f64 = 1e-14;

/// One tooth of the comb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tooth {
    pub(crate) delay: f64,
    pub(crate) weight: f64,
}

/// The comb of a chain of two filters.
const NO_COMB: [Tooth; 1] = [Tooth {
    delay: 0.0,
    weight: 1.0,
}];

/// Two moving averages and a comb.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CubicChain {
    long: f64,
    short: f64,
    total: f64,
    /// One over twice the long one, and over twice the product of both.
    per_long: f64,
    per_product: f64,
    /// Empty for two filters, which then need no memory of their own.
    comb: Vec<Tooth>,
}

impl CubicChain {
    /// Two moving averages alone.
    pub(crate) fn of_two(long: f64, short: f64) -> Self {
        Self {
            long: long.max(short),
            short: short.min(long),
            total: long + short,
            per_long: 0.5 / long.max(short),
            per_product: 0.5 / (long * short),
            comb: Vec::new(),
        }
    }

    /// A chain of two filters and more.
    pub(crate) fn of(chain: &FilterChain) -> Result<Self, FirError> {
        let lengths = chain.time_constants();
        let &[long, short, ref rest @ ..] = lengths else {
            return Err(FirError::SingleFilter {
                time_constant: lengths[0],
            });
        };
        let mut two = Self::of_two(long, short);
        if rest.is_empty() {
            return Ok(two);
        }
        let rest = FilterChain::with_time_constants(rest)?;
        let width = rest.total_delay() / f64::from(TEETH);
        for tooth in 0..TEETH {
            let begin = f64::from(tooth) * width;
            let end = begin + width;
            let (low, high) = (rest.velocity(begin), rest.velocity(end));
            let weight = high - low;
            if weight <= 0.0 {
                continue;
            }
            // Centroid of the kernel over the tooth, by parts.
            let moment = end * high - begin * low - (rest.position(end) - rest.position(begin));
            two.comb.push(Tooth {
                delay: (moment / weight).clamp(begin, end),
                weight,
            });
        }
        // The comb begins with its first tooth and ends with its last.
        let first = two.comb.first().map_or(0.0, |tooth| tooth.delay);
        for tooth in &mut two.comb {
            tooth.delay -= first;
        }
        two.total += two.comb.last().map_or(0.0, |tooth| tooth.delay);
        Ok(two)
    }

    pub(crate) fn long(&self) -> f64 {
        self.long
    }

    pub(crate) fn short(&self) -> f64 {
        self.short
    }

    /// Length of the whole chain.
    pub(crate) fn total(&self) -> f64 {
        self.total
    }

    /// Variance of the kernel, s².
    pub(crate) fn variance(&self) -> f64 {
        let middle = 0.5 * (self.total - self.long - self.short);
        let comb: f64 = self
            .comb()
            .iter()
            .map(|tooth| tooth.weight * (tooth.delay - middle).powi(2))
            .sum();
        (self.long * self.long + self.short * self.short) / 12.0 + comb
    }

    /// Gain at an angular frequency, with its sign.
    pub(crate) fn gain(&self, angular_frequency: f64) -> f64 {
        let boxed = |length: f64| {
            let half = 0.5 * angular_frequency * length;
            if half.abs() < NO_EFFECT {
                1.0
            } else {
                half.sin() / half
            }
        };
        let middle = 0.5 * (self.total - self.long - self.short);
        let comb: f64 = self
            .comb()
            .iter()
            .map(|tooth| tooth.weight * (angular_frequency * (tooth.delay - middle)).cos())
            .sum();
        boxed(self.long) * boxed(self.short) * comb
    }

    pub(crate) fn comb(&self) -> &[Tooth] {
        if self.comb.is_empty() {
            &NO_COMB
        } else {
            &self.comb
        }
    }

    /// Position after a unit step of velocity.
    pub(crate) fn position(&self, time: f64) -> f64 {
        if time <= 0.0 {
            return 0.0;
        }
        if time >= self.total {
            return time - 0.5 * self.total;
        }
        self.over_comb(time, |two, since| two.position_of_two(since))
    }

    /// Velocity after a unit step of velocity.
    pub(crate) fn velocity(&self, time: f64) -> f64 {
        self.over_comb(time, |two, since| two.velocity_of_two(since))
    }

    /// Position and velocity after a unit step of velocity.
    pub(crate) fn response(&self, time: f64) -> (f64, f64) {
        if time <= 0.0 {
            return (0.0, 0.0);
        }
        if time >= self.total {
            return (time - 0.5 * self.total, 1.0);
        }
        if self.comb.is_empty() {
            return self.response_of_two(time);
        }
        (self.position(time), self.velocity(time))
    }

    /// Position and velocity behind the two longest filters, within their length.
    fn response_of_two(&self, time: f64) -> (f64, f64) {
        let (short, double) = (self.short, self.per_long);
        let rising = |t: f64| {
            if t <= short {
                let square = t * t * self.per_product;
                (t * square * (1.0 / 3.0), square)
            } else {
                let position = (t * (t - short) + short * short * (1.0 / 3.0)) * double;
                (position, (2.0 * t - short) * double)
            }
        };
        let total = self.long + short;
        if time <= 0.5 * total {
            rising(time)
        } else {
            let (position, velocity) = rising(total - time);
            (time - 0.5 * total + position, 1.0 - velocity)
        }
    }

    /// Acceleration after a unit step of velocity.
    pub(crate) fn acceleration(&self, time: f64) -> f64 {
        self.over_comb(time, |two, since| two.acceleration_of_two(since))
    }

    /// When the position reaches a value; 0 for 0 or less.
    pub(crate) fn time_to(&self, position: f64) -> f64 {
        let (long, short, total) = (self.long, self.short, self.total);
        if position.is_nan() || position <= 0.0 {
            return 0.0;
        }
        if position >= 0.5 * total {
            return position + 0.5 * total;
        }
        if self.comb.is_empty() {
            let cubic = (6.0 * long * short * position).cbrt();
            if cubic <= short {
                return cubic;
            }
            let square = 0.5 * short + (2.0 * long * position - short * short / 12.0).sqrt();
            if square <= long {
                return square;
            }
        }
        // Convex: from the right Newton stays on the right.
        let (mut low, mut high) = (0.0, total);
        let mut time = (6.0 * long * short * position)
            .cbrt()
            .clamp(0.5 * total, total);
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
            if (next - time).abs() <= INVERSE_PRECISION * total {
                return next;
            }
            time = next;
        }
        time
    }

    fn over_comb(&self, time: f64, response: impl Fn(&Self, f64) -> f64) -> f64 {
        if self.comb.is_empty() {
            return response(self, time);
        }
        self.comb
            .iter()
            .map(|tooth| tooth.weight * response(self, time - tooth.delay))
            .sum()
    }

    fn position_of_two(&self, time: f64) -> f64 {
        let (long, short) = (self.long, self.short);
        let total = long + short;
        let rising = |t: f64| {
            if t <= 0.0 {
                0.0
            } else if t <= short {
                t * t * t / (6.0 * long * short)
            } else {
                (3.0 * t * (t - short) + short * short) / (6.0 * long)
            }
        };
        if time <= 0.5 * total {
            rising(time)
        } else {
            time - 0.5 * total + rising(total - time)
        }
    }

    fn velocity_of_two(&self, time: f64) -> f64 {
        let (long, short) = (self.long, self.short);
        let total = long + short;
        let rising = |t: f64| {
            if t <= 0.0 {
                0.0
            } else if t <= short {
                t * t / (2.0 * long * short)
            } else {
                (2.0 * t - short) / (2.0 * long)
            }
        };
        if time <= 0.5 * total {
            rising(time)
        } else {
            1.0 - rising(total - time)
        }
    }

    fn acceleration_of_two(&self, time: f64) -> f64 {
        let t = time.min(self.long + self.short - time);
        if t <= 0.0 {
            0.0
        } else {
            t.min(self.short) / (self.long * self.short)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_filters_are_exact_and_more_are_near() {
        for (lengths, close) in [
            (&[0.1, 0.06][..], 1e-15),
            (&[0.1, 0.06, 0.03], 1e-6),
            (&[0.1, 0.06, 0.05, 0.02], 1e-5),
        ] {
            let chain = FilterChain::with_time_constants(lengths).unwrap();
            let cubic = CubicChain::of(&chain).unwrap();
            for step in -2..30 {
                let time = 0.01 * f64::from(step);
                let later = time + 0.5 * (chain.total_delay() - cubic.total());
                let gap = cubic.position(time) - chain.position(later);
                assert!(gap.abs() < close, "{lengths:?} at {time}: {gap}");
                let gap = cubic.velocity(time) - chain.velocity(later);
                assert!(gap.abs() < 1e3 * close, "{lengths:?} at {time}: {gap}");
                let position = cubic.position(time);
                let again = cubic.position(cubic.time_to(position));
                assert!((again - position).abs() < 1e-14, "inverse at {time}");
            }
        }
    }

    #[test]
    fn one_filter_has_no_bounded_jerk_and_is_refused() {
        let chain = FilterChain::with_time_constants(&[0.1]).unwrap();
        assert!(
            matches!(CubicChain::of(&chain), Err(FirError::SingleFilter { .. })),
            "one filter"
        );
    }
}
