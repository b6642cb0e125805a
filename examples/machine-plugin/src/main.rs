//! The command `toolglide` with one machine more.

use nutating_table as _; // without this line the machine is not linked, and not there
use std::io::{stderr, stdout};

fn main() -> std::process::ExitCode {
    let (mut out, mut err) = (stdout().lock(), stderr());
    toolglide_cli::run(std::env::args_os(), &mut out, &mut err).into()
}
