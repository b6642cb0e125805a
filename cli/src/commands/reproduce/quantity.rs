//! Defines the quantities that are compared with print.
//!
//! Not here: its value.

use crate::commands::reproduce::experiments::Course;
use crate::commands::reproduce::poses::PosePath;
use toolglide_fiveaxis::PoseMethod;

/// A number of a figure or table.
#[derive(Clone, Copy, Debug)]
pub(super) enum Quantity {
    /// Time for the whole program.
    CycleTime(Planned),
    /// Speed at which the first corner is entered.
    CornerSpeed(Planned),
    /// Cycle time of one method as a share of that of another.
    Ratio(Planned, &'static str),
    /// By how much longer one method takes than another, for each of the corners.
    PerCorner(Planned, &'static str, u32),
    /// The turn above which a corner is faster with uninterrupted acceleration, within this
    /// tolerance, mm.
    Crossover(f64),
    /// Largest feedrate on a circle of this radius within this tolerance, mm, behind the filters.
    CircleFeed(&'static Course, f64, f64),
    /// Gain of the filters at a frequency, Hz.
    Gain(&'static Course, f64),
    /// Largest distance from the path.
    Deviation(Planned),
    /// Root mean square of the distance from the planned motion, behind the reference drive.
    ContourRms(Planned),
    /// Largest distance from the planned motion, behind the reference drive.
    ContourLargest(Planned),
    /// Time for a path of tool poses.
    PoseTime(&'static PosePath, PoseMethod),
    /// By how much one method is faster than another on a path of tool poses, percent.
    PoseGain(&'static PosePath, PoseMethod, PoseMethod),
    /// Largest acceleration of the tool tip by one method over that by another, on a path of tool poses.
    PoseAcceleration(&'static PosePath, PoseMethod, PoseMethod),
    /// Root mean square of the distance of the tool tip from the planned motion behind the drives of a mill.
    PoseServo(&'static PosePath, PoseMethod),
    /// Root mean square of the distance of the tool tip from the program behind the drives of a mill.
    PosePart(&'static PosePath, PoseMethod),
    /// What a motion leaves in a beam behind the drives, by its place among the beams.
    BeamLeft(Planned, usize),
    /// Largest acceleration of a beam behind the drives.
    BeamAcceleration(Planned, usize),
    /// How long two moves of a path of tool poses are under way at the same time.
    PoseOverlap(&'static PosePath, PoseMethod),
}

/// A method of tool poses as the command line calls it.
fn called(method: PoseMethod) -> &'static str {
    match method {
        PoseMethod::PointToPoint => "p2p",
        PoseMethod::DwellControlled => "ns-dcb",
        PoseMethod::VelocityControlled => "ns-vcb",
        PoseMethod::JointSpace { way_points: 1.. } => "ns-jcb with way-points",
        _ => "ns-jcb",
    }
}

/// A program planned by a method.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planned {
    pub(super) course: &'static Course,
    pub(super) method: &'static str,
}

impl Quantity {
    /// The program, where there is one.
    pub(super) fn program(&self) -> Option<&'static str> {
        match self {
            Self::CycleTime(planned)
            | Self::CornerSpeed(planned)
            | Self::Deviation(planned)
            | Self::ContourRms(planned)
            | Self::ContourLargest(planned)
            | Self::BeamLeft(planned, _)
            | Self::BeamAcceleration(planned, _)
            | Self::Ratio(planned, _)
            | Self::PerCorner(planned, _, _) => Some(planned.course.name),
            Self::CircleFeed(course, ..) | Self::Gain(course, _) => Some(course.name),
            Self::PoseTime(path, _)
            | Self::PoseGain(path, ..)
            | Self::PoseAcceleration(path, ..)
            | Self::PoseServo(path, _)
            | Self::PosePart(path, _)
            | Self::PoseOverlap(path, _) => Some(path.name),
            Self::Crossover(_) => None,
        }
    }

    /// What it is, in words.
    pub(super) fn name(&self) -> String {
        match self {
            Self::CycleTime(planned) => format!("cycle time, {}", planned.method),
            Self::CornerSpeed(planned) => format!("corner speed, {}", planned.method),
            Self::Ratio(planned, other) => format!("cycle time, {} / {other}", planned.method),
            Self::PerCorner(planned, other, _) => {
                format!("per corner, {} - {other}", planned.method)
            }
            Self::CircleFeed(_, radius, _) => format!("largest feedrate, radius of {radius} mm"),
            Self::Gain(_, frequency) => format!("gain of the filters at {frequency} Hz"),
            Self::Deviation(planned) => format!("deviation, {}", planned.method),
            Self::ContourRms(planned) => format!("contour error RMS, {}", planned.method),
            Self::ContourLargest(planned) => format!("largest contour error, {}", planned.method),
            Self::PoseTime(_, method) => format!("cycle time, {}", called(*method)),
            Self::PoseGain(_, method, other) => {
                format!("{} faster than {}", called(*method), called(*other))
            }
            Self::PoseAcceleration(_, method, other) => {
                format!("tip acceleration, {} / {}", called(*method), called(*other))
            }
            Self::PoseServo(_, method) => {
                format!("tip error RMS to the plan, {}", called(*method))
            }
            Self::PosePart(_, method) => {
                format!("tip error RMS to the program, {}", called(*method))
            }
            Self::BeamLeft(planned, beam) => {
                format!("left in beam {}, {}", ["X", "Y"][beam % 2], planned.method)
            }
            Self::BeamAcceleration(planned, beam) => format!(
                "largest beam acceleration {}, {}",
                ["X", "Y"][beam % 2],
                planned.method
            ),
            Self::PoseOverlap(_, method) => {
                format!("blend time of the corner, {}", called(*method))
            }
            Self::Crossover(tolerance) => format!("crossover turn at {:.0} µm", 1e3 * tolerance),
        }
    }

    /// Its unit; nothing for a ratio.
    pub(super) fn unit(&self) -> &'static str {
        match self {
            Self::CycleTime(_) | Self::PoseTime(..) => "s",
            Self::PoseGain(..) => "%",
            Self::CornerSpeed(_) | Self::CircleFeed(..) => "mm/s",
            Self::Ratio(..) | Self::Gain(..) | Self::PoseAcceleration(..) => "",
            Self::BeamAcceleration(..) => "mm/s²",
            Self::Deviation(_)
            | Self::ContourRms(_)
            | Self::ContourLargest(_)
            | Self::BeamLeft(..)
            | Self::PoseServo(..)
            | Self::PosePart(..) => "µm",
            Self::PerCorner(..) | Self::PoseOverlap(..) => "ms",
            Self::Crossover(_) => "deg",
        }
    }

    /// Decimals with which it is shown: one or two more than are printed.
    pub(super) fn decimals(&self) -> usize {
        match self {
            Self::CycleTime(_) | Self::PoseTime(..) | Self::Gain(..) => 5,
            Self::CornerSpeed(_)
            | Self::PerCorner(..)
            | Self::PoseOverlap(..)
            | Self::CircleFeed(..)
            | Self::ContourRms(_)
            | Self::ContourLargest(_)
            | Self::BeamLeft(..)
            | Self::PoseServo(..)
            | Self::PosePart(..)
            | Self::PoseAcceleration(..)
            | Self::Deviation(_) => 2,
            Self::Ratio(..) => 4,
            Self::Crossover(_) | Self::PoseGain(..) | Self::BeamAcceleration(..) => 1,
        }
    }
}
