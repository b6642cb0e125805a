//! Corners of curvature-optimal quintics, judged by the judge that judges everything.
//!
//! Not here: how they compare with other methods over whole programs.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use proptest::prelude::*;
use toolglide_baselines::{BezierSmoothing, plan_bezier};
use toolglide_kinematics::{
    Arc, AxisLimits, Feedrate, Limits, MotionPlanner, Move, Piece, Tolerance, Toolpath, Trajectory,
    Vector,
};
use toolglide_smoothing::{Settings, plan};
use toolglide_verify::{Report, verify};

/// Share of the tolerance that a corner with long legs must use.
const USED: f64 = 0.98;

fn limits<const N: usize>() -> Limits<N> {
    Limits::uniform(500.0, 2500.0, 2e5).unwrap()
}

fn path<const N: usize>(points: &[[f64; N]], feedrate: f64, tolerance: f64) -> Toolpath<N> {
    let points: Vec<_> = points.iter().copied().map(Vector::<N>::from).collect();
    Toolpath::from_points(
        &points,
        Feedrate::new(feedrate).unwrap(),
        Tolerance::new(tolerance).unwrap(),
    )
    .unwrap()
}

fn judged<const N: usize>(path: &Toolpath<N>, limits: &Limits<N>) -> Report<N> {
    let motion = plan_bezier(path, limits).unwrap();
    assert!(
        motion.duration().is_finite() && motion.duration() >= 0.0,
        "{}",
        motion.duration()
    );
    verify(&motion, path, limits)
}

#[track_caller]
fn passes<const N: usize>(path: &Toolpath<N>, limits: &Limits<N>) -> Report<N> {
    let report = judged(path, limits);
    assert!(report.passes(), "{:#?}\n{path:?}", report.examples);
    report
}

#[test]
fn corners_with_long_legs_use_the_whole_tolerance() {
    for degrees in [15.0_f64, 45.0, 60.0, 90.0, 120.0, 150.0] {
        for tolerance in [0.1, 0.01] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let corner = [[0.0, 0.0], [10.0, 0.0], [10.0 + 10.0 * cosine, 10.0 * sine]];
            let report = passes(&path(&corner, 100.0, tolerance), &limits());
            let used = report.corner_error.value / tolerance;
            // A gentle turn reaches the feedrate with less.
            let reaches = report.corner_error.value > 0.0 && degrees < 40.0;
            assert!(
                reaches || (USED..=1.0).contains(&used),
                "{degrees} {tolerance} {used}"
            );
        }
    }
}

#[test]
fn a_right_angle_takes_longer_than_with_blended_velocities() {
    let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]];
    for tolerance in [0.1, 0.01] {
        let path = path(&corner, 100.0, tolerance);
        let report = passes(&path, &limits());
        let blended = plan(&path, &Settings::new(limits())).unwrap().duration();
        eprintln!(
            "right angle, tolerance {tolerance}: {:.5} s, blended {blended:.5} s",
            report.cycle_time
        );
        // The jerk at constant speed is so dear here that a stop, 0.305 s, would be faster.
        assert!(report.cycle_time < 0.32, "{}", report.cycle_time);
        assert!(report.cycle_time > blended, "{}", report.cycle_time);
    }
}

#[test]
fn a_right_angle_is_faster_than_a_stop_where_jerk_is_cheap() {
    let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]];
    let jerky = Limits::uniform(500.0, 2500.0, 2e6).unwrap();
    let report = passes(&path(&corner, 100.0, 0.1), &jerky);
    let stop = 2.0 * (10.0 / 100.0 + 100.0 / 2500.0 + 2500.0 / 2e6);
    assert!(report.cycle_time < stop, "{} {stop}", report.cycle_time);
}

#[test]
fn a_straight_path_is_one_motion() {
    let whole = passes(&path(&[[0.0, 0.0], [30.0, 0.0]], 100.0, 0.1), &limits());
    let cut = [[0.0, 0.0], [7.0, 0.0], [7.0, 0.0], [11.0, 0.0], [30.0, 0.0]];
    let cut = passes(&path(&cut, 100.0, 0.1), &limits());
    assert!(
        (cut.cycle_time - whole.cycle_time).abs() < 1e-9,
        "{} {}",
        cut.cycle_time,
        whole.cycle_time
    );
}

#[test]
fn a_reversal_is_a_stop() {
    for off in [0.0, 1e-9, 1e-3, 0.1, 1.0] {
        let there_and_back = [[0.0, 0.0], [10.0, 0.0], [0.0, off]];
        let report = passes(&path(&there_and_back, 100.0, 0.1), &limits());
        assert!(
            report.cycle_time < 0.3051 * (1.0 + off),
            "{off} {}",
            report.cycle_time
        );
    }
}

#[test]
fn very_short_legs_are_travelled() {
    for length in [1e-9, 1e-6, 1e-3, 0.02] {
        let points: Vec<_> = (0..60_u32)
            .map(|index| {
                let along = f64::from(index) * length;
                [along, if index % 2 == 0 { 0.0 } else { 0.3 * length }]
            })
            .collect();
        passes(&path(&points, 100.0, 0.01), &limits());
    }
}

