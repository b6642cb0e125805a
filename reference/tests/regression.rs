//! Known optima: numbers that an independent prototype gave, and another solver confirmed in part.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{bend, course};
use toolglide_kinematics::{Limits, Tolerance, Vector};
use toolglide_reference::{Course, Settings, optimum};

/// Relative difference allowed: that of two grids at 400 intervals.
const SAME: f64 = 3e-4;

fn near(name: &str, course: &Course<2>, intervals: usize, duration: f64, allowed: f64) {
    let settings = Settings::default().with_intervals(intervals);
    let best = optimum(course, &[course.stopping_times()], &settings).unwrap();
    let (low, sampled, high) = (best.lower_bound(), best.sampled_duration(), best.duration());
    assert!(
        (sampled - duration).abs() < allowed,
        "{name}: {sampled} s instead of {duration} s"
    );
    assert!(low <= high && sampled <= high, "{name}");
    assert!(
        high - low < 2.0 * allowed,
        "{name}: the bounds {low} and {high} are far apart"
    );
}

#[test]
fn a_right_angle_takes_what_it_took_before() {
    for (tolerance, duration) in [(0.01, 0.28712), (0.1, 0.27146)] {
        let course = course(&bend(90.0, 10.0), 2500.0, 2e5, tolerance);
        near(
            &format!("{tolerance} mm"),
            &course,
            400,
            duration,
            SAME * duration,
        );
    }
}

#[test]
fn two_turns_of_45_degrees_take_what_they_took_before() {
    let half = 0.5_f64.sqrt();
    let points = [
        [0.0, 0.0],
        [10.0, 0.0],
        [10.0 + 0.5 * half, 0.5 * half],
        [10.0 + 0.5 * half, 0.5 * half + 10.0],
    ]
    .map(Vector::<2>::from);
    for (tolerance, duration) in [(0.009, 0.33019), (0.08, 0.28152)] {
        let course = course(&points, 3000.0, 1e5, tolerance);
        near(
            &format!("{tolerance} mm"),
            &course,
            400,
            duration,
            SAME * duration,
        );
    }
}

#[test]
fn turns_of_all_angles_take_what_they_took_before() {
    for (angle, duration) in [
        (10.0, 0.25213),
        (20.0, 0.25546),
        (30.0, 0.26376),
        (45.0, 0.26894),
        (60.0, 0.27559),
        (75.0, 0.28057),
        (90.0, 0.28338),
        (105.0, 0.28358),
        (120.0, 0.28177),
        (135.0, 0.28046),
        (150.0, 0.28670),
        (160.0, 0.28979),
        (170.0, 0.29173),
    ] {
        let course = course(&bend(angle, 10.0), 2500.0, 2e5, 0.02);
        near(
            &format!("{angle} degrees"),
            &course,
            160,
            duration,
            1e-3 * duration,
        );
    }
}

#[test]
fn a_corner_in_space_takes_what_it_took_before() {
    let points = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 7.0, 7.0]].map(Vector::<3>::from);
    let limits = Limits::uniform(500.0, 2500.0, 2e5).unwrap();
    let tolerance = Tolerance::new(0.02).unwrap();
    let course = Course::through(&points, limits, common::feedrate(), tolerance).unwrap();
    let best = optimum(&course, &[course.stopping_times()], &Settings::default()).unwrap();
    let found = best.sampled_duration();
    assert!((found / 0.27173 - 1.0).abs() < SAME, "{found}");
}
