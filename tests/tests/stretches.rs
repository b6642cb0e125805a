//! Runs of fine moves are entered, travelled on and left at speed.
//!
//! Not here: that they are legal, which every random course shows.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_kinematics::{MotionPlanner, Plan, Trajectory};
use toolglide_smoothing::{KinematicSmoothing, Method, Settings, plan};
use toolglide_tests::course::{Course, limits};
use toolglide_verify::verify;

const FEEDRATE: f64 = 100.0;
const LIMITS: [[f64; 3]; 2] = [[500.0, 2_000.0, 5e4]; 2];

/// Radius of the curves, at which their feedrate is a quarter of what the acceleration allows.
const RADIUS: f64 = 20.0;

/// A curve of fine chords from a point, at first along X, over an angle; its end and last direction.
fn curve(points: &mut Vec<[f64; 2]>, from: [f64; 2], angle: f64, chords: u32) {
    for chord in 1..=chords {
        let at = angle * f64::from(chord) / f64::from(chords);
        points.push([
            from[0] + RADIUS * at.sin(),
            from[1] + RADIUS * (1.0 - at.cos()),
        ]);
    }
}

fn planned(points: &[[f64; 2]]) -> Plan<2> {
    planned_at(points, FEEDRATE)
}

fn planned_at(points: &[[f64; 2]], feedrate: f64) -> Plan<2> {
    let course = Course::of_lines([0.0, 0.0], points, feedrate, 0.05);
    let path = course.toolpath();
    let limits = limits(&LIMITS);
    let motion = plan(&path, &Settings::new(limits)).unwrap();
    let report = verify(&motion, &path, &limits);
    assert!(report.passes(), "{:#?}", report.examples);
    motion
}

/// The least speed between two instants.
fn least_speed(motion: &Plan<2>, from: f64, to: f64) -> f64 {
    (0..=2_000_u32)
        .map(|tick| {
            let time = from + (to - from) * f64::from(tick) / 2_000.0;
            motion.sample(time).velocity.norm()
        })
        .fold(f64::INFINITY, f64::min)
}

/// The first instant at which a motion has come to a height, and has it for good.
fn time_at_height(motion: &Plan<2>, height: f64) -> f64 {
    let mut time = 0.0;
    for piece in motion.pieces() {
        if piece.end()[1] >= height {
            break;
        }
        time += piece.duration();
    }
    time
}

#[test]
fn a_curve_goes_on_at_speed_where_more_of_it_becomes_known() {
    // Many times the moves that are collected before planning begins.
    let mut points = Vec::new();
    curve(&mut points, [0.0, 0.0], 40.0, 8_000);
    let motion = planned(&points);
    let least = least_speed(&motion, 0.2, motion.duration() - 0.2);
    assert!(least > 0.97 * FEEDRATE, "{least} mm/s");
}

#[test]
fn a_curve_is_entered_at_speed_after_a_sharp_corner() {
    let mut points = vec![[0.0, -40.0], [40.0, -40.0]];
    curve(&mut points, [40.0, -40.0], 1.5, 300);
    let motion = planned(&points);
    // From the sharp corner on it speeds up, on the straight move, and only the end is at rest.
    let corner = motion
        .pieces()
        .iter()
        .take_while(|piece| piece.end()[0] < 20.0)
        .map(toolglide_kinematics::Piece::duration)
        .sum::<f64>();
    let least = least_speed(&motion, corner, motion.duration() - 0.2);
    assert!(least > 0.85 * FEEDRATE, "{least} mm/s");
}

#[test]
fn a_curve_is_left_at_speed_before_a_sharp_corner() {
    let mut points = Vec::new();
    curve(&mut points, [0.0, 0.0], std::f64::consts::FRAC_PI_2, 300);
    points.push([RADIUS, RADIUS + 40.0]);
    points.push([RADIUS + 40.0, RADIUS + 40.0]);
    let motion = planned(&points);
    let leaving = time_at_height(&motion, RADIUS + 20.0);
    let least = least_speed(&motion, 0.2, leaving);
    assert!(least > 0.97 * FEEDRATE, "{least} mm/s");
    // The corner is turned, not stopped at.
    let corner = time_at_height(&motion, RADIUS + 39.0);
    let least = least_speed(&motion, corner, corner + 0.1);
    assert!(least > 1.0, "{least} mm/s");
}

