//! Parses one statement of a cutter location file.
//!
//! Source: ISO 4343 and the files that CAM systems write: `MAJOR/minor,number,...`, `$$` begins a
//! remark, `$` at the end of a line goes on in the next one. Not here: what a statement does.

use crate::error::Fault;
use crate::error::statement::StatementError;
use crate::text::place::Span;

/// A statement.
pub(crate) struct Statement<'line> {
    /// Major word in upper case.
    pub(crate) name: String,
    pub(crate) span: Span,
    items: Vec<(&'line str, Span)>,
}

impl<'line> Statement<'line> {
    /// Splits a line; none when it says nothing.
    pub(crate) fn of(line: &'line str) -> Option<Self> {
        let text = line.split("$$").next().unwrap_or_default();
        let start = text.len() - text.trim_start().len();
        let text = text.trim_end();
        if start >= text.len() {
            return None;
        }
        let (major, rest) = match text.find('/') {
            Some(slash) => (&text[start..slash], Some(slash + 1)),
            None => (&text[start..], None),
        };
        let mut items = Vec::new();
        if let Some(first) = rest {
            let mut at = first;
            for item in text[first..].split(',') {
                let word = item.trim();
                let begin = at + item.len() - item.trim_start().len();
                items.push((word, Span::new(begin, begin + word.len())));
                at += item.len() + 1;
            }
        }
        let major = major.trim_end();
        Some(Self {
            name: major.to_ascii_uppercase(),
            span: Span::new(start, start + major.len()),
            items,
        })
    }

    /// What stands behind the slash.
    pub(crate) fn items(&self) -> impl Iterator<Item = (&'line str, Span)> + '_ {
        self.items.iter().copied()
    }

    /// Whether a minor word stands behind the slash.
    pub(crate) fn has(&self, word: &str) -> bool {
        self.items()
            .any(|(item, _)| item.eq_ignore_ascii_case(word))
    }

    /// The numbers behind the slash; other words are left out when `words` may stand there.
    pub(crate) fn numbers(&self, words: bool) -> Result<Vec<f64>, Fault> {
        let mut numbers = Vec::with_capacity(self.items.len());
        for (item, span) in self.items() {
            match number(item) {
                Some(value) => numbers.push(value),
                None if words && item.starts_with(|letter: char| letter.is_ascii_alphabetic()) => {}
                None => {
                    // An empty item is as wide as the comma that ends it.
                    let end = span.end.max(span.start + 1);
                    let span = Span {
                        start: span.start,
                        end,
                    };
                    return Err(Fault::new(span, StatementError::NotANumber.into()));
                }
            }
        }
        Ok(numbers)
    }
}

/// A finite number, as Fortran or C write it.
fn number(text: &str) -> Option<f64> {
    let begins = text.starts_with(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter));
    let plain = begins.then(|| text.replace(['D', 'd'], "E").parse::<f64>().ok());
    plain.flatten().filter(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_statement_is_a_word_and_its_items() {
        let statement = Statement::of("  GOTO / 1., -2.5 ,3E1 $$ remark").unwrap();
        assert_eq!(statement.name, "GOTO", "name");
        assert_eq!(
            statement.numbers(false),
            Ok(vec![1.0, -2.5, 30.0]),
            "numbers"
        );
        assert!(Statement::of(" $$ nothing").is_none(), "remark");
        let rapid = Statement::of("rapid").unwrap();
        assert_eq!(
            (rapid.name.as_str(), rapid.items().count()),
            ("RAPID", 0),
            "no slash"
        );
    }

    #[test]
    fn what_is_no_number_is_refused_at_its_place() {
        let fault = |text| Statement::of(text).unwrap().numbers(false).unwrap_err();
        let place = |text| {
            let fault: Fault = fault(text);
            (fault.span.start, fault.span.end)
        };
        assert_eq!(place("GOTO/1,,2"), (7, 8), "empty");
        assert_eq!(place("GOTO/1, x2"), (8, 10), "word");
        assert_eq!(place("GOTO/1,inf"), (7, 10), "infinite");
    }
}
