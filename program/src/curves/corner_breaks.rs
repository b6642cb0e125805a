//! Breaks the corner between two moves: a rounding arc, or a chamfer.
//!
//! Source: `,R` and `,C` of the operator's manual of FANUC. The move waits for the next one in its plane, which
//! may be straight or an arc; a chamfer begins and ends at the same distance from the corner. Not here: corners
//! that a planner rounds within its tolerance.

use crate::compensation::offset_curve::{Curve, Flat, cross, dot, minus, norm, plus, scaled};
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::interpreter::Interpreter;
use crate::text::place::Span;
use std::collections::VecDeque;
use toolglide_kinematics::numeric::SHORTEST_LENGTH;
use toolglide_kinematics::{Arc, Feedrate, Move, Path, Vector};

/// Turns smaller than this leave no corner, rad.
const SMOOTH: f64 = 1e-6;

/// How a corner is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CornerKind {
    Round,
    Chamfer,
}

/// A move that waits for the next one, and how the corner between them is broken.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    kind: CornerKind,
    /// Radius of the arc, or distance of both ends of the chamfer from the corner, mm.
    size: f64,
    step: Move<3>,
    start: Vector<3>,
}

/// Where the moves beside a broken corner end and begin, and the centre of its arc.
struct Break {
    from: Flat,
    to: Flat,
    center: Option<(Flat, bool)>,
}

impl Interpreter {
    /// Keeps a move back whose end is a corner to be broken.
    pub(crate) fn hold_corner(
        &mut self,
        (kind, written, span): (CornerKind, f64, Span),
        step: Move<3>,
        start: Vector<3>,
    ) -> Result<(), Fault> {
        let letter = if kind == CornerKind::Round { 'R' } else { 'C' };
        let at = |reason| Fault::new(span, reason);
        let plane = self.modal.plane;
        let size = self
            .modal
            .units
            .bounded_length(letter, written)
            .map_err(at)?
            * self.offsets.frame().scale(plane.axes()[0]);
        if size < 0.0 {
            let (quantity, value) = ("size of a corner", written);
            return Err(at(Reason::Negative { quantity, value }));
        }
        if step.feedrate() == Feedrate::RAPID {
            return Err(at(MachiningError::CornerNeeds {
                what: "G1, G2 or G3",
            }
            .into()));
        }
        self.corner = Some(Corner {
            kind,
            size,
            step,
            start,
        });
        Ok(())
    }

    /// A refusal of something that a corner cannot be followed by.
    pub(crate) fn corner_left(&mut self, otherwise: Span) -> Fault {
        self.corner = None;
        let what = "a straight move or an arc in its plane behind it";
        Fault::new(otherwise, MachiningError::CornerNeeds { what }.into())
    }

    /// Hands a move on behind the one whose corner waits.
    pub(crate) fn break_corner(
        &mut self,
        corner: Corner,
        next: Move<3>,
        span: Span,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(Move<3>, Vector<3>), Fault> {
        let plane = self.modal.plane;
        let (axes, normal) = (plane.axes(), plane.normal());
        let middle = corner.step.end(corner.start);
        let refuse = |what| Fault::new(span, MachiningError::CornerNeeds { what }.into());
        let end = next.end(middle);
        let flat = |point: Vector<3>| axes.map(|axis| point[axis]);
        let same = |one: Vector<3>| (one[normal] - middle[normal]).abs() <= SHORTEST_LENGTH;
        let level = same(end) && same(corner.start);
        if next.feedrate() == Feedrate::RAPID || !level {
            return Err(refuse("a straight move or an arc in its plane behind it"));
        }
        let (one, other) = (
            curve(&corner.step, corner.start, flat),
            curve(&next, middle, flat),
        );
        let broken = match corner.kind {
            CornerKind::Round => rounded(&one, &other, corner.size),
            CornerKind::Chamfer => chamfered(&one, &other, corner.size),
        };
        let broken = broken.map_err(refuse)?;
        let Some(broken) = broken else {
            self.hand_on(corner.step, corner.start, span, moves)?;
            return Ok((next, middle));
        };
        let raised = |point: Flat| {
            let mut raised = middle;
            (raised[axes[0]], raised[axes[1]]) = (point[0], point[1]);
            raised
        };
        let (from, to) = (raised(broken.from), raised(broken.to));
        let at = |error| Fault::new(span, Reason::Path(error));
        let first = cut(&corner.step, corner.start, from, axes).map_err(at)?;
        let (feedrate, tolerance) = (corner.step.feedrate(), corner.step.tolerance());
        let between = match broken.center {
            Some((center, counter_clockwise)) => {
                Arc::about(from, to, raised(center), axes, counter_clockwise, 0)
                    .map(|arc| Move::arc(arc, feedrate, tolerance))
            }
            None => Move::line_to(to, feedrate, tolerance),
        };
        let between = between.map_err(at)?.from_line(corner.step.line());
        let last = cut(&next, to, end, axes).map_err(at)?;
        self.hand_on(first, corner.start, span, moves)?;
        self.hand_on(between, from, span, moves)?;
        Ok((last, to))
    }
}

/// A move in the plane.
fn curve(step: &Move<3>, start: Vector<3>, flat: impl Fn(Vector<3>) -> Flat) -> Curve {
    match step.path() {
        Path::Arc(arc) => Curve::Arc {
            center: flat(arc.center()),
            from: flat(start),
            to: flat(arc.end()),
            counter_clockwise: arc.sweep() > 0.0,
            extra_turns: u32::from(arc.sweep().abs() > std::f64::consts::TAU - 1e-9),
        },
        _ => Curve::Line {
            from: flat(start),
            to: flat(step.end(start)),
        },
    }
}

/// The same move with other ends on its curve.
fn cut(
    step: &Move<3>,
    start: Vector<3>,
    end: Vector<3>,
    axes: [usize; 2],
) -> Result<Move<3>, toolglide_kinematics::ToolpathError> {
    let (feedrate, tolerance) = (step.feedrate(), step.tolerance());
    let next = match step.path() {
        Path::Arc(arc) => {
            let turned = arc.sweep() > 0.0;
            let arc = Arc::about(start, end, arc.center(), axes, turned, 0)?;
            Move::arc(arc, feedrate, tolerance)
        }
        _ => Move::line_to(end, feedrate, tolerance)?,
    };
    let next = next.from_line(step.line());
    Ok(if step.stops() {
        next.with_exact_stop()
    } else {
        next
    })
}

/// What both ways of breaking a corner need: turn from one tangent to the next; none for no corner.
fn turn(one: &Curve, other: &Curve) -> Result<Option<f64>, &'static str> {
    let (Some(before), Some(after)) = (one.tangents(), other.tangents()) else {
        return Err("moves that lead somewhere on both sides");
    };
    let (incoming, outgoing) = (before[1], after[0]);
    let turn = cross(incoming, outgoing).atan2(dot(incoming, outgoing));
    if turn.abs() > std::f64::consts::PI - SMOOTH {
        return Err("moves that do not lead back on themselves");
    }
    Ok((turn.abs() > SMOOTH).then_some(turn))
}

