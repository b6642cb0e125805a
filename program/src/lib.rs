//! RS274/NGC part programs as a stream of moves.
//!
//! [`Program`] reads a part program line by line and yields
//! [`Move`](toolglide_kinematics::Move)s in mm and s; it holds one line at a time, whatever the
//! length of the program. What it cannot read exactly as meant it refuses, and every refusal knows
//! file, line, column and word. Nothing that moves an axis is ever skipped silently.
//!
//! # Language
//!
//! A line is a block of words: a letter and a value. Upper and lower case are the same; blanks may
//! stand anywhere, even inside a number. `( )` encloses a comment, `;` begins one that lasts to the
//! end of the line. A line that begins with `/` is skipped (block delete is on). A `%` alone on its
//! line opens a program; any later one ends it, as do `M2`, `M30` and the end of the file. Lines end
//! in LF or CR LF; a byte order mark is skipped.
//!
//! Read are straight moves, arcs and helices, splines, canned cycles, cutter compensation, tool
//! lengths, coordinate systems and their rotation, polar coordinates, parameters, expressions, and O
//! words with their loops and subroutines. `docs/programs.md` of the project lists every word and
//! what becomes of it. LinuxCNC is the reference for what a word means.
//!
//! A line of axis words alone repeats the last motion mode; at the beginning there is none. The
//! program begins in `G17 G21 G40 G49 G54 G64 G80 G90 G91.1 G94 G99` with no feedrate. Within a
//! block the order is that of RS274/NGC: feed mode, `F`, `S`, `T`, tool change, spindle, coolant,
//! overrides, dwell, plane, units, cutter compensation, tool length, coordinate system, path
//! control, distance mode, offsets, motion, stop.
//!
//! Moves are in the coordinates of the machine: offsets and tool lengths are added. Parameters hold
//! offsets in mm.
//!
//! # Tool poses
//!
//! [`Poses`] reads programs of machines with rotary axes, cutter location files, and the language of
//! Sinumerik 840D as far as `docs/programs.md` tells; [`Language`] tells them apart.
//!
//! # Refused
//!
//! What cannot be planned as motion is refused with its name: probing, threads, feed for each turn,
//! axes that the machine has not. With [`Settings::lenient`], words
//! that certainly do not move an axis (most unknown `M` codes, `G96`, `D`, `H`, `L`) become
//! [`Warning`]s instead. Loops and subroutines have a bound on their depth and on the lines they run
//! ([`Settings::steps`]), and a block has one on its moves, so that reading ends.
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

mod aftermath;
mod arcs;
mod arithmetic_error;
mod asides;
mod axis_moves;
mod axis_words;
mod bezier;
mod block;
mod branch;
mod chords;
mod cl;
mod cl_arc;
mod cl_kinds;
mod cl_moves;
mod cl_system;
mod code;
mod codes;
mod compensation;
mod control;
mod corners;
mod cycle_words;
mod cycles;
mod data;
mod definitions;
mod endless;
mod error;
mod expression;
mod fanuc;
mod flow;
mod flow_error;
mod frame;
mod grouping;
mod knot_spline;
mod language;
mod lexer;
mod lines;
mod lower;
mod machining_error;
mod meanings;
mod modal;
mod number;
mod offset_curve;
mod offset_moves;
mod offsets;
mod once;
mod operations;
mod others;
mod pace;
mod parameters;
mod passing;
mod place;
mod point;
mod poses;
mod printer;
mod printer_lines;
mod program;
mod program_setup;
mod program_state;
mod reason;
mod recognise;
mod recording;
mod settings;
mod sinumerik;
mod sinumerik_codes;
mod sinumerik_flow;
mod sinumerik_frame;
mod sinumerik_line;
mod sinumerik_reader;
mod sinumerik_value;
mod sinumerik_ways;
mod sinumerik_words;
mod splines;
mod state;
mod statement;
mod statement_error;
mod subprograms;
mod tally;
mod tape;
mod tool_codes;
mod tools;
mod turned_arcs;
mod units;
mod uses;

pub use arithmetic_error::ArithmeticError;
pub use axis_moves::{AXES_BESIDE, AxisMove, AxisMoves};
pub use code::Code;
pub use error::{Notice, ProgramError, Warning};
pub use flow_error::FlowError;
pub use language::Language;
pub use lines::LONGEST_LINE;
pub use machining_error::MachiningError;
pub use place::Place;
pub use poses::Poses;
pub use program::{MOST_WARNINGS, Program};
pub use reason::Reason;
pub use settings::{MOST_STEPS, MOST_STILL_STEPS, Settings};
pub use statement_error::StatementError;
pub use tools::{Tool, ToolTable, ToolTableError};
pub use units::FARTHEST;
