//! Parses the beginning of a Sinumerik line: block number, jump mark, flow word.
//!
//! Not here: what that word does.

use crate::sinumerik::reader::Reader;

/// Words about the order of lines that stand first.
const ORDERS: [&str; 15] = [
    "IF", "ELSE", "ENDIF", "WHILE", "ENDWHILE", "FOR", "ENDFOR", "LOOP", "ENDLOOP", "REPEAT",
    "UNTIL", "GOTOF", "GOTOB", "GOTO", "GOTOC",
];

/// How a line begins.
pub(crate) struct Beginning {
    /// Its jump mark, in upper case.
    pub(crate) label: Option<String>,
    /// Its number behind `N`.
    pub(crate) number: Option<String>,
    /// The word about the order of lines, if it is one.
    pub(crate) order: Option<&'static str>,
    /// Where that word, or the first other one, stands, and where it ends.
    pub(crate) start: usize,
    pub(crate) end: usize,
}

impl Beginning {
    pub(crate) fn of(line: &[u8]) -> Self {
        let mut reader = Reader::new(line);
        let mut number = None;
        reader.skip_blanks();
        if matches!(reader.peek(), Some(b'N' | b'n')) {
            let start = reader.at;
            let name = reader.next_name();
            if name.len() > 1 && name[1..].bytes().all(|byte| byte.is_ascii_digit()) {
                number = Some(name[1..].trim_start_matches('0').to_owned());
            } else {
                reader.at = start;
            }
        }
        reader.skip_blanks();
        let mut start = reader.at;
        let mut name = reader.next_name();
        let mut label = None;
        if name.len() > 1 && reader.peek() == Some(b':') {
            reader.at += 1;
            label = Some(name);
            reader.skip_blanks();
            start = reader.at;
            name = reader.next_name();
        }
        let order = ORDERS.into_iter().find(|order| *order == name);
        Self {
            label,
            number,
            order,
            start,
            end: reader.at,
        }
    }

    pub(crate) fn is(&self, target: &str) -> bool {
        let numbered = target.strip_prefix('N');
        let number = numbered.map(|digits| digits.trim_start_matches('0'));
        self.label.as_deref() == Some(target)
            || number.is_some() && self.number.as_deref() == number
    }
}

/// The order of a line, with `IF` only where it begins a block.
pub(crate) fn block_order(line: &[u8]) -> Option<&'static str> {
    let beginning = Beginning::of(line);
    let order = beginning.order?;
    if order == "IF" {
        let rest = line.get(beginning.end..).unwrap_or_default();
        let rest = rest.split(|&byte| byte == b';').next().unwrap_or_default();
        let jumps = rest
            .windows(4)
            .any(|word| word.eq_ignore_ascii_case(b"GOTO"));
        return (!jumps).then_some(order);
    }
    Some(order)
}
