//! Executes O words: conditions, loops, subroutines.
//!
//! Source: the chapter on O codes of the manual of LinuxCNC. A subroutine stands above its calls, in a file
//! of its name, or further below, in this order. Not here: how lines are read and remembered.

use crate::error::Fault;
use crate::error::flow::FlowError;
use crate::expression::parameters::{DEEPEST_CALL, LOCAL_PARAMETERS};
use crate::flow::control::{Control, Keyword, Label, control, o_word};
use crate::flow::definitions::Definitions;
use crate::flow::recording::{LONGEST_RECORDING, Recording};
use crate::flow::{Call, Flow, Open};
use crate::interpreter::Interpreter;
use std::io::BufRead;
use std::sync::Arc;

/// Most repetitions of a loop: beyond this a float no longer counts.
const MAX_REPETITIONS: f64 = 1e15;

impl<R: BufRead> Flow<R> {
    /// Obeys the O word at `at` of the line being run; false for the mere number of a program.
    pub(crate) fn obey(&mut self, at: usize, state: &mut Interpreter) -> Result<bool, Fault> {
        let Some(control) = control(self.text(), at, state)? else {
            return Ok(false);
        };
        match control.keyword {
            Keyword::Sub => self.define(&control)?,
            Keyword::Call => self.call(&control, state)?,
            Keyword::EndSub | Keyword::Return => self.leave_subroutine(&control, state)?,
            Keyword::If => self.condition(control, state)?,
            Keyword::ElseIf | Keyword::Else => {
                // The branch before this one was taken.
                self.close(&control, &[Keyword::If], "IF")?;
                self.skip(&control, &[Keyword::EndIf], "ENDIF")?;
            }
            Keyword::EndIf => {
                self.close(&control, &[Keyword::If], "IF")?;
            }
            Keyword::While => self.while_loop(&control, state)?,
            Keyword::EndWhile => {
                let open = self.close(&control, &[Keyword::While], "WHILE")?;
                self.jump_to(open.start);
            }
            Keyword::Do => {
                if !self.frames.is_empty() || !self.remember(&control, Keyword::While)? {
                    self.begin(&control, Keyword::Do, 0.0);
                }
            }
            Keyword::Repeat => self.repeat(&control, state)?,
            Keyword::EndRepeat => {
                let mut open = self.close(&control, &[Keyword::Repeat], "REPEAT")?;
                open.left -= 1.0;
                if open.left > 0.0 {
                    self.jump_to(open.start + 1);
                    self.open().push(open);
                }
            }
            Keyword::Break | Keyword::Continue => self.break_or_continue(&control)?,
        }
        Ok(true)
    }

    /// Loops of the file itself are remembered and run from memory.
    fn remember(&mut self, control: &Control, end: Keyword) -> Result<bool, Fault> {
        let recording = self.record(control, true, end)?;
        self.run(recording, Call::None);
        Ok(true)
    }

    fn define(&mut self, control: &Control) -> Result<(), Fault> {
        if self.depth() > 0 {
            return Err(control.fault(FlowError::NestedSubroutine));
        }
        if let Some(other) = self.subroutines.get(&control.label) {
            // A loop comes by the same lines again.
            let line = other.number(0).saturating_sub(1);
            let here = self.place(control.span);
            if here.line() != line || here.file() != &*other.file {
                let label = control.label.to_string().into();
                return Err(control.fault(FlowError::DefinedTwice { label, line }));
            }
        }
        let recording = self.record(control, false, Keyword::EndSub)?;
        self.subroutines.insert(control.label.clone(), recording);
        Ok(())
    }

    fn call(&mut self, control: &Control, state: &mut Interpreter) -> Result<(), Fault> {
        let mut arguments = Vec::new();
        control.arguments(self.text(), state, &mut arguments)?;
        let (given, bound) = (arguments.len(), LOCAL_PARAMETERS);
        if given > bound {
            return Err(control.fault(FlowError::TooManyArguments { given, bound }));
        }
        if self.depth() >= DEEPEST_CALL {
            let bound = DEEPEST_CALL;
            return Err(control.fault(FlowError::TooDeep { bound }));
        }
        if !self.subroutines.contains_key(&control.label) {
            self.load(control)?;
        }
        if !self.subroutines.contains_key(&control.label) {
            self.find_below(control)?;
        }
        let Some(recording) = self.subroutines.get(&control.label).map(Arc::clone) else {
            let label = control.label.to_string().into();
            return Err(control.fault(FlowError::NoSubroutine { label }));
        };
        state.enter(&arguments);
        self.run(recording, Call::Subroutine);
        Ok(())
    }

    /// Looks for the subroutine in the rest of the program.
    fn find_below(&mut self, control: &Control) -> Result<(), Fault> {
        let because = |reason| control.because(reason);
        let rest = Arc::clone(&self.rest().map_err(because)?.recording);
        let mut definitions = Definitions::of(&rest.file, None);
        for index in 0..rest.len() {
            if !definitions.take(rest.line(index), rest.number(index)) {
                let bound = LONGEST_RECORDING;
                return Err(control.fault(FlowError::TooLong { bound }));
            }
        }
        // One whose end is missing is refused where it stands.
        for (label, lines) in definitions.finish().unwrap_or_default() {
            self.know(label, lines);
        }
        Ok(())
    }

    fn know(&mut self, label: Label, lines: Recording) {
        let place = self.subroutines.entry(label);
        place.or_insert_with(|| Arc::new(lines));
    }

