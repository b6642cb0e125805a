//! Keeps the variables of macro B, and tells those that the control itself has.
//!
//! Source: the chapter on custom macros of the operator's manuals of FANUC and Haas. Lengths are in the units
//! of the program where it sees them, and in mm where they are kept. Not here: variables that nobody knows
//! before the machine runs, which are refused by name.

use crate::error::arithmetic::ArithmeticError;
use crate::fanuc::functions::number;
use crate::fanuc::value::{NULL, Variables};
use crate::interpreter::Interpreter;
use crate::interpreter::offsets::{SYSTEMS, origin};
use std::collections::BTreeMap;
use toolglide_kinematics::Vector;

/// Local variables are `#1` to this.
pub(crate) const LOCALS: usize = 33;

/// The local variables of one level; the first one is not used.
pub(crate) type Locals = [f64; LOCALS + 1];

/// No local variable has a value.
pub(crate) const UNSET: Locals = [NULL; LOCALS + 1];

/// Additional work offsets, from 1.
pub(crate) const EXTENDED: u32 = 300;

/// Additional work offsets that have variables from `#7001` on.
const OLD_EXTENDED: u32 = 48;

/// Variables between the offsets of one system and the next.
const STEP: u32 = 20;

/// Groups of modal codes, by the numbers of their variables.
const GROUPS: usize = 31;

/// Letters whose last values variables from `#4101` on tell.
const ADDRESSES: [(u32, u8); 10] = [
    (2, b'B'),
    (7, b'D'),
    (8, b'E'),
    (9, b'F'),
    (11, b'H'),
    (13, b'M'),
    (14, b'N'),
    (15, b'O'),
    (19, b'S'),
    (20, b'T'),
];

/// What stands in a variable that a program writes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Written {
    Done,
    /// `#3000`: the program ends here.
    Alarm,
    /// `#3006`: the program waits.
    Stop,
    /// Of no effect on the motion.
    Noted(&'static str),
}

/// Variables, and what is modal.
#[derive(Debug)]
pub(crate) struct Memory {
    /// One for the main program and one for each macro that runs.
    pub(crate) locals: Vec<Locals>,
    common: BTreeMap<u32, f64>,
    /// Codes in force, by their groups.
    pub(crate) groups: [f64; GROUPS],
    /// Last values of letters.
    pub(crate) letters: [f64; 26],
    /// Additional work offsets, mm.
    pub(crate) extended: BTreeMap<u32, [f64; 3]>,
    /// The additional work offset in force, 0 where none is.
    pub(crate) in_force: u32,
}

/// Variables as an expression sees them.
pub(crate) struct Scope<'a> {
    pub(crate) memory: &'a Memory,
    pub(crate) state: &'a Interpreter,
}

/// A system of coordinates with an axis, as a variable names it.
enum Origin {
    Common(usize),
    System(u8, usize),
    Extended(u32, usize),
    /// An axis beyond X, Y and Z.
    Other,
}

impl Memory {
    pub(crate) fn new() -> Self {
        let mut groups = [NULL; GROUPS];
        for (group, code) in [
            (1, 0.0),
            (2, 17.0),
            (3, 90.0),
            (5, 94.0),
            (6, 21.0),
            (7, 40.0),
            (8, 49.0),
            (9, 80.0),
            (10, 98.0),
            (11, 50.0),
            (12, 67.0),
            (13, 97.0),
            (14, 54.0),
            (15, 64.0),
            (16, 69.0),
            (17, 15.0),
            (22, 50.1),
        ] {
            groups[group] = code;
        }
        Self {
            locals: vec![UNSET],
            common: BTreeMap::new(),
            groups,
            letters: [0.0; 26],
            extended: BTreeMap::new(),
            in_force: 0,
        }
    }

    /// The last value of a letter in upper case.
    pub(crate) fn letter(&self, letter: u8) -> f64 {
        self.letters[usize::from(letter.saturating_sub(b'A')).min(25)]
    }

    pub(crate) fn set_letter(&mut self, letter: u8, value: f64) {
        self.letters[usize::from(letter.saturating_sub(b'A')).min(25)] = value;
    }

    /// Writes a variable on behalf of the program.
    pub(crate) fn set(
        &mut self,
        variable: u32,
        value: f64,
        state: &mut Interpreter,
    ) -> Result<Written, ArithmeticError> {
        let kept = own(variable);
        match variable {
            1..=33 => {
                if let Some(locals) = self.locals.last_mut() {
                    locals[variable as usize] = value;
                }
                return Ok(Written::Done);
            }
            _ if is_common(kept) => {
                self.common.insert(kept, value);
                return Ok(Written::Done);
            }
            1100..=1199 | 12000..=12999 => return Ok(Written::Noted("an output of the machine")),
            3000 => return Ok(Written::Alarm),
            3001 | 3002 => return Ok(Written::Noted("a clock of the control")),
            3003..=3005 | 3030 | 3032 | 3033 | 3901 | 3902 => {
                self.common.insert(variable, value);
                return Ok(Written::Noted("how the control runs or counts"));
            }
            3006 => return Ok(Written::Stop),
            _ => {}
        }
        let Some(place) = origin_of(variable) else {
            return Err(ArithmeticError::NotWritable { number: variable });
        };
        let length = state.modal.units.length(number(value));
        if length.abs() > crate::interpreter::units::FARTHEST {
            return Err(ArithmeticError::Overflow {
                function: "a work offset",
            });
        }
        match place {
            Origin::Common(axis) => {
                let mut common = state.offsets.common();
                common[axis] = length;
                state.set_common(common);
            }
            Origin::System(system, axis) => {
                state.parameters.put(
                    origin(system) + crate::interpreter::offsets::axis_number(axis),
                    length,
                );
                state.take_again(system);
            }
            Origin::Extended(index, axis) => {
                self.extended.entry(index).or_default()[axis] = length;
                if self.in_force == index {
                    self.select_extended(index, state);
                }
            }
            Origin::Other if length == 0.0 => {}
            Origin::Other => return Err(ArithmeticError::NotWritable { number: variable }),
        }
        Ok(Written::Done)
    }

