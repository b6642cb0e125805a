//! Describes the corner where two straight moves meet.
//!
//! Source: sections 2.3 and 3.2, with the turn measured by half-angle vectors instead of an inverse
//! cosine, so that it is exact near 0 and near 180 degrees. Not here: any motion.

#[cfg(not(feature = "std"))]
use crate::no_std::*;
use crate::tolerance::Tolerance;
use crate::vector::Vector;

/// A corner of a path of straight moves, and what the motion through it must respect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner<const N: usize> {
    /// The corner itself.
    pub point: Vector<N>,
    /// Unit direction in which the path arrives.
    pub incoming: Vector<N>,
    /// Unit direction in which the path leaves.
    pub outgoing: Vector<N>,
    /// Largest speed on the way in, mm/s; infinite where nothing bounds it.
    pub speed_in: f64,
    /// Largest speed on the way out, mm/s.
    pub speed_out: f64,
    /// How far the motion may pass from the corner.
    pub tolerance: Tolerance,
}

impl<const N: usize> Corner<N> {
    /// Sine of half the turn angle: accurate where the path is nearly straight.
    #[must_use]
    pub fn half_turn_sine(&self) -> f64 {
        0.5 * (self.outgoing - self.incoming).norm()
    }

    /// Cosine of half the turn angle: accurate where the path nearly reverses.
    #[must_use]
    pub fn half_turn_cosine(&self) -> f64 {
        0.5 * (self.outgoing + self.incoming).norm()
    }

    /// Turn angle, rad: 0 straight on, pi a reversal.
    ///
    /// # Examples
    /// ```
    /// use toolglide_kinematics::{Corner, Tolerance, Vector};
    /// let corner = Corner {
    ///     point: Vector::<2>::zeros(),
    ///     incoming: Vector::<2>::x(),
    ///     outgoing: Vector::<2>::new(1.0, 1e-9),
    ///     speed_in: 100.0,
    ///     speed_out: 100.0,
    ///     tolerance: Tolerance::new(0.01)?,
    /// };
    /// assert!((corner.turn_angle() / 1e-9 - 1.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn turn_angle(&self) -> f64 {
        2.0 * self.half_turn_sine().atan2(self.half_turn_cosine())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_turn_is_exact_near_straight_and_near_reversal() {
        for deviation in [1e-12_f64, 1e-8, 1e-4] {
            let mut corner = Corner {
                point: Vector::<2>::zeros(),
                incoming: Vector::<2>::x(),
                outgoing: Vector::<2>::new(deviation.cos(), deviation.sin()),
                speed_in: 1.0,
                speed_out: 1.0,
                tolerance: Tolerance::new(1.0).unwrap(),
            };
            assert!(
                (corner.turn_angle() / deviation - 1.0).abs() < 1e-9,
                "{deviation}"
            );
            corner.outgoing = -corner.outgoing;
            let short_of_reversal = core::f64::consts::PI - corner.turn_angle();
            assert!((short_of_reversal - deviation).abs() < 1e-15, "{deviation}");
        }
    }
}
