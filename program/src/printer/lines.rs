//! Parses a line of a printer's program into axis words, a rest, or an order without motion.
//!
//! Source: the codes of Marlin, RepRapFirmware and Klipper. Orders with free text (`M117`) and those of Klipper
//! (`SET_...`) are no words at all. Not here: what extrusion is, see `printer`.

use crate::text::place::Span;

/// What a line of a printer's program asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Line<'a> {
    /// Nothing.
    Empty,
    /// Words of RS274/NGC, up to a byte of the line.
    Words(usize),
    /// Standing still until something else is done.
    Rest(Span),
    /// Whether `E` is a step instead of a place.
    Extrusion {
        /// A step.
        relative: bool,
    },
    /// `G28`, with the axes that it names.
    Home(Span, [bool; 3]),
    /// `G4`, s.
    Dwell(Span, f64),
    /// `SET_GCODE_OFFSET` with what follows it.
    Offset(Span, &'a str),
    /// An order that moves none of the axes that are planned, and why.
    Noted(Span, &'static str),
    /// An order that moves an axis or the part, and how.
    Refused(Span, &'static str),
}

/// What the printer does by itself, without a path that anybody else could know.
const OWN: &str = "a motion of the printer's own, which is not planned";

/// Reads a line.
pub(crate) fn line_of(text: &[u8]) -> Line<'_> {
    let start = word_start(text);
    let Some(rest) = text.get(start..).filter(|rest| !rest.is_empty()) else {
        return Line::Empty;
    };
    let letter = rest[0].to_ascii_uppercase();
    if letter == b';' {
        return Line::Empty;
    }
    if !letter.is_ascii_alphabetic() {
        return Line::Words(text.len());
    }
    let is_name = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    if rest
        .get(1)
        .is_some_and(|&next| next.is_ascii_alphabetic() || next == b'_')
    {
        let length = rest.iter().take_while(|byte| is_name(byte)).count();
        let span = Span::new(start, start + length);
        let name = String::from_utf8_lossy(&rest[..length]).to_ascii_uppercase();
        let after = std::str::from_utf8(&rest[length..]).unwrap_or_default();
        return extended(&name, span, after);
    }
    let digits = rest[1..].iter().take_while(|byte| byte.is_ascii_digit());
    let digits = digits.count();
    let span = Span::new(start, start + 1 + digits);
    let number = std::str::from_utf8(&rest[1..=digits]).unwrap_or_default();
    let number: Option<u32> = number.parse().ok();
    let words = Line::Words(before_checksum(text));
    let after = remark_removed(&rest[1 + digits..]);
    match (letter, number) {
        (b'M', Some(number)) => miscellaneous(number, span, after),
        (b'G', Some(number)) => preparatory(number, span, after).unwrap_or(words),
        // Tools that are asked for by name or by the order of a changer.
        (b'T', None) => Line::Noted(span, "a change of filament"),
        _ => words,
    }
}

/// Where the first word stands, behind blanks and a line number.
fn word_start(text: &[u8]) -> usize {
    let blank = |byte: &u8| matches!(byte, b' ' | b'\t');
    let skip = |from: usize| from + text[from..].iter().take_while(|byte| blank(byte)).count();
    let start = skip(0);
    if !matches!(text.get(start), Some(b'N' | b'n')) {
        return start;
    }
    let digits = text[start + 1..]
        .iter()
        .take_while(|byte| byte.is_ascii_digit())
        .count();
    if digits == 0 {
        return start;
    }
    skip(start + 1 + digits)
}

/// Where the words of a line end: before its checksum `*71`.
fn before_checksum(text: &[u8]) -> usize {
    let end = text.iter().position(|&byte| byte == b';');
    let words = &text[..end.unwrap_or(text.len())];
    let Some(star) = words.iter().rposition(|&byte| byte == b'*') else {
        return text.len();
    };
    let sum = words[star + 1..].trim_ascii();
    let is_sum = !sum.is_empty() && sum.iter().all(u8::is_ascii_digit);
    if is_sum { star } else { text.len() }
}

fn remark_removed(text: &[u8]) -> &[u8] {
    let end = text.iter().position(|&byte| byte == b';');
    &text[..end.unwrap_or(text.len())]
}

fn preparatory(number: u32, span: Span, after: &[u8]) -> Option<Line<'static>> {
    let has = |letter: u8| after.iter().any(|byte| byte.to_ascii_uppercase() == letter);
    Some(match number {
        4 => Line::Dwell(span, seconds(after)),
        10 if has(b'L') => return None,
        10 if has(b'P') && (has(b'S') || has(b'R')) => Line::Noted(span, "temperatures"),
        10 | 11 | 22 | 23 => Line::Noted(span, "retraction by the printer itself"),
        12 | 26 | 27 | 29..=35 | 76 | 80 => Line::Noted(span, OWN),
        28 => Line::Home(span, [b'X', b'Y', b'Z'].map(has)),
        42 => Line::Refused(span, "a move to a point of the bed mesh"),
        60 => Line::Noted(span, "a stored point"),
        61 => Line::Refused(span, "a move to a stored point"),
        _ => return None,
    })
}

