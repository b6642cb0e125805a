//! Solves the seven-phase S-curve over a distance between two corners.
//!
//! Source: section 3.3.1, equations 3.11 to 3.25. Not here: the search for the peak speed.

use crate::connection::SCurveBoundary;
use crate::error::ProfileError;
use crate::phase::{Phase, knots};
use crate::profile::{Profile, State};
use toolglide_kinematics::PathLimits;
use toolglide_kinematics::numeric::{CLOSURE, LIMIT_SLACK};

/// Share of the distance that the search for the peak speed may leave over; it is cruised, so that
/// the distance is kept exactly and the loss of time is of second order.
const PEAK_PRECISION: f64 = 1e-12;

/// Seven-phase motion over a distance: rise, cruise, fall.
///
/// # Examples
/// ```
/// use toolglide_kinematics::PathLimits;
/// use toolglide_profiles::{Profile, SCurve, SCurveBoundary};
/// let limits = PathLimits { velocity: 100.0, acceleration: 2500.0, jerk: 2e5 };
/// let from_rest_to_rest = SCurveBoundary { from: [0.0, 0.0], to: [0.0, 0.0], limits };
/// let feed = SCurve::over(10.0, &from_rest_to_rest)?;
/// assert!((feed.duration() - 0.1525).abs() < 1e-12);
/// assert!((feed.end().position - 10.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SCurve {
    phases: [Phase; 7],
    /// State at the beginning of each phase: those before the cruise from the start, those after it
    /// from the end, so that no rounding lasts.
    starts: [State; 7],
    end: State,
    knots: [f64; 8],
}

impl SCurve {
    /// The fastest motion that joins the ends of `connection` over exactly `distance`, never turning
    /// back, with non-negative acceleration before the peak and non-positive after it.
    ///
    /// # Errors
    /// [`ProfileError::OutOfRange`] for an end that is negative, beyond a limit or not finite,
    /// [`ProfileError::TooFast`] when an end leads beyond the feedrate,
    /// [`ProfileError::TooShort`] with the distance that would have sufficed, and
    /// [`ProfileError::NotClosed`] should the motion, integrated forward, miss its end.
    pub fn over(distance: f64, connection: &SCurveBoundary) -> Result<Self, ProfileError> {
        check(distance, connection)?;
        Self::solve(distance, connection)
    }

    fn solve(distance: f64, connection: &SCurveBoundary) -> Result<Self, ProfileError> {
        let PathLimits { velocity, jerk, .. } = connection.limits;
        let peak = connection.least_peak();
        if peak > velocity * (1.0 + LIMIT_SLACK) {
            return Err(ProfileError::TooFast {
                peak,
                feedrate: velocity,
            });
        }
        let Some(solution) = connection.solve(distance, PEAK_PRECISION) else {
            return Err(ProfileError::TooShort {
                distance,
                needed: connection.least_distance(),
            });
        };
        let [up, hold, down] = solution.rise.durations;
        let [last_up, last_hold, last_down] = solution.fall.durations;
        let phase = |duration, jerk| Phase { duration, jerk };
        let phases = [
            phase(up, jerk),
            phase(hold, 0.0),
            phase(down, -jerk),
            phase(solution.cruise, 0.0),
            phase(last_down, -jerk),
            phase(last_hold, 0.0),
            phase(last_up, jerk),
        ];
        let (starts, end) = solution.states(distance, connection, &phases);
        let speed_scale = starts[3]
            .velocity
            .max(connection.from[0])
            .max(connection.to[0]);
        let distance_scale = distance + speed_scale * solution.duration();
        let acceleration_scale = solution.rise.apex.max(solution.fall.apex);
        // Each phase, integrated forward, must meet the next.
        for (index, phase) in phases.iter().enumerate() {
            let reached = starts[index].after(phase.duration);
            let next = starts.get(index + 1).unwrap_or(&end);
            closed("position", reached.position - next.position, distance_scale)?;
            closed("velocity", reached.velocity - next.velocity, speed_scale)?;
            closed(
                "acceleration",
                reached.acceleration - next.acceleration,
                acceleration_scale,
            )?;
        }
        Ok(Self {
            phases,
            starts,
            end,
            knots: knots(&phases),
        })
    }

    /// State at the beginning of each phase.
    #[must_use]
    pub fn starts(&self) -> &[State; 7] {
        &self.starts
    }

    /// The seven phases; some may have no duration.
    #[must_use]
    pub fn phases(&self) -> &[Phase; 7] {
        &self.phases
    }
}

impl Profile for SCurve {
    fn duration(&self) -> f64 {
        self.knots[7]
    }

    fn at(&self, time: f64) -> State {
        if time >= self.knots[7] {
            return self.end;
        }
        let phase = self.knots[1..7].partition_point(|&knot| knot <= time);
        self.starts[phase].after((time - self.knots[phase]).max(0.0))
    }

    fn knots(&self) -> &[f64] {
        &self.knots
    }
}

