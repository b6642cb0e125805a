//! Sets coordinate systems and tools from a program.
//!
//! Source: `G10` of LinuxCNC. Parameters hold origins in mm. Not here: what offsets do to a point.

use crate::block::code::Code;
use crate::block::{AXES, Block};
use crate::error::Fault;
use crate::error::reason::Reason;
use crate::interpreter::Interpreter;
use crate::interpreter::modal::whole;
use crate::interpreter::non_modal::missing;
use crate::interpreter::offsets::{SYSTEMS, axis_number, origin, rotation};
use crate::interpreter::tool_codes::Measured;
use toolglide_kinematics::Vector;

impl Interpreter {
    /// `G10`.
    pub(crate) fn set_data(&mut self, block: &Block) -> Result<(), Fault> {
        let Some(kind) = whole(block, b'L', "kind of data", 0, 20)? else {
            return Err(missing(block, 'L'));
        };
        match kind {
            // The tool table is the one that was given, and what the program wrote into it.
            0 => Ok(()),
            1 => self.set_tool(block, Measured::Given),
            10 => self.set_tool(block, Measured::Here),
            11 => self.set_tool(block, Measured::OnFixture),
            2 => self.set_system(block),
            20 => self.set_system_by_position(block),
            _ => {
                let reason = Reason::NotSupported {
                    code: Code::new(b'G', 100),
                    what: "data other than tools (L1 L10 L11) and coordinate systems (L2 L20)",
                };
                Err(Fault::new(block.span(b'L'), reason))
            }
        }
    }

    /// The coordinate system that a block names; 0 is the one in force.
    fn named_system(&self, block: &Block) -> Result<u8, Fault> {
        let number = whole(block, b'P', "coordinate system", 0, u32::from(SYSTEMS))?
            .ok_or_else(|| missing(block, 'P'))?;
        Ok(match u8::try_from(number) {
            Ok(0) | Err(_) => self.offsets.system(),
            Ok(number) => number,
        })
    }

    /// `G10 L2`: origin and rotation as written.
    fn set_system(&mut self, block: &Block) -> Result<(), Fault> {
        let number = self.named_system(block)?;
        if let Some(degrees) = block.get(b'R') {
            self.parameters.put(rotation(number), degrees % 360.0);
        }
        for (axis, letter) in AXES.into_iter().enumerate() {
            if let Some(length) = self.length(block, letter)? {
                let place = origin(number) + axis_number(axis);
                self.parameters.put(place, length);
            }
        }
        self.set_origins_of_others(block, number, false)?;
        self.take_again(number);
        Ok(())
    }

    /// `G10 L20`: the origin is where the tool gets the coordinates that are written.
    fn set_system_by_position(&mut self, block: &Block) -> Result<(), Fault> {
        let number = self.named_system(block)?;
        if block.has(b'R') {
            let reason = Reason::Unused { letter: 'R' };
            return Err(Fault::new(block.span(b'R'), reason));
        }
        let mut there = self.offsets;
        there.take_system(number, &self.parameters);
        let mut target = there.in_program(self.position);
        for (axis, letter) in AXES.into_iter().enumerate() {
            target[axis] = self.length(block, letter)?.unwrap_or(target[axis]);
        }
        let degrees = self.parameters.get(rotation(number));
        there.set_origin(Vector::zeros(), degrees);
        let shift = self.position - there.on_machine(target);
        for (axis, letter) in AXES.into_iter().enumerate() {
            // In a turned system both X and Y of the origin follow from either word.
            if block.has(letter) || degrees != 0.0 && axis < 2 {
                let place = origin(number) + axis_number(axis);
                self.parameters.put(place, shift[axis]);
            }
        }
        self.set_origins_of_others(block, number, true)?;
        self.take_again(number);
        Ok(())
    }

    /// A system in force follows its parameters.
    pub(crate) fn take_again(&mut self, number: u8) {
        if number == self.offsets.system() {
            self.offsets.take_system(number, &self.parameters);
        }
    }
}
