//! An arc is followed as an arc: at its radius, as steadily as uniform circular motion, and at a small cost.
//!
//! Not here: that limits and tolerance are kept, which every random course is judged for.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use std::f64::consts::{PI, TAU};
use toolglide_kinematics::{
    Limits, MotionPlanner, Move, Path, Piece, SamplePeriod, Sampler, Vector,
};
use toolglide_smoothing::{KinematicSmoothing, Method, Settings, Work};
use toolglide_tests::corpus;
use toolglide_tests::spectrum::acceleration_above;
use toolglide_verify::Judge;

/// Methods that take arcs as they are.
const METHODS: [Method; 5] = [
    Method::Kcs,
    Method::KcsInterrupted,
    Method::KcsUninterrupted,
    Method::KcsGlobal,
    Method::ExactStop,
];

/// Angle from the ends of an arc within which the motion may be on its way to or from it, rad.
const ENDS: f64 = PI / 6.0;

/// What came of a program.
struct Planned {
    moves: Vec<Move<3>>,
    pieces: Vec<Piece<3>>,
    work: Work,
}

impl Planned {
    /// Plans a program from the origin and has it judged.
    fn of(text: &str, tolerance: f64, method: Method) -> Self {
        let moves = corpus::moves(text.as_bytes(), "arcs.ngc", tolerance).unwrap();
        let limits = Limits::uniform(500.0, 2_500.0, 2e5).unwrap();
        let settings = Settings::new(limits).with_method(method);
        let mut planner = KinematicSmoothing::new(Vector::zeros(), &settings);
        let mut judge = Judge::new(Vector::zeros(), limits);
        let mut pieces = Vec::new();
        for step in &moves {
            judge.expect(step).unwrap();
            planner.push(step).unwrap();
            pieces.extend(std::iter::from_fn(|| planner.pull()));
        }
        planner.finish().unwrap();
        pieces.extend(std::iter::from_fn(|| planner.pull()));
        for piece in &pieces {
            judge.observe(piece);
        }
        let report = judge.finish();
        assert_eq!(
            report.violations,
            0,
            "{}: {:#?}",
            method.name(),
            report.examples
        );
        Self {
            moves,
            pieces,
            work: planner.work(),
        }
    }

    fn duration(&self) -> f64 {
        self.pieces.iter().map(Piece::duration).sum()
    }

    /// Acceleration above 50 Hz, mm/s2.
    fn shaking(&self) -> f64 {
        let mut sampler = Sampler::new(SamplePeriod::new(0.001).unwrap());
        let mut rows = Vec::new();
        for piece in &self.pieces {
            sampler.feed(piece);
            while let Some((_, point)) = sampler.next_tick() {
                rows.push([point[0], point[1], point[2]]);
            }
        }
        acceleration_above(50.0, &rows)
    }

    /// Largest distance from the radius of the arc of a move, and largest jerk, away from its ends.
    fn off_radius(&self, number: usize) -> [f64; 2] {
        let Path::Arc(arc) = self.moves[number].path() else {
            panic!("move {number} is no arc")
        };
        let (radial, lateral) = arc.frame();
        let (mut off, mut jerk, mut seen) = (0.0_f64, 0.0_f64, 0);
        for piece in &self.pieces {
            if piece.serves().last as usize != number {
                continue;
            }
            for part in 0..8 {
                let sample = piece.at(piece.duration() * f64::from(part) / 8.0);
                let offset = sample.position - arc.center();
                let [along, across] = [radial, lateral].map(|side| side.dot(&offset));
                let angle = (arc.sweep().signum() * across.atan2(along)).rem_euclid(TAU);
                if angle > ENDS && angle < arc.sweep().abs() - ENDS {
                    off = off.max((along.hypot(across) - arc.radii().0).abs());
                    jerk = jerk.max(sample.jerk.norm());
                    seen += 1;
                }
            }
        }
        assert!(seen > 40, "{seen} places of move {number}");
        [off, jerk]
    }
}

/// A full circle of some radius at a feedrate of mm/min.
fn circle(radius: f64, feedrate: f64) -> String {
    format!("G21 G90 G17\nG0 X0 Y0\nG3 X0 Y0 I{radius} J0 F{feedrate}\n")
}

#[test]
fn a_circle_keeps_its_radius_and_the_jerk_of_uniform_motion() {
    for (radius, feedrate, tolerance) in [
        (10.0, 600.0, 0.05),
        (3.0, 2_400.0, 0.1),
        (40.0, 6_000.0, 0.02),
    ] {
        let text = circle(radius, feedrate);
        let speed: f64 = feedrate / 60.0;
        let uniform = speed.powi(3) / (radius * radius);
        for method in METHODS {
            let planned = Planned::of(&text, tolerance, method);
            let [off, jerk] = planned.off_radius(1);
            let name = method.name();
            assert!(off < 1e-5, "{name}: R {radius} is missed by {off} mm");
            assert!(
                jerk < 1.01 * uniform + 1.0,
                "{name}: jerk {jerk} instead of {uniform}"
            );
            // A start, a stop, and the way at the feedrate.
            let least = TAU * radius / speed + 2.0 * (speed / 2e5).sqrt();
            let duration = planned.duration();
            assert!(
                duration < 1.013 * least,
                "{name}: {duration} s instead of {least} s"
            );
        }
    }
}

