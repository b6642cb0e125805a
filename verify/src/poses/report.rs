//! Reports the findings of the pose judge.
//!
//! Source: the house style of messages: place, quantity, value, bound. Not here: finding it.

use crate::report::{Peak, Place};
use crate::set_points::spacing::Gaps;
use thiserror::Error;
use toolglide_kinematics::AxisKind;

/// How many violations of one kind a report quotes; all are counted.
const EXAMPLES_PER_KIND: u8 = 10;

/// Largest velocity, acceleration and jerk of an axis, and where it went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisPeaks {
    /// Letter of the axis.
    pub name: char,
    /// Largest velocity, mm/s or rad/s.
    pub velocity: Peak,
    /// Largest acceleration.
    pub acceleration: Peak,
    /// Largest jerk.
    pub jerk: Peak,
    /// Lowest position seen, mm or rad.
    pub lowest: f64,
    /// Highest position seen.
    pub highest: f64,
}

/// What a motion of poses did: how long it took, how close to each bound it came, what it broke.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseReport {
    /// How long the motion lasts.
    pub cycle_time: f64,
    /// Length of the path of the tool tip, mm; of a straight move of axes that of its linear axes.
    pub path_length: f64,
    /// Sum of the angles by which the tool turns, rad; of a straight move of axes those of its rotary axes.
    pub path_angle: f64,
    /// How many moves the path has.
    pub moves: u32,
    /// How many pieces of motion were judged.
    pub observed: u64,
    /// One per axis, in machine order.
    pub axes: Vec<AxisPeaks>,
    /// Largest speed of the tool tip.
    pub peak_speed: Peak,
    /// Largest distance of the tool tip from its path where its share of the tolerance is largest.
    pub tip_deviation: Peak,
    /// The same as a share of the tolerance there.
    pub tip_ratio: Peak,
    /// How far the tool tip passes from the corner that it misses by the largest share.
    pub tip_corner: Peak,
    /// The same as a share of the tolerance.
    pub tip_corner_ratio: Peak,
    /// Largest angle between the tool and its path on the sphere.
    pub orientation_deviation: Peak,
    /// The same as a share of the tolerance there.
    pub orientation_ratio: Peak,
    /// How far the tool turns past the orientation that it misses by the largest share.
    pub orientation_corner: Peak,
    /// The same as a share of the tolerance.
    pub orientation_corner_ratio: Peak,
    /// By how much the length of an orientation differs from 1.
    pub unit_error: f64,
    /// How many violations there are.
    pub violations: u64,
    /// The first few violations of each kind, in the order found.
    pub examples: Vec<PoseViolation>,
    /// Set-points that are too far apart to be judged; none for pieces.
    pub gaps: Gaps,
    counts: [u8; PoseViolation::KINDS],
}

impl PoseReport {
    pub(super) fn new(axes: Vec<AxisPeaks>) -> Self {
        Self {
            cycle_time: 0.0,
            path_length: 0.0,
            path_angle: 0.0,
            moves: 0,
            observed: 0,
            axes,
            peak_speed: Peak::default(),
            tip_deviation: Peak::default(),
            tip_ratio: Peak::default(),
            tip_corner: Peak::default(),
            tip_corner_ratio: Peak::default(),
            orientation_deviation: Peak::default(),
            orientation_ratio: Peak::default(),
            orientation_corner: Peak::default(),
            orientation_corner_ratio: Peak::default(),
            unit_error: 0.0,
            violations: 0,
            examples: Vec::new(),
            gaps: Gaps::default(),
            counts: [0; PoseViolation::KINDS],
        }
    }

    /// Whether the motion breaks nothing, and its set-points show that.
    #[must_use]
    pub fn passes(&self) -> bool {
        self.violations == 0 && self.gaps.is_empty()
    }

    pub(super) fn add(&mut self, violation: PoseViolation) {
        self.violations += 1;
        let count = &mut self.counts[violation.kind()];
        if *count < EXAMPLES_PER_KIND {
            *count += 1;
            self.examples.push(violation);
        }
    }

    /// Takes a share of the tolerance of the tip, and the deviation in mm that it is, into the peaks.
    pub(super) fn raise_tip(&mut self, share: f64, value: f64, time: f64, place: Place) {
        if share > self.tip_ratio.value {
            self.tip_ratio.raise(share, time, place);
            self.tip_deviation = Peak { value, time, place };
        }
    }

    /// The same for the orientation, in rad.
    pub(super) fn raise_orientation(&mut self, share: f64, value: f64, time: f64, place: Place) {
        if share > self.orientation_ratio.value {
            self.orientation_ratio.raise(share, time, place);
            self.orientation_deviation = Peak { value, time, place };
        }
    }
}

/// Which derivative of the position of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisQuantity {
    /// The first, mm/s or rad/s.
    Velocity,
    /// The second.
    Acceleration,
    /// The third.
    Jerk,
}

/// A value of an axis as a machinist reads it: rotary axes in degrees.
fn shown(value: f64, kind: AxisKind) -> f64 {
    match kind {
        AxisKind::Linear => value,
        AxisKind::Rotary => value.to_degrees(),
    }
}

/// The unit in which it is shown.
fn unit(kind: AxisKind) -> &'static str {
    match kind {
        AxisKind::Linear => "mm",
        AxisKind::Rotary => "deg",
    }
}

impl AxisQuantity {
    fn per_time(self) -> &'static str {
        match self {
            Self::Velocity => "/s",
            Self::Acceleration => "/s²",
            Self::Jerk => "/s³",
        }
    }
}

