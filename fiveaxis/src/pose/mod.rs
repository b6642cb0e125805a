//! Turns words of pose moves into blocks and corners with one duration for tip and tool.

pub(crate) mod block;
pub(crate) mod corner;
pub(crate) mod joint;
pub(crate) mod resolve;
pub(crate) mod start;
pub(crate) mod swing;
pub(crate) mod tool;
