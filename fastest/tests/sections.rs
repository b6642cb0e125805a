//! The motion of every section is that of the planner that is faster there.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_fastest::FasterOf;
use toolglide_kinematics::{Feedrate, Limits, Move, Plan, Tolerance, Toolpath, Trajectory, Vector};
use toolglide_smoothing::{KinematicSmoothing, Method, Settings};
use toolglide_verify::verify;

/// The kind of corner that is faster on circles of fine chords, and the one that is faster on zigzags.
const ROUND: Method = Method::KcsInterrupted;
const SHARP: Method = Method::KcsUninterrupted;

fn limits() -> Limits<2> {
    Limits::uniform(500.0, 2_500.0, 2e5).unwrap()
}

fn line(x: f64, y: f64) -> Move<2> {
    let feedrate = Feedrate::new(100.0).unwrap();
    let tolerance = Tolerance::new(0.02).unwrap();
    Move::line_to(Vector::<2>::new(x, y), feedrate, tolerance).unwrap()
}

/// Turns of 60 degrees between moves of 3 mm along the x axis, which begin and end at y = 0.
fn zigzag(count: u32, from: f64) -> Vec<Move<2>> {
    (1..=2 * count)
        .map(|number| line(from + 1.5 * f64::from(number), 2.6 * f64::from(number % 2)))
        .collect()
}

/// Chords of 0.1 mm of a circle above a point of the x axis, once around and more.
fn circle(count: u32, x: f64) -> Vec<Move<2>> {
    let radius = 20.0;
    (1..=count)
        .map(|number| 0.1 / radius * f64::from(number))
        .map(|angle| line(x + radius * angle.sin(), radius - radius * angle.cos()))
        .collect()
}

fn path(parts: &[&[Move<2>]], start: f64) -> Toolpath<2> {
    let mut path = Toolpath::starting_at(Vector::<2>::new(start, 0.0)).unwrap();
    for step in parts.iter().copied().flatten() {
        path.push(*step).unwrap();
    }
    path
}

fn planner(path: &Toolpath<2>, method: Method) -> KinematicSmoothing<2> {
    let settings = Settings::new(limits()).with_method(method);
    KinematicSmoothing::new(path.start(), &settings)
}

fn by(path: &Toolpath<2>, method: Method) -> f64 {
    Plan::of(path, &mut planner(path, method))
        .unwrap()
        .duration()
}

/// The duration of the faster of two methods, whose motion the judge must pass.
fn faster(path: &Toolpath<2>, first: Method, second: Method) -> f64 {
    let (one, other) = (planner(path, first), planner(path, second));
    let motion = Plan::of(
        path,
        &mut FasterOf::new(path.start(), one, other, &limits(), 4096),
    )
    .unwrap();
    let report = verify(&motion, path, &limits());
    assert!(report.passes(), "{:#?}", report.examples);
    motion.duration()
}

#[test]
fn each_side_of_a_stop_is_travelled_by_what_is_faster_there() {
    let mut corners = zigzag(20, 0.0);
    let last = corners.pop().unwrap();
    corners.push(last.with_exact_stop());
    let chords = circle(300, 60.0);
    let least = by(&path(&[&corners], 0.0), SHARP) + by(&path(&[&chords], 60.0), ROUND);
    let both = path(&[&corners, &chords], 0.0);
    for (first, second) in [(SHARP, ROUND), (ROUND, SHARP)] {
        let takes = faster(&both, first, second);
        assert!(
            takes <= least * (1.0 + 1e-9),
            "{takes} s, {least} s by the faster of each"
        );
    }
}

#[test]
fn a_long_line_divides_sections_without_a_stop() {
    let (corners, chords) = (zigzag(20, 0.0), circle(300, 110.0));
    let both = path(&[&corners, &[line(110.0, 0.0)], &chords], 0.0);
    let [round, sharp] = [ROUND, SHARP].map(|method| by(&both, method));
    let gained = by(&path(&[&corners], 0.0), ROUND) - by(&path(&[&corners], 0.0), SHARP);
    let takes = faster(&both, SHARP, ROUND);
    assert!(gained > 0.1, "{gained} s between the two on corners alone");
    assert!(
        takes < round - 0.9 * gained && takes < sharp,
        "{takes} s, {round} s and {sharp} s throughout"
    );
}

#[test]
fn a_section_too_long_to_be_held_is_led_by_what_is_ahead() {
    let chords = path(&[&circle(8_000, 0.0)], 0.0);
    let [round, sharp] = [ROUND, SHARP].map(|method| by(&chords, method));
    assert!(round < 0.9 * sharp, "{round} s and {sharp} s");
    for (first, second) in [(SHARP, ROUND), (ROUND, SHARP)] {
        let takes = faster(&chords, first, second);
        assert!(takes <= 1.005 * round, "{takes} s, {round} s and {sharp} s");
    }
}

#[test]
fn a_lead_is_given_back_before_it_is_lost() {
    let parts: [&[Move<2>]; 2] = [&circle(8_000, 0.0), &[]];
    let end = circle(8_000, 0.0).pop().unwrap().end(Vector::zeros());
    // Corners follow at once, with nothing to divide them from the circle.
    let corners: Vec<_> = (1..=4_000)
        .map(|number| {
            let number = f64::from(number);
            line(end[0] + 1.5 * number, end[1] + 2.6 * (number % 2.0))
        })
        .collect();
    let both = path(&[parts[0], &corners], 0.0);
    let [round, sharp] = [ROUND, SHARP].map(|method| by(&both, method));
    for (first, second) in [(SHARP, ROUND), (ROUND, SHARP)] {
        let takes = faster(&both, first, second);
        let least = round.min(sharp);
        assert!(takes <= 1.005 * least, "{takes} s, {round} s and {sharp} s");
    }
}
