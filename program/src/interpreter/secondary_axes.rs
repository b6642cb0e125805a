//! Reads words of the axes beside X, Y and Z: rotary axes A, B, C and secondary axes U, V, W.
//!
//! Source: RS274/NGC and LinuxCNC: they have places in every coordinate system and in the shift of `G92`, in the
//! parameters behind those of X, Y and Z. Rotations and tools leave them alone. Not here: X, Y and Z.

use crate::block::code::Code;
use crate::block::codes::{Distance, Group, Once, Way};
use crate::block::{AXES, Block};
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::interpreter::Interpreter;
use crate::interpreter::offsets::{SHIFT, SHIFTED, origin};
use crate::interpreter::units::within_reach;

/// Their letters, in the order of their parameters.
pub(crate) const OTHERS: [u8; 6] = *b"ABCUVW";

/// How many of them are rotary.
pub(crate) const ROTARY: usize = 3;

/// Where the parameters of the others stand behind that of X.
const FIRST: u32 = 3;

/// Largest angle of a rotary axis or of polar coordinates, degrees: as far beyond use as it is far
/// within what a float of 64 bits resolves.
pub(crate) const LARGEST_ANGLE: f64 = 1e9;

/// A whole turn, degrees.
const TURN: f64 = 360.0;

/// Places nearer than this are one, degrees and mm.
const SAME_PLACE: f64 = 1e-9;

/// Places of these axes, degrees and mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Others {
    /// On the machine.
    pub(crate) at: [f64; 6],
    /// Of the origin of the coordinate system in force.
    origin: [f64; 6],
    /// Of the shift in force.
    shift: [f64; 6],
}

impl Others {
    /// Where the zero of the program is on the machine.
    pub(crate) fn zero(&self, axis: usize) -> f64 {
        self.origin[axis] + self.shift[axis]
    }

    /// Where an axis is in the program.
    pub(crate) fn in_program(&self, axis: usize) -> f64 {
        self.at[axis] - self.zero(axis)
    }
}

/// Parameters of the others behind that of an X.
fn parameters(first: u32) -> impl Iterator<Item = u32> {
    (first + FIRST..).take(OTHERS.len())
}

impl Interpreter {
    /// The number of a word in degrees or mm.
    fn other(&self, block: &Block, axis: usize) -> Result<Option<f64>, Fault> {
        if axis >= ROTARY {
            return self.length(block, OTHERS[axis]);
        }
        Ok(block.get(OTHERS[axis]))
    }

    /// Where the word of an axis leads on the machine.
    fn other_end(&self, block: &Block, axis: usize) -> Result<Option<f64>, Fault> {
        let Some(value) = self.other(block, axis)? else {
            return Ok(None);
        };
        let letter = OTHERS[axis];
        let others = &self.others;
        let zero = others.zero(axis);
        let here = others.at[axis];
        let bare = block.once == Some(Once::MachineCoordinates);
        let end = match (
            block.way(letter),
            block.distance_of(letter, self.modal.distance),
        ) {
            (Some(Way::Shortest), _) => {
                let ahead = (value + zero - here).rem_euclid(TURN);
                here + if ahead > 0.5 * TURN {
                    ahead - TURN
                } else {
                    ahead
                }
            }
            (Some(Way::Positive), _) => here + (value + zero - here).rem_euclid(TURN),
            (Some(Way::Negative), _) => here - (here - value - zero).rem_euclid(TURN),
            (_, Distance::Incremental) => here + value,
            (_, Distance::Absolute) if bare => value,
            (_, Distance::Absolute) => value + zero,
        };
        let name = char::from(letter);
        if axis >= ROTARY {
            return within_reach(name, end)
                .map(Some)
                .map_err(|reason| Fault::new(block.span(letter), reason));
        }
        if end.abs() > LARGEST_ANGLE {
            let what = "an angle up to 1e9 degrees";
            let reason = MachiningError::Polar { letter: name, what };
            return Err(Fault::new(block.span(letter), reason.into()));
        }
        Ok(Some(end))
    }

