//! The codes of the language: what each one means and which exclude each other.
//!
//! Source: the modal groups of RS274/NGC, and the codes of LinuxCNC for the names of what is
//! refused. Not here: what a meaning does.

use std::fmt;

/// A number as near as this to a code is that code: the rounding of one multiplication by ten.
const CODE_ROUNDING: f64 = 1e-9;

/// First parameter of the point of `G28`, and of that of `G30`.
const HOME: u16 = 5161;
const SECOND_HOME: u16 = 5181;

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

    pub(crate) fn initial(self) -> u8 {
        self.letter
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
    /// Cubic spline by two offsets.
    Cubic,
    /// Quadratic spline by one offset.
    Quadratic,
    /// Control points of a rational spline.
    Nurbs,
    /// Canned cycle, by the number of its code.
    Cycle(u8),
}

impl Motion {
    pub(crate) fn code(self) -> Code {
        match self {
            Self::Off => Code::new(b'G', 800),
            Self::Rapid => Code::new(b'G', 0),
            Self::Line => Code::new(b'G', 10),
            Self::Clockwise => Code::new(b'G', 20),
            Self::CounterClockwise => Code::new(b'G', 30),
            Self::Cubic => Code::new(b'G', 50),
            Self::Quadratic => Code::new(b'G', 51),
            Self::Nurbs => Code::new(b'G', 52),
            Self::Cycle(number) => Code::new(b'G', 10 * number as u16),
        }
    }

    pub(crate) fn is_cycle(self) -> bool {
        matches!(self, Self::Cycle(_))
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

/// On which side of the path the tool goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Off,
    Left,
    Right,
    /// The diameter stands in the block.
    LeftOf,
    RightOf,
}

/// Where the length of the tool comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ToolLength {
    Off,
    /// From the tool table.
    Table,
    /// From the block.
    Given,
    /// Added to what there is.
    Added,
}

/// What holds for one block only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Once {
    Dwell,
    /// `G10`: offsets and tools.
    SetData,
    /// `G28` or `G30`: go to a stored point, whose first parameter this is.
    GoHome(u16),
    /// `G28.1` or `G30.1`.
    StoreHome(u16),
    /// `G53`.
    MachineCoordinates,
    /// `G92`.
    Shift,
    /// `G92.1`.
    ClearShift,
    /// `G92.2`.
    SuspendShift,
    /// `G92.3`.
    RestoreShift,
}

/// What happens to the modal state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Saving {
    Save,
    Forget,
    Restore,
    /// Restored when the subroutine ends.
    SaveForCall,
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
    /// `G5.3`.
    EndOfNurbs,
    Once(Once),
    Side(Side),
    ToolLength(ToolLength),
    /// Coordinate system, from 1.
    Coordinates(u8),
    /// Whether cycles go back to where they began (`G98`) or to the plane of `R`.
    ReturnToStart(bool),
    ToolChange,
    /// Whether the axis words are those of the tool tip.
    ToolTip(bool),
    Saving(Saving),
    /// The words of a block belong to a function outside the motion.
    Outside,
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
    Return,
    Stop,
    ToolChange,
    Spindle,
    SpindleMode,
    Coolant,
    SecondCoolant,
    Overrides,
    Saving,
    Outside,
}

impl Group {
    pub(crate) const COUNT: usize = Self::Outside as usize + 1;

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
            Self::Return => "return of cycles",
            Self::Stop => "stop",
            Self::ToolChange => "tool change",
            Self::Spindle => "spindle",
            Self::SpindleMode => "spindle mode",
            Self::Coolant | Self::SecondCoolant => "coolant",
            Self::Overrides => "overrides",
            Self::Saving => "saving the modal state",
            Self::Outside => "input and output",
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
    /// Of another machine, and certain not to move an axis: skipped with a warning even by strict
    /// reading.
    Carried,
}

