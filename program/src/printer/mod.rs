//! Executes orders of printers beside motion: extrusion, homing, offsets.
//!
//! Source: Marlin and Klipper. `E` is a length of filament, no axis: a move takes as long as its path does, and a
//! block with `E` alone lasts as long as the filament needs at the feedrate, while the axes rest. `G0` keeps the
//! feedrate as `G1` does. Not here: which line asks for what, see `printer_lines`.

pub(crate) mod lines;

use crate::block::Block;
use crate::block::codes::{Distance, Motion, Once};
use crate::error::reason::Reason;
use crate::error::{Fault, Notice};
use crate::interpreter::Interpreter;
use crate::interpreter::units::within_reach;
use crate::program::Program;
use crate::text::number::number;
use crate::text::place::Span;
use lines::{Line, line_of};
use std::collections::{BTreeSet, VecDeque};
use std::io::BufRead;
use toolglide_kinematics::{Feedrate, Move, Vector};

/// Orders that are remembered as told.
const MAX_NOTED: usize = 200;

/// Filament, and what was said of orders.
#[derive(Clone, Debug, Default)]
pub(crate) struct Printer {
    /// Where `E` is, mm.
    at: f64,
    relative: bool,
    /// Length of filament that was pushed out, less what was drawn back, mm.
    extruded: f64,
    noted: BTreeSet<String>,
}

impl<R: BufRead> Program<R> {
    /// Length of filament that a printer's program has pushed out so far, less what it drew back, mm; none for
    /// other programs.
    #[must_use]
    pub fn filament(&self) -> Option<f64> {
        let printer = self.lowering.printer.as_ref();
        printer.map(|printer| printer.extruded)
    }

    /// Does what a line of a printer's program says; where its words end, if it has any.
    pub(crate) fn printer_line(&mut self) -> Result<Option<usize>, Fault> {
        let (state, moves) = (&mut self.lowering, &mut self.waiting);
        let text = self.flow.text();
        state.line = self.flow.line();
        let line = line_of(text);
        if !matches!(line, Line::Empty | Line::Words(_)) {
            self.blocks += 1;
        }
        match line {
            Line::Empty => return Ok(None),
            Line::Words(end) => return Ok(Some(end)),
            Line::Rest(span) => state.stand(0.0, span, moves)?,
            Line::Dwell(span, duration) if duration >= 0.0 => {
                state.stand(duration, span, moves)?;
            }
            Line::Dwell(span, value) => {
                let quantity = "dwell";
                return Err(Fault::new(span, Reason::Negative { quantity, value }));
            }
            Line::Extrusion { relative } => {
                if let Some(printer) = &mut state.printer {
                    printer.relative = relative;
                }
            }
            Line::Home(span, axes) => state.home(axes, span, moves)?,
            Line::Offset(span, after) => state.offset_by(after, span, moves)?,
            Line::Noted(span, what) => {
                let word = word_at(text, span);
                if state.printer.as_mut().is_some_and(|on| on.tells(&word)) {
                    let word = word.into();
                    self.remarks.push((span, Notice::Noted { word, what }));
                }
            }
            Line::Refused(span, what) => {
                let word = word_at(text, span).into();
                return Err(Fault::new(span, Reason::WordNotSupported { word, what }));
            }
        }
        Ok(None)
    }
}

fn word_at(text: &[u8], span: Span) -> String {
    let word = &text[span.start as usize..span.end as usize];
    String::from_utf8_lossy(word).to_ascii_uppercase()
}

impl Printer {
    /// Whether an order is met for the first time.
    fn tells(&mut self, word: &str) -> bool {
        self.noted.len() < MAX_NOTED && self.noted.insert(word.to_owned())
    }
}

impl Interpreter {
    /// Whether the moves of `G0` keep a feedrate, as printers have it.
    pub(crate) fn paces_rapids(&self) -> bool {
        self.printer.is_some() && self.modal.feedrate.is_some()
    }

