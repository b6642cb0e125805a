//! Recognises the language of a program by its first lines.
//!
//! Source: what slicers write at the head of their files and the orders that only printers have; the first
//! lines of Heidenhain Klartext, of STEP-NC, and of turning programs after ISO 6983. Not here: endings of
//! files, see `language`.

/// Lines that are looked at for signs of a language other than a printer's, which may come later.
const FIRST_LINES: usize = 200;

/// Remarks with which only slicers begin a line, in upper case and without blanks behind the `;`.
const SLICER_REMARKS: [&str; 10] = [
    ";LAYER",
    ";FLAVOR:",
    ";TYPE:",
    ";MINX:",
    ";FILAMENT",
    ";NOZZLE_DIAMETER",
    ";NOZZLETEMPERATURE",
    ";EXTERNALPERIMETERSEXTRUSIONWIDTH",
    ";ESTIMATEDPRINTINGTIME",
    ";HEADER_BLOCK_START",
];

/// Names of slicers in the remark that says who made a file.
const SLICERS: [&str; 16] = [
    "ANYCUBIC",
    "BAMBU",
    "CRAFTWARE",
    "CREALITY",
    "CURA",
    "FLASHPRINT",
    "IDEAMAKER",
    "KIRI",
    "KISSLICER",
    "MATTERCONTROL",
    "ORCA",
    "PRUSA",
    "QIDI",
    "SIMPLIFY3D",
    "SLIC3R",
    "SUPERSLICER",
];

/// How orders of Klipper begin.
const KLIPPER: [&str; 8] = [
    "BED_MESH_",
    "END_PRINT",
    "EXCLUDE_OBJECT",
    "PRINT_END",
    "PRINT_START",
    "SET_PRESSURE_ADVANCE",
    "SET_VELOCITY_LIMIT",
    "START_PRINT",
];

/// Whether a program is one of a printer.
pub(crate) fn is_printer(beginning: &str) -> bool {
    let (mut extrudes, mut serves) = (false, false);
    for line in beginning.lines() {
        let line = line.trim().to_ascii_uppercase();
        if line.starts_with(';') {
            let dense: String = line.split_whitespace().collect();
            let made = ["GENERATED", "SLICED", "CREATED"]
                .iter()
                .any(|word| dense.contains(word));
            if SLICER_REMARKS.iter().any(|sign| dense.starts_with(sign))
                || made && SLICERS.iter().any(|slicer| dense.contains(slicer))
            {
                return true;
            }
            continue;
        }
        if KLIPPER.iter().any(|sign| line.starts_with(sign)) {
            return true;
        }
        let words = line.split(';').next().unwrap_or_default();
        let (code, rest) = first_code(words);
        match code {
            Some(('M', 104 | 109 | 140 | 190)) if has_word(rest, 'S') || has_word(rest, 'R') => {
                return true;
            }
            Some(('M', 82 | 83 | 104 | 106 | 107 | 109 | 140 | 190)) => serves = true,
            Some(('G', 92)) if has_word(rest, 'E') => return true,
            Some(('G', 0..=3)) => extrudes |= has_word(rest, 'E'),
            _ => {}
        }
        if extrudes && serves {
            return true;
        }
    }
    false
}

/// A language that is known by its first lines and not read.
pub(crate) fn unread(beginning: &str) -> Option<&'static str> {
    let lines = || {
        let lines = beginning.lines().map(str::trim);
        lines.filter(|line| !line.is_empty()).take(FIRST_LINES)
    };
    let first = lines().next()?.to_ascii_uppercase();
    if first.starts_with("ISO-10303-21") {
        return Some("STEP-NC (ISO 14649 in a file of ISO 10303-21)");
    }
    if lines().any(is_klartext) {
        return Some("Heidenhain Klartext");
    }
    if first.starts_with('%') && (first.contains("G71") || first.contains("G70")) {
        let starred = lines().filter(|line| line.ends_with('*')).count();
        if starred * 2 > lines().count() {
            return Some("Heidenhain DIN/ISO");
        }
    }
    is_lathe(lines()).then_some("ISO code of a lathe")
}

/// Whether a line can only be one of Klartext: a number, and one of its words.
fn is_klartext(line: &str) -> bool {
    let upper = line.to_ascii_uppercase();
    let unnumbered = upper.trim_start_matches(|letter: char| letter.is_ascii_digit());
    let words = unnumbered.trim_start();
    let numbered = unnumbered.len() < upper.len();
    let begins = |beginnings: &[&str]| beginnings.iter().any(|word| words.starts_with(word));
    begins(&["BEGIN PGM ", "END PGM "])
        || numbered
            && begins(&[
                "BLK FORM ",
                "TOOL CALL ",
                "TOOL DEF ",
                "CYCL DEF ",
                "CALL LBL ",
                "FN 0:",
                "L X",
                "L Y",
                "L Z",
                "L IX",
                "L IY",
                "L IZ",
                "CC X",
                "C X",
            ])
}

