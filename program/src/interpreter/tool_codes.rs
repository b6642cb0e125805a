//! Executes codes of tools: table, length, side of the path.
//!
//! Source: `G10 L1`, `G40` to `G43.2` and `G49` of LinuxCNC. Not here: what compensation does.

use crate::block::codes::{Group, Side, ToolLength};
use crate::block::{AXES, Block};
use crate::compensation::Compensation;
use crate::error::machining::MachiningError;
use crate::error::{Fault, Notice, Remark};
use crate::interpreter::Interpreter;
use crate::interpreter::modal::{not_negative, whole};
use crate::interpreter::non_modal::{COMPENSATED, companion, missing, missing_of};
use crate::interpreter::offsets::SYSTEMS;
use crate::interpreter::tools::{LARGEST_TOOL, Tool};
use std::collections::VecDeque;
use toolglide_kinematics::{Move, Vector};

/// What the words of a tool say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Measured {
    /// Its offsets.
    Given,
    /// The coordinates that the tool has here, in the system in force.
    Here,
    /// The coordinates that the tool has here, in the last system and without a shift.
    OnFixture,
}

impl Interpreter {
    /// `G10 L1`, `L10` and `L11`.
    pub(crate) fn set_tool(&mut self, block: &Block, how: Measured) -> Result<(), Fault> {
        let Some(number) = whole(block, b'P', "tool number", 0, LARGEST_TOOL)? else {
            return Err(missing(block, 'P'));
        };
        Self::no_others(block, "in the table of tools")?;
        let mut tool = self.tools.get(number).unwrap_or(Tool {
            offset: Vector::zeros(),
            diameter: 0.0,
        });
        if let Some(radius) = not_negative(block, b'R', "radius of the tool")? {
            tool.diameter = 2.0 * self.modal.units.length(radius);
        }
        let written = |state: &Self| -> Result<[Option<f64>; 3], Fault> {
            let mut lengths = [None; 3];
            for (length, letter) in lengths.iter_mut().zip(AXES) {
                *length = state.length(block, letter)?;
            }
            Ok(lengths)
        };
        let written = written(self)?;
        let mut offset = tool.offset;
        let mut turned = false;
        match how {
            Measured::Given => {
                offset = Vector::from_fn(|axis, _| written[axis].unwrap_or(offset[axis]));
            }
            Measured::Here | Measured::OnFixture => {
                let mut without = self.offsets;
                if how == Measured::OnFixture {
                    without = without.bare(SYSTEMS, &self.parameters);
                }
                // Where the point would be with the tool as it is now, but for what is written.
                without.set_tool(tool.offset);
                let here = without.in_program(self.position);
                let target = Vector::from_fn(|axis, _| written[axis].unwrap_or(here[axis]));
                without.set_tool(Vector::zeros());
                offset = self.position - without.on_machine(target);
                turned = without.rotation() != 0.0;
            }
        }
        for axis in 0..3 {
            // In a turned system both X and Y of the tool follow from either word.
            if written[axis].is_some() || turned && axis < 2 {
                tool.offset[axis] = offset[axis];
            }
        }
        self.tools.set(number, tool);
        Ok(())
    }

