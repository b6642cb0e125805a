//! Reads part programs into a stream of moves or of tool poses.
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

mod apt;
mod asides;
mod block;
mod compensation;
mod curves;
mod cycles;
mod error;
mod expression;
mod fanuc;
mod flow;
mod interpreter;
mod poses;
mod printer;
mod program;
mod settings;
mod sinumerik;
mod sinumerik_ways;
mod text;

pub use block::code::Code;
pub use error::arithmetic::ArithmeticError;
pub use error::flow::FlowError;
pub use error::machining::MachiningError;
pub use error::reason::Reason;
pub use error::statement::StatementError;
pub use error::{Notice, ProgramError, Warning};
pub use interpreter::tools::{Tool, ToolTable, ToolTableError};
pub use interpreter::units::FARTHEST;
pub use poses::Poses;
pub use poses::axis_moves::{AXES_BESIDE, AxisMove, AxisMoves};
pub use program::{MAX_WARNINGS, Program};
pub use settings::{MAX_STEPS, MAX_STILL_STEPS, Settings};
pub use text::language::Language;
pub use text::lines::LONGEST_LINE;
pub use text::place::Place;
