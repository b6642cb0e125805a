//! The path of tip or tool in parts, and how far a row is from them.
//!
//! Source: distances from segments and arcs, less what rounding may add to them. A move in which the tip
//! stands still belongs to the part before of the tip, and likewise for the tool. Not here: which part a row is on.

use crate::axis_vector::AxisVector;
use crate::great_circle::GreatCircle;
use crate::numeric::SHORTEST_LENGTH;
use crate::pose::ToolPose;
use crate::pose_leg::{PoseLeg, PosePath};
use crate::vector::Vector;
use crate::verify::pose::STRAIGHT_SLACK;
use crate::verify::pose::away::{from_arc, from_segment};
use crate::verify::pose::course::from_straight;
use crate::verify::report::Place;

/// What is followed along the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Followed {
    /// The tool tip, mm.
    Tip,
    /// The orientation of the tool, rad.
    Tool,
}

/// A row, and the way to it from the one before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) time: f64,
    pub(super) axes: AxisVector,
    pub(super) pose: ToolPose,
    /// Pose of the row before; its own for the first.
    pub(super) from: ToolPose,
    /// What rounding may do to the tip, mm, and to the orientation, rad.
    pub(super) slack: [f64; 2],
    /// How far tip and orientation may be from the chord between the two rows.
    pub(super) bulge: [f64; 2],
}

/// Where a part of the path leads.
#[derive(Clone, Debug)]
pub(super) enum Way {
    Line([Vector<3>; 2]),
    Arc(GreatCircle),
    /// A straight move of axes.
    Axes(Box<[AxisVector; 2]>),
}

/// A part of the path.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) way: Way,
    pub(super) place: Place,
    /// Tolerance along it.
    pub(super) tolerance: f64,
    /// Tolerance at its end.
    pub(super) at_end: f64,
}

impl Part {
    /// Whether it is a straight move of axes.
    pub(super) fn is_of_axes(&self) -> bool {
        matches!(self.way, Way::Axes(_))
    }

    /// How far a row is from the part at least, mm or rad.
    pub(super) fn away(&self, row: &Row) -> f64 {
        let [tip, tool] = row.slack;
        let away = match &self.way {
            Way::Line([start, end]) => from_segment(&row.pose.tip(), start, end) - tip,
            Way::Arc(turn) => from_arc(&row.pose.orientation(), turn) - tool,
            Way::Axes(ends) => from_straight(&row.axes, &ends[0], &ends[1]) - tip - tool,
        };
        away.max(0.0)
    }

    /// How far from its end the motion passed between the row before and a row at least, mm or rad. The end of a
    /// move of axes is where the next move begins, and that is enough.
    pub(super) fn passed(&self, row: &Row) -> f64 {
        let away = match &self.way {
            Way::Line([_, end]) => {
                from_segment(end, &row.from.tip(), &row.pose.tip()) - row.slack[0] - row.bulge[0]
            }
            // Between two rows the tool turns so little that its way is straight.
            Way::Arc(turn) => {
                let (from, to) = (row.from.orientation(), row.pose.orientation());
                from_segment(&turn.end(), &from, &to) - row.slack[1] - row.bulge[1]
            }
            Way::Axes(_) => 0.0,
        };
        away.max(0.0)
    }
}

/// Adds a leg to the parts of a path.
pub(super) fn add(parts: &mut Vec<Part>, followed: Followed, leg: &PoseLeg, place: Place) {
    let (way, tolerance, moves) = match (&leg.path, followed) {
        (PosePath::Tool { tip, .. }, Followed::Tip) => (
            Way::Line(*tip),
            leg.tip_tolerance.length(),
            leg.length() > SHORTEST_LENGTH,
        ),
        (PosePath::Tool { turn, .. }, Followed::Tool) => (
            Way::Arc(*turn),
            leg.orientation_tolerance.angle(),
            turn.angle() > 0.0,
        ),
        (PosePath::Axes { start, end }, _) => {
            (Way::Axes(Box::new([*start, *end])), STRAIGHT_SLACK, true)
        }
        (PosePath::Dwell { .. }, _) => return,
    };
    if let Some(before) = parts.last_mut() {
        let of_tool = !before.is_of_axes();
        if of_tool && !matches!(way, Way::Axes(_)) {
            before.at_end = before.at_end.min(tolerance);
        }
        #[allow(
            clippy::float_cmp,
            reason = "tolerances that a program repeats are the same"
        )]
        let same = before.tolerance == tolerance;
        if of_tool && !moves && same {
            return;
        }
    }
    parts.push(Part {
        way,
        place,
        tolerance,
        at_end: tolerance,
    });
}
