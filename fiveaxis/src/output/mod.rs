//! Emits pieces of pose motion and samples them tick by tick.

pub(crate) mod pieces;
pub(crate) mod sampler;
