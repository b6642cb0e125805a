//! Whatever the path, the limits, the method and the window: the judge finds nothing.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use proptest::prelude::*;
use std::cell::Cell;
use toolglide_kinematics::{Plan, Trajectory, verify};
use toolglide_smoothing::{Method, Settings, plan};
use toolglide_tests::bounds::{FEWEST_PLANS, NEVER_SLOWER};
use toolglide_tests::course::{Course, Numbers, limits};
use toolglide_tests::run::try_all;
use toolglide_tests::strategies;

/// Windows tried: the shortest that looks ahead, a short one, and the default.
const WINDOWS: [usize; 3] = [2, 5, 512];

/// Plans a course with every method and window and has each judged; gives how many there were.
fn judge<const N: usize>(course: &Course<N>, numbers: &Numbers<N>) -> Result<u32, TestCaseError> {
    let path = course.toolpath();
    let limits = limits(numbers);
    let mut plans = 0;
    for window in WINDOWS {
        let settings = Settings::new(limits).with_window(window);
        let with = |method| -> Result<Plan<N>, TestCaseError> {
            let planned = plan(&path, &settings.with_method(method)).unwrap();
            let report = verify(&planned, &path, &limits);
            prop_assert!(
                report.passes(),
                "{} in a window of {window}: {} violations, {:#?}",
                method.name(),
                report.violations,
                report.examples
            );
            Ok(planned)
        };
        let stopping = with(Method::ExactStop)?.duration();
        for method in Method::ALL {
            if method == Method::ExactStop {
                continue;
            }
            let duration = with(method)?.duration();
            prop_assert!(
                method != Method::Kcs || duration <= stopping * (1.0 + NEVER_SLOWER),
                "in a window of {window} kcs takes {duration} s, stopping {stopping} s"
            );
        }
        plans += 4;
    }
    Ok(plans)
}

/// Judges random courses.
fn judge_all<const N: usize>(courses: impl Strategy<Value = Course<N>>) {
    let plans = Cell::new(0);
    try_all(courses, CASES, |course, numbers| {
        plans.set(plans.get() + judge(course, numbers)?);
        Ok(())
    });
    assert!(plans.get() >= CASES * PLANS_A_CASE, "{} plans", plans.get());
}

/// Cases of each kind of course and number of axes.
const CASES: u32 = 40;

/// Every window with every method.
const PLANS_A_CASE: u32 = 12;

const _: () = assert!(9 * CASES * PLANS_A_CASE >= FEWEST_PLANS, "too few plans");

#[test]
fn any_path_in_two_axes_is_planned_within_its_limits() {
    judge_all(strategies::courses::<2>());
}

#[test]
fn any_path_in_three_axes_is_planned_within_its_limits() {
    judge_all(strategies::courses::<3>());
}

#[test]
fn any_path_in_four_axes_is_planned_within_its_limits() {
    judge_all(strategies::courses::<4>());
}

#[test]
fn zigzags_of_two_axes_are_planned_within_their_limits() {
    judge_all(strategies::zigzags::<2>());
}

#[test]
fn zigzags_of_three_axes_are_planned_within_their_limits() {
    judge_all(strategies::zigzags::<3>());
}

#[test]
fn zigzags_of_four_axes_are_planned_within_their_limits() {
    judge_all(strategies::zigzags::<4>());
}

#[test]
fn chords_of_curves_in_two_axes_are_planned_within_their_limits() {
    judge_all(strategies::curves::<2>());
}

#[test]
fn chords_of_curves_in_three_axes_are_planned_within_their_limits() {
    judge_all(strategies::curves::<3>());
}

#[test]
fn chords_of_curves_in_four_axes_are_planned_within_their_limits() {
    judge_all(strategies::curves::<4>());
}
