//! Writes the motions of a run as one HTML page that opens from disk.
//!
//! Not here: what the page shows, which is the crate `toolglide-report`.

use crate::commands::plan::title;
use crate::error::CliError;
use crate::input::args::JobArgs;
use crate::input::setup::Setup;
use crate::output::files::OutputFile;
use crate::output::output_files::inputs;
use crate::output::summary::unit;
use std::io::{BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use toolglide_kinematics::{Limits, Move, Piece, Vector};
use toolglide_report::{AxisInfo, Motion, MotionRecorder, Page, PathRecorder};
use toolglide_verify::Report;

/// Most bytes of a program that a page holds.
const MAX_PROGRAM: u64 = 64 << 20;

/// Path and motions while they stream past.
#[derive(Debug)]
pub(crate) struct Recording<const N: usize> {
    path: PathRecorder<N>,
    motions: Vec<MotionRecorder<N>>,
    limits: Limits<N>,
}

impl<const N: usize> Recording<N> {
    /// Nothing yet of so many motions.
    pub(crate) fn new(start: Vector<N>, limits: Limits<N>, motions: usize) -> Self {
        Self {
            path: PathRecorder::starting_at(start),
            motions: (0..motions).map(|_| MotionRecorder::new(limits)).collect(),
            limits,
        }
    }

    /// Takes the next moves.
    pub(crate) fn expect(&mut self, batch: &[Move<N>]) {
        batch.iter().for_each(|next| self.path.expect(next));
    }

    /// Takes the next piece of a motion, and its largest distance from the path.
    pub(crate) fn observe(&mut self, motion: usize, piece: &Piece<N>, deviation: f64) {
        if let Some(motion) = self.motions.get_mut(motion) {
            motion.observe(&self.path, piece, deviation);
        }
    }
}

/// A page to be written.
#[derive(Debug)]
pub(crate) struct PageFile {
    pub(crate) file: OutputFile,
    program: PathBuf,
}

impl PageFile {
    /// Begins the page that was asked for, if any.
    pub(crate) fn begin(page: Option<&Path>, job: &JobArgs) -> Result<Option<Self>, CliError> {
        page.map(|path| {
            let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
            if !matches!(
                ending.as_ref().and_then(|ending| ending.to_str()),
                Some("html" | "htm")
            ) {
                return Err(CliError::Option {
                    option: "--report",
                    value: path.display().to_string(),
                    bound: "its name must end in .html".to_owned(),
                });
            }
            Ok(Self {
                file: OutputFile::begin(path, &inputs(job))?,
                program: job.program.clone(),
            })
        })
        .transpose()
    }

    /// Writes the motions of some methods, each with its name and the report of its judge.
    pub(crate) fn write<'a, const N: usize>(
        &mut self,
        name: &str,
        setup: &Setup,
        recording: Recording<N>,
        judged: impl IntoIterator<Item = (&'a str, &'a Report<N>)>,
    ) -> Result<(), CliError> {
        let motions: Vec<_> = recording
            .motions
            .into_iter()
            .zip(judged)
            .map(|(motion, (method, report))| finished(motion, method, report))
            .collect();
        let axes: Vec<_> = setup
            .axes
            .iter()
            .map(|axis| AxisInfo {
                name: axis.name,
                unit: unit(axis.kind),
            })
            .collect();
        let page = Page {
            title: &title(name),
            machine: &setup.machine,
            axes: &axes,
            limits: recording.limits,
            path: &recording.path,
            motions: &motions,
            program: &text_of(&self.program)?,
        };
        let path = self.file.path().to_owned();
        let mut out = BufWriter::new(&mut self.file);
        page.write(&mut out)
            .and_then(|()| out.flush())
            .map_err(|reason| CliError::write(path, reason))
    }
}

fn finished<const N: usize>(
    motion: MotionRecorder<N>,
    method: &str,
    report: &Report<N>,
) -> Motion<N> {
    let verdict = match report.violations {
        0 => "every limit and tolerance is kept".to_owned(),
        1 => "NOT ALLOWED: 1 violation".to_owned(),
        more => format!("NOT ALLOWED: {more} violations"),
    };
    let deviation = [report.deviation.value, report.deviation_ratio.value];
    motion.finish(method, report.passes(), &verdict, deviation)
}

/// The text of a program; none of standard input, which can be read only once.
fn text_of(program: &Path) -> Result<Vec<u8>, CliError> {
    let mut text = Vec::new();
    if std::fs::metadata(program).is_ok_and(|found| found.is_file()) {
        let (file, _) = crate::input::source::open_file(program)?;
        let read = file.take(MAX_PROGRAM).read_to_end(&mut text);
        read.map_err(|reason| CliError::Read {
            file: program.to_owned(),
            reason,
        })?;
    }
    Ok(text)
}
