//! Raises the speed to a peak: half of a motion between two boundaries.
//!
//! Source: section 3.3.1, one side of equation 3.17, integrated phase by phase because the printed
//! closed form cancels for small accelerations. Lowering the speed is the same, mirrored in time.

#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// A change from a speed and a non-negative acceleration to a higher speed at zero acceleration:
/// jerk up, hold, jerk down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedRamp {
    /// Durations of the three phases.
    pub durations: [f64; 3],
    /// Acceleration while it is held.
    pub apex: f64,
    /// Distance used.
    pub distance: f64,
    /// Speed where the jerk turns down.
    speed_at_turn: f64,
}

impl SpeedRamp {
    /// The shortest rise from `speed` and `acceleration` to `peak`.
    ///
    /// `peak` must be at least [`SpeedRamp::least_peak`], and `acceleration` between zero and
    /// `most_acceleration`; rounding beyond these is absorbed.
    #[must_use]
    #[inline]
    pub fn to_peak(
        speed: f64,
        acceleration: f64,
        peak: f64,
        most_acceleration: f64,
        jerk: f64,
    ) -> Self {
        let gain = peak - speed;
        let per_jerk = 1.0 / jerk;
        let half_square = 0.5 * acceleration * acceleration;
        let free = (jerk * gain + half_square)
            .max(0.0)
            .sqrt()
            .max(acceleration);
        let (apex, hold) = if free <= most_acceleration {
            (free, 0.0)
        } else {
            let ramps = (most_acceleration * most_acceleration - half_square) * per_jerk;
            (
                most_acceleration,
                ((gain - ramps) / most_acceleration).max(0.0),
            )
        };
        let up = ((apex - acceleration) * per_jerk).max(0.0);
        let down = apex * per_jerk;
        let speed_after_up = speed + up * (acceleration + 0.5 * jerk * up);
        let speed_at_turn = speed_after_up + apex * hold;
        let distance = up * (speed + up * (0.5 * acceleration + jerk * up / 6.0))
            + hold * (speed_after_up + 0.5 * apex * hold)
            + down * (peak - jerk * down * down / 6.0);
        Self {
            durations: [up, hold, down],
            apex,
            distance,
            speed_at_turn,
        }
    }

    /// The lowest peak that can follow: the acceleration runs out at once.
    #[must_use]
    #[inline]
    pub fn least_peak(speed: f64, acceleration: f64, jerk: f64) -> f64 {
        speed + 0.5 * acceleration * acceleration / jerk
    }

    /// How long the rise lasts.
    #[must_use]
    #[inline]
    pub fn duration(&self) -> f64 {
        self.durations[0] + self.durations[1] + self.durations[2]
    }

    /// How fast the distance grows with the peak, s.
    ///
    /// Lengthening the two ramps by the same time moves the turn, which gives `apex / jerk +
    /// speed_at_turn / apex`; it holds with and without a phase of constant acceleration.
    #[must_use]
    #[inline]
    pub fn distance_per_peak(&self) -> f64 {
        if self.apex > 0.0 {
            self.durations[2] + self.speed_at_turn / self.apex
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::phase::{Phase, integrate};
    use crate::profile::State;
    use proptest::prelude::*;

    fn integrated(speed: f64, acceleration: f64, rise: &SpeedRamp, jerk: f64) -> State {
        let [up, hold, down] = rise.durations;
        integrate(
            State::moving(speed, acceleration),
            &[
                Phase { duration: up, jerk },
                Phase {
                    duration: hold,
                    jerk: 0.0,
                },
                Phase {
                    duration: down,
                    jerk: -jerk,
                },
            ],
        )
    }

    proptest! {
        #[test]
        fn a_rise_integrated_forward_meets_its_peak_and_its_distance(
            speed in 0.0..200.0_f64, share in 0.0..1.0_f64, above in 0.0..300.0_f64,
            most in 100.0..20_000.0_f64, ratio in 3.0..1000.0_f64,
        ) {
            let jerk = most * ratio;
            let acceleration = share * most;
            let peak = SpeedRamp::least_peak(speed, acceleration, jerk) + above;
            let rise = SpeedRamp::to_peak(speed, acceleration, peak, most, jerk);
            let end = integrated(speed, acceleration, &rise, jerk);
            prop_assert!((end.velocity - peak).abs() < 1e-10 * (1.0 + peak), "{end:?}");
            prop_assert!(end.acceleration.abs() < 1e-9 * most, "{end:?}");
            prop_assert!((end.position - rise.distance).abs() < 1e-10 * (1.0 + rise.distance), "{end:?}");
            prop_assert!(rise.apex <= most, "{rise:?}");
        }

        #[test]
        fn the_slope_of_the_distance_is_its_difference_quotient(
            speed in 1.0..200.0_f64, share in 0.0..1.0_f64, above in 1.0..300.0_f64,
            most in 100.0..20_000.0_f64, ratio in 3.0..1000.0_f64,
        ) {
            let jerk = most * ratio;
            let acceleration = share * most;
            let peak = SpeedRamp::least_peak(speed, acceleration, jerk) + above;
            let step = 1e-5 * above;
            let at = |peak| SpeedRamp::to_peak(speed, acceleration, peak, most, jerk);
            let quotient = (at(peak + step).distance - at(peak - step).distance) / (2.0 * step);
            let slope = at(peak).distance_per_peak();
            prop_assert!((quotient / slope - 1.0).abs() < 1e-4, "{quotient} {slope}");
        }
    }
}
