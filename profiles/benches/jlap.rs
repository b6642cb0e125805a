//! Changes of speed and straight moves a second.
#![allow(clippy::unwrap_used, reason = "a bench that cannot start may panic")]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use toolglide_kinematics::PathLimits;
use toolglide_profiles::{Jlap, Profile, SCurve, SCurveBoundary, State};

const LIMITS: PathLimits = PathLimits {
    velocity: 100.0,
    acceleration: 2_500.0,
    jerk: 2e5,
};

/// How many different problems are solved in turn.
const PROBLEMS: u32 = 1_000;

/// Shares from 0 to 1 that do not repeat.
fn share(number: u32, step: f64) -> f64 {
    (f64::from(number) * step).fract()
}

/// Straight moves as corners leave them: short and long, with and without acceleration at the ends.
fn connections() -> Vec<(f64, SCurveBoundary)> {
    let end = |number: u32, step: f64| {
        let acceleration = LIMITS.acceleration * (share(number, step) - 0.5).max(0.0);
        [60.0 * share(number, 1.7 * step), acceleration]
    };
    (0..PROBLEMS)
        .map(|number| {
            let connection = SCurveBoundary {
                from: end(number, 0.618),
                to: end(number, 0.754),
                limits: LIMITS,
            };
            let distance = connection.least_distance() + 20.0 * share(number, 0.414).powi(4);
            (distance, connection)
        })
        .collect()
}

fn jlap(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("profiles");
    group.measurement_time(std::time::Duration::from_secs(1));
    group.warm_up_time(std::time::Duration::from_millis(300));
    group.sample_size(20);
    group.throughput(Throughput::Elements(u64::from(PROBLEMS)));
    group.bench_function("a change of speed, solved", |bencher| {
        bencher.iter(|| {
            for number in 0..PROBLEMS {
                let start = State::moving(100.0 * share(number, 0.618), 500.0);
                let end = 100.0 * share(number, 0.414);
                black_box(Jlap::between(start, end, 0.0, 2_500.0, 2e5).unwrap());
            }
        });
    });
    let problems = connections();
    group.bench_function("a straight move, solved", |bencher| {
        bencher.iter(|| {
            for (distance, connection) in &problems {
                black_box(SCurve::over(*distance, connection).unwrap());
            }
        });
    });
    group.bench_function("a straight move, its duration alone", |bencher| {
        bencher.iter(|| {
            for (distance, connection) in &problems {
                black_box(connection.duration_over(*distance).unwrap());
            }
        });
    });
    let feeds: Vec<_> = problems
        .iter()
        .map(|(distance, connection)| SCurve::over(*distance, connection).unwrap())
        .collect();
    group.bench_function("a state on a straight move", |bencher| {
        bencher.iter(|| {
            for feed in &feeds {
                black_box(feed.at(black_box(0.6 * feed.duration())));
            }
        });
    });
    group.finish();
}

criterion_group!(benches, jlap);
criterion_main!(benches);
