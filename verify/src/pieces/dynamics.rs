//! Judges limits at every instant of a piece, and continuity between pieces.
//!
//! Source: velocity is a parabola whose extreme lies where the acceleration vanishes, acceleration
//! is a straight line, jerk is constant; the square of the speed is a quartic. Not here: the path.

use crate::path::bernstein::{Largest, squared_speed};
use crate::path::leg::{is_measurable, length_slack};
use crate::report::{Peak, Place, Report};
use crate::violation::Violation;
use toolglide_kinematics::Limits;
use toolglide_kinematics::Piece;
use toolglide_kinematics::Sample;
use toolglide_kinematics::Vector;
use toolglide_kinematics::numeric::{
    COORDINATE_JUMP, COORDINATE_ROUNDING, JUMP_SLACK, LARGEST_MAGNITUDE, LENGTH_SLACK, LIMIT_SLACK,
};

/// A piece with its ends and its beginning on the clock.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretch<const N: usize> {
    pub(crate) begin: f64,
    pub(crate) duration: f64,
    pub(crate) start: Sample<N>,
    /// The state that the polynomial reaches.
    pub(crate) end: Sample<N>,
    /// The position where the piece says that it ends.
    pub(crate) stated_end: Vector<N>,
}

impl<const N: usize> Stretch<N> {
    pub(crate) fn new(piece: &Piece<N>, begin: f64) -> Self {
        let t = piece.duration();
        let start = Sample {
            position: piece.start(),
            ..piece.at(0.0)
        };
        let Sample {
            position,
            velocity,
            acceleration,
            jerk,
        } = start;
        let end = Sample {
            position: position + (velocity + (acceleration * 0.5 + jerk * (t / 6.0)) * t) * t,
            velocity: velocity + (acceleration + jerk * (0.5 * t)) * t,
            acceleration: acceleration + jerk * t,
            jerk,
        };
        Self {
            begin,
            duration: t,
            start,
            end,
            stated_end: piece.end(),
        }
    }

    pub(crate) fn is_motion(&self) -> bool {
        let fine = |at: &Sample<N>| {
            is_measurable(&at.position)
                && is_measurable(&at.velocity)
                && is_measurable(&at.acceleration)
                && is_measurable(&at.jerk)
        };
        // A negative duration runs back in time, which is no motion either.
        self.duration >= 0.0
            && self.begin + self.duration <= LARGEST_MAGNITUDE
            && fine(&self.start)
            && fine(&self.end)
            && is_measurable(&self.stated_end)
    }

    /// Whether the whole piece stands still.
    pub(crate) fn rests(&self, limits: &Limits<N>) -> bool {
        let (begin, end) = (self.begin, self.begin + self.duration);
        moving_axis(&self.start, limits, begin).is_none()
            && moving_axis(&self.end, limits, end).is_none()
            && {
                let room = length_slack(self.start.position.amax());
                (self.end.position - self.start.position).amax() <= room
            }
    }
}

/// Room for the rounding of velocity and acceleration of an axis at a time.
///
/// Both are sums of products below the limit, which [`JUMP_SLACK`] covers; and at a time `t` instants are told apart
/// by no less than the rounding of `t`, within which the axis may legally change its velocity by its limit of
/// acceleration, and that by its limit of jerk, times as much.
fn rounding<const N: usize>(limits: &Limits<N>, axis: usize, time: f64) -> [f64; 2] {
    let instant = COORDINATE_ROUNDING * time;
    let (velocity, acceleration) = (limits.velocity()[axis], limits.acceleration()[axis]);
    [
        JUMP_SLACK * velocity + instant * acceleration,
        JUMP_SLACK * acceleration + instant * limits.jerk()[axis],
    ]
}

/// The first axis that is not at rest at a time.
pub(crate) fn moving_axis<const N: usize>(
    at: &Sample<N>,
    limits: &Limits<N>,
    time: f64,
) -> Option<usize> {
    (0..N).find(|&axis| {
        let [velocity, acceleration] = rounding(limits, axis, time);
        at.velocity[axis].abs() > velocity || at.acceleration[axis].abs() > acceleration
    })
}

/// Velocity, acceleration and jerk of every axis against its limits.
pub(crate) fn judge_limits<const N: usize>(
    report: &mut Report<N>,
    limits: &Limits<N>,
    stretch: &Stretch<N>,
    place: Place,
) {
    let Stretch {
        begin,
        duration,
        start,
        end,
        ..
    } = stretch;
    for axis in 0..N {
        let (a, j) = (start.acceleration[axis], start.jerk[axis]);
        let mut velocity = larger(start.velocity[axis], end.velocity[axis], *begin, *duration);
        let turn = -a / j;
        if turn > 0.0 && turn < *duration {
            let extreme = (start.velocity[axis] + 0.5 * a * turn).abs();
            if extreme > velocity.0 {
                velocity = (extreme, begin + turn);
            }
        }
        let acceleration = larger(a, end.acceleration[axis], *begin, *duration);
        note(report, Quantity::Velocity, axis, velocity, limits, place);
        note(
            report,
            Quantity::Acceleration,
            axis,
            acceleration,
            limits,
            place,
        );
        // A piece without duration has a jerk in name only.
        if *duration > 0.0 {
            note(
                report,
                Quantity::Jerk,
                axis,
                (j.abs(), *begin),
                limits,
                place,
            );
        }
    }
}

