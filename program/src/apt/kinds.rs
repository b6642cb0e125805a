//! Sorts statements of cutter location files that are not read: silent, noted, refused.
//!
//! Source: ISO 4343 (APT) and the files that NX, Creo, CATIA and others write. Not here: statements that are read.

/// Statements that say nothing about the motion: remarks, pictures, tools, tolerances of the computation.
const SILENT: [&str; 37] = [
    "AIR",
    "ARCSLP",
    "CAMERA",
    "CHECK",
    "CLAMP",
    "CLPRNT",
    "COOLNT",
    "CUTTER",
    "DATE",
    "DISPLY",
    "END-OF-PATH",
    "HEAD",
    "INTOL",
    "LINTOL",
    "LPRINT",
    "MACHIN",
    "MCHTOL",
    "MODE",
    "MULTAX",
    "NOPOST",
    "OUTTOL",
    "PAINT",
    "PARTNO",
    "PLUNGE",
    "PPRINT",
    "REMARK",
    "SELCTL",
    "SEQNO",
    "SYN",
    "TLAXIS",
    "TLDATA",
    "TOLER",
    "TOOL PATH",
    "TOOLNO",
    "TPRINT",
    "VERIFY",
    "ZSURF",
];

/// Statements for the post-processor or the control that move nothing; each kind is told once.
const TOLD: [(&str, &str); 15] = [
    ("AUTOPS", "a word for the post-processor"),
    ("AUXFUN", "a function of the control by its M code"),
    ("BREAK", "a word for the post-processor"),
    ("CLEARP", "a plane for retractions, none of which is read"),
    ("DRESS", "a word for the post-processor"),
    ("LEADER", "a word for the post-processor"),
    ("LOAD", "a change of something else than a tool"),
    ("OPSKIP", "optional blocks, all of which are read"),
    ("PPFUN", "a word for the post-processor"),
    ("PPWORD", "a word for the post-processor"),
    ("PPTABL", "a table for the post-processor"),
    ("REWIND", "a word for the post-processor"),
    ("SAFPOS", "a place for retractions, none of which is read"),
    ("SELECT", "a tool that is made ready"),
    ("TMARK", "a word for the post-processor"),
];

/// How statements begin that move an axis or the part, longer ones before those that they begin with.
const MOVING: [(&str, &str); 46] = [
    ("BORE", "cycles"),
    ("CALL", "a program within the file"),
    ("CBORE", "cycles"),
    ("COPY", "copies of the path"),
    ("CSINK", "cycles"),
    ("CUTCOM", "compensation of the cutter by the control"),
    ("CYCLE", "cycles"),
    ("DRILL", "cycles"),
    ("GOHOME", "a move to a point that only the machine knows"),
    (
        "GO",
        "a move along surfaces, which APT itself would compute",
    ),
    ("INDEX", "copies of the path"),
    (
        "INDIR",
        "a move along surfaces, which APT itself would compute",
    ),
    ("INSERT", "lines for the control as they are"),
    ("JUMPTO", "a program within the file"),
    ("LOOP", "a program within the file"),
    ("MACRO", "a program within the file"),
    ("MATRIX", "a transformation of the path"),
    ("MIRROR", "a transformation of the path"),
    ("MOVETO", "a move whose path only the machine knows"),
    ("MOVNRB", "splines"),
    ("NURBS", "splines"),
    ("ORIGIN", "a shift of the part"),
    ("PATERN", "copies of the path"),
    ("PATTERN", "copies of the path"),
    ("PIVOT", "a shift of the head"),
    ("POSITN", "a move whose path only the machine knows"),
    ("PREFUN", "a function of the control by its G code"),
    ("PROBE", "probing: where it ends is not known before"),
    (
        "PSIS",
        "a move along surfaces, which APT itself would compute",
    ),
    ("REAM", "cycles"),
    (
        "RETRCT",
        "a move to a plane that only the post-processor knows",
    ),
    ("ROTABL", "a turn of the table"),
    ("ROTATE", "a turn of the table or the head"),
    ("ROTHED", "a turn of the head"),
    ("ROT", "a turn of the table or the head"),
    (
        "RTRCTO",
        "a move to a plane that only the post-processor knows",
    ),
    ("SPLINE", "splines"),
    ("TAP", "cycles"),
    ("TERMAC", "a program within the file"),
    ("THREAD", "motion tied to the spindle"),
    (
        "TLLFT",
        "a move along surfaces, which APT itself would compute",
    ),
    (
        "TLON",
        "a move along surfaces, which APT itself would compute",
    ),
    (
        "TLRGT",
        "a move along surfaces, which APT itself would compute",
    ),
    ("TRACUT", "a transformation of the path"),
    ("TRANS", "a transformation of the path"),
    ("TURRET", "a turn of the turret"),
];

/// What becomes of a statement that is not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// It says nothing about the motion.
    Silent,
    /// It moves nothing, which is told once.
    Told(&'static str),
    /// It moves an axis or the part, and is refused whatever is asked for.
    Moving(&'static str),
    /// Nobody knows it.
    Unknown,
}

/// What becomes of a statement, by its major word in upper case.
pub(crate) fn kind(name: &str, items: &[&str]) -> Kind {
    let off = items.len() == 1 && items[0].eq_ignore_ascii_case("OFF");
    let ends = matches!(
        name,
        "CUTCOM" | "CYCLE" | "TRACUT" | "TRANS" | "COPY" | "DRILL"
    );
    if off && ends {
        // None of them was ever on.
        return Kind::Silent;
    }
    let told = TOLD.iter().find(|(word, _)| name == *word);
    let moving = MOVING.iter().find(|(word, _)| name.starts_with(word));
    match (told, moving) {
        (Some((_, what)), _) => Kind::Told(what),
        (None, Some((_, what))) => Kind::Moving(what),
        (None, None) if SILENT.iter().any(|word| name.starts_with(word)) => Kind::Silent,
        (None, None) => Kind::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_an_axis_or_the_part_is_told_from_what_does_not() {
        for name in ["CYCLE", "ROTATE", "TRACUT", "ROTABL", "GOFWD", "GOHOME"] {
            assert!(matches!(kind(name, &[]), Kind::Moving(_)), "{name}");
        }
        for name in ["PPWORD", "AUXFUN", "CLEARP"] {
            assert!(matches!(kind(name, &[]), Kind::Told(_)), "{name}");
        }
        for name in ["PAINT", "TLDATA", "TOOL PATH", "PPRINT THE END"] {
            assert_eq!(kind(name, &[]), Kind::Silent, "{name}");
        }
        assert_eq!(kind("CYCLE", &["OFF"]), Kind::Silent, "off");
        assert_eq!(kind("WIGGLE", &[]), Kind::Unknown, "unknown");
    }
}