fn check(distance: f64, connection: &SCurveBoundary) -> Result<(), ProfileError> {
    let PathLimits {
        velocity,
        acceleration,
        jerk,
    } = connection.limits;
    for (quantity, value) in [
        ("velocity limit", velocity),
        ("acceleration limit", acceleration),
        ("jerk limit", jerk),
    ] {
        if value.is_nan() || value <= 0.0 {
            return Err(ProfileError::NotPositive { quantity, value });
        }
    }
    let most_acceleration = acceleration * (1.0 + LIMIT_SLACK);
    for (quantity, value, high) in [
        ("distance", distance, f64::MAX),
        ("start speed", connection.from[0], f64::MAX),
        ("end speed", connection.to[0], f64::MAX),
        ("start acceleration", connection.from[1], most_acceleration),
        ("end deceleration", connection.to[1], most_acceleration),
    ] {
        if !(0.0..=high).contains(&value) {
            return Err(ProfileError::OutOfRange {
                quantity,
                value,
                low: 0.0,
                high,
            });
        }
    }
    Ok(())
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

    const LIMITS: PathLimits = PathLimits {
        velocity: 100.0,
        acceleration: 2500.0,
        jerk: 2e5,
    };

    fn rest_to_rest(limits: PathLimits) -> SCurveBoundary {
        SCurveBoundary {
            from: [0.0, 0.0],
            to: [0.0, 0.0],
            limits,
        }
    }

    #[test]
    fn a_short_move_from_rest_to_rest_is_four_jerk_phases() {
        let limits = PathLimits {
            velocity: 1e3,
            acceleration: 1e9,
            jerk: 5e4,
        };
        let feed = SCurve::over(4.0, &rest_to_rest(limits)).unwrap();
        let closed_form = 4.0 * (4.0_f64 / (2.0 * 5e4)).cbrt();
        assert!(
            (feed.duration() / closed_form - 1.0).abs() < 1e-9,
            "{}",
            feed.duration()
        );
    }

    #[test]
    fn no_distance_between_rests_is_no_motion() {
        let feed = SCurve::over(0.0, &rest_to_rest(LIMITS)).unwrap();
        assert!(feed.duration().abs() < 1e-15, "{feed:?}");
    }

    #[test]
    fn the_distance_that_just_suffices_is_accepted() {
        let connection = SCurveBoundary {
            from: [60.0, 1500.0],
            to: [20.0, 800.0],
            limits: LIMITS,
        };
        let least = connection.least_distance();
        assert!(SCurve::over(least, &connection).is_ok(), "{least}");
        let refused = SCurve::over(0.999 * least, &connection);
        assert!(
            matches!(refused, Err(ProfileError::TooShort { .. })),
            "{refused:?}"
        );
    }

    #[test]
    fn an_acceleration_that_cannot_run_out_below_the_feedrate_is_refused() {
        let connection = SCurveBoundary {
            from: [99.0, 2000.0],
            to: [0.0, 0.0],
            limits: LIMITS,
        };
        let refused = SCurve::over(100.0, &connection);
        assert!(
            matches!(refused, Err(ProfileError::TooFast { .. })),
            "{refused:?}"
        );
    }

    #[test]
    fn ends_that_are_not_numbers_are_refused() {
        for bad in [f64::NAN, f64::INFINITY, -1.0] {
            assert!(
                SCurve::over(bad, &rest_to_rest(LIMITS)).is_err(),
                "distance {bad}"
            );
            let mut connection = rest_to_rest(LIMITS);
            connection.from[0] = bad;
            assert!(SCurve::over(1.0, &connection).is_err(), "start speed {bad}");
            let mut connection = rest_to_rest(LIMITS);
            connection.to[1] = bad;
            assert!(
                SCurve::over(1.0, &connection).is_err(),
                "end deceleration {bad}"
            );
        }
    }

    #[test]
    fn a_long_slow_cruise_keeps_its_distance() {
        let limits = PathLimits {
            velocity: 3.210_781_211_594_768,
            acceleration: 8_954.277_474_615_019,
            jerk: 173_840.144_019_451_7,
        };
        let connection = SCurveBoundary {
            from: [1.565_104_121_804_189, 500.0],
            to: [1.747_782_288_166_221, 490.0],
            limits,
        };
        let feed = SCurve::over(588.266_649_328_689_1, &connection).unwrap();
        assert!(
            (feed.end().position - 588.266_649_328_689_1).abs() < 1e-12,
            "{feed:?}"
        );
        let cruise = feed.starts()[3];
        assert!(cruise.acceleration.abs() < f64::MIN_POSITIVE, "{cruise:?}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn a_feed_keeps_its_limits_and_meets_its_end(
            v in prop::array::uniform2(0.0..1.0_f64), a in prop::array::uniform2(0.0..1.0_f64),
            feedrate in 1.0..1000.0_f64, most in 100.0..30_000.0_f64, ratio in 3.0..1000.0_f64,
            extra in prop_oneof![Just(0.0), 1e-9..1.0_f64, 1.0..1e4_f64],
        ) {
            let limits = PathLimits { velocity: feedrate, acceleration: most, jerk: most * ratio };
            let end = |v: f64, a: f64| {
                let room = feedrate * v;
                let a = (a * most).min((2.0 * limits.jerk * room).sqrt());
                [(room - 0.5 * a * a / limits.jerk).max(0.0), a]
            };
            let connection = SCurveBoundary { from: end(v[0], a[0]), to: end(v[1], a[1]), limits };
            let distance = connection.least_distance() * (1.0 + extra) + extra * 1e-3;
            let feed = SCurve::over(distance, &connection).unwrap();
            for knot in feed.knots() {
                let state = feed.at(*knot);
                prop_assert!(state.velocity <= feedrate * (1.0 + 1e-9), "{state:?}");
                prop_assert!(state.velocity >= -1e-9 * feedrate, "{state:?}");
                prop_assert!(state.acceleration.abs() <= most * (1.0 + 1e-9), "{state:?}");
            }
            let quick = connection.duration_over(distance).unwrap();
            prop_assert!((quick - feed.duration()).abs() <= 1e-6 * quick, "{quick} {}", feed.duration());
        }
    }
}
