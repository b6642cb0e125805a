//! Time of a tick, of the closed form, and of planning a block.
#![allow(clippy::unwrap_used, reason = "a bench that cannot start may panic")]
#![allow(missing_docs, reason = "criterion makes functions without")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::f64::consts::TAU;
use std::hint::black_box;
use toolglide_fir::{FilterChain, FirInterpolation, PulseTrain, Settings, TickFilter};
use toolglide_kinematics::{
    Arc, Feedrate, Limits, MotionPlanner, Move, SamplePeriod, Tolerance, Toolpath, Vector,
};

fn chain() -> FilterChain {
    FilterChain::with_time_constants(&[0.1, 0.06]).unwrap()
}

fn ticks(criterion: &mut Criterion) {
    let period = SamplePeriod::new(0.001).unwrap();
    let mut filter = TickFilter::new(&chain(), period, [0_i64; 3]).unwrap();
    let mut position = 0_i64;
    criterion.bench_function("a tick of three axes behind two filters", |bencher| {
        bencher.iter(|| {
            position = (position + 12_345) & 0xFFF_FFFF;
            filter.tick(black_box([position, -position, position >> 1]))
        });
    });
}

fn closed_form(criterion: &mut Criterion) {
    let mut train = PulseTrain::starting_at(Vector::<3>::zeros(), chain());
    for number in 0..100_u32 {
        let angle = TAU * (f64::from(number) * 0.618_034).fract();
        let end = train.end() + Vector::<3>::new(angle.cos(), angle.sin(), 0.1) * 20.0;
        train.line_to(end, 50.0, 0.05).unwrap();
    }
    let duration = train.duration();
    let mut time = 0.0;
    criterion.bench_function("the closed form of lines at a time", |bencher| {
        bencher.iter(|| {
            time = (time + 0.001_3) % duration;
            train.position(black_box(time))
        });
    });
}

/// A star of five round arms.
fn star(count: u32) -> Toolpath<2> {
    let points: Vec<_> = (0..=count)
        .map(|number| TAU * f64::from(number) / f64::from(count))
        .map(|angle| {
            let radius = 30.0 * (1.0 + 0.35 * (5.0 * angle).cos());
            Vector::<2>::new(radius * angle.cos(), radius * angle.sin())
        })
        .collect();
    let feedrate = Feedrate::new(50.0).unwrap();
    Toolpath::from_points(&points, feedrate, Tolerance::new(0.03).unwrap()).unwrap()
}

/// Plans a path while it streams in, as a controller does, and drops the motion.
fn stream(path: &Toolpath<2>, settings: &Settings<2>) -> f64 {
    let mut planner = FirInterpolation::new(path.start(), settings);
    let mut time = 0.0;
    for step in path.moves() {
        planner.push(step).unwrap();
        while let Some(piece) = planner.pull() {
            time += piece.duration();
        }
    }
    planner.finish().unwrap();
    while let Some(piece) = planner.pull() {
        time += piece.duration();
    }
    time
}

fn planning(criterion: &mut Criterion) {
    let settings = Settings::new(Limits::uniform(500.0, 2_500.0, 2e5).unwrap())
        .with_chain(&chain())
        .unwrap();
    let mut group = criterion.benchmark_group("planning a star");
    for count in [125, 250, 500] {
        let path = star(count);
        group.throughput(Throughput::Elements(count.into()));
        group.bench_function(format!("{count} moves"), |bencher| {
            bencher.iter(|| stream(black_box(&path), &settings));
        });
    }
    group.finish();
}

/// A smooth curve in chords of some 36 µm.
fn curve(count: u32) -> Toolpath<2> {
    let points: Vec<_> = (0..=count)
        .map(|number| TAU * f64::from(number) / f64::from(count))
        .map(|angle| Vector::<2>::new((3.0 * angle).sin(), (2.0 * angle).sin()) * 50.0)
        .collect();
    let feedrate = Feedrate::new(100.0).unwrap();
    Toolpath::from_points(&points, feedrate, Tolerance::new(0.01).unwrap()).unwrap()
}

/// Half circles that turn to either side in turns.
fn waves(count: u32) -> Toolpath<2> {
    let feedrate = Feedrate::new(50.0).unwrap();
    let tolerance = Tolerance::new(0.01).unwrap();
    let mut path = Toolpath::starting_at(Vector::zeros()).unwrap();
    for number in 0..count {
        let x = 4.0 * f64::from(number);
        let ends = [x, x + 4.0, x + 2.0].map(|x| Vector::<2>::new(x, 0.0));
        let left = number % 2 == 0;
        let arc = Arc::about(ends[0], ends[1], ends[2], [0, 1], left, 0).unwrap();
        path.push(Move::arc(arc, feedrate, tolerance)).unwrap();
    }
    path
}

/// Time constants are chosen as the path goes.
fn planning_what_is_fine(criterion: &mut Criterion) {
    let settings = Settings::new(Limits::uniform(500.0, 2_500.0, 2e5).unwrap());
    let mut group = criterion.benchmark_group("planning");
    for (name, path) in [
        ("20,000 chords of a curve", curve(20_000)),
        ("200 half circles", waves(200)),
    ] {
        let moves = u64::try_from(path.moves().len()).unwrap();
        group.throughput(Throughput::Elements(moves));
        group.bench_function(name, |bencher| {
            bencher.iter(|| stream(black_box(&path), &settings));
        });
    }
    group.finish();
}

criterion_group!(benches, ticks, closed_form, planning, planning_what_is_fine);
criterion_main!(benches);
