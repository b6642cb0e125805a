//! Builds arcs as they are written: by centre or by radius, in one of three planes.
//!
//! Source: `G2` and `G3` of RS274/NGC. Not here: the geometry of the arc itself.

use crate::block::codes::{Distance, Motion, Plane};
use crate::block::word_usage::motion_span;
use crate::block::{AXES, Block, OFFSETS};
use crate::error::reason::Reason;
use crate::error::{Fault, Notice};
use crate::interpreter::Interpreter;
use crate::interpreter::modal::{Modal, whole};
use crate::interpreter::units::{Units, within_reach};
use crate::text::place::Span;
use toolglide_kinematics::numeric::{ARC_RADIUS_MISMATCH_SHARE, SHORTEST_LENGTH};
use toolglide_kinematics::{Arc, ToolpathError, Vector};

/// A radius may be too short by this to reach from start to end, mm; the arc is then half a
/// circle. Programs round their coordinates and radii to three decimals.
const RADIUS_SHORTFALL: f64 = 0.005;

/// Radii that differ by no more than this, mm, are those of an arc whose centre was rounded to three decimals: it
/// goes evenly from one to the other, and nobody would see it.
const UNSEEN_MISMATCH: f64 = 0.005;

/// How often the rounding of coordinates the radii may differ at most, however large they are.
const MAX_ROUNDINGS: f64 = 100.0;

/// Most turns of one arc: more than a day of turns a machine could make.
const MAX_TURNS: u32 = 1_000_000;

impl Plane {
    /// Its axes; a positive turn goes from the first to the second.
    pub(crate) fn axes(self) -> [usize; 2] {
        match self {
            Self::Xy => [0, 1],
            Self::Zx => [2, 0],
            Self::Yz => [1, 2],
        }
    }

    /// The axis outside it.
    pub(crate) fn normal(self) -> usize {
        match self {
            Self::Xy => 2,
            Self::Zx => 1,
            Self::Yz => 0,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Xy => "XY (G17)",
            Self::Zx => "ZX (G18)",
            Self::Yz => "YZ (G19)",
        }
    }

    fn one_offset(self) -> &'static str {
        match self {
            Self::Xy => "I or J",
            Self::Zx => "I or K",
            Self::Yz => "J or K",
        }
    }

    fn both_offsets(self) -> &'static str {
        match self {
            Self::Xy => "I and J",
            Self::Zx => "I and K",
            Self::Yz => "J and K",
        }
    }
}

/// The arc of a block, and by how much its radii differ as they are written, mm, where that is more than a
/// rounding to three decimals.
pub(crate) fn arc(
    block: &Block,
    state: &Interpreter,
    motion: Motion,
    start: Vector<3>,
    end: Vector<3>,
) -> Result<(Arc<3>, Option<f64>), Fault> {
    let modal = &state.modal;
    let plane = modal.plane;
    let axes = plane.axes();
    for axis in axes {
        if !state.settings.axes[axis] {
            let letter = char::from(AXES[axis]);
            return Err(Fault::new(motion_span(block), block.no_axis(letter)));
        }
    }
    let counter_clockwise = motion == Motion::CounterClockwise;
    let frame = state.offsets.frame();
    let counter_clockwise = counter_clockwise != frame.mirrors(axes);
    let (center, blamed) = center(block, state, counter_clockwise, start, end)?;
    let turns = whole(block, b'P', "number of turns", 1, MAX_TURNS)?.unwrap_or(1);
    let (center, mismatch) = corrected(center, start, end, modal)
        .map_err(|error| Fault::new(blamed, Reason::Path(error)))?;
    Arc::about(start, end, center, axes, counter_clockwise, turns - 1)
        .map(|arc| (arc, mismatch))
        .map_err(|error| Fault::new(blamed, Reason::Path(error)))
}

fn center(
    block: &Block,
    state: &Interpreter,
    counter_clockwise: bool,
    start: Vector<3>,
    end: Vector<3>,
) -> Result<(Vector<3>, Span), Fault> {
    let modal = &state.modal;
    let plane = modal.plane;
    let outside = OFFSETS[plane.normal()];
    if block.has(outside) {
        let reason = Reason::OffsetOutsidePlane {
            letter: char::from(outside),
            plane: plane.name(),
        };
        return Err(Fault::new(block.span(outside), reason));
    }
    let inside = plane.axes().map(|axis| OFFSETS[axis]);
    match (block.get(b'R'), block.first_of(&inside)) {
        (Some(_), Some(offset)) => {
            let letter = char::from(offset);
            let reason = Reason::ArcCenterAndRadius { letter };
            Err(Fault::new(block.span(offset), reason))
        }
        (None, None) => {
            let offsets = plane.one_offset();
            let reason = Reason::ArcCenterMissing { offsets };
            Err(Fault::new(motion_span(block), reason))
        }
        (Some(written), None) => {
            let span = block.span(b'R');
            modal
                .units
                .bounded_length('R', written)
                .map(|radius| radius * state.offsets.frame().scale(plane.axes()[0]))
                .and_then(|radius| center_by_radius(plane, radius, counter_clockwise, start, end))
                .map(|center| (center, span))
                .map_err(|reason| Fault::new(span, reason))
        }
        (None, Some(offset)) => {
            let span = block.span(offset);
            center_by_offsets(block, state, span, start).map(|center| (center, span))
        }
    }
}

