//! No axis, no direction and no unit is better than another.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use proptest::prelude::*;
use toolglide_kinematics::Trajectory;
use toolglide_smoothing::{Method, Settings, plan};
use toolglide_tests::bounds::SAME_DURATION;
use toolglide_tests::course::{Course, Numbers, limits, rotated};
use toolglide_tests::run::try_all;
use toolglide_tests::strategies;

/// Cases of each property.
const CASES: u32 = 60;

fn duration<const N: usize>(course: &Course<N>, numbers: &Numbers<N>, method: Method) -> f64 {
    let settings = Settings::new(limits(numbers)).with_method(method);
    plan(&course.toolpath(), &settings).unwrap().duration()
}

fn same(one: f64, other: f64, method: Method) -> Result<(), TestCaseError> {
    prop_assert!(
        (one - other).abs() <= SAME_DURATION * one,
        "{}: {one} s and {other} s, relative {:e}",
        method.name(),
        other / one - 1.0
    );
    Ok(())
}

fn mirrored<const N: usize>() {
    try_all(strategies::courses::<N>(), CASES, |course, numbers| {
        for method in Method::ALL {
            let one = duration(course, numbers, method);
            for axis in 0..N {
                let other = duration(&course.mirrored(axis), numbers, method);
                same(one, other, method)?;
            }
        }
        Ok(())
    });
}

fn permuted<const N: usize>() {
    try_all(strategies::courses::<N>(), CASES, |course, numbers| {
        for method in Method::ALL {
            let one = duration(course, numbers, method);
            for by in 1..N {
                let other = duration(&course.rotated(by), &rotated(*numbers, by), method);
                same(one, other, method)?;
            }
        }
        Ok(())
    });
}

fn scaled<const N: usize>() {
    try_all(strategies::courses::<N>(), CASES, |course, numbers| {
        for method in Method::ALL {
            let one = duration(course, numbers, method);
            // Powers of two scale without rounding, so that no decision falls otherwise.
            for scale in [0.5, 2.0] {
                let fitting = numbers.map(|[velocity, acceleration, jerk]| {
                    [velocity * scale * scale, acceleration * scale, jerk]
                });
                let other = duration(&course.scaled(scale), &fitting, method);
                same(one, other / scale, method)?;
            }
        }
        Ok(())
    });
}

#[test]
fn a_mirrored_path_of_two_axes_takes_the_same_time() {
    mirrored::<2>();
}

#[test]
fn a_mirrored_path_of_three_axes_takes_the_same_time() {
    mirrored::<3>();
}

#[test]
fn axes_may_be_taken_in_another_order_in_two_axes() {
    permuted::<2>();
}

#[test]
fn axes_may_be_taken_in_another_order_in_four_axes() {
    permuted::<4>();
}

#[test]
fn lengths_of_the_cube_of_a_time_take_that_time_in_two_axes() {
    scaled::<2>();
}

#[test]
fn lengths_of_the_cube_of_a_time_take_that_time_in_three_axes() {
    scaled::<3>();
}
