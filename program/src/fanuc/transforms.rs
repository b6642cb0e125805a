//! Maps the points of a program onto the workpiece: mirror, scaling, rotation, local coordinates, in this order.
//!
//! Source: `G51.1`, `G51`, `G68` and `G52` of the operator's manuals of FANUC and Haas. Not here: what a frame
//! does to a move.

use crate::interpreter::frame::Frame;
use toolglide_kinematics::Vector;

/// A rotation about an axis through a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turn {
    pub(crate) about: usize,
    pub(crate) center: Vector<3>,
    pub(crate) degrees: f64,
}

/// What is in force, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Transforms {
    /// Where each axis is mirrored.
    pub(crate) mirror: [Option<f64>; 3],
    /// Centre and factors.
    pub(crate) scaling: Option<(Vector<3>, [f64; 3])>,
    pub(crate) turn: Option<Turn>,
    pub(crate) local: [f64; 3],
}

impl Transforms {
    /// A point behind the mirror.
    pub(crate) fn mirrored(&self, point: Vector<3>) -> Vector<3> {
        Vector::from_fn(|axis, _| match self.mirror[axis] {
            Some(center) => 2.0 * center - point[axis],
            None => point[axis],
        })
    }

    /// A point behind mirror and scaling.
    pub(crate) fn scaled(&self, point: Vector<3>) -> Vector<3> {
        let point = self.mirrored(point);
        match self.scaling {
            Some((center, factors)) => Vector::from_fn(|axis, _| {
                center[axis] + factors[axis] * (point[axis] - center[axis])
            }),
            None => point,
        }
    }

    /// All of them as one frame.
    pub(crate) fn frame(&self) -> Frame {
        let factors = std::array::from_fn(|axis| {
            let sign = if self.mirror[axis].is_some() {
                -1.0
            } else {
                1.0
            };
            sign * self.scaling.map_or(1.0, |(_, factors)| factors[axis])
        });
        let zero = self.scaled(Vector::zeros());
        let (turned, zero) = match self.turn {
            Some(turn) => {
                let turned = Frame::NONE.turned(turn.about, turn.degrees);
                (turned, turned.out(zero - turn.center) + turn.center)
            }
            None => (Frame::NONE, zero),
        };
        turned
            .scaled(factors)
            .placed(zero + Vector::<3>::from(self.local))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_mirrored_then_scaled_then_turned_then_shifted() {
        let transforms = Transforms {
            mirror: [Some(5.0), None, None],
            scaling: Some((Vector::<3>::new(1.0, 0.0, 0.0), [2.0; 3])),
            turn: Some(Turn {
                about: 2,
                center: Vector::<3>::new(0.0, 1.0, 0.0),
                degrees: 90.0,
            }),
            local: [0.0, 0.0, 4.0],
        };
        let frame = transforms.frame();
        let point = Vector::<3>::new(7.0, 2.0, 1.0);
        // 7 is mirrored to 3, scaled about 1 to 5, and y to 4, z to 2; then turned about (0, 1).
        let expected = Vector::<3>::new(-3.0, 6.0, 6.0);
        assert!(
            (frame.out(point) - expected).norm() < 1e-12,
            "{}",
            frame.out(point)
        );
        assert!((frame.back(expected) - point).norm() < 1e-12, "back");
    }
}
