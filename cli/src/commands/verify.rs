//! Judges anyone's set-points against a program and the limits of a machine.
//!
//! The set-points are read twice: once to see whether they are sound and how finely they are
//! written, and once to judge them. The program is read alongside, some thousand moves ahead, so
//! that neither is ever held as a whole.

use crate::commands::plan::{moves, warn};
use crate::error::CliError;
use crate::input::args::VerifyArgs;
use crate::input::csv_reader::Table;
use crate::input::setup::Setup;
use crate::input::source::{Source, open_file};
use crate::input::travel::{OnAxes, by_axes};
use crate::output::files::same_file;
use crate::output::report::show;
use crate::output::summary::Summary;
use crate::pipeline::Moves;
use std::collections::VecDeque;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use toolglide_kinematics::{Move, Vector};
use toolglide_verify::{SetPointJudge, VerifyError};

/// Moves that are expected beyond what the motion can reach before the next set-point: a motion
/// within a wide tolerance may pass hundreds of short moves at once.
const MOVES_AHEAD: u32 = 4096;

/// Length of path that is expected, in lengths that the axes can go before the next set-point: a
/// path with many turns is longer than the motion that rounds them.
const LENGTHS_AHEAD: f64 = 8.0;

/// Runs the command.
pub(crate) fn verify(
    args: &VerifyArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    if crate::commands::poses::concerns(&args.job)? {
        return crate::commands::poses::verify(args, out, err);
    }
    let setup = Setup::new(&args.job, None)?;
    by_axes!(setup.axes.len(), run(args, &setup, out, err))
}

fn run<const N: usize>(
    args: &VerifyArgs,
    setup: &Setup,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError>
where
    Move<N>: OnAxes,
{
    let file = args.set_points.as_path();
    if same_file(file, &args.job.program) {
        return Err(CliError::Option {
            option: "SETPOINTS.csv",
            value: file.display().to_string(),
            bound: "this is the program".to_owned(),
        });
    }
    let source = Source::open(&args.job.program, args.job.dialect.as_deref())?;
    let name = source.name.clone();
    let resolution = resolution::<N>(file, setup)?;
    let judge = SetPointJudge::new(setup.start::<N>(), setup.limits(), resolution);
    let mut follower = Follower {
        moves: moves(&args.job, setup, source)?,
        judge,
        fastest: setup.limits::<N>().velocity().norm(),
        at: setup.start(),
        ends: VecDeque::new(),
        length: 0.0,
        first: 0,
        expected: 0,
        over: false,
    };
    let mut table = Table::open(file, open(file)?, &setup.axes)?;
    let mut rows = 0;
    let mut last = None;
    while let Some((time, position)) = table.row()? {
        follower.read_ahead(time - last.unwrap_or(time))?;
        follower
            .judge
            .observe(time, position)
            .map_err(|reason| refusal(&table, &reason))?;
        last = Some(time);
        rows += 1;
    }
    follower.read_rest()?;
    let verdict = follower.judge.finish();
    warn(follower.moves.program.program(), err);
    let blocks = follower.moves.program.program().blocks();
    let mut summary = Summary::of(&name, setup, &verdict, blocks, rows);
    summary.set_points = Some(file.display().to_string());
    show(&summary, args.job.json, out, err)
}

/// What rounding may have changed in a coordinate: half a step of the finest number.
fn resolution<const N: usize>(file: &Path, setup: &Setup) -> Result<f64, CliError> {
    let mut table = Table::<_, N>::open(file, open(file)?, &setup.axes)?;
    while table.row()?.is_some() {}
    Ok(0.5 * table.resolution())
}

fn open(file: &Path) -> Result<BufReader<File>, CliError> {
    let (opened, length) = open_file(file)?;
    if length.is_none() {
        return Err(CliError::Read {
            file: file.to_owned(),
            reason: std::io::Error::other("it is read twice, so it must be a regular file"),
        });
    }
    Ok(BufReader::with_capacity(1 << 16, opened))
}

/// A motion that does not begin where the program does is outside; anything else is no motion.
fn refusal<R: BufRead, const N: usize>(table: &Table<R, N>, reason: &VerifyError) -> CliError {
    match reason {
        VerifyError::NotAtStart { distance } => table.outside(format!(
            "the motion starts {distance} mm from the start of the path; --start says where that is"
        )),
        other => table.refuse(other.to_string()),
    }
}

/// The program, read as far ahead of the motion as it must be known.
struct Follower<R, const N: usize> {
    moves: Moves<R, N>,
    judge: SetPointJudge<N>,
    /// Largest speed of all axes together.
    fastest: f64,
    at: Vector<N>,
    /// Length of the path at the end of each move from `first` on.
    ends: VecDeque<f64>,
    length: f64,
    first: u32,
    expected: u32,
    over: bool,
}

impl<R: BufRead, const N: usize> Follower<R, N>
where
    Move<N>: OnAxes,
{
    /// Reads as far as the motion may come in a time, and some moves more.
    fn read_ahead(&mut self, time: f64) -> Result<(), CliError> {
        let reached = self.judge.reached();
        let mut begin = None;
        while self.first < reached
            && let Some(end) = self.ends.pop_front()
        {
            begin = Some(end);
            self.first += 1;
        }
        let begin = begin.or(self.ends.front().copied()).unwrap_or(0.0);
        let needed = begin + LENGTHS_AHEAD * self.fastest * time;
        while !self.over && (self.length < needed || self.expected < reached + MOVES_AHEAD) {
            self.read()?;
        }
        Ok(())
    }

    /// Reads the program to its end.
    fn read_rest(&mut self) -> Result<(), CliError> {
        while !self.over {
            self.read()?;
        }
        Ok(())
    }

    fn read(&mut self) -> Result<(), CliError> {
        let Some(next) = self.moves.next()? else {
            self.over = true;
            return Ok(());
        };
        self.judge.expect(&next).map_err(|reason| CliError::Line {
            program: self.moves.name.clone(),
            line: next.line(),
            reason: reason.to_string(),
        })?;
        self.length += next.length(self.at);
        self.at = next.end(self.at);
        self.ends.push_back(self.length);
        self.expected = self.expected.saturating_add(1);
        Ok(())
    }
}
