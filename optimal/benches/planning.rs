//! Measures planning time for a second of motion, and the longest wait for one move.
//!
//! Not here: a single window, see the bench of the solver.

#![allow(missing_docs, reason = "what criterion generates")]
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a bench reports, and fails by panicking"
)]

use criterion::{Criterion, criterion_group, criterion_main};
use std::time::{Duration, Instant};
use toolglide_kinematics::{Feedrate, Limits, MotionPlanner, Tolerance, Toolpath, Vector};
use toolglide_optimal::{Settings, TimeOptimal};

/// Seconds of motion, of planning, and of the longest wait for a move.
fn plan<const N: usize>(path: &Toolpath<N>, limits: Limits<N>) -> (f64, Duration, Duration) {
    let mut planner = TimeOptimal::<N>::new(path.start(), &Settings::new(limits));
    let (mut motion, mut planning, mut longest) = (0.0, Duration::ZERO, Duration::ZERO);
    for step in path.moves().iter().map(Some).chain([None]) {
        let began = Instant::now();
        match step {
            Some(step) => planner.push(step).unwrap(),
            None => planner.finish().unwrap(),
        }
        while let Some(piece) = planner.pull() {
            motion += piece.duration();
        }
        let took = began.elapsed();
        planning += took;
        longest = longest.max(took);
    }
    (motion, planning, longest)
}

fn path<const N: usize>(points: &[Vector<N>], tolerance: f64) -> Toolpath<N> {
    let feedrate = Feedrate::new(100.0).unwrap();
    Toolpath::from_points(points, feedrate, Tolerance::new(tolerance).unwrap()).unwrap()
}

/// A zigzag of moves of 1 to 5 mm.
fn zigzag() -> Toolpath<2> {
    let mut at = Vector::<2>::zeros();
    let mut points = vec![at];
    for k in 0..200 {
        let angle = 2.3 * f64::from(k % 5) - 0.9 * f64::from(k % 3);
        let length = 1.0 + f64::from(k % 9) * 0.5;
        at += Vector::<2>::new(angle.cos(), angle.sin()) * length;
        points.push(at);
    }
    path(&points, 0.05)
}

/// Chords of 36 µm of a curve.
fn chords() -> Toolpath<2> {
    let points: Vec<_> = (0..20_000)
        .map(|k| {
            let t = f64::from(k) * 3e-4;
            Vector::<2>::new(50.0 * (3.0 * t).sin(), 50.0 * (2.0 * t).cos())
        })
        .collect();
    path(&points, 0.01)
}

/// Moves of 0.05 to 5 mm in any direction of space.
fn scribble() -> Toolpath<3> {
    let mut at = Vector::<3>::zeros();
    let mut points = vec![at];
    for k in 0..150 {
        let t = f64::from(k);
        let way = Vector::<3>::new((1.7 * t).sin(), (2.9 * t).cos(), (4.3 * t).sin());
        at += way.normalize() * 0.05 * 100.0_f64.powf(0.5 + 0.5 * (5.1 * t).sin());
        points.push(at);
    }
    path(&points, 0.05)
}

fn measure<const N: usize>(c: &mut Criterion, name: &str, path: &Toolpath<N>) {
    let limits = Limits::uniform(500.0, 2_000.0, 5e4).unwrap();
    let (motion, planning, longest) = plan(path, limits);
    println!(
        "{name}: {motion:.3} s of motion, {:.3} s of planning for each second, {:.1} ms the longest wait for a move",
        planning.as_secs_f64() / motion,
        1e3 * longest.as_secs_f64(),
    );
    c.bench_function(name, |b| b.iter(|| plan(path, limits)));
}

fn planning(c: &mut Criterion) {
    measure(c, "zigzag of 200 moves, 2 axes", &zigzag());
    measure(c, "20,000 chords of 36 µm, 2 axes", &chords());
    measure(c, "150 random moves, 3 axes", &scribble());
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = planning
}
criterion_main!(benches);
