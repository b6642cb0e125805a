//! The reference as a planner: its motion passes the judge on every kind of path.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use toolglide_kinematics::{Arc, Feedrate, Limits, Move, Tolerance, Toolpath, Trajectory, Vector};
use toolglide_reference::{LONGEST, plan};
use toolglide_verify::verify;

fn judged(path: &Toolpath<2>, limits: Limits<2>) -> f64 {
    let motion = plan(path, limits).unwrap();
    let report = verify(&motion, path, &limits);
    assert!(report.passes(), "{report:?}");
    motion.duration()
}

fn limits() -> Limits<2> {
    Limits::uniform(200.0, 2000.0, 5e4).unwrap()
}

fn line(x: f64, y: f64, feed: f64) -> Move<2> {
    let tolerance = Tolerance::new(0.05).unwrap();
    Move::line_to(
        Vector::<2>::new(x, y),
        Feedrate::new(feed).unwrap(),
        tolerance,
    )
    .unwrap()
}

#[test]
fn lines_arcs_stops_and_dwells_pass_the_judge() {
    let tolerance = Tolerance::new(0.05).unwrap();
    let mut path = Toolpath::starting_at(Vector::<2>::zeros()).unwrap();
    let corner = Vector::<2>::new(5.0, 5.0);
    let arc = Arc::about(
        Vector::<2>::new(5.0, 1.0),
        Vector::<2>::new(9.0, 5.0),
        Vector::<2>::new(5.0, 5.0),
        [0, 1],
        true,
        0,
    )
    .unwrap();
    for next in [
        line(5.0, 0.0, 100.0),
        line(5.0, 1.0, 40.0),
        Move::arc(arc, Feedrate::new(80.0).unwrap(), tolerance),
        line(9.0, 9.0, 100.0).with_exact_stop(),
        Move::dwell(0.1, tolerance).unwrap(),
        line(9.0, 9.0, 100.0),
        line(corner.x, corner.y, 100.0),
        line(9.0, 9.0, 100.0),
    ] {
        path.push(next).unwrap();
    }
    let duration = judged(&path, limits());
    assert!(duration > 0.1 && duration < 1.0, "{duration}");
}

#[test]
fn a_zigzag_of_short_moves_takes_what_it_took_before() {
    // Turns of 30 and of 90 degrees between moves of 1 mm: 0.3014 s and 0.4450 s at their samples.
    for (turn, duration) in [(30.0_f64, 0.3014), (90.0, 0.4450)] {
        let mut points = vec![Vector::<2>::zeros()];
        for index in 0..8 {
            let half = turn.to_radians() * if index % 2 == 0 { 0.5 } else { -0.5 };
            points.push(points[index] + Vector::<2>::new(half.cos(), half.sin()));
        }
        let tolerance = Tolerance::new(0.05).unwrap();
        let path = Toolpath::from_points(&points, common::feedrate(), tolerance).unwrap();
        let found = judged(&path, limits());
        assert!(
            (found / duration - 1.0).abs() < 5e-3,
            "{turn} degrees: {found}"
        );
    }
}

#[test]
fn a_long_program_is_cut_where_it_turns_most() {
    let mut points = vec![Vector::<2>::zeros()];
    for index in 0..LONGEST + 20 {
        let sharp = index % 10 == 0;
        let x = 0.3 * f64::from(u32::try_from(index).unwrap());
        points.push(Vector::<2>::new(
            x + 0.3,
            if sharp { 0.5 } else { 0.01 * x },
        ));
    }
    let tolerance = Tolerance::new(0.05).unwrap();
    let path = Toolpath::from_points(&points, common::feedrate(), tolerance).unwrap();
    judged(&path, limits());
}
