//! Divides quadratic, cubic and rational splines of the plane XY into chords.
//!
//! Source: `G5`, `G5.1` and `G5.2` `G5.3` of LinuxCNC. A Bezier curve lies within its control points;
//! it is halved until they are within a share of the tolerance of a chord, and the moves keep the rest
//! of the tolerance, so that the motion stays within the whole of it of the true curve. Not here:
//! splines with knots of their own, see `knot_spline`.

use crate::block::codes::{Distance, Group, Motion, PathControl, Plane};
use crate::block::word_usage::motion_span;
use crate::block::{AXES, Block};
use crate::curves::bezier::{MAX_HALVINGS, Weighted, beziers, even_knots, flatten};
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::interpreter::modal::whole;
use crate::interpreter::{Interpreter, MAX_MOVES};
use crate::text::place::Span;
use std::collections::VecDeque;
use toolglide_kinematics::{Feedrate, Move, Tolerance, Vector};

/// Share of the tolerance that chords may use.
pub(crate) const CHORD_SHARE: f64 = 0.1;

/// Control points of one spline.
pub(crate) const MAX_POINTS: usize = 10_000;

/// Order of a rational spline where none is written, and the largest.
const USUAL_ORDER: u32 = 3;
pub(crate) const LARGEST_ORDER: u32 = 16;

/// A rational spline whose control points are being read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Nurbs {
    order: usize,
    points: Vec<Weighted>,
}

/// A point times its weight, and the weight.
pub(crate) fn weighted(point: Vector<3>, weight: f64) -> Weighted {
    [
        point[0] * weight,
        point[1] * weight,
        point[2] * weight,
        weight,
    ]
}

impl Interpreter {
    /// `G5` and `G5.1`.
    pub(crate) fn spline(
        &mut self,
        block: &Block,
        motion: Motion,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        self.check_spline(block, motion)?;
        let code = motion.code();
        let span = motion_span(block);
        let missing = |words| {
            Fault::new(
                span,
                MachiningError::SplineIncomplete { code, words }.into(),
            )
        };
        let start = [self.program[0], self.program[1]];
        let end = self.end(block)?;
        let last = [end[0], end[1]];
        let from = |base: [f64; 2], offset: [f64; 2]| [base[0] + offset[0], base[1] + offset[1]];
        let pair = |state: &Self, letters: [u8; 2]| -> Result<Option<[f64; 2]>, Fault> {
            let first = state.length(block, letters[0])?;
            let second = state.length(block, letters[1])?;
            Ok((first.is_some() || second.is_some())
                .then(|| [first.unwrap_or(0.0), second.unwrap_or(0.0)]))
        };
        let offset = pair(self, *b"IJ")?;
        let points = if motion == Motion::Quadratic {
            let offset = offset.ok_or_else(|| missing("I or J"))?;
            self.spline_end = None;
            vec![start, from(start, offset), last]
        } else {
            let (Some(p), Some(q)) = (self.length(block, b'P')?, self.length(block, b'Q')?) else {
                return Err(missing("P and Q"));
            };
            if block.has(b'I') != block.has(b'J') {
                return Err(missing("both I and J, or neither"));
            }
            // Without offsets a cubic goes on as the last one ended.
            let going_on = self.spline_end.map(|[p, q]| [-p, -q]);
            let offset = offset.or(going_on).ok_or_else(|| missing("I and J"))?;
            self.spline_end = Some([p, q]);
            vec![start, from(start, offset), from(last, [p, q]), last]
        };
        let height = self.program[2];
        let curve: Vec<Weighted> = points
            .iter()
            .map(|point| [point[0], point[1], height, 1.0])
            .collect();
        let mut chords = Vec::new();
        flatten(&curve, self.chord_error(), MAX_HALVINGS, &mut chords);
        self.follow(&chords, block, moves)
    }

    /// A control point of `G5.2`, or the beginning of a spline.
    pub(crate) fn control_point(&mut self, block: &Block) -> Result<(), Fault> {
        self.check_spline(block, Motion::Nurbs)?;
        let span = motion_span(block);
        let weight = block.get(b'P').unwrap_or(1.0);
        if !(weight > 0.0 && weight.is_finite()) {
            let (quantity, value) = ("weight", weight);
            let reason = Reason::NotPositive { quantity, value };
            return Err(Fault::new(block.span(b'P'), reason));
        }
        let order = whole(block, b'L', "order of the spline", 2, LARGEST_ORDER)?;
        let weighted = |point| weighted(point, weight);
        if self.nurbs.is_none() {
            let order = order.unwrap_or(USUAL_ORDER) as usize;
            self.nurbs = Some(Nurbs {
                order,
                points: vec![weighted(self.program)],
            });
        }
        if block.first_of(&AXES).is_none() {
            return Ok(());
        }
        let end = self.end(block)?;
        self.program = end;
        if let Some(nurbs) = &mut self.nurbs {
            if nurbs.points.len() >= MAX_POINTS {
                let bound = MAX_POINTS;
                return Err(Fault::new(
                    span,
                    MachiningError::TooManyPoints { bound }.into(),
                ));
            }
            nurbs.points.push(weighted(end));
        }
        Ok(())
    }

