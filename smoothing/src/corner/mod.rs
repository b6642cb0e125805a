//! Blends one corner: each kind of corner motion, and the choice of the kinds that compete.

pub(crate) mod candidates;
pub(crate) mod interrupted;
pub(crate) mod stop_start;
pub(crate) mod uninterrupted;
