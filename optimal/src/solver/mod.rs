//! Solves the convex program of a window by sequential interior-point iterations.

pub(crate) mod budget;
pub(crate) mod cone;
pub(crate) mod interior;
pub(crate) mod riccati;
pub(crate) mod sequential;
pub(crate) mod small_blocks;
