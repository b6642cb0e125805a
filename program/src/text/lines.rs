//! Reads the lines of a file one at a time, in bounded memory.
//!
//! Not here: what a line means.

use crate::error::reason::Reason;
use std::io::{BufRead, Read};

/// Longest line, bytes without its end: a block of words is a few hundred, so more is not a
/// program, and memory must not grow with it.
pub const LONGEST_LINE: usize = 64 * 1024;

/// The mark that some editors put before a text in UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The mark that ends a text of DOS, `SUB`.
const END_OF_FILE: u8 = 0x1a;

/// Reads lines into one buffer.
#[derive(Debug)]
pub(crate) struct Lines<R> {
    reader: R,
    buffer: Vec<u8>,
    count: u64,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(reader: R) -> Self {
        Self {
            reader,
            buffer: Vec::new(),
            count: 0,
        }
    }

    /// Lines begun so far, the current one included.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// The current line without its end.
    pub(crate) fn text(&self) -> &[u8] {
        &self.buffer
    }

    /// Goes to the next line; false at the end of the file.
    pub(crate) fn advance(&mut self) -> Result<bool, Reason> {
        self.buffer.clear();
        // Room for the mark and CR LF, and for one byte more to notice that the line is too long.
        let most = LONGEST_LINE as u64 + 6;
        let read = Read::take(&mut self.reader, most).read_until(b'\n', &mut self.buffer);
        match read {
            Ok(0) => return Ok(false),
            Ok(_) => self.count += 1,
            Err(error) => {
                self.count += 1;
                self.buffer.clear();
                return Err(Reason::Unreadable {
                    kind: error.kind(),
                    message: error.to_string().into(),
                });
            }
        }
        if self.count == 1 && is_utf_16(&self.buffer) {
            return Err(Reason::Utf16);
        }
        // Files of DOS may end with this.
        if self.buffer.first() == Some(&END_OF_FILE) {
            self.buffer.clear();
            self.count -= 1;
            return Ok(false);
        }
        if self.buffer.last() == Some(&b'\n') {
            self.buffer.pop();
        }
        while self.buffer.last() == Some(&b'\r') {
            self.buffer.pop();
        }
        if self.count == 1 && self.buffer.starts_with(BYTE_ORDER_MARK) {
            self.buffer.drain(..BYTE_ORDER_MARK.len());
        }
        if self.buffer.len() > LONGEST_LINE {
            return Err(Reason::LineTooLong {
                bound: LONGEST_LINE,
            });
        }
        Ok(true)
    }
}

/// Whether a text begins with the mark of UTF-16, or with a letter that has its zero byte beside it.
fn is_utf_16(beginning: &[u8]) -> bool {
    match *beginning {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => true,
        [0, letter, 0, next, ..] | [letter, 0, next, 0, ..] => {
            letter.is_ascii() && letter != 0 && next.is_ascii() && next != 0
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &[u8]) -> Vec<Vec<u8>> {
        let mut lines = Lines::new(text);
        let mut found = Vec::new();
        while lines.advance().unwrap() {
            found.push(lines.text().to_vec());
        }
        found
    }

    #[test]
    fn line_ends_of_either_kind_and_the_byte_order_mark_are_dropped() {
        let found = all(b"\xef\xbb\xbfG0\r\nG1\n\nG2");
        assert_eq!(found, [&b"G0"[..], b"G1", b"", b"G2"], "lines");
    }

    #[test]
    fn a_text_in_utf_16_is_named_as_one_and_other_bytes_are_not() {
        for text in [
            &b"\xff\xfeG\0"[..],
            b"\xfe\xff\0G",
            b"G\x002\x001\0",
            b"\0G\x002\x001",
        ] {
            let refused = Lines::new(text).advance();
            assert_eq!(refused, Err(Reason::Utf16), "{text:?}");
        }
        for text in [
            &b"\0\0\0\0"[..],
            b"G\0\0\0",
            b"G21\0",
            b"\xff",
            b"\xef\xbb\xbfG\0",
        ] {
            assert_eq!(all(text).len(), 1, "{text:?}");
        }
    }

    #[test]
    fn a_text_of_dos_ends_at_its_mark() {
        assert_eq!(all(b"G0\r\n\x1a"), [&b"G0"[..]], "mark");
        assert_eq!(all(b"G0\n\x1a\0\0\nG1"), [&b"G0"[..]], "what follows it");
    }

    #[test]
    fn the_longest_line_is_read_and_one_byte_more_is_refused() {
        let mut text = vec![b' '; LONGEST_LINE];
        text.extend_from_slice(b"\r\nG1");
        assert_eq!(all(&text).len(), 2, "longest");
        let longer = vec![b' '; LONGEST_LINE + 1];
        let refused = Lines::new(&longer[..]).advance();
        let bound = LONGEST_LINE;
        assert_eq!(refused, Err(Reason::LineTooLong { bound }), "longer");
    }
}
