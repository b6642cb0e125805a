//! Laws that every optimum keeps: scaling, mirrors and more room.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::bend;
use toolglide_kinematics::{Feedrate, Limits, Tolerance, Vector};
use toolglide_reference::{Course, Settings, optimum};

/// One problem in numbers.
#[derive(Clone)]
struct Problem {
    points: Vec<Vector<2>>,
    feed: f64,
    acceleration: f64,
    jerk: f64,
    tolerance: f64,
}

fn usual() -> Problem {
    Problem {
        points: bend(50.0, 6.0),
        feed: 100.0,
        acceleration: 2500.0,
        jerk: 2e5,
        tolerance: 0.02,
    }
}

impl Problem {
    fn least(&self) -> f64 {
        self.least_in(100)
    }

    fn least_in(&self, intervals: usize) -> f64 {
        let limits = Limits::uniform(5.0 * self.feed, self.acceleration, self.jerk).unwrap();
        let feed = Feedrate::new(self.feed).unwrap();
        let tolerance = Tolerance::new(self.tolerance).unwrap();
        let course = Course::through(&self.points, limits, feed, tolerance).unwrap();
        let settings = Settings::default().with_intervals(intervals);
        let best = optimum(&course, &[course.stopping_times()], &settings).unwrap();
        assert!(best.lower_bound() <= best.duration(), "bounds");
        best.sampled_duration()
    }
}

#[test]
fn lengths_and_times_can_be_scaled() {
    let least = usual().least();
    for factor in [1e-2, 25.4] {
        let mut longer = usual();
        longer.points.iter_mut().for_each(|point| *point *= factor);
        longer.feed *= factor;
        longer.acceleration *= factor;
        longer.jerk *= factor;
        longer.tolerance *= factor;
        let ratio = longer.least() / least;
        assert!(
            (ratio - 1.0).abs() < 2e-5,
            "lengths times {factor}: {ratio}"
        );
        let mut slower = usual();
        slower.feed /= factor;
        slower.acceleration /= factor * factor;
        slower.jerk /= factor * factor * factor;
        let ratio = slower.least() / (factor * least);
        assert!((ratio - 1.0).abs() < 2e-5, "times times {factor}: {ratio}");
    }
}

#[test]
fn mirrors_and_directions_do_not_matter() {
    let least = usual().least();
    let changed = |change: &dyn Fn(Vector<2>) -> Vector<2>| {
        let mut problem = usual();
        problem.points = problem.points.into_iter().map(change).collect();
        problem
    };
    let mut backwards = usual();
    backwards.points.reverse();
    for (name, problem) in [
        (
            "mirrored",
            changed(&|point| Vector::<2>::new(-point.x, point.y)),
        ),
        (
            "turned",
            changed(&|point| Vector::<2>::new(-point.y, point.x)),
        ),
        (
            "far away",
            changed(&|point| point + Vector::<2>::new(1e3, -5e2)),
        ),
        ("backwards", backwards),
    ] {
        let ratio = problem.least() / least;
        assert!((ratio - 1.0).abs() < 2e-5, "{name}: {ratio}");
    }
}

#[test]
fn more_room_and_larger_limits_never_take_longer() {
    let least = usual().least();
    let faster = |change: &dyn Fn(&mut Problem)| {
        let mut problem = usual();
        change(&mut problem);
        problem.least()
    };
    for (name, found) in [
        ("tolerance", faster(&|problem| problem.tolerance *= 1.5)),
        ("feedrate", faster(&|problem| problem.feed *= 1.5)),
        (
            "acceleration",
            faster(&|problem| problem.acceleration *= 1.5),
        ),
        ("jerk", faster(&|problem| problem.jerk *= 1.5)),
    ] {
        assert!(
            found < least,
            "a larger {name} takes {found} s instead of {least} s"
        );
    }
}

#[test]
fn without_room_the_optimum_stops_at_the_corner() {
    let mut problem = usual();
    problem.points = bend(90.0, 10.0);
    problem.tolerance = 1e-5;
    let found = problem.least_in(320);
    // What is left below 0.305 s goes with the cube root of the tolerance.
    assert!((found - 0.30283).abs() < 3e-4, "{found}");
}
