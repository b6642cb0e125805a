//! Choosing among the kinds of corners is no slower than any of them by itself.
//!
//! Not here: that it is no slower than stopping, see the random courses.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_kinematics::Trajectory;
use toolglide_smoothing::{Method, Settings, plan};
use toolglide_tests::course::{Course, limits};

/// Within what a search for a duration leaves open, relative.
const SEARCHED: f64 = 1e-6;

/// Durations of a course by every kind of corner: chosen, and forced.
fn durations(course: &Course<2>, axis: [f64; 3]) -> [f64; 3] {
    let path = course.toolpath();
    let settings = Settings::new(limits(&[axis; 2]));
    [
        Method::Kcs,
        Method::KcsUninterrupted,
        Method::KcsInterrupted,
    ]
    .map(|method| {
        plan(&path, &settings.with_method(method))
            .unwrap()
            .duration()
    })
}

/// So many moves along each straight line from corner to corner.
fn fine_moves(corners: &[[f64; 2]], count: u32) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for pair in corners.windows(2) {
        let span = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        points.extend((1..=count).map(|part| {
            let share = f64::from(part) / f64::from(count);
            [pair[0][0] + share * span[0], pair[0][1] + share * span[1]]
        }));
    }
    points
}

#[test]
fn short_lines_traced_there_and_back_take_no_longer_than_by_one_kind_of_corner() {
    // Between the corners there is less room than any of them would take by itself.
    let corners: Vec<[f64; 2]> = (0..60)
        .map(|corner| [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.0, 1.0]][corner % 4])
        .collect();
    let points = fine_moves(&corners, 100);
    for tolerance in [0.01, 0.05, 0.1] {
        let course = Course::of_lines([0.0, 0.0], &points, 150.0, tolerance);
        let [chosen, uninterrupted, interrupted] = durations(&course, [500.0, 2_000.0, 5e4]);
        let least = uninterrupted.min(interrupted);
        assert!(
            chosen <= least * (1.0 + SEARCHED),
            "{chosen} s instead of {least} s within {tolerance} mm"
        );
    }
}
