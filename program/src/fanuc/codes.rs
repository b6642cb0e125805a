//! Tells what each code of FANUC and Haas mills is: done, noted, or refused by name.
//!
//! Source: the operator's manuals of FANUC 0i and 30i and of Haas mills. Not here: what a code does.

/// What a code of this dialect alone does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Special {
    /// `G9`.
    ExactStop,
    Dwell,
    /// `G5`, `G5.1` and `G8`, which must have their word.
    Mode(u8),
    /// `G10`.
    SetData,
    /// `G12` and `G13`.
    Pocket {
        counter_clockwise: bool,
    },
    /// `G16` and `G15`.
    Polar(bool),
    /// `G27`: to a point, at rapid.
    CheckReference,
    /// `G28`: to the first reference point.
    Home,
    /// `G30`: to the second one, or that of `P`.
    OtherHome,
    /// `G29`: from there.
    FromHome,
    /// `G51` and `G50`.
    Scaling(bool),
    /// `G51.1` and `G50.1`, or `G101` and `G100`.
    Mirror(bool),
    /// `G52`.
    Local,
    /// `G53`.
    Machine,
    /// `G54` to `G59`, which may have `P`.
    System(u8),
    /// `G54.1` and `G154`.
    Extended,
    /// `G110` to `G129`: the additional offset of this number.
    Numbered(u8),
    /// `G65`.
    Call,
    /// `G66`.
    ModalCall,
    /// `G67`.
    EndCall,
    /// `G68` and `G69`.
    Rotation(bool),
    /// `G44`.
    AgainstLength,
    /// `G76`.
    FineBore,
    /// `G87`.
    BackBore,
    /// `G80`.
    EndCycle,
    /// `G92`.
    Shift,
}

/// What becomes of a code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Use {
    /// That of RS274/NGC with this number.
    Same(u16),
    Does(Special),
    /// Said once, with the letters that are its own.
    Noted(&'static str, &'static [u8]),
    Refused(&'static str),
    Unknown,
}

/// What becomes of a `G` code.
pub(crate) fn preparatory(tenths: u16) -> Use {
    use Special as S;
    match tenths {
        0 | 10 | 20 | 30 | 62 | 170 | 180 | 190 | 200 | 210 | 400 | 410 | 420 | 430 | 434 | 435
        | 490 | 610 | 611 | 640 | 730 | 740 | 810 | 820 | 830 | 840 | 850 | 860 | 880 | 890
        | 900 | 901 | 910 | 911 | 921 | 930 | 940 | 970 | 980 | 990 => Use::Same(tenths),
        40 => Use::Does(S::Dwell),
        50 => Use::Does(S::Mode(5)),
        51 => Use::Does(S::Mode(51)),
        80 => Use::Does(S::Mode(8)),
        90 => Use::Does(S::ExactStop),
        100 => Use::Does(S::SetData),
        120 => Use::Does(S::Pocket {
            counter_clockwise: false,
        }),
        130 => Use::Does(S::Pocket {
            counter_clockwise: true,
        }),
        150 => Use::Does(S::Polar(false)),
        160 => Use::Does(S::Polar(true)),
        270 => Use::Does(S::CheckReference),
        280 => Use::Does(S::Home),
        290 => Use::Does(S::FromHome),
        300 => Use::Does(S::OtherHome),
        440 => Use::Does(S::AgainstLength),
        760 => Use::Does(S::FineBore),
        870 => Use::Does(S::BackBore),
        500 => Use::Does(S::Scaling(false)),
        501 | 1000 => Use::Does(S::Mirror(false)),
        510 => Use::Does(S::Scaling(true)),
        511 | 1010 => Use::Does(S::Mirror(true)),
        520 => Use::Does(S::Local),
        530 => Use::Does(S::Machine),
        540 => Use::Does(S::System(1)),
        550 => Use::Does(S::System(2)),
        560 => Use::Does(S::System(3)),
        570 => Use::Does(S::System(4)),
        580 => Use::Does(S::System(5)),
        590 => Use::Does(S::System(6)),
        541 | 1540 => Use::Does(S::Extended),
        650 => Use::Does(S::Call),
        660 => Use::Does(S::ModalCall),
        670 => Use::Does(S::EndCall),
        680 => Use::Does(S::Rotation(true)),
        690 => Use::Does(S::Rotation(false)),
        800 => Use::Does(S::EndCycle),
        920 => Use::Does(S::Shift),
        1100..=1290 if tenths.is_multiple_of(10) => {
            Use::Does(S::Numbered(u8::try_from(tenths / 10 - 109).unwrap_or(1)))
        }
        2340 => Use::Same(434),
        _ => noted(tenths).unwrap_or_else(|| refused(tenths).map_or(Use::Unknown, Use::Refused)),
    }
}