#[test]
fn a_small_tolerance_changes_nothing_on_an_arc() {
    let text = circle(10.0, 600.0);
    let [coarse, fine] = [0.05, 1e-5].map(|tolerance| Planned::of(&text, tolerance, Method::Kcs));
    let [off, jerk] = fine.off_radius(1);
    assert!(off < 1e-5 && jerk < 11.0, "{off} mm, {jerk} mm/s3");
    assert!(
        (fine.duration() / coarse.duration() - 1.0).abs() < 1e-3,
        "{} s",
        fine.duration()
    );
    let [coarse, fine] = [coarse, fine].map(|planned| planned.work.pieces);
    assert!(fine <= 3 * coarse, "{fine} pieces instead of {coarse}");
}

#[test]
fn arcs_between_lines_are_followed_and_entered_at_speed() {
    // A slot of half circles of 5 mm.
    let text = "G21 G90 G17 F3000\nG1 X20\nG3 X20 Y10 J5\nG1 X0\nG3 X0 Y0 J-5\nG1 X20\n";
    for method in [
        Method::Kcs,
        Method::KcsInterrupted,
        Method::KcsUninterrupted,
    ] {
        let planned = Planned::of(text, 0.02, method);
        let name = method.name();
        for number in [1, 3] {
            let [off, jerk] = planned.off_radius(number);
            assert!(off < 1e-4, "{name}: move {number} is off by {off} mm");
            let uniform = 50.0_f64.powi(3) / 25.0;
            assert!(
                jerk < 1.05 * uniform,
                "{name}: jerk {jerk} instead of {uniform}"
            );
        }
        let length = 60.0 + TAU * 5.0;
        let least = length / 50.0 + 2.0 * (50.0_f64 / 2e5).sqrt();
        let duration = planned.duration();
        assert!(
            duration < 1.01 * least,
            "{name}: {duration} s instead of {least} s"
        );
    }
}

#[test]
fn a_circle_behind_a_sharp_corner_does_not_shake() {
    let text = "G21 G90 G17 F5000\nG1 X20\nG3 I-20\nG3 I-20\n";
    let planned = Planned::of(text, 0.01, Method::Kcs);
    let shaking = planned.shaking();
    assert!(shaking < 30.0, "{shaking} mm/s2");
    assert!(planned.duration() < 3.356, "{} s", planned.duration());
}

#[test]
fn examples_with_arcs_are_quick_and_quiet() {
    for (name, most, shaking) in [
        ("bracket", 16.914, 55.0),
        ("star", 11.0734, 60.0),
        ("helix_bore", 12.271, 60.0),
    ] {
        let file = format!("{}/../examples/{name}.ngc", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(file).unwrap();
        let planned = Planned::of(&text, 0.01, Method::Kcs);
        let (duration, above) = (planned.duration(), planned.shaking());
        assert!(duration <= most, "{name}: {duration} s");
        assert!(above <= shaking, "{name}: {above} mm/s2 above 50 Hz");
    }
}

/// Half circles of alternate sides in a row.
fn waves(count: usize, chord: f64) -> String {
    let mut text = String::from("G21 G90 F3000\n");
    for number in 1..=count {
        let x = chord * number as f64;
        text += &format!("G{} X{x:.4} Y0 R{:.5}\n", 2 + number % 2, 0.7 * chord);
    }
    text
}

#[test]
fn planning_an_arc_takes_the_same_work_however_many_there_are() {
    for chord in [0.3, 3.0, 30.0] {
        let [few, many] = [40, 160].map(|count| {
            let Work { pieces, corners } =
                Planned::of(&waves(count, chord), 0.01, Method::Kcs).work;
            [pieces, corners].map(|work| work as f64 / count as f64)
        });
        assert!(
            many[0] <= 1.3 * few[0] + 20.0,
            "chord {chord}: {many:?} an arc, {few:?} of few"
        );
        assert!(
            many[1] <= 1.3 * few[1] + 4.0,
            "chord {chord}: {many:?} an arc, {few:?} of few"
        );
    }
}

#[test]
fn an_arc_at_its_feedrate_is_planned_a_few_times_at_the_most() {
    for text in [circle(10.0, 1_500.0), circle(40.0, 6_000.0), waves(60, 5.0)] {
        let planned = Planned::of(&text, 0.01, Method::Kcs);
        let pieces = planned.pieces.len() as u64;
        assert!(
            planned.work.pieces <= 8 * pieces,
            "{:?} for {pieces} pieces",
            planned.work
        );
        assert!(
            planned.work.corners <= 2 * planned.moves.len() as u64,
            "{:?}",
            planned.work
        );
    }
}
