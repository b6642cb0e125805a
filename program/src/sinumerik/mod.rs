//! Translates Sinumerik 840D into the blocks of RS274/NGC.
//!
//! Source: the programming manual of Sinumerik 840D sl, as post-processors use it: addresses with `=`,
//! names, `DEF`, frames (`TRANS` `ATRANS` `ROT` `AROT`), `SUPA`, `TRAORI` `TRAFOOF`, `CYCLE832`. Not
//! here: jumps, conditions and loops, see `sinumerik_flow`, and cycles, which are refused by name.

pub(crate) mod codes;
pub(crate) mod flow;
pub(crate) mod frame;
pub(crate) mod line;
pub(crate) mod reader;
pub(crate) mod tool_vector;
pub(crate) mod value;
pub(crate) mod words;

use crate::block::Block;
use crate::block::codes::PathControl;
use crate::error::reason::Reason;
use crate::error::{Fault, Notice, Remark};
use crate::interpreter::Interpreter;
use crate::interpreter::tools::ToolTable;
use crate::settings::Settings;
use crate::sinumerik_ways::{extended_address, no_way};
use crate::text::lexer::Word;
use crate::text::place::Span;
use codes::is_foreign;
use frame::FrameWord;
use reader::Reader;
use std::collections::BTreeMap;
use toolglide_kinematics::{Tolerance, ToolpathError};
use words::{Known, known};

/// Tools whose names are remembered.
const MAX_TOOLS: usize = 1000;

/// What a program has said that blocks of RS274/NGC cannot hold.
#[derive(Debug, Default)]
pub(crate) struct Sinumerik {
    /// Numbers of tools that have names, by the order in which they are met.
    tools: BTreeMap<String, u32>,
}

/// A line being read.
pub(crate) struct Line<'a> {
    pub(crate) block: &'a mut Block,
    pub(crate) state: &'a mut Interpreter,
    remarks: &'a mut Vec<Remark>,
    pub(crate) frame: Option<(FrameWord, Span)>,
    /// Words X, Y and Z of a frame.
    pub(crate) offsets: [Option<f64>; 3],
    /// Components `A3=` `B3=` `C3=` of where the tool points.
    pub(crate) vector: [Option<(f64, Span)>; 3],
    pub(crate) dwell: bool,
}

impl Sinumerik {
    /// Reads the words of a line into a block.
    pub(crate) fn read(
        &mut self,
        mut reader: Reader<'_>,
        block: &mut Block,
        state: &mut Interpreter,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), Fault> {
        block.begin();
        let mut line = Line {
            block,
            state,
            remarks,
            frame: None,
            offsets: [None; 3],
            vector: [None; 3],
            dwell: false,
        };
        while let Some(start) = reader.next_item()? {
            let name = reader.name();
            match name.as_str() {
                "" => {
                    return Err(reader.stray(start));
                }
                "T" => self.tool(&mut reader, start, &mut line)?,
                _ if name.len() == 1 && reader.address_follows() => {
                    line.address(&mut reader, &name, start)?;
                }
                _ => line.word(&mut reader, &name, start)?,
            }
        }
        line.set_frame()?;
        line.set_vector()
    }

    /// The number of a tool with a name: that of the table, or one by order that the table has not.
    fn number_of(&mut self, name: String, table: &ToolTable) -> u32 {
        if let Some(number) = table.named(&name) {
            return number;
        }
        let next = u32::try_from(self.tools.len()).unwrap_or(0) + 1 + table.largest();
        if self.tools.len() < MAX_TOOLS {
            *self.tools.entry(name).or_insert(next)
        } else {
            next
        }
    }

    /// A tool by number or by name.
    fn tool(
        &mut self,
        reader: &mut Reader<'_>,
        start: usize,
        line: &mut Line<'_>,
    ) -> Result<(), Fault> {
        let quoted = reader.quoted_after_equals();
        let value = match quoted {
            Some(name) => f64::from(self.number_of(name, &line.state.tools)),
            None => match reader.address_value(line.state, start)? {
                (value, None) => value,
                (_, Some(_)) => return Err(no_way("T", Span::new(start, reader.at))),
            },
        };
        line.add(b'T', value, Span::new(start, reader.at))
    }
}