/// How long `G4` lasts: `P` in ms or `S` in s, which counts where both stand.
fn seconds(after: &[u8]) -> f64 {
    let value = |letter: u8| {
        let at = after
            .iter()
            .position(|byte| byte.to_ascii_uppercase() == letter)?;
        let (value, _) = crate::text::number::number(after, at + 1).ok()?;
        Some(value)
    };
    let milliseconds = value(b'P').map(|value| value / 1000.0);
    value(b'S').or(milliseconds).unwrap_or(0.0)
}

fn miscellaneous(number: u32, span: Span, after: &[u8]) -> Line<'static> {
    let what = match number {
        2 | 30 if after.trim_ascii().is_empty() => return Line::Words(span.end as usize),
        0 | 1 | 25 | 226 | 400 | 600 | 601 => return Line::Rest(span),
        // The printer waits for its temperature.
        109 | 116 | 190 | 191 => return Line::Rest(span),
        82 => return Line::Extrusion { relative: false },
        83 => return Line::Extrusion { relative: true },
        206 | 428 => return Line::Refused(span, "a shift of all axes"),
        290 => return Line::Refused(span, "a step of an axis"),
        360..=364 => return Line::Refused(span, "a move to a point of calibration"),
        32 | 98 | 808 => return Line::Refused(span, "the run of another file"),
        104 | 140 | 141 => "temperatures",
        106 | 107 => "fans",
        73 | 117 | 118 => "shown to people",
        200..=205 | 566 | 572 | 593 | 900 => {
            "limits and pressure of the printer; those of the machine here count"
        }
        220 => "a rate by which all feedrates are multiplied; 100 % counts",
        _ => "an order to the printer alone",
    };
    Line::Noted(span, what)
}

/// An order by a name of several letters.
fn extended<'a>(name: &str, span: Span, after: &'a str) -> Line<'a> {
    match name {
        "SET_GCODE_OFFSET" => Line::Offset(span, after),
        "PAUSE" => Line::Rest(span),
        "FORCE_MOVE" | "MANUAL_STEPPER" => Line::Refused(span, "a move of one motor"),
        "RESTORE_GCODE_STATE" => Line::Refused(span, "modes and a place of before"),
        "SET_KINEMATIC_POSITION" => Line::Refused(span, "a shift of all axes"),
        "START_PRINT" | "PRINT_START" | "END_PRINT" | "PRINT_END" => Line::Noted(span, OWN),
        _ => Line::Noted(span, "an order to the printer alone"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noted(text: &str) -> bool {
        matches!(line_of(text.as_bytes()), Line::Noted(..))
    }

    #[test]
    fn orders_and_texts_move_nothing() {
        for text in [
            "M117 Printing layer 2 (of 9",
            "M73 P10 R5",
            "N12 M204 P1000*33",
            "SET_PRESSURE_ADVANCE ADVANCE=0.05",
            "exclude_object_start NAME=part",
            "M106 S127.5",
            "M862.3 P \"MK3S\"",
            "G29",
            "G10",
            "T?",
            "Tx",
            "M84 X Y E",
        ] {
            assert!(noted(text), "{text}");
        }
        assert_eq!(line_of(b"  ; G1 X1"), Line::Empty, "remark");
        assert_eq!(line_of(b"N5"), Line::Empty, "number alone");
        assert_eq!(line_of(b"N3 G1 X5*71 ; a*b"), Line::Words(8), "checksum");
        assert_eq!(line_of(b"G1 X5 ; 2*3"), Line::Words(11), "no checksum");
        let refused = |text: &str| matches!(line_of(text.as_bytes()), Line::Refused(..));
        for text in ["M206 X5", "G61", "FORCE_MOVE STEPPER=x", "M98 P\"a.g\""] {
            assert!(refused(text), "{text}");
        }
    }

    #[test]
    #[allow(clippy::float_cmp, reason = "values are small and exact")]
    fn dwells_are_in_milliseconds_or_seconds() {
        let duration = |text: &str| match line_of(text.as_bytes()) {
            Line::Dwell(_, duration) => duration,
            other => panic!("{other:?}"),
        };
        let found = ["G4 P500", "G4 S2 P9", "g4 s1.5", "G4"].map(duration);
        assert_eq!(found, [0.5, 2.0, 1.5, 0.0], "durations");
    }
}
