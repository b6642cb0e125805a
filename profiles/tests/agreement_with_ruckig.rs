//! Seven phases against a general time-optimal solver, which shares no formula with them.
//!
//! Of ten thousand random boundary conditions as corners leave them, none takes longer here than
//! there. Section 3 of our derivation compares the same way. Where the two differ the reason is
//! counted: the other solver refuses an end that runs out exactly at the feedrate, or brakes first,
//! because rounding brings it above; it turns back where the distance just suffices, because rounding
//! makes it too short; and below a distance of [`MIN_DISTANCE`] its own tolerance of 1e-8 mm no
//! longer compares.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use rsruckig::prelude::{InputParameter, Ruckig, RuckigResult, ThrowErrorHandler, Trajectory};
use toolglide_kinematics::PathLimits;
use toolglide_profiles::{Profile, SCurve, SCurveBoundary};

/// How many boundary conditions are tried.
const CASES: u32 = 10_000;

/// How much longer one may take before the two count as different, relative.
const SAME: f64 = 1e-6;

/// Shortest distance that is compared, mm: a thousand times the position tolerance of the other.
const MIN_DISTANCE: f64 = 1e-5;

/// A speed below this is backwards, mm/s.
const BACKWARDS: f64 = -1e-9;

/// Numbers that look random and are the same in every run.
struct Random(u64);

impl Random {
    /// Evenly between 0 and 1.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let top = u32::try_from((z ^ (z >> 31)) >> 32).unwrap();
        f64::from(top) / 4_294_967_296.0
    }

    /// Evenly between the logarithms of two bounds.
    fn logarithmic(&mut self, least: f64, most: f64) -> f64 {
        (least.ln() + self.share() * (most / least).ln()).exp()
    }

    fn one_in(&mut self, count: f64) -> bool {
        self.share() * count < 1.0
    }

    /// An end of a move: a speed, and an acceleration that runs out below the feedrate.
    fn end(&mut self, limits: &PathLimits) -> [f64; 2] {
        let peak = if self.one_in(10.0) {
            limits.velocity
        } else {
            limits.velocity * self.share()
        };
        if self.one_in(5.0) {
            return [peak, 0.0];
        }
        if self.one_in(10.0) {
            return [0.0, 0.0];
        }
        let most = limits.acceleration.min((2.0 * limits.jerk * peak).sqrt());
        let acceleration = if self.one_in(10.0) {
            most
        } else {
            most * self.share()
        };
        let speed = peak - 0.5 * acceleration * acceleration / limits.jerk;
        [speed.max(0.0), acceleration]
    }

    fn connection(&mut self) -> SCurveBoundary {
        let acceleration = self.logarithmic(1e2, 3e4);
        let limits = PathLimits {
            velocity: self.logarithmic(1.0, 1e3),
            acceleration,
            jerk: acceleration * self.logarithmic(3.0, 1e3),
        };
        SCurveBoundary {
            from: self.end(&limits),
            to: self.end(&limits),
            limits,
        }
    }

    /// A distance from the least upward, and whether it is the least itself.
    fn distance(&mut self, least: f64) -> (f64, bool) {
        if least > 0.0 && self.one_in(10.0) {
            return (least, true);
        }
        let extra = self.logarithmic(1e-4, 1e3);
        let distance = if self.one_in(2.0) {
            least * (1.0 + extra)
        } else {
            least + extra
        };
        (distance.max(1e-6), false)
    }
}

