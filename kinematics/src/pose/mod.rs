//! Describes tool poses: orientation on the sphere, moves, legs and pieces of pose motion.

pub(crate) mod great_circle;
pub(crate) mod leg;
pub(crate) mod moves;
pub(crate) mod piece;
pub(crate) mod tool_pose;
