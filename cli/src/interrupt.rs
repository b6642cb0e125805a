//! Stopping from the keyboard without leaving half a file behind.

use crate::error::CliError;
use std::sync::atomic::{AtomicBool, Ordering};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Asks every run of this process to stop soon; a run that is still at work when it is asked again
/// ends the process.
pub fn interrupt() {
    if INTERRUPTED.swap(true, Ordering::Relaxed) {
        std::process::exit(i32::from(crate::error::INTERRUPTED));
    }
}

/// Stops the run when it was asked to.
pub(crate) fn check_interrupt() -> Result<(), CliError> {
    if INTERRUPTED.load(Ordering::Relaxed) {
        Err(CliError::Interrupted)
    } else {
        Ok(())
    }
}
