//! Chooses between SVG and PNG by the name of a file.

use super::render::png;
use crate::error::CliError;
use crate::output::files::OutputFile;
use std::io::Write;
use std::path::Path;

/// The kind of a picture file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Picture {
    /// Lines and letters.
    Svg,
    /// Pixels.
    Png,
}

impl Picture {
    /// The kind that the ending of the name asks for.
    pub(crate) fn of(path: &Path) -> Result<Self, CliError> {
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(CliError::Option {
                option: "--plot",
                value: path.display().to_string(),
                bound: "its name must end in .svg or .png".to_owned(),
            }),
        }
    }

    /// Writes a drawing, given as SVG text.
    pub(crate) fn write(self, svg: &str, file: &mut OutputFile) -> Result<(), CliError> {
        let pixels;
        let bytes = match self {
            Self::Svg => svg.as_bytes(),
            Self::Png => {
                pixels = png(svg).map_err(|reason| CliError::Plot {
                    file: file.path().to_owned(),
                    reason,
                })?;
                &pixels
            }
        };
        let path = file.path().to_owned();
        file.write_all(bytes)
            .map_err(|reason| CliError::write(path, reason))
    }
}
