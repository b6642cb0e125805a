//! Optima that are known in closed form, between both bounds.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use toolglide_kinematics::{Feedrate, Limits, Tolerance, Vector};
use toolglide_reference::{Course, Settings, lower_bound, optimum};
use toolglide_verify::verify;

/// Relative precision of 100 intervals.
const HUNDRED: f64 = 3e-4;

fn hundred() -> Settings {
    Settings::default().with_intervals(100)
}

fn path(length: f64, turn: f64) -> [Vector<2>; 2] {
    let (sine, cosine) = turn.to_radians().sin_cos();
    [
        Vector::zeros(),
        Vector::<2>::new(length * cosine, length * sine),
    ]
}

#[test]
fn one_axis_from_rest_to_rest_is_bracketed() {
    for length in [10.0, 3.0, 1.0, 0.05] {
        let points = [Vector::<1>::new(0.0), Vector::<1>::new(length)];
        let course = common::course(&points, 2500.0, 2e5, 0.01);
        let exact = course.stopping_times()[0];
        let best = optimum(&course, &[vec![exact]], &hundred()).unwrap();
        let (low, high) = (best.lower_bound(), best.duration());
        assert!(low <= exact, "{length} mm: {low} > {exact}");
        assert!(
            high >= exact * (1.0 - 1e-9),
            "{length} mm: {high} < {exact}"
        );
        assert!(
            high / exact - 1.0 < HUNDRED,
            "{length} mm: {high} > {exact}"
        );
        assert!(1.0 - low / exact < HUNDRED, "{length} mm: {low} < {exact}");
    }
}

#[test]
fn a_grid_that_meets_the_switches_is_exact() {
    let points = [Vector::<1>::new(0.0), Vector::<1>::new(0.05)];
    let course = common::course(&points, 2500.0, 2e5, 0.01);
    let best = optimum(&course, &[vec![0.03]], &hundred()).unwrap();
    assert!(
        (best.sampled_duration() / 0.02 - 1.0).abs() < 1e-7,
        "{}",
        best.sampled_duration()
    );
}

#[test]
fn a_diagonal_may_use_the_limits_of_both_axes() {
    let root = 2.0_f64.sqrt();
    let course = common::course(&path(10.0, 45.0), 2500.0, 2e5, 0.01);
    let exact = 10.0 / 100.0 + 100.0 / (2500.0 * root) + 2500.0 / 2e5;
    let best = optimum(&course, &[course.stopping_times()], &hundred()).unwrap();
    assert!(
        (course.stopping_times()[0] - exact).abs() < 1e-12,
        "closed form"
    );
    assert!(best.lower_bound() <= exact, "{}", best.lower_bound());
    assert!(
        (best.duration() / exact - 1.0).abs() < 3.0 * HUNDRED,
        "{}",
        best.duration()
    );
}

#[test]
fn a_point_on_a_straight_line_costs_nothing() {
    let points = [0.0, 4.0, 10.0].map(|x| Vector::<2>::new(x, 0.0));
    let course = common::course(&points, 2500.0, 2e5, 0.01);
    let settings = Settings::default().with_intervals(200);
    let best = optimum(&course, &[course.stopping_times()], &settings).unwrap();
    assert!(
        (best.sampled_duration() / 0.1525 - 1.0).abs() < HUNDRED,
        "{}",
        best.sampled_duration()
    );
}

#[test]
fn a_badly_scaled_start_ends_at_the_same_optimum() {
    let course = common::course(&common::bend(90.0, 10.0), 2500.0, 2e5, 0.01);
    let times = course.stopping_times();
    let usual = optimum(&course, std::slice::from_ref(&times), &hundred()).unwrap();
    for factor in [1e-4, 1e-2, 1e2, 1e4] {
        let start: Vec<f64> = times.iter().map(|time| time * factor).collect();
        let found = optimum(&course, &[start], &hundred()).unwrap();
        let ratio = found.sampled_duration() / usual.sampled_duration();
        assert!((ratio - 1.0).abs() < 3e-5, "times {factor}: {ratio}");
    }
}

#[test]
fn the_optimum_passes_the_judge() {
    let points =
        [[0.0, 0.0], [3.0, 0.0], [3.5, 0.5], [3.5, 4.0], [0.0, 0.0]].map(Vector::<2>::from);
    let limits = Limits::new([
        toolglide_kinematics::AxisLimits::new(80.0, 2500.0, 2e5).unwrap(),
        toolglide_kinematics::AxisLimits::new(60.0, 1500.0, 1e5).unwrap(),
    ]);
    let tolerance = Tolerance::new(0.02).unwrap();
    for feedrate in [Feedrate::new(70.0).unwrap(), Feedrate::RAPID] {
        let course = Course::through(&points, limits, feedrate, tolerance).unwrap();
        let best = optimum(&course, &[course.stopping_times()], &Settings::default()).unwrap();
        let path =
            toolglide_kinematics::Toolpath::from_points(&points, feedrate, tolerance).unwrap();
        let report = verify(best.plan(), &path, &limits);
        assert!(report.passes(), "{report:?}");
        let low = lower_bound(&course, best.plan(), 240).unwrap();
        assert!(low <= best.duration(), "{low} > {}", best.duration());
        assert!(low > 0.995 * best.duration(), "{low} < {}", best.duration());
    }
}
