//! The programs that show the language, one for each part of it.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::settings;
use std::path::PathBuf;
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
fn every_example_is_named_here() {
    let here = include_str!("language_examples.rs");
    for file in std::fs::read_dir(folder()).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        let known = name == "README.md" || name == "pocket.ngc" || here.contains(&name);
        assert!(known, "{name}");
    }
}
