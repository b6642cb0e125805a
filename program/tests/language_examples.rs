//! The programs that show the language, one for each part of it.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::settings;
use std::path::PathBuf;
use toolglide_kinematics::Vector;
use toolglide_program::{Language, Poses, Program, ToolTable};

fn folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/language"))
}

fn text(file: &str) -> String {
    let path = folder().join(file);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// How many moves a program of straight axes has.
fn moves(file: &str) -> usize {
    let text = text(file);
    let tools = ToolTable::parse(&self::text("tools.tbl")).unwrap();
    let mut program = Program::new(text.as_bytes(), file, settings())
        .with_tools(tools)
        .with_subroutines(|name| std::fs::read(folder().join(format!("{name}.ngc"))).map(Some));
    let read: Result<Vec<_>, _> = program.by_ref().collect();
    let count = read.unwrap_or_else(|error| panic!("{error}")).len();
    assert!(
        program.warnings().is_empty(),
        "{file}: {:?}",
        program.warnings()
    );
    count
}

#[test]
fn programs_of_straight_axes_are_read_strictly() {
    for (file, expected) in [
        ("parameters.ngc", 182),
        ("subroutines.ngc", 43),
        ("offsets.ngc", 22),
        ("drilling.ngc", 68),
        ("compensation.ngc", 20),
        ("splines.ngc", 756),
        ("polar.ngc", 20),
        ("subprograms.ngc", 20),
        ("knots.ngc", 258),
    ] {
        assert_eq!(moves(file), expected, "{file}");
    }
}

#[test]
fn programs_of_rotary_axes_are_read_as_poses() {
    for (file, expected) in [
        ("tilted.ngc", 59),
        ("blade.apt", 61),
        ("swivel.mpf", 246),
        ("loops.mpf", 314),
    ] {
        let text = text(file);
        let path = PathBuf::from(file);
        let language = Language::of(&path, text.as_bytes());
        let tools = ToolTable::parse(&self::text("tools.tbl")).unwrap();
        let poses = Poses::new(text.as_bytes(), file, settings(), language).with_tools(tools);
        let read: Result<Vec<_>, _> = poses.collect();
        let count = read.unwrap_or_else(|error| panic!("{error}")).len();
        assert_eq!(count, expected, "{file}");
    }
}

#[test]
fn dialects_are_told_apart_and_read() {
    for (file, language, moves, told) in [
        ("printer.gcode", Language::Printer, 16, 10),
        ("rounded.ngc", Language::Ngc, 17, 1),
    ] {
        let text = text(file);
        let found = Language::of(&PathBuf::from(file), text.as_bytes());
        assert_eq!(found, language, "{file}");
        let mut program = Program::new(text.as_bytes(), file, settings()).in_language(found);
        let read: Result<Vec<_>, _> = program.by_ref().collect();
        let count = read.unwrap_or_else(|error| panic!("{error}")).len();
        assert_eq!((count, program.warnings().len()), (moves, told), "{file}");
    }
    for (file, language, moves) in [
        ("profile.cls", Language::CutterLocations, 116),
        ("ways.mpf", Language::Sinumerik, 231),
    ] {
        let text = text(file);
        let found = Language::of(&PathBuf::from(file), text.as_bytes());
        assert_eq!(found, language, "{file}");
        let read: Result<Vec<_>, _> =
            Poses::new(text.as_bytes(), file, settings(), found).collect();
        let count = read.unwrap_or_else(|error| panic!("{error}")).len();
        assert_eq!(count, moves, "{file}");
    }
}

/// Ends of the moves of a program that is known for one of FANUC or Haas by itself.
fn fanuc_ends(file: &str) -> Vec<Vector<3>> {
    let text = text(file);
    let language = Language::of(&PathBuf::from(file), text.as_bytes());
    assert_eq!(language, Language::Fanuc, "{file}");
    let program = Program::new(text.as_bytes(), file, settings()).in_language(language);
    let mut at = Vector::zeros();
    let ends = program.map(|step| {
        at = step.unwrap_or_else(|error| panic!("{error}")).end(at);
        at
    });
    ends.collect()
}

#[test]
fn the_macros_of_fanuc_cut_holes_a_pocket_and_notches() {
    let ends = fanuc_ends("fanuc_macro.nc");
    let at_depth = |depth: f64| {
        let found = ends.iter().filter(move |end| (end[2] - depth).abs() < 1e-9);
        found.copied().collect::<Vec<_>>()
    };
    let holes = at_depth(-8.0);
    assert_eq!(holes.len(), 6, "holes");
    for (hole, degrees) in holes
        .iter()
        .zip([15.0_f64, 75.0, 135.0, 195.0, 255.0, 315.0])
    {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let off = (hole[0] - 30.0 * cosine).hypot(hole[1] - 30.0 * sine);
        assert!(off < 1e-9, "{hole}");
    }
    // Three circles a level, each reached by a line, and back to the centre; entered from above.
    for depth in [-2.0, -4.0, -6.0] {
        assert_eq!(at_depth(depth).len(), 8, "level {depth}");
    }
    // In, two sides with their corners broken, and out, in four directions.
    let notches = at_depth(-1.0);
    assert_eq!(notches.len(), 4 * 6, "notches");
    let turned: Vec<_> = (0..4).map(|turn| notches[6 * turn + 1]).collect();
    for (point, expected) in
        turned
            .iter()
            .zip([[42.0, -5.0], [5.0, 42.0], [-42.0, 5.0], [-5.0, -42.0]])
    {
        let off = (point[0] - expected[0]).hypot(point[1] - expected[1]);
        assert!(off < 1e-9, "{point}");
    }
}

#[test]
fn a_program_for_haas_is_read_as_its_control_does() {
    let ends = fanuc_ends("haas.nc");
    let last = ends.last().unwrap();
    assert!(
        (last - Vector::<3>::new(30.0, 30.0, 0.0)).norm() < 1e-9,
        "{last}"
    );
    let holes: Vec<f64> = ends
        .iter()
        .filter(|end| (end[2] + 6.0).abs() < 1e-9)
        .map(|end| end[1])
        .collect();
    // A dwell ends where it began.
    assert_eq!(holes, [-20.0, -20.0, 0.0, 0.0, 20.0, 20.0], "holes");
}

#[test]
fn every_example_is_named_here() {
    let here = include_str!("language_examples.rs");
    for file in std::fs::read_dir(folder()).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        let known = name == "README.md" || name == "pocket.ngc" || here.contains(&name);
        assert!(known, "{name}");
    }
}
