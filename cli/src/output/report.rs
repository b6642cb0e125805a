//! Reports the outcome of a command as text, as JSON and as an exit code.
//!
//! Not here: what is told.

use crate::error::{CliError, DONE, OUTSIDE};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::Write;

/// What came out, as JSON by its own names and as text.
pub(crate) trait Shown: Serialize {
    /// The text for people.
    fn text(&self) -> String;

    /// What was broken, one line each; empty when nothing was.
    fn complaint(&self) -> String;

    /// Whether every limit and tolerance is kept.
    fn passes(&self) -> bool;
}

/// Prints what came out and what is wrong with it; the exit code says whether anything is.
pub(crate) fn show(
    shown: &impl Shown,
    json: bool,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let text = if json {
        let mut text = serde_json::to_string_pretty(shown)?;
        text.push('\n');
        text
    } else {
        shown.text()
    };
    out.write_all(text.as_bytes())
        .map_err(|reason| CliError::write("standard output", reason))?;
    let _ = err.write_all(shown.complaint().as_bytes());
    Ok(if shown.passes() { DONE } else { OUTSIDE })
}

/// The same where the rows of set-points have standard output to themselves.
pub(crate) fn show_beside_rows(shown: &impl Shown, err: &mut dyn Write) -> Result<u8, CliError> {
    let mut text = Vec::new();
    let code = show(shown, false, &mut text, err)?;
    let _ = err.write_all(&text);
    Ok(code)
}

/// The verdict in one line, of a motion whose rows are so many times too far apart to be judged.
pub(crate) fn verdict(violations: u64, too_coarse: u64) -> String {
    let counted = |count: u64, what: &str| match count {
        1 => format!("1 {what}"),
        more => format!("{more} {what}s"),
    };
    let gaps = counted(too_coarse, "gap");
    match (violations, too_coarse) {
        (0, 0) => "verdict      every limit and tolerance is kept\n".to_owned(),
        (0, _) => format!("verdict      too coarse to judge: {gaps} between rows\n"),
        (_, 0) => format!(
            "verdict      NOT ALLOWED: {}\n",
            counted(violations, "violation")
        ),
        _ => format!(
            "verdict      NOT ALLOWED: {}; too coarse to judge the rest: {gaps} between rows\n",
            counted(violations, "violation")
        ),
    }
}

/// Whether a count is left out of what a program reads.
#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands fields over by reference"
)]
pub(crate) fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// Violations of one motion behind whose they are, and how many are not quoted.
pub(crate) fn quoted(whose: &str, worst: &[String], violations: u64) -> String {
    let mut text = String::new();
    for violation in worst {
        let _ = writeln!(text, "{whose}: {violation}");
    }
    let more = violations.saturating_sub(worst.len() as u64);
    if more > 0 {
        let _ = writeln!(text, "{whose}: and {more} more");
    }
    text
}
