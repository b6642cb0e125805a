//! Represents vectors of one coordinate per axis.
//!
//! Source: section 2.3 of the dissertation writes everything per axis; here it is written in vectors.
//! Not here: rotations and poses, see [`ToolPose`](crate::ToolPose).

use crate::error::ToolpathError;
use crate::numeric::{LARGEST_COORDINATE, SHORTEST_LENGTH};

/// A point or a difference of points, one coordinate per axis.
pub type Vector<const N: usize> = nalgebra::SVector<f64, N>;

/// Whether every coordinate is a finite number.
#[must_use]
pub fn is_finite<const N: usize>(vector: &Vector<N>) -> bool {
    vector.iter().all(|coordinate| coordinate.is_finite())
}

/// Checks that a point is one that planners can carry.
///
/// # Errors
/// [`ToolpathError::NotFinite`] for a coordinate that is no finite number, [`ToolpathError::TooFar`] for one beyond
/// [`LARGEST_COORDINATE`].
pub fn check<const N: usize>(point: &Vector<N>) -> Result<(), ToolpathError> {
    if !is_finite(point) {
        return Err(ToolpathError::NotFinite);
    }
    let farthest = point
        .iter()
        .find(|coordinate| coordinate.abs() > LARGEST_COORDINATE);
    farthest.map_or(Ok(()), |&value| Err(ToolpathError::TooFar { value }))
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
