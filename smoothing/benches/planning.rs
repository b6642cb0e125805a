//! Time to plan a block: a zigzag of 2000 corners, and a curve of 20000 fine moves.
//!
//! Both are part programs where they are at hand beside the project, and made up likewise where they
//! are not. Before the measurements the latency of each push, pulls included, is printed.
#![allow(clippy::unwrap_used, reason = "a bench that cannot start may panic")]
#![allow(clippy::print_stdout, reason = "latencies have no other place")]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use toolglide_kinematics::{
    Feedrate, Limits, MotionPlanner, Tolerance, Toolpath, Trajectory, Vector,
};
use toolglide_smoothing::{KinematicSmoothing, Method, Settings, plan};

/// Where the programs lie; they are not part of this project.
const PROGRAMS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/gcode/bench");

/// How often the latencies are taken; the least of each push is kept, which leaves out what else the
/// computer did.
const ROUNDS: usize = 7;

/// The points of a program of plain lines `G1 X1.5 Y2.5`.
fn program(name: &str) -> Option<Vec<Vector<2>>> {
    let text = std::fs::read_to_string(format!("{PROGRAMS}/{name}")).ok()?;
    let mut points = vec![Vector::<2>::zeros()];
    for line in text.lines().filter(|line| line.starts_with("G1")) {
        let mut at = points[points.len() - 1];
        for word in line.split_whitespace() {
            for (axis, letter) in ['X', 'Y'].into_iter().enumerate() {
                if let Some(value) = word.strip_prefix(letter) {
                    at[axis] = value.parse().unwrap();
                }
            }
        }
        points.push(at);
    }
    Some(points)
}

/// Moves of 2 to 5 mm with corners of all angles.
fn zigzag() -> Vec<Vector<2>> {
    let mut points = vec![Vector::<2>::zeros()];
    for number in 0..2_000_u32 {
        let angle = std::f64::consts::TAU * (f64::from(number) * 0.618_034).fract();
        let length = 2.0 + 3.0 * (f64::from(number) * 0.414_214).fract();
        points.push(points[points.len() - 1] + Vector::<2>::new(angle.cos(), angle.sin()) * length);
    }
    points
}

/// A Lissajous curve of chords of some hundredths of a millimetre.
fn lissajous() -> Vec<Vector<2>> {
    (0..=20_000_u32)
        .map(|number| {
            let angle = std::f64::consts::TAU * f64::from(number) / 20_000.0;
            Vector::<2>::new(36.8 * (3.0 * angle).sin(), 60.0 * (2.0 * angle).sin())
        })
        .collect()
}

/// Median, 99.9th percentile and worst of the latencies of all pushes and of the end.
fn latencies(path: &Toolpath<2>, settings: &Settings<2>) -> [Duration; 3] {
    let mut least = vec![Duration::MAX; path.moves().len() + 1];
    for _ in 0..ROUNDS {
        let mut planner = KinematicSmoothing::new(path.start(), settings);
        for (least, step) in least
            .iter_mut()
            .zip(path.moves().iter().map(Some).chain([None]))
        {
            let began = Instant::now();
            match step {
                Some(step) => planner.push(step).unwrap(),
                None => planner.finish().unwrap(),
            }
            while let Some(piece) = planner.pull() {
                black_box(piece);
            }
            *least = (*least).min(began.elapsed());
        }
    }
    least.sort_unstable();
    let count = least.len();
    [
        least[count / 2],
        least[count - 1 - count / 1000],
        least[count - 1],
    ]
}

fn planning(criterion: &mut Criterion) {
    let limits = Limits::uniform(1_000.0, 2_000.0, 5e4).unwrap();
    let mut group = criterion.benchmark_group("blocks");
    group.measurement_time(Duration::from_millis(600));
    group.warm_up_time(Duration::from_millis(200));
    group.sample_size(10);
    for (name, tolerance, otherwise) in [
        ("zig2000", 0.05, zigzag as fn() -> Vec<Vector<2>>),
        ("liss20k", 0.01, lissajous),
    ] {
        let points = program(&format!("{name}.ngc")).unwrap_or_else(otherwise);
        let (feedrate, tolerance) = (
            Feedrate::new(100.0).unwrap(),
            Tolerance::new(tolerance).unwrap(),
        );
        let path = Toolpath::from_points(&points, feedrate, tolerance).unwrap();
        group.throughput(Throughput::Elements(path.moves().len() as u64));
        for method in Method::ALL {
            let settings = Settings::new(limits).with_method(method);
            let [median, most, worst] = latencies(&path, &settings);
            println!(
                "{name}, {}: {:.4} s; a push takes {median:?}, 99.9 % up to {most:?}, the longest {worst:?}",
                method.name(),
                plan(&path, &settings).unwrap().duration(),
            );
            group.bench_function(format!("{name}, {}", method.name()), |bencher| {
                bencher.iter(|| plan(black_box(&path), &settings).unwrap().duration());
            });
        }
    }
    group.finish();
}

criterion_group!(benches, planning);
criterion_main!(benches);
