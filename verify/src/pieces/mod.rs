//! Judges planned pieces at every instant: limits, continuity, corners and the path.

pub(crate) mod dynamics;
pub(crate) mod judge;
pub(crate) mod move_progress;
pub(crate) mod tracker;