/// Whether the lines are those of a lathe: no Y, and two things that only lathes have.
fn is_lathe<'a>(lines: impl Iterator<Item = &'a str>) -> bool {
    let (mut cycles, mut tools, mut speeds, mut steps, mut turns) =
        (false, false, false, false, false);
    for line in lines {
        let upper = line.to_ascii_uppercase();
        let words = without_remarks(&upper);
        if has_word(&words, 'Y') || words.contains(['#', '=', '[']) {
            return false;
        }
        let has = |code: &str| has_code(&words, code);
        let shape = has_word(&words, 'P') && (has_word(&words, 'Q') || has_word(&words, 'R'));
        let turning = ["G70", "G71", "G72", "G73", "G76"].into_iter().any(has);
        cycles |= turning && (shape || has_word(&words, 'U') || has_word(&words, 'W'));
        tools |= has_long_tool(&words);
        speeds |= has("G96") || has("G50") && has_word(&words, 'S');
        steps |= (has_word(&words, 'U') || has_word(&words, 'W')) && !turning;
        turns |= has("G95") || has("G99") && has_word(&words, 'F') && !has_word(&words, 'Z');
    }
    [cycles, tools, speeds, steps, turns]
        .into_iter()
        .filter(|&sign| sign)
        .count()
        >= 2
}

/// A line without what stands in round brackets or behind `;`.
fn without_remarks(line: &str) -> String {
    let mut depth = 0_u32;
    let mut kept = String::with_capacity(line.len());
    for letter in line.split(';').next().unwrap_or_default().chars() {
        match letter {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ if depth == 0 => kept.push(letter),
            _ => {}
        }
    }
    kept
}

/// The first code of a line behind its number, and what follows it.
fn first_code(line: &str) -> (Option<(char, u32)>, &str) {
    let mut rest = line.trim_start();
    if let Some(numbered) = rest.strip_prefix('N') {
        rest = numbered
            .trim_start_matches(|letter: char| letter.is_ascii_digit())
            .trim_start();
    }
    let Some(letter) = rest.chars().next().filter(char::is_ascii_alphabetic) else {
        return (None, rest);
    };
    let behind = &rest[1..];
    let digits = behind
        .find(|digit: char| !digit.is_ascii_digit())
        .unwrap_or(behind.len());
    let number = behind[..digits].parse().ok();
    (number.map(|number| (letter, number)), &behind[digits..])
}

/// Whether a letter with a number stands in a line of words.
fn has_word(words: &str, letter: char) -> bool {
    words.match_indices(letter).any(|(at, _)| {
        let value = words[at + 1..].trim_start();
        value.starts_with(|first: char| first.is_ascii_digit() || "+-.".contains(first))
    })
}

/// Whether a code stands in a line of words, and no longer one that begins so.
fn has_code(words: &str, code: &str) -> bool {
    words.match_indices(code).any(|(at, _)| {
        let next = words[at + code.len()..].chars().next();
        !next.is_some_and(|next| next.is_ascii_digit() || next == '.')
    })
}

/// Whether a tool of four digits stands in a line: its number and that of its offset.
fn has_long_tool(words: &str) -> bool {
    words.match_indices('T').any(|(at, _)| {
        let value = &words[at + 1..];
        let digits = value
            .find(|digit: char| !digit.is_ascii_digit())
            .unwrap_or(value.len());
        digits == 4
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_printer_is_known_by_its_orders_and_by_its_slicer() {
        for text in [
            "; generated by PrusaSlicer 2.7.0 on 2024-01-01\nG1 X1",
            ";FLAVOR:Marlin\n;TIME:100",
            ";Generated with Cura_SteamEngine 5.0",
            "G28\n;LAYER:0\nG1 X1",
            "M104 S200\nG28",
            "M190 S60",
            "G21\nG92 E0\n",
            "M83\nG1 X10 E0.5 F1800",
            "N1 G1 X10E0.5\nM107",
            "EXCLUDE_OBJECT_DEFINE NAME=part\n",
        ] {
            assert!(is_printer(text), "{text}");
        }
        for text in [
            "G21 G90\nM52 P1\nM190 P2\nM67 E3 Q60\nG1 X50 F2000",
            "g21g90f600\ng1x1y2\nG1X2.35e-12",
            "(generated by CAM)\nM3 S100\nG1 X1 F100",
            "; Generated by Fusion 360\nG1 X1",
            "M106 S255\nG1 X1 F100\nM107",
            "M82\nM83\n",
            "G1 X10 E0.5 F1800\n",
        ] {
            assert!(!is_printer(text), "{text}");
        }
    }

    #[test]
    fn languages_that_are_not_read_are_named() {
        let starts = |text: &str, name: &str| {
            assert!(
                unread(text).is_some_and(|found| found.starts_with(name)),
                "{text}"
            );
        };
        starts("0 BEGIN PGM TEST MM\n1 BLK FORM 0.1 Z X+0", "Heidenhain K");
        starts("  10 L X+10 Y-5 R0 FMAX\n", "Heidenhain K");
        starts("%PLATE G71 *\nN10 G30 G17 X+0 Y+0 Z-40*\n", "Heidenhain D");
        starts("\nISO-10303-21;\nHEADER;\n", "STEP-NC");
        starts("G50 S2000\nT0101\nG96 S180 M3\nG0 X52 Z2\n", "ISO code");
        starts("O1\nT0303\nG71 U2 R1\nG71 P10 Q20 U0.5 W0.1 F0.2\n", "ISO");
        for text in [
            "",
            "G21 G90\nG1 X10 Y5 F100\nT12 M6\nG96 S100",
            "T1 M6\nG0 X1 Z5\nG81 X1 Z-1 R1 F50\n",
            "L X\nG1 X1",
            "%\nO0001\nG71\nG1 X1*\n",
            "G0 X1 Z5 W0\nT1 M6\n",
        ] {
            assert_eq!(unread(text), None, "{text}");
        }
    }
}