const TOO_LARGE: &str = "longer moves on both sides: it is larger than they are";

/// An arc that touches both curves.
fn rounded(one: &Curve, other: &Curve, radius: f64) -> Result<Option<Break>, &'static str> {
    let Some(turn) = turn(one, other)?.filter(|_| radius > SHORTEST_LENGTH) else {
        return Ok(None);
    };
    // The centre lies on the inside of the corner.
    let distance = radius.copysign(turn);
    let (first, second) = match (one.offset(distance), other.offset(distance)) {
        (Ok(first), Ok(second)) => (first, second),
        _ => return Err(TOO_LARGE),
    };
    let center = first.meets(&second, one.end()).ok_or(TOO_LARGE)?;
    let (from, to) = (foot(one, center), foot(other, center));
    Ok(Some(Break {
        from,
        to,
        center: Some((center, turn > 0.0)),
    }))
}

/// A straight cut whose ends are equally far from the corner.
fn chamfered(one: &Curve, other: &Curve, size: f64) -> Result<Option<Break>, &'static str> {
    if turn(one, other)?.is_none() || size <= SHORTEST_LENGTH {
        return Ok(None);
    }
    let from = at_distance(one, one.end(), size, false).ok_or(TOO_LARGE)?;
    let to = at_distance(other, other.start(), size, true).ok_or(TOO_LARGE)?;
    Ok(Some(Break {
        from,
        to,
        center: None,
    }))
}

/// The point of a curve that is nearest to another point.
fn foot(curve: &Curve, point: Flat) -> Flat {
    match *curve {
        Curve::Line { from, to } => {
            let along = minus(to, from);
            let share = dot(minus(point, from), along) / dot(along, along);
            plus(from, scaled(along, share))
        }
        Curve::Arc { center, from, .. } => {
            let out = minus(point, center);
            plus(center, scaled(out, norm(minus(from, center)) / norm(out)))
        }
    }
}

/// The point of a curve at a distance from its end or from its start.
fn at_distance(curve: &Curve, corner: Flat, size: f64, from_start: bool) -> Option<Flat> {
    match *curve {
        Curve::Line { from, to } => {
            let along = minus(to, from);
            let length = norm(along);
            let sign = if from_start { 1.0 } else { -1.0 };
            (size <= length).then(|| plus(corner, scaled(along, sign * size / length)))
        }
        Curve::Arc {
            center,
            from,
            to,
            counter_clockwise,
            extra_turns,
        } => {
            let out = minus(corner, center);
            let radius = norm(out);
            let half = 0.5 * size / radius;
            if half >= 1.0 {
                return None;
            }
            let angle = 2.0 * half.asin();
            let whole = cross(minus(from, center), minus(to, center))
                .atan2(dot(minus(from, center), minus(to, center)));
            let whole = if counter_clockwise { whole } else { -whole };
            let whole = whole.rem_euclid(std::f64::consts::TAU);
            if extra_turns == 0 && angle > whole {
                return None;
            }
            let sign = if counter_clockwise == from_start {
                1.0
            } else {
                -1.0
            };
            let (sine, cosine) = (sign * angle).sin_cos();
            Some(plus(
                center,
                [
                    out[0] * cosine - out[1] * sine,
                    out[0] * sine + out[1] * cosine,
                ],
            ))
        }
    }
}
