//! Computes motion from rest to rest along one straight segment in closed form.
//!
//! Source: the seven-phase law of motion, three cases of equation set 2.2. It starts the search, is
//! what the convex program is tested against, and what is left when that fails. Not here: corners.

use crate::course::{Course, Segment};
use toolglide_kinematics::{Limits, MoveRange, PathLimits, Piece, Sample};

/// The phases of a motion from rest to rest: jerk `+ 0 - 0 - 0 +`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Straight {
    /// Duration of a phase of jerk, s.
    pub(crate) jerking: f64,
    /// Duration of a phase of constant acceleration, s.
    pub(crate) accelerating: f64,
    /// Duration of the phase of constant speed, s.
    pub(crate) cruising: f64,
}

impl Straight {
    /// The fastest over a length.
    pub(crate) fn over(length: f64, limits: &PathLimits) -> Self {
        let (v, a, j) = (limits.velocity, limits.acceleration, limits.jerk);
        let knee = a * a / j;
        // The speed that is reached when there is no cruising.
        let by_jerk = (0.25 * j * length * length).cbrt();
        let reached = if by_jerk <= knee {
            by_jerk
        } else {
            0.5 * (-knee + (knee * knee + 4.0 * a * length).sqrt())
        };
        let peak = reached.min(v);
        let (jerking, accelerating) = if peak > knee {
            (a / j, peak / a - a / j)
        } else {
            ((peak / j).sqrt(), 0.0)
        };
        let ramps = peak * (2.0 * jerking + accelerating);
        Self {
            jerking,
            accelerating,
            cruising: ((length - ramps) / peak).max(0.0),
        }
    }

    /// How long it takes, s.
    pub(crate) fn duration(&self) -> f64 {
        4.0 * self.jerking + 2.0 * self.accelerating + self.cruising
    }

    /// The pieces along a leg.
    pub(crate) fn pieces<const N: usize>(&self, leg: &Segment<N>) -> Vec<Piece<N>> {
        let (t, hold, cruise) = (self.jerking, self.accelerating, self.cruising);
        let phases = [
            (t, 1.0),
            (hold, 0.0),
            (t, -1.0),
            (cruise, 0.0),
            (t, -1.0),
            (hold, 0.0),
            (t, 1.0),
        ];
        let serves = MoveRange {
            first: leg.serves,
            last: leg.serves,
        };
        let phases: Vec<_> = phases.into_iter().filter(|phase| phase.0 > 0.0).collect();
        // The length for a jerk of one decides how large it is, so that rounding leaves no gap.
        let unit = {
            let (mut p, mut v, mut a) = (0.0, 0.0, 0.0);
            for &(t, sign) in &phases {
                p += (v + (0.5 * a + sign * t / 6.0) * t) * t;
                v += (a + 0.5 * sign * t) * t;
                a += sign * t;
            }
            p
        };
        let jerk = leg.length / unit;
        let mut state = Sample::at_rest(leg.start);
        let mut pieces = Vec::with_capacity(phases.len());
        for (index, &(t, sign)) in phases.iter().enumerate() {
            state.jerk = leg.direction * (sign * jerk);
            let p = state.position
                + (state.velocity + (state.acceleration * 0.5 + state.jerk * (t / 6.0)) * t) * t;
            let end = if index + 1 == phases.len() {
                leg.end
            } else {
                p
            };
            pieces.push(Piece::new(&state, t, end, serves));
            state.velocity += (state.acceleration + state.jerk * (0.5 * t)) * t;
            state.acceleration += state.jerk * t;
            state.position = end;
        }
        pieces
    }
}

/// What a motion along a leg may use of the limits.
pub(crate) fn along<const N: usize>(limits: &Limits<N>, leg: &Segment<N>) -> PathLimits {
    let mut along = limits.along(&leg.direction);
    along.velocity = along.velocity.min(leg.feed);
    along
}

impl<const N: usize> Course<N> {
    /// How long each leg takes from rest to rest, s: durations to start a search from.
    #[must_use]
    pub fn stopping_times(&self) -> Vec<f64> {
        self.legs
            .iter()
            .map(|leg| Straight::over(leg.length, &along(&self.limits, leg)).duration())
            .collect()
    }

    /// How long the length of the course would take if it were straight, s, at the mean of the
    /// limits along its legs: what no corner costs.
    #[must_use]
    pub fn straight_time(&self) -> f64 {
        let total = self.length();
        let mut mean = PathLimits {
            velocity: 0.0,
            acceleration: 0.0,
            jerk: 0.0,
        };
        for leg in &self.legs {
            let (share, along) = (leg.length / total, along(&self.limits, leg));
            mean.velocity += share * along.velocity;
            mean.acceleration += share * along.acceleration;
            mean.jerk += share * along.jerk;
        }
        Straight::over(total, &mean).duration()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_three_cases_have_their_closed_durations() {
        let limits = PathLimits {
            velocity: 100.0,
            acceleration: 2500.0,
            jerk: 2e5,
        };
        for (length, duration) in [
            (10.0, 0.1525),
            (3.0, 0.082_900_6),
            (1.0, 0.054_407_6),
            (0.05, 0.02),
        ] {
            let found = Straight::over(length, &limits).duration();
            assert!((found - duration).abs() < 1e-7, "{length} mm: {found}");
        }
    }
}