/// Meaning of a `G` code.
pub(crate) fn preparatory(tenths: u16) -> Result<(Group, Meaning), Unread> {
    let motion = |motion| (Group::Motion, Meaning::Motion(motion));
    let once = |once| (Group::NonModal, Meaning::Once(once));
    let side = |side| (Group::CutterCompensation, Meaning::Side(side));
    let length = |length| (Group::ToolLength, Meaning::ToolLength(length));
    let coordinates = |system| (Group::Coordinates, Meaning::Coordinates(system));
    let control = |control| (Group::PathControl, Meaning::PathControl(control));
    Ok(match tenths {
        0 => motion(Motion::Rapid),
        10 => motion(Motion::Line),
        20 => motion(Motion::Clockwise),
        30 => motion(Motion::CounterClockwise),
        40 => once(Once::Dwell),
        50 => motion(Motion::Cubic),
        51 => motion(Motion::Quadratic),
        52 => motion(Motion::Nurbs),
        53 => (Group::Motion, Meaning::EndOfNurbs),
        100 => once(Once::SetData),
        170 => (Group::Plane, Meaning::Plane(Plane::Xy)),
        180 => (Group::Plane, Meaning::Plane(Plane::Zx)),
        190 => (Group::Plane, Meaning::Plane(Plane::Yz)),
        200 => (Group::Units, Meaning::Inch),
        210 => (Group::Units, Meaning::Millimeter),
        280 => once(Once::GoHome(HOME)),
        281 => once(Once::StoreHome(HOME)),
        300 => once(Once::GoHome(SECOND_HOME)),
        301 => once(Once::StoreHome(SECOND_HOME)),
        400 => side(Side::Off),
        410 => side(Side::Left),
        411 => side(Side::LeftOf),
        420 => side(Side::Right),
        421 => side(Side::RightOf),
        430 => length(ToolLength::Table),
        431 => length(ToolLength::Given),
        432 => length(ToolLength::Added),
        490 => length(ToolLength::Off),
        530 => once(Once::MachineCoordinates),
        540 => coordinates(1),
        550 => coordinates(2),
        560 => coordinates(3),
        570 => coordinates(4),
        580 => coordinates(5),
        590 => coordinates(6),
        591 => coordinates(7),
        592 => coordinates(8),
        593 => coordinates(9),
        610 | 611 => control(PathControl::ExactStop),
        640 => control(PathControl::Blend),
        730 => motion(Motion::Cycle(73)),
        740 => motion(Motion::Cycle(74)),
        800 => motion(Motion::Off),
        810 => motion(Motion::Cycle(81)),
        820 => motion(Motion::Cycle(82)),
        830 => motion(Motion::Cycle(83)),
        840 => motion(Motion::Cycle(84)),
        850 => motion(Motion::Cycle(85)),
        860 => motion(Motion::Cycle(86)),
        870 => motion(Motion::Cycle(87)),
        880 => motion(Motion::Cycle(88)),
        890 => motion(Motion::Cycle(89)),
        900 => (Group::Distance, Meaning::Distance(Distance::Absolute)),
        901 => (Group::ArcDistance, Meaning::ArcDistance(Distance::Absolute)),
        910 => (Group::Distance, Meaning::Distance(Distance::Incremental)),
        911 => (
            Group::ArcDistance,
            Meaning::ArcDistance(Distance::Incremental),
        ),
        920 => once(Once::Shift),
        921 => once(Once::ClearShift),
        922 => once(Once::SuspendShift),
        923 => once(Once::RestoreShift),
        930 => (Group::FeedMode, Meaning::FeedMode(FeedMode::InverseTime)),
        940 => (Group::FeedMode, Meaning::FeedMode(FeedMode::PerMinute)),
        970 => (Group::SpindleMode, Meaning::Nothing),
        980 => (Group::Return, Meaning::ReturnToStart(true)),
        990 => (Group::Return, Meaning::ReturnToStart(false)),
        _ => return Err(unread_preparatory(tenths)),
    })
}

fn unread_preparatory(tenths: u16) -> Unread {
    Unread::Known(match tenths {
        60..=63 => "splines with knots of their own",
        70 | 80 => "diameters on a lathe",
        150 | 160 => "polar coordinates by G16; write @ and ^",
        170..=199 => "planes of axes other than X, Y and Z",
        330 | 331 => "motion tied to the spindle",
        380..=389 => "probing: where it ends is not known before",
        434 | 435 => "control of the tool tip, which needs a machine with rotary axes",
        520 => "offsets of the coordinate system by G52; write G92",
        700..=720 | 760 => "cycles of a lathe",
        950 => "feed for each turn of the spindle",
        960 => return Unread::Harmless("constant surface speed"),
        _ => return Unread::Unknown,
    })
}

/// Meaning of an `M` code.
pub(crate) fn miscellaneous(tenths: u16) -> Result<(Group, Meaning), Unread> {
    let saving = |saving| (Group::Saving, Meaning::Saving(saving));
    Ok(match tenths / 10 {
        0 | 1 | 60 => (Group::Stop, Meaning::Stop(Stop::Pause)),
        2 | 30 => (Group::Stop, Meaning::Stop(Stop::End)),
        3..=5 => (Group::Spindle, Meaning::Nothing),
        6 => (Group::ToolChange, Meaning::ToolChange),
        // Mist and flood may be turned on together, but neither of them beside off.
        7 | 9 => (Group::Coolant, Meaning::Nothing),
        8 => (Group::SecondCoolant, Meaning::Nothing),
        48..=53 => (Group::Overrides, Meaning::Nothing),
        62..=68 => (Group::Outside, Meaning::Outside),
        70 => saving(Saving::Save),
        71 => saving(Saving::Forget),
        72 => saving(Saving::Restore),
        73 => saving(Saving::SaveForCall),
        47 | 97..=99 => return Err(Unread::Known("jumps and subroutines other than O words")),
        128 | 129 | 428..=430 => return Err(Unread::Known("change of the kinematics")),
        // Of these LinuxCNC runs a program of the user, and printers heat and blow.
        82..=84 | 100..=199 => return Err(Unread::Carried),
        _ => return Err(Unread::UnknownHarmless),
    })
}

/// Meaning of the codes that only a machine with rotary axes has.
pub(crate) fn of_rotary(letter: u8, tenths: u16) -> Option<(Group, Meaning)> {
    let tip = match (letter, tenths) {
        (b'G', 434 | 435) | (b'M', 1280 | 4280) => true,
        (b'M', 1290 | 4290) => false,
        _ => return None,
    };
    let group = if letter == b'G' {
        Group::ToolLength
    } else {
        Group::Outside
    };
    Some((group, Meaning::ToolTip(tip)))
}

/// What a letter stands for that no block may use.
pub(crate) fn unread_letter(letter: u8) -> Option<Unread> {
    Some(match letter {
        b'A' | b'B' | b'C' => Unread::Known("rotary axes"),
        b'U' | b'V' | b'W' => Unread::Known("secondary linear axes"),
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
