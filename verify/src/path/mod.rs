//! Measures how far a motion is from the true path of lines and arcs.

pub(crate) mod bernstein;
pub(crate) mod chord;
pub(crate) mod closest_approach;
pub(crate) mod course;
pub(crate) mod deviation;
pub(crate) mod deviation_bound;
pub(crate) mod helix;
pub(crate) mod leg;
pub(crate) mod route;
