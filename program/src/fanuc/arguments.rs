//! Reads the arguments of a macro call into local variables, by both lists.
//!
//! Source: the chapter on custom macros of the operator's manuals of FANUC and Haas: of list I each letter has
//! its variable; of list II the triples `I J K` go on. Of two values for one variable the later holds.

use crate::error::Fault;
use crate::error::reason::Reason;
use crate::fanuc::memory::{Locals, UNSET};
use crate::fanuc::words::Word;

/// Variables of list I by their letters; `G L N O P` are no arguments.
const LETTERS: [(u8, usize); 21] = [
    (b'A', 1),
    (b'B', 2),
    (b'C', 3),
    (b'I', 4),
    (b'J', 5),
    (b'K', 6),
    (b'D', 7),
    (b'E', 8),
    (b'F', 9),
    (b'H', 11),
    (b'M', 13),
    (b'Q', 17),
    (b'R', 18),
    (b'S', 19),
    (b'T', 20),
    (b'U', 21),
    (b'V', 22),
    (b'W', 23),
    (b'X', 24),
    (b'Y', 25),
    (b'Z', 26),
];

/// Triples of list II.
const MAX_TRIPLES: usize = 10;

/// The macro that is called after each motion.
#[derive(Clone, Debug)]
pub(crate) struct ModalMacro {
    pub(crate) number: u32,
    pub(crate) times: u32,
    /// Its local variables, which keep their values from call to call.
    pub(crate) locals: Locals,
}

/// The local variables of a macro by the words of its call.
pub(crate) fn locals(arguments: &[Word]) -> Result<Locals, Fault> {
    let mut locals = UNSET;
    let (mut triple, mut last) = (0, 0);
    for word in arguments
        .iter()
        .filter(|word| !b"GPLN".contains(&word.letter))
    {
        let letter = char::from(word.letter);
        let variable = LETTERS.iter().find(|(letter, _)| *letter == word.letter);
        let Some(&(_, variable)) = variable.filter(|_| !word.comma) else {
            return Err(Fault::new(word.span, Reason::Unused { letter }));
        };
        let place = if matches!(word.letter, b'I' | b'J' | b'K') {
            // A letter that does not come behind the last one begins the next triple.
            if variable <= last {
                triple += 1;
            }
            last = variable;
            if triple >= MAX_TRIPLES {
                return Err(Fault::new(word.span, Reason::Repeated { letter }));
            }
            variable + 3 * triple
        } else {
            variable
        };
        locals[place] = word.value;
    }
    Ok(locals)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::place::Span;

    fn found(text: &str) -> Vec<(usize, f64)> {
        let words: Vec<Word> = text
            .split_whitespace()
            .map(|word| Word {
                letter: word.as_bytes()[0],
                comma: false,
                value: word[1..].parse().unwrap_or(0.0),
                point: false,
                span: Span::default(),
            })
            .collect();
        let locals = locals(&words).unwrap_or(UNSET);
        (1..)
            .zip(&locals[1..])
            .filter(|(_, value)| !value.is_nan())
            .map(|(at, value)| (at, *value))
            .collect()
    }

    #[test]
    fn both_lists_fill_their_variables() {
        let first =
            found("A1 B2 C3 I4 J5 K6 D7 E8 F9 H11 M13 Q17 R18 S19 T20 U21 V22 W23 X24 Y25 Z26");
        assert!(
            first
                .iter()
                .all(|&(at, value)| (value - at as f64).abs() < 0.5),
            "{first:?}"
        );
        assert_eq!(first.len(), 21, "list I");
        let second = found("A1 I4 J5 K6 I7 K9 I10 J11");
        assert!(
            second
                .iter()
                .all(|&(at, value)| (value - at as f64).abs() < 0.5),
            "{second:?}"
        );
        assert_eq!(found("I1 I2 D3"), [(4, 1.0), (7, 3.0)], "the later holds");
    }
}
