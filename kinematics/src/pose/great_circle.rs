//! Interpolates between two tool orientations along a great circle.
//!
//! Source: section 5.2, equations 5.6 to 5.12, with the angle by an inverse tangent of two arguments
//! instead of an inverse cosine, and the motion as a rotation instead of a weighted sum, so that
//! neither a small angle nor one near 180 degrees loses digits. Not here: time.

use crate::error::ToolpathError;
#[cfg(not(feature = "std"))]
use crate::no_std::*;
use crate::numeric::{OPPOSITE_ANGLE, SAME_ORIENTATION};
use crate::pose::tool_pose::ToolPose;
use crate::vector::Vector;

/// A vector turned about a unit axis by an angle, rad, counterclockwise seen against the axis.
#[must_use]
#[inline]
pub fn turned(vector: &Vector<3>, axis: &Vector<3>, angle: f64) -> Vector<3> {
    let (sine, cosine) = angle.sin_cos();
    vector * cosine + axis.cross(vector) * sine + axis * (axis.dot(vector) * (1.0 - cosine))
}

/// Angle between two vectors, rad, exact near 0 and near 180 degrees.
#[must_use]
#[inline]
pub fn angle_between(one: &Vector<3>, other: &Vector<3>) -> f64 {
    one.cross(other).norm().atan2(one.dot(other))
}

/// The turn from one tool orientation to another about one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GreatCircle {
    start: Vector<3>,
    end: Vector<3>,
    axis: Vector<3>,
    angle: f64,
}

impl GreatCircle {
    /// The shortest turn between the orientations of two poses.
    ///
    /// Orientations nearer than [`SAME_ORIENTATION`] count as one: the angle is 0 and the axis any.
    ///
    /// # Errors
    /// [`ToolpathError::Opposite`] for orientations that point opposite ways within
    /// [`OPPOSITE_ANGLE`], between which every turn is as short.
    ///
    /// # Examples
    /// ```
    /// use toolglide_kinematics::{GreatCircle, ToolPose, Vector};
    /// let up = ToolPose::new(Vector::zeros(), Vector::<3>::z())?;
    /// let side = ToolPose::new(Vector::zeros(), Vector::<3>::x())?;
    /// let turn = GreatCircle::between(&up, &side)?;
    /// assert!((turn.angle() - core::f64::consts::FRAC_PI_2).abs() < 1e-15);
    /// assert_eq!(turn.axis(), Vector::<3>::y());
    /// # Ok::<(), toolglide_kinematics::ToolpathError>(())
    /// ```
    pub fn between(start: &ToolPose, end: &ToolPose) -> Result<Self, ToolpathError> {
        let (start, end) = (start.orientation(), end.orientation());
        let normal = start.cross(&end);
        let sine = normal.norm();
        let angle = sine.atan2(start.dot(&end));
        if core::f64::consts::PI - angle < OPPOSITE_ANGLE {
            return Err(ToolpathError::Opposite { angle });
        }
        let (axis, angle) = if angle < SAME_ORIENTATION {
            (Vector::<3>::z(), 0.0)
        } else {
            (normal / sine, angle)
        };
        Ok(Self {
            start,
            end,
            axis,
            angle,
        })
    }

    /// The turn about an axis that is given because the orientations point opposite ways.
    ///
    /// What `axis` has along the orientation is taken off it.
    ///
    /// # Errors
    /// [`ToolpathError::NotUnit`] when nothing is left of the axis,
    /// [`ToolpathError::NotOpposite`] when the orientations are not opposite.
    pub fn about(
        start: &ToolPose,
        end: &ToolPose,
        axis: &Vector<3>,
    ) -> Result<Self, ToolpathError> {
        let (start, end) = (start.orientation(), end.orientation());
        let angle = angle_between(&start, &end);
        if core::f64::consts::PI - angle >= OPPOSITE_ANGLE {
            return Err(ToolpathError::NotOpposite { angle });
        }
        let across = axis - start * start.dot(axis);
        let length = across.norm();
        if !(length > OPPOSITE_ANGLE && length.is_finite()) {
            return Err(ToolpathError::NotUnit { length });
        }
        Ok(Self {
            start,
            end,
            axis: across / length,
            angle: core::f64::consts::PI,
        })
    }

    /// The turn by an angle of at most half a turn, rad, about any unit axis, from `start` to
    /// `end`, where it is known to lead.
    ///
    /// Where the axis is not across the orientation this is no great circle, but a parallel of the sphere
    /// about its axis: not the shortest way, but one that a machine can turn with one axis. A negative
    /// angle turns the other way.
    #[must_use]
    pub fn along_parallel(start: &ToolPose, end: &ToolPose, axis: &Vector<3>, angle: f64) -> Self {
        Self {
            start: start.orientation(),
            end: end.orientation(),
            axis: axis * 1.0_f64.copysign(angle),
            angle: angle.abs(),
        }
    }

    /// Orientation before the turn, of unit length.
    #[must_use]
    pub fn start(&self) -> Vector<3> {
        self.start
    }

