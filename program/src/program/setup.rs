//! Sets a program up before its first line: tools, subroutines, axes, language.
//!
//! Not here: reading.

use crate::block::codes::Motion;
use crate::error::arithmetic::ArithmeticError;
use crate::fanuc::Fanuc;
use crate::flow::tape::Tape;
use crate::interpreter::tools::ToolTable;
use crate::poses::axis_moves::AxisMoves;
use crate::printer::Printer;
use crate::program::Program;
use crate::sinumerik::Sinumerik;
use crate::text::language::Language;
use std::io::BufRead;
use std::sync::Arc;

impl<R: BufRead> Program<R> {
    /// The same program, with the tools of the machine.
    #[must_use]
    pub fn with_tools(mut self, tools: ToolTable) -> Self {
        self.lowering.tools = tools;
        self
    }

    /// The same program, with `find` to give the text of a subroutine that stands in a file of its
    /// own, by its name without ending.
    #[must_use]
    pub fn with_subroutines(
        mut self,
        find: impl Fn(&str) -> std::io::Result<Option<Vec<u8>>> + Send + 'static,
    ) -> Self {
        self.find_subroutines(find);
        self
    }

    /// The same program, for a machine with rotary axes A, B and C: their words are read, as are the
    /// codes that make the tool tip the point that moves (`G43.4`, `M128`, `M428`).
    #[must_use]
    pub fn with_rotary_axes(mut self) -> Self {
        self.block.rotary = true;
        self
    }

    /// The same program, with the words of secondary axes U, V and W counted among its features. No
    /// machine moves them, so that this is for looking at a program only.
    #[must_use]
    pub fn with_secondary_axes(mut self) -> Self {
        self.block.secondary = true;
        self
    }

    /// The same program, as the moves of all axes of a machine that has `axes` beside X, Y and Z, in the order
    /// of [`AXES_BESIDE`](crate::AXES_BESIDE); they begin at `start`, degrees and mm.
    #[must_use]
    pub fn on_all_axes(mut self, axes: [bool; 6], start: [f64; 6]) -> AxisMoves<R> {
        self.lowering.others.at = start;
        self.block.beside = axes;
        AxisMoves::new(self)
    }

    /// The same program, for a machine of this name: refusals of axes that it has not name it.
    #[must_use]
    pub fn for_machine(mut self, name: &str) -> Self {
        self.block.machine = Arc::from(name);
        self
    }

    /// The same program, with the value of a parameter that only the machine or the operator knows, before
    /// its first line: a number with or without `#`, or a name with or without `#<` and `>`.
    ///
    /// # Errors
    /// [`ArithmeticError::BadName`] for what is no name, [`ArithmeticError::NoSuchParameter`],
    /// [`ArithmeticError::ReadOnly`] and [`ArithmeticError::Predefined`] for what cannot be set, and
    /// [`ArithmeticError::Overflow`] for a value that is not finite.
    ///
    /// # Examples
    /// ```
    /// use toolglide_kinematics::Tolerance;
    /// use toolglide_program::{Program, Settings};
    /// let text = "F#<_hal[cut.feed]>\nG1 X#31\n";
    /// let program = Program::new(text.as_bytes(), "a.ngc", Settings::new(Tolerance::new(0.01)?))
    ///     .with_parameter("_hal[cut.feed]", 1200.0)?
    ///     .with_parameter("#31", 7.0)?;
    /// let moves = program.collect::<Result<Vec<_>, _>>()?;
    /// assert_eq!(moves[0].feedrate().speed(), 20.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_parameter(mut self, name: &str, value: f64) -> Result<Self, ArithmeticError> {
        self.give_parameter(name, value)?;
        Ok(self)
    }

    pub(crate) fn give_parameter(&mut self, name: &str, value: f64) -> Result<(), ArithmeticError> {
        if !value.is_finite() {
            let function = "a given parameter";
            return Err(ArithmeticError::Overflow { function });
        }
        let number = name.trim_start_matches('#').parse();
        if let (Some(fanuc), Ok(number)) = (&mut self.fanuc, number) {
            return fanuc.give(number, value, &mut self.lowering);
        }
        self.lowering.give_parameter(name, value)
    }

    /// The same program, in a language of axis words: RS274/NGC, as without this, that of printers, FANUC, or Sinumerik.
    /// One that is [not read](Language::NotRead) is refused in its first line.
    #[must_use]
    pub fn in_language(mut self, language: Language) -> Self {
        let jumps = language == Language::Sinumerik;
        let fanuc = language == Language::Fanuc;
        self.sinumerik = jumps.then(Sinumerik::default);
        self.block.printer = language == Language::Printer;
        self.lowering.printer = self.block.printer.then(Printer::default);
        self.not_read = match language {
            Language::NotRead(name) => Some(name),
            _ => None,
        };
        self.lowering.leads_to_normal = jumps || fanuc;
        self.flow.tape = (jumps || fanuc).then(|| Tape::new(&self.flow.file));
        self.fanuc = fanuc.then(|| Box::new(Fanuc::new()));
        if fanuc {
            self.lowering.fanuc = true;
            // What is in force when such a control is turned on.
            self.lowering.modal.motion = Motion::Rapid;
            self.lowering.modal.return_to_start = true;
        }
        self
    }

    /// The same program, for a machine with these reference points: X Y Z in mm and A B C in degrees of the
    /// first one (`G28`), the second (`G30`), and those of `G30 P3` and `P4`.
    #[must_use]
    pub fn with_reference_points(mut self, points: &[[f64; 6]]) -> Self {
        self.set_reference_points(points);
        self
    }

    /// The same program, going on behind refused lines so that all refusals are seen. What it yields
    /// after the first of them is not what the program says.
    #[must_use]
    pub fn past_refusals(mut self) -> Self {
        self.past_refusals = true;
        self
    }

    pub(crate) fn find_subroutines(
        &mut self,
        find: impl Fn(&str) -> std::io::Result<Option<Vec<u8>>> + Send + 'static,
    ) {
        self.flow.find = Some(Box::new(find));
    }

    pub(crate) fn set_reference_points(&mut self, points: &[[f64; 6]]) {
        for (first, point) in [5161, 5181].into_iter().zip(points) {
            for (number, &value) in (first..).zip(&point[..3]) {
                self.lowering.parameters.put(number, value);
            }
        }
        self.lowering.references = points.to_vec();
    }

    pub(crate) fn set_past_refusals(&mut self) {
        self.past_refusals = true;
    }
}
