//! Plans the examples of the dissertation and prints its numbers beside ours.
//!
//! Source: chapters 2 to 4 of Tajima, Smooth Trajectory Generation for Machine Tools and Industrial
//! Robots (Oregon State University, 2019). Not here: the programs, which are part of the examples.

mod crossover;
mod experiments;
mod poses;
mod quantity;
mod rows;
mod run;

use crate::error::{CliError, DONE, OUTSIDE};
use crate::input::args::ReproduceArgs;
use experiments::{EXPERIMENTS, Experiment};
use rows::{Row, rows, text};
use run::Runs;
use std::io::Write;

/// Runs the command.
pub(crate) fn reproduce(
    args: &ReproduceArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let mut runs = Runs::default();
    let groups = chosen(args.name.as_deref())?
        .into_iter()
        .map(|experiment| Ok((experiment, rows(experiment, &mut runs)?)))
        .collect::<Result<Vec<_>, CliError>>()?;
    let shown = if args.json {
        let all: Vec<&Row> = groups.iter().flat_map(|group| &group.1).collect();
        let mut text = serde_json::to_string_pretty(&all)?;
        text.push('\n');
        text
    } else {
        text(&groups)
    };
    out.write_all(shown.as_bytes())
        .map_err(|reason| CliError::write("standard output", reason))?;
    for complaint in runs.complaints() {
        let _ = writeln!(err, "{complaint}");
    }
    Ok(if runs.complaints().is_empty() {
        DONE
    } else {
        OUTSIDE
    })
}

fn chosen(name: Option<&str>) -> Result<Vec<&'static Experiment>, CliError> {
    let Some(name) = name else {
        return Ok(EXPERIMENTS.iter().collect());
    };
    let found: Vec<_> = EXPERIMENTS
        .iter()
        .filter(|experiment| experiment.name == name)
        .collect();
    if found.is_empty() {
        let names: Vec<_> = EXPERIMENTS
            .iter()
            .map(|experiment| experiment.name)
            .collect();
        return Err(CliError::Option {
            option: "NAME",
            value: format!("\"{name}\""),
            bound: format!("there are {}", names.join(", ")),
        });
    }
    Ok(found)
}
