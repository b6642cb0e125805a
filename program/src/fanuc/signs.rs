//! Recognises programs for FANUC and Haas by what no program for LinuxCNC can have.
//!
//! Signs are statements of macro B (`IF [`, `WHILE [`, `GOTO 1`, `DO1`, `END1`, `THEN`), codes that LinuxCNC
//! refuses (`G65 P`, `G4 X`, `G68 R`, `G54.1 P`, `G187`, `M97 P` and others), `,R` and `,C`, orders to print, expressions
//! without brackets (`#1=#1+1`), and `M98 P31001` where
//! program 1001 is in the file. What both have, such as `#1=` and `M98 P1000`, is no sign.

use crate::block::code::Code;
use crate::error::Fault;
use crate::error::reason::Reason;
use crate::fanuc::labels::{blanks, block_number, program_number, stands_loop};
use crate::text::number::number;
use crate::text::place::Span;
use std::collections::BTreeSet;

/// Codes of FANUC or Haas alone, in tenths, with a letter that must stand in their block.
const CODES: [(u16, &[u8]); 30] = [
    (51, b"Q"),
    (80, b"P"),
    (90, b"XYZ"),
    (120, b"I"),
    (130, b"I"),
    (501, b"XYZ"),
    (511, b"XYZ"),
    (510, b"PIJK"),
    (541, b"P"),
    (650, b"P"),
    (660, b"P"),
    (670, b""),
    (680, b"R"),
    (690, b""),
    (1000, b"XYZ"),
    (1010, b"XYZ"),
    (1030, b"P"),
    (1100, b""),
    (1110, b""),
    (1120, b""),
    (1130, b""),
    (1500, b"P"),
    (1540, b"P"),
    (1870, b""),
    (2340, b"H"),
    (2540, b""),
    (2550, b""),
    (682, b"XYZIJK"),
    (531, b""),
    (441, b"H"),
];

/// Lines that are looked at.
const LINES: usize = 2000;

/// Whether the beginning of a program has a sign of FANUC or Haas.
pub(crate) fn looks_like(beginning: &[u8]) -> bool {
    let lines = || beginning.split(|&byte| byte == b'\n').take(LINES);
    let mut numbers = BTreeSet::new();
    let mut calls = Vec::new();
    for line in lines() {
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        // The last line may be torn off.
        if let Some(number) = program_number(line) {
            numbers.insert(number);
        }
        if has_sign(line, &mut calls) {
            return true;
        }
    }
    calls.iter().any(|&number| {
        number > 9999 && !numbers.contains(&number) && numbers.contains(&(number % 10_000))
    })
}

/// A refusal of a line, or what reads it where it is a statement of macro B.
pub(crate) fn explained(fault: Fault, line: &[u8]) -> Fault {
    let unread = matches!(
        fault.reason,
        Reason::NumberMissing { .. } | Reason::BadCharacter { .. }
    );
    if unread && has_sign(line, &mut Vec::new()) {
        let what = "statements of macros; --dialect fanuc reads them";
        let start = blanks(line, block_number(line).map_or(0, |(_, end)| end));
        let span = Span::new(start, line.len());
        return Fault::new(span, Reason::SyntaxNotSupported { what });
    }
    fault
}

