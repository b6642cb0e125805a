//! Names every reason why a run ends without a result, with its exit code.
//!
//! Not here: a verification that failed, which is a result.

use std::path::PathBuf;
use thiserror::Error;
use toolglide_fir::FirError;
use toolglide_kinematics::PlanError;
use toolglide_machines::MachineError;
use toolglide_program::ProgramError;
use toolglide_simulation::{DriveError, SimulationError};

/// Everything is done and inside the limits.
pub const DONE: u8 = 0;
/// Everything is done, but the motion breaks a limit.
pub const OUTSIDE: u8 = 1;
/// Wrong use or wrong input: there is no result.
pub const REFUSED: u8 = 2;
/// Ended by SIGINT, as from the keyboard, as shells count it.
pub const INTERRUPTED: u8 = 130;
/// Ended by SIGTERM, as shells count it.
pub const TERMINATED: u8 = 143;

/// Why a run ends without a result.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CliError {
    /// The machine is refused.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// The filters are refused.
    #[error("{asked}: {reason}")]
    Filters {
        /// Who asked for them: an option, or a field of a machine file.
        asked: String,
        /// What is wrong.
        reason: FirError,
    },
    /// An option has a value that it must not have.
    #[error("{option}: {value} was given, but {bound}")]
    Option {
        /// Which option.
        option: &'static str,
        /// What was given.
        value: String,
        /// What it must be.
        bound: String,
    },
    /// The drive of an axis is refused.
    #[error("{asked}: drive of axis {axis}: {reason}")]
    Drive {
        /// The machine, as it was asked for.
        asked: String,
        /// Letter of the axis.
        axis: char,
        /// What is wrong.
        reason: DriveError,
    },
    /// A simulation ends early.
    #[error("{program}: {reason}")]
    Simulation {
        /// The program.
        program: String,
        /// What is wrong, and when.
        reason: SimulationError,
    },
    /// A file cannot be read.
    #[error("{}: cannot be read: {reason}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
    /// A file cannot be written.
    #[error("{}: cannot be written: {reason}", file.display())]
    Write {
        /// The file.
        file: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
    /// A line of the program is refused.
    #[error("{program}:{line}: {reason}")]
    Line {
        /// The program.
        program: String,
        /// Line, counted from 1.
        line: u32,
        /// What is wrong.
        reason: String,
    },
    /// A row of set-points is refused.
    #[error("{}:{line}: {reason}", file.display())]
    Row {
        /// The file.
        file: PathBuf,
        /// Line, counted from 1; 0 when the file is empty.
        line: u64,
        /// What is wrong.
        reason: String,
    },
    /// Set-points are outside what is allowed so far that they cannot be judged further.
    #[error("{}:{line}: {reason}", file.display())]
    Outside {
        /// The file.
        file: PathBuf,
        /// Line, counted from 1.
        line: u64,
        /// What is wrong.
        reason: String,
    },
    /// The planner refuses a move.
    #[error("{program}:{line}: {reason}")]
    Plan {
        /// The program.
        program: String,
        /// Line, counted from 1.
        line: u32,
        /// What is wrong.
        reason: PlanError,
    },
    /// The program is refused; the reason names the place.
    #[error("{0}")]
    Program(Box<ProgramError>),
    /// The tool table is refused.
    #[error("{}: {reason}", file.display())]
    ToolTable {
        /// The file.
        file: PathBuf,
        /// What is wrong, and where.
        reason: toolglide_program::ToolTableError,
    },
    /// The plot cannot be drawn.
    #[error("{}: cannot be drawn: {reason}", file.display())]
    Plot {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A mode of vibration is refused.
    #[error("{asked}: {reason}")]
    Mode {
        /// Who named it: an option, or a field of the machine file.
        asked: String,
        /// What is wrong.
        reason: String,
    },
    /// The summary cannot be written as JSON.
    #[error("the summary cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// Whoever read our output has seen enough.
    #[error("the reader of the output has gone")]
    BrokenPipe,
}

impl CliError {
    /// Filters that are refused, with who asked for them.
    pub(crate) fn filters(asked: &str) -> impl Fn(FirError) -> Self {
        move |reason| Self::Filters {
            asked: asked.to_owned(),
            reason,
        }
    }

    /// A mode of vibration that is refused, with who named it.
    pub(crate) fn mode<E: std::fmt::Display>(asked: &str) -> impl Fn(E) -> Self {
        move |reason| Self::Mode {
            asked: asked.to_owned(),
            reason: reason.to_string(),
        }
    }

    /// A file that cannot be written; a reader that has gone is no fault of anybody.
    pub fn write(file: impl Into<PathBuf>, reason: std::io::Error) -> Self {
        if reason.kind() == std::io::ErrorKind::BrokenPipe {
            Self::BrokenPipe
        } else {
            Self::Write {
                file: file.into(),
                reason,
            }
        }
    }

    /// The exit code that says so.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::BrokenPipe => DONE,
            Self::Outside { .. } => OUTSIDE,
            _ => REFUSED,
        }
    }
}
