//! Runs the library's [`run`](toolglide_cli::run) with the streams of the process.

use std::process::ExitCode;

fn main() -> ExitCode {
    toolglide_cli::end_on_signals();
    let code = toolglide_cli::run(
        std::env::args_os(),
        &mut std::io::stdout().lock(),
        &mut std::io::stderr(),
    );
    ExitCode::from(code)
}
