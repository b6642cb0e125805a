//! Finds part programs of other people where they are at hand.
//!
//! They are not part of this project and lie beside it; a test that needs one says so and passes
//! when it is not there. Not here: reading them, which `program` does.

use std::path::PathBuf;
use toolglide_kinematics::{Move, Tolerance, Vector};
use toolglide_program::{Language, Program, ProgramError, Settings};

/// Where the programs lie.
const PROGRAMS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/gcode");

/// A program under its name, as `bench/liss20k.ngc`; `None` and a message when it is not there.
#[must_use]
pub fn text(name: &str) -> Option<Vec<u8>> {
    let text = std::fs::read(PathBuf::from(PROGRAMS).join(name)).ok();
    if text.is_none() {
        eprintln!("skipped: {name} is not at hand");
    }
    text
}

/// The names of all programs of the folders `bench` and `corpus`, sorted.
#[must_use]
pub fn names() -> Vec<String> {
    let mut names = names_in("bench");
    names.extend(names_in("corpus"));
    names
}

/// The names of all programs of a folder and those in it, sorted.
#[must_use]
pub fn names_in(folder: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let Ok(entries) = std::fs::read_dir(PathBuf::from(PROGRAMS).join(&folder)) else {
            eprintln!("skipped: folder {folder} is not at hand");
            continue;
        };
        for entry in entries.flatten() {
            let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                folders.push(name);
            } else {
                names.push(name);
            }
        }
    }
    names.sort();
    names
}

/// The moves of a program that begins at the origin.
///
/// # Errors
/// The first refusal.
pub fn moves(text: &[u8], name: &str, tolerance: f64) -> Result<Vec<Move<3>>, ProgramError> {
    let mut settings = Settings::new(Tolerance::new(tolerance).unwrap());
    settings.lenient = true;
    settings.start = Vector::zeros();
    let language = Language::of(std::path::Path::new(name), text);
    Program::new(text, name, settings)
        .in_language(language)
        .collect()
}
