//! Whole programs through windows, judged, with a general conic solver in the place of the own one.

#![allow(
    clippy::unwrap_used,
    clippy::cast_precision_loss,
    reason = "a failed unwrap is a failed test; counts are small"
)]

mod clarabel;
mod common;

use clarabel::Conic;
use common::{Failing, run, run_with};
use toolglide_kinematics::{
    AxisLimits, Feedrate, Limits, MotionPlanner, Move, Plan, Tolerance, Toolpath, Trajectory,
    Vector,
};
use toolglide_optimal::{ScpSolver, Settings, Smoothing, TimeOptimal, plan_with};
use toolglide_verify::verify;

fn judged<const N: usize>(points: &[Vector<N>], tolerance: f64, limits: Limits<N>) -> Plan<N> {
    let path = Toolpath::from_points(
        points,
        Feedrate::new(100.0).unwrap(),
        Tolerance::new(tolerance).unwrap(),
    )
    .unwrap();
    let plan = plan_with(Conic::default(), &path, &Settings::new(limits)).unwrap();
    let report = verify(&plan, &path, &limits);
    assert!(report.passes(), "{:#?}", report.examples);
    plan
}

#[test]
fn a_corner_takes_the_time_of_the_optimum() {
    let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
    let limits = Limits::uniform(500.0, 2500.0, 2e5).unwrap();
    for (tolerance, optimum) in [(0.01, 0.28712), (0.1, 0.27146)] {
        let duration = judged(&points, tolerance, limits).duration();
        assert!(duration < optimum * 1.003, "{tolerance}: {duration}");
    }
}

#[test]
fn both_solvers_find_the_same_motion() {
    let points = [
        [0.0, 0.0],
        [6.0, 0.0],
        [6.5, 0.5],
        [6.5, 4.0],
        [4.0, 4.0],
        [3.0, 7.0],
    ]
    .map(Vector::<2>::from);
    let limits = Limits::uniform(500.0, 2000.0, 5e4).unwrap();
    let path = Toolpath::from_points(
        &points,
        Feedrate::new(100.0).unwrap(),
        Tolerance::new(0.05).unwrap(),
    )
    .unwrap();
    let (general, _) = run(Conic::default(), &path, limits);
    let (own, _) = run(ScpSolver::new(), &path, limits);
    let ratio = own.duration() / general.duration();
    assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
}

#[test]
fn the_middle_of_long_moves_takes_no_windows_and_the_faster_motion_may_change_there() {
    let limits = Limits::uniform(500.0, 2000.0, 5e4).unwrap();
    let square = |side: f64| {
        let points: Vec<_> = (0..13_u32)
            .map(|k| [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]][k as usize % 4])
            .map(Vector::<2>::from)
            .collect();
        let feedrate = Feedrate::new(100.0).unwrap();
        Toolpath::from_points(&points, feedrate, Tolerance::new(0.05).unwrap()).unwrap()
    };
    let (near, far) = (square(40.0), square(4000.0));
    let fastest = Settings::new(limits).with_smoothing(Smoothing::NONE);
    let (short, few) = run_with(ScpSolver::new(), &near, &fastest);
    let (long, many) = run_with(ScpSolver::new(), &far, &fastest);
    for (plan, path) in [(&short, &near), (&long, &far)] {
        let report = verify(plan, path, &limits);
        assert!(report.passes(), "{:#?}", report.examples);
    }
    assert_eq!(few.windows, many.windows, "corners are all that is planned");
    assert_eq!(few.stretches, 13, "eleven corners and two ends: {few:?}");
    assert!(few.yielded <= 2, "start and stop: {few:?}");
    let apart = long.duration() - short.duration();
    let straight = 12.0 * (4000.0 - 40.0) / 100.0;
    assert!(
        (apart - straight).abs() < 1e-6,
        "{apart} s for {straight} s"
    );
    // Who may be slower by a share of a stretch takes the motion with less jerk around the corners of long ones.
    let smoother = Settings::new(limits);
    let (longer, _) = run_with(ScpSolver::new(), &far, &smoother);
    let given = longer.duration() / long.duration() - 1.0;
    assert!(
        given > 1e-4 && given <= smoother.smoothing.indifference(),
        "{given}"
    );
    let settings = toolglide_smoothing::Settings::new(limits);
    let smoothed = toolglide_smoothing::plan(&near, &settings).unwrap();
    assert!(
        short.duration() < smoothed.duration() - 11.0 * 0.003,
        "{} s, {} s",
        short.duration(),
        smoothed.duration()
    );
}

