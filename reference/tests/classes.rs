//! Compares what each class of motions allows, at a right angle.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{bend, course};
use toolglide_reference::{Class, Settings, optimum};

/// Duration of the optimum of a class at a right angle of a tolerance, mm.
fn least(tolerance: f64, class: Class) -> f64 {
    let course = course(&bend(90.0, 10.0), 2500.0, 2e5, tolerance);
    let course = course.of_class(class).unwrap();
    let settings = Settings::default().with_intervals(320);
    let best = optimum(&course, &[course.stopping_times()], &settings).unwrap();
    assert!(best.lower_bound() <= best.duration(), "{class:?}");
    best.sampled_duration()
}

#[test]
fn every_class_takes_what_it_took_before() {
    for (tolerance, class, duration) in [
        (0.02, Class::OneSided, 0.28244),
        (0.02, Class::TwoSided, 0.28338),
        (0.02, Class::NeverOutside, 0.28773),
        (0.01, Class::OneSided, 0.28639),
        (0.01, Class::NeverOutside, 0.29091),
        (0.1, Class::NeverOutside, 0.27787),
        // The zones in which kinematic corner smoothing leaves the lines.
        (0.01, Class::OnTheLines { reach: 0.056_57 }, 0.29307),
        (0.02, Class::OnTheLines { reach: 0.113_14 }, 0.28998),
        (0.1, Class::OnTheLines { reach: 0.565_7 }, 0.27924),
    ] {
        let found = least(tolerance, class);
        assert!(
            (found / duration - 1.0).abs() < 3e-4,
            "{tolerance} mm, {class:?}: {found} s instead of {duration} s"
        );
    }
}