    /// Looks for a file with the subroutine, and takes all subroutines of it.
    fn load(&mut self, control: &Control) -> Result<(), Fault> {
        let name = control.label.file();
        let bad = |message: String| {
            control.fault(FlowError::BadFile {
                label: control.label.to_string().into(),
                message: message.into(),
            })
        };
        let Some(find) = &self.find else {
            return Ok(());
        };
        let text = match find(&name) {
            Ok(Some(text)) => text,
            Ok(None) => return Ok(()),
            Err(error) => return Err(bad(format!("cannot be read: {error}"))),
        };
        let file: Arc<str> = Arc::from(format!("{name}.ngc"));
        let mut definitions = Definitions::of(&file, Some(self.line()));
        for (line, number) in text.split(|&byte| byte == b'\n').zip(1_u64..) {
            let line = line.strip_suffix(b"\r").unwrap_or(line);
            if !definitions.take(line, number) {
                return Err(bad("is too long".to_owned()));
            }
        }
        let found = definitions.finish();
        for (label, lines) in found.map_err(|label| bad(format!("has no ENDSUB of {label}")))? {
            self.know(label, lines);
        }
        Ok(())
    }

    fn leave_subroutine(
        &mut self,
        control: &Control,
        state: &mut Interpreter,
    ) -> Result<(), Fault> {
        let mut values = Vec::new();
        control.arguments(self.text(), state, &mut values)?;
        if !self.leave() {
            return Err(control.not_open("SUB"));
        }
        state.leave(values.first().copied());
        Ok(())
    }

    /// Takes the first branch whose condition holds.
    fn condition(&mut self, mut control: Control, state: &Interpreter) -> Result<(), Fault> {
        let first = control.clone();
        loop {
            let holds = control.argument(self.text(), state)? != 0.0;
            if holds {
                self.begin(&first, Keyword::If, 0.0);
                return Ok(());
            }
            let ends = [Keyword::ElseIf, Keyword::Else, Keyword::EndIf];
            match self.skip(&first, &ends, "ENDIF")? {
                Keyword::ElseIf => {
                    let line = self.text();
                    let next =
                        o_word(line).map(|at| crate::flow::control::control(line, at, state));
                    if let Some(Ok(Some(next))) = next {
                        control = next;
                    }
                }
                Keyword::Else => {
                    self.begin(&first, Keyword::If, 0.0);
                    return Ok(());
                }
                _ => return Ok(()),
            }
        }
    }

    /// A `while` is the head of a loop, or the foot of a `do`.
    fn while_loop(&mut self, control: &Control, state: &Interpreter) -> Result<(), Fault> {
        let foot = self
            .open()
            .last()
            .is_some_and(|open| open.keyword == Keyword::Do && open.label == control.label);
        if foot {
            let again = control.argument(self.text(), state)? != 0.0;
            let open = self.close(control, &[Keyword::Do], "DO")?;
            if again {
                self.jump_to(open.start + 1);
                self.open().push(open);
            }
            return Ok(());
        }
        if self.frames.is_empty() {
            return self.remember(control, Keyword::EndWhile).map(|_| ());
        }
        if control.argument(self.text(), state)? == 0.0 {
            self.skip(control, &[Keyword::EndWhile], "ENDWHILE")?;
        } else {
            self.begin(control, Keyword::While, 0.0);
        }
        Ok(())
    }

    fn repeat(&mut self, control: &Control, state: &Interpreter) -> Result<(), Fault> {
        if self.frames.is_empty() {
            return self.remember(control, Keyword::EndRepeat).map(|_| ());
        }
        let value = control.argument(self.text(), state)?.round();
        let most = MAX_REPETITIONS;
        if value > most {
            return Err(control.fault(FlowError::BadRepetitions { value, most }));
        }
        if value <= 0.0 {
            self.skip(control, &[Keyword::EndRepeat], "ENDREPEAT")?;
        } else {
            self.begin(control, Keyword::Repeat, value);
        }
        Ok(())
    }

    fn break_or_continue(&mut self, control: &Control) -> Result<(), Fault> {
        let loops = [Keyword::While, Keyword::Do, Keyword::Repeat];
        let open = self.close(control, &loops, "WHILE, DO or REPEAT")?;
        let (end, name) = match open.keyword {
            Keyword::While => (Keyword::EndWhile, "ENDWHILE"),
            Keyword::Do => (Keyword::While, "WHILE"),
            _ => (Keyword::EndRepeat, "ENDREPEAT"),
        };
        if control.keyword == Keyword::Break {
            self.skip(control, &[end], name)?;
        } else if open.keyword == Keyword::While {
            self.jump_to(open.start);
        } else {
            self.skip(control, &[end], name)?;
            // The end of the loop is the next line to be run.
            let end = self.index();
            self.jump_to(end);
            self.open().push(open);
        }
        Ok(())
    }

    fn begin(&mut self, control: &Control, keyword: Keyword, left: f64) {
        let open = Open {
            label: control.label.clone(),
            keyword,
            start: self.index(),
            left,
        };
        self.open().push(open);
    }

    /// Closes the innermost block of one of `keywords` with the label of `control`, and all inside.
    fn close(
        &mut self,
        control: &Control,
        keywords: &[Keyword],
        opening: &'static str,
    ) -> Result<Open, Fault> {
        let open = self.open();
        let found = open
            .iter()
            .rposition(|open| open.label == control.label && keywords.contains(&open.keyword));
        match found {
            Some(index) => {
                open.truncate(index + 1);
                open.pop().ok_or_else(|| control.not_open(opening))
            }
            None => Err(control.not_open(opening)),
        }
    }
}
