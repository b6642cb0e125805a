//! Reads where a vector points the tool: `A3=` `B3=` `C3=` of Sinumerik.
//!
//! Source: orientations by direction vectors in the programming manual of Sinumerik 840D sl. The vector points from
//! the tip of the tool to its holder, its length means nothing, and a component that is not written is 0. Not here:
//! where the rotary axes are then, which only the machine knows.

use crate::block::codes::{Distance, Way};
use crate::error::Fault;
use crate::error::reason::Reason;
use crate::interpreter::secondary_axes::{OTHERS, ROTARY};
use crate::sinumerik::Line;
use crate::text::place::Span;
use toolglide_kinematics::Vector;

/// Where the tool points while vectors say it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ToolVector {
    /// Direction in the workpiece, of unit length; none where rotary words say it.
    pub(crate) direction: Option<Vector<3>>,
    /// Rotary axes A, B, C that stay where a vector has put them, until a word names them.
    pub(crate) held: [bool; ROTARY],
}

impl ToolVector {
    /// Words of axes are those of the machine again: its rotary axes stay where they are.
    pub(crate) fn release(&mut self) {
        if self.direction.take().is_some() {
            self.held = [true; ROTARY];
        }
    }
}

impl Line<'_> {
    /// Takes a component of the vector.
    pub(crate) fn add_component(
        &mut self,
        letter: u8,
        value: f64,
        span: Span,
    ) -> Result<(), Fault> {
        let axis = usize::from(letter - b'A');
        if self.vector[axis].replace((value, span)).is_some() {
            let word = name(axis);
            return Err(refused(word, "a component that is written twice", span));
        }
        Ok(())
    }

    /// Points the tool as the words of the line say.
    pub(crate) fn set_vector(&mut self) -> Result<(), Fault> {
        let Some((axis, span)) = self
            .vector
            .iter()
            .zip(0..)
            .find_map(|(word, axis)| word.map(|(_, span)| (axis, span)))
        else {
            return self.end_vector();
        };
        let what = if !self.block.rotary {
            Some("directions of the tool, which need a machine with rotary axes")
        } else if !self.state.tip {
            Some("directions of the tool, which need TRAORI")
        } else if self.block.first_of(&OTHERS[..ROTARY]).is_some() {
            Some("directions of the tool beside words A, B or C")
        } else {
            None
        };
        if let Some(what) = what {
            return Err(refused(name(axis), what, span));
        }
        let written =
            Vector::<3>::from_fn(|axis, _| self.vector[axis].map_or(0.0, |(value, _)| value));
        let direction = self.state.offsets.frame().direction(written);
        let value = direction.norm();
        if !(value > 0.0 && value.is_finite()) {
            let quantity = "length of the vector A3 B3 C3";
            return Err(Fault::new(span, Reason::NotPositive { quantity, value }));
        }
        self.state.tool_vector.direction = Some(direction / value);
        // The rotary axes take part in the block, by no words of their own.
        for (axis, letter) in OTHERS.into_iter().enumerate().take(ROTARY) {
            let here = self.state.others.in_program(axis);
            self.block.set_way(letter, Way::Absolute);
            self.add(letter, here, span)?;
        }
        Ok(())
    }

    /// Words of rotary axes end what a vector says.
    fn end_vector(&mut self) -> Result<(), Fault> {
        let named = |axis: usize| self.block.get(OTHERS[axis]).is_some();
        if !(0..ROTARY).any(named) {
            return Ok(());
        }
        let mut vector = self.state.tool_vector;
        vector.release();
        for axis in (0..ROTARY).filter(|&axis| named(axis)) {
            let letter = OTHERS[axis];
            let distance = self.block.distance.unwrap_or(self.state.modal.distance);
            let is_place = match self.block.way(letter) {
                None => distance == Distance::Absolute,
                Some(way) => way == Way::Absolute,
            };
            if vector.held[axis] && !is_place {
                let word = char::from(letter).to_string();
                let what =
                    "a step of a rotary axis that is where a vector has put it; write its place";
                return Err(refused(word, what, self.block.span(letter)));
            }
            vector.held[axis] = false;
        }
        self.state.tool_vector = vector;
        Ok(())
    }
}

/// The name of a component.
fn name(axis: usize) -> String {
    format!("{}3=", char::from(OTHERS[axis]))
}

fn refused(word: String, what: &'static str, span: Span) -> Fault {
    let word = word.into();
    Fault::new(span, Reason::WordNotSupported { word, what })
}
