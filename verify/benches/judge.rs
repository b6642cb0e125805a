//! Time to judge one piece of a typical motion: a staircase whose moves overlap in time, so that
//! every corner is rounded, and a plain stop at every corner.
#![allow(clippy::unwrap_used, reason = "a bench that cannot start may panic")]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use toolglide_kinematics::{
    Feedrate, Limits, Move, MoveRange, Piece, Plan, Sample, Tolerance, Toolpath, Trajectory, Vector,
};
use toolglide_verify::{verify, verify_set_points};

const STEP: f64 = 5.0;
const SPEED: f64 = 100.0;
const ACCELERATION: f64 = 2_000.0;
const JERK: f64 = 50_000.0;

/// Seven phases over `STEP`, cruising at `SPEED`: duration and jerk.
fn phases() -> [(f64, f64); 7] {
    let rise = ACCELERATION / JERK;
    let hold = SPEED / ACCELERATION - rise;
    let cruise = STEP / SPEED - (2.0 * rise + hold);
    assert!(cruise < 0.0 || hold > 0.0, "the step is long enough");
    let cruise = cruise.max(0.0);
    [
        (rise, JERK),
        (hold, 0.0),
        (rise, -JERK),
        (cruise, 0.0),
        (rise, -JERK),
        (hold, 0.0),
        (rise, JERK),
    ]
}

/// Moves along X and Y in turn, each beginning `overlap` before the last ends.
fn staircase(moves: u32, overlap: f64) -> (Toolpath<3>, Plan<3>) {
    let seven = phases();
    let total: f64 = seven.iter().map(|(t, _)| t).sum();
    let length: f64 = {
        let (rise, hold) = (seven[0].0, seven[1].0);
        SPEED * (2.0 * rise + hold + seven[3].0)
    };
    let period = total - overlap;
    let mut path = Toolpath::starting_at(Vector::<3>::zeros()).unwrap();
    let mut corner = Vector::<3>::zeros();
    let mut knots = Vec::new();
    for mv in 0..moves {
        let axis = usize::from(mv % 2 == 1);
        corner[axis] += length;
        let tolerance = Tolerance::new(2.0).unwrap();
        path.push(Move::line_to(corner, Feedrate::new(2.0 * SPEED).unwrap(), tolerance).unwrap())
            .unwrap();
        let mut time = f64::from(mv) * period;
        knots.push((time, axis, 0.0, Some(mv)));
        for (k, (t, jerk)) in seven.iter().enumerate() {
            knots.push((time, axis, *jerk, None));
            time += t;
            if k == 6 {
                knots.push((time, axis, 0.0, None));
            }
        }
    }
    knots.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut plan = Plan::starting_at(Vector::zeros());
    let mut state = Sample::at_rest(Vector::<3>::zeros());
    let mut last = 0;
    for pair in knots.windows(2) {
        let (time, axis, jerk, begun) = pair[0];
        match begun {
            Some(mv) => {
                // The axis rests here; rounding must not add up over the whole staircase.
                last = mv;
                state.position[axis] = length * f64::from(mv / 2);
                state.velocity[axis] = 0.0;
                state.acceleration[axis] = 0.0;
            }
            None => state.jerk[axis] = jerk,
        }
        let t = pair[1].0 - time;
        if t <= 1e-12 {
            continue;
        }
        let over = time >= f64::from(last.saturating_sub(1)) * period + total - 1e-9;
        let first = if over { last } else { last.saturating_sub(1) };
        let jerk = state.jerk;
        let next = Sample {
            position: state.position
                + (state.velocity + (state.acceleration * 0.5 + jerk * (t / 6.0)) * t) * t,
            velocity: state.velocity + (state.acceleration + jerk * (0.5 * t)) * t,
            acceleration: state.acceleration + jerk * t,
            jerk,
        };
        plan.push(Piece::new(
            &state,
            t,
            next.position,
            MoveRange { first, last },
        ));
        state = next;
    }
    (path, plan)
}

fn judge(criterion: &mut Criterion) {
    let limits = Limits::<3>::uniform(200.0, 1.001 * ACCELERATION, 1.001 * JERK).unwrap();
    let mut group = criterion.benchmark_group("judge");
    for (name, overlap) in [("stop at corners", 0.0), ("round corners", 0.07)] {
        let (path, plan) = staircase(2_000, overlap);
        let report = verify(&plan, &path, &limits);
        let serious = |text: String| !text.contains("jumps") && !text.contains("end");
        assert!(
            !report
                .examples
                .iter()
                .any(|violation| serious(violation.to_string())),
            "{:?}",
            report.examples
        );
        group.throughput(Throughput::Elements(plan.pieces().len() as u64));
        group.bench_function(name, |bencher| {
            bencher.iter(|| verify(black_box(&plan), &path, &limits));
        });
    }
    group.finish();
    let (path, plan) = staircase(100, 0.07);
    let period = 0.001;
    let points: Vec<_> = (0..)
        .map(|k| f64::from(k) * period)
        .take_while(|time| *time < plan.duration())
        .map(|time| (time, plan.sample(time).position))
        .collect();
    let mut group = criterion.benchmark_group("judge of set-points");
    group.throughput(Throughput::Elements(points.len() as u64));
    group.bench_function("round corners", |bencher| {
        bencher.iter(|| verify_set_points(black_box(points.iter().copied()), &path, &limits, 0.0));
    });
    group.finish();
}

criterion_group!(benches, judge);
criterion_main!(benches);
