//! RS274/NGC part programs as a stream of moves.
//!
//! [`Program`] reads a part program line by line and yields
//! [`Move`](toolglide_kinematics::Move)s in mm and s; it holds one line at a time, whatever the
//! length of the program. What it cannot read exactly as meant it refuses, and every refusal knows
//! file, line, column and word. Nothing that moves an axis is ever skipped silently.
//!
//! # Language
//!
//! A line is a block of words: a letter and a number. Upper and lower case are the same; blanks
//! may stand anywhere, even inside a number. `( )` encloses a comment, `;` begins one that lasts
//! to the end of the line. A line that begins with `/` is skipped (block delete is on). A `%`
//! alone on its line opens a program; any later one ends it, as do `M2`, `M30` and the end of the
//! file. Lines end in LF or CR LF; a byte order mark is skipped.
//!
//! | words | meaning |
//! | --- | --- |
//! | `G0` | rapid: [`Feedrate::RAPID`](toolglide_kinematics::Feedrate::RAPID) |
//! | `G1` | straight move at the feedrate |
//! | `G2` `G3` | arc clockwise, counter-clockwise in the plane, seen from its positive normal; a helix when the third axis moves; a full circle when the end is the start |
//! | `I` `J` `K` | centre of the arc, from its start (`G91.1`) or absolute (`G90.1`, both needed) |
//! | `R` | radius of the arc instead of its centre; negative takes the longer way round |
//! | `P` with `G2` `G3` | number of turns begun, from 1 |
//! | `G4 P` | standing still for P seconds |
//! | `G17` `G18` `G19` | plane XY, ZX, YZ |
//! | `G20` `G21` | inch, mm: for `X Y Z I J K R F` and the `P` of `G64` |
//! | `G40` `G49` `G54` | accepted: there are no offsets |
//! | `G61` `G61.1` | the motion comes to rest at the end of every move |
//! | `G64` | corners are rounded within the tolerance: `P`, or that of the [`Settings`] without one. `Q` is accepted; merging short moves never leaves `P`, so `Q` grants nothing more |
//! | `G80` | no motion mode: axis words need a motion word from here. Of no effect beside another motion word |
//! | `G90` `G91` | coordinates absolute, incremental |
//! | `G93` `G94` | `F` is one over the minutes of the move, needed by every `G1` `G2` `G3` and ignored beside others; `F` is length units a minute. From one to the other `F` is forgotten |
//! | `F` | feedrate. By the order of execution it is read before `G20` or `G21` of the same block |
//! | `S` `T` | spindle speed and tool: carried, of no effect on the motion |
//! | `M0` `M1` `M60` | the motion comes to rest: a dwell of no duration |
//! | `M2` `M30` | end of the program |
//! | `M3` `M4` `M5` `M6` `M7` `M8` `M9` `M48` `M49` | accepted, of no effect on the motion |
//! | `N` | line number, of no effect |
//!
//! A line of axis words alone repeats the last motion mode; at the beginning there is none. The
//! program begins in `G17 G21 G90 G91.1 G94 G64` with no feedrate.
//!
//! Within a block the order is that of RS274/NGC: feed mode, `F`, `S`, `T`, tool change, spindle,
//! coolant, overrides, dwell, plane, units, path control, distance mode, motion, stop.
//!
//! # Refused
//!
//! Parameters, expressions, `O` words, canned cycles, tool length and cutter compensation, offsets
//! of coordinates, machine coordinates, splines, and axes other than X, Y and Z are refused with
//! their name. With [`Settings::lenient`], words that certainly do not move an axis (most unknown
//! `M` codes, `G96` to `G99`, `E`, `D`, `H`, `L`) become [`Warning`]s instead.
//!
//! # Examples
//! ```
//! use toolglide_kinematics::{Tolerance, Vector};
//! use toolglide_program::{Program, Settings};
//! let text = "G21 G90\nF1200\nG1 X10\nG3 X20 Y10 J10\nM2\n";
//! let program = Program::new(text.as_bytes(), "slot.ngc", Settings::new(Tolerance::new(0.01)?));
//! let moves = program.collect::<Result<Vec<_>, _>>()?;
//! assert_eq!(moves.len(), 2);
//! assert_eq!(moves[1].end(Vector::zeros()), Vector::<3>::new(20.0, 10.0, 0.0));
//! assert_eq!(moves[1].line(), 4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arcs;
mod arithmetic_error;
mod axis_words;
mod block;
mod branch;
mod chords;
mod cl;
mod codes;
mod compensation;
mod control;
mod cycles;
mod error;
mod expression;
mod flow;
mod flow_error;
mod frame;
mod language;
mod lexer;
mod lines;
mod lower;
mod machining_error;
mod modal;
mod number;
mod offset_curve;
mod offsets;
mod once;
mod parameters;
mod place;
mod point;
mod poses;
mod program;
mod reason;
mod recording;
mod settings;
mod sinumerik;
mod sinumerik_value;
mod splines;
mod state;
mod statement;
mod statement_error;
mod tools;
mod units;
mod uses;

pub use arithmetic_error::ArithmeticError;
pub use codes::Code;
pub use error::{Notice, ProgramError, Warning};
pub use flow_error::FlowError;
pub use language::Language;
pub use lines::LONGEST_LINE;
pub use machining_error::MachiningError;
pub use place::Place;
pub use poses::Poses;
pub use program::{MOST_WARNINGS, Program};
pub use reason::Reason;
pub use settings::{MOST_STEPS, Settings};
pub use statement_error::StatementError;
pub use tools::{Tool, ToolTable, ToolTableError};
pub use units::FARTHEST;
