//! Ends the process at the first signal and leaves no half-written file behind.
//!
//! A thread waits for signals. It takes away the files that are not complete and ends the process, so
//! that a solver, a read of a pipe and a loop of a program need not look for signals themselves.

use crate::output::part::{Written, take_away};
use std::io::{IsTerminal, Write};
use std::sync::mpsc::channel;
use std::time::Duration;

/// How long the message may take: a full pipe behind standard error must not hold up the end.
const MESSAGE: Duration = Duration::from_millis(100);

/// From now on SIGINT, SIGTERM and SIGHUP end the process within moments: files that are not complete are
/// taken away, and the exit code is 128 and the number of the signal. Where signals cannot be waited for,
/// they end the process as the system does.
pub fn end_on_signals() {
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        let Ok(mut signals) = signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGHUP]) else {
            return;
        };
        std::thread::spawn(move || {
            if let Some(signal) = signals.forever().next() {
                end(128 + signal);
            }
        });
    }
    #[cfg(not(unix))]
    {
        let _ = ctrlc::set_handler(|| end(i32::from(crate::error::INTERRUPTED)));
    }
}

fn end(code: i32) -> ! {
    let (parts, written) = take_away();
    let (said, wait) = channel();
    std::thread::spawn(move || {
        let mut err = std::io::stderr();
        // A display of progress may stand in this line.
        let clear = if err.is_terminal() { "\r\x1b[K" } else { "" };
        let what = match written {
            Written::Nothing => "nothing was written",
            Written::All => "the files were complete",
        };
        let _ = writeln!(err, "{clear}toolglide: interrupted; {what}");
        said.send(())
    });
    let _ = wait.recv_timeout(MESSAGE);
    // Until here no file can be begun or get its name.
    let _parts = parts;
    std::process::exit(code)
}
