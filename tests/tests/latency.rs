//! Motion is handed out as soon as nothing that comes later can change it.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_fastest::Fastest;
use toolglide_fir::FirInterpolation;
use toolglide_kinematics::{Limits, MotionPlanner, Trajectory};
use toolglide_smoothing::{KinematicSmoothing, Method, Settings};
use toolglide_tests::course::Course;

/// Moves that are pushed before the first piece comes out, and the most that are held later on, counted from the
/// move that the latest piece serves.
fn latency<const N: usize>(
    planner: &mut impl MotionPlanner<N>,
    course: &Course<N>,
) -> (usize, usize) {
    let (mut first, mut held, mut served) = (None, 0, 0);
    for (step, number) in course.toolpath().moves().iter().zip(1..) {
        planner.push(step).unwrap();
        while let Some(piece) = planner.pull() {
            first = first.or(Some(number));
            served = piece.serves().last as usize + 1;
        }
        if first.is_some() {
            held = held.max(number - served);
        }
    }
    (first.unwrap_or(usize::MAX), held)
}

fn limits() -> Limits<2> {
    Limits::uniform(500.0, 2_500.0, 2e5).unwrap()
}

/// A square spiral outwards, of moves of so many mm and more.
fn corners(length: f64, turn_degrees: f64, count: u32) -> Course<2> {
    let (mut at, mut ends) = ([0.0, 0.0], Vec::new());
    for number in 0..count {
        let angle = f64::from(number) * turn_degrees.to_radians();
        at = [at[0] + length * angle.cos(), at[1] + length * angle.sin()];
        ends.push(at);
    }
    Course::of_lines([0.0; 2], &ends, 100.0, 0.01)
}

#[test]
fn corners_between_long_moves_are_handed_out_after_three_moves() {
    for turn in [90.0, 60.0, 20.0, 5.0] {
        let course = corners(50.0, turn, 40);
        for method in Method::ALL {
            for window in [2, 4, 64, 512] {
                let settings = Settings::new(limits())
                    .with_method(method)
                    .with_window(window);
                let mut planner = KinematicSmoothing::new([0.0; 2].into(), &settings);
                let (first, held) = latency(&mut planner, &course);
                assert!(
                    first <= 3 && held <= 2,
                    "{} in a window of {window}, turns of {turn} degrees: {first} moves before the first piece, then {held} held",
                    method.name()
                );
            }
        }
    }
}

#[test]
fn a_line_of_long_moves_is_handed_out_though_they_could_be_merged() {
    let course = corners(50.0, 0.0, 40);
    let mut planner = KinematicSmoothing::new([0.0; 2].into(), &Settings::new(limits()));
    let (first, held) = latency(&mut planner, &course);
    assert!(
        first <= 3 && held <= 3,
        "{first} moves before the first piece, then {held} held"
    );
}

#[test]
fn corners_between_short_moves_wait_for_the_window_at_the_most() {
    for window in [2, 4, 16] {
        let course = corners(2.0, 100.0, 200);
        let settings = Settings::new(limits()).with_window(window);
        let mut planner = KinematicSmoothing::new([0.0; 2].into(), &settings);
        let (first, held) = latency(&mut planner, &course);
        // Beside the window: a move is known when the next one has come, at four places on its way.
        assert!(
            first <= window + 6 && held <= window + 6,
            "window of {window}: {first} moves before the first piece, then {held} held"
        );
    }
}

#[test]
fn runs_of_fine_moves_wait_for_the_window_too() {
    for window in [4, 16, 64] {
        // Chords of 0.2 mm of a circle.
        let course = corners(0.2, 2.0, 1000);
        let settings = Settings::new(limits()).with_window(window);
        let mut planner = KinematicSmoothing::new([0.0; 2].into(), &settings);
        let (first, _) = latency(&mut planner, &course);
        assert!(
            first <= 2 * window + 30,
            "window of {window}: {first} moves before the first piece"
        );
    }
}

#[test]
fn time_optimal_motion_of_long_moves_is_handed_out_after_three_moves() {
    for turn in [90.0, 60.0, 20.0] {
        let course = corners(50.0, turn, 24);
        let settings = toolglide_optimal::Settings::new(limits());
        let mut planner = toolglide_optimal::TimeOptimal::new([0.0; 2].into(), &settings);
        let (first, held) = latency(&mut planner, &course);
        assert!(
            first <= 3 && held <= 3,
            "turns of {turn} degrees: {first} moves before the first piece, then {held} held"
        );
    }
    // Along the edges of a cube in turn.
    let mut at = [0.0; 3];
    let ends: Vec<_> = (0..12)
        .map(|number| {
            at[number % 3] += 50.0;
            at
        })
        .collect();
    let course = Course::of_lines([0.0; 3], &ends, 100.0, 0.01);
    let limits = Limits::uniform(500.0, 2_500.0, 2e5).unwrap();
    let settings = toolglide_optimal::Settings::new(limits);
    let mut planner = toolglide_optimal::TimeOptimal::new([0.0; 3].into(), &settings);
    let (first, held) = latency(&mut planner, &course);
    assert!(
        first <= 3 && held <= 3,
        "along edges: {first} moves before the first piece, then {held} held"
    );
}

#[test]
fn filtered_pulses_of_long_moves_are_handed_out_after_three_moves() {
    for turn in [90.0, 60.0, 20.0, 5.0] {
        let course = corners(50.0, turn, 300);
        let settings = toolglide_fir::Settings::new(limits());
        let mut planner = FirInterpolation::new([0.0; 2].into(), &settings);
        let (first, held) = latency(&mut planner, &course);
        assert!(
            first <= 3 && held <= 3,
            "turns of {turn} degrees: {first} moves before the first piece, then {held} held"
        );
    }
}

#[test]
fn the_fastest_of_all_is_handed_out_after_three_long_moves() {
    for turn in [90.0, 60.0, 20.0, 5.0] {
        let course = corners(50.0, turn, 300);
        let mut planner = Fastest::new([0.0; 2].into(), limits());
        let (first, held) = latency(&mut planner, &course);
        assert!(
            first <= 3 && held <= 3,
            "turns of {turn} degrees: {first} moves before the first piece, then {held} held"
        );
    }
}

/// Cycle time of two moves at a right angle, the first so long, and of moves of a length that turn by so much.
fn filtered_time(first: f64, (length, turn_degrees): (f64, f64)) -> f64 {
    let mut at = [first, 50.0];
    let mut ends = vec![[first, 0.0], at];
    for number in 0..400 {
        let angle = f64::from(number) * turn_degrees.to_radians();
        at = [at[0] + length * angle.cos(), at[1] + length * angle.sin()];
        ends.push(at);
    }
    let course = Course::<2>::of_lines([0.0; 2], &ends, 100.0, 0.01);
    let settings = toolglide_fir::Settings::new(limits());
    let motion = toolglide_fir::plan(&course.toolpath(), &settings).unwrap();
    motion.duration() - first / 100.0
}

#[test]
fn filters_chosen_early_take_no_longer_than_those_chosen_for_more_moves() {
    for moves in [
        (50.0, 90.0),
        (50.0, 5.0),
        (30.0, 1.0),
        (1.0, 5.0),
        (0.2, 5.0),
        (1.0, 90.0),
    ] {
        // A short move at the beginning keeps all that follows waiting.
        let (early, late) = (filtered_time(50.0, moves), filtered_time(5.0, moves));
        assert!(
            early <= 1.001 * late + 0.05,
            "moves of {} mm, turns of {} degrees: {early} s, and {late} s for more moves",
            moves.0,
            moves.1
        );
    }
}