impl Line<'_> {
    pub(crate) fn add(&mut self, letter: u8, value: f64, span: Span) -> Result<(), Fault> {
        let word = Word {
            letter,
            value,
            span,
        };
        // Codes of the machine are the business of the machine.
        let settings = Settings {
            lenient: self.state.settings.lenient || letter == b'M',
            ..self.state.settings
        };
        self.block.add(word, &settings, self.remarks)
    }

    /// A letter with a value.
    fn address(&mut self, reader: &mut Reader<'_>, name: &str, start: usize) -> Result<(), Fault> {
        let letter = name.bytes().next().unwrap_or(b'?');
        if matches!(letter, b'R' | b'S' | b'M')
            && let Some(number) = reader.extension(self.state)?
        {
            let value = reader.expression(self.state)?;
            let span = Span::new(start, reader.at);
            return if letter == b'R' {
                self.assign(&format!("r{number}"), value, span)
            } else {
                self.add(letter, value, span)
            };
        }
        if matches!(letter, b'A' | b'B' | b'C') && reader.extension_is(3) {
            let value = reader.expression(self.state)?;
            return self.add_component(letter, value, Span::new(start, reader.at));
        }
        let (value, way) = reader.address_value(self.state, start)?;
        let span = Span::new(start, reader.at);
        if reader.peek() == Some(b'=') {
            let whole = format!("{name}{value}=");
            let span = Span::new(start, reader.at + 1);
            return Err(extended_address(&whole, span));
        }
        if way.is_some() && !b"XYZABCIJK".contains(&letter) {
            return Err(no_way(name, span));
        }
        let axis = b"XYZ".iter().position(|&axis| axis == letter);
        match letter {
            b'G' => self.code(value, span),
            // Lengths of tools are in the machine.
            b'D' | b'H' => Ok(()),
            b'U' | b'V' | b'W' if self.block.has_beside(letter) => self.add(letter, value, span),
            b'L' | b'P' | b'Q' | b'E' | b'O' | b'U' | b'V' | b'W' => Err(unknown(name, span)),
            b'F' if self.dwell => self.add(b'P', value, span),
            b'M' if (value - 17.0).abs() < 0.5 => self.add(b'M', 2.0, span),
            // Of these RS274/NGC has a meaning that Sinumerik has not.
            b'M' if is_foreign(value) => {
                let reason = Reason::UnknownWord {
                    word: format!("M{value}").into(),
                };
                self.remarks.push((span, Notice::Skipped(reason)));
                Ok(())
            }
            _ => {
                if let (Some(axis), Some(_), None) = (axis, self.frame, way) {
                    self.offsets[axis] = Some(value);
                    return Ok(());
                }
                self.add_by_way(letter, value, way, span)
            }
        }
    }

    /// A word of several letters.
    fn word(&mut self, reader: &mut Reader<'_>, name: &str, start: usize) -> Result<(), Fault> {
        let span = Span::new(start, reader.at);
        match name {
            "DEF" => return self.define(reader),
            "SUPA" => return self.add(b'G', 53.0, span),
            "TRAORI" => self.state.tip = true,
            "TRAFOOF" => {
                self.state.tip = false;
                self.state.tool_vector.release();
            }
            "ORIAXES" => self.state.great_circle = false,
            "ORIVECT" | "ORIPLANE" => self.state.great_circle = true,
            "TRANS" | "ATRANS" => {
                let added = name == "ATRANS";
                self.frame = Some((FrameWord::Shift { added }, span));
            }
            "ROT" | "AROT" => {
                let added = name == "AROT";
                self.frame = Some((FrameWord::Turn { added }, span));
            }
            "CR" | "TURN" if reader.equals_follows() => {
                let value = reader.expression(self.state)?;
                let span = Span::new(start, reader.at);
                return match name {
                    "CR" => self.add(b'R', value, span),
                    _ => self.add(b'P', value + 1.0, span),
                };
            }
            "CYCLE832" => {
                let arguments = reader.arguments(self.state)?;
                return self.smooth(arguments.first().copied(), span);
            }
            "CYCLE800" => {
                if !reader.arguments(self.state)?.is_empty() {
                    return Err(unknown("CYCLE800 with arguments", span));
                }
                return Ok(());
            }
            "AP" | "RP" if reader.equals_follows() => {
                let (value, way) = reader.way_value(self.state)?;
                let letter = if name == "RP" { b'@' } else { b'^' };
                return self.add_by_way(letter, value, way, Span::new(start, reader.at));
            }
            "RET" => return self.add(b'M', 2.0, span),
            "SPOS" if reader.equals_follows() => {
                return reader.way_value(self.state).map(|_| ());
            }
            "PROC" | "EXTERN" => {
                reader.skip_line();
                return Ok(());
            }
            "MCALL" if reader.next_item()?.is_none() => return Ok(()),
            _ if known(name) == Known::Silent => {}
            _ if let Known::NotRead(what) = known(name) => {
                let word = name.into();
                return Err(Fault::new(span, Reason::WordNotSupported { word, what }));
            }
            _ if reader.equals_follows() => {
                let value = reader.expression(self.state)?;
                let lower = name.to_ascii_lowercase();
                if self.state.parameters.get_named(&lower).is_none() {
                    return Err(unknown(name, span));
                }
                return self.assign(&lower, value, Span::new(start, reader.at));
            }
            _ => return Err(unknown(name, span)),
        }
        reader.skip_brackets();
        Ok(())
    }

    /// `DEF REAL a, b = 2`.
    fn define(&mut self, reader: &mut Reader<'_>) -> Result<(), Fault> {
        let kind = reader.next_name();
        if !matches!(kind.as_str(), "REAL" | "INT" | "BOOL") {
            return Err(reader.stray(reader.at));
        }
        loop {
            let start = reader.at;
            let name = reader.next_name().to_ascii_lowercase();
            if name.is_empty() {
                return Err(reader.stray(start));
            }
            let value = if reader.equals_follows() {
                reader.expression(self.state)?
            } else {
                0.0
            };
            self.assign(&name, value, Span::new(start, reader.at))?;
            if !reader.comma_follows() {
                return Ok(());
            }
        }
    }

    fn assign(&mut self, name: &str, value: f64, span: Span) -> Result<(), Fault> {
        self.block.features |= crate::block::PARAMETERS;
        self.state
            .parameters
            .set_named(name, value)
            .map_err(|reason| Fault::new(span, reason.into()))
    }

    /// `CYCLE832`: the tolerance within which corners are rounded.
    fn smooth(&mut self, tolerance: Option<f64>, span: Span) -> Result<(), Fault> {
        let state = &mut *self.state;
        state.modal.path_control = PathControl::Blend;
        state.modal.tolerance = state.settings.tolerance;
        let Some(value) = tolerance.filter(|&value| value != 0.0) else {
            return Ok(());
        };
        if !state.settings.override_tolerance {
            let quantity = "tolerance";
            let length = state.modal.units.length(value);
            state.modal.tolerance = Tolerance::new(length).map_err(|reason| {
                let reason = match reason {
                    ToolpathError::TooSmall { .. } | ToolpathError::TooLarge { .. } => {
                        Reason::Path(reason)
                    }
                    _ => Reason::NotPositive { quantity, value },
                };
                Fault::new(span, reason)
            })?;
        }
        Ok(())
    }
}

pub(crate) fn unknown(word: &str, span: Span) -> Fault {
    let word = word.into();
    Fault::new(span, Reason::UnknownWord { word })
}
