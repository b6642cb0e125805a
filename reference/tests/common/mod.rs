//! Courses that several tests use.

#![allow(dead_code, reason = "no test uses all of them")]

use toolglide_kinematics::{Feedrate, Limits, Tolerance, Vector};
use toolglide_reference::Course;

/// The feedrate of all numbers that are compared, 100 mm/s.
pub(crate) fn feedrate() -> Feedrate {
    Feedrate::new(100.0).unwrap()
}

/// Ten millimeters along x, a turn by some degrees, and a second leg.
pub(crate) fn bend(degrees: f64, length: f64) -> Vec<Vector<2>> {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    vec![
        Vector::<2>::zeros(),
        Vector::<2>::new(10.0, 0.0),
        Vector::<2>::new(10.0 + length * cosine, length * sine),
    ]
}

/// A course at the usual feedrate with equal axes.
pub(crate) fn course<const N: usize>(
    points: &[Vector<N>],
    acceleration: f64,
    jerk: f64,
    tolerance: f64,
) -> Course<N> {
    let limits = Limits::uniform(500.0, acceleration, jerk).unwrap();
    let tolerance = Tolerance::new(tolerance).unwrap();
    Course::through(points, limits, feedrate(), tolerance).unwrap()
}