/// What the other solver finds: how long it takes and its least speed; `None` when it refuses.
fn other(distance: f64, connection: &SCurveBoundary) -> Option<(f64, f64)> {
    let mut input = InputParameter::<1>::new(None);
    input.current_position[0] = 0.0;
    input.current_velocity[0] = connection.from[0];
    input.current_acceleration[0] = connection.from[1];
    input.target_position[0] = distance;
    input.target_velocity[0] = connection.to[0];
    input.target_acceleration[0] = -connection.to[1];
    input.max_velocity[0] = connection.limits.velocity;
    input.max_acceleration[0] = connection.limits.acceleration;
    input.max_jerk[0] = connection.limits.jerk;
    let mut trajectory = Trajectory::<1>::new(None);
    let solved = Ruckig::<1, ThrowErrorHandler>::new(None, 1e-3).calculate(&input, &mut trajectory);
    if !matches!(solved, Ok(RuckigResult::Working | RuckigResult::Finished)) {
        return None;
    }
    let profile = &trajectory.get_profiles()[0][0];
    let mut slowest = f64::INFINITY;
    for phase in 0..7 {
        let (v, a, j) = (profile.v[phase], profile.a[phase], profile.j[phase]);
        let turn = -a / j;
        if turn > 0.0 && turn < profile.t[phase] {
            slowest = slowest.min(v + 0.5 * a * turn);
        }
        slowest = slowest.min(v);
    }
    Some((trajectory.get_duration(), slowest.min(profile.v[7])))
}

/// Whether a feed keeps its limits at every knot, between which speed and acceleration are monotone
/// but for the turn at the peak.
fn is_legal(feed: &SCurve, connection: &SCurveBoundary) -> bool {
    let limits = &connection.limits;
    feed.knots().iter().all(|knot| {
        let state = feed.at(*knot);
        state.velocity >= BACKWARDS
            && state.velocity <= limits.velocity * (1.0 + 1e-9)
            && state.acceleration.abs() <= limits.acceleration * (1.0 + 1e-9)
    })
}

#[derive(Debug, Default, PartialEq)]
struct Count {
    same: u32,
    /// We take longer: never.
    slower: u32,
    /// The other brakes first, for an end that runs out at the feedrate.
    brakes_at_feedrate: u32,
    /// The other takes longer without that reason.
    other_slower: u32,
    /// The other turns back, at the least distance.
    turns_back_at_least: u32,
    /// The other turns back elsewhere.
    turns_back: u32,
    /// The other refuses an end that runs out at the feedrate.
    refused_at_feedrate: u32,
    /// The other refuses without that reason.
    refused: u32,
    tiny: u32,
}

#[test]
fn no_feed_is_slower_than_the_general_solver_finds() {
    let mut random = Random(7);
    let mut count = Count::default();
    for case in 0..CASES {
        let connection = random.connection();
        let (distance, is_least) = random.distance(connection.least_distance());
        let feed = SCurve::over(distance, &connection)
            .unwrap_or_else(|error| panic!("case {case}: {error}: {distance:?} {connection:?}"));
        assert!(
            is_legal(&feed, &connection),
            "case {case}: {distance:?} {connection:?}"
        );
        let at_feedrate = connection.least_peak() >= connection.limits.velocity * (1.0 - 1e-9);
        let kind = match other(distance, &connection) {
            None if at_feedrate => &mut count.refused_at_feedrate,
            None => &mut count.refused,
            Some(_) if distance < MIN_DISTANCE => &mut count.tiny,
            Some((_, slowest)) if slowest < BACKWARDS && is_least => &mut count.turns_back_at_least,
            Some((_, slowest)) if slowest < BACKWARDS => &mut count.turns_back,
            Some((duration, _)) => {
                let ratio = feed.duration() / duration;
                if ratio > 1.0 + SAME {
                    &mut count.slower
                } else if ratio >= 1.0 - SAME {
                    &mut count.same
                } else if at_feedrate {
                    &mut count.brakes_at_feedrate
                } else {
                    &mut count.other_slower
                }
            }
        };
        *kind += 1;
    }
    assert_eq!(count.slower, 0, "{count:?}");
    assert!(count.other_slower <= CASES / 100, "{count:?}");
    assert!(count.same >= CASES / 10 * 9, "{count:?}");
    assert!(count.refused + count.turns_back <= 10, "{count:?}");
}
