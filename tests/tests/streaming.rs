//! A motion that is pulled while the path is still being read is the motion pulled at the end.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use proptest::prelude::*;
use toolglide_kinematics::{MotionPlanner, Piece, PlanError};
use toolglide_smoothing::{KinematicSmoothing, Method, Settings};
use toolglide_tests::course::{Course, Numbers, limits};
use toolglide_tests::run::try_all;
use toolglide_tests::strategies;
use toolglide_tests::stream::plan_and_judge;

/// Cases of each kind of course.
const CASES: u32 = 60;

/// When the pieces are pulled.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pull {
    AfterEachPush,
    AfterEachThirdPush,
    OnePieceAPush,
    AtTheEnd,
}

fn pieces<const N: usize>(course: &Course<N>, settings: &Settings<N>, pull: Pull) -> Vec<Piece<N>> {
    let path = course.toolpath();
    let mut planner = KinematicSmoothing::new(path.start(), settings);
    let mut pieces = Vec::new();
    for (step, count) in path.moves().iter().zip(1..) {
        planner.push(step).unwrap();
        match pull {
            Pull::AtTheEnd => {}
            Pull::OnePieceAPush => pieces.extend(planner.pull()),
            Pull::AfterEachThirdPush if count % 3 != 0 => {}
            _ => pieces.extend(std::iter::from_fn(|| planner.pull())),
        }
    }
    planner.finish().unwrap();
    pieces.extend(std::iter::from_fn(|| planner.pull()));
    assert_eq!(planner.pull(), None, "the end is the end");
    pieces
}

fn streamed<const N: usize>(course: &Course<N>, numbers: &Numbers<N>) -> Result<(), TestCaseError> {
    for method in Method::ALL {
        for window in [2, 5, 512] {
            let settings = Settings::new(limits(numbers))
                .with_method(method)
                .with_window(window);
            let whole = pieces(course, &settings, Pull::AtTheEnd);
            for pull in [
                Pull::AfterEachPush,
                Pull::AfterEachThirdPush,
                Pull::OnePieceAPush,
            ] {
                let streamed = pieces(course, &settings, pull);
                prop_assert!(
                    streamed == whole,
                    "{} in a window of {window}, pulled {pull:?}: {} pieces, not {}",
                    method.name(),
                    streamed.len(),
                    whole.len()
                );
            }
        }
    }
    Ok(())
}

#[test]
fn the_time_of_pulling_does_not_matter_in_two_axes() {
    try_all(strategies::courses::<2>(), CASES, streamed);
}

#[test]
fn the_time_of_pulling_does_not_matter_in_three_axes() {
    try_all(strategies::courses::<3>(), CASES, streamed);
}

#[test]
fn the_time_of_pulling_does_not_matter_along_curves() {
    try_all(strategies::curves::<3>(), CASES, streamed);
}

#[test]
fn a_planner_and_a_judge_side_by_side_agree() {
    try_all(strategies::curves::<3>(), CASES, |course, numbers| {
        let (path, limits) = (course.toolpath(), limits(numbers));
        let settings = Settings::new(limits).with_window(16);
        let report = plan_and_judge(path.moves(), &settings, limits).report;
        prop_assert!(report.passes(), "{:#?}", report.examples);
        Ok(())
    });
}

#[test]
fn nothing_follows_the_end() {
    let course = Course::of_lines([0.0, 0.0], &[[1.0, 0.0]], 10.0, 0.01);
    let path = course.toolpath();
    let settings = Settings::new(limits(&[[100.0, 1e3, 1e4]; 2]));
    let mut planner = KinematicSmoothing::new(path.start(), &settings);
    planner.push(&path.moves()[0]).unwrap();
    planner.finish().unwrap();
    planner.finish().unwrap();
    let late = planner.push(&path.moves()[0]);
    assert!(
        matches!(late, Err(PlanError::Finished { index: 1 })),
        "{late:?}"
    );
}
