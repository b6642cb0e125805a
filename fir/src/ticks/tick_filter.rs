//! Filters commanded positions by moving sums of integers, tick by tick.
//!
//! Source: equation 4.35, on commanded positions instead of velocities and in integers, so that
//! nothing drifts: a sum gains what enters and loses what leaves, exactly, and is divided once, at the
//! output. Sums over ticks alone are not quite moving averages over time; the Eulerian weights of the
//! last few commands, ours, make them so, and the output is that of the closed form at every tick. Not
//! here: when pulses begin.

use crate::error::FirError;
use crate::filter::chain::FilterChain;
use crate::ticks::tick_pulse::TICK_ROUNDING;
use core::ops::{AddAssign, Mul, Sub};
use toolglide_kinematics::SamplePeriod;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// Largest position, units: a kilometre in nm. Commands beyond it are held there.
const MAX_UNITS: i64 = 1 << 40;

/// Largest divisor with which the sums of such positions fit in 64 bits.
const MAX_SHORT: i128 = 1 << 22;

/// Largest divisor with which they fit in 128 bits.
const MAX_LONG: i128 = 1 << 86;

/// Most ticks that all filters hold together: some seconds at 100 kHz.
const MAX_TICKS: usize = 1 << 20;

/// Moving averages of the commanded positions of `N` axes, one tick after the other.
///
/// Positions are integers in a unit of the caller's choice, such as 1 nm, up to 2^40 of them.
/// Commands are positions at the end of each tick; in between, the command is straight. The output is
/// the filtered position at the end of the same tick, rounded to the nearest unit; it lands exactly on
/// a command that stays. After construction nothing is allocated.
///
/// # Examples
/// ```
/// use toolglide_fir::{FilterChain, TickFilter};
/// use toolglide_kinematics::SamplePeriod;
/// let chain = FilterChain::with_time_constants(&[0.003, 0.002])?;
/// let mut filter = TickFilter::new(&chain, SamplePeriod::new(0.001)?, [0_i64])?;
/// let positions: Vec<_> = (0..6).map(|_| filter.tick([3600])[0]).collect();
/// assert_eq!(positions, [100, 700, 1800, 2900, 3500, 3600]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct TickFilter<const N: usize> {
    sums: Sums<N>,
    ticks: usize,
}

/// Sums as wide as they must be.
#[derive(Clone, Debug)]
enum Sums<const N: usize> {
    Short {
        cascade: Cascade<i64, N>,
        divisor: i64,
        /// 2^64 by the divisor, rounded down.
        reciprocal: i128,
    },
    Long {
        cascade: Cascade<i128, N>,
        divisor: i128,
    },
}

/// The weights and the moving sums behind them.
#[derive(Clone, Debug)]
struct Cascade<T, const N: usize> {
    weights: Vec<T>,
    /// The last commands, the newest first.
    recent: Vec<[T; N]>,
    stages: Vec<Stage<T, N>>,
}

/// One moving sum.
#[derive(Clone, Debug)]
struct Stage<T, const N: usize> {
    window: Vec<[T; N]>,
    next: usize,
    sum: [T; N],
}

