//! Shows what the baselines of the text do that methods for machines do not.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_baselines::{BezierSmoothing, LocalOverlap, plan_bezier};
use toolglide_fir::FilterChain;
use toolglide_kinematics::{
    Arc, Feedrate, Limits, Move, Plan, Tolerance, Toolpath, Trajectory, Vector,
};
use toolglide_verify::{Violation, verify};

fn limits() -> Limits<2> {
    Limits::uniform(500.0, 2000.0, 1e5).unwrap()
}

fn path(points: &[[f64; 2]], tolerance: f64) -> Toolpath<2> {
    let points: Vec<_> = points.iter().copied().map(Vector::<2>::from).collect();
    let (feedrate, tolerance) = (
        Feedrate::new(100.0).unwrap(),
        Tolerance::new(tolerance).unwrap(),
    );
    Toolpath::from_points(&points, feedrate, tolerance).unwrap()
}

#[test]
fn a_spline_without_a_jerk_limit_is_faster_and_breaks_nothing_but_jerk() {
    let corner = path(&[[0.0, 0.0], [20.0, 0.0], [30.0, 17.0]], 0.05);
    let kept = plan_bezier(&corner, &limits()).unwrap();
    let mut free = BezierSmoothing::without_corner_jerk(corner.start(), limits()).unwrap();
    let free = Plan::of(&corner, &mut free).unwrap();
    assert!(
        free.duration() < kept.duration() - 0.005,
        "{} {}",
        free.duration(),
        kept.duration()
    );
    let report = verify(&free, &corner, &limits());
    assert!(report.violations > 0, "it breaks the jerk limit");
    for violation in &report.examples {
        assert!(matches!(violation, Violation::Jerk { .. }), "{violation}");
    }
    let acceleration = report.peak_acceleration.map(|peak| peak.value);
    assert!(
        acceleration[1] > 0.8 * 2000.0,
        "it saturates acceleration: {acceleration:?}"
    );
}

fn chain() -> FilterChain {
    FilterChain::with_time_constants(&[0.05, 0.03]).unwrap()
}

fn overlapped(path: &Toolpath<2>) -> Plan<2> {
    let free = Limits::uniform(500.0, 1e5, 1e8).unwrap();
    let mut planner = LocalOverlap::new(path.start(), free, chain());
    Plan::of(path, &mut planner).unwrap()
}

#[test]
fn the_local_rule_uses_the_tolerance_of_one_corner_and_no_more() {
    let corner = path(&[[0.0, 0.0], [20.0, 0.0], [20.0, 20.0]], 0.1);
    let plan = overlapped(&corner);
    let free = Limits::uniform(500.0, 1e5, 1e8).unwrap();
    let report = verify(&plan, &corner, &free);
    assert!(report.passes(), "{:?}", report.examples);
    let used = report.corner_error.value / 0.1;
    assert!((0.95..=1.0).contains(&used), "{used} of the tolerance");
    assert_eq!(plan.end(), corner.end());
}

#[test]
fn where_corners_are_dense_the_local_rule_breaks_the_tolerance() {
    // Turns of 10 degrees every 0.5 mm: each is overlapped as if the filters had forgotten the one before.
    let mut at = [0.0, 0.0];
    let points: Vec<[f64; 2]> = (0..24)
        .map(|k| {
            let angle = (10.0 * f64::from(k)).to_radians();
            let here = at;
            at = [at[0] + 0.5 * angle.cos(), at[1] + 0.5 * angle.sin()];
            here
        })
        .collect();
    let dense = path(&points, 0.2);
    let free = Limits::uniform(500.0, 1e5, 1e8).unwrap();
    let report = verify(&overlapped(&dense), &dense, &free);
    assert!(report.deviation_ratio.value > 2.0, "{:?}", report.deviation);
}

#[test]
fn an_arc_behind_the_filters_stays_near_its_circle() {
    let start = Vector::<2>::new(10.0, 0.0);
    let end = Vector::<2>::new(0.0, 10.0);
    let arc = Arc::about(start, end, Vector::zeros(), [0, 1], true, 0).unwrap();
    let mut path = Toolpath::starting_at(start).unwrap();
    let feedrate = Feedrate::new(20.0).unwrap();
    path.push(Move::arc(arc, feedrate, Tolerance::new(0.1).unwrap()))
        .unwrap();
    let plan = overlapped(&path);
    assert!((plan.end() - end).norm() < 1e-9, "{:?}", plan.end());
    for k in 0..100 {
        let at = plan.sample(plan.duration() * f64::from(k) / 100.0).position;
        assert!((at.norm() - 10.0).abs() < 0.01, "{at}");
    }
}