/// A quantity that is limited on every axis.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Quantity {
    Velocity,
    Acceleration,
    Jerk,
}

/// Records a value with its time, and a violation when it breaks the limit.
pub(crate) fn note<const N: usize>(
    report: &mut Report<N>,
    quantity: Quantity,
    axis: usize,
    (value, time): (f64, f64),
    limits: &Limits<N>,
    place: Place,
) {
    let (peak, limit): (&mut Peak, f64) = match quantity {
        Quantity::Velocity => (&mut report.peak_velocity[axis], limits.velocity()[axis]),
        Quantity::Acceleration => (
            &mut report.peak_acceleration[axis],
            limits.acceleration()[axis],
        ),
        Quantity::Jerk => (&mut report.peak_jerk[axis], limits.jerk()[axis]),
    };
    peak.raise(value, time, place);
    if value <= limit * (1.0 + LIMIT_SLACK) {
        return;
    }
    report.add(match quantity {
        Quantity::Velocity => Violation::Velocity {
            axis,
            value,
            limit,
            time,
            place,
        },
        Quantity::Acceleration => Violation::Acceleration {
            axis,
            value,
            limit,
            time,
            place,
        },
        Quantity::Jerk => Violation::Jerk {
            axis,
            value,
            limit,
            time,
            place,
        },
    });
}

/// The speed against a feedrate; a feedrate of 0 bounds nothing.
pub(crate) fn judge_speed<const N: usize>(
    report: &mut Report<N>,
    stretch: &Stretch<N>,
    feedrate: f64,
    place: Place,
) {
    let squares = squared_speed(&stretch.start, stretch.duration);
    let peak = report.peak_speed.value;
    let bounded = feedrate > 0.0 && feedrate.is_finite();
    let known = if bounded { peak.min(feedrate) } else { peak };
    let search = Largest::above(known * known, &squares);
    if search.bound <= known * known {
        return;
    }
    let (speed, time) = (
        search.bound.sqrt(),
        stretch.begin + search.at * stretch.duration,
    );
    report.peak_speed.raise(speed, time, place);
    if bounded {
        note_feedrate(report, speed, feedrate, time, place);
    }
}

/// Records how far a speed exceeds the feedrate.
pub(crate) fn note_feedrate<const N: usize>(
    report: &mut Report<N>,
    speed: f64,
    feedrate: f64,
    time: f64,
    place: Place,
) {
    report
        .feedrate_overshoot
        .raise(speed - feedrate, time, place);
    if speed > feedrate * (1.0 + LIMIT_SLACK) {
        report.add(Violation::Feedrate {
            value: speed,
            feedrate,
            time,
            place,
        });
    }
}

/// Whether a piece continues the state before it, and ends where it says, both within the rounding of its own
/// positions or the `room` for that along its moves. The piece before `lasted` so long.
///
/// A change of velocity by `e / t`, or of acceleration by `e / t^2`, over a piece of a time `t` moves no point of it by
/// more than the rounding `e` of its coordinates; planners that take differences of points have no better. At most a
/// millionth of the limit is put down to that.
pub(crate) fn judge_continuity<const N: usize>(
    report: &mut Report<N>,
    limits: &Limits<N>,
    before: &Sample<N>,
    stretch: &Stretch<N>,
    (room, lasted): (f64, f64),
    place: Place,
) {
    let start = &stretch.start;
    let gap = (start.position - before.position).norm();
    let miss = (stretch.end.position - stretch.stated_end).norm();
    let reach = start.position.amax().max(stretch.stated_end.amax());
    for (value, time) in [
        (gap, stretch.begin),
        (miss, stretch.begin + stretch.duration),
    ] {
        report.position_jump.raise(value, time, place);
        if value > length_slack(reach).max(room) {
            report.add(Violation::PositionJump { value, time, place });
        }
    }
    let time = stretch.begin;
    // What the rounding of coordinates makes of differences over the shorter of the two pieces.
    let coordinate = (length_slack(reach).max(room) - LENGTH_SLACK).max(0.0);
    let step = lasted.min(stretch.duration);
    for axis in 0..N {
        let mut allowed = rounding(limits, axis, time);
        let most = [limits.velocity()[axis], limits.acceleration()[axis]];
        for (order, allowed) in [1, 2].into_iter().zip(&mut allowed) {
            let shown = coordinate / step.powi(order);
            *allowed += shown.min(COORDINATE_JUMP * most[usize::from(order == 2)]);
        }
        let value = (start.velocity[axis] - before.velocity[axis]).abs();
        report.velocity_jump.raise(value, time, place);
        if value > allowed[0] {
            report.add(Violation::VelocityJump {
                axis,
                value,
                time,
                place,
            });
        }
        let value = (start.acceleration[axis] - before.acceleration[axis]).abs();
        report.acceleration_jump.raise(value, time, place);
        if value > allowed[1] {
            report.add(Violation::AccelerationJump {
                axis,
                value,
                time,
                place,
            });
        }
    }
}

/// The larger magnitude of two ends, with its time.
fn larger(first: f64, last: f64, begin: f64, duration: f64) -> (f64, f64) {
    if last.abs() > first.abs() {
        (last.abs(), begin + duration)
    } else {
        (first.abs(), begin)
    }
}
