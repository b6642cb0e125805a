//! Small programs in one window: durations against the optimum, bounds at every instant.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_kinematics::{Limits, Vector};
use toolglide_optimal::{
    Budget, EndState, ScpSolver, Window, WindowMotion, WindowSegment, WindowSolver,
};

/// A share of a bound that the solver may take for nothing.
const ENOUGH: f64 = 1e-4;

struct Program {
    points: Vec<[f64; 2]>,
    tolerance: f64,
    feedrate: f64,
    acceleration: f64,
    jerk: f64,
    durations: Vec<f64>,
    interval: f64,
}

impl Program {
    fn duration(&self) -> f64 {
        self.with_window(|window| {
            let mut motion = self.guess();
            let solved = ScpSolver::new()
                .solve(window, &mut motion, &mut Budget::solves(8))
                .unwrap();
            check(window, &motion);
            solved.duration
        })
    }

    fn guess(&self) -> WindowMotion<2> {
        WindowMotion {
            durations: self.durations.clone(),
            ..WindowMotion::new()
        }
    }

    fn with_window<T>(&self, then: impl FnOnce(&Window<'_, 2>) -> T) -> T {
        let limits =
            Limits::<2>::uniform(10.0 * self.feedrate, self.acceleration, self.jerk).unwrap();
        let segments: Vec<_> = self
            .points
            .windows(2)
            .zip(&self.durations)
            .map(|(ends, duration)| WindowSegment {
                start: Vector::from(ends[0]),
                end: Vector::from(ends[1]),
                tolerance: self.tolerance,
                corner_tolerance: Some(self.tolerance),
                feedrate: self.feedrate,
                steps: (1..200)
                    .find(|steps| f64::from(*steps) * self.interval >= *duration)
                    .map_or(200, |steps: u16| usize::from(steps.max(4))),
                follow: None,
                walls: [None; 2],
            })
            .collect();
        then(&Window {
            start: EndState::rest(segments[0].start),
            end: EndState::rest(segments[segments.len() - 1].end),
            segments: &segments,
            limits: &limits,
            silence: None,
        })
    }
}

/// Integrates the jerks and looks at many instants of every interval.
fn check(window: &Window<'_, 2>, motion: &WindowMotion<2>) {
    let mut state = window.start;
    let mut next = 0;
    for (segment, duration) in window.segments.iter().zip(&motion.durations) {
        let interval = duration / f64::from(u16::try_from(segment.steps).unwrap());
        for jerk in &motion.jerks[next..next + segment.steps] {
            for part in 0..=8 {
                let now = state.after(interval * f64::from(part) / 8.0, jerk);
                assert!(
                    now.velocity.norm() <= segment.feedrate * (1.0 + ENOUGH),
                    "feed: {now:?}"
                );
                let acceleration = window.limits.acceleration()[0];
                assert!(
                    now.acceleration.amax() <= acceleration * (1.0 + ENOUGH),
                    "acceleration: {now:?}"
                );
                let way = segment.end - segment.start;
                let share = (now.position - segment.start).dot(&way) / way.norm_squared();
                let nearest = segment.start + way * share.clamp(0.0, 1.0);
                assert!(
                    (now.position - nearest).norm() <= segment.tolerance * (1.0 + ENOUGH) + 1e-9,
                    "tube: {now:?}"
                );
            }
            assert!(
                jerk.amax() <= window.limits.jerk()[0] * (1.0 + ENOUGH),
                "jerk: {jerk}"
            );
            state = state.after(interval, jerk);
        }
        next += segment.steps;
        assert!(
            (state.position - segment.end).norm() <= segment.tolerance * (1.0 + ENOUGH) + 1e-9,
            "corner: {state:?}"
        );
    }
    assert!(
        (state.position - window.end.position).norm() < 1e-8,
        "end: {state:?}"
    );
    assert!(state.velocity.norm() < 1e-6, "end: {state:?}");
}

fn right_angle(tolerance: f64) -> Program {
    Program {
        points: vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]],
        tolerance,
        feedrate: 100.0,
        acceleration: 2500.0,
        jerk: 2e5,
        durations: vec![0.16, 0.16],
        interval: 2e-3,
    }
}

fn two_bends(tolerance: f64) -> Program {
    let half = 0.5_f64.sqrt();
    let bend = 10.0 + 0.5 * half;
    Program {
        points: vec![
            [0.0, 0.0],
            [10.0, 0.0],
            [bend, 0.5 * half],
            [bend, 10.0 + 0.5 * half],
        ],
        tolerance,
        feedrate: 100.0,
        acceleration: 3000.0,
        jerk: 1e5,
        durations: vec![0.16, 0.03, 0.16],
        interval: 2e-3,
    }
}

#[test]
fn a_right_angle_comes_within_a_tenth_of_a_percent_of_the_optimum() {
    for (tolerance, optimum) in [(0.01, 0.2871), (0.1, 0.2715)] {
        let duration = right_angle(tolerance).duration();
        assert!(duration < optimum * 1.001, "{tolerance}: {duration}");
    }
}

#[test]
fn two_bends_come_within_a_tenth_of_a_percent_of_the_optimum() {
    for (tolerance, optimum) in [(0.009, 0.3302), (0.08, 0.2815)] {
        let duration = two_bends(tolerance).duration();
        assert!(duration < optimum * 1.001, "{tolerance}: {duration}");
    }
}

#[test]
fn twice_the_size_at_twice_the_limits_takes_the_same_time() {
    let once = two_bends(0.02);
    let mut twice = two_bends(0.04);
    twice.points = once
        .points
        .iter()
        .map(|point| point.map(|x| 2.0 * x))
        .collect();
    twice.feedrate *= 2.0;
    twice.acceleration *= 2.0;
    twice.jerk *= 2.0;
    let (once, twice) = (once.duration(), twice.duration());
    assert!((once - twice).abs() < 1e-6 * once, "{once} {twice}");
}

#[test]
fn twice_as_fast_takes_half_the_time() {
    let slow = right_angle(0.05);
    let mut fast = right_angle(0.05);
    fast.feedrate *= 2.0;
    fast.acceleration *= 4.0;
    fast.jerk *= 8.0;
    fast.interval *= 0.5;
    for duration in &mut fast.durations {
        *duration *= 0.5;
    }
    let (slow, fast) = (slow.duration(), fast.duration());
    assert!((slow - 2.0 * fast).abs() < 1e-6 * slow, "{slow} {fast}");
}

#[test]
fn a_solver_used_before_gives_the_same_bits_and_allocates_nothing() {
    let program = two_bends(0.02);
    let mut solver = ScpSolver::new();
    let mut first = program.guess();
    program
        .with_window(|window| solver.solve(window, &mut first, &mut Budget::solves(8)))
        .unwrap();
    let other = right_angle(0.05);
    let mut second = other.guess();
    other
        .with_window(|window| solver.solve(window, &mut second, &mut Budget::solves(8)))
        .unwrap();
    let mut again = first.clone();
    again.durations.clone_from(&program.durations);
    again.states.clear();
    again.jerks.clear();
    program.with_window(|window| {
        let counted = allocation_counter::measure(|| {
            solver
                .solve(window, &mut again, &mut Budget::solves(8))
                .unwrap();
        });
        assert_eq!(counted.count_total, 0, "allocations");
    });
    assert_eq!(again, first, "the same window, solved twice");
}
