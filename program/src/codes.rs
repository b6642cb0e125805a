//! Codes of the language, what they can mean, and which exclude each other.
//!
//! Source: the modal groups of RS274/NGC. Not here: which code means what.

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
    /// Control points and knots of a rational spline.
    Knots,
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
            Self::Knots => Code::new(b'G', 62),
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
    /// `G52`.
    LocalShift,
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

/// Programs with a number within the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Subprogram {
    /// `M98`.
    Call,
    /// `M99`.
    Return,
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
    Subprogram(Subprogram),
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
            Self::Stop => "stop and subprograms",
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
