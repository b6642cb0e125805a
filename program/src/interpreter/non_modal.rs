//! Executes codes that hold for one block: shifts, machine coordinates, stored points.
//!
//! Source: `G28` to `G30.1`, `G52` to `G59.3` and `G92` to `G92.3` of RS274/NGC
//! and LinuxCNC, where `G52` writes the offsets of `G92`. Parameters hold offsets in mm. Not
//! here: `G10`, and what offsets do to a point.

use crate::block::codes::{Group, Motion, Once, ToolLength};
use crate::block::{AXES, Block};
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::error::{Fault, Remark};
use crate::expression::parameters::SYSTEM;
use crate::interpreter::Interpreter;
use crate::interpreter::offsets::axis_number;
use crate::interpreter::secondary_axes::OTHERS;
use crate::text::place::Span;
use std::collections::VecDeque;
use toolglide_kinematics::{Feedrate, Move, Vector};

/// Why most set-up has to wait.
pub(crate) const COMPENSATED: &str = "while cutter compensation is on (G40 ends it)";

impl Interpreter {
    /// Refuses what cutter compensation cannot go through.
    pub(crate) fn check_compensated(&self, block: &Block) -> Result<(), Fault> {
        if self.compensation.as_ref().is_some_and(|on| !on.is_ending()) {
            let quiet = |group| Self::not_now(block, group, COMPENSATED);
            let groups = [Group::Plane, Group::ToolLength, Group::Coordinates];
            let plane_stays = block.plane.is_none_or(|plane| plane == self.modal.plane);
            let fault = groups
                .into_iter()
                .filter(|&group| group != Group::Plane || !plane_stays)
                .find_map(quiet);
            let once = block.once.filter(|&once| once != Once::Dwell);
            let once = once.and_then(|_| quiet(Group::NonModal));
            if let Some(fault) = fault.or(once) {
                return Err(fault);
            }
        }
        Ok(())
    }

    /// Tool length, cutter compensation and coordinate system, in the order of execution.
    pub(crate) fn set_up(
        &mut self,
        block: &Block,
        remarks: &mut Vec<Remark>,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        if let Some(side) = block.side {
            self.compensate(block, side, remarks, moves)?;
        }
        if let Some(tip) = block.tool_tip {
            self.tip = tip;
        } else if block.tool_length == Some(ToolLength::Off) {
            self.tip = false;
        }
        if let Some(length) = block.tool_length {
            self.tool_length(block, length, remarks)?;
        }
        if let Some(number) = block.coordinates
            && number != self.offsets.system()
        {
            self.parameters.put(SYSTEM, f64::from(number));
            self.offsets.take_system(number, &self.parameters);
            self.place_others();
            self.program = self.offsets.in_program(self.position);
        }
        Ok(())
    }

    /// Codes that hold for one block.
    pub(crate) fn once(
        &mut self,
        block: &Block,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let Some(once) = block.once else {
            return Ok(());
        };
        match once {
            Once::Dwell => return Ok(()),
            Once::MachineCoordinates => return self.check_machine_coordinates(block),
            Once::SetData => self.set_data(block)?,
            Once::GoHome(first) => return self.go_home(block, first, moves),
            Once::StoreHome(first) => {
                for (axis, number) in (u32::from(first)..).take(3).enumerate() {
                    self.parameters.put(number, self.position[axis]);
                }
                self.store_others(first);
            }
            Once::Shift | Once::LocalShift => {
                let mut shift = self.offsets.shift();
                let mut any = block.has(b'E') || block.absent;
                for (axis, letter) in AXES.into_iter().enumerate() {
                    if let Some(length) = self.length(block, letter)? {
                        shift[axis] = match once {
                            Once::LocalShift => length,
                            _ => shift[axis] + self.program[axis] - length,
                        };
                        any = true;
                    }
                }
                any |= self.shift_others(block, once)?;
                if !any && self.printer.is_some() {
                    // Every axis is at 0 from here.
                    shift += self.program;
                    any = true;
                }
                if !any {
                    return Err(companion(block, Group::NonModal, "an axis word"));
                }
                self.offsets.set_shift(shift, &mut self.parameters);
            }
            Once::ClearShift => {
                self.offsets.end_shift(true, &mut self.parameters);
                self.clear_others();
            }
            Once::SuspendShift => self.offsets.end_shift(false, &mut self.parameters),
            Once::RestoreShift => self.offsets.restore_shift(&mut self.parameters),
        }
        self.place_others();
        self.program = self.offsets.in_program(self.position);
        Ok(())
    }

    fn check_machine_coordinates(&self, block: &Block) -> Result<(), Fault> {
        let motion = block.motion.unwrap_or(self.modal.motion);
        if !matches!(motion, Motion::Rapid | Motion::Line) {
            return Err(companion(block, Group::NonModal, "G0 or G1"));
        }
        if self.modal.distance == crate::block::codes::Distance::Incremental {
            let fault = Self::not_now(block, Group::NonModal, "with incremental distances (G91)");
            return fault.map_or(Ok(()), Err);
        }
        Ok(())
    }

    /// `G28` and `G30`: to a stored point, by way of the point that the block names. With axis
    /// words, only these axes go home.
    fn go_home(
        &mut self,
        block: &Block,
        first: u16,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let span = block
            .taker(Group::NonModal)
            .map_or(Span::default(), |(_, span)| span);
        let home =
            Vector::from_fn(|axis, _| self.parameters.get(u32::from(first) + axis_number(axis)));
        let mut home = home;
        for axis in 0..3 {
            if !self.settings.axes[axis] {
                home[axis] = self.position[axis];
            }
        }
        let home = self.offsets.in_program(home);
        if block.first_of(&AXES).is_none() && block.absent {
            return Ok(());
        }
        self.home_others(block, first)?;
        if block.first_of(&AXES).is_none() {
            let stays = block.first_of(&OTHERS).is_some();
            let end = if stays { self.program } else { home };
            return self.go(end, Feedrate::RAPID, span, moves);
        }
        let mut end = self.straight_end(block)?;
        self.go(end, Feedrate::RAPID, span, moves)?;
        // The axes that are named are those of the program, which may be turned.
        for (axis, letter) in AXES.into_iter().enumerate() {
            if block.has(letter) {
                end[axis] = home[axis];
            }
        }
        self.go(end, Feedrate::RAPID, span, moves)
    }
}

pub(crate) fn companion(block: &Block, group: Group, companion: &'static str) -> Fault {
    let (code, span) = block
        .taker(group)
        .unwrap_or((Motion::Off.code(), Span::default()));
    Fault::new(span, MachiningError::Companion { code, companion }.into())
}

pub(crate) fn missing(block: &Block, letter: char) -> Fault {
    missing_of(block, Group::NonModal, letter)
}

pub(crate) fn missing_of(block: &Block, group: Group, letter: char) -> Fault {
    let (code, span) = block
        .taker(group)
        .unwrap_or((Motion::Off.code(), Span::default()));
    Fault::new(span, Reason::WordMissing { code, letter })
}
