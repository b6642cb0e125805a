//! Streams programs for machines with rotary axes as tool poses.
//!
//! Not here: the languages, and what a pose means on a machine.

pub(crate) mod axis_moves;
pub(crate) mod axis_words;

use crate::apt::CutterLocations;
use crate::block::code::Code;
use crate::error::arithmetic::ArithmeticError;
use crate::error::{ProgramError, Warning};
use crate::interpreter::tools::ToolTable;
use crate::program::Program;
use crate::settings::Settings;
use crate::text::language::Language;
use axis_words::AxisWords;
use std::io::BufRead;
use toolglide_kinematics::PoseMove;

/// Reads a program and yields the moves of the tool in the workpiece, or of all axes, in order.
///
/// Arcs come as chords within a tenth of the tolerance, and their moves keep the rest of it.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{PoseEnd, Tolerance};
/// use toolglide_program::{Language, Poses, Settings};
/// let text = "UNITS/MM\nFEDRAT/600,MMPM\nGOTO/1,2,3,0,0.6,0.8\nFINI\n";
/// let settings = Settings::new(Tolerance::new(0.01)?);
/// let poses = Poses::new(text.as_bytes(), "a.apt", settings, Language::CutterLocations);
/// let moves = poses.collect::<Result<Vec<_>, _>>()?;
/// let PoseEnd::Pose(pose) = moves[0].end() else { panic!("a pose") };
/// assert_eq!(pose.tip()[2], 3.0);
/// assert_eq!(moves[0].line(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Poses<R> {
    source: Source<R>,
}

#[derive(Debug)]
enum Source<R> {
    Axes(Box<AxisWords<R>>),
    Locations(Box<CutterLocations<R>>),
}

impl<R: BufRead> Poses<R> {
    /// A program read from `reader` in a language; messages call it `file`.
    pub fn new(reader: R, file: &str, settings: Settings, language: Language) -> Self {
        let source = match language {
            Language::CutterLocations => {
                Source::Locations(Box::new(CutterLocations::new(reader, file, settings)))
            }
            Language::Sinumerik
            | Language::Fanuc
            | Language::Ngc
            | Language::Printer
            | Language::NotRead(_) => {
                let program = Program::new(reader, file, settings).in_language(language);
                Source::Axes(Box::new(AxisWords::new(program)))
            }
        };
        Self { source }
    }

    /// The same program, with the tools of the machine.
    #[must_use]
    pub fn with_tools(mut self, tools: ToolTable) -> Self {
        if let Source::Axes(axes) = &mut self.source {
            axes.program.lowering.tools = tools;
        }
        self
    }

    /// The same program, with files of subroutines, as [`Program::with_subroutines`].
    #[must_use]
    pub fn with_subroutines(
        mut self,
        find: impl Fn(&str) -> std::io::Result<Option<Vec<u8>>> + Send + 'static,
    ) -> Self {
        if let Source::Axes(axes) = &mut self.source {
            axes.program.find_subroutines(find);
        }
        self
    }

    /// The same program, for a machine with these reference points, as
    /// [`Program::with_reference_points`].
    #[must_use]
    pub fn with_reference_points(mut self, points: &[[f64; 6]]) -> Self {
        if let Source::Axes(axes) = &mut self.source {
            axes.program.set_reference_points(points);
        }
        self
    }

    /// The same program, with the value of a parameter, as [`Program::with_parameter`]; cutter location
    /// files have none.
    ///
    /// # Errors
    /// Those of [`Program::with_parameter`].
    pub fn with_parameter(mut self, name: &str, value: f64) -> Result<Self, ArithmeticError> {
        if let Source::Axes(axes) = &mut self.source {
            axes.program.give_parameter(name, value)?;
        }
        Ok(self)
    }

    /// The same program, for a machine of this name, as [`Program::for_machine`].
    #[must_use]
    pub fn for_machine(mut self, name: &str) -> Self {
        if let Source::Axes(axes) = &mut self.source {
            axes.program.block.machine = name.into();
        }
        self
    }

    /// The same program, going on behind refused lines, as [`Program::past_refusals`].
    #[must_use]
    pub fn past_refusals(mut self) -> Self {
        match &mut self.source {
            Source::Axes(axes) => axes.program.set_past_refusals(),
            Source::Locations(locations) => locations.past_refusals = true,
        }
        self
    }

    /// What should be known of the lines read so far, as [`Program::warnings`].
    #[must_use]
    pub fn warnings(&self) -> &[Warning] {
        match &self.source {
            Source::Axes(axes) => axes.program.warnings(),
            Source::Locations(locations) => &locations.warnings,
        }
    }

    /// How many warnings came after those that are kept.
    #[must_use]
    pub fn more_warnings(&self) -> u64 {
        match &self.source {
            Source::Axes(axes) => axes.program.more_warnings(),
            Source::Locations(locations) => locations.more_warnings,
        }
    }

    /// Lines with at least one word, or statements, read so far.
    #[must_use]
    pub fn blocks(&self) -> u64 {
        match &self.source {
            Source::Axes(axes) => axes.program.blocks(),
            Source::Locations(locations) => locations.statements,
        }
    }

    /// Lines read so far.
    #[must_use]
    pub fn lines(&self) -> u64 {
        match &self.source {
            Source::Axes(axes) => axes.program.lines(),
            Source::Locations(locations) => locations.lines(),
        }
    }

    /// `G` and `M` codes met so far, in order, and how often each.
    #[must_use]
    pub fn codes(&self) -> Vec<(Code, u64)> {
        match &self.source {
            Source::Axes(axes) => axes.program.codes().collect(),
            Source::Locations(_) => Vec::new(),
        }
    }

    /// Tools that were asked for so far, in order of their numbers.
    #[must_use]
    pub fn tools_used(&self) -> Vec<u32> {
        match &self.source {
            Source::Axes(axes) => axes.program.tools_used().collect(),
            Source::Locations(locations) => locations.tools_used.iter().copied().collect(),
        }
    }

    /// The line that the last refusal or the last moves came from.
    #[must_use]
    pub fn line_text(&self) -> std::borrow::Cow<'_, str> {
        match &self.source {
            Source::Axes(axes) => axes.program.line_text(),
            Source::Locations(locations) => locations.line_text(),
        }
    }
}

impl<R: BufRead> Iterator for Poses<R> {
    type Item = Result<PoseMove, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        match &mut self.source {
            Source::Axes(axes) => axes.next(),
            Source::Locations(locations) => locations.next(),
        }
    }
}
