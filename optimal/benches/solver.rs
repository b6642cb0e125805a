//! Time to solve one window: a right angle, and chains of eight random segments with two and three
//! axes. Before the measurements, steps of the interior-point method and time per node of one step.
#![allow(clippy::unwrap_used, reason = "a bench that cannot start may panic")]
#![allow(clippy::print_stdout, reason = "times per step have no other place")]

use std::hint::black_box;
use std::time::Instant;

use criterion::{Criterion, criterion_group, criterion_main};
use toolglide_kinematics::{Limits, Vector};
use toolglide_optimal::{
    Budget, EndState, ScpSolver, Window, WindowMotion, WindowSegment, WindowSolver,
};

/// Linearised problems allowed for a window.
const EFFORT: usize = 8;

/// Intervals of a segment.
const STEPS: usize = 16;

/// A generator of numbers between zero and one, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        f64::from(u32::try_from(self.0 >> 32).unwrap()) / f64::from(u32::MAX)
    }
}

fn chain<const N: usize>(count: usize) -> Vec<WindowSegment<N>> {
    let mut numbers = Numbers(88_172_645_463_325_252);
    let mut corner = Vector::<N>::zeros();
    (0..count)
        .map(|_| {
            let direction = Vector::<N>::from_fn(|_, _| numbers.next() - 0.5).normalize();
            let start = corner;
            corner += direction * (1.0 + 4.0 * numbers.next());
            segment(start, corner)
        })
        .collect()
}

fn segment<const N: usize>(start: Vector<N>, end: Vector<N>) -> WindowSegment<N> {
    WindowSegment {
        start,
        end,
        tolerance: 0.05,
        corner_tolerance: Some(0.05),
        feedrate: 100.0,
        steps: STEPS,
        follow: None,
        walls: [None; 2],
    }
}

fn measure<const N: usize>(criterion: &mut Criterion, name: &str, segments: &[WindowSegment<N>]) {
    let limits = Limits::<N>::uniform(500.0, 2_000.0, 5e4).unwrap();
    let window = Window {
        start: EndState::rest(segments[0].start),
        end: EndState::rest(segments[segments.len() - 1].end),
        segments,
        limits: &limits,
        silence: None,
    };
    let guess: Vec<f64> = segments
        .iter()
        .map(|segment| 0.04 + (segment.end - segment.start).norm() / 80.0)
        .collect();
    let mut solver = ScpSolver::new();
    let mut motion = WindowMotion::new();
    let mut solve = || {
        motion.durations.clone_from(&guess);
        motion.states.clear();
        motion.jerks.clear();
        solver
            .solve(black_box(&window), &mut motion, &mut Budget::solves(EFFORT))
            .unwrap()
    };
    let solved = solve();
    let best = (0..20)
        .map(|_| {
            let began = Instant::now();
            solve();
            began.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min);
    let nodes = f64::from(solved.iterations) * f64::from(u32::try_from(window.steps()).unwrap());
    println!(
        "{name}: {:.4} s of motion, {} nodes, {} problems, {} iterations, {:.2} µs per node and iteration, {:.3} s per s",
        solved.duration,
        window.steps(),
        solved.solves,
        solved.iterations,
        best / nodes * 1e6,
        best / solved.duration,
    );
    criterion.bench_function(name, |bencher| bencher.iter(&mut solve));
}

fn windows(criterion: &mut Criterion) {
    let corner = Vector::<2>::new(10.0, 0.0);
    let right_angle = [
        segment(Vector::<2>::zeros(), corner),
        segment(corner, Vector::<2>::new(10.0, 10.0)),
    ];
    measure(criterion, "right angle", &right_angle);
    measure(criterion, "chain, two axes", &chain::<2>(8));
    measure(criterion, "chain, three axes", &chain::<3>(8));
}

criterion_group!(benches, windows);
criterion_main!(benches);
