//! Scales the corner motions of a look-ahead window and chooses the fastest sequence of them.

pub(crate) mod candidate_graph;
pub(crate) mod corners;
pub(crate) mod overlap;
pub(crate) mod scale;
pub(crate) mod two_jerks;
pub(crate) mod unroll;
pub(crate) mod window;
