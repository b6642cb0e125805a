//! Turns streamed moves into merged segments and cuts them into spans of a window.

pub(crate) mod chords;
pub(crate) mod merge;
pub(crate) mod spans;
