//! Lists the meaning of each `G` and `M` code, and the reason of each that is not read.
//!
//! Source: RS274/NGC, the manual of LinuxCNC, and `G6.2` and `M98` of FANUC. Not here: what a meaning does.

use crate::block::codes::{
    Distance, FeedMode, Group, Meaning, Motion, Once, PathControl, Plane, Saving, Side, Stop,
    Subprogram, ToolLength,
};

/// First parameter of the point of `G28`, and of that of `G30`.
const HOME: u16 = 5161;
const SECOND_HOME: u16 = 5181;

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
        62 => motion(Motion::Knots),
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
        520 => once(Once::LocalShift),
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
        60 | 61 | 63 => "splines other than G5 to G5.3 and G6.2",
        70 | 80 => "diameters on a lathe",
        150 | 160 => "polar coordinates by G16; write @ and ^",
        170..=199 => "planes of axes other than X, Y and Z",
        330 | 331 => "motion tied to the spindle",
        380..=389 => "probing: where it ends is not known before",
        434 | 435 => "control of the tool tip, which needs a machine with rotary axes",
        700..=720 | 760 => "cycles of a lathe",
        950 => "feed for each turn of the spindle",
        960 => return Unread::Harmless("constant surface speed"),
        90
        | 120
        | 130
        | 270
        | 290
        | 310
        | 440
        | 500..=511
        | 541
        | 600
        | 620
        | 630
        | 650..=690
        | 1030
        | 1100..=1290
        | 1500
        | 1540
        | 1870
        | 2340
        | 2540
        | 2550 => "a code of FANUC or Haas; --dialect fanuc reads programs for them",
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
        19 => (Group::Outside, Meaning::Outside),
        48..=53 => (Group::Overrides, Meaning::Nothing),
        62..=68 => (Group::Outside, Meaning::Outside),
        70 => saving(Saving::Save),
        71 => saving(Saving::Forget),
        72 => saving(Saving::Restore),
        73 => saving(Saving::SaveForCall),
        98 => (Group::Stop, Meaning::Subprogram(Subprogram::Call)),
        99 => (Group::Stop, Meaning::Subprogram(Subprogram::Return)),
        47 => return Err(Unread::Known("a program without end")),
        97 => return Err(Unread::Known("jumps to a line; write M98 or O words")),
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
