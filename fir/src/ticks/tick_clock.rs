//! Slows the commands down in front of the filters, tick by tick in integers.
//!
//! Source: ours. Behind the first moving average acceleration is a difference of two commanded velocities one time
//! constant apart. Of velocities that keep that difference within a bound with each other and with rest, any shares
//! between 0 and 1 keep it, too: of equal signs the larger counts, of opposite signs both become smaller. So the rate may
//! jump at every tick. Staircases of feedrate are excepted: there a rest is not nearby. Not here: the filters.

/// The clock of commanded positions: it takes the next one of them when its time has come.
///
/// Time passes at a rate from 0 to [`TickClock::FULL`], which may be another one at every tick. At full rate the positions
/// are those that are taken, to the bit. At rate 0 they stay, and the filtered motion is at rest after the sum of the
/// filters.
///
/// # Examples
/// ```
/// use toolglide_fir::TickClock;
/// let mut commands = [[100_i64], [200], [300]].into_iter();
/// let mut clock = TickClock::new([0_i64]);
/// let half = TickClock::<1>::FULL / 2;
/// let positions: Vec<_> = [half, half, 0, TickClock::<1>::FULL, half]
///     .map(|rate| clock.tick(rate, || commands.next())[0])
///     .to_vec();
/// assert_eq!(positions, [50, 100, 100, 200, 250]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TickClock<const N: usize> {
    from: [i64; N],
    to: [i64; N],
    /// Share of the way from one to the other, of [`TickClock::FULL`].
    phase: u32,
}

impl<const N: usize> TickClock<N> {
    /// The rate at which time passes as planned.
    pub const FULL: u32 = 1 << 20;

    /// A clock of commands that begin at a position.
    #[must_use]
    pub fn new(start: [i64; N]) -> Self {
        Self {
            from: start,
            to: start,
            phase: Self::FULL,
        }
    }

    /// The commanded position at the end of the next tick, at a rate of [`TickClock::FULL`]; a larger one counts as that.
    ///
    /// `next` gives the commanded position at the end of the next tick at full rate, or `None` while there is none.
    #[inline]
    pub fn tick(&mut self, rate: u32, next: impl FnOnce() -> Option<[i64; N]>) -> [i64; N] {
        self.phase += rate.min(Self::FULL);
        if self.phase > Self::FULL {
            match next() {
                Some(position) => {
                    self.from = self.to;
                    self.to = position;
                    self.phase -= Self::FULL;
                }
                None => self.phase = Self::FULL,
            }
        }
        if self.phase == Self::FULL {
            return self.to;
        }
        let mut at = self.from;
        for (axis, position) in at.iter_mut().enumerate() {
            let way = i128::from(self.to[axis]) - i128::from(*position);
            let passed = (way * i128::from(self.phase)).div_euclid(i128::from(Self::FULL));
            *position = position.saturating_add(narrowed(passed));
        }
        at
    }

