//! Solves the jerk-limited acceleration profile between two speeds and accelerations in least time.
//!
//! Source: section 2.2, equations 2.7 to 2.18, with the direction of the jerk taken from what the
//! direct ramp leaves to do instead of from the difference of the speeds. Not here: a distance to
//! keep, see [`crate::SCurve`].

use crate::error::ProfileError;
use crate::phase::{Phase, integrate, knots, state_at};
use crate::profile::{Profile, State};
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::numeric::CLOSURE;

/// A three-phase change between two (speed, acceleration) states: jerk, hold, opposite jerk.
///
/// # Examples
/// ```
/// use toolglide_profiles::{Jlap, Profile, State};
/// let change = Jlap::between(State::moving(0.0, 0.0), 100.0, 0.0, 2500.0, 2e5)?;
/// // A change between zero accelerations takes dv / A + A / J.
/// assert!((change.duration() - (100.0 / 2500.0 + 2500.0 / 2e5)).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jlap {
    start: State,
    phases: [Phase; 3],
    knots: [f64; 4],
}

impl Jlap {
    /// The change of least time from the velocity and acceleration of `start` to those given, within
    /// an acceleration and a jerk.
    ///
    /// Any two states can be joined: there is no distance to keep.
    ///
    /// # Errors
    /// [`ProfileError::NotPositive`] for a limit that is not positive and finite,
    /// [`ProfileError::OutOfRange`] for a start or end acceleration beyond the limit or a value that
    /// is not finite, and [`ProfileError::NotClosed`] should the change, integrated forward, miss its
    /// end (which no test has produced).
    pub fn between(
        start: State,
        end_velocity: f64,
        end_acceleration: f64,
        acceleration: f64,
        jerk: f64,
    ) -> Result<Self, ProfileError> {
        positive("acceleration limit", acceleration)?;
        positive("jerk limit", jerk)?;
        within("start acceleration", start.acceleration, acceleration)?;
        within("end acceleration", end_acceleration, acceleration)?;
        within("start velocity", start.velocity, f64::MAX)?;
        within("end velocity", end_velocity, f64::MAX)?;
        let phases = solve(
            [start.velocity, start.acceleration],
            [end_velocity, end_acceleration],
            acceleration,
            jerk,
        );
        let reached = integrate(start, &phases);
        let speed_scale =
            start.velocity.abs() + end_velocity.abs() + acceleration * acceleration / jerk;
        closed("velocity", reached.velocity - end_velocity, speed_scale)?;
        closed(
            "acceleration",
            reached.acceleration - end_acceleration,
            acceleration,
        )?;
        Ok(Self {
            start,
            phases,
            knots: knots(&phases),
        })
    }

    /// The three phases.
    #[must_use]
    pub fn phases(&self) -> &[Phase; 3] {
        &self.phases
    }
}

impl Profile for Jlap {
    fn duration(&self) -> f64 {
        self.knots[3]
    }

    fn at(&self, time: f64) -> State {
        state_at(self.start, &self.phases, time)
    }

    fn knots(&self) -> &[f64] {
        &self.knots
    }
}

#[allow(
    clippy::many_single_char_names,
    reason = "transcribed equations keep the letters of the text"
)]
fn solve([v0, a0]: [f64; 2], [v1, a1]: [f64; 2], a_max: f64, j: f64) -> [Phase; 3] {
    let dv = v1 - v0;
    let direct = (a0 + a1) * (a1 - a0).abs() / (2.0 * j); // speed gained on the ramp from a0 to a1
    let s = if dv >= direct { 1.0 } else { -1.0 }; // corrects 2.7 and 2.10
    let apex = (s * j * dv + 0.5 * (a0 * a0 + a1 * a1)).max(0.0).sqrt(); // 2.10
    let apex = apex.max(s * a0).max(s * a1);
    let (apex, hold) = if apex <= a_max {
        (apex, 0.0)
    } else {
        let ramps = (2.0 * a_max * a_max - a0 * a0 - a1 * a1) / (2.0 * j);
        (a_max, ((s * dv - ramps) / a_max).max(0.0)) // 2.9
    };
    [
        Phase {
            duration: ((apex - s * a0) / j).max(0.0), // 2.8
            jerk: s * j,
        },
        Phase {
            duration: hold,
            jerk: 0.0,
        },
        Phase {
            duration: ((apex - s * a1) / j).max(0.0),
            jerk: -s * j,
        },
    ]
}

