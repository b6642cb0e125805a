//! Runs the `toolglide` command as a library: [`run`] takes arguments and streams and returns the
//! exit code, so that tests and other programs need no process.
//!
//! Exit codes: [`DONE`] when all is well, [`OUTSIDE`] when the motion breaks a limit, [`REFUSED`] for
//! wrong use or wrong input, [`INTERRUPTED`] and [`TERMINATED`] when a signal ends the process, which
//! [`end_on_signals`] does tidily.

mod commands;
mod error;
mod input;
mod methods;
mod output;
mod pipeline;
mod plot;
mod rounding;

pub use error::{CliError, DONE, INTERRUPTED, OUTSIDE, REFUSED, TERMINATED};
pub use input::signals::end_on_signals;
pub use methods::{METHODS, MethodName};

use clap::{CommandFactory, Parser};
use input::args::{Command, CommandLine};
use std::ffi::OsString;
use std::io::Write;

/// Runs the command with the given arguments, the first of which is the name of the program.
///
/// Results go to `out`, messages to `err`.
///
/// # Examples
/// ```
/// let (mut out, mut err) = (Vec::new(), Vec::new());
/// let code = toolglide_cli::run(["toolglide", "machines"], &mut out, &mut err);
/// assert_eq!(code, toolglide_cli::DONE);
/// assert!(String::from_utf8(out)?.contains("gantry"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn run<I, T>(arguments: I, out: &mut dyn Write, err: &mut dyn Write) -> u8
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let command = match CommandLine::try_parse_from(arguments) {
        Ok(line) => line.command,
        Err(message) => {
            // Help is what was asked for; anything else is a refusal.
            let asked = !message.use_stderr();
            let _ = if asked {
                write!(out, "{message}")
            } else {
                write!(err, "{message}")
            };
            return if asked { DONE } else { REFUSED };
        }
    };
    let outcome = match command {
        Command::Plan(args) => commands::plan::plan(&args, out, err),
        Command::Run(args) => commands::run::run(&args, out, err),
        Command::Verify(args) => commands::verify::verify(&args, out, err),
        Command::Compare(args) => commands::compare::compare(&args, out, err),
        Command::Score(args) => commands::score::score(&args, out, err),
        Command::Check(args) => commands::check::check(&args, out, err),
        Command::Spectrum(args) => commands::spectrum::spectrum(&args, out, err),
        Command::Reproduce(args) => commands::reproduce::reproduce(&args, out, err),
        Command::Simulate(args) => commands::simulate::simulate(&args, out, err),
        Command::Identify(args) => commands::identify::identify(&args, out, err),
        Command::Machines(args) => commands::machines::machines(&args, out).map(|()| DONE),
        Command::Completions { shell } => {
            let mut command = CommandLine::command();
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut command, "toolglide", &mut text);
            out.write_all(&text)
                .map_err(|reason| CliError::write("standard output", reason))
                .map(|()| DONE)
        }
    };
    let outcome = outcome.and_then(|code| {
        out.flush()
            .map_err(|reason| CliError::write("standard output", reason))
            .map(|()| code)
    });
    outcome.unwrap_or_else(|refused| {
        if !matches!(refused, CliError::BrokenPipe) {
            let _ = writeln!(err, "toolglide: {refused}");
        }
        refused.exit_code()
    })
}