    /// Takes the `E` of a block, and rests as long as the filament alone needs.
    pub(crate) fn extrude(
        &mut self,
        block: &Block,
        motion: Option<Motion>,
        before: Vector<3>,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let Some(value) = block.get(b'E') else {
            return Ok(());
        };
        let length = self.modal.units.length(value);
        let span = block.span(b'E');
        let length = within_reach('E', length).map_err(|reason| Fault::new(span, reason))?;
        let incremental = self.modal.distance == Distance::Incremental;
        let Some(printer) = &mut self.printer else {
            return Ok(());
        };
        if block.once == Some(Once::Shift) {
            printer.at = length;
            return Ok(());
        }
        let step = if printer.relative || incremental {
            length
        } else {
            length - printer.at
        };
        printer.at += step;
        printer.extruded += step;
        let still = motion.is_none() || self.position == before;
        if !still || step.abs() <= 0.0 {
            return Ok(());
        }
        let speed = self.modal.feedrate.filter(|&speed| speed > 0.0);
        let speed = speed.ok_or_else(|| Fault::new(span, Reason::NoFeedrate))?;
        self.stand(step.abs() / speed, span, moves)
    }

    /// Stands still.
    fn stand(
        &mut self,
        duration: f64,
        span: Span,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let rest = self.rest(duration, span)?;
        self.emit(rest, moves)
    }

    /// `G28`: the axes that it names, or all, go to 0 of the machine, where their shifts end.
    fn home(
        &mut self,
        axes: [bool; 3],
        span: Span,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let all = axes == [false; 3];
        let mut there = self.position;
        let mut shift = self.offsets.shift();
        for axis in 0..3 {
            if (all || axes[axis]) && self.settings.axes[axis] {
                there[axis] = 0.0;
                shift[axis] = 0.0;
            }
        }
        let end = self.offsets.in_program(there);
        if there != self.position {
            self.go(end, Feedrate::RAPID, span, moves)?;
        }
        self.offsets.set_shift(shift, &mut self.parameters);
        self.program = self.offsets.in_program(self.position);
        Ok(())
    }

    /// `SET_GCODE_OFFSET`: what is added to the axes from here, by `MOVE=1` at once.
    fn offset_by(
        &mut self,
        after: &str,
        span: Span,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let mut offset = self.offsets.tool();
        let mut goes = false;
        for pair in after
            .split(';')
            .next()
            .unwrap_or_default()
            .split_whitespace()
        {
            let (name, text) = pair.split_once('=').unwrap_or((pair, ""));
            let refused = || {
                let word = pair.into();
                let what = "an offset is an axis, =, and a number";
                Fault::new(span, Reason::WordNotSupported { word, what })
            };
            let value = match number(text.as_bytes(), 0) {
                Ok((value, end)) if end == text.len() => value,
                _ if name.eq_ignore_ascii_case("MOVE_SPEED") => continue,
                _ => return Err(refused()),
            };
            let name = name.to_ascii_uppercase();
            let axis = ["X", "Y", "Z"]
                .iter()
                .position(|axis| name.strip_suffix("_ADJUST").unwrap_or(&name) == *axis);
            match (axis, name.as_str()) {
                (Some(axis), _) => {
                    let letter = name.chars().next().unwrap_or('X');
                    let base = if name.len() > 1 { offset[axis] } else { 0.0 };
                    offset[axis] = within_reach(letter, base + value)
                        .map_err(|reason| Fault::new(span, reason))?;
                }
                (None, "MOVE") => goes = value != 0.0,
                (None, "MOVE_SPEED" | "E" | "E_ADJUST") => {}
                _ => return Err(refused()),
            }
        }
        let here = self.program;
        self.offsets.set_tool(offset);
        if goes {
            let feedrate = self.modal.feedrate.map(Feedrate::new);
            let feedrate = feedrate.and_then(Result::ok).unwrap_or(Feedrate::RAPID);
            return self.go(here, feedrate, span, moves);
        }
        self.program = self.offsets.in_program(self.position);
        Ok(())
    }
}
