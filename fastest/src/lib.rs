//! Hands out the fastest motion of several planners, section by section.
//!
//! Kinematic corner smoothing chooses among many motions, and FIR interpolation, or one kind of corner throughout, is
//! faster on some paths all the same. [`FasterOf`] compares two planners wherever both pass the same place in the same
//! state, and [`Fastest`] compares all of them. Not here: any motion.

mod faster_of;
mod fastest;
mod joint;

pub use faster_of::FasterOf;
pub use fastest::{Fastest, plan};
