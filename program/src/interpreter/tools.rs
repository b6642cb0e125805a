//! Reads the tool table: length and diameter of each tool.
//!
//! Source: the tool table file of LinuxCNC: one tool a line, `T` number, `P` pocket, `X Y Z` offsets,
//! `D` diameter, `;` remark. Not here: what a program does with them.

use std::collections::BTreeMap;
use thiserror::Error;
use toolglide_kinematics::Vector;

/// Largest number of a tool.
pub(crate) const LARGEST_TOOL: u32 = 999_999;

/// Characters of an offending word that are shown.
const LONGEST_SHOWN: usize = 40;

/// One tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tool {
    /// Offset of the tool tip from the reference point of the machine, mm; the length of the tool is
    /// that of Z.
    pub offset: Vector<3>,
    /// Diameter, mm.
    pub diameter: f64,
}

/// Tools by their number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ToolTable {
    tools: BTreeMap<u32, Tool>,
    /// Numbers by remarks in upper case, which may be names.
    names: BTreeMap<String, u32>,
}

/// Why a tool table is refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("line {line}: {problem}")]
pub struct ToolTableError {
    line: usize,
    problem: String,
}

impl ToolTable {
    /// A table without tools.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Reads the text of a tool table in mm.
    ///
    /// # Errors
    /// [`ToolTableError`] for a line that is none, a tool without a number or with one that stands
    /// twice, and a diameter that is negative.
    ///
    /// # Examples
    /// ```
    /// use toolglide_program::ToolTable;
    /// let table = ToolTable::parse("T1 P1 Z25.4 D6 ; end mill\n")?;
    /// assert!(table.get(1).is_some_and(|tool| tool.diameter == 6.0));
    /// # Ok::<(), toolglide_program::ToolTableError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, ToolTableError> {
        let mut table = Self::new();
        for (line, number) in text.lines().zip(1..) {
            let words = line.split(';').next().unwrap_or_default();
            if words.trim().is_empty() {
                continue;
            }
            let refuse = |problem: String| ToolTableError {
                line: number,
                problem,
            };
            let (tool, entry) = entry(words).map_err(refuse)?;
            if let Some((_, name)) = line.split_once(';') {
                let name = name.trim().to_ascii_uppercase();
                table.names.entry(name).or_insert(tool);
            }
            if table.tools.insert(tool, entry).is_some() {
                return Err(refuse(format!("tool {tool} stands twice")));
            }
        }
        Ok(table)
    }

    /// A tool by its number.
    #[must_use]
    pub fn get(&self, number: u32) -> Option<Tool> {
        self.tools.get(&number).copied()
    }

    /// The number of the tool whose remark is a name, in whatever case; the first one if several have it.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<u32> {
        self.names.get(&name.to_ascii_uppercase()).copied()
    }

    /// Largest number of a tool, 0 where there is none.
    pub(crate) fn largest(&self) -> u32 {
        self.tools.keys().next_back().copied().unwrap_or(0)
    }

    /// Adds or replaces a tool.
    pub fn set(&mut self, number: u32, tool: Tool) {
        self.tools.insert(number, tool);
    }

    /// Whether there is no tool.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.tools.is_empty()
    }
}

fn entry(words: &str) -> Result<(u32, Tool), String> {
    let mut number = None;
    let mut tool = Tool {
        offset: Vector::zeros(),
        diameter: 0.0,
    };
    for word in words.split_whitespace() {
        let mut letters = word.chars();
        let letter = letters.next().unwrap_or(' ').to_ascii_uppercase();
        let value: f64 = letters
            .as_str()
            .parse()
            .ok()
            .filter(|value: &f64| value.is_finite())
            .ok_or_else(|| {
                let shown: String = word.escape_debug().take(LONGEST_SHOWN).collect();
                format!("\"{shown}\" is no letter with a number")
            })?;
        match letter {
            'T' if (0.0..=f64::from(LARGEST_TOOL)).contains(&value) && value.fract() == 0.0 => {
                #[allow(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "whole and within the bounds checked above"
                )]
                let whole = value as u32;
                number = Some(whole);
            }
            'T' => {
                let bound = format!("a whole number from 0 to {LARGEST_TOOL}");
                return Err(format!("tool number is {value}, but must be {bound}"));
            }
            'X' => tool.offset[0] = value,
            'Y' => tool.offset[1] = value,
            'Z' => tool.offset[2] = value,
            'D' if value < 0.0 => {
                return Err(format!("diameter is {value} mm, but must not be negative"));
            }
            'D' => tool.diameter = value,
            // Pocket, angles and offsets of other axes: of no use to three straight axes.
            'P' | 'A' | 'B' | 'C' | 'U' | 'V' | 'W' | 'I' | 'J' | 'Q' => {}
            _ => return Err(format!("\"{word}\" is not known in a tool table")),
        }
    }
    match number {
        Some(number) => Ok((number, tool)),
        None => Err("there is no T word with the number of the tool".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_its_tools_by_number() {
        let text = "; tools\nT2 P7 D3.175 Z+0.511 ;end mill\n\nt10 p2 z-5 x1 i0\n";
        let table = ToolTable::parse(text).unwrap();
        let tool = table.get(2).unwrap();
        assert_eq!((tool.diameter, tool.offset[2]), (3.175, 0.511), "tool 2");
        let offset = Vector::<3>::new(1.0, 0.0, -5.0);
        assert_eq!(
            table.get(10).map(|tool| tool.offset),
            Some(offset),
            "tool 10"
        );
        assert_eq!(table.get(3), None, "tool 3");
    }

    #[test]
    fn what_is_no_tool_is_refused_with_its_line() {
        for (text, expected) in [
            ("T1\nT1", "line 2: tool 1 stands twice"),
            (
                "P1 Z5",
                "line 1: there is no T word with the number of the tool",
            ),
            ("\nT1 Zx", "line 2: \"Zx\" is no letter with a number"),
            (
                "T1 D-1",
                "line 1: diameter is -1 mm, but must not be negative",
            ),
            ("T1 ~1", "line 1: \"~1\" is not known in a tool table"),
            (
                "T1.5",
                "line 1: tool number is 1.5, but must be a whole number from 0 to 999999",
            ),
        ] {
            let shown = ToolTable::parse(text).unwrap_err().to_string();
            assert_eq!(shown, expected, "{text:?}");
        }
    }
}