    /// `G43` to `G49`.
    pub(crate) fn tool_length(
        &mut self,
        block: &Block,
        kind: ToolLength,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        if matches!(kind, ToolLength::Given | ToolLength::Added) {
            Self::no_others(block, "as the length of a tool")?;
        }
        let given = |state: &Self| -> Result<Vector<3>, Fault> {
            let mut offset = Vector::zeros();
            for (axis, letter) in AXES.into_iter().enumerate() {
                offset[axis] = state.length(block, letter)?.unwrap_or(0.0);
            }
            Ok(offset)
        };
        let tool = match kind {
            ToolLength::Off => Vector::zeros(),
            ToolLength::Table => {
                self.tool_of(block, b'H', Group::ToolLength, remarks)?
                    .offset
            }
            ToolLength::Against => {
                let tool = self.tool_of(block, b'H', Group::ToolLength, remarks)?;
                -tool.offset
            }
            ToolLength::Given => {
                if block.first_of(&AXES).is_none() {
                    return Err(companion(block, Group::ToolLength, "an axis word"));
                }
                let mut offset = self.offsets.tool();
                for (axis, letter) in AXES.into_iter().enumerate() {
                    offset[axis] = self.length(block, letter)?.unwrap_or(offset[axis]);
                }
                offset
            }
            ToolLength::Added if block.has(b'H') => {
                if block.first_of(&AXES).is_some() {
                    let state = "with both an H word and axis words";
                    return Self::not_now(block, Group::ToolLength, state).map_or(Ok(()), Err);
                }
                let more = self
                    .tool_of(block, b'H', Group::ToolLength, remarks)?
                    .offset;
                self.offsets.tool() + more
            }
            ToolLength::Added if block.first_of(&AXES).is_none() => {
                return Err(companion(
                    block,
                    Group::ToolLength,
                    "an H word or an axis word",
                ));
            }
            ToolLength::Added => self.offsets.tool() + given(self)?,
        };
        self.offsets.set_tool(tool);
        self.program = self.offsets.in_program(self.position);
        Ok(())
    }

    /// The tool that a word names, or the one in the spindle.
    fn tool_of(
        &self,
        block: &Block,
        letter: u8,
        group: Group,
        remarks: &mut Vec<Remark>,
    ) -> Result<Tool, Fault> {
        let none = Tool {
            offset: Vector::zeros(),
            diameter: 0.0,
        };
        let written = whole(block, letter, "tool number", 0, LARGEST_TOOL)?;
        let number = written.unwrap_or(self.loaded);
        let span = match (written, block.taker(group)) {
            (None, Some((_, span))) => span,
            _ => block.span(letter),
        };
        if number == 0 {
            return Ok(none);
        }
        if let Some(tool) = self.tools.get(number) {
            return Ok(tool);
        }
        if self.tools.is_empty() {
            remarks.push((span, Notice::NoToolTable { tool: number }));
            return Ok(none);
        }
        let tool = number;
        Err(Fault::new(span, MachiningError::NoSuchTool { tool }.into()))
    }

    /// `G40` to `G42.1`.
    pub(crate) fn compensate(
        &mut self,
        block: &Block,
        side: Side,
        remarks: &mut Vec<Remark>,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let group = Group::CutterCompensation;
        let left = match side {
            Side::Off => {
                if let Some(compensation) = &mut self.compensation {
                    compensation.end(moves);
                    if compensation.is_over() {
                        self.compensation = None;
                    }
                }
                return Ok(());
            }
            Side::Left | Side::LeftOf => true,
            Side::Right | Side::RightOf => false,
        };
        if self.compensation.as_ref().is_some_and(|on| !on.is_ending()) {
            return Self::not_now(block, group, COMPENSATED).map_or(Ok(()), Err);
        }
        let diameter = match side {
            Side::LeftOf | Side::RightOf => match self.length(block, b'D')? {
                Some(diameter) => diameter,
                None => return Err(missing_of(block, group, 'D')),
            },
            _ => self.tool_of(block, b'D', group, remarks)?.diameter,
        };
        let radius = 0.5 * diameter.abs();
        let mirrored = self.offsets.frame().mirrors(self.modal.plane.axes());
        // A tool of negative diameter goes on the other side, as does a mirrored path.
        let left = (left == (diameter >= 0.0)) != mirrored;
        let at = self
            .compensation
            .take()
            .map_or(self.position, |on| on.position());
        let compensation = Compensation::new(self.modal.plane, radius, left, at);
        self.compensation = Some(if self.leads_to_normal {
            compensation.leading_to_normal()
        } else {
            compensation
        });
        Ok(())
    }
}
