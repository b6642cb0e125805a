//! Defines the meanings of codes, and which exclude each other.
//!
//! Source: the modal groups of RS274/NGC. Not here: which code means what.

use crate::block::code::Code;

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
    /// `G87` of FANUC: the tool goes to the bottom beside the hole, and bores upwards.
    BackBore,
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
            Self::BackBore => Code::new(b'G', 870),
        }
    }

    pub(crate) fn is_cycle(self) -> bool {
        matches!(self, Self::Cycle(_) | Self::BackBore)
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

/// What a single word says about its number, whatever the distance mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// A place.
    Absolute,
    /// A step.
    Incremental,
    /// A place of a rotary axis, by the shortest way.
    Shortest,
    /// A place of a rotary axis, turning positively.
    Positive,
    /// A place of a rotary axis, turning negatively.
    Negative,
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
    /// From the tool table, taken off: `G44` of FANUC.
    Against,
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
