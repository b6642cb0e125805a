//! The programs that come with the project.

mod common;

use common::{dwell, is_rapid, settings};
use toolglide_kinematics::{Path, Vector};
use toolglide_program::Program;

/// All of them, with their moves and the length of their feed moves to a tenth, mm.
const EXAMPLES: [(&str, usize, f64); 5] = [
    ("bracket.ngc", 60, 910.5),
    ("corner.ngc", 2, 100.0),
    ("dome.ngc", 256, 824.9),
    ("helix_bore.ngc", 16, 608.4),
    ("star.ngc", 33, 624.7),
];

/// The lengths above are rounded, mm.
const LENGTH_ROUNDING: f64 = 0.05;

/// All examples lie within this, mm, so that a small machine can run them.
const LEAST: [f64; 3] = [-5.0, -10.0, -15.0];
const LARGEST: [f64; 3] = [105.0, 105.0, 10.0];

/// The tangent may turn by this where two moves of a finished contour meet, rad.
const TANGENT: f64 = 1e-6;

fn text(file: &str) -> String {
    let path = format!("{}/../examples/{file}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn every_example_is_read_strictly_and_stays_on_a_small_machine() {
    for (file, expected_moves, expected_length) in EXAMPLES {
        let text = text(file);
        let mut program = Program::new(text.as_bytes(), file, settings());
        let (mut at, mut moves, mut length) = (Vector::zeros(), 0, 0.0);
        for step in program.by_ref() {
            let step = step.unwrap_or_else(|error| panic!("{error}"));
            let samples = match step.path() {
                Path::Arc(arc) => (0..=100).map(|n| arc.point(f64::from(n) / 100.0)).collect(),
                _ => vec![step.end(at)],
            };
            for point in samples {
                for axis in 0..3 {
                    let inside = (LEAST[axis]..=LARGEST[axis]).contains(&point[axis]);
                    assert!(inside, "{file}:{}: {point:?}", step.line());
                }
            }
            if !is_rapid(&step) && dwell(&step).is_none() {
                length += step.length(at);
            }
            at = step.end(at);
            moves += 1;
        }
        assert!(
            program.warnings().is_empty(),
            "{file}: {:?}",
            program.warnings()
        );
        assert_eq!(moves, expected_moves, "{file}: moves, {length:.1} mm");
        let apart = (length - expected_length).abs();
        assert!(apart <= LENGTH_ROUNDING, "{file}: {length:.1} mm");
    }
}

#[test]
fn the_bore_is_one_smooth_path() {
    let text = text("helix_bore.ngc");
    let arcs: Vec<_> = Program::new(text.as_bytes(), "helix_bore.ngc", settings())
        .filter_map(|step| match step.map(|step| *step.path()) {
            Ok(Path::Arc(arc)) => Some(arc),
            _ => None,
        })
        .collect();
    // The first is the helix, which alone climbs.
    for pair in arcs[1..].windows(2) {
        let (out, into) = (pair[0].tangent(1.0), pair[1].tangent(0.0));
        assert!((out - into).norm() < TANGENT, "{out:?} and {into:?}");
    }
}
