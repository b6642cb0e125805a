//! Filtered pulses on programs by others, and where corners are dense.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use std::f64::consts::TAU;
use toolglide_fir::{FilterChain, FirInterpolation, Method, Settings, plan};
use toolglide_kinematics::{
    Feedrate, Limits, MotionPlanner, Tolerance, Toolpath, Trajectory, Vector,
};
use toolglide_tests::corpus;
use toolglide_verify::{Judge, verify};

#[test]
fn programs_of_arcs_are_followed_within_the_tolerance() {
    let limits = Limits::uniform(500.0, 2_500.0, 2e5).unwrap();
    for name in [
        "tinyg/FordEmblem.gcode",
        "ugs/arc_rword_test.gcode",
        "linuxcnc/arcspiral.ngc",
        "linuxcnc/cds.ngc",
        "linuxcnc/tort.ngc",
        "linuxcnc/tp_rgh.ngc",
    ] {
        let name = format!("corpus/{name}");
        let Some(text) = corpus::text(&name) else {
            continue;
        };
        let moves = corpus::moves(&text, &name, 0.01).unwrap();
        let mut planner = FirInterpolation::new(Vector::zeros(), &Settings::new(limits));
        let mut judge = Judge::new(Vector::zeros(), limits);
        for step in moves.iter().map(Some).chain([None]) {
            match step {
                Some(step) => {
                    judge.expect(step).unwrap();
                    planner.push(step).unwrap();
                }
                None => planner.finish().unwrap(),
            }
            while let Some(piece) = planner.pull() {
                judge.observe(&piece);
            }
        }
        let report = judge.finish();
        assert!(report.passes(), "{name}: {:#?}", report.examples);
        let ratio = report.deviation_ratio.value.max(report.corner_ratio.value);
        assert!(ratio <= 1.0, "{name}: {ratio} of the tolerance");
    }
}

/// Moves along a closed curve around the origin.
fn around(count: u32, radius: impl Fn(f64) -> f64, tolerance: f64) -> Toolpath<2> {
    let points: Vec<_> = (0..=count)
        .map(|number| TAU * f64::from(number) / f64::from(count))
        .map(|angle| Vector::<2>::new(angle.cos(), angle.sin()) * radius(angle))
        .collect();
    let feedrate = Feedrate::new(50.0).unwrap();
    Toolpath::from_points(&points, feedrate, Tolerance::new(tolerance).unwrap()).unwrap()
}

/// How long a path takes with a dwell at every corner: as each corner by itself allows it, and where
/// moves are short as long as it takes to keep every corner by itself.
fn dwelling(path: &Toolpath<2>, chain: &FilterChain) -> f64 {
    let total = chain.total_delay();
    let mut points = vec![path.start()];
    for step in path.moves() {
        points.push(step.end(path.start()));
    }
    let spans: Vec<_> = points.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let feedrate = path.moves()[0].feedrate().speed();
    let tolerance = path.moves()[0].tolerance().length();
    let lasts = |index: usize| spans[index].norm() / feedrate;
    let mut overlaps: Vec<f64> = spans
        .windows(2)
        .map(|pair| (pair[1].normalize() - pair[0].normalize()).norm())
        .map(|turn| (2.0 * chain.time_to(tolerance / (feedrate * turn))).min(total))
        .collect();
    for index in 1..overlaps.len() {
        // No more than two moves in the window.
        let room = lasts(index) + total;
        let excess = (overlaps[index - 1] + overlaps[index] - room).max(0.0);
        overlaps[index] = (overlaps[index] - excess).max(0.5 * room);
        overlaps[index - 1] = overlaps[index - 1].min(room - overlaps[index]);
    }
    let moving: f64 = (0..spans.len()).map(lasts).sum();
    moving + total + overlaps.iter().map(|overlap| total - overlap).sum::<f64>()
}

#[test]
fn dense_turns_keep_the_tolerance_and_are_faster_than_dwelling_at_every_corner() {
    let limits = Limits::uniform(500.0, 2_500.0, 2e5).unwrap();
    let chain = FilterChain::with_time_constants(&[0.1, 0.06]).unwrap();
    let settings = Settings::new(limits).with_chain(&chain).unwrap();
    let star = |angle: f64| 15.0 * (1.0 + 0.35 * (5.0 * angle).cos());
    // The printed overlap takes 10.30 s on the star and breaks the tolerance by 83 %.
    for (name, path, most) in [
        ("star of 250 moves", around(250, star, 0.03), 10.30),
        ("polygon of 500 moves", around(500, |_| 20.0, 0.03), 5.0),
    ] {
        let motion = plan(&path, &settings).unwrap();
        let report = verify(&motion, &path, &limits);
        assert!(report.passes(), "{name}: {:#?}", report.examples);
        let takes = motion.duration();
        assert!(takes < most, "{name}: {takes} s");
        let dwelling = dwelling(&path, &chain);
        assert!(
            takes < 0.6 * dwelling,
            "{name}: {takes} s, {dwelling} s with dwells"
        );
        let stopping = settings.clone().with_method(Method::PointToPoint);
        let stopping = plan(&path, &stopping).unwrap().duration();
        assert!(
            takes < 0.25 * stopping,
            "{name}: {takes} s, {stopping} s with stops"
        );
    }
}