fn positive(quantity: &'static str, value: f64) -> Result<(), ProfileError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(ProfileError::NotPositive { quantity, value })
    }
}

fn within(quantity: &'static str, value: f64, bound: f64) -> Result<(), ProfileError> {
    if value.abs() <= bound {
        Ok(())
    } else {
        Err(ProfileError::OutOfRange {
            quantity,
            value,
            low: -bound,
            high: bound,
        })
    }
}

fn closed(quantity: &'static str, miss: f64, scale: f64) -> Result<(), ProfileError> {
    if miss.abs() <= CLOSURE * scale {
        Ok(())
    } else {
        Err(ProfileError::NotClosed { quantity, miss })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_small_change_does_not_reach_the_acceleration_limit() {
        let change = Jlap::between(State::moving(0.0, 0.0), 10.0, 0.0, 2500.0, 2e5).unwrap();
        assert!(
            (change.duration() - 2.0 * (10.0_f64 / 2e5).sqrt()).abs() < 1e-14,
            "{change:?}"
        );
        assert!(change.phases()[1].duration.abs() < 1e-15, "{change:?}");
    }

    #[test]
    fn a_small_gain_while_accelerating_must_first_lose_acceleration() {
        // The printed sign rule gives an apex below the start acceleration here.
        let change = Jlap::between(State::moving(0.0, 500.0), 0.1, 0.0, 2500.0, 1e5).unwrap();
        assert!(change.phases()[0].jerk < 0.0, "{change:?}");
        assert!((change.end().velocity - 0.1).abs() < 1e-12, "{change:?}");
    }

    #[test]
    fn equal_states_need_no_time() {
        let change = Jlap::between(State::moving(7.0, 0.0), 7.0, 0.0, 1.0, 1.0).unwrap();
        assert!(change.duration().abs() < 1e-15, "{change:?}");
    }

    #[test]
    fn limits_that_are_not_positive_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(
                Jlap::between(State::default(), 1.0, 0.0, bad, 1.0).is_err(),
                "{bad}"
            );
            assert!(
                Jlap::between(State::default(), 1.0, 0.0, 1.0, bad).is_err(),
                "{bad}"
            );
        }
        assert!(
            Jlap::between(State::default(), f64::NAN, 0.0, 1.0, 1.0).is_err(),
            "nan"
        );
        assert!(
            Jlap::between(State::default(), 1.0, 2.0, 1.0, 1.0).is_err(),
            "beyond the limit"
        );
    }

    proptest! {
        #[test]
        fn any_two_states_can_be_joined_within_the_limits(
            v0 in -300.0..300.0_f64, v1 in -300.0..300.0_f64,
            s0 in -1.0..=1.0_f64, s1 in -1.0..=1.0_f64,
            most in 10.0..20_000.0_f64, ratio in 3.0..1000.0_f64,
        ) {
            let jerk = most * ratio;
            let change = Jlap::between(State::moving(v0, s0 * most), v1, s1 * most, most, jerk).unwrap();
            for knot in change.knots() {
                prop_assert!(change.at(*knot).acceleration.abs() <= most * (1.0 + 1e-12), "{change:?}");
            }
        }

        #[test]
        fn reversing_time_reverses_the_change(
            v0 in 0.0..300.0_f64, v1 in 0.0..300.0_f64, s0 in -1.0..=1.0_f64, s1 in -1.0..=1.0_f64,
        ) {
            let there = Jlap::between(State::moving(v0, s0 * 1e3), v1, s1 * 1e3, 1e3, 5e4).unwrap();
            let back = Jlap::between(State::moving(v1, -s1 * 1e3), v0, -s0 * 1e3, 1e3, 5e4).unwrap();
            prop_assert!((there.duration() - back.duration()).abs() < 1e-9, "{there:?} {back:?}");
        }
    }
}