impl std::fmt::Display for AxisQuantity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Jerk => "jerk",
        })
    }
}

/// Something that a motion of poses broke, with its value, its bound, when, and on which move.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PoseViolation {
    /// A limit of an axis is exceeded.
    #[error(
        "axis {axis}: {quantity} {} exceeds the limit of {} {}{} at {time:.3} s ({place})",
        shown(*value, *kind),
        shown(*limit, *kind),
        unit(*kind),
        quantity.per_time()
    )]
    Axis {
        /// Letter of the axis.
        axis: char,
        /// What it moves in.
        kind: AxisKind,
        /// Which limit.
        quantity: AxisQuantity,
        /// The value, in mm or rad; told in mm or degrees.
        value: f64,
        /// The limit.
        limit: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// The machine cannot take a pose of the motion.
    #[error("{reason} at {time:.3} s ({place})")]
    Unreachable {
        /// What the machine says.
        reason: String,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// The tool tip is too far from its path.
    #[error(
        "the tool tip is {value} mm from the path, but may be {tolerance} mm at {time:.3} s ({place})"
    )]
    TipDeviation {
        /// The distance.
        value: f64,
        /// The tolerance.
        tolerance: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// The tool is turned too far away from its path.
    #[error(
        "the tool is turned {value} rad away from the path, but may be {tolerance} rad at {time:.3} s ({place})"
    )]
    OrientationDeviation {
        /// The angle.
        value: f64,
        /// The tolerance.
        tolerance: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// The tool tip does not pass near enough to a corner.
    #[error(
        "the tool tip passes {value} mm from the corner, but may pass {tolerance} mm from it ({place})"
    )]
    TipCorner {
        /// The closest approach.
        value: f64,
        /// The tolerance.
        tolerance: f64,
        /// The move that ends in the corner.
        place: Place,
    },
    /// The tool does not pass near enough to a programmed orientation.
    #[error(
        "the tool passes {value} rad from the orientation programmed, but may pass {tolerance} rad from it ({place})"
    )]
    OrientationCorner {
        /// The closest approach.
        value: f64,
        /// The tolerance.
        tolerance: f64,
        /// The move that ends in the orientation.
        place: Place,
    },
    /// A rotary axis leaves the way that its words say.
    #[error(
        "axis {axis} is {} deg from its way, but may be {} deg at {time:.3} s ({place})",
        value.to_degrees(),
        tolerance.to_degrees()
    )]
    RotaryDeviation {
        /// Letter of the axis.
        axis: char,
        /// How far it is from it.
        value: f64,
        /// How far it may be: [`toolglide_kinematics::OrientationTolerance::OF_AXIS`] times the tolerance of the orientation.
        tolerance: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// The axes leave a straight move of axes.
    #[error("the axes are {value} from their straight move at {time:.3} s ({place})")]
    AxesDeviation {
        /// Largest distance of an axis, mm or rad.
        value: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// The tool tip is faster than programmed.
    #[error(
        "speed {value} mm/s of the tool tip exceeds the feedrate of {feedrate} mm/s at {time:.3} s ({place})"
    )]
    Feedrate {
        /// The speed.
        value: f64,
        /// The largest feedrate of the moves served.
        feedrate: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// An exact stop is not made, or the motion does not end at rest at the end of the path.
    #[error("no stop at the end of the move ({place})")]
    StopNotMade {
        /// The move that should end at rest.
        place: Place,
    },
    /// A dwell is cut short.
    #[error("the motion rests {rested} s, but must dwell {duration} s ({place})")]
    DwellTooShort {
        /// How long it rests.
        rested: f64,
        /// How long it must.
        duration: f64,
        /// The dwell.
        place: Place,
    },
    /// Tool or axes jump between two pieces.
    #[error(
        "axis {axis}: {what} jumps by {} {} at {time:.3} s ({place})",
        shown(*value, *kind),
        unit(*kind)
    )]
    Jump {
        /// Letter of the axis.
        axis: char,
        /// What it moves in.
        kind: AxisKind,
        /// Position, velocity or acceleration.
        what: &'static str,
        /// By how much, in mm or rad; told in mm or degrees.
        value: f64,
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// An orientation has not unit length, or a number is none.
    #[error("the pose is no pose at {time:.3} s ({place})")]
    NotFinite {
        /// When.
        time: f64,
        /// Where.
        place: Place,
    },
    /// A piece serves moves out of their order, or a move that there is not.
    #[error("pieces serve moves {first} to {last} out of order at {time:.3} s")]
    MovesOutOfOrder {
        /// First move served.
        first: u32,
        /// Last move served.
        last: u32,
        /// When.
        time: f64,
    },
}

impl PoseViolation {
    /// How many kinds there are.
    pub(super) const KINDS: usize = 14;

    fn kind(&self) -> usize {
        match self {
            Self::Axis { .. } => 0,
            Self::Unreachable { .. } => 1,
            Self::TipDeviation { .. } => 2,
            Self::OrientationDeviation { .. } => 3,
            Self::TipCorner { .. } => 4,
            Self::OrientationCorner { .. } => 5,
            Self::AxesDeviation { .. } => 6,
            Self::Feedrate { .. } => 7,
            Self::StopNotMade { .. } => 8,
            Self::DwellTooShort { .. } => 9,
            Self::Jump { .. } => 10,
            Self::NotFinite { .. } => 11,
            Self::MovesOutOfOrder { .. } => 12,
            Self::RotaryDeviation { .. } => 13,
        }
    }
}
