//! Reads machine files in TOML and prints their JSON Schema.
//!
//! Source: [`MachineConfig`]. Not here: building the machine.

use crate::config::MachineConfig;
use crate::error::MachineError;
use std::path::Path;

/// Largest machine file that is read, bytes: a description of a few axes has some hundred.
const LARGEST_FILE: u64 = 1 << 20;

/// Reads a machine file.
///
/// # Errors
/// [`MachineError::Read`] when it cannot be read, and what [`from_toml`] refuses, with the file.
pub fn load(file: &Path) -> Result<MachineConfig, MachineError> {
    let read = |reason| MachineError::Read {
        file: file.to_owned(),
        reason,
    };
    let found = std::fs::metadata(file).map_err(read)?;
    if !found.is_file() {
        let what = if found.is_dir() {
            "it is a folder"
        } else {
            "it is no regular file, but a pipe or a device"
        };
        return Err(read(std::io::Error::other(what)));
    }
    let size = found.len();
    if size > LARGEST_FILE {
        return Err(MachineError::InFile {
            file: file.to_owned(),
            reason: Box::new(MachineError::field("size", size, "less than 1 MiB")),
        });
    }
    let text = std::fs::read_to_string(file).map_err(read)?;
    from_toml(&text).map_err(|reason| MachineError::InFile {
        file: file.to_owned(),
        reason: Box::new(reason),
    })
}

/// Reads the text of a machine file.
///
/// # Errors
/// [`MachineError::Syntax`] for text that is no TOML, for unknown fields and for missing ones.
///
/// # Examples
/// ```
/// let config = toolglide_machines::from_toml(r#"
///     model = "gantry"
///     name = "plotter"
///     axis = [
///         { name = "X", velocity = 300.0, acceleration = 2000.0, jerk = 5e4 },
///         { name = "Y", velocity = 300.0, acceleration = 1500.0, jerk = 5e4 },
///     ]
/// "#)?;
/// assert_eq!(config.letters(), "XY");
/// # Ok::<(), toolglide_machines::MachineError>(())
/// ```
pub fn from_toml(text: &str) -> Result<MachineConfig, MachineError> {
    toml::from_str(text).map_err(|error| MachineError::Syntax {
        line: error.span().map_or(1, |span| {
            1 + text[..span.start.min(text.len())].matches('\n').count()
        }),
        reason: error.message().replace('\n', ", "),
    })
}

/// The JSON Schema of machine files.
#[must_use]
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(MachineConfig)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLOTTER: &str = "model = \"gantry\"\nname = \"plotter\"\n\n[[axis]]\nname = \"X\"\nvelocity = 300\nacceleration = 2000\njerk = 5e4\n";

    #[test]
    fn what_is_left_out_has_the_usual_value() {
        let config = from_toml(PLOTTER).unwrap();
        assert!(
            (config.tolerance().unwrap().length() - 0.01).abs() < 1e-15,
            "tolerance"
        );
        assert!(
            (config.period().unwrap().seconds() - 0.001).abs() < 1e-15,
            "period"
        );
        assert_eq!(config.axis[0].travel, None, "travel");
    }

    #[test]
    fn an_unknown_field_is_refused_with_its_line() {
        for (addition, field, at) in [("speed = 3\n", "speed", 9), ("[extra]\n", "extra", 9)] {
            let refused = from_toml(&format!("{PLOTTER}{addition}")).unwrap_err();
            assert!(
                matches!(&refused, MachineError::Syntax { line, reason }
                    if *line == at && reason.contains(field)),
                "{refused:?}"
            );
        }
    }

    #[test]
    fn a_missing_field_is_named() {
        let refused = from_toml("model = \"gantry\"\nname = \"m\"\n").unwrap_err();
        assert!(refused.to_string().contains("axis"), "{refused}");
    }

    #[test]
    fn text_that_is_no_toml_is_refused() {
        for text in [
            "model = ",
            "\u{0}\u{1}",
            "G1 X10",
            "model = 3\nname = \"m\"\naxis = []\n",
        ] {
            assert!(
                matches!(from_toml(text), Err(MachineError::Syntax { .. })),
                "{text:?}"
            );
        }
    }

    #[test]
    fn the_schema_names_every_field_and_no_other() {
        let schema = serde_json::to_string(&schema()).unwrap();
        for field in [
            "model",
            "tolerance_mm",
            "period_s",
            "axis",
            "mode",
            "frequency_hz",
            "fir_s",
            "velocity",
            "travel",
        ] {
            assert!(
                schema.contains(&format!("\"{field}\"")),
                "{field} in {schema}"
            );
        }
        assert!(
            schema.contains("\"additionalProperties\":false"),
            "{schema}"
        );
    }
}
