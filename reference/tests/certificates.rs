//! Bounds that hold for every motion around a corner.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{bend, course};
use toolglide_reference::{Class, ReferenceError, Settings, certify, optimum};

#[test]
fn nothing_is_faster_around_a_corner_than_the_optimum() {
    // Two-sided it takes some 200 programs to come within 4e-4.
    for (class, programs, gap) in [(Class::OneSided, 30, 3e-4), (Class::TwoSided, 16, 3e-2)] {
        let course = course(&bend(90.0, 10.0), 2500.0, 2e5, 0.1);
        let course = course.of_class(class).unwrap();
        let settings = Settings::default().with_intervals(400);
        let best = optimum(&course, &[course.stopping_times()], &settings).unwrap();
        let proved = certify(&course, best.duration(), programs).unwrap();
        assert!(proved.lower_bound <= best.duration(), "{proved:?}");
        assert!(
            proved.lower_bound > best.duration() * (1.0 - gap),
            "{class:?}: {proved:?} for {}",
            best.duration()
        );
    }
}

#[test]
fn a_certificate_is_for_one_corner() {
    let points = [0.0, 1.0].map(toolglide_kinematics::Vector::<1>::new);
    let course = course(&points, 2500.0, 2e5, 0.01);
    assert_eq!(
        certify(&course, 1.0, 10),
        Err(ReferenceError::NotOneCorner { legs: 1 })
    );
}