    /// Takes the words of these axes.
    pub(crate) fn turn(&mut self, block: &Block) -> Result<(), Fault> {
        for (axis, &letter) in OTHERS.iter().enumerate() {
            let Some(end) = self.other_end(block, axis)? else {
                continue;
            };
            if self.compensation.is_some() {
                let state = "while cutter compensation is on (G40 ends it)";
                return Err(refused_now(block, letter, state));
            }
            self.others.at[axis] = end;
        }
        Ok(())
    }

    /// Refuses words of these axes where nothing uses them.
    pub(crate) fn no_others(block: &Block, state: &'static str) -> Result<(), Fault> {
        match block.first_of(&OTHERS) {
            Some(letter) => Err(refused_now(block, letter, state)),
            None => Ok(()),
        }
    }

    /// Shifts these axes by `G92` or `G52`; whether the block names one.
    pub(crate) fn shift_others(&mut self, block: &Block, once: Once) -> Result<bool, Fault> {
        let mut any = false;
        for (axis, number) in parameters(SHIFT).enumerate() {
            let value = self.other(block, axis)?;
            any |= value.is_some();
            let others = &self.others;
            let shift = match (value, once) {
                (None, _) => others.shift[axis],
                (Some(value), Once::LocalShift) => value,
                (Some(value), _) => others.at[axis] - others.origin[axis] - value,
            };
            self.parameters.put(number, shift);
        }
        Ok(any)
    }

    /// Forgets the stored shift of these axes.
    pub(crate) fn clear_others(&mut self) {
        for number in parameters(SHIFT) {
            self.parameters.put(number, 0.0);
        }
    }

    /// Takes origin and shift in force from their parameters.
    pub(crate) fn place_others(&mut self) {
        let get = |numbers| {
            let mut places = [0.0; OTHERS.len()];
            for (place, number) in places.iter_mut().zip(parameters(numbers)) {
                *place = self.parameters.get(number);
            }
            places
        };
        let shifted = self.parameters.get(SHIFTED) != 0.0;
        let (origin, shift) = (get(origin(self.offsets.system())), get(SHIFT));
        self.others.origin = origin;
        self.others.shift = if shifted { shift } else { Default::default() };
    }

    /// `G10 L2` and `L20`: origins of these axes in a system, as written or by where they are.
    pub(crate) fn set_origins_of_others(
        &mut self,
        block: &Block,
        system: u8,
        by_place: bool,
    ) -> Result<(), Fault> {
        for (axis, number) in parameters(origin(system)).enumerate() {
            if let Some(value) = self.other(block, axis)? {
                let others = &self.others;
                let place = others.at[axis] - others.shift[axis] - value;
                let place = if by_place { place } else { value };
                self.parameters.put(number, place);
            }
        }
        Ok(())
    }

    /// `G28.1` and `G30.1`.
    pub(crate) fn store_others(&mut self, first: u16) {
        for (axis, number) in parameters(u32::from(first)).enumerate() {
            self.parameters.put(number, self.others.at[axis]);
        }
    }

    /// `G28` and `G30`: those that the block names go home, or all where it names no axis. The point on the way
    /// must be home, or where the axis is.
    pub(crate) fn home_others(&mut self, block: &Block, first: u16) -> Result<(), Fault> {
        let all = block.first_of(&AXES).is_none() && block.first_of(&OTHERS).is_none();
        for (axis, number) in parameters(u32::from(first)).enumerate() {
            let home = self.parameters.get(number);
            let letter = OTHERS[axis];
            let named = self.other_end(block, axis)?;
            if let Some(way) = named {
                let near = |place: f64| (way - place).abs() <= SAME_PLACE;
                if !near(home) && !near(self.others.at[axis]) {
                    let state = "by way of a place that is neither home nor where the axis is";
                    let code = block.taker(Group::NonModal).map(|(code, _)| code);
                    let code = code.unwrap_or(Code::letter(letter));
                    let reason = MachiningError::NotNow { code, state };
                    return Err(Fault::new(block.span(letter), reason.into()));
                }
            }
            let there = if axis < ROTARY {
                block.rotary
            } else {
                block.secondary
            };
            if named.is_some() || all && there {
                self.others.at[axis] = home;
            }
        }
        Ok(())
    }
}

fn refused_now(block: &Block, letter: u8, state: &'static str) -> Fault {
    let code = Code::letter(letter);
    let reason: Reason = MachiningError::NotNow { code, state }.into();
    Fault::new(block.span(letter), reason)
}
