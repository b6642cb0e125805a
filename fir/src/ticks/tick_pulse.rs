//! Commands a straight move as positions in integers, tick by tick.
//!
//! Source: equation 4.35 takes pulses of whole ticks; the feedrate is lowered for it, never the length.
//! Not here: the filters.

use crate::error::FirError;
use toolglide_kinematics::SamplePeriod;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// A duration may exceed a whole number of ticks by this share of a tick without taking another one.
pub(crate) const TICK_ROUNDING: f64 = 1e-9;

/// A straight move as commanded positions, tick by tick, which ends exactly.
///
/// The move takes a whole number of ticks, so that its feedrate is a little lower than asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TickPulse<const N: usize> {
    from: [i64; N],
    by: [i64; N],
    ticks: u32,
    tick: u32,
}

impl<const N: usize> TickPulse<N> {
    /// A move that lasts `duration` seconds or up to a tick longer.
    ///
    /// # Errors
    /// [`FirError::ShorterThanTick`] for a duration below a period, [`FirError::NotPositive`] for one that is
    /// not positive and finite, [`FirError::TooManyTicks`] for one of more than 2^31 ticks.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked before"
    )]
    pub fn new(
        from: [i64; N],
        to: [i64; N],
        duration: f64,
        period: SamplePeriod,
    ) -> Result<Self, FirError> {
        if !(duration > 0.0 && duration.is_finite()) {
            return Err(FirError::NotPositive {
                quantity: "duration",
                value: duration,
            });
        }
        let period = period.seconds();
        if duration < period * (1.0 - TICK_ROUNDING) {
            return Err(FirError::ShorterThanTick { duration, period });
        }
        let ticks = (duration / period - TICK_ROUNDING).ceil();
        if ticks > f64::from(i32::MAX) {
            return Err(FirError::TooManyTicks {
                ticks: ticks as usize,
                most: i32::MAX as usize,
            });
        }
        Ok(Self {
            from,
            by: core::array::from_fn(|axis| to[axis].wrapping_sub(from[axis])),
            ticks: ticks as u32,
            tick: 0,
        })
    }
}

impl<const N: usize> Iterator for TickPulse<N> {
    type Item = [i64; N];

    #[allow(
        clippy::cast_possible_truncation,
        reason = "a share of a 64-bit distance is one"
    )]
    fn next(&mut self) -> Option<[i64; N]> {
        if self.tick == self.ticks {
            return None;
        }
        self.tick += 1;
        let (tick, ticks) = (i128::from(self.tick), i128::from(self.ticks));
        Some(core::array::from_fn(|axis| {
            let passed = (i128::from(self.by[axis]) * tick).div_euclid(ticks);
            self.from[axis].wrapping_add(passed as i64)
        }))
    }
}
