//! The `toolglide` command: the library's [`run`](toolglide_cli::run) with the streams of the
//! process.

use std::process::ExitCode;

fn main() -> ExitCode {
    // Without a handler the run is only less tidy when it is interrupted.
    let _ = ctrlc::set_handler(toolglide_cli::interrupt);
    let code = toolglide_cli::run(
        std::env::args_os(),
        &mut std::io::stdout().lock(),
        &mut std::io::stderr(),
    );
    ExitCode::from(code)
}
