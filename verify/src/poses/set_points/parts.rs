//! Divides the path of tip or tool into parts and measures the distance of a row from them.
//!
//! Source: distances from segments and arcs, less what rounding may add to them. A move in which the tip
//! stands still belongs to the part before of the tip, and likewise for the tool. Not here: which part a row is on.

use crate::poses::STRAIGHT_SLACK;
use crate::poses::course::from_straight;
use crate::poses::tool_deviation::{from_arc, from_segment};
use crate::report::Place;
use toolglide_kinematics::GreatCircle;
use toolglide_kinematics::OrientationTolerance;
use toolglide_kinematics::ToolPose;
use toolglide_kinematics::Vector;
use toolglide_kinematics::numeric::SHORTEST_LENGTH;
use toolglide_kinematics::{AxisVector, MAX_AXES};
use toolglide_kinematics::{PoseLeg, PosePath};

/// Share of the difference of an axis that counts where the tool does not tell it.
const FLOOR: f64 = 1.0 / OrientationTolerance::OF_AXIS;

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
    /// Which axes are rotary.
    pub(super) rotary: [bool; MAX_AXES],
    /// Directions in which the tool moves with each rotary axis.
    pub(super) swings: [Vector<3>; MAX_AXES],
    /// Axis positions of the row before; its own for the first.
    pub(super) axes_before: AxisVector,
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
    /// Rotary axes that go evenly: where they begin and end.
    Rotary(Box<[AxisVector; 2]>),
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

impl Row {
    /// How far a position of the rotary axes is from a straight way of theirs, in what the tool shows of it, rad; an axis
    /// that it does not show counts by a share. What the tool shows bends by less than the square of the difference.
    fn shown(&self, at: &AxisVector, start: &AxisVector, end: &AxisVector) -> f64 {
        let (mut span, mut gone) = (Vector::<3>::zeros(), Vector::<3>::zeros());
        let (mut squares, mut products) = (0.0, 0.0);
        let rotary = || {
            self.swings
                .iter()
                .enumerate()
                .filter(|(axis, _)| self.rotary[*axis])
                .map(|(axis, swing)| (swing, end[axis] - start[axis], at[axis] - start[axis]))
        };
        for (swing, whole, part) in rotary() {
            span += swing * whole;
            gone += swing * part;
            squares += FLOOR * FLOOR * whole * whole;
            products += FLOOR * FLOOR * whole * part;
        }
        squares += span.norm_squared();
        products += span.dot(&gone);
        let share = if squares > 0.0 {
            (products / squares).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let (mut most, mut sum) = (0.0_f64, 0.0);
        for (_, whole, part) in rotary() {
            let away = (part - share * whole).abs();
            most = most.max(away);
            sum += away;
        }
        let shown = (gone - span * share).norm();
        (shown - (sum * sum).min(shown)).max(FLOOR * most)
    }
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
            Way::Rotary(ends) => row.shown(&row.axes, &ends[0], &ends[1]) - tool,
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
            Way::Rotary(ends) => {
                row.shown(&ends[1], &row.axes_before, &row.axes) - row.slack[1] - row.bulge[1]
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
        (PosePath::Rotary { tip, .. }, Followed::Tip) => (
            Way::Line(*tip),
            leg.tip_tolerance.length(),
            leg.length() > SHORTEST_LENGTH,
        ),
        (PosePath::Rotary { axes, .. }, Followed::Tool) => (
            Way::Rotary(Box::new(*axes)),
            leg.orientation_tolerance.angle(),
            axes[0] != axes[1],
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
