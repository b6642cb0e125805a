//! Names every fault of a machine and its file.

use std::path::PathBuf;
use thiserror::Error;

/// Why a machine is refused.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MachineError {
    /// No model has this name.
    #[error("machine \"{name}\" is not registered; registered: {}", registered.join(", "))]
    Unknown {
        /// The name asked for.
        name: String,
        /// The names there are, sorted.
        registered: Vec<&'static str>,
    },
    /// Two models have one name, so that neither can be meant.
    #[error("machine \"{name}\" is registered {times} times, but a name must be registered once")]
    Twice {
        /// The name.
        name: &'static str,
        /// How often it is registered.
        times: usize,
    },
    /// The file cannot be read.
    #[error("{}: cannot be read: {reason}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
    /// The text is no machine file: bad syntax, an unknown field, or a missing one.
    #[error("line {line}: {reason}")]
    Syntax {
        /// Line of the file, counted from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// A field has a value that it must not have.
    #[error("{field} is {value}, but must be {bound}")]
    Field {
        /// Which field.
        field: String,
        /// What it says.
        value: String,
        /// What it must be.
        bound: &'static str,
    },
    /// The file lists other axes than the model has, or in another order.
    #[error(
        "the axes are {}, but must be {}, in this order",
        spaced(given),
        spaced(wanted)
    )]
    Axes {
        /// Letters that the file lists.
        given: Vec<char>,
        /// Letters that the model has, in machine order.
        wanted: Vec<char>,
    },
    /// A distance that the model needs is not given.
    #[error("geometry.{name} is missing: the distance {meaning}, mm")]
    MissingDistance {
        /// Name of the distance.
        name: &'static str,
        /// What it is.
        meaning: &'static str,
    },
    /// A distance is given that the model does not know.
    #[error("geometry.{name} is unknown; known: {}", listed(known))]
    UnknownDistance {
        /// The name that is given.
        name: String,
        /// The names that the model knows.
        known: Vec<&'static str>,
    },
    /// Something is wrong in this file.
    #[error("{}: {reason}", file.display())]
    InFile {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        reason: Box<MachineError>,
    },
}

impl MachineError {
    /// A field with a value that it must not have.
    pub fn field(
        field: impl Into<String>,
        value: impl std::fmt::Display,
        bound: &'static str,
    ) -> Self {
        Self::Field {
            field: field.into(),
            value: value.to_string(),
            bound,
        }
    }
}

/// Letters with spaces between them, as in "X Y Z".
fn spaced(letters: &[char]) -> String {
    let letters: Vec<String> = letters.iter().map(char::to_string).collect();
    letters.join(" ")
}

/// Names with commas between them, or "none".
fn listed(names: &[&str]) -> String {
    if names.is_empty() {
        return "none".to_owned();
    }
    names.join(", ")
}
