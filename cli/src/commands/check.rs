//! Reads a program only, and shows every error and its place.
//!
//! Errors look as those of rustc: the line, and a caret under the word. Not here: the language.

use crate::error::{CliError, DONE, REFUSED};
use crate::input::args::CheckArgs;
use crate::input::source::{Source, poses_with_parameters, subroutines, tools, with_parameters};
use crate::output::program_report::{Remark, Survey};
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet, Title};
use std::io::{BufRead, Write};
use toolglide_kinematics::Tolerance;
use toolglide_program::{Language, Place, Poses, Program, ProgramError, Reason, Settings, Warning};

/// Errors that are shown; of more, only the number is told.
const MAX_ERRORS: usize = 100;

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
    let source = Source::open(&args.program, args.dialect.as_deref())?;
    let language = source.language;
    let mut seen = Seen {
        survey: Survey {
            program: source.name.clone(),
            dialect: language.name(),
            ..Survey::default()
        },
        err,
        quiet: args.json,
    };
    if matches!(
        language,
        Language::Ngc | Language::Fanuc | Language::Printer
    ) {
        let program = Program::new(source.reader, &source.name, settings)
            .in_language(language)
            .with_tools(tools)
            .with_subroutines(subroutines(&args.program))
            .with_rotary_axes()
            .with_secondary_axes()
            .past_refusals();
        seen.read(with_parameters(program, &args.parameters)?)?;
    } else {
        let poses = Poses::new(source.reader, &source.name, settings, language)
            .with_tools(tools)
            .with_subroutines(subroutines(&args.program))
            .past_refusals();
        seen.read_poses(poses_with_parameters(poses, &args.parameters)?)?;
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
}

impl Seen<'_> {
    fn read<R: BufRead>(&mut self, mut program: Program<R>) -> Result<(), CliError> {
        while let Some(next) = program.next() {
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
        survey.filament_mm = program.filament();
        survey.warnings = program.warnings().iter().map(Remark::of_warning).collect();
        survey.more_warnings = program.more_warnings();
        self.finish(program.warnings());
        Ok(())
    }

    fn read_poses<R: BufRead>(&mut self, mut poses: Poses<R>) -> Result<(), CliError> {
        while let Some(next) = poses.next() {
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
        self.finish(poses.warnings());
        Ok(())
    }

    /// Keeps and shows a refusal, unless it follows from one before it or says the same.
    fn refuse(&mut self, error: &ProgramError, line: &str) {
        if error.is_consequence() {
            self.survey.consequences += 1;
            return;
        }
        let remark = Remark::of_error(error);
        let alike = |other: &&mut Remark| other.is_like(&remark, says_all(error.reason()));
        if let Some(other) = self.survey.errors.iter_mut().find(alike) {
            other.again(remark.line);
            return;
        }
        if self.survey.errors.len() >= MAX_ERRORS {
            self.survey.more_errors += 1;
            return;
        }
        self.survey.errors.push(remark);
        if !self.quiet {
            let title = Level::ERROR.primary_title(error.reason().to_string());
            let _ = writeln!(self.err, "{}\n", shown(title, error.place(), line));
        }
    }

    fn finish(&mut self, warnings: &[Warning]) {
        if self.quiet {
            return;
        }
        for (remark, warning) in self.survey.warnings.iter().zip(warnings) {
            let message = remark.message.clone();
            let title = Level::WARNING.primary_title(message);
            let text = shown(title, warning.place(), warning.line_text());
            let _ = writeln!(self.err, "{text}\n");
        }
        for error in &self.survey.errors {
            if let Some(more) = error.more() {
                let _ = writeln!(self.err, "{more}");
            }
        }
        match self.survey.consequences {
            0 => {}
            1 => {
                let _ = writeln!(self.err, "and 1 refusal that may follow from these");
            }
            more => {
                let _ = writeln!(self.err, "and {more} refusals that may follow from these");
            }
        }
        if self.survey.more_warnings > 0 {
            let _ = writeln!(self.err, "and {} more warnings", self.survey.more_warnings);
        }
        if self.survey.more_errors > 0 {
            let _ = writeln!(self.err, "and {} more errors", self.survey.more_errors);
        }
    }
}

/// Whether the message of a refusal says all that there is to know of it, so that once is enough.
fn says_all(reason: &Reason) -> bool {
    matches!(
        reason,
        Reason::NoSuchAxis { .. }
            | Reason::NotSupported { .. }
            | Reason::UnknownCode { .. }
            | Reason::UnknownWord { .. }
            | Reason::NoFeedrate
            | Reason::NoInverseTime
    )
}

/// A refusal or a warning with its line and a caret.
fn shown(title: Title<'_>, place: &Place, line: &str) -> String {
    let byte = |characters: u32| {
        let index = characters as usize;
        line.char_indices()
            .nth(index)
            .map_or(line.len(), |(at, _)| at)
    };
    let first = place.column().saturating_sub(1);
    let (start, end) = (byte(first), byte(first.saturating_add(place.length())));
    let number = usize::try_from(place.line()).unwrap_or(usize::MAX);
    let report = [title.element(
        Snippet::source(line)
            .line_start(number)
            .path(place.file())
            .annotation(AnnotationKind::Primary.span(start..end)),
    )];
    Renderer::plain().render(&report)
}
