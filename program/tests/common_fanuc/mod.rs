//! Short ways to read a program of FANUC in a test.
#![allow(dead_code, reason = "each test file uses its share")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a failed unwrap is a failed test"
)]

use crate::common::{CLOSE, FILE, settings};
use toolglide_kinematics::{Move, Vector};
use toolglide_program::{Language, Program, ProgramError, Reason};

/// Programs in files beside the one that is read.
pub(crate) fn beside(name: &str) -> std::io::Result<Option<Vec<u8>>> {
    Ok((name == "O7000").then(|| b"TEXT\n%\nO7000(BESIDE)\nG0 X#1 Y[#2+1.]\nM99\n%\n".to_vec()))
}

pub(crate) fn program(text: &str) -> Program<&[u8]> {
    Program::new(text.as_bytes(), FILE, settings())
        .in_language(Language::Fanuc)
        .with_subroutines(beside)
}

pub(crate) fn try_moves(text: &str) -> Result<Vec<Move<3>>, ProgramError> {
    program(text).collect()
}

pub(crate) fn moves(text: &str) -> Vec<Move<3>> {
    match try_moves(text) {
        Ok(moves) => moves,
        Err(error) => panic!("{text:?}: {error}"),
    }
}

pub(crate) fn ends(text: &str) -> Vec<[f64; 3]> {
    let mut at = Vector::zeros();
    moves(text)
        .iter()
        .map(|step| {
            at = step.end(at);
            at.into()
        })
        .collect()
}

pub(crate) fn assert_ends(text: &str, expected: &[[f64; 3]]) {
    let found = ends(text);
    assert_eq!(found.len(), expected.len(), "{text:?}: {found:?}");
    for (one, other) in found.iter().zip(expected) {
        let near = (0..3).all(|axis| (one[axis] - other[axis]).abs() < CLOSE);
        assert!(near, "{text:?}: {found:?}, expected {expected:?}");
    }
}

/// Line, column, word and reason of a refusal.
pub(crate) fn refusal(text: &str) -> (u64, u32, String, Reason) {
    let error = try_moves(text).expect_err(text);
    let word = error.word().to_owned();
    (error.line(), error.column(), word, error.reason().clone())
}

pub(crate) fn refuses(text: &str, line: u64, says: &str) {
    let (found, _, _, reason) = refusal(text);
    let said = reason.to_string();
    assert_eq!(found, line, "{text:?}: {said}");
    assert!(said.contains(says), "{text:?}: {said}");
}

/// What warnings say.
pub(crate) fn noted(text: &str) -> Vec<String> {
    let mut program = program(text);
    for step in program.by_ref() {
        step.unwrap();
    }
    let warnings = program.warnings().iter();
    warnings
        .map(|warning| warning.notice().to_string())
        .collect()
}
