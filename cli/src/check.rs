//! `toolglide check`: reads a program only, and shows everything that is wrong with it.
//!
//! Errors look as those of rustc: the line, and a caret under the word. Not here: the language.

use crate::args::CheckArgs;
use crate::error::{CliError, DONE, REFUSED};
use crate::interrupt::check_interrupt;
use crate::source::{Source, subroutines, tools};
use crate::survey::{Remark, Survey};
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::io::{BufRead, Write};
use toolglide_kinematics::Tolerance;
use toolglide_program::{Language, Poses, Program, ProgramError, Settings};

/// Errors that are shown; of more, only the number is told.
const MOST_ERRORS: usize = 100;

/// Moves between two looks at the keyboard.
const BATCH: u64 = 4096;

/// Reads a program, and tells what it holds and what is wrong with it.
pub(crate) fn check(
    args: &CheckArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let tools = tools(args.tool_table.as_deref())?;
    let tolerance = Tolerance::new(args.tolerance).map_err(|reason| CliError::Option {
        option: "--tolerance",
        value: args.tolerance.to_string(),
        bound: reason.to_string(),
    })?;
    let settings = Settings {
        lenient: args.lenient,
        ..Settings::new(tolerance)
    };
    let mut source = Source::open(&args.program)?;
    let language = match args.dialect.as_deref().and_then(Language::named) {
        Some(language) => language,
        None => {
            let beginning = source.reader.fill_buf().map_err(|reason| CliError::Read {
                file: args.program.clone(),
                reason,
            })?;
            Language::of(&args.program, beginning)
        }
    };
    let mut seen = Seen {
        survey: Survey {
            program: source.name.clone(),
            dialect: language.name(),
            ..Survey::default()
        },
        err,
        quiet: args.json,
        count: 0,
    };
    if language == Language::Ngc {
        let program = Program::new(source.reader, &source.name, settings)
            .with_tools(tools)
            .with_subroutines(subroutines(&args.program))
            .with_rotary_axes()
            .past_refusals();
        seen.read(program)?;
    } else {
        let poses = Poses::new(source.reader, &source.name, settings, language)
            .with_tools(tools)
            .past_refusals();
        seen.read_poses(poses)?;
    }
    let survey = seen.survey;
    let text = if args.json {
        serde_json::to_string_pretty(&survey)? + "\n"
    } else {
        survey.text()
    };
    out.write_all(text.as_bytes())
        .map_err(|reason| CliError::write("standard output", reason))?;
    Ok(if survey.errors.is_empty() {
        DONE
    } else {
        REFUSED
    })
}

/// What was seen so far.
struct Seen<'a> {
    survey: Survey,
    err: &'a mut dyn Write,
    /// Whether errors are told in the JSON object only.
    quiet: bool,
    count: u64,
}

impl Seen<'_> {
    fn read<R: BufRead>(&mut self, mut program: Program<R>) -> Result<(), CliError> {
        while let Some(next) = program.next() {
            self.pause()?;
            match next {
                Ok(step) => self.survey.meet(&step),
                Err(error) => self.refuse(&error, &program.line_text()),
            }
        }
        let survey = &mut self.survey;
        survey.lines = program.lines();
        survey.blocks = program.blocks();
        survey.tools = program.tools_used().collect();
        survey.name_codes(program.codes());
        survey.features = program.features().map(str::to_owned).collect();
        survey.warnings = program.warnings().iter().map(Remark::of_warning).collect();
        survey.more_warnings = program.more_warnings();
        self.show_warnings();
        Ok(())
    }

    fn read_poses<R: BufRead>(&mut self, mut poses: Poses<R>) -> Result<(), CliError> {
        while let Some(next) = poses.next() {
            self.pause()?;
            match next {
                Ok(step) => self.survey.meet_pose(&step),
                Err(error) => self.refuse(&error, &poses.line_text()),
            }
        }
        let survey = &mut self.survey;
        survey.lines = poses.lines();
        survey.blocks = poses.blocks();
        survey.tools = poses.tools_used();
        survey.name_codes(poses.codes().into_iter());
        survey.warnings = poses.warnings().iter().map(Remark::of_warning).collect();
        survey.more_warnings = poses.more_warnings();
        self.show_warnings();
        Ok(())
    }

    fn pause(&mut self) -> Result<(), CliError> {
        self.count += 1;
        if self.count.is_multiple_of(BATCH) {
            check_interrupt()?;
        }
        Ok(())
    }

    /// Keeps and shows a refusal.
    fn refuse(&mut self, error: &ProgramError, line: &str) {
        if self.survey.errors.len() >= MOST_ERRORS {
            self.survey.more_errors += 1;
            return;
        }
        self.survey.errors.push(Remark::of_error(error));
        if !self.quiet {
            let _ = writeln!(self.err, "{}\n", shown(error, line));
        }
    }

    fn show_warnings(&mut self) {
        if self.quiet {
            return;
        }
        for warning in &self.survey.warnings {
            let place = format!("{}:{}:{}", warning.file, warning.line, warning.column);
            let _ = writeln!(self.err, "warning: {place}: {}", warning.message);
        }
        if self.survey.more_warnings > 0 {
            let _ = writeln!(self.err, "and {} more warnings", self.survey.more_warnings);
        }
        if self.survey.more_errors > 0 {
            let _ = writeln!(self.err, "and {} more errors", self.survey.more_errors);
        }
    }
}

/// A refusal with its line and a caret.
fn shown(error: &ProgramError, line: &str) -> String {
    let byte = |characters: u32| {
        let index = characters as usize;
        line.char_indices()
            .nth(index)
            .map_or(line.len(), |(at, _)| at)
    };
    let first = error.column().saturating_sub(1);
    let (start, end) = (byte(first), byte(first.saturating_add(error.length())));
    let number = usize::try_from(error.line()).unwrap_or(usize::MAX);
    let message = error.reason().to_string();
    let report = [Level::ERROR.primary_title(message).element(
        Snippet::source(line)
            .line_start(number)
            .path(error.file())
            .annotation(AnnotationKind::Primary.span(start..end)),
    )];
    Renderer::plain().render(&report)
}
