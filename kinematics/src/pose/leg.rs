//! Represents a pose move with a known start: a line of the tool tip and a turn of the tool, or a
//! straight move of all axes.
//!
//! Source: section 5.2. Not here: words of programs, see [`PoseMove`](crate::PoseMove), and time.

use crate::axis_vector::AxisVector;
use crate::error::ToolpathError;
use crate::machine::{Axis, AxisKind};
#[cfg(not(feature = "std"))]
use crate::no_std::*;
use crate::numeric::SHORTEST_LENGTH;
use crate::pose::great_circle::GreatCircle;
use crate::pose::moves::PoseFeed;
use crate::pose::tool_pose::ToolPose;
use crate::tolerance::{OrientationTolerance, Tolerance};
use crate::vector::Vector;

/// The points of a pose leg.
#[derive(Clone, Debug, PartialEq)]
pub enum PosePath {
    /// The tip goes straight and the tool turns about one axis, both in the same shares.
    Tool {
        /// Tool tip at the start and at the end.
        tip: [Vector<3>; 2],
        /// The turn of the tool.
        turn: GreatCircle,
    },
    /// The tip goes straight and the rotary axes go evenly, in the same shares: the tool swings as they do.
    Rotary {
        /// Tool tip at the start and at the end.
        tip: [Vector<3>; 2],
        /// Positions of the rotary axes at the start and at the end, in machine order; those of linear axes are 0.
        axes: [AxisVector; 2],
        /// Angle by which the tool swings on its way, rad.
        angle: f64,
    },
    /// All axes go straight, in the same shares.
    Axes {
        /// Axis positions at the start.
        start: AxisVector,
        /// Axis positions at the end.
        end: AxisVector,
    },
    /// Standing still.
    Dwell {
        /// For how long, s.
        duration: f64,
    },
}

/// A pose move with its start, its bounds, and the line that it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseLeg {
    /// Its points.
    pub path: PosePath,
    /// How fast it is followed.
    pub feed: PoseFeed,
    /// How far the tool tip may leave it.
    pub tip_tolerance: Tolerance,
    /// How far the tool may turn away from it.
    pub orientation_tolerance: OrientationTolerance,
    /// Whether the motion must come to rest exactly at its end.
    pub stop: bool,
    /// Line of the program, counted from 1; 0 when it comes from none.
    pub line: u32,
}

impl PoseLeg {
    /// A leg from one pose to another that does not stop.
    ///
    /// # Errors
    /// [`ToolpathError::Opposite`] for orientations between which the turn is open.
    ///
    /// # Examples
    /// ```
    /// use toolglide_kinematics::{
    ///     Feedrate, OrientationTolerance, PoseFeed, PoseLeg, Tolerance, ToolPose, Vector,
    /// };
    /// let start = ToolPose::upright(Vector::zeros())?;
    /// let end = ToolPose::new(Vector::<3>::new(3.0, 4.0, 0.0), Vector::<3>::new(0.6, 0.0, 0.8))?;
    /// let leg = PoseLeg::between(
    ///     &start,
    ///     &end,
    ///     PoseFeed::Speed(Feedrate::new(50.0)?),
    ///     Tolerance::new(0.01)?,
    ///     OrientationTolerance::new(0.01)?,
    /// )?;
    /// assert!((leg.length() - 5.0).abs() < 1e-15);
    /// # Ok::<(), toolglide_kinematics::ToolpathError>(())
    /// ```
    pub fn between(
        start: &ToolPose,
        end: &ToolPose,
        feed: PoseFeed,
        tip_tolerance: Tolerance,
        orientation_tolerance: OrientationTolerance,
    ) -> Result<Self, ToolpathError> {
        Ok(Self {
            path: PosePath::Tool {
                tip: [start.tip(), end.tip()],
                turn: GreatCircle::between(start, end)?,
            },
            feed,
            tip_tolerance,
            orientation_tolerance,
            stop: false,
            line: 0,
        })
    }

    /// The line of the tool tip; `None` for what is none.
    #[must_use]
    pub fn tip(&self) -> Option<[Vector<3>; 2]> {
        match &self.path {
            PosePath::Tool { tip, .. } | PosePath::Rotary { tip, .. } => Some(*tip),
            _ => None,
        }
    }

    /// Length of the way of the tool tip, mm; 0 for what is no line of the tip.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.tip().map_or(0.0, |tip| (tip[1] - tip[0]).norm())
    }

    /// How far a straight move of axes goes: the way of the linear axes, mm, and that of the rotary ones, rad; both are
    /// the root of the sum of squares, and 0 for what is no move of axes.
    #[must_use]
    pub fn way_of_axes(&self, axes: &[Axis]) -> (f64, f64) {
        let PosePath::Axes { start, end } = &self.path else {
            return (0.0, 0.0);
        };
        let of = |kind: AxisKind| {
            axes.iter()
                .zip(start.iter().zip(end.iter()))
                .filter(|(axis, _)| axis.kind == kind)
                .map(|(_, (start, end))| (end - start).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        (of(AxisKind::Linear), of(AxisKind::Rotary))
    }

    /// How far the rotary axes turn, rad, the root of the sum of squares, on a leg that turns the tool while its tip stands
    /// still, as words of rotary axes say it; `None` for any other.
    #[must_use]
    pub fn turns_alone(&self) -> Option<f64> {
        let PosePath::Rotary {
            axes: [start, end], ..
        } = &self.path
        else {
            return None;
        };
        let squares = start
            .iter()
            .zip(end.iter())
            .map(|(start, end)| (end - start).powi(2));
        let turned = squares.sum::<f64>().sqrt();
        (self.length() <= SHORTEST_LENGTH && turned > 0.0).then_some(turned)
    }

    /// Angle by which the tool turns, rad; 0 for what is no turn of the tool.
    #[must_use]
    pub fn angle(&self) -> f64 {
        match &self.path {
            PosePath::Tool { turn, .. } => turn.angle(),
            PosePath::Rotary { angle, .. } => *angle,
            _ => 0.0,
        }
    }
}
