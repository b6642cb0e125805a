//! Describes a section of the path, lines and arcs, as a curve over its length.
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

/// Legs end to end, found by the distance along them.
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
        } else if let Some(bend) = &at.bend {
            bend.point(along / at.length)
        } else {
            at.start + at.direction * along
        }
    }

    /// Direction of the way at a distance on the leg that `leg_at` found.
    #[inline]
    pub(super) fn direction(&self, distance: f64, leg: usize) -> Vector<N> {
        let at = &self.legs[leg];
        at.bend.as_ref().map_or(at.direction, |bend| {
            bend.tangent(((distance - self.marks[leg]) / at.length).clamp(0.0, 1.0))
        })
    }

    /// Whether two legs are parts of one arc.
    #[inline]
    pub(super) fn are_one_arc(&self, leg: usize, other: usize) -> bool {
        let [one, other] = [leg, other].map(|index| &self.legs[index]);
        // Moves that lead nowhere may come before the arc in its first part.
        one.bend.is_some() && other.bend.is_some() && one.serves.last == other.serves.last
    }

    /// How much the parts of one arc, between two of its legs, differ because its radii do.
    pub(super) fn unevenness(&self, first: usize, last: usize) -> f64 {
        let bends = self.legs[first..=last]
            .iter()
            .filter_map(|leg| leg.bend.as_ref());
        let Some(one) = bends.clone().next() else {
            return 0.0;
        };
        bends.fold(0.0, |most: f64, bend| most.max(bend.unlike(one)))
    }

    /// How far arcs between two distances, on some legs, lie from the lines between these and the ends of the legs.
    pub(super) fn sagitta(&self, begin: f64, end: f64, first: usize, last: usize) -> f64 {
        (first..=last).fold(0.0_f64, |most, leg| {
            self.legs[leg].bend.as_ref().map_or(most, |bend| {
                let length = self.marks[leg + 1].min(end) - self.marks[leg].max(begin);
                most.max(0.125 * length * length / bend.bending())
            })
        })
    }

    /// The first leg of the arc that a leg belongs to, and the first behind it; the leg itself where it is straight.
    pub(super) fn arc_around(&self, leg: usize) -> (usize, usize) {
        let (mut first, mut end) = (leg, leg + 1);
        while first > 0 && self.are_one_arc(first - 1, leg) {
            first -= 1;
        }
        while end < self.legs.len() && self.are_one_arc(end, leg) {
            end += 1;
        }
        (first, end)
    }

    /// The same, going straight on beyond the ends of the curve.
    #[inline]
    pub(super) fn point_beyond(&self, distance: f64, leg: usize) -> Vector<N> {
        let at = &self.legs[leg];
        let along = distance - self.marks[leg];
        match &at.bend {
            None => at.start + at.direction * along,
            Some(bend) => {
                let share = (along / at.length).clamp(0.0, 1.0);
                let beyond = along - share * at.length;
                let point = bend.point(share);
                if beyond == 0.0 {
                    point
                } else {
                    point + bend.tangent(share) * beyond
                }
            }
        }
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
