//! Describes circular moves, flat or helical, in any number of axes.
//!
//! Source: section 4.2.3 for the circle; the lift and the slightly unequal radii are ours, because
//! real programs have both. Not here: chords, which a planner makes inside its tolerance.

use crate::error::ToolpathError;
#[cfg(not(feature = "std"))]
use crate::no_std::*;
use crate::numeric::{
    ARC_RADIUS_MISMATCH, ARC_RADIUS_MISMATCH_MOST, ARC_RADIUS_MISMATCH_SHARE, SHORTEST_LENGTH,
};
use crate::vector::{Vector, check};

/// A turn about a centre in a plane, while the other axes advance in proportion to the angle.
///
/// The radius goes linearly from that of the start to that of the end, so that both ends are met
/// exactly although programs round their centres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc<const N: usize> {
    start: Vector<N>,
    end: Vector<N>,
    center: Vector<N>,
    radial: Vector<N>,
    lateral: Vector<N>,
    start_radius: f64,
    end_radius: f64,
    sweep: f64,
    lift: Vector<N>,
}

impl<const N: usize> Arc<N> {
    /// An arc about `center` in the plane of two axes.
    ///
    /// `plane` names the two axes so that a positive turn goes from the first towards the second.
    /// The arc is counter-clockwise in that sense if `counter_clockwise`. Start and end that
    /// coincide in the plane make a full circle; `extra_turns` adds whole circles to either. The
    /// coordinates of `center` outside the plane do not matter.
    ///
    /// # Errors
    /// [`ToolpathError::ArcPlane`] when the plane does not name two different axes,
    /// [`ToolpathError::ArcRadius`] when a radius is zero,
    /// [`ToolpathError::ArcMismatch`] when start and end lie on circles whose radii differ by more
    /// than [`ARC_RADIUS_MISMATCH`] or [`ARC_RADIUS_MISMATCH_SHARE`], whichever is larger, or by
    /// more than [`ARC_RADIUS_MISMATCH_MOST`],
    /// [`ToolpathError::NotFinite`] for coordinates that are not finite, [`ToolpathError::TooFar`] for those beyond
    /// [`LARGEST_COORDINATE`](crate::numeric::LARGEST_COORDINATE).
    ///
    /// # Examples
    /// ```
    /// use toolglide_kinematics::{Arc, Vector};
    /// let quarter = Arc::about(
    ///     Vector::<2>::new(10.0, 0.0), Vector::<2>::new(0.0, 10.0), Vector::<2>::zeros(),
    ///     [0, 1], true, 0)?;
    /// assert!((quarter.length() - 5.0 * core::f64::consts::PI).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn about(
        start: Vector<N>,
        end: Vector<N>,
        center: Vector<N>,
        plane: [usize; 2],
        counter_clockwise: bool,
        extra_turns: u32,
    ) -> Result<Self, ToolpathError> {
        let [first, second] = plane;
        if first == second || first >= N || second >= N {
            return Err(ToolpathError::ArcPlane { plane, axes: N });
        }
        for point in [&start, &end, &center] {
            check(point)?;
        }
        let from = [start[first] - center[first], start[second] - center[second]];
        let to = [end[first] - center[first], end[second] - center[second]];
        let start_radius = from[0].hypot(from[1]);
        let end_radius = to[0].hypot(to[1]);
        if !(start_radius > SHORTEST_LENGTH && end_radius > SHORTEST_LENGTH) {
            return Err(ToolpathError::ArcRadius {
                radius: start_radius.min(end_radius),
            });
        }
        let allowed = ARC_RADIUS_MISMATCH
            .max(ARC_RADIUS_MISMATCH_SHARE * start_radius.max(end_radius))
            .min(ARC_RADIUS_MISMATCH_MOST)
            .min(start_radius.min(end_radius));
        if (start_radius - end_radius).abs() > allowed {
            return Err(ToolpathError::ArcMismatch {
                start_radius,
                end_radius,
                allowed,
            });
        }
        let span = (to[0] - from[0]).hypot(to[1] - from[1]);
        let turn = (from[0] * to[1] - from[1] * to[0]).atan2(from[0] * to[0] + from[1] * to[1]);
        let full = core::f64::consts::TAU;
        let once = if span <= SHORTEST_LENGTH {
            full
        } else if counter_clockwise {
            if turn > 0.0 { turn } else { turn + full }
        } else if turn < 0.0 {
            -turn
        } else {
            full - turn
        };
        let angle = once + full * f64::from(extra_turns);
        let mut radial = Vector::zeros();
        radial[first] = from[0] / start_radius;
        radial[second] = from[1] / start_radius;
        let mut lateral = Vector::zeros();
        lateral[first] = -radial[second];
        lateral[second] = radial[first];
        let mut center = center;
        let mut lift = end - start;
        for axis in 0..N {
            if axis == first || axis == second {
                lift[axis] = 0.0;
            } else {
                center[axis] = start[axis];
            }
        }
        Ok(Self {
            start,
            end,
            center,
            radial,
            lateral,
            start_radius,
            end_radius,
            sweep: if counter_clockwise { angle } else { -angle },
            lift,
        })
    }

    /// Where the arc begins.
    #[must_use]
    pub fn start(&self) -> Vector<N> {
        self.start
    }

    /// Where the arc ends.
    #[must_use]
    pub fn end(&self) -> Vector<N> {
        self.end
    }

    /// Centre of the arc, at the height of its start.
    #[must_use]
    pub fn center(&self) -> Vector<N> {
        self.center
    }

    /// Unit vector from the centre to the start, and the unit vector a right angle further in the
    /// positive sense of the plane.
    #[must_use]
    pub fn frame(&self) -> (Vector<N>, Vector<N>) {
        (self.radial, self.lateral)
    }

    /// Radius at the start and at the end; they differ by the rounding of the program.
    #[must_use]
    pub fn radii(&self) -> (f64, f64) {
        (self.start_radius, self.end_radius)
    }

    /// Largest second derivative of the point after the angle, mm: the larger radius, with what its
    /// change adds. A chord over a small angle lies off the arc by an eighth of this times the square of
    /// the angle at the most.
    #[must_use]
    pub fn bending(&self) -> f64 {
        let growth = (self.end_radius - self.start_radius).abs() / self.sweep.abs();
        self.start_radius.max(self.end_radius) + 2.0 * growth
    }

    /// Signed angle of the whole turn, rad: positive from the first axis of the plane to the
    /// second, more than a full turn where whole circles were added.
    #[must_use]
    pub fn sweep(&self) -> f64 {
        self.sweep
    }

    /// How far the axes outside the plane advance over the whole arc.
    #[must_use]
    pub fn lift(&self) -> Vector<N> {
        self.lift
    }

    /// Point at a share of the sweep between 0 and 1; the ends are exact.
    #[must_use]
    pub fn point(&self, share: f64) -> Vector<N> {
        if share <= 0.0 {
            return self.start;
        }
        if share >= 1.0 {
            return self.end;
        }
        let (sine, cosine) = (share * self.sweep).sin_cos();
        let radius = self.start_radius + share * (self.end_radius - self.start_radius);
        self.center + (self.radial * cosine + self.lateral * sine) * radius + self.lift * share
    }

    /// Unit tangent at a share of the sweep, in the sense of the motion.
    #[must_use]
    pub fn tangent(&self, share: f64) -> Vector<N> {
        let share = share.clamp(0.0, 1.0);
        let (sine, cosine) = (share * self.sweep).sin_cos();
        let growth = self.end_radius - self.start_radius;
        let radius = self.start_radius + share * growth;
        let outward = self.radial * cosine + self.lateral * sine;
        let along = self.lateral * cosine - self.radial * sine;
        (along * (radius * self.sweep) + outward * growth + self.lift).normalize()
    }

    /// Length of the arc; where the radii differ, that of the helix of mean radius.
    #[must_use]
    pub fn length(&self) -> f64 {
        let turn = 0.5 * (self.start_radius + self.end_radius) * self.sweep;
        turn.hypot(self.lift.norm())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{FRAC_PI_2, PI, TAU};

    fn flat(start: [f64; 2], end: [f64; 2], ccw: bool) -> Arc<2> {
        Arc::about(start.into(), end.into(), Vector::zeros(), [0, 1], ccw, 0).unwrap()
    }

    #[test]
    fn clockwise_takes_the_other_way_round() {
        assert!(
            (flat([1.0, 0.0], [0.0, 1.0], true).sweep() - FRAC_PI_2).abs() < 1e-14,
            "ccw"
        );
        assert!(
            (flat([1.0, 0.0], [0.0, 1.0], false).sweep() + 1.5 * PI).abs() < 1e-14,
            "cw"
        );
    }

    #[test]
    fn coinciding_ends_make_a_full_circle() {
        assert!(
            (flat([2.0, 0.0], [2.0, 0.0], true).sweep() - TAU).abs() < 1e-14,
            "ccw"
        );
        assert!(
            (flat([2.0, 0.0], [2.0, 0.0], false).sweep() + TAU).abs() < 1e-14,
            "cw"
        );
    }

    #[test]
    fn the_ends_are_exact_and_the_tangent_is_the_derivative() {
        let helix = Arc::about(
            Vector::<3>::new(3.0, 1.0, 0.0),
            Vector::<3>::new(1.0, 3.004, 2.0),
            Vector::<3>::new(1.0, 1.0, 9.0),
            [0, 1],
            true,
            2,
        )
        .unwrap();
        assert_eq!(helix.point(0.0), helix.start(), "start");
        assert_eq!(helix.point(1.0), helix.end(), "end");
        assert!(
            (helix.point(1.0 - 1e-12) - helix.end()).norm() < 1e-9,
            "end is continuous"
        );
        let step = 1e-6;
        let chord = (helix.point(0.3 + step) - helix.point(0.3 - step)).normalize();
        assert!((chord - helix.tangent(0.3)).norm() < 1e-8, "tangent");
    }

    #[test]
    fn a_centre_off_by_more_than_rounding_is_refused() {
        let refused = Arc::about(
            Vector::<2>::new(10.0, 0.0),
            Vector::<2>::new(0.0, 12.0),
            Vector::zeros(),
            [0, 1],
            true,
            0,
        );
        assert!(
            matches!(refused, Err(ToolpathError::ArcMismatch { .. })),
            "{refused:?}"
        );
    }
}