fn has_sign(line: &[u8], calls: &mut Vec<u32>) -> bool {
    let mut at = blanks(line, block_number(line).map_or(0, |(_, end)| end));
    // O words of LinuxCNC, remarks, and lines that are left out.
    if matches!(line.get(at), Some(b'o' | b'O' | b'%' | b';' | b'/') | None) {
        return false;
    }
    if stands_loop(line).is_some() {
        return true;
    }
    let keyword = |word: &[u8], next: &[u8]| {
        let here = line.get(at..at + word.len());
        let behind = line.get(blanks(line, at + word.len()));
        here.is_some_and(|here| here.eq_ignore_ascii_case(word))
            && behind.is_some_and(|byte| next.contains(byte))
    };
    if keyword(b"IF", b"[") || keyword(b"WHILE", b"[") || keyword(b"GOTO", b"0123456789#[") {
        return true;
    }
    let orders = [&b"POPEN"[..], b"PCLOS", b"DPRNT", b"BPRNT", b"SETVN"];
    let ordered = orders.iter().any(|order| {
        let here = line.get(at..at + order.len());
        here.is_some_and(|here| here.eq_ignore_ascii_case(order))
    });
    if ordered || computes_bare(line.get(at..).unwrap_or_default()) {
        return true;
    }
    let (mut codes, mut letters) = (Vec::new(), Vec::new());
    let mut call = false;
    while let Some(&byte) = line.get(at) {
        match byte {
            b'(' => {
                let rest = &line[at..];
                at += rest
                    .iter()
                    .position(|&byte| byte == b')')
                    .map_or(rest.len(), |end| end + 1);
            }
            b';' => break,
            b',' => {
                let letter = line.get(blanks(line, at + 1)).map(u8::to_ascii_uppercase);
                let value = number(line, blanks(line, at + 1) + 1).is_ok();
                if matches!(letter, Some(b'R' | b'C'))
                    && value
                    && (!codes.is_empty() || !letters.is_empty())
                {
                    return true;
                }
                at += 1;
            }
            _ if byte.is_ascii_alphabetic() => {
                let letter = byte.to_ascii_uppercase();
                let Ok((value, end)) = number(line, at + 1) else {
                    if !matches!(line.get(at + 1), Some(b'#' | b'[')) {
                        // Text, and no block.
                        return false;
                    }
                    letters.push(letter);
                    at += 1;
                    continue;
                };
                match letter {
                    b'G' => codes.extend(Code::of_number(b'G', value, 1).and_then(Code::tenths)),
                    b'M' if (value - 97.0).abs() < 0.5 => codes.push(9700),
                    b'M' => call |= (value - 98.0).abs() < 0.5,
                    b'P' if call && value > 9999.0 && value < 1e8 => {
                        #[allow(
                            clippy::cast_possible_truncation,
                            clippy::cast_sign_loss,
                            reason = "between the bounds checked above"
                        )]
                        calls.push(value as u32);
                        letters.push(letter);
                    }
                    _ => letters.push(letter),
                }
                at = end;
            }
            _ => at += 1,
        }
    }
    let asks =
        |wanted: &[u8]| wanted.is_empty() || letters.iter().any(|letter| wanted.contains(letter));
    // A dwell that LinuxCNC wants `P` for.
    let dwells = codes.contains(&40) && asks(b"XU") && !asks(b"P");
    let mode = codes.contains(&50) && asks(b"P") && !asks(b"XYIJ");
    dwells
        || mode
        || codes.contains(&9700) && asks(b"P")
        || CODES
            .iter()
            .any(|(code, wanted)| codes.contains(code) && asks(wanted))
}

/// Whether a line sets a variable to an expression that stands in no brackets, as in `#1=#1+1`.
fn computes_bare(line: &[u8]) -> bool {
    if line.first() != Some(&b'#') {
        return false;
    }
    let mut depth = 0_u32;
    let (mut equals, mut value) = (false, false);
    for (index, &byte) in line.iter().enumerate() {
        match byte {
            b'(' | b';' | b'<' => return false,
            b'[' => depth += 1,
            b']' => {
                depth = depth.saturating_sub(1);
                value = equals;
            }
            b' ' | b'\t' => {}
            _ if depth > 0 => {}
            b'=' => equals = true,
            // Both languages have `ATAN[ ]/[ ]`.
            b'/' if line.get(index + 1) == Some(&b'[') => value = false,
            b'+' | b'-' | b'*' | b'/' if equals && value => return true,
            // A second assignment or a word behind the first one.
            b'#' if value => return false,
            _ => value = equals && (byte.is_ascii_digit() || byte == b'.'),
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_of_fanuc_are_seen_and_those_of_others_are_none() {
        for text in [
            "%\nO0042\nWHILE [#1 LT 6] DO1\n",
            "N10 IF[#1EQ4]GOTO20",
            "GOTO 10",
            "END1",
            "G65 P9010 A10.",
            "G68 X0 Y0 R30.",
            "G187 P3",
            "G0 G90 G54.1 P3 X0",
            "G154 P2",
            "M97 P100",
            "G4 X2.",
            "N5 G04 U1.5",
            "#1=#1+1",
            "#100 = 5.*#2",
            "N5 #1=SIN[30]*2",
            "#[#1+2]=[3]-1",
            "POPEN",
            "DPRNT[X#1[44]]",
            "G5 P10000",
            "G05.1 Q1",
            "G1 X10,R2",
            "X20. , C1.",
            "O1\nM98 P31001\nM30\nO1001\nM99",
        ] {
            assert!(looks_like(text.as_bytes()), "{text}");
        }
        for text in [
            "%\nO0100\nG21 G90\n#1=5\nG0 X#1\nM98 P1000 L3\nM30\nO1000\nM99\n%",
            "o100 while [#1 LT 6]\no100 endwhile",
            "o<x> if [1 EQ 1]",
            "G5 I0 J3 P0 Q-3 X1 Y1",
            "G5.1 X10 I5 J10",
            "M98 P31001",
            "G4 P2 X1",
            "G4 P0.5\nG1 X4",
            "G4 F2",
            "#1=-5",
            "#1=[#1+1]",
            "#1=#2 #3=4",
            "#1=ATAN[1]/[2]",
            "#1 = 2 (a+b)",
            "#<_a>=1",
            "; IF [a] GOTO 1",
            "(G65 P1)",
            "PARTNO/G65, P1",
            "R1=5 IF R1<5 GOTOF MARK",
            "G1 X10 F100 ; a,R2",
            "D01 H01",
        ] {
            assert!(!looks_like(text.as_bytes()), "{text}");
        }
    }
}
