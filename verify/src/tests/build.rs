//! Small motions for tests: rest to rest along lines, and two axes whose moves overlap in time.

use crate::{Report, verify_set_points};
use toolglide_kinematics::{
    Feedrate, Limits, Move, MoveRange, Path, Piece, Plan, Sample, Tolerance, Toolpath, Trajectory,
    Vector,
};

pub(super) fn limits<const N: usize>() -> Limits<N> {
    Limits::uniform(200.0, 2_000.0, 50_000.0).unwrap()
}

pub(super) fn line<const N: usize>(end: [f64; N]) -> Move<N> {
    Move::line_to(
        end.into(),
        Feedrate::new(100.0).unwrap(),
        Tolerance::new(0.01).unwrap(),
    )
    .unwrap()
}

pub(super) fn path<const N: usize>(moves: &[Move<N>]) -> Toolpath<N> {
    let mut path = Toolpath::starting_at(Vector::zeros()).unwrap();
    for (step, number) in moves.iter().zip(10..) {
        path.push(step.from_line(number)).unwrap();
    }
    path
}

/// Durations and jerks (shares of the jerk limit) of a motion over `length` from rest to rest.
pub(super) fn phases(length: f64, speed: f64, acceleration: f64, jerk: f64) -> Vec<(f64, f64)> {
    let ramp = |v: f64| {
        let rise = (acceleration / jerk).min((v / jerk).sqrt());
        let hold = (v / (jerk * rise) - rise).max(0.0);
        (rise, hold)
    };
    let reach = |v: f64| {
        let (rise, hold) = ramp(v);
        v * (2.0 * rise + hold)
    };
    let (mut low, mut high) = (0.0, speed);
    let mut peak = speed;
    if reach(speed) > length {
        for _ in 0..200 {
            peak = 0.5 * (low + high);
            if reach(peak) > length {
                high = peak;
            } else {
                low = peak;
            }
        }
    }
    let (rise, hold) = ramp(peak);
    let cruise = ((length - reach(peak)) / peak).max(0.0);
    // Exact in speed: the jerk follows from the speed, so that rounding stays in the position.
    let j = peak / (rise * (rise + hold));
    vec![
        (rise, j),
        (hold, 0.0),
        (rise, -j),
        (cruise, 0.0),
        (rise, -j),
        (hold, 0.0),
        (rise, j),
    ]
}

/// Appends pieces of given durations and jerks; the last ends at `end`.
pub(super) fn push_phases<const N: usize>(
    plan: &mut Plan<N>,
    phases: &[(f64, Vector<N>)],
    end: Vector<N>,
    serves: MoveRange,
) {
    let mut state = Sample::at_rest(plan.end());
    if let Some(last) = plan.pieces().last() {
        state = last.at(last.duration());
    }
    for (index, (time, jerk)) in phases.iter().enumerate() {
        state.jerk = *jerk;
        let t = *time;
        let last = index + 1 == phases.len();
        let next = Sample {
            position: state.position
                + (state.velocity + (state.acceleration * 0.5 + jerk * (t / 6.0)) * t) * t,
            velocity: state.velocity + (state.acceleration + jerk * (0.5 * t)) * t,
            acceleration: state.acceleration + jerk * t,
            jerk: *jerk,
        };
        let end = if last { end } else { next.position };
        plan.push(Piece::new(&state, t, end, serves));
        state = next;
    }
}

/// A legal motion that stops at the end of every move; arcs are cut by their chord.
pub(super) fn stop_and_go<const N: usize>(path: &Toolpath<N>, limits: &Limits<N>) -> Plan<N> {
    let mut plan = Plan::starting_at(path.start());
    for (step, mv) in path.moves().iter().zip(0..) {
        let serves = MoveRange::one(mv);
        let start = plan.end();
        if let Path::Dwell { duration } = step.path() {
            plan.push(Piece::new(
                &Sample::at_rest(start),
                *duration,
                start,
                serves,
            ));
            continue;
        }
        let span = step.end(start) - start;
        let length = span.norm();
        let direction = span / length;
        let along = limits.along(&direction);
        let speed = along.velocity.min(step.feedrate().speed());
        let seven = phases(length, speed, along.acceleration, along.jerk);
        let seven: Vec<_> = seven.iter().map(|(t, j)| (*t, direction * *j)).collect();
        let end = step.end(start);
        // Rest is exact, as a planner makes it: each move starts from rest anew.
        let mut leg = Plan::starting_at(start);
        push_phases(&mut leg, &seven, end, serves);
        plan.extend(leg.pieces().iter().copied());
    }
    plan
}

/// One axis after the other, the second starting `overlap` before the first ends.
pub(super) fn overlapped(
    lengths: [f64; 2],
    overlap: f64,
    limits: &Limits<2>,
    feedrate: f64,
) -> Plan<2> {
    let axes = [0, 1].map(|axis| {
        phases(
            lengths[axis],
            feedrate,
            limits.acceleration()[axis],
            limits.jerk()[axis],
        )
    });
    let total = |axis: usize| axes[axis].iter().map(|(t, _)| t).sum::<f64>();
    let shift = total(0) - overlap;
    let mut knots = vec![0.0, shift];
    for (axis, offset) in [(0, 0.0), (1, shift)] {
        let mut at = offset;
        for (t, _) in &axes[axis] {
            at += t;
            knots.push(at);
        }
    }
    knots.sort_by(f64::total_cmp);
    let jerk = |axis: usize, time: f64| {
        let mut at = if axis == 0 { 0.0 } else { shift };
        for (t, j) in &axes[axis] {
            if time >= at && time < at + t {
                return *j;
            }
            at += t;
        }
        0.0
    };
    let mut plan = Plan::starting_at(Vector::zeros());
    for pair in knots.windows(2) {
        let (t, middle) = (pair[1] - pair[0], 0.5 * (pair[0] + pair[1]));
        let end = if pair[1] >= knots[knots.len() - 1] {
            Vector::<2>::new(lengths[0], lengths[1])
        } else {
            Vector::zeros()
        };
        let serves = MoveRange {
            first: u32::from(middle > total(0)),
            last: u32::from(middle > shift),
        };
        let j = Vector::<2>::new(jerk(0, middle), jerk(1, middle));
        let is_last = end.norm() > 0.0;
        let mut leg = plan.clone();
        let state = leg
            .pieces()
            .last()
            .map_or(Sample::at_rest(leg.start()), |piece| {
                piece.at(piece.duration())
            });
        let natural =
            state.position + (state.velocity + (state.acceleration * 0.5 + j * (t / 6.0)) * t) * t;
        push_phases(
            &mut leg,
            &[(t, j)],
            if is_last { end } else { natural },
            serves,
        );
        plan = leg;
    }
    plan
}

/// Set-points of a plan at a period, the end included.
pub(super) fn set_points<const N: usize>(plan: &Plan<N>, period: f64) -> Vec<(f64, Vector<N>)> {
    let mut points: Vec<_> = (0..)
        .map(|k| f64::from(k) * period)
        .take_while(|time| *time < plan.duration())
        .map(|time| (time, plan.sample(time).position))
        .collect();
    points.push((plan.duration(), plan.end()));
    points
}

/// What the judge says of the set-points of a plan.
pub(super) fn judged<const N: usize>(plan: &Plan<N>, path: &Toolpath<N>, period: f64) -> Report<N> {
    verify_set_points(set_points(plan, period), path, &limits(), 0.0).unwrap()
}
