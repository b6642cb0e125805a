//! The codes of the language: what each one means and which exclude each other.
//!
//! Source: the modal groups of RS274/NGC, and the codes of LinuxCNC for the names of what is
//! refused. Not here: what a meaning does.

use std::fmt;

/// A number as near as this to a code is that code: the rounding of one multiplication by ten.
const CODE_ROUNDING: f64 = 1e-9;

/// Largest number of a `G` or `M` code.
const LARGEST_CODE: f64 = 999.0;

/// A code such as `G1` or `G91.1`, or the letter of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Code {
    letter: u8,
    tenths: Option<u16>,
}

impl Code {
    /// A letter alone.
    pub(crate) fn letter(letter: u8) -> Self {
        Self {
            letter,
            tenths: None,
        }
    }

    /// A letter and ten times its number.
    pub(crate) const fn new(letter: u8, tenths: u16) -> Self {
        Self {
            letter,
            tenths: Some(tenths),
        }
    }

    /// The code of a number, if it is a multiple of `step` tenths.
    pub(crate) fn of_number(letter: u8, value: f64, step: u16) -> Option<Self> {
        let tenths = (value * 10.0).round();
        if !(0.0..=LARGEST_CODE).contains(&value) || (value * 10.0 - tenths).abs() > CODE_ROUNDING {
            return None;
        }
        // A whole number up to 9990, as checked above.
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "checked above"
        )]
        let tenths = tenths as u16;
        tenths
            .is_multiple_of(step)
            .then_some(Self::new(letter, tenths))
    }

    pub(crate) fn tenths(self) -> Option<u16> {
        self.tenths
    }
}

impl fmt::Display for Code {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", char::from(self.letter))?;
        match self.tenths {
            None => Ok(()),
            Some(tenths) if tenths % 10 == 0 => write!(out, "{}", tenths / 10),
            Some(tenths) => write!(out, "{}.{}", tenths / 10, tenths % 10),
        }
    }
}

/// How axis words move the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    /// No motion mode: before the first one and after `G80`.
    Off,
    Rapid,
    Line,
    Clockwise,
    CounterClockwise,
}

impl Motion {
    pub(crate) fn code(self) -> Code {
        match self {
            Self::Off => Code::new(b'G', 800),
            Self::Rapid => Code::new(b'G', 0),
            Self::Line => Code::new(b'G', 10),
            Self::Clockwise => Code::new(b'G', 20),
            Self::CounterClockwise => Code::new(b'G', 30),
        }
    }

    pub(crate) fn is_arc(self) -> bool {
        matches!(self, Self::Clockwise | Self::CounterClockwise)
    }
}

/// Plane of the arcs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Plane {
    Xy,
    Zx,
    Yz,
}

/// Whether numbers are places or steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Distance {
    Absolute,
    Incremental,
}

/// What `F` means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FeedMode {
    InverseTime,
    PerMinute,
}

/// What happens between moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PathControl {
    ExactStop,
    Blend,
}

/// What stops a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stop {
    Pause,
    End,
}

/// What a code does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    Motion(Motion),
    Dwell,
    Plane(Plane),
    Inch,
    Millimeter,
    Distance(Distance),
    ArcDistance(Distance),
    FeedMode(FeedMode),
    PathControl(PathControl),
    Stop(Stop),
    /// Of no effect on the motion.
    Nothing,
}

/// Codes that exclude each other in a block; [`Group::COUNT`] of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Group {
    NonModal,
    Motion,
    Plane,
    Distance,
    ArcDistance,
    FeedMode,
    Units,
    CutterCompensation,
    ToolLength,
    Coordinates,
    PathControl,
    Stop,
    ToolChange,
    Spindle,
    Coolant,
    SecondCoolant,
    Overrides,
}

impl Group {
    pub(crate) const COUNT: usize = Self::Overrides as usize + 1;

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::NonModal => "codes for one block",
            Self::Motion => "motion",
            Self::Plane => "plane",
            Self::Distance => "distance mode",
            Self::ArcDistance => "distance mode of arcs",
            Self::FeedMode => "feed mode",
            Self::Units => "units",
            Self::CutterCompensation => "cutter compensation",
            Self::ToolLength => "tool length",
            Self::Coordinates => "coordinate system",
            Self::PathControl => "path control",
            Self::Stop => "stop",
            Self::ToolChange => "tool change",
            Self::Spindle => "spindle",
            Self::Coolant | Self::SecondCoolant => "coolant",
            Self::Overrides => "overrides",
        }
    }
}

