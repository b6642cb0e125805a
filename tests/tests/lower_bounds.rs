//! No plan is faster than the bound at its own shares of time, whichever method made it.
//!
//! The bound knows the path and the motion; it shares no formula with any planner.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use proptest::prelude::*;
use std::cell::Cell;
use toolglide_kinematics::{Limits, Plan, Toolpath, Trajectory, Vector};
use toolglide_reference::{Section, lower_bound, part, sections};
use toolglide_smoothing::{Method, Settings};
use toolglide_tests::course::{Course, limits};
use toolglide_tests::run::try_all;
use toolglide_tests::strategies;

/// Random courses of each kind.
const CASES: u32 = 4;

/// Intervals of time of a bound.
const INTERVALS: usize = 80;

/// Sections of more legs are left out: their bound takes too long.
const MAX_LEGS: usize = 40;

/// Rounding that a bound may have, relative.
const ROUNDING: f64 = 1e-7;

/// Share of the bounds that the solver may fail to find.
const FAILED: f64 = 0.1;

fn plans<const N: usize>(path: &Toolpath<N>, limits: Limits<N>) -> Vec<(&'static str, Plan<N>)> {
    let smoothed = Method::ALL.map(|method| {
        let settings = Settings::new(limits).with_method(method);
        let plan = toolglide_smoothing::plan(path, &settings).unwrap();
        (method.name(), plan)
    });
    let filters = toolglide_fir::Settings::new(limits);
    let filtered = toolglide_fir::plan(path, &filters).unwrap();
    smoothed.into_iter().chain([("fir", filtered)]).collect()
}

/// Holds every plan of a path against its bound; gives how many bounds there were and how many were
/// not found.
fn hold<const N: usize>(
    path: &Toolpath<N>,
    limits: Limits<N>,
) -> Result<(u32, u32), TestCaseError> {
    let (mut found, mut failed) = (0, 0);
    let sections = sections(path, limits).unwrap();
    for (method, plan) in plans(path, limits) {
        for section in &sections {
            let Section::Course(course) = section else {
                continue;
            };
            if course.legs() > MAX_LEGS {
                continue;
            }
            let motion = part(&plan, course);
            match lower_bound(course, &motion, INTERVALS) {
                Ok(bound) => {
                    found += 1;
                    prop_assert!(
                        motion.duration() >= bound * (1.0 - ROUNDING),
                        "{method} takes {} s, but its bound is {bound} s",
                        motion.duration()
                    );
                }
                Err(_) => failed += 1,
            }
        }
    }
    Ok((found, failed))
}

fn hold_all<const N: usize>(courses: impl Strategy<Value = Course<N>>) {
    let counts = Cell::new((0, 0));
    try_all(courses, CASES, |course, numbers| {
        let (found, failed) = hold(&course.toolpath(), limits(numbers))?;
        let before = counts.get();
        counts.set((before.0 + found, before.1 + failed));
        Ok(())
    });
    let (found, failed) = counts.get();
    let share = f64::from(failed) / f64::from(found + failed);
    assert!(
        share <= FAILED,
        "{failed} bounds of {} failed",
        found + failed
    );
}

#[test]
fn no_plan_of_a_zigzag_in_two_axes_is_faster_than_its_bound() {
    hold_all(strategies::zigzags::<2>());
}

#[test]
fn no_plan_of_a_zigzag_in_three_axes_is_faster_than_its_bound() {
    hold_all(strategies::zigzags::<3>());
}

#[test]
fn no_plan_of_a_curve_is_faster_than_its_bound() {
    hold_all(strategies::curves::<2>());
}

#[test]
fn no_plan_of_any_path_is_faster_than_its_bound() {
    hold_all(strategies::courses::<2>());
}

#[test]
fn the_corner_on_the_lines_is_the_best_there_is() {
    // Kinematic smoothing leaves the lines within 0.0566 mm of the corner, and is optimal there.
    let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
    let limits = Limits::uniform(500.0, 2500.0, 2e5).unwrap();
    let feedrate = toolglide_kinematics::Feedrate::new(100.0).unwrap();
    let tolerance = toolglide_kinematics::Tolerance::new(0.01).unwrap();
    let path = Toolpath::from_points(&points, feedrate, tolerance).unwrap();
    let settings = Settings::new(limits).with_method(Method::KcsUninterrupted);
    let plan = toolglide_smoothing::plan(&path, &settings).unwrap();
    let reach = 0.056_569;
    let course = toolglide_reference::Course::through(&points, limits, feedrate, tolerance)
        .unwrap()
        .of_class(toolglide_reference::Class::OnTheLines { reach })
        .unwrap();
    let bound = lower_bound(&course, &plan, 400).unwrap();
    let duration = plan.duration();
    assert!(bound <= duration, "{bound} > {duration}");
    assert!(bound > duration * (1.0 - 2e-4), "{bound} < {duration}");
}