    /// `G5.3`: the spline is complete.
    pub(crate) fn end_nurbs(
        &mut self,
        block: &Block,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let span = block
            .taker(Group::Motion)
            .map_or(Span::default(), |(_, span)| span);
        let Some(nurbs) = self.nurbs.take() else {
            return Err(Fault::new(span, MachiningError::NoSpline.into()));
        };
        let (given, order) = (nurbs.points.len(), nurbs.order);
        if given < order {
            let reason = MachiningError::TooFewPoints { given, order };
            return Err(Fault::new(span, reason.into()));
        }
        let mut chords = Vec::new();
        let knots = even_knots(given, order);
        for curve in beziers(&nurbs.points, order, &knots) {
            flatten(&curve, self.chord_error(), MAX_HALVINGS, &mut chords);
        }
        self.program = self.offsets.in_program(self.position);
        self.follow(&chords, block, moves)
    }

    /// Within a spline there are control points only.
    pub(crate) fn check_open_spline(
        &self,
        block: &Block,
        motion: Option<Motion>,
    ) -> Result<(), Fault> {
        if let Some(spline) = &self.knot_spline {
            // LinuxCNC writes the code again in blocks with a knot alone.
            let same = block.motion.is_none_or(|code| code == Motion::Knots);
            let goes_on = motion == Some(Motion::Knots) && block.is_plain();
            if !goes_on || !same {
                return Err(Fault::new(motion_span(block), spline.incomplete().into()));
            }
            return Ok(());
        }
        let wrong = motion.is_some_and(|motion| motion != Motion::Nurbs);
        let wrong = wrong || !block.is_plain() || block.motion.is_some_and(|m| m != Motion::Nurbs);
        if self.nurbs.is_some() && wrong && !block.end_of_nurbs {
            let span = motion_span(block);
            return Err(Fault::new(span, MachiningError::OpenSpline.into()));
        }
        Ok(())
    }

    pub(crate) fn check_spline(&self, block: &Block, motion: Motion) -> Result<(), Fault> {
        let in_space = motion == Motion::Knots;
        let in_plane = motion == Motion::Nurbs;
        let normal = AXES[self.modal.plane.normal()];
        let state = if self.modal.plane != Plane::Xy && !in_space && !in_plane {
            "outside the plane XY (G17)"
        } else if self.compensation.is_some() {
            "while cutter compensation is on (G40 ends it)"
        } else if block.first_of(b"@^ABCUVW").is_some() || block.has(normal) && !in_space {
            match (in_space, self.modal.plane) {
                (true, _) => "with words other than X, Y and Z",
                (_, Plane::Xy) => "with words other than X and Y",
                (_, Plane::Zx) => "with words other than Z and X",
                (_, Plane::Yz) => "with words other than Y and Z",
            }
        } else if motion != Motion::Quadratic && self.modal.distance == Distance::Incremental {
            "with incremental distances (G91)"
        } else {
            return Ok(());
        };
        let code = motion.code();
        Err(Fault::new(
            motion_span(block),
            MachiningError::NotNow { code, state }.into(),
        ))
    }

    /// How far a chord may leave the true curve, mm.
    pub(crate) fn chord_error(&self) -> f64 {
        CHORD_SHARE * self.modal.tolerance.length()
    }

    /// Moves along chords, at the feedrate of a block.
    pub(crate) fn follow(
        &mut self,
        chords: &[[f64; 3]],
        block: &Block,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let span = motion_span(block);
        let mut at = self.program;
        let mut length = 0.0;
        for point in chords {
            length += (Vector::from(*point) - at).norm();
            at = Vector::from(*point);
        }
        let feedrate = self.feedrate(block, length)?;
        if chords.len() > MAX_MOVES as usize {
            let bound = MAX_MOVES;
            let reason = MachiningError::TooManyMoves { bound };
            return Err(Fault::new(span, reason.into()));
        }
        let whole = self.modal.tolerance;
        self.modal.tolerance =
            Tolerance::new(whole.length() * (1.0 - CHORD_SHARE)).unwrap_or(whole);
        let outcome = self.chords(chords, feedrate, span, moves);
        self.modal.tolerance = whole;
        outcome
    }

    fn chords(
        &mut self,
        chords: &[[f64; 3]],
        feedrate: Feedrate,
        span: Span,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        for point in chords {
            self.go(Vector::from(*point), feedrate, span, moves)?;
        }
        if self.modal.path_control == PathControl::ExactStop
            && let Some(last) = moves.back_mut()
        {
            *last = last.with_exact_stop();
        }
        Ok(())
    }
}
