//! Cuts segments into spans that fit one window, and chooses how finely their time is cut.
//!
//! Source: ours. The jerk is constant over an interval, so that intervals must be short against the
//! time in which the acceleration is built up; where speed is constant they may be long. The middle of a
//! long move is not planned in windows at all: there the feedrate holds on the line itself. Not here:
//! windows.

use crate::path::merge::Segment;
use crate::window::Follow;
use toolglide_kinematics::{Limits, MoveRange, PathLimits, Vector};

/// Longest time of a span that changes its speed, as a multiple of the interval.
pub(crate) const SPAN_STEPS: f64 = 24.0;

/// Fewest intervals of a span: with four it can be started and stopped at both ends.
pub(crate) const MIN_STEPS: usize = 4;

/// Most intervals of a span.
pub(crate) const MAX_STEPS: usize = 60;

/// Most intervals of a span that is travelled at constant speed.
const STEADY_STEPS: usize = 6;

/// Shortest middle of a long move that is not planned in windows, as a multiple of the distance to stop: it is
/// entered a little below its feedrate, gains that, and keeps it for a while.
const MIDDLE: f64 = 0.1;

/// Share of the feedrate at which such a middle is entered and left: a little less than what a solver
/// may use, so that a window can begin and end there.
const CRUISE_SHARE: f64 = 1.0 - 4e-4;

/// Room at the ends of a long move, as a multiple of the distance to stop: as much as there is, between these. Ways
/// around a corner that use all of the tolerance begin before the speed must change.
const END_ROOM: [f64; 2] = [1.1, 2.0];

/// A straight piece of path with what a window must know of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span<const N: usize> {
    pub(crate) start: Vector<N>,
    pub(crate) end: Vector<N>,
    pub(crate) direction: Vector<N>,
    pub(crate) length: f64,
    /// Length of the line of which it is a part, and where it begins on that, mm.
    pub(crate) line_length: f64,
    pub(crate) from: f64,
    pub(crate) tube: f64,
    /// Largest radius of the balls at its start and at its end, mm.
    pub(crate) balls: [f64; 2],
    /// Whether it is a chord of an arc.
    pub(crate) curved: bool,
    /// The arc over it, where the motion shall follow it.
    pub(crate) follow: Option<Follow<N>>,
    /// Whether the next span goes on along the same line.
    pub(crate) goes_on: bool,
    pub(crate) feedrate: f64,
    /// Limits along it; the velocity is the feedrate where that is lower.
    pub(crate) limits: PathLimits,
    pub(crate) serves: MoveRange,
    /// Duration of an interval, s, where it is short.
    pub(crate) interval: f64,
    /// Time to stop from its feedrate, s.
    pub(crate) stop_time: f64,
    /// Intervals, fixed when it is first planned; 0 before.
    pub(crate) steps: usize,
}

/// The middle of a long move: travelled on the line itself, up to the feedrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cruise<const N: usize> {
    pub(crate) start: Vector<N>,
    pub(crate) end: Vector<N>,
    pub(crate) direction: Vector<N>,
    pub(crate) limits: PathLimits,
    /// Speed at its start and at its end, mm/s.
    pub(crate) speed: f64,
    pub(crate) serves: MoveRange,
}

/// What a run is cut into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Part<const N: usize> {
    /// To be planned in windows.
    Span(Span<N>),
    /// The middle of a long move.
    Cruise(Cruise<N>),
}

/// How finely time is cut, as a share of the time in which the acceleration is built up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fineness(pub(crate) f64);

/// The smallest acceleration and jerk of any axis.
pub(crate) fn weakest<const N: usize>(limits: &Limits<N>) -> (f64, f64) {
    (limits.acceleration().min(), limits.jerk().min())
}

