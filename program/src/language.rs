//! Which language a program is written in.
//!
//! Source: the usual endings of files, and what only one language begins with. Not here: reading it.

use std::path::Path;

/// Endings of cutter location files, and of programs for Sinumerik.
const CUTTER_LOCATIONS: [&str; 5] = ["apt", "cls", "cl", "ncl", "aptsource"];
const SINUMERIK: [&str; 2] = ["mpf", "spf"];

/// A language of programs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Language {
    /// RS274/NGC, as LinuxCNC reads it.
    #[default]
    Ngc,
    /// FANUC and Haas mills.
    Fanuc,
    /// Sinumerik 840D.
    Sinumerik,
    /// Cutter location files (APT).
    CutterLocations,
}

impl Language {
    /// Its name on a command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ngc => "ngc",
            Self::Fanuc => "fanuc",
            Self::Sinumerik => "840d",
            Self::CutterLocations => "cl",
        }
    }

    /// The language of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        [
            Self::Ngc,
            Self::Fanuc,
            Self::Sinumerik,
            Self::CutterLocations,
        ]
        .into_iter()
        .find(|language| language.name() == name)
    }

    /// The language of a file by its name and its first lines; RS274/NGC unless another is certain.
    ///
    /// # Examples
    /// ```
    /// use toolglide_program::Language;
    /// let of = |name, beginning: &str| Language::of(std::path::Path::new(name), beginning.as_bytes());
    /// assert_eq!(of("part.ngc", "G21"), Language::Ngc);
    /// assert_eq!(of("part.mpf", ""), Language::Sinumerik);
    /// assert_eq!(of("part.nc", "%\nO0042\nIF [#1 EQ 2] GOTO 10\n"), Language::Fanuc);
    /// assert_eq!(of("part.txt", "PARTNO/A\nUNITS/MM\n"), Language::CutterLocations);
    /// ```
    #[must_use]
    pub fn of(file: &Path, beginning: &[u8]) -> Self {
        let ending = file.extension().and_then(|ending| ending.to_str());
        let is_one = |endings: &[&str]| {
            ending.is_some_and(|ending| endings.iter().any(|one| ending.eq_ignore_ascii_case(one)))
        };
        if is_one(&CUTTER_LOCATIONS) {
            return Self::CutterLocations;
        }
        if is_one(&SINUMERIK) {
            return Self::Sinumerik;
        }
        let text = String::from_utf8_lossy(beginning).to_ascii_uppercase();
        let first = |beginnings: &[&str]| {
            text.lines().take(50).any(|line| {
                let line = line.trim_start();
                beginnings
                    .iter()
                    .any(|beginning| line.starts_with(beginning))
            })
        };
        if first(&[
            "PARTNO",
            "UNITS/",
            "MULTAX",
            "GOTO/",
            "LOADTL/",
            "TOOL PATH/",
            "FEDRAT/",
        ]) {
            Self::CutterLocations
        } else if first(&[";$PATH=", "%_N_"]) {
            Self::Sinumerik
        } else if crate::fanuc::looks_like(beginning) {
            Self::Fanuc
        } else {
            Self::Ngc
        }
    }
}
