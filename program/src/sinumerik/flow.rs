//! Executes jumps, conditions and loops of Sinumerik.
//!
//! Source: the programming manual of Sinumerik 840D sl: `GOTOF` `GOTOB` `GOTO` `GOTOC`, `IF`, `WHILE`, `FOR`,
//! `LOOP`, `REPEAT`. Nothing is remembered of a loop but its lines, so that jumps out of it do no harm. Not
//! here: words that are not about the order of lines.

use crate::error::Fault;
use crate::error::flow::FlowError;
use crate::error::reason::Reason;
use crate::flow::Flow;
use crate::flow::tape::Tape;
use crate::interpreter::Interpreter;
use crate::sinumerik::line::{Beginning, block_order};
use crate::sinumerik::reader::Reader;
use crate::text::place::Span;
use std::io::BufRead;

impl<R: BufRead> Flow<R> {
    /// Obeys the line being run if it is about the order of lines; else where its words begin.
    pub(crate) fn obey_order(&mut self, state: &mut Interpreter) -> Result<Option<usize>, Fault> {
        let beginning = Beginning::of(self.text());
        let Some(order) = beginning.order else {
            return Ok(Some(beginning.start));
        };
        let line = self.text().to_vec();
        let span = Span::new(beginning.start, beginning.end);
        let mut reader = Reader::new(&line);
        reader.at = beginning.end;
        if let Some(opening @ ("IF" | "WHILE" | "FOR" | "LOOP" | "REPEAT")) = block_order(&line) {
            self.expect_end(span, opening)?;
        }
        match order {
            "IF" => self.if_order(&mut reader, span, state)?,
            "ELSE" => {
                self.skip_order(span, "IF", &["ENDIF"], "ENDIF")?;
            }
            "WHILE" => {
                let holds = condition(&mut reader, state);
                // A loop whose condition is wrong is passed over.
                if !matches!(holds, Ok(true)) {
                    let here = self.tape_index();
                    self.skip_order(span, "WHILE", &["ENDWHILE"], "ENDWHILE")?;
                    if let Err(fault) = holds {
                        self.show(here);
                        return Err(fault);
                    }
                }
            }
            "FOR" => self.for_order(&mut reader, span, state, false)?,
            "ENDWHILE" => {
                let head = self.head(span, order, "WHILE")?;
                // The head is run again.
                self.tape_back(head);
            }
            "ENDLOOP" => {
                let head = self.head(span, order, "LOOP")?;
                self.tape_to(head);
            }
            "UNTIL" => {
                let holds = condition(&mut reader, state)?;
                let head = self.head(span, order, "REPEAT")?;
                if !holds {
                    self.tape_to(head);
                }
            }
            "ENDFOR" => {
                let head = self.head(span, order, "FOR")?;
                let foot = self.tape_index();
                self.tape_to(head);
                let line = self.text().to_vec();
                let beginning = Beginning::of(&line);
                let mut reader = Reader::new(&line);
                reader.at = beginning.end;
                let span = Span::new(beginning.start, beginning.end);
                let outcome = self.for_order(&mut reader, span, state, true);
                if outcome.is_err() || self.tape_index() != head {
                    self.tape_to(foot);
                }
                outcome?;
            }
            "GOTOF" | "GOTOB" | "GOTO" | "GOTOC" => self.jump(&mut reader, span, order)?,
            // LOOP, REPEAT and ENDIF say where a block begins or ends, and nothing else.
            _ => {}
        }
        Ok(None)
    }

    /// `IF` before a jump, or before a block.
    fn if_order(
        &mut self,
        reader: &mut Reader<'_>,
        span: Span,
        state: &Interpreter,
    ) -> Result<(), Fault> {
        loop {
            let holds = reader.expression(state)? != 0.0;
            let start = reader.next_item()?.unwrap_or(reader.at);
            let name = reader.next_name();
            match name.as_str() {
                "" => {
                    if reader.next_item()?.is_some() {
                        return Err(reader.stray(start));
                    }
                    if !holds {
                        self.skip_order(span, "IF", &["ELSE", "ENDIF"], "ENDIF")?;
                    }
                    return Ok(());
                }
                "GOTOF" | "GOTOB" | "GOTO" | "GOTOC" if holds => {
                    return self.jump(reader, Span::new(start, reader.at), &name);
                }
                "GOTOF" | "GOTOB" | "GOTO" | "GOTOC" => {
                    reader.next_name();
                    if reader.next_item()?.is_none() {
                        return Ok(());
                    }
                    let next = reader.at;
                    if !reader.takes("IF") {
                        return Err(reader.stray(next));
                    }
                }
                _ => {
                    let word = name.into();
                    let span = Span::new(start, reader.at);
                    return Err(Fault::new(span, Reason::UnknownWord { word }));
                }
            }
        }
    }

