//! Names the place of a word in a program: file, line and column.
//!
//! Bytes are counted while reading, because that costs nothing; characters only once there is
//! something to say.

use std::fmt;
use std::sync::Arc;

/// Characters of an offending word that are kept: enough to recognise it, few enough to print.
const LONGEST_EXCERPT: usize = 40;

/// Bytes of a line, counted from 0, the end not included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Span {
    pub(crate) start: u32,
    pub(crate) end: u32,
}

impl Span {
    /// Lines are bounded far below 4 GiB, so positions always fit.
    pub(crate) fn new(start: usize, end: usize) -> Self {
        Self {
            start: u32::try_from(start).unwrap_or(u32::MAX),
            end: u32::try_from(end).unwrap_or(u32::MAX),
        }
    }

    fn range(self, length: usize) -> std::ops::Range<usize> {
        let end = (self.end as usize).min(length);
        (self.start as usize).min(end)..end
    }
}

/// A stretch of one line of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    file: Arc<str>,
    line: u64,
    column: u32,
    length: u32,
    word: Box<str>,
}

impl Place {
    pub(crate) fn new(file: &Arc<str>, line: u64, text: &[u8], span: Span) -> Self {
        let range = span.range(text.len());
        let before = String::from_utf8_lossy(&text[..range.start]);
        let inside = String::from_utf8_lossy(&text[range]);
        let count = |text: &str| u32::try_from(text.chars().count()).unwrap_or(u32::MAX);
        let mut word: String = inside.chars().take(LONGEST_EXCERPT).collect();
        if word.len() < inside.len() {
            word.push('…');
        }
        Self {
            file: Arc::clone(file),
            line,
            column: count(&before).saturating_add(1),
            length: count(&inside).max(1),
            word: word.into(),
        }
    }

    /// Name of the file, as it was given.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Line, counted from 1.
    #[must_use]
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Column of the first character, counted in characters from 1.
    #[must_use]
    pub fn column(&self) -> u32 {
        self.column
    }

    /// How many characters it covers, at least one: what a caret underlines.
    #[must_use]
    pub fn length(&self) -> u32 {
        self.length
    }

    /// The word as it was written, shortened when it is very long; empty where none is at fault.
    #[must_use]
    pub fn word(&self) -> &str {
        &self.word
    }
}

impl fmt::Display for Place {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}:{}:{}", self.file, self.line, self.column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_not_bytes() {
        let text = "(µm) G53 X1".as_bytes();
        let place = Place::new(&Arc::from("a.ngc"), 7, text, Span::new(6, 9));
        assert_eq!(place.to_string(), "a.ngc:7:6", "place");
        assert_eq!((place.word(), place.length()), ("G53", 3), "word");
    }

    #[test]
    fn a_place_beyond_the_line_is_its_end() {
        let place = Place::new(&Arc::from("a"), 1, b"G1", Span::new(9, 12));
        assert_eq!((place.column(), place.length()), (3, 1), "end of line");
    }

    #[test]
    fn a_long_word_is_shortened() {
        let text = [b'9'; 100];
        let place = Place::new(&Arc::from("a"), 1, &text, Span::new(0, 100));
        assert_eq!(place.word().chars().count(), LONGEST_EXCERPT + 1, "excerpt");
        assert_eq!(place.length(), 100, "all of it is underlined");
    }
}
