//! Runs the commands of `toolglide`, a file each.

pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod identify;
pub(crate) mod machines;
pub(crate) mod plan;
pub(crate) mod poses;
pub(crate) mod reproduce;
pub(crate) mod run;
pub(crate) mod score;
pub(crate) mod simulate;
pub(crate) mod spectrum;
pub(crate) mod verify;
