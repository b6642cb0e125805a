//! Refines set-points of the interpolation period to the servo period.
//!
//! Source: a line, or a cubic through four set-points with the tangents of central differences. Not here: the motion that is
//! sampled.

use crate::error::DriveError;
use crate::ring::Ring;

/// Ratios nearer to a whole number than this are whole.
const WHOLE: f64 = 1e-9;

/// Set-points that are kept beside those that are known ahead: four are looked at.
const KEPT: u64 = 8;

/// Most servo periods in a period of the set-points.
const MAX_RATIO: f64 = 10_000.0;

/// How set-points are refined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight from one to the next.
    Linear,
    /// A cubic whose tangents are central differences.
    Cubic,
}

/// Set-points at the interpolation period and what drives get of them.
#[derive(Clone, Debug)]
pub(crate) struct Refiner<const A: usize> {
    kind: Interpolation,
    ratio: u64,
    points: Ring<[f64; A]>,
}

impl<const A: usize> Refiner<A> {
    /// From one period to another, s.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the ratio is checked"
    )]
    pub(crate) fn new(
        kind: Interpolation,
        period: f64,
        servo_period: f64,
    ) -> Result<Self, DriveError> {
        let ratio = period / servo_period;
        let whole = ratio.round();
        let divides = (ratio - whole).abs() <= WHOLE * whole;
        if !((1.0..=MAX_RATIO).contains(&whole) && divides) {
            return Err(DriveError::new(
                "servo_period_s",
                servo_period,
                format!(
                    "the period of the set-points, {period} s, or a whole part of it down to one in {MAX_RATIO}"
                ),
            ));
        }
        Ok(Self {
            kind,
            ratio: whole as u64,
            points: Ring::new(2, [0.0; A]),
        })
    }

    /// The same with room for so many servo periods that are known ahead.
    pub(crate) fn with_room(mut self, ahead: u64) -> Self {
        let kept = usize::try_from(ahead / self.ratio + KEPT).unwrap_or(usize::MAX);
        self.points = Ring::new(kept, [0.0; A]);
        self
    }

    /// Servo periods in a period of the set-points.
    pub(crate) fn ratio(&self) -> u64 {
        self.ratio
    }

    /// Takes the next set-point.
    #[inline]
    pub(crate) fn give(&mut self, point: [f64; A]) {
        self.points.push(point);
    }

    /// What the drives get at a servo tick; the set-point after the next but one must be known, or be the last.
    #[inline]
    #[allow(clippy::cast_precision_loss, reason = "a ratio is small")]
    pub(crate) fn at(&self, tick: u64) -> [f64; A] {
        let (index, part) = (tick / self.ratio, tick % self.ratio);
        if part == 0 {
            return self.points.get(index);
        }
        let share = part as f64 / self.ratio as f64;
        let (start, end) = (self.points.get(index), self.points.get(index + 1));
        if self.kind == Interpolation::Linear {
            return std::array::from_fn(|axis| start[axis] + (end[axis] - start[axis]) * share);
        }
        let before = self.points.get(index.saturating_sub(1));
        let after = self.points.get(index + 2);
        std::array::from_fn(|axis| {
            let span = end[axis] - start[axis];
            let (first, last) = (
                0.5 * (end[axis] - before[axis]),
                0.5 * (after[axis] - start[axis]),
            );
            let second = 3.0 * span - 2.0 * first - last;
            let third = first + last - 2.0 * span;
            start[axis] + share * (first + share * (second + share * third))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_refines_a_parabola_exactly_and_a_line_does_not() {
        let at = |t: f64| 0.5 * t * t;
        for (kind, most) in [(Interpolation::Cubic, 1e-12), (Interpolation::Linear, 0.2)] {
            let mut refiner = Refiner::<1>::new(kind, 1e-3, 1e-4).unwrap().with_room(100);
            let mut off = 0.0_f64;
            for k in 0..10_u32 {
                refiner.give([at(f64::from(k))]);
            }
            for tick in 20..60_u32 {
                let [found] = refiner.at(u64::from(tick));
                off = off.max((found - at(0.1 * f64::from(tick))).abs());
            }
            assert!(off < most, "{kind:?}: {off}");
            assert!(kind == Interpolation::Cubic || off > 0.1, "{kind:?}: {off}");
        }
    }

    #[test]
    fn a_servo_period_that_does_not_divide_is_refused() {
        for (period, servo) in [(1e-3, 3e-4), (1e-4, 1e-3), (1.0, 1e-5)] {
            let refused = Refiner::<1>::new(Interpolation::Cubic, period, servo).unwrap_err();
            assert_eq!(refused.field, "servo_period_s");
        }
    }
}