/// What is known of a code that is not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unread {
    /// Known by name.
    Known(&'static str),
    /// Known by name, and certain not to move an axis or to change how later words do.
    Harmless(&'static str),
    /// Not known.
    Unknown,
    /// Not known, but of a kind that moves no axis.
    UnknownHarmless,
}

/// Meaning of a `G` code.
pub(crate) fn preparatory(tenths: u16) -> Result<(Group, Meaning), Unread> {
    Ok(match tenths {
        0 => (Group::Motion, Meaning::Motion(Motion::Rapid)),
        10 => (Group::Motion, Meaning::Motion(Motion::Line)),
        20 => (Group::Motion, Meaning::Motion(Motion::Clockwise)),
        30 => (Group::Motion, Meaning::Motion(Motion::CounterClockwise)),
        40 => (Group::NonModal, Meaning::Dwell),
        170 => (Group::Plane, Meaning::Plane(Plane::Xy)),
        180 => (Group::Plane, Meaning::Plane(Plane::Zx)),
        190 => (Group::Plane, Meaning::Plane(Plane::Yz)),
        200 => (Group::Units, Meaning::Inch),
        210 => (Group::Units, Meaning::Millimeter),
        400 => (Group::CutterCompensation, Meaning::Nothing),
        490 => (Group::ToolLength, Meaning::Nothing),
        540 => (Group::Coordinates, Meaning::Nothing),
        610 | 611 => (
            Group::PathControl,
            Meaning::PathControl(PathControl::ExactStop),
        ),
        640 => (Group::PathControl, Meaning::PathControl(PathControl::Blend)),
        800 => (Group::Motion, Meaning::Motion(Motion::Off)),
        900 => (Group::Distance, Meaning::Distance(Distance::Absolute)),
        901 => (Group::ArcDistance, Meaning::ArcDistance(Distance::Absolute)),
        910 => (Group::Distance, Meaning::Distance(Distance::Incremental)),
        911 => (
            Group::ArcDistance,
            Meaning::ArcDistance(Distance::Incremental),
        ),
        930 => (Group::FeedMode, Meaning::FeedMode(FeedMode::InverseTime)),
        940 => (Group::FeedMode, Meaning::FeedMode(FeedMode::PerMinute)),
        _ => return Err(unread_preparatory(tenths)),
    })
}

fn unread_preparatory(tenths: u16) -> Unread {
    Unread::Known(match tenths {
        50..=53 | 60..=63 => "splines",
        70 | 80 => "diameters on a lathe",
        100 => "setting offsets and coordinate systems",
        150 | 160 => "polar coordinates",
        170..=199 => "planes of axes other than X, Y and Z",
        280 | 281 | 300 | 301 => "going to a stored point",
        330 | 331 => "motion tied to the spindle",
        380..=389 => "probing",
        410 | 411 | 420 | 421 => "cutter compensation",
        430..=432 => "tool length compensation",
        520 | 920..=923 => "offsets of the coordinate system",
        530 => "machine coordinates",
        550..=593 => "coordinate systems other than G54",
        700..=720 | 730 | 740 | 760 | 810..=890 => "canned cycles",
        950 => "feed for each turn of the spindle",
        960 | 970 => return Unread::Harmless("control of the spindle speed"),
        980 | 990 => return Unread::Harmless("retraction in canned cycles"),
        _ => return Unread::Unknown,
    })
}

/// Meaning of an `M` code.
pub(crate) fn miscellaneous(tenths: u16) -> Result<(Group, Meaning), Unread> {
    Ok(match tenths / 10 {
        0 | 1 | 60 => (Group::Stop, Meaning::Stop(Stop::Pause)),
        2 | 30 => (Group::Stop, Meaning::Stop(Stop::End)),
        3..=5 => (Group::Spindle, Meaning::Nothing),
        6 => (Group::ToolChange, Meaning::Nothing),
        // Mist and flood may be turned on together, but neither of them beside off.
        7 | 9 => (Group::Coolant, Meaning::Nothing),
        8 => (Group::SecondCoolant, Meaning::Nothing),
        48 | 49 => (Group::Overrides, Meaning::Nothing),
        47 | 97..=99 => return Err(Unread::Known("jumps and subroutines")),
        70..=73 => return Err(Unread::Known("saving and restoring the modal state")),
        128 | 129 | 428..=430 => return Err(Unread::Known("change of the kinematics")),
        _ => return Err(Unread::UnknownHarmless),
    })
}

/// What a letter stands for that no block may use.
pub(crate) fn unread_letter(letter: u8) -> Option<Unread> {
    Some(match letter {
        b'A' | b'B' | b'C' => Unread::Known("rotary axes"),
        b'U' | b'V' | b'W' => Unread::Known("secondary linear axes"),
        b'D' => Unread::Harmless("number of a cutter radius or a speed"),
        b'E' => Unread::Harmless("extruder or spindle-tied motion"),
        b'H' => Unread::Harmless("number of a tool length"),
        b'L' => Unread::Harmless("count of repetitions"),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_multiples_of_a_tenth() {
        let code = |value| Code::of_number(b'G', value, 1).map(|code| code.to_string());
        assert_eq!(code(91.1).as_deref(), Some("G91.1"), "tenths");
        assert_eq!(code(1.0).as_deref(), Some("G1"), "whole");
        assert_eq!(code(59.3).as_deref(), Some("G59.3"), "59.3");
        for wrong in [1.25, -1.0, 1e6, 999.5, -0.1] {
            assert_eq!(code(wrong), None, "{wrong}");
        }
        assert_eq!(Code::of_number(b'M', 3.5, 10), None, "M codes are whole");
    }
}
