//! Places the coordinates of the program on the machine.
//!
//! Source: RS274/NGC and the manual of LinuxCNC: a point of the program is shifted by `G92`, turned by
//! the rotation of its coordinate system, and moved by the origin of the system and by the tool.
//! Not here: who sets them.

use crate::expression::parameters::Parameters;
use crate::interpreter::frame::Frame;
use toolglide_kinematics::Vector;

/// Coordinate systems, `G54` to `G59.3`.
pub(crate) const SYSTEMS: u8 = 9;

/// Parameter that is 1 while `G92` holds, and the first one of its offsets.
pub(crate) const SHIFTED: u32 = 5210;
pub(crate) const SHIFT: u32 = 5211;

/// First parameter of the origin of a coordinate system from 1, and how much further the next is.
const ORIGIN: u32 = 5201;
const ORIGIN_STEP: u32 = 20;

/// Where the rotation of a system stands after its origin.
const ROTATION: u32 = 9;

/// Offsets in force, mm and degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Offsets {
    origin: Vector<3>,
    shift: Vector<3>,
    tool: Vector<3>,
    /// Offset of all coordinate systems.
    common: Vector<3>,
    frame: Frame,
    /// The coordinate system in force, from 1. Its parameters count from when it is selected.
    system: u8,
    rotation: f64,
    sine: f64,
    cosine: f64,
    /// Whether all of them are zero, so that points need no arithmetic.
    none: bool,
}

impl Offsets {
    pub(crate) fn new() -> Self {
        Self {
            origin: Vector::zeros(),
            shift: Vector::zeros(),
            tool: Vector::zeros(),
            common: Vector::zeros(),
            frame: Frame::NONE,
            system: 1,
            rotation: 0.0,
            sine: 0.0,
            cosine: 1.0,
            none: true,
        }
    }

    /// A point of the program on the machine.
    pub(crate) fn on_machine(&self, point: Vector<3>) -> Vector<3> {
        if self.none {
            return point;
        }
        let turned = self.turned(self.frame.out(point) + self.shift, self.sine);
        turned + self.origin + self.common + self.tool
    }

    /// A point of the machine in the program.
    pub(crate) fn in_program(&self, point: Vector<3>) -> Vector<3> {
        if self.none {
            return point;
        }
        let turned = self.turned(point - self.tool - self.common - self.origin, -self.sine);
        self.frame.back(turned - self.shift)
    }

    fn turned(&self, point: Vector<3>, sine: f64) -> Vector<3> {
        if self.rotation.abs() <= 0.0 {
            return point;
        }
        Vector::<3>::new(
            point[0] * self.cosine - point[1] * sine,
            point[0] * sine + point[1] * self.cosine,
            point[2],
        )
    }

    /// Rotation of the coordinate system, degrees.
    pub(crate) fn rotation(&self) -> f64 {
        self.rotation
    }

    pub(crate) fn frame(&self) -> Frame {
        self.frame
    }

    pub(crate) fn set_frame(&mut self, frame: Frame) {
        self.frame = frame;
        self.look();
    }

    /// The offset of all coordinate systems.
    pub(crate) fn common(&self) -> Vector<3> {
        self.common
    }

    pub(crate) fn set_common(&mut self, common: Vector<3>) {
        self.common = common;
        self.look();
    }

    /// Takes an origin that belongs to none of the numbered systems, mm.
    pub(crate) fn take_origin(&mut self, origin: Vector<3>) {
        self.system = 0;
        self.set_origin(origin, 0.0);
    }

    pub(crate) fn tool(&self) -> Vector<3> {
        self.tool
    }

    pub(crate) fn set_tool(&mut self, tool: Vector<3>) {
        self.tool = tool;
        self.look();
    }

    pub(crate) fn shift(&self) -> Vector<3> {
        self.shift
    }

    /// Shifts the program, and stores it in the parameters.
    pub(crate) fn set_shift(&mut self, shift: Vector<3>, parameters: &mut Parameters) {
        self.shift = shift;
        parameters.put(SHIFTED, 1.0);
        for (axis, number) in (SHIFT..).take(3).enumerate() {
            parameters.put(number, shift[axis]);
        }
        self.look();
    }

    /// The same offsets in another coordinate system, without shift and tool.
    pub(crate) fn bare(mut self, system: u8, parameters: &Parameters) -> Self {
        self.shift = Vector::zeros();
        self.tool = Vector::zeros();
        self.take_system(system, parameters);
        self
    }

    /// Ends the shift; its parameters are kept or cleared.
    pub(crate) fn end_shift(&mut self, clear: bool, parameters: &mut Parameters) {
        if clear {
            self.set_shift(Vector::zeros(), parameters);
        }
        parameters.put(SHIFTED, 0.0);
        self.shift = Vector::zeros();
        self.look();
    }

    /// Shifts by what the parameters say.
    pub(crate) fn restore_shift(&mut self, parameters: &mut Parameters) {
        let shift = Vector::from_fn(|axis, _| parameters.get(SHIFT + axis_number(axis)));
        self.set_shift(shift, parameters);
    }

    /// The coordinate system in force, from 1.
    pub(crate) fn system(&self) -> u8 {
        self.system
    }

    /// Takes a coordinate system from its parameters.
    pub(crate) fn take_system(&mut self, system: u8, parameters: &Parameters) {
        self.system = system;
        let first = origin(system);
        let origin = Vector::from_fn(|axis, _| parameters.get(first + axis_number(axis)));
        self.set_origin(origin, parameters.get(first + ROTATION));
    }

    /// Sets origin, mm, and rotation, degrees, of the coordinate system.
    pub(crate) fn set_origin(&mut self, origin: Vector<3>, rotation: f64) {
        self.origin = origin;
        self.rotation = rotation;
        (self.sine, self.cosine) = rotation.to_radians().sin_cos();
        self.look();
    }

    fn look(&mut self) {
        let zero = Vector::<3>::zeros();
        self.none = self.rotation.abs() <= 0.0
            && self.frame == Frame::NONE
            && self.origin == zero
            && self.shift == zero
            && self.common == zero
            && self.tool == zero;
    }
}

/// First parameter of the origin of a system.
pub(crate) fn origin(system: u8) -> u32 {
    ORIGIN + ORIGIN_STEP * u32::from(system)
}

/// Parameter of the rotation of a system.
pub(crate) fn rotation(system: u8) -> u32 {
    origin(system) + ROTATION
}

/// Axes are three.
pub(crate) fn axis_number(axis: usize) -> u32 {
    u32::try_from(axis).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_shifted_turned_and_moved_and_comes_back() {
        let mut parameters = Parameters::new();
        for (number, value) in [(5221, 10.0), (5222, 5.0), (5230, 90.0)] {
            parameters.put(number, value);
        }
        let mut offsets = Offsets::new();
        offsets.take_system(1, &parameters);
        offsets.set_shift(Vector::<3>::new(1.0, 0.0, 0.0), &mut parameters);
        offsets.set_tool(Vector::<3>::new(0.0, 0.0, 7.0));
        let point = Vector::<3>::new(2.0, 0.0, 1.0);
        let there = offsets.on_machine(point);
        let expected = Vector::<3>::new(10.0, 8.0, 8.0);
        assert!((there - expected).norm() < 1e-12, "{there}");
        assert!((offsets.in_program(there) - point).norm() < 1e-12, "back");
        assert!((parameters.get(5211) - 1.0).abs() < 1e-12, "stored");
    }
}
