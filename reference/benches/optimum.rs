//! How long the optimum takes to find: one program of some intervals, and a search over the durations of
//! many legs.

#![allow(
    missing_docs,
    clippy::unwrap_used,
    reason = "the macros write functions; a failed unwrap is a failed bench"
)]

use criterion::{Criterion, criterion_group, criterion_main};
use toolglide_kinematics::{Feedrate, Limits, Tolerance, Vector};
use toolglide_reference::{Course, Settings, lower_bound, optimum, solved_once};

fn course(points: &[Vector<2>], tolerance: f64) -> Course<2> {
    let limits = Limits::uniform(500.0, 2500.0, 2e5).unwrap();
    let (feedrate, tolerance) = (
        Feedrate::new(100.0).unwrap(),
        Tolerance::new(tolerance).unwrap(),
    );
    Course::through(points, limits, feedrate, tolerance).unwrap()
}

/// One program of a right angle on samples.
fn programs(criterion: &mut Criterion) {
    let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
    let course = course(&points, 0.01);
    for intervals in [100, 400] {
        let settings = Settings::default().with_intervals(intervals);
        criterion.bench_function(&format!("one program of {intervals} intervals"), |bench| {
            bench.iter(|| solved_once(&course, &[0.1435; 2], &settings));
        });
    }
    let settings = Settings::default().with_intervals(400);
    let best = optimum(&course, &[course.stopping_times()], &settings).unwrap();
    criterion.bench_function("one bound of 400 intervals", |bench| {
        bench.iter(|| lower_bound(&course, best.plan(), 400));
    });
}

/// A spiral of forty short legs from full stops, with its bound.
fn spiral(criterion: &mut Criterion) {
    let mut points = vec![Vector::<2>::zeros(), Vector::<2>::new(10.0, 0.0)];
    let mut heading = 0.0_f64;
    for step in 0..38 {
        heading += (8.0 + 0.7 * f64::from(step)).to_radians();
        let last = points[points.len() - 1];
        points.push(last + Vector::<2>::new(heading.cos(), heading.sin()));
    }
    let last = points[points.len() - 1];
    points.push(last + Vector::<2>::new(heading.cos(), heading.sin()) * 10.0);
    let course = course(&points, 0.05);
    criterion.bench_function("a spiral of 40 legs", |bench| {
        bench.iter(|| optimum(&course, &[course.stopping_times()], &Settings::default()));
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = programs, spiral
}
criterion_main!(benches);
