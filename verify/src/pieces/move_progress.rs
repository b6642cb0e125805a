//! Tracks corners passed in turn, stops made, dwells rested out, arcs followed to their end.
//!
//! Source: the second half of the meaning of [`toolglide_kinematics::Tolerance`]. Not here: the distance from the
//! path between corners.

use crate::path::bernstein::Cubic;
use crate::path::closest_approach::{closest, enters};
use crate::path::leg::Leg;
use crate::path::route::Route;
use crate::pieces::dynamics::{Stretch, moving_axis};
use crate::report::Report;
use crate::violation::Violation;
use toolglide_kinematics::Limits;
use toolglide_kinematics::Sample;
use toolglide_kinematics::Vector;
use toolglide_kinematics::numeric::LENGTH_SLACK;

/// How far the motion has come along the path.
#[derive(Clone, Debug, Default)]
pub(crate) struct Record {
    /// The move whose end is the next corner to pass.
    next: u32,
    /// Program line of the last move that was closed.
    pub(crate) last_line: u32,
}

impl Record {
    /// Takes note of all that a piece passes while it serves a range of moves.
    pub(crate) fn pass<const N: usize>(
        &mut self,
        route: &mut Route<N>,
        report: &Report<N>,
        limits: &Limits<N>,
        stretch: &Stretch<N>,
        curve: &Cubic<N>,
        (first, last): (u32, u32),
    ) {
        let mut rest = None;
        for mv in route.base()..=last {
            let Some(leg) = route.get_mut(mv) else { break };
            if leg.stops && !leg.stopped {
                let points = rest.get_or_insert_with(|| resting_points(stretch, limits));
                leg.note_stop(points, stretch);
            }
            leg.note_corner(report, stretch, curve, mv < self.next);
            if mv >= first {
                leg.note_waypoints(curve);
            }
        }
        if stretch.rests(limits) {
            rest_out(route, stretch, (first, last));
        }
        self.pass_corners(route, curve, last);
    }

    /// Passes corners in their order, each at the first chance after the one before.
    fn pass_corners<const N: usize>(&mut self, route: &Route<N>, curve: &Cubic<N>, last: u32) {
        let mut from = 0.0;
        while self.next <= last
            && let Some(leg) = route.get(self.next)
            && leg.approach <= leg.corner_allowed
            && let Some(at) = enters(curve, &leg.end, leg.corner_allowed, from)
        {
            from = at;
            self.next += 1;
        }
    }

    /// Forgets the first move and reports what it missed, and a corner out of its turn.
    pub(crate) fn close<const N: usize>(
        &mut self,
        route: &mut Route<N>,
        report: &mut Report<N>,
        time: f64,
    ) {
        let Some((leg, is_corner)) = close_leg(route, report, time) else {
            return;
        };
        let place = leg.place;
        self.last_line = place.line;
        if self.next > place.mv {
            return;
        }
        if is_corner && leg.approach <= leg.corner_allowed {
            report.add(Violation::CornerOrder {
                time: leg.approach_time,
                place,
            });
        }
        self.next = place.mv + 1;
        while route
            .get(self.next)
            .is_some_and(|leg| leg.approach <= leg.corner_allowed)
        {
            self.next += 1;
        }
    }
}

/// Forgets the first move and reports what it missed; says whether its end was a corner, which
/// that of the last move is not.
pub(crate) fn close_leg<const N: usize>(
    route: &mut Route<N>,
    report: &mut Report<N>,
    time: f64,
) -> Option<(Leg<N>, bool)> {
    let leg = route.forget_first()?;
    let is_corner = route.base() < route.len();
    let (place, approach_time) = (leg.place, leg.approach_time);
    if is_corner && leg.approach.is_finite() {
        report
            .corner_error
            .raise(leg.approach, approach_time, place);
        report
            .corner_ratio
            .raise(leg.approach / leg.corner_allowed, approach_time, place);
        if leg.approach > leg.corner_allowed {
            report.add(Violation::CornerMissed {
                value: leg.approach,
                tolerance: leg.corner_tolerance,
                time: approach_time,
                place,
            });
        }
    }
    close_parts(&leg, report, time, is_corner);
    Some((leg, is_corner))
}

