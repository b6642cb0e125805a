//! Computes the point that the axis words of a block name, in the coordinates of the program.
//!
//! Source: `G90` `G91`, polar coordinates `@` `^` and `G53` of RS274/NGC and LinuxCNC. Not here:
//! where the point is on the machine.

use crate::block::codes::{Distance, Group, Once, Plane};
use crate::block::{AXES, Block};
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::interpreter::Interpreter;
use crate::interpreter::secondary_axes::LARGEST_ANGLE;
use crate::interpreter::units::within_reach;
use toolglide_kinematics::Vector;

impl Interpreter {
    /// Where the axis words of a block lead.
    pub(crate) fn end(&mut self, block: &Block) -> Result<Vector<3>, Fault> {
        if block.once == Some(Once::MachineCoordinates) {
            self.turn(block)?;
            return self.end_on_machine(block);
        }
        let end = self.straight_end(block)?;
        self.turn(block)?;
        let named = block.has(b'X') && block.has(b'Y') || block.has(b'@') && block.has(b'^');
        self.arrived = named && self.modal.distance == Distance::Absolute;
        Ok(end)
    }

    /// Where the words X, Y and Z of a block lead.
    pub(crate) fn straight_end(&self, block: &Block) -> Result<Vector<3>, Fault> {
        let mut end = self.program;
        if block.first_of(b"@^").is_some() {
            end = self.polar(block, self.program)?;
        }
        for (axis, letter) in AXES.into_iter().enumerate() {
            let Some(value) = block.get(letter) else {
                continue;
            };
            let length = self.modal.units.length(value);
            let coordinate = match block.distance_of(letter, self.modal.distance) {
                Distance::Absolute => length,
                Distance::Incremental => self.program[axis] + length,
            };
            end[axis] = within_reach(char::from(letter), coordinate)
                .map_err(|reason| Fault::new(block.span(letter), reason))?;
        }
        Ok(end)
    }

    /// A point in the coordinates of the machine.
    fn end_on_machine(&self, block: &Block) -> Result<Vector<3>, Fault> {
        let mut there = self.position;
        for (axis, letter) in AXES.into_iter().enumerate() {
            if let Some(value) = block.get(letter) {
                let base = match block.distance_of(letter, Distance::Absolute) {
                    Distance::Absolute => 0.0,
                    Distance::Incremental => there[axis],
                };
                let length = base + self.modal.units.length(value);
                there[axis] = within_reach(char::from(letter), length)
                    .map_err(|reason| Fault::new(block.span(letter), reason))?;
            }
        }
        Ok(self.offsets.in_program(there))
    }

    /// Distance and angle from the origin, degrees; with `G91` both are added to those of `from`.
    pub(crate) fn polar(&self, block: &Block, from: Vector<3>) -> Result<Vector<3>, Fault> {
        let letter = if block.has(b'@') { b'@' } else { b'^' };
        let refuse = |what| {
            let letter = char::from(letter);
            let reason = MachiningError::Polar { letter, what };
            Fault::new(
                block.span(if letter == '@' { b'@' } else { b'^' }),
                reason.into(),
            )
        };
        if self.modal.plane != Plane::Xy {
            return Err(refuse("the plane XY (G17)"));
        }
        if block.first_of(b"XY").is_some() {
            return Err(refuse("to stand without X and Y"));
        }
        let here = [from[0], from[1]];
        let mut distance = here[0].hypot(here[1]);
        let mut angle = here[1].atan2(here[0]).to_degrees();
        let steps = |letter| {
            let mode = block.distance_of(letter, self.modal.distance);
            mode == Distance::Incremental
        };
        if distance == 0.0 && (block.has(b'^') && steps(b'^') || block.has(b'@') && steps(b'@')) {
            return Err(refuse("G90 at the origin, which has no angle"));
        }
        if distance == 0.0 && !(block.has(b'@') && block.has(b'^')) {
            return Err(refuse("both @ and ^ at the origin, which has no angle"));
        }
        if let Some(value) = block.get(b'@') {
            let length = self.modal.units.length(value);
            let sum = if steps(b'@') {
                distance + length
            } else {
                length
            };
            distance =
                within_reach('@', sum).map_err(|reason| Fault::new(block.span(b'@'), reason))?;
        }
        if let Some(value) = block.get(b'^') {
            angle = if steps(b'^') { angle + value } else { value };
            if angle.abs() > LARGEST_ANGLE {
                return Err(refuse("an angle up to 1e9 degrees"));
            }
        }
        let (sine, cosine) = angle.to_radians().sin_cos();
        let mut end = from;
        (end[0], end[1]) = (distance * cosine, distance * sine);
        Ok(end)
    }

    /// A length word in mm, if it stands in the block.
    pub(crate) fn length(&self, block: &Block, letter: u8) -> Result<Option<f64>, Fault> {
        block
            .get(letter)
            .map(|value| {
                self.modal
                    .units
                    .bounded_length(char::from(letter), value)
                    .map_err(|reason| Fault::new(block.span(letter), reason))
            })
            .transpose()
    }

    /// A refusal of the code of a group in the present state.
    pub(crate) fn not_now(block: &Block, group: Group, state: &'static str) -> Option<Fault> {
        block
            .taker(group)
            .map(|(code, span)| Fault::new(span, MachiningError::NotNow { code, state }.into()))
    }
}
