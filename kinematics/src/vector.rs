//! Vectors of one coordinate per axis.
//!
//! Source: section 2.3 of the dissertation writes everything per axis; here it is written in vectors.
//! Not here: rotations and poses, see [`ToolPose`](crate::ToolPose).

use crate::numeric::SHORTEST_LENGTH;

/// A point or a difference of points, one coordinate per axis.
pub type Vector<const N: usize> = nalgebra::SVector<f64, N>;

/// Whether every coordinate is a finite number.
#[must_use]
pub fn is_finite<const N: usize>(vector: &Vector<N>) -> bool {
    vector.iter().all(|coordinate| coordinate.is_finite())
}

/// Length and unit direction from one point to another, or `None` when they coincide.
///
/// Points nearer than [`SHORTEST_LENGTH`] coincide.
#[must_use]
pub fn length_and_direction<const N: usize>(
    from: &Vector<N>,
    to: &Vector<N>,
) -> Option<(f64, Vector<N>)> {
    let span = to - from;
    let length = span.norm();
    (length > SHORTEST_LENGTH).then(|| (length, span / length))
}