/// Reports stops, dwells and arcs that were cut short.
fn close_parts<const N: usize>(leg: &Leg<N>, report: &mut Report<N>, time: f64, is_corner: bool) {
    let place = leg.place;
    // A stop at the end of the path is the end of the motion, which is judged there.
    if is_corner && leg.stops && !leg.stopped {
        report.add(Violation::StopNotMade {
            distance: leg.approach,
            time: leg.approach_time,
            place,
        });
    }
    if let Some(duration) = leg.dwell
        && !leg.has_dwelt()
    {
        report.add(Violation::DwellTooShort {
            rested: leg.rested,
            duration,
            time,
            place,
        });
    }
    if leg.waypoints_passed < leg.waypoints() {
        let (_, share) = leg.waypoint(leg.waypoints_passed);
        report.add(Violation::ArcCut { share, time, place });
    }
}

impl<const N: usize> Leg<N> {
    /// Looks whether the motion rests at the end of this move.
    fn note_stop(&mut self, points: &[Option<(f64, Vector<N>)>; 3], stretch: &Stretch<N>) {
        for (at, point) in points.iter().flatten() {
            let distance = (point - self.end).norm();
            if distance <= self.slack {
                self.stopped = true;
                self.comes_near(distance, stretch.begin + at);
            }
        }
    }

    /// Looks how close a piece comes to the corner, as far as it can change the report.
    fn note_corner(
        &mut self,
        report: &Report<N>,
        stretch: &Stretch<N>,
        curve: &Cubic<N>,
        passed: bool,
    ) {
        let enough = report
            .corner_error
            .value
            .min(report.corner_ratio.value * self.corner_allowed)
            .min(self.corner_allowed);
        if passed && self.approach <= enough.max(LENGTH_SLACK) {
            return;
        }
        if let Some(near) = closest(curve, &self.end, self.approach, enough) {
            self.comes_near(near.distance, stretch.begin + near.at * stretch.duration);
        }
    }

    /// Passes the points inside an arc in their order.
    fn note_waypoints(&mut self, curve: &Cubic<N>) {
        let count = self.waypoints();
        let mut from = 0.0;
        while self.waypoints_passed < count {
            let (point, _) = self.waypoint(self.waypoints_passed);
            match enters(curve, &point, self.allowed, from) {
                Some(at) => {
                    from = at;
                    self.waypoints_passed += 1;
                }
                None => break,
            }
        }
    }
}

/// Gives the time of a piece at rest to the dwells that it serves, in their order.
fn rest_out<const N: usize>(route: &mut Route<N>, stretch: &Stretch<N>, range: (u32, u32)) {
    let mut left = stretch.duration;
    for mv in range.0..=range.1 {
        let Some(leg) = route.get_mut(mv) else { break };
        let Some(duration) = leg.dwell else { continue };
        if (stretch.start.position - leg.end).norm() <= leg.slack {
            let given = left.min((duration - leg.rested).max(0.0));
            leg.rested += given;
            left -= given;
        }
    }
}

/// Where a piece is at rest: at its ends, or inside where all accelerations vanish together.
fn resting_points<const N: usize>(
    stretch: &Stretch<N>,
    limits: &Limits<N>,
) -> [Option<(f64, Vector<N>)>; 3] {
    let Stretch {
        duration,
        start,
        end,
        stated_end,
        ..
    } = stretch;
    let resting = |at: f64, state: &Sample<N>, position: Vector<N>| {
        moving_axis(state, limits, stretch.begin + at)
            .is_none()
            .then_some((at, position))
    };
    let turn = -start.acceleration.dot(&start.jerk) / start.jerk.norm_squared();
    let inside = (turn > 0.0 && turn < *duration).then(|| {
        let velocity = start.velocity + (start.acceleration + start.jerk * (0.5 * turn)) * turn;
        let change =
            (start.velocity + (start.acceleration * 0.5 + start.jerk * (turn / 6.0)) * turn) * turn;
        Sample {
            position: start.position + change,
            velocity,
            acceleration: start.acceleration + start.jerk * turn,
            jerk: start.jerk,
        }
    });
    [
        resting(0.0, start, start.position),
        inside.and_then(|state| resting(turn, &state, state.position)),
        resting(*duration, end, *stated_end),
    ]
}
