//! Maps the state of the reader to parameters, both ways.
//!
//! Source: the numbered and the predefined named parameters of LinuxCNC, lengths in the units of the
//! program. Not here: parameters that a program makes up.

use crate::block::codes::{Distance, FeedMode, Plane};
use crate::error::Fault;
use crate::error::arithmetic::ArithmeticError;
use crate::expression::parameters::{LARGEST_PARAMETER, Values};
use crate::expression::{Evaluator, LONGEST_NAME, Parameter};
use crate::interpreter::Interpreter;
use crate::interpreter::secondary_axes::ROTARY;
use crate::interpreter::units::Units;
use crate::text::lexer::Assignment;
use toolglide_kinematics::Vector;

/// Parameters of the tool in the spindle: its number, its offset in force from X, its diameter.
const TOOL: u32 = 5400;
const TOOL_OFFSET: u32 = 5401;
const DIAMETER: u32 = 5410;

/// First parameter of the position in the program.
const POSITION: u32 = 5420;
const POSITION_OF_OTHERS: u32 = 5423;

impl Values for Interpreter {
    fn numbered(&self, number: u32) -> f64 {
        let units = self.modal.units;
        match number {
            TOOL => f64::from(self.loaded),
            TOOL_OFFSET..=5403 => {
                units.written(self.offsets.tool()[(number - TOOL_OFFSET) as usize])
            }
            DIAMETER => {
                let tool = self.tools.get(self.loaded);
                units.written(tool.map_or(0.0, |tool| tool.diameter))
            }
            POSITION..=5422 => units.written(self.program[(number - POSITION) as usize]),
            POSITION_OF_OTHERS..=5428 => {
                let axis = (number - POSITION_OF_OTHERS) as usize;
                let place = self.others.in_program(axis);
                if axis < ROTARY {
                    place
                } else {
                    units.written(place)
                }
            }
            _ => self.parameters.get(number),
        }
    }

    fn named(&self, name: &str) -> Option<f64> {
        self.parameters
            .get_named(name)
            .or_else(|| self.predefined(name))
    }
}

impl Interpreter {
    /// A predefined parameter.
    fn predefined(&self, name: &str) -> Option<f64> {
        let modal = &self.modal;
        let units = modal.units;
        let truth = |holds: bool| f64::from(u8::from(holds));
        Some(match name {
            "_x" => units.written(self.program[0]),
            "_y" => units.written(self.program[1]),
            "_z" => units.written(self.program[2]),
            "_a" => self.others.in_program(0),
            "_b" => self.others.in_program(1),
            "_c" => self.others.in_program(2),
            "_u" => units.written(self.others.in_program(3)),
            "_v" => units.written(self.others.in_program(4)),
            "_w" => units.written(self.others.in_program(5)),
            "_abs_a" => self.others.at[0],
            "_abs_b" => self.others.at[1],
            "_abs_c" => self.others.at[2],
            "_abs_x" => units.written(self.position[0]),
            "_abs_y" => units.written(self.position[1]),
            "_abs_z" => units.written(self.position[2]),
            "_tool_offset" => truth(self.offsets.tool() != Vector::<3>::zeros()),
            "_feed" => units.written(modal.feedrate.unwrap_or(0.0)) * 60.0,
            "_rpm" => modal.spindle_speed,
            "_line" => f64::from(self.line),
            "_motion_mode" => f64::from(modal.motion.code().tenths().unwrap_or(0)),
            "_plane" => match modal.plane {
                Plane::Xy => 170.0,
                Plane::Zx => 180.0,
                Plane::Yz => 190.0,
            },
            "_metric" => truth(units == Units::Millimeter),
            "_imperial" => truth(units == Units::Inch),
            "_absolute" => truth(modal.distance == Distance::Absolute),
            "_incremental" => truth(modal.distance == Distance::Incremental),
            "_inverse_time" => truth(modal.feed_mode == FeedMode::InverseTime),
            "_units_per_minute" => truth(modal.feed_mode == FeedMode::PerMinute),
            "_units_per_rev" => 0.0,
            "_coord_system" => {
                let system = self.offsets.system();
                f64::from(if system <= 6 {
                    530 + 10 * u16::from(system)
                } else {
                    590 + u16::from(system) - 6
                })
            }
            "_current_tool" => f64::from(self.loaded),
            "_selected_tool" => f64::from(modal.tool),
            "_return_mode" | "_retract_old_z" => truth(modal.return_to_start),
            "_retract_r_plane" => truth(!modal.return_to_start),
            "_ccomp" => match &self.compensation {
                None => 400.0,
                Some(compensation) => compensation.code(),
            },
            "_call_level" => f64::from(u32::try_from(self.saved.len() - 1).unwrap_or(0)),
            "_task" => 0.0,
            "_value" | "_value_returned" => 0.0,
            _ => return None,
        })
    }

    /// Gives a parameter its value.
    pub(crate) fn set_parameter(&mut self, assignment: &Assignment) -> Result<(), Fault> {
        let value = assignment.value;
        let outcome = match &assignment.parameter {
            Parameter::Numbered(number) => {
                // Offsets count from when their system is selected, as for LinuxCNC.
                self.parameters.set(*number, value)
            }
            Parameter::Named(name) if self.predefined(name).is_some() => {
                let name = name.clone();
                Err(ArithmeticError::Predefined { name })
            }
            Parameter::Named(name) => self.parameters.set_named(name, value),
        };
        outcome.map_err(|reason| Fault::new(assignment.span, reason.into()))
    }

    /// Gives a parameter the value that somebody else than the program has for it.
    pub(crate) fn give_parameter(&mut self, name: &str, value: f64) -> Result<(), ArithmeticError> {
        let bare = name.trim();
        let bare = bare.strip_prefix('#').unwrap_or(bare).trim();
        if let Ok(number) = bare.parse::<u32>() {
            let most = LARGEST_PARAMETER;
            if !(1..=most).contains(&number) {
                let value = f64::from(number);
                return Err(ArithmeticError::NoSuchParameter { value, most });
            }
            return self.parameters.set(number, value);
        }
        let inside = bare
            .strip_prefix('<')
            .and_then(|rest| rest.strip_suffix('>'));
        let text = format!("<{}>", inside.unwrap_or(bare));
        let mut evaluator = Evaluator::new(text.as_bytes(), 0, &self.parameters);
        let named = evaluator.name().ok();
        let Some(name) = named.filter(|_| evaluator.at == text.len()) else {
            let most = LONGEST_NAME;
            return Err(ArithmeticError::BadName { most });
        };
        if self.predefined(&name).is_some() {
            return Err(ArithmeticError::Predefined { name });
        }
        self.parameters.set_named(&name, value)
    }

    /// What a subroutine gives back.
    pub(crate) fn return_value(&mut self, value: Option<f64>) {
        let returned = f64::from(u8::from(value.is_some()));
        for (name, value) in [
            ("_value", value.unwrap_or(0.0)),
            ("_value_returned", returned),
        ] {
            // There is always room for these two once a program has few names; with very many the
            // value stays 0.
            let _ = self.parameters.set_named(name, value);
        }
    }
}
