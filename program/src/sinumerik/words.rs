//! Lists words of Sinumerik without effect, and those that are refused.
//!
//! Source: the programming manual of Sinumerik 840D sl. Not here: words that do something.

/// Words of no effect on the path: compression, feed-forward, ways of accelerating, orientation, blanks
/// for the simulation.
const SILENT: [&str; 50] = [
    "BRISK",
    "BRISKA",
    "CDOF",
    "CDOF2",
    "CDON",
    "CFC",
    "CFIN",
    "CFTCP",
    "COMPCAD",
    "COMPCURV",
    "COMPOF",
    "COMPON",
    "COMPSURF",
    "CUT2D",
    "CUT2DF",
    "DIAMOF",
    "DISPLOF",
    "DRIVE",
    "DYNFINISH",
    "DYNNORM",
    "DYNPOS",
    "DYNROUGH",
    "DYNSEMIFIN",
    "FFWOF",
    "FFWON",
    "FGROUP",
    "FIFOCTRL",
    "FNORM",
    "G0FRAME",
    "GROUP_BEGIN",
    "GROUP_END",
    "MSG",
    "NORM",
    "ORICONIO",
    "ORIMKS",
    "ORIWKS",
    "OSOF",
    "RTLIOF",
    "RTLION",
    "SAVE",
    "SBLOF",
    "SBLON",
    "SETMS",
    "SOFT",
    "SPATH",
    "STOPFIFO",
    "STOPRE",
    "UPATH",
    "WALIMON",
    "WORKPIECE",
];

/// Words that are known, and why they are refused; a word that ends in `*` stands for all that begin so.
const NOT_READ: [(&str, &str); 35] = [
    ("ACC", "limits of axes by the program"),
    ("AKIMA", "splines"),
    ("AMIRROR", "mirrored frames"),
    ("AR", "arcs by their angle"),
    ("ASCALE", "scaled frames"),
    ("ASPLINE", "splines"),
    ("BSPLINE", "splines"),
    ("CALL", "calls of subprograms"),
    ("CASE", "jumps by a value"),
    ("CHF", "chamfers between blocks"),
    ("CHR", "chamfers between blocks"),
    ("CIP", "arcs by a point on them"),
    ("CSPLINE", "splines"),
    ("CT", "arcs that go on smoothly"),
    ("CYCLE*", "cycles"),
    ("FB", "feedrates for one block"),
    ("GOTOS", "a program without end"),
    ("HOLES*", "cycles"),
    ("KONT", "ways of beginning compensation other than NORM"),
    ("KONTC", "ways of beginning compensation other than NORM"),
    ("KONTT", "ways of beginning compensation other than NORM"),
    ("LONGHOLE", "cycles"),
    ("MCALL", "calls of subprograms"),
    ("MIRROR", "mirrored frames"),
    ("PCALL", "calls of subprograms"),
    ("POCKET*", "cycles"),
    ("POLY", "polynomials"),
    ("RND", "rounding between blocks"),
    ("RNDM", "rounding between blocks"),
    ("SCALE", "scaled frames"),
    ("SLOT*", "cycles"),
    ("TRACYL", "transformations other than TRAORI"),
    ("TRANSMIT", "transformations other than TRAORI"),
    ("WALIMOF", "work without limits"),
    ("$*", "variables of the system"),
];

/// What is known of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Known {
    /// Of no effect on the path.
    Silent,
    /// Refused, as part of this.
    NotRead(&'static str),
    /// Nothing.
    Unknown,
}

/// What is known of a word in upper case.
pub(crate) fn known(word: &str) -> Known {
    if SILENT.contains(&word) {
        return Known::Silent;
    }
    let is = |pattern: &str| match pattern.strip_suffix('*') {
        Some(beginning) => word.starts_with(beginning),
        None => word == pattern,
    };
    let found = NOT_READ.iter().find(|(pattern, _)| is(pattern));
    found.map_or(Known::Unknown, |(_, what)| Known::NotRead(what))
}