    /// `FOR name = first TO last`: at its beginning, or once more at its end.
    fn for_order(
        &mut self,
        reader: &mut Reader<'_>,
        span: Span,
        state: &mut Interpreter,
        again: bool,
    ) -> Result<(), Fault> {
        let start = reader.at;
        let name = reader.next_name().to_ascii_lowercase();
        if name.is_empty() || !reader.equals_follows() {
            return Err(reader.stray(reader.at.min(start + 1)));
        }
        let named = Span::new(start, reader.at);
        let first = reader.expression(state)?;
        let to = reader.at;
        if !reader.takes("TO") {
            return Err(reader.stray(to));
        }
        let last = reader.expression(state)?;
        let value = if again {
            state.parameters.get_named(&name).unwrap_or(first) + 1.0
        } else {
            first
        };
        state
            .parameters
            .set_named(&name, value)
            .map_err(|reason| Fault::new(named, reason.into()))?;
        if value > last {
            self.skip_order(span, "FOR", &["ENDFOR"], "ENDFOR")?;
        }
        Ok(())
    }

    /// Jumps to a mark or a block number.
    fn jump(&mut self, reader: &mut Reader<'_>, span: Span, order: &str) -> Result<(), Fault> {
        reader.skip_blanks();
        let start = reader.at;
        let target = reader.next_name();
        let span = Span::new(
            if target.is_empty() {
                span.start as usize
            } else {
                start
            },
            reader.at,
        );
        let here = self.tape_index();
        let is = |line: &[u8]| Beginning::of(line).is(&target);
        if order != "GOTOB" {
            if self
                .seek(|line| is(line).then_some(()))
                .map_err(|reason| Fault::new(span, reason))?
                .is_some()
            {
                // The mark may stand before words of its own.
                let found = self.tape_index();
                self.tape_back(found);
                return Ok(());
            }
            self.tape_to(here);
        }
        let before = match order {
            "GOTOF" => None,
            _ => self.tape_before(is),
        };
        match (before, order) {
            (Some(index), _) => self.tape_back(index),
            (None, "GOTOC") => {}
            (None, _) => {
                let label = target.into();
                return Err(Fault::new(span, FlowError::NoTarget { label }.into()));
            }
        }
        Ok(())
    }

    /// Passes over lines until one of `ends` at the depth of the line being run.
    fn skip_order(
        &mut self,
        span: Span,
        opening: &'static str,
        ends: &[&str],
        closing: &'static str,
    ) -> Result<(), Fault> {
        let here = self.tape_index();
        let mut depth = 0_u32;
        let found = self.seek(|line| {
            let met = block_order(line)?;
            if met == opening {
                depth += 1;
            } else if depth == 0 && ends.contains(&met) {
                return Some(());
            } else if met == closing {
                depth -= 1;
            }
            None
        });
        if found.map_err(|reason| Fault::new(span, reason))?.is_none() {
            self.tape_to(here);
            let keyword = opening;
            return Err(Fault::new(
                span,
                FlowError::BlockNotClosed { keyword, closing }.into(),
            ));
        }
        Ok(())
    }

    /// Index of the head of the loop that the line being run ends.
    fn head(
        &self,
        span: Span,
        keyword: &'static str,
        opening: &'static str,
    ) -> Result<usize, Fault> {
        let mut depth = 0_u32;
        let found = self.tape_before(|line| match block_order(line) {
            Some(met) if met == keyword => {
                depth += 1;
                false
            }
            Some(met) if met == opening && depth > 0 => {
                depth -= 1;
                false
            }
            met => met == Some(opening),
        });
        let reason = FlowError::BlockNotOpen { keyword, opening };
        found.ok_or_else(|| Fault::new(span, reason.into()))
    }

    /// Goes on until a line gives something; none at the end of the program.
    fn seek<T>(&mut self, mut is: impl FnMut(&[u8]) -> Option<T>) -> Result<Option<T>, Reason> {
        self.look(true);
        let mut found = Ok(None);
        loop {
            match self.advance() {
                Ok(true) => {}
                Ok(false) => break,
                Err(reason) => {
                    found = Err(reason);
                    break;
                }
            }
            if let Some(met) = is(self.text()) {
                found = Ok(Some(met));
                break;
            }
        }
        self.look(false);
        found
    }

    /// Shows a line of the tape as the one being run, and goes on where it is.
    fn show(&mut self, index: usize) {
        if let Some(tape) = &mut self.tape {
            tape.show(index);
        }
    }

    fn look(&mut self, looking: bool) {
        if let Some(tape) = &mut self.tape {
            tape.looking = looking;
        }
    }

    /// Refuses a block without its end, when it is met for the first time.
    fn expect_end(&mut self, span: Span, opening: &'static str) -> Result<(), Fault> {
        let closing = match opening {
            "IF" => "ENDIF",
            "WHILE" => "ENDWHILE",
            "FOR" => "ENDFOR",
            "LOOP" => "ENDLOOP",
            _ => "UNTIL",
        };
        if self.tape.as_ref().is_some_and(Tape::at_front) {
            let here = self.tape_index();
            self.skip_order(span, opening, &[closing], closing)?;
            self.tape_to(here);
        }
        Ok(())
    }
}

/// A condition with nothing behind it.
fn condition(reader: &mut Reader<'_>, state: &Interpreter) -> Result<bool, Fault> {
    let value = reader.expression(state)?;
    match reader.next_item()? {
        None => Ok(value != 0.0),
        Some(at) => Err(reader.stray(at)),
    }
}