#[test]
fn a_curve_is_left_only_where_its_way_is_straight_already() {
    // What is left at speed is planned so far that the curve still bends the way where it ends.
    let points = [
        [0.29, -0.36],
        [0.46, -0.55],
        [0.73, -0.77],
        [0.83, -0.83],
        [1.42, -0.95],
        [2.07, -1.02],
        [2.76, -1.03],
        [3.51, -0.98],
        [5.15, -0.67],
        [6.02, -0.41],
        [7.83, 0.31],
        [10.57, 1.81],
        [11.45, 2.39],
        [13.9, 4.31],
        [15.14, 5.44],
        [1.84, 0.32],
    ];
    let path = Course::of_lines([0.0, 0.0], &points, 1_651.0 / 60.0, 0.01).toolpath();
    let limits = limits(&[[1_000.0, 2_000.0, 5e4]; 2]);
    let motion = plan(&path, &Settings::new(limits)).unwrap();
    let report = verify(&motion, &path, &limits);
    assert!(report.passes(), "{:#?}", report.examples);
}

#[test]
fn what_was_planned_to_a_rest_is_used_where_the_path_ends_there() {
    let mut points = Vec::new();
    curve(&mut points, [0.0, 0.0], 40.0, 8_000);
    let course = Course::of_lines([0.0, 0.0], &points, FEEDRATE, 0.05);
    let path = course.toolpath();
    let limits = limits(&LIMITS);
    for count in [513, 700, 1_024, 1_025] {
        let mut planner = KinematicSmoothing::new(path.start(), &Settings::new(limits));
        let mut end = None;
        for step in &path.moves()[..count] {
            planner.push(step).unwrap();
            end = std::iter::from_fn(|| planner.pull()).last().or(end);
        }
        planner.finish().unwrap();
        let end = std::iter::from_fn(|| planner.pull())
            .last()
            .or(end)
            .unwrap();
        let last = end.at(end.duration());
        assert_eq!(
            end.end(),
            path.moves()[count - 1].end(path.start()),
            "{count}"
        );
        assert!(last.velocity.norm() < 1e-6, "{count}: {}", last.velocity);
    }
}

#[test]
fn an_arc_beside_a_stop_takes_what_it_takes_alone() {
    use toolglide_tests::course::{Lead, arc, go};
    let step = |lead| go(lead, FEEDRATE, 0.05);
    let quarter = arc([20.0, 10.0], [30.0, 10.0], [0, 1], true, 0);
    let course = Course {
        start: [0.0, 0.0],
        legs: vec![
            step(Lead::Line([20.0, 0.0])),
            step(quarter),
            step(Lead::Line([30.0, 40.0])),
        ],
    };
    let limits = limits(&LIMITS);
    let settings = Settings::new(limits).with_method(Method::ExactStop);
    let whole = plan(&course.toolpath(), &settings).unwrap().duration();
    let mut start = course.start;
    let mut sum = 0.0;
    for (leg, end) in course
        .legs
        .iter()
        .zip([[20.0, 0.0], [30.0, 10.0], [30.0, 40.0]])
    {
        let legs = vec![*leg];
        let alone = Course { start, legs }.toolpath();
        sum += plan(&alone, &settings).unwrap().duration();
        start = end;
    }
    assert!((whole - sum).abs() < 1e-9, "{whole} s, {sum} s");
}

#[test]
fn fine_moves_that_stray_less_than_the_tolerance_take_what_a_straight_line_takes() {
    let fine: Vec<_> = (1..=10_000_u32)
        .map(|number| {
            let along = 0.01 * f64::from(number);
            [along, 0.002 * (37.0 * along).sin()]
        })
        .collect();
    let [fine, straight] = [&fine[..], &[[100.0, 0.0]]].map(|points| planned_at(points, 500.0));
    let most = 1.001 * straight.duration();
    assert!(fine.duration() < most, "{} s", fine.duration());
}

#[test]
fn a_circle_goes_on_at_speed_where_the_curve_is_found_a_little_slower_again() {
    // Coordinates rounded to a ten-thousandth of an inch, and more moves than are planned at once.
    const RADIUS: f64 = 25.4;
    let rounded = |value: f64| (value / 2.54e-3).round() * 2.54e-3;
    let points: Vec<_> = (0..10_000_u32)
        .map(|chord| {
            let at = std::f64::consts::TAU * f64::from(chord) / 10_000.0;
            [rounded(RADIUS * at.sin()), rounded(RADIUS * at.cos())]
        })
        .collect();
    let limits = limits(&[[500.0, 2_500.0, 2e5]; 2]);
    let course = Course::of_lines([0.0, 0.0], &points, 4_000.0, 0.1);
    let path = course.toolpath();
    let motion = plan(&path, &Settings::new(limits)).unwrap();
    let report = verify(&motion, &path, &limits);
    assert!(report.passes(), "{:#?}", report.examples);
    // Only the corner of the first move and the end are at rest.
    let least = least_speed(&motion, 0.5, motion.duration() - 0.2);
    assert!(least > 150.0, "{least} mm/s");
}
