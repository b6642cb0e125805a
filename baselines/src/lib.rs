//! Plans motion as the dissertation's baselines do, to compare with; no controller needs this crate.
//!
//! [`BezierSmoothing`] rounds corners by splines at constant speed, inside the jerk limit or, as the text describes its own
//! baseline, without one at the corners. [`LocalOverlap`] overlaps filtered pulses by the printed rule of one corner alone,
//! which breaks its tolerance where corners are dense. Neither is a method for a machine.

mod bezier;
mod local_overlap;

pub use bezier::{BezierSmoothing, plan_bezier};
pub use local_overlap::LocalOverlap;
