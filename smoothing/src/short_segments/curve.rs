//! Describes a section of the path as a curve over its length.
//!
//! Source: ours. Not here: time.

use crate::segment::Segment;
use toolglide_kinematics::{MoveRange, Vector};

/// A control point and its place on the curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Control<const N: usize> {
    pub(super) point: Vector<N>,
    pub(super) distance: f64,
    pub(super) leg: usize,
    pub(super) serves: MoveRange,
}

/// Straight legs end to end, found by the distance along them.
#[derive(Clone, Debug)]
pub(super) struct Curve<const N: usize> {
    legs: Vec<Segment<N>>,
    /// Distance at which each leg begins, and the whole length at the end.
    marks: Vec<f64>,
}

impl<const N: usize> Curve<N> {
    pub(super) fn with_capacity(legs: usize) -> Self {
        Self {
            legs: Vec::with_capacity(legs),
            marks: Vec::with_capacity(legs + 1),
        }
    }

    pub(super) fn set(&mut self, legs: &[Segment<N>]) {
        self.legs.clear();
        self.legs.extend_from_slice(legs);
        self.marks.clear();
        let mut mark = 0.0;
        for leg in legs {
            self.marks.push(mark);
            mark += leg.length;
        }
        self.marks.push(mark);
    }

    pub(super) fn legs(&self) -> &[Segment<N>] {
        &self.legs
    }

    pub(super) fn length(&self) -> f64 {
        self.marks.last().copied().unwrap_or(0.0)
    }

    /// Distance at which a leg begins.
    pub(super) fn mark(&self, leg: usize) -> f64 {
        self.marks[leg.min(self.legs.len())]
    }

    /// The leg at a distance, searched from a leg nearby.
    #[inline]
    pub(super) fn leg_at(&self, distance: f64, near: usize) -> usize {
        let last = self.legs.len() - 1;
        let mut index = near.min(last);
        while index < last && self.marks[index + 1] <= distance {
            index += 1;
        }
        while index > 0 && self.marks[index] > distance {
            index -= 1;
        }
        index
    }

    /// The control point at a distance, searched from a leg nearby.
    #[inline]
    pub(super) fn control_at(&self, distance: f64, near: usize) -> Control<N> {
        let leg = self.leg_at(distance, near);
        Control {
            point: self.point(distance, leg),
            distance,
            leg,
            serves: self.legs[leg].serves,
        }
    }

    /// The control point at the very end.
    pub(super) fn end(&self) -> Control<N> {
        let leg = self.legs.len() - 1;
        Control {
            point: self.legs[leg].end,
            distance: self.length(),
            leg,
            serves: self.legs[leg].serves,
        }
    }

    /// The point at a distance on the leg that `leg_at` found; the ends beyond the curve.
    #[inline]
    pub(super) fn point(&self, distance: f64, leg: usize) -> Vector<N> {
        let at = &self.legs[leg];
        let along = distance - self.marks[leg];
        if along <= 0.0 {
            at.start
        } else if along >= at.length {
            at.end
        } else {
            at.start + at.direction * along
        }
    }

    /// The same, going straight on beyond the ends of the curve.
    #[inline]
    pub(super) fn point_beyond(&self, distance: f64, leg: usize) -> Vector<N> {
        let at = &self.legs[leg];
        at.start + at.direction * (distance - self.marks[leg])
    }
}

/// Distance from a point to a segment.
#[inline]
pub(super) fn distance_to<const N: usize>(
    point: &Vector<N>,
    from: &Vector<N>,
    to: &Vector<N>,
) -> f64 {
    let span = to - from;
    let offset = point - from;
    let square = span.norm_squared();
    let share = if square > 0.0 {
        (offset.dot(&span) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (offset - span * share).norm()
}