#[test]
fn tiny_turns_cost_nothing() {
    for turn in [1e-13, 1e-11, 1e-9, 1e-6, 1e-4] {
        let points = [[0.0, 0.0], [15.0, 0.0], [30.0, 15.0 * turn]];
        let report = passes(&path(&points, 100.0, 0.1), &limits());
        let straight = passes(&path(&[[0.0, 0.0], [30.0, 0.0]], 100.0, 0.1), &limits());
        assert!(
            report.cycle_time < straight.cycle_time * 1.001,
            "{turn} {}",
            report.cycle_time
        );
    }
}

#[test]
fn arcs_dwells_and_exact_stops_are_respected() {
    let (feedrate, tolerance) = (Feedrate::new(80.0).unwrap(), Tolerance::new(0.02).unwrap());
    let mut path = Toolpath::starting_at(Vector::<2>::zeros()).unwrap();
    let line = |x: f64, y: f64| Move::line_to(Vector::<2>::new(x, y), feedrate, tolerance).unwrap();
    path.push(Move::dwell(0.1, tolerance).unwrap()).unwrap();
    path.push(line(5.0, 0.0)).unwrap();
    let arc = Arc::about(
        Vector::<2>::new(5.0, 0.0),
        Vector::<2>::new(9.0, 4.0),
        Vector::<2>::new(5.0, 4.0),
        [0, 1],
        true,
        0,
    );
    path.push(Move::arc(arc.unwrap(), feedrate, tolerance))
        .unwrap();
    path.push(line(9.0, 10.0).with_exact_stop()).unwrap();
    path.push(line(9.0, 10.0)).unwrap();
    path.push(line(3.0, 10.0)).unwrap();
    path.push(Move::dwell(0.2, tolerance).unwrap()).unwrap();
    path.push(line(3.0, 3.0)).unwrap();
    path.push(line(3.0, 3.0)).unwrap();
    passes(&path, &limits());
}

#[test]
fn streaming_gives_the_same_motion() {
    let points: Vec<_> = (0..700_u32)
        .map(|index| {
            let at = f64::from(index);
            [0.3 * at, (1.7 * at).sin(), (0.9 * at).cos()]
        })
        .collect();
    let path = path(&points, 120.0, 0.02);
    let whole = plan_bezier(&path, &limits()).unwrap();
    let mut planner = BezierSmoothing::new(path.start(), limits());
    for step in path.moves() {
        planner.push(step).unwrap();
    }
    planner.finish().unwrap();
    let pieces: Vec<Piece<3>> = std::iter::from_fn(|| planner.pull()).collect();
    assert!(pieces == whole.pieces(), "{} pieces", pieces.len());
    passes(&path, &limits());
}

#[test]
fn fine_curves_are_not_stopped_at() {
    let points: Vec<_> = (0..400_u32)
        .map(|index| {
            let angle = 0.02 * f64::from(index);
            [20.0 * angle.cos(), 20.0 * angle.sin()]
        })
        .collect();
    let path = path(&points, 100.0, 0.05);
    let report = passes(&path, &limits());
    eprintln!("circle of chords: {:.3} s", report.cycle_time);
    assert!(report.cycle_time < 4.0, "{}", report.cycle_time);
}

fn axis() -> impl Strategy<Value = [f64; 3]> {
    (10.0..1000.0_f64, 100.0..30_000.0_f64, 3.0..1000.0_f64)
        .prop_map(|(velocity, acceleration, ratio)| [velocity, acceleration, acceleration * ratio])
}

fn zigzag<const N: usize>() -> impl Strategy<Value = (Toolpath<N>, Limits<N>)> {
    (
        prop::collection::vec(prop::collection::vec(-1.0..1.0_f64, N), 2..30),
        prop::collection::vec(axis(), N),
        (-3.0..1.5_f64, -3.0..0.0_f64, 0.5..3.0_f64),
        -900.0..900.0_f64,
    )
        .prop_map(|(steps, axes, (size, tolerance, feedrate), start)| {
            let mut points = vec![[start; N]];
            for step in steps {
                let mut next = points[points.len() - 1];
                for (coordinate, change) in next.iter_mut().zip(&step) {
                    *coordinate += change * 10.0_f64.powf(size);
                }
                points.push(next);
            }
            let path = path(&points, 10.0_f64.powf(feedrate), 10.0_f64.powf(tolerance));
            let limits = Limits::new(std::array::from_fn(|axis| {
                let [velocity, acceleration, jerk] = axes[axis];
                AxisLimits::new(velocity, acceleration, jerk).unwrap()
            }));
            (path, limits)
        })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_plane_paths_keep_everything((path, limits) in zigzag::<2>()) {
        let report = judged(&path, &limits);
        prop_assert!(report.passes(), "{:#?}", report.examples);
    }

    #[test]
    fn random_spatial_paths_keep_everything((path, limits) in zigzag::<3>()) {
        let report = judged(&path, &limits);
        prop_assert!(report.passes(), "{:#?}", report.examples);
    }
}