impl<const N: usize> TickFilter<N> {
    /// Filters at rest at `start`, each as many ticks long as its time constant, rounded.
    ///
    /// # Errors
    /// [`FirError::PeriodTooLong`] for a filter that is shorter than half a tick,
    /// [`FirError::TooManyTicks`] for filters too long for their sums.
    pub fn new(
        chain: &FilterChain,
        period: SamplePeriod,
        start: [i64; N],
    ) -> Result<Self, FirError> {
        let lengths = chain
            .time_constants()
            .iter()
            .map(|&time_constant| ticks_of(time_constant, period))
            .collect::<Result<Vec<usize>, _>>()?;
        let ticks: usize = lengths.iter().sum();
        let weights = eulerian(lengths.len());
        let mut divisor: i128 = weights.iter().sum();
        for &length in &lengths {
            divisor = divisor.saturating_mul(length as i128);
        }
        if ticks > MAX_TICKS || divisor > MAX_LONG {
            return Err(FirError::TooManyTicks {
                ticks,
                most: MAX_TICKS,
            });
        }
        let start = start.map(within);
        let sums = if divisor <= MAX_SHORT {
            let weights = weights.iter().map(|&weight| narrowed(weight)).collect();
            let divisor = narrowed(divisor);
            Sums::Short {
                cascade: Cascade::resting(weights, &lengths, start),
                divisor,
                reciprocal: (1_i128 << 64) / i128::from(divisor),
            }
        } else {
            Sums::Long {
                cascade: Cascade::resting(weights, &lengths, start.map(i128::from)),
                divisor,
            }
        };
        Ok(Self { sums, ticks })
    }

    /// Takes the commanded positions at the end of the next tick and gives the filtered ones.
    #[inline]
    pub fn tick(&mut self, command: [i64; N]) -> [i64; N] {
        match &mut self.sums {
            Sums::Short {
                cascade,
                divisor,
                reciprocal,
            } => {
                let (divisor, reciprocal) = (*divisor, *reciprocal);
                cascade
                    .tick(command.map(within))
                    .map(|sum| quotient(sum + divisor / 2, divisor, reciprocal))
            }
            Sums::Long { cascade, divisor } => {
                let divisor = *divisor;
                cascade
                    .tick(command.map(|position| i128::from(within(position))))
                    .map(|sum| narrowed((sum + divisor / 2).div_euclid(divisor)))
            }
        }
    }

    /// Ticks until a command that stays is reached: the sum of the lengths of the filters.
    #[must_use]
    pub fn settling_ticks(&self) -> usize {
        self.ticks
    }

    /// Ticks to wait between two pulses that may overlap by `overlap` seconds: the sum of the lengths
    /// less the overlap, which is rounded down.
    ///
    /// # Source
    /// Section 4.3; one tick less for each filter, as a sum over ticks alone would suggest, breaks the
    /// tolerance.
    ///
    /// # Errors
    /// [`FirError::NotPositive`] for an overlap that is negative, infinite or NaN.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the overlap is not negative, and a cast of a long one saturates"
    )]
    pub fn dwell_ticks(&self, overlap: f64, period: SamplePeriod) -> Result<usize, FirError> {
        if !(overlap >= 0.0 && overlap.is_finite()) {
            return Err(FirError::NotPositive {
                quantity: "overlap",
                value: overlap,
            });
        }
        let overlapping = (overlap / period.seconds() + TICK_ROUNDING) as usize;
        Ok(self.ticks.saturating_sub(overlapping))
    }
}

impl<T, const N: usize> Cascade<T, N>
where
    T: Copy + Default + AddAssign + Sub<Output = T> + Mul<Output = T>,
{
    /// Sums of a command that has always been `start`.
    fn resting(weights: Vec<T>, lengths: &[usize], start: [T; N]) -> Self {
        let recent = vec![start; weights.len()];
        let mut value = weighted(&weights, &recent);
        let mut stages = Vec::with_capacity(lengths.len());
        for &length in lengths {
            let window = vec![value; length];
            let mut sum = [T::default(); N];
            for held in &window {
                for axis in 0..N {
                    sum[axis] += held[axis];
                }
            }
            value = sum;
            stages.push(Stage {
                window,
                next: 0,
                sum,
            });
        }
        Self {
            weights,
            recent,
            stages,
        }
    }

    #[inline]
    fn tick(&mut self, command: [T; N]) -> [T; N] {
        let mut newer = command;
        for held in &mut self.recent {
            core::mem::swap(held, &mut newer);
        }
        let mut value = weighted(&self.weights, &self.recent);
        for stage in &mut self.stages {
            let leaving = &mut stage.window[stage.next];
            for axis in 0..N {
                stage.sum[axis] += value[axis] - leaving[axis];
            }
            *leaving = value;
            stage.next += 1;
            if stage.next == stage.window.len() {
                stage.next = 0;
            }
            value = stage.sum;
        }
        value
    }
}