/// Cuts a run into spans and the middle of a long move, which is reached in `silence` seconds more than speed takes.
pub(crate) fn cut<const N: usize>(
    run: &Segment<N>,
    limits: &Limits<N>,
    fineness: Fineness,
    silence: f64,
    mut take: impl FnMut(Part<N>),
) {
    let line = whole(run, limits, fineness);
    if run.follow.is_some() {
        take(line.part(run, 0.0, f64::INFINITY));
        return;
    }
    let Span {
        limits: along,
        interval,
        stop_time,
        ..
    } = line;
    let distance_to_stop = 0.5 * along.velocity * stop_time;
    let more = along.velocity * silence;
    let room =
        (0.5 * (run.length - MIDDLE * distance_to_stop)).min(END_ROOM[1] * distance_to_stop + more);
    if room.is_nan() || room < END_ROOM[0] * distance_to_stop + more {
        let reach = along.reachable_within(run.length);
        let time = 2.0 * along.time_to_change(reach) + run.length / along.velocity;
        let least = along.velocity * interval * SPAN_STEPS;
        let count = if run.length > least {
            parts(time, interval).min(parts(run.length / along.velocity, interval) + 2)
        } else {
            1
        };
        let share = |index| run.length * steps(index) / steps(count);
        for index in 1..count {
            take(line.part(run, share(index - 1), share(index)));
        }
        take(line.part(run, share(count - 1), f64::INFINITY));
        return;
    }
    let ends = parts(stop_time * (room / distance_to_stop), interval);
    let share = |index| room * steps(index) / steps(ends);
    for index in 0..ends {
        take(line.part(run, share(index), share(index + 1)));
    }
    take(Part::Cruise(Cruise {
        start: place(run, room),
        end: place(run, run.length - room),
        direction: run.direction,
        limits: along,
        speed: CRUISE_SHARE * along.velocity,
        serves: run.serves,
    }));
    for left in (1..=ends).rev() {
        let to = if left > 1 {
            run.length - share(left - 1)
        } else {
            f64::INFINITY
        };
        take(line.part(run, run.length - share(left), to));
    }
}

/// Duration of an interval at a feedrate (mm/s) on the way from or to rest, s.
pub(crate) fn interval_at<const N: usize>(
    limits: &Limits<N>,
    feedrate: f64,
    fineness: Fineness,
) -> (f64, PathLimits) {
    let (acceleration, jerk) = weakest(limits);
    let weak = PathLimits {
        velocity: feedrate,
        acceleration,
        jerk,
    };
    let build_up = (acceleration / jerk).min((feedrate / jerk).sqrt());
    let stop_time = weak.time_to_change(feedrate);
    // Where speed takes long to change, the intervals grow with the geometric mean of both times.
    let interval = fineness.0 * (build_up * (0.5 * stop_time).max(build_up)).sqrt();
    (interval, weak)
}

/// A run as one span.
fn whole<const N: usize>(run: &Segment<N>, limits: &Limits<N>, fineness: Fineness) -> Span<N> {
    let mut along = limits.along(&run.direction);
    along.velocity = along.velocity.min(run.feedrate);
    let (interval, weak) = interval_at(limits, along.velocity, fineness);
    let stop_time = weak.time_to_change(along.velocity);
    Span {
        start: run.start,
        end: run.end,
        direction: run.direction,
        length: run.length,
        line_length: run.length,
        from: 0.0,
        tube: run.tube,
        balls: run.balls,
        curved: run.curved,
        follow: run.follow,
        goes_on: false,
        feedrate: run.feedrate,
        limits: along,
        serves: run.serves,
        interval,
        stop_time,
        steps: 0,
    }
}

/// The place so far along a run, mm; its very ends there and beyond.
fn place<const N: usize>(run: &Segment<N>, along: f64) -> Vector<N> {
    if along <= 0.0 {
        run.start
    } else if along >= run.length {
        run.end
    } else {
        run.start + run.direction * along
    }
}

#[allow(clippy::cast_precision_loss, reason = "a few dozen at the most")]
pub(crate) fn steps(count: usize) -> f64 {
    count as f64
}

/// Spans for a stretch of a duration.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to a small range"
)]
fn parts(time: f64, interval: f64) -> usize {
    let parts = (time / (interval * SPAN_STEPS)).ceil();
    // Not even a number where lengths or limits are beyond float arithmetic.
    if parts > 1.0 {
        parts.min(1e3) as usize
    } else {
        1
    }
}

impl<const N: usize> Span<N> {
    /// The part of a run between two distances from its start, mm.
    fn part(&self, run: &Segment<N>, from: f64, to: f64) -> Part<N> {
        let last = to >= run.length;
        Part::Span(Self {
            start: place(run, from),
            end: place(run, to),
            length: to.min(run.length) - from,
            from,
            // Where a line is only cut, the ball costs nothing: when it is passed is free.
            balls: [
                if from > 0.0 { run.tube } else { run.balls[0] },
                if last { run.balls[1] } else { run.tube },
            ],
            goes_on: !last,
            ..*self
        })
    }

    /// Intervals for a duration, over which its speed is `steady` or not.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to a small range"
    )]
    pub(crate) fn steps_for(&self, time: f64, steady: bool) -> usize {
        let most = if steady { STEADY_STEPS } else { MAX_STEPS };
        let count = (time / self.interval).ceil();
        if count > steps(MIN_STEPS) {
            count.min(steps(most)) as usize
        } else {
            MIN_STEPS
        }
    }
}