fn center_by_offsets(
    block: &Block,
    state: &Interpreter,
    blamed: Span,
    start: Vector<3>,
) -> Result<Vector<3>, Fault> {
    let modal = &state.modal;
    // Offsets are written in the coordinates of the program.
    let start = state.offsets.in_program(start);
    let mut center = start;
    for axis in modal.plane.axes() {
        let letter = OFFSETS[axis];
        let name = char::from(letter);
        let at = |reason| Fault::new(block.span(letter), reason);
        match (
            block.get(letter),
            block.distance_of(letter, modal.arc_distance),
        ) {
            (Some(value), Distance::Absolute) => {
                center[axis] = modal.units.bounded_length(name, value).map_err(at)?;
            }
            (Some(value), Distance::Incremental) => {
                let offset = modal.units.length(value);
                center[axis] = within_reach(name, start[axis] + offset).map_err(at)?;
            }
            (None, Distance::Absolute) => {
                let offsets = modal.plane.both_offsets();
                return Err(Fault::new(blamed, Reason::ArcCenterIncomplete { offsets }));
            }
            (None, Distance::Incremental) => {}
        }
    }
    Ok(state.offsets.on_machine(center))
}

/// By how much the radii at both ends of an arc may differ, mm: LinuxCNC's rule, which is the rounding of its
/// coordinates, or a thousandth of the radius, which may not exceed a hundred roundings.
pub(crate) fn allowed_mismatch(units: Units, radius: f64) -> f64 {
    let rounding = units.arc_rounding();
    let share = ARC_RADIUS_MISMATCH_SHARE * radius;
    rounding.max(share).min(MAX_ROUNDINGS * rounding)
}

/// The centre of an arc whose coordinates were rounded, moved so that both ends are on one circle; where it would
/// have to go farther than the rounding, as for almost whole circles, it stays, and the radius goes evenly from
/// that of the start to that of the end.
fn corrected(
    center: Vector<3>,
    start: Vector<3>,
    end: Vector<3>,
    modal: &Modal,
) -> Result<(Vector<3>, Option<f64>), ToolpathError> {
    let [first, second] = modal.plane.axes();
    let radius = |point: Vector<3>| {
        let (along, across) = (point[first] - center[first], point[second] - center[second]);
        along.hypot(across)
    };
    let (start_radius, end_radius) = (radius(start), radius(end));
    if start_radius.min(end_radius) <= SHORTEST_LENGTH {
        // There is no circle, which is said of the arc itself.
        return Ok((center, None));
    }
    let mismatch = (start_radius - end_radius).abs();
    let larger = start_radius.max(end_radius);
    let allowed = allowed_mismatch(modal.units, larger);
    if mismatch > allowed {
        return Err(ToolpathError::ArcMismatch {
            start_radius,
            end_radius,
            allowed,
        });
    }
    let chord = [end[first] - start[first], end[second] - start[second]];
    let length = chord[0].hypot(chord[1]);
    if !is_rounded(start_radius, end_radius) || length <= SHORTEST_LENGTH {
        return Ok((center, None));
    }
    let way = [chord[0] / length, chord[1] / length];
    let middle = [
        0.5 * (start[first] + end[first]) - center[first],
        0.5 * (start[second] + end[second]) - center[second],
    ];
    let step = middle[0] * way[0] + middle[1] * way[1];
    let mut there = center;
    if step.abs() <= modal.units.arc_rounding() {
        there[first] += step * way[0];
        there[second] += step * way[1];
    }
    Ok((there, Some(mismatch)))
}

impl Interpreter {
    /// Tells of the first arc whose coordinates were rounded.
    pub(crate) fn tell_rounding(&mut self, block: &Block, mismatch: Option<f64>) {
        if let Some(mismatch) = mismatch
            && !std::mem::replace(&mut self.rounding_told, true)
        {
            let notice = Notice::RoundedArc { mismatch };
            self.own_remark = Some((motion_span(block), notice));
        }
    }
}

/// Whether radii differ by more than a rounding to three decimals.
fn is_rounded(start_radius: f64, end_radius: f64) -> bool {
    let share = ARC_RADIUS_MISMATCH_SHARE * start_radius.max(end_radius);
    (start_radius - end_radius).abs() > UNSEEN_MISMATCH.max(share)
}

/// The centre from a radius: of the two circles through both ends, the one that gives the shorter
/// arc, or the longer arc when the radius is negative.
fn center_by_radius(
    plane: Plane,
    radius: f64,
    counter_clockwise: bool,
    start: Vector<3>,
    end: Vector<3>,
) -> Result<Vector<3>, Reason> {
    let [first, second] = plane.axes();
    let chord = [end[first] - start[first], end[second] - start[second]];
    let length = chord[0].hypot(chord[1]);
    if length <= SHORTEST_LENGTH {
        let offsets = plane.one_offset();
        return Err(Reason::ArcRadiusClosed { radius, offsets });
    }
    let half_chord = 0.5 * length;
    if radius.abs() < half_chord - RADIUS_SHORTFALL || radius.abs() <= SHORTEST_LENGTH {
        return Err(Reason::ArcRadiusTooShort {
            radius,
            half_chord,
            allowed: RADIUS_SHORTFALL,
        });
    }
    let square = (radius.abs() - half_chord) * (radius.abs() + half_chord);
    let height = square.max(0.0).sqrt();
    // The shorter arc turns about a centre on the side to which it bends.
    let left = counter_clockwise == (radius > 0.0);
    let side = if left { height } else { -height };
    let mut center = start;
    center[first] += 0.5 * chord[0] - side * chord[1] / length;
    center[second] += 0.5 * chord[1] + side * chord[0] / length;
    Ok(center)
}
