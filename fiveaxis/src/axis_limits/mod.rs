//! Slows blocks down until every axis behind the inverse kinematics keeps its limits.

pub(crate) mod axis_bounds;
pub(crate) mod axis_path;
pub(crate) mod block_splitting;
pub(crate) mod chebyshev;
pub(crate) mod quick_bounds;
pub(crate) mod remeasure;
pub(crate) mod slow_down;
