//! Counts what planning costs, without a clock.
//!
//! Source: ours. Processor time is some tenths of a microsecond a piece and some microseconds a corner. Not here: any
//! bound.

/// What a planner has done since it was made, trials that came to nothing included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Pieces of splines that were proposed.
    pub pieces: u64,
    /// Segments that were joined to the one before them in a corner.
    pub corners: u64,
}
