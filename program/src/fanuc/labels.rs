//! Finds block numbers, program numbers and loops in lines that go by without being run.
//!
//! Not here: where a program goes on.

use std::collections::BTreeMap;

/// Block numbers of one program, with the lines where they stand.
#[derive(Debug, Default)]
pub(crate) struct Labels {
    lines: BTreeMap<u32, Vec<usize>>,
}

impl Labels {
    /// Takes a line; true when the program ends before it.
    pub(crate) fn take(&mut self, index: usize, first: bool, line: &[u8]) -> bool {
        let at = blanks(line, 0);
        let ends = line.get(at) == Some(&b'%') || program_number(line).is_some();
        if !first && ends {
            return true;
        }
        if let Some((number, _)) = block_number(line) {
            self.lines.entry(number).or_default().push(index);
        }
        false
    }

    /// The line of a block: the first one behind `from`, or the first of all.
    pub(crate) fn find(&self, number: u32, from: usize) -> Option<usize> {
        let lines = self.lines.get(&number)?;
        let behind = lines.iter().find(|&&line| line > from);
        behind.or_else(|| lines.first()).copied()
    }
}

/// The number of the program that begins with a line: `O1234` or `:1234`, whatever follows.
pub(crate) fn program_number(line: &[u8]) -> Option<u32> {
    let mut at = blanks(line, 0);
    if line.get(at) == Some(&b'%') {
        at = blanks(line, at + 1);
    }
    if !matches!(line.get(at), Some(b'O' | b'o' | b':')) {
        return None;
    }
    digits(line, blanks(line, at + 1)).map(|(number, _)| number)
}

/// The number of a block, and where it goes on.
pub(crate) fn block_number(line: &[u8]) -> Option<(u32, usize)> {
    let mut at = blanks(line, 0);
    if line.get(at) == Some(&b'/') {
        at = blanks(line, digits(line, at + 1).map_or(at + 1, |(_, end)| end));
    }
    if program_number(line).is_some() {
        let start = line
            .iter()
            .position(|byte| matches!(byte, b'O' | b'o' | b':'))?;
        at = digits(line, blanks(line, start + 1))?.1;
        at = blanks(line, at);
    }
    if !matches!(line.get(at), Some(b'N' | b'n')) {
        return None;
    }
    digits(line, blanks(line, at + 1))
}

/// Whether a line begins (true) or ends a loop, and its number.
pub(crate) fn stands_loop(line: &[u8]) -> Option<(bool, u32)> {
    let at = blanks(line, block_number(line).map_or(0, |(_, end)| end));
    let rest = line.get(at..)?;
    let upper: Vec<u8> = rest
        .iter()
        .take_while(|&&byte| byte != b'(' && byte != b';')
        .filter(|byte| !matches!(byte, b' ' | b'\t'))
        .map(u8::to_ascii_uppercase)
        .collect();
    if let Some(number) = upper.strip_prefix(b"END") {
        return digits(number, 0).map(|(number, _)| (false, number));
    }
    let head = if upper.starts_with(b"WHILE") {
        let close = upper.iter().rposition(|&byte| byte == b']')?;
        upper.get(close + 1..)?
    } else {
        &upper
    };
    let number = head.strip_prefix(b"DO")?;
    digits(number, 0).map(|(number, _)| (true, number))
}

/// Whether a line can be a block, and no text: letters with numbers, or a statement of macro B.
pub(crate) fn is_block(line: &[u8]) -> bool {
    let mut at = 0;
    let mut any = false;
    loop {
        at = blanks(line, at);
        match line.get(at) {
            None | Some(b';') => return any,
            Some(b'#') => return true,
            Some(b'(') => match line[at..].iter().position(|&byte| byte == b')') {
                Some(length) => at += length + 1,
                None => return any,
            },
            Some(b'/') => at += 1,
            Some(byte) if byte.is_ascii_alphabetic() || *byte == b':' => {
                match crate::text::number::number(line, at + 1) {
                    Ok((_, end)) => at = end,
                    Err(_) => return matches!(line.get(at + 1), Some(b'#' | b'[')),
                }
                any = true;
            }
            Some(_) => return false,
        }
    }
}

/// Behind the blanks at a place.
pub(crate) fn blanks(line: &[u8], from: usize) -> usize {
    let rest = line.get(from..).unwrap_or_default();
    let length = rest.iter().position(|byte| !matches!(byte, b' ' | b'\t'));
    from + length.unwrap_or(rest.len())
}

/// The whole number at a place, and where it ends.
pub(crate) fn digits(line: &[u8], from: usize) -> Option<(u32, usize)> {
    let rest = line.get(from..)?;
    let length = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let text = std::str::from_utf8(&rest[..length]).ok()?;
    Some((text.parse().ok()?, from + length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_known_by_how_they_begin() {
        assert_eq!(program_number(b"O1234(NAME)"), Some(1234), "number");
        assert_eq!(program_number(b" :0012"), Some(12), "colon");
        assert_eq!(program_number(b"%O77"), Some(77), "behind the opening");
        assert_eq!(program_number(b"o<sub> sub"), None, "name");
        assert_eq!(block_number(b"N010 G1").map(|found| found.0), Some(10), "N");
        assert_eq!(
            block_number(b"O5 N20 G1").map(|found| found.0),
            Some(20),
            "behind O"
        );
        assert_eq!(
            block_number(b"/2 N30").map(|found| found.0),
            Some(30),
            "behind /"
        );
        assert_eq!(
            stands_loop(b"N1 WHILE [#1 LT [2]] DO 2"),
            Some((true, 2)),
            "while"
        );
        assert_eq!(stands_loop(b"do3 (x)"), Some((true, 3)), "do");
        assert_eq!(stands_loop(b"END1"), Some((false, 1)), "end");
        assert_eq!(stands_loop(b"D01 G41"), None, "D word");
    }
}
