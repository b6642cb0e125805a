//! Stores a path of any length in fixed memory: points farther apart than a spacing that grows.
//!
//! The spacing is a share of the extent of the path, so that nothing larger than a fraction of a
//! pixel is lost before the path has more points than a picture has room for.

use toolglide_kinematics::Vector;

/// Most points that are kept.
const MAX_POINTS: usize = 60_000;

/// Spacing from which thinning starts, as a share of the extent: a fifth of a pixel.
const FIRST_SHARE: f64 = 1.0 / 4000.0;

/// Points of a path with a value each.
#[derive(Clone, Debug)]
pub(crate) struct Trace<const N: usize> {
    points: Vec<(Vector<N>, f64)>,
    last: (Vector<N>, f64),
    spacing: f64,
    low: Vector<N>,
    high: Vector<N>,
}

impl<const N: usize> Trace<N> {
    /// A path that begins.
    pub(crate) fn starting_at(point: Vector<N>, value: f64) -> Self {
        Self {
            points: vec![(point, value)],
            last: (point, value),
            spacing: 0.0,
            low: point,
            high: point,
        }
    }

    /// Appends a point.
    #[inline]
    pub(crate) fn push(&mut self, point: Vector<N>, value: f64) {
        self.last = (point, value);
        let far = self
            .points
            .last()
            .is_none_or(|kept| (point - kept.0).norm() >= self.spacing);
        if far {
            self.low = self.low.inf(&point);
            self.high = self.high.sup(&point);
            self.points.push((point, value));
            if self.points.len() > MAX_POINTS {
                self.thin();
            }
        }
    }

    /// Points nearer than this are one.
    pub(crate) fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Lowest and highest coordinates.
    pub(crate) fn extent(&self) -> (Vector<N>, Vector<N>) {
        (self.low, self.high)
    }

    /// Length of the path through the points that were kept.
    pub(crate) fn length(&self) -> f64 {
        self.points
            .windows(2)
            .map(|pair| (pair[1].0 - pair[0].0).norm())
            .sum()
    }

    /// The points that were kept, and the last one.
    pub(crate) fn points(&self) -> impl Iterator<Item = (Vector<N>, f64)> + '_ {
        self.points.iter().copied().chain([self.last])
    }

    fn thin(&mut self) {
        let spacing = (2.0 * self.spacing).max(FIRST_SHARE * (self.high - self.low).norm());
        self.spacing = spacing;
        let mut kept: Option<Vector<N>> = None;
        self.points.retain(|(point, _)| {
            let far = kept.is_none_or(|last| (point - last).norm() >= spacing);
            if far {
                kept = Some(*point);
            }
            far
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_points_are_thinned_and_their_extent_is_kept() {
        let mut trace = Trace::starting_at(Vector::<2>::zeros(), 0.0);
        for step in 0..1_000_000 {
            let angle = f64::from(step) * 1e-3;
            trace.push(
                Vector::<2>::new(angle.cos(), 2.0 * angle.sin()) * 50.0,
                angle,
            );
        }
        assert!(trace.points().count() <= MAX_POINTS + 1, "bounded");
        let (low, high) = trace.extent();
        assert!(
            (high - Vector::<2>::new(50.0, 100.0)).norm() < 0.1,
            "{high}"
        );
        assert!((low + high).norm() < 0.1, "{low}");
    }
}
