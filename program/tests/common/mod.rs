//! Short ways to read a program in a test.
#![allow(dead_code, reason = "each test file uses its share")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a failed unwrap is a failed test"
)]

use toolglide_kinematics::{Arc, Feedrate, Move, Path, Tolerance, Vector};
use toolglide_program::{Program, ProgramError, Reason, Settings};

/// Name of the file in all messages.
pub(crate) const FILE: &str = "part.ngc";

/// Lengths in tests are right within this, mm: far above rounding, far below any meaning.
pub(crate) const CLOSE: f64 = 1e-9;

pub(crate) fn settings() -> Settings {
    Settings::new(Tolerance::new(0.01).unwrap())
}

pub(crate) fn lenient() -> Settings {
    let mut settings = settings();
    settings.lenient = true;
    settings
}

pub(crate) fn try_read(text: &str, settings: Settings) -> Result<Vec<Move<3>>, ProgramError> {
    Program::new(text.as_bytes(), FILE, settings).collect()
}

/// The moves of a legal program.
pub(crate) fn read(text: &str) -> Vec<Move<3>> {
    match try_read(text, settings()) {
        Ok(moves) => moves,
        Err(error) => panic!("{text:?}: {error}"),
    }
}

/// Where each move of a legal program ends.
pub(crate) fn ends(text: &str) -> Vec<[f64; 3]> {
    let mut at = Vector::zeros();
    read(text)
        .iter()
        .map(|step| {
            at = step.end(at);
            at.into()
        })
        .collect()
}

/// Speeds of the moves in mm/s.
pub(crate) fn speeds(text: &str) -> Vec<f64> {
    read(text)
        .iter()
        .map(|step| step.feedrate().speed())
        .collect()
}

/// The arc of the last move.
pub(crate) fn last_arc(text: &str) -> Arc<3> {
    match read(text).last().unwrap().path() {
        Path::Arc(arc) => *arc,
        other => panic!("{text:?} ends with {other:?}"),
    }
}

/// Asserts that two lists of numbers agree.
pub(crate) fn assert_close(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}: {found:?}");
    for (one, other) in found.iter().zip(expected) {
        let same = one.is_infinite() && other.is_infinite() || (one - other).abs() <= CLOSE;
        assert!(same, "{what}: {found:?}, expected {expected:?}");
    }
}

pub(crate) fn assert_ends(text: &str, expected: &[[f64; 3]]) {
    let found = ends(text);
    assert_close(&found.concat(), &expected.concat(), text);
}

/// Line, column, word and reason of a refusal.
pub(crate) fn refusal_with(text: &str, settings: Settings) -> (u64, u32, String, Reason) {
    let error = try_read(text, settings).expect_err(text);
    assert_eq!(error.file(), FILE, "{text:?}");
    let shown = error.to_string();
    let place = format!("{FILE}:{}:{}: ", error.line(), error.column());
    assert!(
        shown.starts_with(&place) && shown.len() > place.len(),
        "{shown}"
    );
    let word = error.word().to_owned();
    (error.line(), error.column(), word, error.reason().clone())
}

pub(crate) fn refusal(text: &str) -> (u64, u32, String, Reason) {
    refusal_with(text, settings())
}

/// Asserts place, word and reason of the refusal of a program.
#[allow(unused_macros, reason = "each test file uses its share")]
macro_rules! refuses {
    ($text:expr, $line:expr, $column:expr, $word:expr, $reason:pat) => {
        let (line, column, word, reason) = $crate::common::refusal($text);
        let expected: &str = $word.as_ref();
        let place = (line, column, word.as_str());
        assert_eq!(place, ($line, $column, expected), "{:?}: {reason}", $text);
        assert!(matches!(reason, $reason), "{:?}: {reason:?}", $text);
    };
}

/// Whether a move is a dwell, and how long, s.
pub(crate) fn dwell(step: &Move<3>) -> Option<f64> {
    match step.path() {
        Path::Dwell { duration } => Some(*duration),
        _ => None,
    }
}

pub(crate) fn is_rapid(step: &Move<3>) -> bool {
    step.feedrate() == Feedrate::RAPID
}