/// Codes that move no axis and change no path.
fn noted(tenths: u16) -> Option<Use> {
    let (what, letters): (_, &[u8]) = match tenths {
        54 => ("vibration control of the drives", b"QPR"),
        110 => ("end of data input", b""),
        131 => (
            "end of polar coordinate interpolation, which never begins here",
            b"",
        ),
        220 => ("stored stroke limits", b"XYZIJK"),
        230 => ("end of stored stroke limits", b""),
        250 | 260 => ("supervision of the spindle", b"PQRI"),
        390 => (
            "an arc around an outside corner, which compensation makes anyway",
            b"XYZIJK",
        ),
        401 => (
            "end of normal direction control, which never begins here",
            b"",
        ),
        620 => ("feedrate at inside corners", b""),
        630 => ("tapping mode", b""),
        1020 => ("output to a file", b"XYZABC"),
        1030 => ("limit of the blocks that are read ahead", b"P"),
        1870 => ("smoothness of the control", b"PE"),
        2550 => ("end of dynamic work offsets, which never begin here", b""),
        _ => return None,
    };
    Some(Use::Noted(what, letters))
}

/// Codes that are known, and not read.
fn refused(tenths: u16) -> Option<&'static str> {
    Some(match tenths {
        70 => "diameters on a lathe",
        71 | 1070 => "interpolation on a cylinder",
        121 => "interpolation in polar coordinates",
        310..=319 | 360 => "skipping at a signal: where it ends is not known before",
        370 | 380..=389 => "probing: where it ends is not known before",
        330 | 340 | 350 | 842 | 843 | 1840 => "motion tied to the spindle",
        1500 => "pockets of any shape",
        411 | 421 | 1510 | 1520 => "normal direction control, which turns a rotary axis",
        431 => "tool lengths along the axis of the tool",
        450..=480 => "offsets of tools by moves, and engraving",
        511..=512 => "turning of polygons",
        531 => "turning the tool onto a plane",
        542 => "offsets of a turning fixture",
        600 => "positioning from one side",
        661 => "macros called by every block, with arguments of its own",
        682..=684 | 2680 | 2690 => "tilted work planes",
        700..=720 => "cycles of a lathe, or patterns of holes on Haas",
        770 => "back boring of Haas",
        750 => "cycles of a grinder",
        950 => "feed for each turn of the spindle",
        960 => "constant surface speed",
        1360 | 1370 => "probing: where it ends is not known before",
        1410 => "compensation in three dimensions",
        1430 => "tool lengths of five axes",
        1530 | 1550 | 1610..=1690 => "cycles of five axes",
        1740 => "tapping along no axis",
        2530 | 2540 => "dynamic work offsets",
        _ => return None,
    })
}

/// What becomes of an `M` code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Machine {
    /// That of RS274/NGC.
    Same,
    /// `M98`.
    Call,
    /// `M198`.
    CallOutside,
    /// `M97`.
    CallBlock,
    /// `M99`.
    Return,
    Refused(&'static str),
    /// A function of the machine.
    Noted,
}

/// What becomes of an `M` code, by its number.
pub(crate) fn miscellaneous(number: u16) -> Machine {
    match number {
        0..=9 | 30 | 60 => Machine::Same,
        96 => Machine::Refused("jumps and interruptions at a signal"),
        97 => Machine::CallBlock,
        98 => Machine::Call,
        99 => Machine::Return,
        109 => Machine::Refused("questions to the operator"),
        198 => Machine::CallOutside,
        _ => Machine::Noted,
    }
}
