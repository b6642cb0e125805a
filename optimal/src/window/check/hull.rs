//! Bounds a motion over a whole interval by its Bezier points.
//!
//! Source: a Bezier curve lies in the hull of its points, and halves of it by de Casteljau's method do so
//! more closely. Not here: which bounds.

use crate::window::WindowSegment;
use crate::window::check::SLACK;
use toolglide_kinematics::Vector;

/// The largest share of its limit that any axis uses.
pub(super) fn share_of<const N: usize>(value: &Vector<N>, limit: &Vector<N>) -> f64 {
    (0..N).fold(0.0, |most, axis| most.max(value[axis].abs() / limit[axis]))
}

/// Distance of a point from a segment.
pub(super) fn distance<const N: usize>(segment: &WindowSegment<N>, point: &Vector<N>) -> f64 {
    let span = segment.end - segment.start;
    let offset = point - segment.start;
    let along = (offset.dot(&span) / span.norm_squared()).clamp(0.0, 1.0);
    (offset - span * along).norm()
}

/// Upper bound of a convex function over a Bezier curve: at most 1 as soon as that can be told.
pub(super) fn hull<const N: usize, const POINTS: usize>(
    points: [Vector<N>; POINTS],
    halvings: u32,
    function: &impl Fn(&Vector<N>) -> f64,
) -> f64 {
    let mut most = 0.0_f64;
    for point in &points {
        let value = function(point);
        // A number that is none must not pass.
        most = if value.is_nan() {
            f64::INFINITY
        } else {
            most.max(value)
        };
    }
    let ends = function(&points[0]).max(function(&points[POINTS - 1]));
    if most <= 1.0 || halvings == 0 || ends > 1.0 + SLACK || !most.is_finite() {
        return most;
    }
    let (mut left, mut right) = (points, points);
    for (round, first) in left.iter_mut().enumerate().skip(1) {
        for index in 0..POINTS - round {
            right[index] = (right[index] + right[index + 1]) * 0.5;
        }
        *first = right[0];
    }
    // `right` now holds the second half from its beginning, `left` the first.
    hull(left, halvings - 1, function).max(hull(right, halvings - 1, function))
}
