//! Writes every servo period of a simulation as CSV.
//!
//! Not here: set-points of a plan, see `csv_writer`.

use super::case::Case;
use crate::error::CliError;
use crate::output::csv_writer::{CHUNK, number};
use std::fmt::Write as _;
use std::io::Write;
use std::path::PathBuf;
use toolglide_simulation::{Instant, SHOWN_MODES};

/// Rows on their way to a file.
pub(super) struct Rows<'a> {
    sink: &'a mut dyn Write,
    name: PathBuf,
    modes: usize,
    text: Vec<u8>,
}

impl<'a> Rows<'a> {
    /// Begins with the header.
    pub(super) fn new(case: &Case, sink: &'a mut dyn Write, name: PathBuf) -> Self {
        let axes: Vec<String> = case
            .drives
            .axes
            .iter()
            .map(|axis| axis.name.to_ascii_lowercase().to_string())
            .collect();
        let mut header = "t_s".to_owned();
        for kind in ["planned", "actual", "foot"] {
            for axis in &axes {
                let _ = write!(header, ",{kind}_{axis}");
            }
        }
        header.push_str(",servo_error_um,part_error_um,tolerance_um,line");
        for kind in ["force", "friction"] {
            for axis in &axes {
                let _ = write!(header, ",{kind}_{axis}");
            }
        }
        let mut modes = 0;
        for axis in &case.drives.axes {
            for mode in axis.model.modes() {
                if modes < SHOWN_MODES {
                    let name = axis.name.to_ascii_lowercase();
                    let _ = write!(header, ",mode_{name}_{}hz", mode.frequency);
                    modes += 1;
                }
            }
        }
        header.push('\n');
        Self {
            sink,
            name,
            modes,
            text: header.into_bytes(),
        }
    }

    /// Takes an instant.
    pub(super) fn take<const N: usize>(&mut self, instant: &Instant<N>) -> Result<(), CliError> {
        // The period is a decimal, so its multiples are written as one.
        number(&mut self.text, (instant.time * 1e9).round() / 1e9);
        let errors = [
            1e3 * instant.servo.norm(),
            1e3 * instant.part,
            1e3 * instant.tolerance,
            f64::from(instant.line),
        ];
        let cells = instant
            .planned
            .iter()
            .chain(instant.actual.iter())
            .chain(instant.foot.iter())
            .chain(&errors)
            .chain(instant.force.iter())
            .chain(instant.friction.iter())
            .chain(&instant.modes[..self.modes]);
        for &cell in cells {
            self.text.push(b',');
            number(&mut self.text, cell);
        }
        self.text.push(b'\n');
        if self.text.len() >= CHUNK {
            self.hand_on()?;
        }
        Ok(())
    }

    /// Writes what is left.
    pub(super) fn finish(mut self) -> Result<(), CliError> {
        self.hand_on()?;
        self.sink
            .flush()
            .map_err(|reason| CliError::write(&self.name, reason))
    }

    fn hand_on(&mut self) -> Result<(), CliError> {
        self.sink
            .write_all(&self.text)
            .map_err(|reason| CliError::write(&self.name, reason))?;
        self.text.clear();
        Ok(())
    }
}
