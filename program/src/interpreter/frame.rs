//! Shifts and turns a coordinate system as a program asks.
//!
//! Source: programmable frames of Sinumerik: each shift and each turn is in the system that those
//! before it made; mirror, scaling and rotation of FANUC. Not here: the words that ask for them.

use toolglide_kinematics::Vector;

/// Where the points of a program are in the workpiece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    /// Its axes in the workpiece, unit vectors.
    axes: [[f64; 3]; 3],
    /// How much longer a length of the program is along each of its axes; negative where it is mirrored.
    scale: [f64; 3],
    shift: [f64; 3],
}

impl Frame {
    /// The workpiece itself.
    pub(crate) const NONE: Self = Self {
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        scale: [1.0; 3],
        shift: [0.0; 3],
    };

    /// A frame by its origin, and by its X and Y axes, which are upright to each other within rounding.
    pub(crate) fn of(origin: Vector<3>, along: Vector<3>, across: Vector<3>) -> Self {
        let first = along / along.norm();
        let second = across - first * first.dot(&across);
        let second = second / second.norm();
        Self {
            axes: [first.into(), second.into(), first.cross(&second).into()],
            scale: [1.0; 3],
            shift: origin.into(),
        }
    }

    /// A direction of the program in the workpiece.
    pub(crate) fn direction(&self, way: Vector<3>) -> Vector<3> {
        Vector::from_fn(|row, _| {
            let scaled = |axis: usize| self.scale[axis] * way[axis];
            (0..3).map(|axis| self.axes[axis][row] * scaled(axis)).sum()
        })
    }

    /// A point of the program in the workpiece.
    pub(crate) fn out(&self, point: Vector<3>) -> Vector<3> {
        Vector::from_fn(|row, _| {
            let scaled = |axis: usize| self.scale[axis] * point[axis];
            let turned: f64 = (0..3).map(|axis| self.axes[axis][row] * scaled(axis)).sum();
            turned + self.shift[row]
        })
    }

    /// A point of the workpiece in the program.
    pub(crate) fn back(&self, point: Vector<3>) -> Vector<3> {
        let from = point - Vector::<3>::from(self.shift);
        Vector::from_fn(|axis, _| {
            let turned: f64 = (0..3).map(|row| self.axes[axis][row] * from[row]).sum();
            turned / self.scale[axis]
        })
    }

    /// Whether arcs across an axis stay arcs across it: it keeps its direction, or is mirrored, and both
    /// axes of the plane are scaled alike.
    #[allow(
        clippy::float_cmp,
        reason = "the very axes, and the very factors, that were written"
    )]
    pub(crate) fn keeps_arcs_across(&self, normal: usize) -> bool {
        let (first, second) = ((normal + 1) % 3, (normal + 2) % 3);
        let alike = self.scale[first].abs() == self.scale[second].abs();
        self.axes[normal] == Self::NONE.axes[normal] && alike
    }

    /// Whether lengths along two axes are scaled alike.
    #[allow(clippy::float_cmp, reason = "the very factors that were written")]
    pub(crate) fn is_even(&self, [first, second]: [usize; 2]) -> bool {
        self.scale[first].abs() == self.scale[second].abs()
    }

    /// Whether arcs in the plane of two axes change their direction.
    pub(crate) fn mirrors(&self, [first, second]: [usize; 2]) -> bool {
        self.scale[first] * self.scale[second] < 0.0
    }

    /// How much longer a length along an axis becomes.
    pub(crate) fn scale(&self, axis: usize) -> f64 {
        self.scale[axis].abs()
    }

    /// The frame with lengths along its own axes multiplied.
    pub(crate) fn scaled(mut self, factors: [f64; 3]) -> Self {
        self.scale = std::array::from_fn(|axis| self.scale[axis] * factors[axis]);
        self
    }

    /// The frame with its origin at a point of the workpiece, mm.
    pub(crate) fn placed(mut self, at: Vector<3>) -> Self {
        self.shift = at.into();
        self
    }

    /// The frame with its origin in that of the workpiece.
    pub(crate) fn without_shift(mut self) -> Self {
        self.shift = Self::NONE.shift;
        self
    }

    /// The frame moved in its own coordinates, mm.
    pub(crate) fn shifted(mut self, by: Vector<3>) -> Self {
        self.shift = self.out(by).into();
        self
    }

    /// The frame turned about one of its own axes, degrees.
    pub(crate) fn turned(mut self, about: usize, degrees: f64) -> Self {
        let (first, second) = ((about + 1) % 3, (about + 2) % 3);
        // Right angles are exact, so that faces of a box stay parallel to its axes.
        let quarters = degrees / 90.0;
        let (sine, cosine) = if quarters.fract() == 0.0 {
            match quarters.rem_euclid(4.0).round() {
                0.0 => (0.0, 1.0),
                1.0 => (1.0, 0.0),
                2.0 => (0.0, -1.0),
                _ => (-1.0, 0.0),
            }
        } else {
            degrees.to_radians().sin_cos()
        };
        let (one, other) = (self.axes[first], self.axes[second]);
        self.axes[first] = std::array::from_fn(|row| cosine * one[row] + sine * other[row]);
        self.axes[second] = std::array::from_fn(|row| cosine * other[row] - sine * one[row]);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_add_up_in_the_turned_frame_and_points_come_back() {
        let frame = Frame::NONE
            .shifted(Vector::<3>::new(1.0, 2.0, 3.0))
            .turned(0, -90.0)
            .turned(2, 90.0)
            .turned(1, 30.0);
        let point = Vector::<3>::new(0.5, -4.0, 2.0);
        assert!(
            (frame.back(frame.out(point)) - point).norm() < 1e-12,
            "back"
        );
        let quarter = Frame::NONE.turned(0, -90.0).turned(2, 90.0);
        // X goes to the Y of the first frame, which is -Z of the workpiece.
        let out = quarter.out(Vector::<3>::x());
        assert!((out + Vector::<3>::z()).norm() < 1e-12, "{out}");
    }

    #[test]
    fn a_positive_turn_about_y_takes_z_to_x() {
        let out = Frame::NONE.turned(1, 90.0).out(Vector::<3>::z());
        assert!((out - Vector::<3>::x()).norm() < 1e-12, "{out}");
    }
}
