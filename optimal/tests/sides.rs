//! Motion stays on the side of straight lines that is asked for.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_kinematics::{
    Feedrate, Limits, PathSide, Plan, Tolerance, Toolpath, Trajectory, Vector,
};
use toolglide_optimal::{Settings, plan};
use toolglide_verify::{Judge, Report};

fn path() -> Toolpath<2> {
    let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [20.0, 10.0]].map(Vector::<2>::from);
    let feedrate = Feedrate::new(100.0).unwrap();
    Toolpath::from_points(&points, feedrate, Tolerance::new(0.03).unwrap()).unwrap()
}

fn planned(side: PathSide, overshoot: f64) -> (Plan<2>, Report<2>) {
    let limits = Limits::<2>::uniform(500.0, 2000.0, 5e4).unwrap();
    let path = path();
    let settings = Settings::new(limits).with_side(side, overshoot);
    let motion = plan(&path, &settings).unwrap();
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
    let (free, report) = planned(PathSide::Both, 0.0);
    let swing = report.smoothness.unwrap().outside;
    assert!(
        swing > 0.02,
        "the fastest motion swings beyond the line: {swing} mm"
    );
    for overshoot in [0.0, 0.003] {
        let (kept, report) = planned(PathSide::Inside, overshoot);
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
        let (_, report) = planned(side, 0.0);
        assert!(report.passes(), "{side:?}: {:#?}", report.examples);
    }
}
