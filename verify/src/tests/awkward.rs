//! Whatever comes, the judge judges; and what was once hard to find stays found.

use proptest::prelude::*;

use super::build::{limits, path, stop_and_go};
use crate::path::bernstein::Cubic;
use crate::path::deviation;
use crate::path::route::Route;
use crate::{Judge, SetPointJudge, verify, verify_set_points};
use toolglide_kinematics::{
    Arc, Feedrate, Limits, Move, MoveRange, Piece, Sample, Tolerance, Trajectory, Vector,
};

/// Numbers of all sizes, and what is none.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -10.0..10.0_f64,
        2 => Just(0.0),
        1 => (-320.0..308.0_f64).prop_map(|power| 10.0_f64.powf(power)),
        1 => -1e6..1e6_f64,
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(f64::MIN)],
    ]
}

fn vector() -> impl Strategy<Value = Vector<2>> {
    [number(), number()].prop_map(Vector::from)
}

fn any_move() -> impl Strategy<Value = (Vector<2>, Vector<2>, u32, f64, f64)> {
    (vector(), vector(), 0..6_u32, 1e-6..10.0_f64, 1e-3..1e3_f64)
}

/// A move of any kind from where the path has come to, if there can be one.
fn made(at: Vector<2>, any: &(Vector<2>, Vector<2>, u32, f64, f64)) -> Option<Move<2>> {
    let (end, center, kind, tolerance, feedrate) = *any;
    let tolerance = Tolerance::new(tolerance).ok()?;
    let feedrate = Feedrate::new(feedrate).ok()?;
    match kind {
        0 => Move::dwell(end[0], tolerance).ok(),
        1 => Arc::about(at, at, center, [0, 1], true, u32::MAX)
            .ok()
            .map(|arc| Move::arc(arc, feedrate, tolerance)),
        2 => {
            let end = center + (at - center) * 0.999_9;
            Arc::about(at, end, center, [0, 1], false, 3)
                .ok()
                .map(|arc| Move::arc(arc, feedrate, tolerance).with_exact_stop())
        }
        3 => Move::line_to(end, feedrate, tolerance)
            .ok()
            .map(Move::with_exact_stop),
        _ => Move::line_to(end, feedrate, tolerance).ok(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_piece_makes_the_judge_panic(
        moves in proptest::collection::vec(any_move(), 0..6),
        pieces in proptest::collection::vec(
            (vector(), vector(), vector(), vector(), vector(), number(), 0..7_u32, 0..7_u32), 0..8),
    ) {
        let mut at = Vector::zeros();
        let mut judge = Judge::new(at, limits());
        for any in &moves {
            if let Some(next) = made(at, any)
                && judge.expect(&next).is_ok()
            {
                at = next.end(at);
            }
        }
        for (position, velocity, acceleration, jerk, end, time, first, last) in pieces {
            let start = Sample { position, velocity, acceleration, jerk };
            let time = if time.is_finite() { time.abs() } else { 0.0 };
            judge.observe(&Piece::new(&start, time, end, MoveRange { first, last }));
        }
        let report = judge.finish();
        prop_assert!(report.examples.iter().all(|violation| !violation.to_string().is_empty()), "text");
        prop_assert!(report.deviation.value >= 0.0 && report.corner_error.value >= 0.0, "{report:?}");
    }

    #[test]
    fn no_set_point_makes_the_judge_panic(
        moves in proptest::collection::vec(any_move(), 0..6),
        points in proptest::collection::vec((number(), vector()), 0..12),
    ) {
        let mut at = Vector::zeros();
        let mut judge = SetPointJudge::new(at, limits(), 0.0);
        for any in &moves {
            if let Some(next) = made(at, any)
                && judge.expect(&next).is_ok()
            {
                at = next.end(at);
            }
        }
        let mut time = 0.0;
        let _ = judge.observe(time, Vector::zeros());
        for (step, position) in points {
            time += step.abs();
            let _ = judge.observe(time, position);
        }
        prop_assert!(judge.finish().deviation.value >= 0.0, "deviation");
    }
}

#[test]
fn a_deviation_that_grows_to_the_end_is_found_at_once() {
    // By share the second move is nearest at the start, by distance the first is at the end.
    let curve = Cubic {
        points: [[0.0, 1.588], [0.0, 0.0], [-1.674, 0.0], [0.0, 2.061]].map(Vector::from),
    };
    let mut route = Route::new(Vector::<2>::zeros());
    for (end, tolerance) in [(2.754, 0.01), (2.818, 0.777)] {
        let tolerance = Tolerance::new(tolerance).unwrap();
        let next = Move::line_to(Vector::from([end, 0.0]), Feedrate::RAPID, tolerance).unwrap();
        route.expect(&next).unwrap();
    }
    let found = deviation::largest(&route, &curve, 0, 1, [0.0; 2]);
    assert!((found.bounds[0] - 2.061).abs() < 1e-5, "{found:?}");
    assert!((found.attained[0].at - 1.0).abs() < 1e-9, "{found:?}");
}

#[test]
fn a_rapid_may_run_up_to_the_slow_move_that_goes_on_straight() {
    let tolerance = Tolerance::new(0.5).unwrap();
    let to =
        |x: f64, feedrate| Move::line_to(Vector::<2>::new(x, 0.0), feedrate, tolerance).unwrap();
    let slow = Feedrate::new(0.1).unwrap();
    let path = path(&[to(10.0, Feedrate::RAPID), to(10.5, slow)]);
    let plan = stop_and_go(&path, &limits());
    let points = super::build::set_points(&plan, 0.001);
    let report = verify_set_points(points, &path, &limits(), 0.0).unwrap();
    assert!(report.passes(), "{:?}", report.examples);
}

#[test]
fn huge_coordinates_and_tiny_moves_pass() {
    let tolerance = Tolerance::new(1e-4).unwrap();
    let far = Vector::<3>::new(1e5, -1e5, 9e4);
    let mut toolpath = toolglide_kinematics::Toolpath::starting_at(far).unwrap();
    let mut at = far;
    for k in 0..40_u32 {
        at[(k % 3) as usize] += if k % 2 == 0 { 1e-3 } else { 3e-4 };
        let step = Move::line_to(at, Feedrate::new(100.0).unwrap(), tolerance).unwrap();
        toolpath.push(step).unwrap();
    }
    let limits = Limits::uniform(200.0, 2_000.0, 50_000.0).unwrap();
    let plan = stop_and_go(&toolpath, &limits);
    let report = verify(&plan, &toolpath, &limits);
    assert!(report.passes(), "{:?}", report.examples);
    for period in [1e-3, 1e-5] {
        let mut points = super::build::set_points(&plan, period);
        // A last interval of a picosecond.
        points.insert(points.len() - 1, (plan.duration() - 1e-12, plan.end()));
        points.dedup_by(|after, before| after.0 <= before.0);
        let report = verify_set_points(points, &toolpath, &limits, 0.0).unwrap();
        assert!(report.passes(), "{period}: {:?}", report.examples);
    }
}