#[inline]
fn weighted<T, const N: usize>(weights: &[T], recent: &[[T; N]]) -> [T; N]
where
    T: Copy + Default + AddAssign + Mul<Output = T>,
{
    let mut value = [T::default(); N];
    for (weight, held) in weights.iter().zip(recent) {
        for axis in 0..N {
            value[axis] += *weight * held[axis];
        }
    }
    value
}

/// Weights of the last commands: a straight command, averaged over one tick for each filter, at the
/// end of ticks. They are the Eulerian numbers and add up to the factorial of one more than the filters.
fn eulerian(filters: usize) -> Vec<i128> {
    let mut row = vec![1_i128];
    for order in 2..=filters + 1 {
        let mut next = vec![1_i128; order];
        for index in 1..order - 1 {
            let (left, right) = (row[index - 1], row[index]);
            next[index] = (order - index) as i128 * left + (index + 1) as i128 * right;
        }
        row = next;
    }
    row
}

/// A sum by its divisor, rounded down: the reciprocal is off by one at most.
#[inline]
#[allow(
    clippy::cast_possible_truncation,
    reason = "a quotient of a 64-bit sum is one"
)]
fn quotient(sum: i64, divisor: i64, reciprocal: i128) -> i64 {
    let near = ((i128::from(sum) * reciprocal) >> 64) as i64;
    let rest = sum - near * divisor;
    if rest < 0 {
        near - 1
    } else if rest >= divisor {
        near + 1
    } else {
        near
    }
}

#[inline]
fn within(position: i64) -> i64 {
    position.clamp(-MAX_UNITS, MAX_UNITS)
}