#[test]
fn feedrates_that_change_at_corners_are_kept_by_windows() {
    let room = Tolerance::new(0.03).unwrap();
    let mut path = Toolpath::starting_at(Vector::<2>::zeros()).unwrap();
    let mut at = Vector::<2>::zeros();
    for k in 0..60_u32 {
        let angle = 0.9 * f64::from(k % 4) - 0.7 * f64::from(k % 3);
        at += Vector::<2>::new(angle.cos(), angle.sin()) * (0.3 + 0.4 * f64::from(k % 5));
        let feedrate = match k % 6 {
            0 => Feedrate::RAPID,
            1 | 2 => Feedrate::new(15.0).unwrap(),
            _ => Feedrate::new(60.0).unwrap(),
        };
        path.push(Move::line_to(at, feedrate, room).unwrap())
            .unwrap();
    }
    let limits = Limits::uniform(500.0, 2500.0, 2e5).unwrap();
    let (plan, tally) = run(ScpSolver::new(), &path, limits);
    let report = verify(&plan, &path, &limits);
    assert!(report.passes(), "{tally:?} {:#?}", report.examples);
    assert!(tally.windows > 3 && tally.kept == 0, "{tally:?}");
}

#[test]
fn where_a_window_does_not_lead_to_the_middle_of_a_long_move_it_is_reached_from_rest() {
    let points = [
        [0.0, 0.0],
        [60.0, 0.0],
        [60.0, 1.0],
        [0.0, 30.0],
        [0.0, 90.0],
    ]
    .map(Vector::<2>::from);
    let path = Toolpath::from_points(
        &points,
        Feedrate::new(100.0).unwrap(),
        Tolerance::new(0.05).unwrap(),
    )
    .unwrap();
    let limits = Limits::new([
        AxisLimits::new(500.0, 2000.0, 5e4).unwrap(),
        AxisLimits::new(80.0, 900.0, 9e3).unwrap(),
    ]);
    for every in 1..4 {
        let failing = Failing::every(every);
        let (plan, tally) = run(failing, &path, limits);
        let report = verify(&plan, &path, &limits);
        assert!(report.passes(), "{every}, {tally:?} {:#?}", report.examples);
    }
}

#[test]
fn pauses_that_follow_each_other_all_last() {
    let room = Tolerance::new(0.05).unwrap();
    let limits = Limits::uniform(500.0, 2000.0, 5e4).unwrap();
    let line = |x: f64| {
        let to = Vector::<2>::new(x, 0.0);
        Move::line_to(to, Feedrate::new(100.0).unwrap(), room).unwrap()
    };
    let pause = |duration: f64| Move::dwell(duration, room).unwrap();
    let mut path = Toolpath::starting_at(Vector::<2>::zeros()).unwrap();
    for step in [
        pause(0.0),
        line(5.0),
        pause(1.0),
        pause(0.0),
        line(5.0).with_exact_stop(),
        line(5.0),
        pause(0.5),
        line(10.0),
        line(10.001),
        line(10.0),
        pause(0.25),
        line(10.0),
        pause(0.0),
    ] {
        path.push(step).unwrap();
    }
    let (plan, tally) = run(ScpSolver::new(), &path, limits);
    let report = verify(&plan, &path, &limits);
    assert!(report.passes(), "{tally:?} {:#?}", report.examples);
    assert!(plan.duration() > 1.75, "{} s", plan.duration());
}

#[test]
fn when_pieces_are_pulled_makes_no_difference() {
    let points: Vec<_> = (0..60)
        .map(|k| Vector::<2>::new(f64::from(k), f64::from(k % 3) * 0.7))
        .collect();
    let limits = Limits::uniform(500.0, 2000.0, 5e4).unwrap();
    let path = Toolpath::from_points(
        &points,
        Feedrate::new(100.0).unwrap(),
        Tolerance::new(0.05).unwrap(),
    )
    .unwrap();
    // The planner brings a solver that looks for the least jerk.
    let settings = Settings::new(limits);
    let solver = ScpSolver::new().with_smoothing(settings.smoothing);
    let (plan, tally) = run_with(solver, &path, &settings);
    assert!(tally.windows > 3, "{tally:?}");
    let mut planner = TimeOptimal::<2>::new(path.start(), &settings);
    for step in path.moves() {
        planner.push(step).unwrap();
    }
    planner.finish().unwrap();
    let late: Vec<_> = std::iter::from_fn(|| planner.pull()).collect();
    assert_eq!(plan.pieces(), late, "the same pieces, bit for bit");
    assert_eq!(planner.pull(), None, "nothing after the end");
    let step = path.moves()[0];
    assert!(planner.push(&step).is_err(), "no moves after the end");
}
