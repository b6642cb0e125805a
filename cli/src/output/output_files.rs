//! Begins the files of a run before anything is planned and names them when all is done.

use crate::error::CliError;
use crate::input::args::{JobArgs, PlanArgs};
use crate::output::csv_writer::Destination;
use crate::output::files::{OutputFile, same_file};
use crate::output::page::PageFile;
use crate::plot::Picture;
use std::io::Write;
use std::path::Path;

/// A picture to be drawn.
#[derive(Debug)]
pub(crate) struct Drawing {
    picture: Picture,
    file: OutputFile,
}

impl Drawing {
    /// Begins the picture that was asked for, if any.
    pub(crate) fn begin(plot: Option<&Path>, job: &JobArgs) -> Result<Option<Self>, CliError> {
        plot.map(|path| {
            Ok(Self {
                picture: Picture::of(path)?,
                file: OutputFile::begin(path, &inputs(job))?,
            })
        })
        .transpose()
    }

    /// Writes it, given as SVG text.
    pub(crate) fn write(&mut self, svg: &str) -> Result<(), CliError> {
        self.picture.write(svg, &mut self.file)
    }

    /// Gives the complete file its name.
    pub(crate) fn commit(self) -> Result<(), CliError> {
        OutputFile::commit([self.file])
    }
}

/// Where the set-points of a plan go.
#[derive(Debug)]
pub(crate) struct RowsFile {
    file: Option<OutputFile>,
    to_stdout: bool,
}

impl RowsFile {
    /// What takes the rows; nothing unless they were asked for.
    pub(crate) fn destination<'a>(&'a mut self, out: &'a mut dyn Write) -> Option<Destination<'a>> {
        match &mut self.file {
            Some(file) => {
                let name = file.path().to_owned();
                Some(Destination { sink: file, name })
            }
            None if self.to_stdout => Some(Destination {
                sink: out,
                name: "standard output".into(),
            }),
            None => None,
        }
    }
}

/// Set-points and picture of one plan.
#[derive(Debug)]
pub(crate) struct PlanFiles {
    /// The set-points.
    pub(crate) rows: RowsFile,
    /// The picture, if one was asked for.
    pub(crate) drawing: Option<Drawing>,
    /// The page, if one was asked for.
    pub(crate) page: Option<PageFile>,
}

impl PlanFiles {
    /// Begins the files of a run, none of which may be another of them.
    pub(crate) fn begin(args: &PlanArgs) -> Result<Self, CliError> {
        Self::begin_for(
            args.output.as_deref(),
            args.plot.as_deref(),
            args.report.as_deref(),
            &args.job,
        )
    }

    /// The same from what was asked for, each by itself.
    pub(crate) fn begin_for(
        output: Option<&Path>,
        plot: Option<&Path>,
        page: Option<&Path>,
        job: &JobArgs,
    ) -> Result<Self, CliError> {
        let to_stdout = output == Some(Path::new("-"));
        if to_stdout && job.json {
            return Err(CliError::Option {
                option: "--json",
                value: "with -o -".to_owned(),
                bound: "only one of them can have standard output".to_owned(),
            });
        }
        let rows = output.filter(|_| !to_stdout);
        if let (Some(rows), Some(plot)) = (rows, plot)
            && same_file(rows, plot)
        {
            return Err(CliError::Option {
                option: "--plot",
                value: plot.display().to_string(),
                bound: "the set-points are written there".to_owned(),
            });
        }
        if let Some(page) = page {
            for other in [rows, plot].into_iter().flatten() {
                if same_file(page, other) {
                    return Err(CliError::Option {
                        option: "--report",
                        value: page.display().to_string(),
                        bound: "another file of this run is written there".to_owned(),
                    });
                }
            }
        }
        Ok(Self {
            rows: RowsFile {
                file: rows
                    .map(|path| OutputFile::begin(path, &inputs(job)))
                    .transpose()?,
                to_stdout,
            },
            drawing: Drawing::begin(plot, job)?,
            page: PageFile::begin(page, job)?,
        })
    }

    /// Gives the complete files their names. Says whether the rows have standard output to themselves.
    pub(crate) fn commit(self) -> Result<bool, CliError> {
        let drawing = self.drawing.map(|drawing| drawing.file);
        let page = self.page.map(|page| page.file);
        OutputFile::commit(self.rows.file.into_iter().chain(drawing).chain(page))?;
        Ok(self.rows.to_stdout)
    }
}

/// What a run reads, which must not be written over.
pub(crate) fn inputs(job: &JobArgs) -> Vec<&Path> {
    let read = [job.program.as_path(), Path::new(&job.machine)];
    read.into_iter().chain(job.tool_table.as_deref()).collect()
}
