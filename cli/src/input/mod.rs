//! Reads options, programs, machines and set-points into what a command needs.

pub(crate) mod args;
pub(crate) mod csv_reader;
pub(crate) mod drives;
pub(crate) mod filters;
pub(crate) mod recording;
pub(crate) mod setup;
pub(crate) mod signals;
pub(crate) mod silence;
pub(crate) mod source;
pub(crate) mod travel;
pub(crate) mod values;
