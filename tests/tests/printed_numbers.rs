//! Cycle times that were printed, or derived with five digits: a right angle, two corners of 45
//! degrees, and three programs.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_kinematics::{Limits, Trajectory};
use toolglide_smoothing::{Method, Settings, plan};
use toolglide_tests::bounds::PRINTED;
use toolglide_tests::corpus;
use toolglide_tests::course::Course;
use toolglide_tests::stream::plan_and_judge;
use toolglide_verify::verify;

fn close(duration: f64, printed: f64) {
    assert!(
        (duration / printed - 1.0).abs() <= PRINTED,
        "{duration:.5} s, printed {printed:.5} s"
    );
}

fn duration(course: &Course<2>, limits: Limits<2>, method: Method) -> f64 {
    let path = course.toolpath();
    let motion = plan(&path, &Settings::new(limits).with_method(method)).unwrap();
    let report = verify(&motion, &path, &limits);
    assert!(report.passes(), "{:#?}", report.examples);
    motion.duration()
}

/// Two moves of 10 mm at 100 mm/s with a right angle between them.
fn right_angle(tolerance: f64, method: Method) -> f64 {
    let course = Course::of_lines([0.0, 0.0], &[[10.0, 0.0], [10.0, 10.0]], 100.0, tolerance);
    let limits = Limits::uniform(500.0, 2_500.0, 2e5).unwrap();
    duration(&course, limits, method)
}

#[test]
fn a_right_angle_with_a_full_stop() {
    close(right_angle(0.1, Method::ExactStop), 0.305_00);
    close(right_angle(0.01, Method::ExactStop), 0.305_00);
}

#[test]
fn a_right_angle_interrupted() {
    close(right_angle(0.1, Method::KcsInterrupted), 0.296_05);
    close(right_angle(0.01, Method::KcsInterrupted), 0.309_70);
}

#[test]
fn a_right_angle_uninterrupted() {
    close(right_angle(0.1, Method::KcsUninterrupted), 0.290_00);
    close(right_angle(0.01, Method::KcsUninterrupted), 0.293_07);
}

#[test]
fn a_right_angle_takes_no_longer_than_its_best_corner() {
    assert!(
        right_angle(0.1, Method::Kcs) <= 0.290_00 * (1.0 + PRINTED),
        "0.1 mm"
    );
    assert!(
        right_angle(0.01, Method::Kcs) <= 0.293_07 * (1.0 + PRINTED),
        "0.01 mm"
    );
}

#[test]
fn two_corners_of_45_degrees_half_a_millimetre_apart() {
    let half = 0.5 * std::f64::consts::FRAC_1_SQRT_2;
    let ends = [[10.0, 0.0], [10.0 + half, half], [10.0 + half, 10.0 + half]];
    let course = Course::of_lines([0.0, 0.0], &ends, 100.0, 0.009);
    let limits = Limits::uniform(500.0, 3_000.0, 1e5).unwrap();
    close(
        duration(&course, limits, Method::KcsUninterrupted),
        0.357_40,
    );
    let best = duration(&course, limits, Method::Kcs);
    assert!(best <= 0.357_40 * (1.0 + PRINTED), "{best:.5} s");
}

/// Cycle time of a program at 2000 mm/s² and 50000 mm/s³, judged as it streams; `None` where the
/// program is not at hand.
fn program(name: &str, tolerance: f64) -> Option<f64> {
    let text = corpus::text(name)?;
    let limits = Limits::<3>::uniform(1_000.0, 2_000.0, 5e4).unwrap();
    let moves = corpus::moves(&text, name, tolerance).unwrap();
    let report = plan_and_judge(&moves, &Settings::new(limits), limits).report;
    eprintln!("{name} {:.4} s", report.cycle_time);
    assert!(report.passes(), "{name}: {:#?}", report.examples);
    Some(report.cycle_time)
}

#[test]
fn a_spiral_of_moves_of_a_millimetre() {
    if let Some(time) = program("bench/spiral1mm.ngc", 0.05) {
        assert!(time <= 4.6, "{time:.4} s");
    }
}

#[test]
fn a_zigzag_of_two_thousand_corners() {
    if let Some(time) = program("bench/zig2000.ngc", 0.05) {
        assert!(time <= 225.0, "{time:.4} s");
    }
}

#[test]
fn a_curve_of_twenty_thousand_moves() {
    if let Some(time) = program("bench/liss20k.ngc", 0.01) {
        assert!(time <= 9.0, "{time:.4} s");
    }
}
