//! Differences set-points into velocity, acceleration and jerk, as far as they are certain.
//!
//! Source: `n!` times the divided difference of order `n` is a weighted mean of the nth derivative
//! over its points (Peano), so that it never exceeds a bound that the derivative keeps, whatever
//! the intervals are. Not here: what happens between two points.

use toolglide_kinematics::Limits;
use toolglide_kinematics::Vector;
use toolglide_kinematics::numeric::COORDINATE_ROUNDING;

/// How many points the difference of the highest order needs.
const POINTS: usize = 4;

/// A mean derivative of each axis, and by how much rounding may have changed it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mean<const N: usize> {
    pub(crate) value: Vector<N>,
    pub(crate) noise: Vector<N>,
    /// Middle of the points, and their span.
    pub(crate) time: f64,
    pub(crate) span: f64,
}

impl<const N: usize> Mean<N> {
    /// The magnitude that is certain on one axis.
    pub(crate) fn certain(&self, axis: usize) -> f64 {
        (self.value[axis].abs() - self.noise[axis]).max(0.0)
    }
}

/// The last few set-points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recent<const N: usize> {
    /// Newest first.
    points: [(f64, Vector<N>); POINTS],
    count: usize,
    resolution: f64,
    velocity: Vector<N>,
}

impl<const N: usize> Recent<N> {
    pub(crate) fn new(limits: &Limits<N>, resolution: f64) -> Self {
        Self {
            points: [(0.0, Vector::zeros()); POINTS],
            count: 0,
            resolution,
            velocity: *limits.velocity(),
        }
    }

    pub(crate) fn push(&mut self, time: f64, position: Vector<N>) {
        self.points.rotate_right(1);
        self.points[0] = (time, position);
        self.count = (self.count + 1).min(POINTS);
    }

    /// The points, newest first.
    pub(crate) fn points(&self) -> &[(f64, Vector<N>)] {
        &self.points[..self.count]
    }

    /// By how much rounding may have moved a point: its own, and that of its time.
    pub(crate) fn rounding(&self, time: f64, position: &Vector<N>) -> Vector<N> {
        Vector::from_fn(|axis, _| {
            let size = position[axis].abs() + self.velocity[axis] * time.abs();
            self.resolution + COORDINATE_ROUNDING * size
        })
    }

    /// Mean derivative of an order over the newest points; `None` while there are too few.
    pub(crate) fn mean(&self, order: usize) -> Option<Mean<N>> {
        let points = self.points().get(..=order)?;
        let (newest, origin) = points[0];
        let oldest = points[order].0;
        let mut factor = 1.0;
        for k in [2.0, 3.0].into_iter().take(order.saturating_sub(1)) {
            factor *= k;
        }
        let mut value = Vector::zeros();
        let mut noise = Vector::zeros();
        for (index, (time, position)) in points.iter().enumerate() {
            let mut weight = factor;
            for (other, (time_there, _)) in points.iter().enumerate() {
                if other != index {
                    weight /= time - time_there;
                }
            }
            value += (position - origin) * weight;
            noise += self.rounding(*time, position) * weight.abs();
        }
        Some(Mean {
            value,
            noise,
            time: 0.5 * (newest + oldest),
            span: newest - oldest,
        })
    }
}