    /// The rate for an override, where the commands are planned for the greatest one; 0 for no number.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of a small number, and a cast saturates"
    )]
    pub fn rate(value: f64, greatest: f64) -> u32 {
        ((value / greatest).clamp(0.0, 1.0) * f64::from(Self::FULL)) as u32
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "a share of a distance between two positions, which saturates where it is used"
)]
fn narrowed(value: i128) -> i64 {
    value as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FilterChain, TickFilter, TickPulse};
    use toolglide_kinematics::SamplePeriod;

    /// mm in units of 1 nm.
    const MM: i64 = 1_000_000;

    /// Largest acceleration and jerk by differences, mm/s^2 and mm/s^3, distance from a right-angle corner of 10 mm legs,
    /// mm, and ticks from the hold to rest, of a motion whose rate is given at every tick.
    #[allow(clippy::cast_precision_loss, reason = "below 2^53")]
    fn moved(rate: impl Fn(usize) -> u32) -> (f64, f64, f64, Vec<[i64; 2]>) {
        let h = 1e-4;
        let period = SamplePeriod::new(h).unwrap();
        let chain = FilterChain::with_time_constants(&[0.05, 0.03]).unwrap();
        let mut filter = TickFilter::new(&chain, period, [0_i64; 2]).unwrap();
        let dwell = filter.dwell_ticks(0.045, period).unwrap();
        let corner = [10 * MM, 0];
        let mut commands = TickPulse::new([0; 2], corner, 0.1, period)
            .unwrap()
            .chain(core::iter::repeat_n(corner, dwell))
            .chain(TickPulse::new(corner, [10 * MM, 10 * MM], 0.1, period).unwrap());
        let mut clock = TickClock::new([0_i64; 2]);
        let mut path = vec![[0_i64; 2]; 3];
        for tick in 0..30_000 {
            path.push(filter.tick(clock.tick(rate(tick), || commands.next())));
        }
        let difference =
            |k: usize, axis: usize| (path[k][axis] - path[k - 1][axis]) as f64 / MM as f64 / h;
        let (mut a, mut j, mut off) = (0.0_f64, 0.0_f64, 0.0_f64);
        // Over ten ticks, so that rounding to 1 nm is small.
        let v =
            |k: usize, axis: usize| (0..10).map(|i| difference(k + i, axis)).sum::<f64>() / 10.0;
        for k in 1..path.len() - 40 {
            for axis in 0..2 {
                let [v0, v1, v2] = [0, 10, 20].map(|i| v(k + i, axis));
                a = a.max((v1 - v0).abs() / (10.0 * h));
                j = j.max((v2 - 2.0 * v1 + v0).abs() / (100.0 * h * h));
            }
        }
        for place in &path[1..path.len() - 40] {
            let [x, y] = place.map(|unit| unit as f64 / MM as f64);
            off = off.max(y.abs().min((10.0 - x).abs()));
        }
        (a, j, off, path)
    }

    #[test]
    fn at_full_rate_the_commands_pass_unchanged() {
        let full = moved(|_| TickClock::<2>::FULL);
        let more = moved(|_| u32::MAX >> 1);
        assert_eq!(full.3, more.3, "more than full is full");
        assert_eq!(full.3.last(), Some(&[10 * MM, 10 * MM]), "it lands");
    }

    #[test]
    fn a_rate_that_jumps_at_every_tick_keeps_limits_and_tolerance() {
        let (_, _, off, _) = moved(|_| TickClock::<2>::FULL);
        let full = TickClock::<2>::FULL;
        let noise = |tick: usize| (tick as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
        let operators: [&dyn Fn(usize) -> u32; 4] = [
            &|tick| u32::try_from(noise(tick) % u64::from(full)).unwrap(),
            &|tick| if (tick / 50) % 2 == 0 { full } else { 0 },
            &|tick| if (tick / 500) % 2 == 0 { full } else { 0 },
            &|tick| if (tick / 300) % 2 == 0 { full } else { 0 },
        ];
        for (index, operator) in operators.iter().enumerate() {
            let (a, j, with, path) = moved(operator);
            // 100 mm/s by 0.05 s, and twice that by 0.03 s; positions in nm leave a thousandth of the differences over
            // 1 ms, and of those of third order four of them.
            assert!(a <= 2000.0 * 1.001, "{index}: {a} mm/s^2");
            assert!(j <= 133_334.0 + 4e3, "{index}: {j} mm/s^3");
            assert!(
                with <= off + 1e-4,
                "{index}: {with} mm, at full rate {off} mm"
            );
            assert_eq!(path.last(), Some(&[10 * MM, 10 * MM]), "{index} lands");
        }
    }

    #[test]
    fn a_hold_is_over_after_the_sum_of_the_filters() {
        for at in [200, 700, 1000, 1300] {
            let (_, _, _, path) = moved(|tick| if tick < at { TickClock::<2>::FULL } else { 0 });
            let rest = path.last().copied();
            let last = path.iter().rposition(|&place| Some(place) != rest).unwrap();
            // Three places stand before the first tick.
            assert!(last <= 3 + at + 800, "hold at {at}: moves until {last}");
        }
    }
}