    /// Selects an additional work offset.
    pub(crate) fn select_extended(&mut self, index: u32, state: &mut Interpreter) {
        self.in_force = index;
        let origin = self.extended.get(&index).copied().unwrap_or_default();
        state.offsets.take_origin(Vector::from(origin));
        state.program = state.offsets.in_program(state.position);
    }
}

/// The variable behind another name of it on Haas.
fn own(variable: u32) -> u32 {
    match variable {
        10_100..=10_199 | 10_500..=10_999 => variable - 10_000,
        _ => variable,
    }
}

/// Variables that a program has for itself.
fn is_common(variable: u32) -> bool {
    matches!(variable, 100..=999 | 10_000..=10_999 | 98_000..=98_999)
}

/// The origin that a variable holds.
fn origin_of(variable: u32) -> Option<Origin> {
    let place = |first: u32| (variable - first, ((variable - first) % STEP) as usize);
    let (found, axis) = match variable {
        5201..=5206 => {
            let axis = place(5201).1;
            (Origin::Common(axis), axis)
        }
        5221..=5326 => {
            let (behind, axis) = place(5221);
            let system = u8::try_from(behind / STEP).unwrap_or(0) + 1;
            (Origin::System(system.min(SYSTEMS), axis), axis)
        }
        7001.. if variable < 7001 + STEP * OLD_EXTENDED => {
            let (behind, axis) = place(7001);
            (Origin::Extended(behind / STEP + 1, axis), axis)
        }
        14_001.. if variable < 14_001 + STEP * EXTENDED => {
            let (behind, axis) = place(14_001);
            (Origin::Extended(behind / STEP + 1, axis), axis)
        }
        _ => return None,
    };
    match axis {
        0..=2 => Some(found),
        3..=5 => Some(Origin::Other),
        _ => None,
    }
}

/// Why a variable of the control has no value here.
fn unknown(variable: u32) -> &'static str {
    match variable {
        34..=99 => "there is no such variable",
        1000..=1199 | 12_000..=12_999 => "inputs and outputs of the machine",
        2000..=2999 | 11_000..=11_999 | 13_000..=13_999 => "tool offsets of the control",
        10_000..=10_999 => "a variable that this program has not set",
        3001 | 3002 => "clocks of the control",
        3011 | 3012 => "date and time",
        3901 | 3902 => "parts that the machine has counted",
        5061..=5080 => "where a probe has touched",
        5101..=5120 => "how far the axes lag",
        _ => "a variable of the control",
    }
}

impl Variables for Scope<'_> {
    fn value(&self, variable: u32) -> Result<f64, ArithmeticError> {
        let (memory, state) = (self.memory, self.state);
        let units = state.modal.units;
        let kept = own(variable);
        let axis = |first: u32| (variable - first) as usize;
        let refused = || {
            let name = format!("#{variable}").into();
            let what = unknown(variable);
            Err(ArithmeticError::NotKnown { name, what })
        };
        let length = |point: Vector<3>, axis: usize| match axis {
            0..=2 => units.written(point[axis]),
            _ => state.others.at.get(axis - 3).copied().unwrap_or(0.0),
        };
        Ok(match variable {
            0 => NULL,
            1..=33 => memory
                .locals
                .last()
                .map_or(NULL, |level| level[variable as usize]),
            _ if is_common(kept) && kept < 1000 => {
                memory.common.get(&kept).copied().unwrap_or(NULL)
            }
            _ if is_common(kept) => match memory.common.get(&kept) {
                Some(value) => *value,
                None => return refused(),
            },
            3003..=3005 | 3030 | 3032 | 3033 => {
                memory.common.get(&variable).copied().unwrap_or(0.0)
            }
            4001..=4030 | 4201..=4230 | 4401..=4430 => {
                match memory.groups[(variable % 200) as usize] {
                    unset if unset.is_nan() => return refused(),
                    code => code,
                }
            }
            4130 | 4330 | 4530 => f64::from(memory.in_force),
            4101..=4120 | 4301..=4320 | 4501..=4520 => {
                let found = ADDRESSES.iter().find(|one| one.0 == variable % 200 - 100);
                match found {
                    Some((_, letter)) => memory.letter(*letter),
                    None => return refused(),
                }
            }
            5001..=5006 => length(state.program, axis(5001)),
            5021..=5026 => length(state.position, axis(5021)),
            5041..=5046 => length(state.program + state.offsets.tool(), axis(5041)),
            5081..=5083 => units.written(state.offsets.tool()[axis(5081)]),
            _ => match origin_of(variable) {
                Some(Origin::Common(axis)) => units.written(state.offsets.common()[axis]),
                Some(Origin::System(system, axis)) => {
                    let place = origin(system) + crate::interpreter::offsets::axis_number(axis);
                    units.written(state.parameters.get(place))
                }
                Some(Origin::Extended(index, axis)) => {
                    let known = memory.extended.get(&index);
                    units.written(known.map_or(0.0, |origin| origin[axis]))
                }
                Some(Origin::Other) => 0.0,
                None => return refused(),
            },
        })
    }
}
