//! Takes the operator's commands, checks them and keeps the latest of each.
//!
//! Every command is a level or an edge of a plain struct; the executor reads it once per step. Of several at once the
//! strongest counts: abort, hold, stop at the end of a block, override.

use crate::terms::Caps;
use thiserror::Error;

/// Why a command is refused; what was in force stays in force.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CommandError {
    /// An override must be a number that is not negative.
    #[error("{which} override is {value}, but must be a finite number that is not negative")]
    Override {
        /// "feed" or "rapid".
        which: &'static str,
        /// The value given.
        value: f64,
    },
}

/// An override after it was taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taken {
    /// As it was given.
    Exactly,
    /// The largest one instead.
    Clamped,
}

/// The commands of an operator.
#[derive(Clone, Debug, PartialEq)]
pub struct Commands {
    hold: bool,
    abort: bool,
    reverse: bool,
    block_end: bool,
    caps: Caps,
}

impl Commands {
    pub(crate) fn new(caps: Caps) -> Self {
        Self {
            hold: false,
            abort: false,
            reverse: false,
            block_end: false,
            caps,
        }
    }

    /// Stops the motion on its path as soon as its limits allow. A dwell is held, too.
    pub fn hold(&mut self) {
        self.hold = true;
    }

    /// Goes on at the override in force: after a hold, after a stop at a block end, and after an abort, once pieces
    /// from the place of the abort on are fed.
    pub fn resume(&mut self) {
        self.hold = false;
        self.block_end = false;
        self.abort = false;
    }

    /// Holds, then forgets every piece in hand.
    pub fn abort(&mut self) {
        self.abort = true;
    }

    /// Goes backwards along the pieces that are kept.
    pub fn reverse(&mut self) {
        self.reverse = true;
    }

    /// Goes forwards again.
    pub fn forward(&mut self) {
        self.reverse = false;
    }

    /// Stops where the block ends that is executed now; it needs a place that serves this block alone.
    pub fn stop_at_block_end(&mut self) {
        self.block_end = true;
    }

    /// Sets the feed override: 1 for the programmed feedrate, 0 for a hold; above the greatest the greatest.
    ///
    /// # Errors
    /// [`CommandError::Override`] for a value that is negative, infinite or no number.
    pub fn feed(&mut self, value: f64) -> Result<Taken, CommandError> {
        let most = self.caps.top;
        let (value, taken) = checked("feed", value, most)?;
        self.caps.feed = value;
        Ok(taken)
    }

    /// Sets the rapid override, 1 at most.
    ///
    /// # Errors
    /// As [`Commands::feed`].
    pub fn rapid(&mut self, value: f64) -> Result<Taken, CommandError> {
        let (value, taken) = checked("rapid", value, 1.0)?;
        self.caps.rapid = value;
        Ok(taken)
    }

    pub(crate) fn caps(&self) -> Caps {
        self.caps
    }

    pub(crate) fn is_held(&self) -> bool {
        self.hold || self.abort
    }

    pub(crate) fn is_aborted(&self) -> bool {
        self.abort
    }

    pub(crate) fn stops_at_block_end(&self) -> bool {
        self.block_end
    }

    /// 1 forwards, -1 backwards.
    pub(crate) fn direction(&self) -> f64 {
        if self.reverse { -1.0 } else { 1.0 }
    }
}

fn checked(which: &'static str, value: f64, most: f64) -> Result<(f64, Taken), CommandError> {
    if !(value >= 0.0 && value.is_finite()) {
        return Err(CommandError::Override { which, value });
    }
    if value > most {
        return Ok((most, Taken::Clamped));
    }
    Ok((value, Taken::Exactly))
}
