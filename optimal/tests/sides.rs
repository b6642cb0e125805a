//! Motion stays on the side of straight lines that is asked for.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_kinematics::{
    Feedrate, Limits, MotionPlanner, Move, PathSide, Plan, Tolerance, Toolpath, Trajectory, Vector,
};
use toolglide_optimal::{Settings, TimeOptimal, plan};
use toolglide_verify::{Judge, Report};

/// An S of two corners.
fn path() -> Toolpath<2> {
    let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [20.0, 10.0]].map(Vector::<2>::from);
    let feedrate = Feedrate::new(100.0).unwrap();
    Toolpath::from_points(&points, feedrate, Tolerance::new(0.03).unwrap()).unwrap()
}

fn limits() -> Limits<2> {
    Limits::uniform(500.0, 2000.0, 5e4).unwrap()
}

fn planned(path: &Toolpath<2>, side: PathSide, overshoot: f64) -> (Plan<2>, Report<2>) {
    let limits = limits();
    let settings = Settings::new(limits).with_side(side, overshoot);
    let motion = plan(path, &settings).unwrap();
    let mut judge = Judge::new(path.start(), limits).with_side(side, overshoot);
    for step in path.moves() {
        judge.expect(step).unwrap();
    }
    for piece in motion.pieces() {
        judge.observe(piece);
    }
    (motion, judge.finish())
}

#[test]
fn the_inner_side_of_corners_costs_a_few_hundredths_and_is_kept() {
    let (free, report) = planned(&path(), PathSide::Both, 0.0);
    let swing = report.smoothness.unwrap().outside;
    assert!(
        swing > 0.02,
        "the fastest motion swings beyond the line: {swing} mm"
    );
    for overshoot in [0.0, 0.003] {
        let (kept, report) = planned(&path(), PathSide::Inside, overshoot);
        assert!(report.passes(), "{:#?}", report.examples);
        let outside = report.smoothness.unwrap().outside;
        assert!(outside <= overshoot + 1e-6, "{outside} mm");
        let share = kept.duration() / free.duration();
        assert!(share > 1.005 && share < 1.05, "{overshoot}: {share}");
    }
}

#[test]
fn left_and_right_of_the_lines_are_kept() {
    for side in [PathSide::Left, PathSide::Right] {
        let (_, report) = planned(&path(), side, 0.0);
        assert!(report.passes(), "{side:?}: {:#?}", report.examples);
    }
}

/// Moves of about a length in random directions; with `stops` the motion rests after every fifth.
fn zigzag(seed: u32, length: f64, stops: bool) -> Toolpath<2> {
    let mut state = seed.wrapping_mul(2_654_435_761).wrapping_add(12345);
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1_u32 << 24)
    };
    let (feedrate, tolerance) = (Feedrate::new(100.0).unwrap(), Tolerance::new(0.03).unwrap());
    let mut path = Toolpath::starting_at(Vector::<2>::zeros()).unwrap();
    let (mut at, mut angle) = (Vector::<2>::zeros(), 0.0_f64);
    for index in 0..16 {
        // Some go nearly straight on.
        angle += if index % 4 == 3 {
            1e-3
        } else {
            4.0 * (random() - 0.5)
        };
        at += Vector::<2>::new(angle.cos(), angle.sin()) * (length * (0.1 + random()));
        let step = Move::line_to(at, feedrate, tolerance).unwrap();
        let rests = stops && index % 5 == 4;
        path.push(if rests { step.with_exact_stop() } else { step })
            .unwrap();
    }
    path
}

#[test]
fn sides_are_kept_around_stops_and_along_short_moves_that_go_nearly_straight_on() {
    for (seed, length) in [(0, 0.5), (1, 0.5), (2, 3.0), (3, 3.0), (4, 10.0), (5, 10.0)] {
        for stops in [false, true] {
            let path = zigzag(seed, length, stops);
            for side in [PathSide::Inside, PathSide::Left, PathSide::Right] {
                let (_, report) = planned(&path, side, 0.002);
                assert!(
                    report.passes(),
                    "{seed}, {stops}, {side:?}: {:#?}",
                    report.examples
                );
            }
        }
    }
}

#[test]
fn the_inner_side_of_random_corners_costs_less_than_a_sixth() {
    let mut total = [0.0; 2];
    for (seed, length) in [(2, 3.0), (3, 3.0), (4, 10.0), (5, 10.0)] {
        for stops in [false, true] {
            let path = zigzag(seed, length, stops);
            for (sum, side) in total.iter_mut().zip([PathSide::Both, PathSide::Inside]) {
                *sum += planned(&path, side, 0.0).0.duration();
            }
        }
    }
    let [free, kept] = total;
    assert!(kept < 7.0 / 6.0 * free, "{kept} s, {free} s");
}

#[test]
fn when_pieces_are_pulled_makes_no_difference_where_a_stop_waits_for_the_next_corner() {
    let path = zigzag(7, 3.0, true);
    let (motion, _) = planned(&path, PathSide::Inside, 0.0);
    let settings = Settings::new(limits()).with_side(PathSide::Inside, 0.0);
    let mut planner = TimeOptimal::<2>::new(path.start(), &settings);
    for step in path.moves() {
        planner.push(step).unwrap();
    }
    planner.finish().unwrap();
    let late: Vec<_> = std::iter::from_fn(|| planner.pull()).collect();
    assert_eq!(motion.pieces(), late, "the same pieces, bit for bit");
}
