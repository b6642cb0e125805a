//! Runs the command without a process, in a folder of its own.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]
#![allow(dead_code, reason = "every test binary uses its own part")]

use std::path::{Path, PathBuf};

/// What a run gave.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) code: u8,
    pub(crate) out: String,
    pub(crate) err: String,
}

/// Runs the command with these arguments.
pub(crate) fn toolglide(arguments: &[&str]) -> Run {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let arguments = std::iter::once("toolglide").chain(arguments.iter().copied());
    let code = toolglide_cli::run(arguments, &mut out, &mut err);
    Run {
        code,
        out: String::from_utf8(out).unwrap(),
        err: String::from_utf8(err).unwrap(),
    }
}

/// A folder with files, which goes when the test ends.
pub(crate) struct Folder {
    folder: tempfile::TempDir,
}

impl Folder {
    pub(crate) fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    /// Path of a file in it, whether it exists or not.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The same as text.
    pub(crate) fn name(&self, name: &str) -> String {
        self.path(name).to_str().unwrap().to_owned()
    }

    /// Writes a file and gives its path as text.
    pub(crate) fn write(&self, name: &str, text: impl AsRef<[u8]>) -> String {
        std::fs::write(self.path(name), text).unwrap();
        self.name(name)
    }

    /// Reads a file.
    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// Names of all files, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let mut files: Vec<String> = std::fs::read_dir(self.folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        files.sort();
        files
    }

    /// The folder itself.
    pub(crate) fn here(&self) -> &Path {
        self.folder.path()
    }
}

/// A square with a rapid to begin with, an arc and a dwell: 5 moves that move.
pub(crate) const SQUARE: &str =
    "G21 G90 G64 P0.05\nG0 X5 Y5\nG1 X25 F6000\nY25\nG3 X15 Y35 I-10\nG4 P0.05\nG1 X5 Y5 Z-1\nM2\n";

/// Rows of a CSV file as numbers.
pub(crate) fn rows(csv: &str) -> Vec<Vec<f64>> {
    csv.lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect()
}

/// The same with numbers of four significant digits, and none below a picometre, so that rounding
/// does not show.
pub(crate) fn rounded(value: &serde_json::Value) -> serde_json::Value {
    use serde_json::Value;
    match value {
        Value::Number(number) if number.is_f64() => {
            let number = number.as_f64().unwrap();
            let text = format!("{:.3e}", if number.abs() < 1e-9 { 0.0 } else { number });
            text.parse::<f64>().unwrap().into()
        }
        Value::Array(all) => all.iter().map(rounded).collect(),
        Value::Object(all) => Value::Object(
            all.iter()
                .map(|(name, value)| (name.clone(), rounded(value)))
                .collect(),
        ),
        other => other.clone(),
    }
}