#[inline]
#[allow(
    clippy::cast_possible_truncation,
    reason = "only for what was checked to fit"
)]
fn narrowed(value: i128) -> i64 {
    value as i64
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "at least one, and a cast of a large one saturates"
)]
fn ticks_of(time_constant: f64, period: SamplePeriod) -> Result<usize, FirError> {
    let ticks = (time_constant / period.seconds()).round();
    if ticks < 1.0 {
        return Err(FirError::PeriodTooLong {
            period: period.seconds(),
            time_constant,
        });
    }
    Ok((ticks as usize).min(MAX_TICKS + 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PulseTrain, TickPulse};
    use toolglide_kinematics::Vector;

    const PERIOD: f64 = 0.001;

    fn period() -> SamplePeriod {
        SamplePeriod::new(PERIOD).unwrap()
    }

    fn chain(lengths: &[f64]) -> FilterChain {
        FilterChain::with_time_constants(lengths).unwrap()
    }

    /// A right-angle corner, tick by tick and in closed form; gives the largest gap in units.
    #[allow(clippy::cast_precision_loss, reason = "below 2^53")]
    fn gap(lengths: &[f64], overlap: f64) -> f64 {
        let filters = chain(lengths);
        let mut ticks = TickFilter::new(&filters, period(), [-7_i64, 5]).unwrap();
        let mut train = PulseTrain::starting_at(Vector::<2>::new(-7.0, 5.0), filters);
        let dwell = ticks.dwell_ticks(overlap, period()).unwrap();
        let mut at = [-7, 5];
        let mut outputs = Vec::new();
        for (corner, count) in [([40_000_123_i64, -11], 500), ([39_999_001, 25_000_000], 37)] {
            let duration = PERIOD * f64::from(count);
            let waits = if outputs.is_empty() { 0 } else { dwell };
            outputs.extend((0..waits).map(|_| ticks.tick(at)));
            let pulse = TickPulse::new(at, corner, duration, period()).unwrap();
            outputs.extend(pulse.map(|command| ticks.tick(command)));
            let end = Vector::<2>::from(corner.map(|unit| unit as f64));
            let feedrate = (end - train.end()).norm() / duration;
            train.line_to(end, feedrate, PERIOD * waits as f64).unwrap();
            at = corner;
        }
        let settling = ticks.settling_ticks();
        outputs.extend((0..settling).map(|_| ticks.tick(at)));
        assert_eq!(outputs.last(), Some(&at), "it lands");
        let mut worst = 0.0_f64;
        for (output, tick) in outputs.iter().zip(1_u32..) {
            let exact = train.position(PERIOD * f64::from(tick));
            for axis in 0..2 {
                worst = worst.max((output[axis] as f64 - exact[axis]).abs());
            }
        }
        worst
    }

    #[test]
    fn ticks_and_closed_form_agree_to_one_unit() {
        for lengths in [
            &[0.05, 0.03][..],
            &[0.08],
            &[0.05, 0.05],
            &[0.03, 0.02, 0.01],
            &[0.3, 0.2, 0.1, 0.07, 0.05],
        ] {
            for overlap in [0.0, 0.0304, 0.06] {
                let worst = gap(lengths, overlap);
                assert!(worst <= 1.0, "{lengths:?}, {overlap} s: {worst} units");
            }
        }
    }

    #[test]
    fn six_million_ticks_end_exactly_where_they_should() {
        let mut ticks = TickFilter::new(&chain(&[0.05, 0.03]), period(), [0_i64; 3]).unwrap();
        let mut at = [0_i64; 3];
        let mut count = 0_u32;
        let mut step = 1_i64;
        while count < 6_000_000 {
            step = (step * 48_271) % 2_147_483_647;
            let to = [step % 100_003, -step % 70_001, at[2] + step % 11 - 5];
            for command in TickPulse::new(at, to, 0.3, period()).unwrap() {
                ticks.tick(command);
                count += 1;
            }
            at = to;
        }
        let mut last = [0; 3];
        for _ in 0..ticks.settling_ticks() {
            last = ticks.tick(at);
        }
        assert_eq!(last, at, "after {count} ticks");
    }

    #[test]
    fn division_by_reciprocal_rounds_down() {
        for divisor in [1, 2, 3, 6, 7, 36_000, 4_194_303, 4_194_304_i64] {
            let reciprocal = (1_i128 << 64) / i128::from(divisor);
            for sum in [0, 1, 5, 35_999, 1 << 40, (1 << 62) - 1, (1 << 61) + 12_345] {
                for signed in [sum, -sum] {
                    assert_eq!(
                        quotient(signed, divisor, reciprocal),
                        signed.div_euclid(divisor),
                        "{signed} / {divisor}"
                    );
                }
            }
        }
    }

    #[test]
    fn moves_shorter_than_a_tick_and_filters_too_long_are_refused() {
        assert!(
            matches!(
                TickPulse::new([0], [5], 0.000_9, period()),
                Err(FirError::ShorterThanTick { .. })
            ),
            "shorter than a tick"
        );
        for duration in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(
                matches!(
                    TickPulse::new([0], [5], duration, period()),
                    Err(FirError::NotPositive { .. })
                ),
                "{duration}"
            );
        }
        assert!(
            matches!(
                TickFilter::new(&chain(&[0.000_4]), period(), [0]),
                Err(FirError::PeriodTooLong { .. })
            ),
            "nothing is left"
        );
        assert!(
            matches!(
                TickFilter::new(&chain(&[5.0]), SamplePeriod::new(1e-6).unwrap(), [0]),
                Err(FirError::TooManyTicks { .. })
            ),
            "too long"
        );
        assert_eq!(
            TickPulse::new([0], [5], 0.009, period()).unwrap().count(),
            9,
            "nine ticks, although 0.009 / 0.001 is a little less in binary"
        );
    }
}