    /// Orientation after the turn, of unit length.
    #[must_use]
    pub fn end(&self) -> Vector<3> {
        self.end
    }

    /// Axis of the turn, of unit length; any where the angle is 0.
    #[must_use]
    pub fn axis(&self) -> Vector<3> {
        self.axis
    }

    /// Angle of the turn, rad, from 0 to 180 degrees.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.angle
    }

    /// The part of the turn from one share of it to a larger one.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        Self {
            start: self.at(from),
            end: self.at(to),
            axis: self.axis,
            angle: self.angle * (to - from),
        }
    }

    /// Orientation after a share of the turn from 0 to 1.
    #[must_use]
    pub fn at(&self, share: f64) -> Vector<3> {
        if share >= 1.0 {
            return self.end;
        }
        turned(&self.start, &self.axis, self.angle * share.max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(orientation: Vector<3>) -> ToolPose {
        ToolPose::new(Vector::zeros(), orientation.normalize()).unwrap()
    }

    #[test]
    fn the_turns_of_table_5_1_are_reproduced() {
        let orientations = [
            Vector::<3>::new(-0.1302, -0.3906, 0.9113),
            Vector::<3>::new(0.4262, 0.0947, 0.8997),
            Vector::<3>::new(-0.1255, 0.3137, 0.9412),
        ]
        .map(pose);
        let one = GreatCircle::between(&orientations[0], &orientations[1]).unwrap();
        let two = GreatCircle::between(&orientations[1], &orientations[2]).unwrap();
        assert!((one.angle() - 0.756_281_506_869).abs() < 1e-11, "{one:?}");
        assert!((two.angle() - 0.604_159_421_332).abs() < 1e-11, "{two:?}");
        let turn = angle_between(&one.axis(), &two.axis());
        assert!((turn - 1.973_833_082_326).abs() < 1e-10, "{turn}");
    }

    #[test]
    fn every_point_of_a_turn_has_unit_length_and_the_last_is_the_end() {
        let turn = GreatCircle::between(
            &pose(Vector::<3>::new(0.3, -0.4, 0.2)),
            &pose(Vector::<3>::new(-0.3, -0.1, 0.9)),
        )
        .unwrap();
        for step in 0..=100 {
            let at = turn.at(f64::from(step) / 100.0);
            assert!((at.norm() - 1.0).abs() < 1e-15, "{step}: {}", at.norm());
        }
        assert_eq!(turn.at(1.0), turn.end(), "exactly");
        let reached = turned(&turn.start(), &turn.axis(), turn.angle());
        assert!((reached - turn.end()).norm() < 1e-15, "{reached}");
    }

    #[test]
    fn parts_of_a_turn_follow_each_other_to_its_end() {
        let (one, other) = (
            pose(Vector::<3>::new(0.3, -0.4, 0.2)),
            pose(Vector::<3>::new(-0.3, -0.1, 0.9)),
        );
        let whole = GreatCircle::between(&one, &other).unwrap();
        let first = whole.part(0.0, 0.3);
        let last = whole.part(0.3, 1.0);
        assert_eq!(first.start(), whole.start(), "start");
        assert_eq!(first.end(), last.start(), "between");
        assert_eq!(last.end(), whole.end(), "end");
        let angle = first.angle() + last.angle();
        assert!((angle - whole.angle()).abs() < 1e-15, "{angle}");
        let middle = last.at(0.5) - whole.at(0.65);
        assert!(middle.norm() < 1e-15, "{middle}");
    }

    #[test]
    fn a_turn_along_a_parallel_keeps_its_latitude() {
        let up = Vector::<3>::z();
        let start = pose(Vector::<3>::new(0.3, 0.0, 0.4));
        for angle in [1.2, -1.2] {
            let end = pose(turned(&start.orientation(), &up, angle));
            let turn = GreatCircle::along_parallel(&start, &end, &up, angle);
            for step in 0..=10 {
                let at = turn.at(0.1 * f64::from(step));
                assert!(
                    (at.z - start.orientation().z).abs() < 1e-15,
                    "{angle}: {at}"
                );
            }
            assert!((turn.at(0.999_999_9) - turn.end()).norm() < 1e-6, "{angle}");
        }
    }

    #[test]
    fn opposite_orientations_need_an_axis() {
        let (up, down) = (pose(Vector::<3>::z()), pose(-Vector::<3>::z()));
        assert!(
            matches!(
                GreatCircle::between(&up, &down),
                Err(ToolpathError::Opposite { .. })
            ),
            "no axis"
        );
        let turn = GreatCircle::about(&up, &down, &Vector::<3>::new(2.0, 0.0, 5.0)).unwrap();
        assert!((turn.axis() - Vector::<3>::x()).norm() < 1e-15, "{turn:?}");
        assert!(
            GreatCircle::about(&up, &down, &Vector::<3>::z()).is_err(),
            "along"
        );
        let side = pose(Vector::<3>::x());
        assert!(
            GreatCircle::about(&up, &side, &Vector::<3>::y()).is_err(),
            "near"
        );
        assert!(
            GreatCircle::between(&up, &up).unwrap().angle() == 0.0,
            "same"
        );
    }
}
