//! Evaluates rational splines whose program gives each knot: `G6.2`.
//!
//! Source: NURBS interpolation of FANUC and Mitsubishi controls: `G6.2 P K X Y Z R`, then a block for each
//! control point with its knot `K` and its weight `R`, then as many blocks with a knot alone as the order
//! `P` says. LinuxCNC writes `G6.2` in these again, and says by `Q` how it steps along the curve. With the last knot the curve is complete, and becomes chords as all splines do. Not here: the
//! chords.

use crate::block::codes::{FeedMode, Motion};
use crate::block::word_usage::motion_span;
use crate::block::{AXES, Block};
use crate::curves::bezier::{MAX_HALVINGS, Weighted, beziers, flatten};
use crate::curves::splines::{LARGEST_ORDER, MAX_POINTS, weighted};
use crate::error::Fault;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use crate::interpreter::Interpreter;
use crate::interpreter::modal::whole;
use std::collections::VecDeque;
use toolglide_kinematics::{Move, Vector};

/// Order where none is written.
const USUAL_ORDER: u32 = 4;

/// How many ways of stepping along a spline LinuxCNC has.
const STEPPINGS: u32 = 3;

/// How far the first point may be from where the tool is, mm: what two numbers with four decimals of an
/// inch may differ by.
const START_SLACK: f64 = 0.003;

/// A spline that is being read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KnotSpline {
    order: usize,
    points: Vec<Weighted>,
    knots: Vec<f64>,
    /// Whether the first block left its knot to the second.
    first_knot_open: bool,
}

impl KnotSpline {
    /// How many knots the points need.
    fn wanted(&self) -> usize {
        self.points.len() + self.order
    }

    /// Whether the points are complete.
    fn has_all_points(&self) -> bool {
        self.knots.len() > self.points.len()
    }

    /// A refusal because something else stands where the next knot should.
    pub(crate) fn incomplete(&self) -> MachiningError {
        MachiningError::KnotsMissing {
            given: self.knots.len(),
            wanted: self.wanted(),
        }
    }

    /// Whether the knots make one curve from the first point to the last.
    fn check(&self) -> Result<(), MachiningError> {
        let (given, order) = (self.points.len(), self.order);
        if given < order {
            return Err(MachiningError::TooFewPoints { given, order });
        }
        let (head, last) = self.knots.split_at(given);
        let (first, inner) = head.split_at(order);
        // They never fall, so that the first and the last of some are equal where all are.
        let equal = |knots: &[f64]| knots.first() >= knots.last();
        if !equal(first) || !equal(last) || first.first() >= last.first() {
            return Err(MachiningError::KnotsNotClamped { order });
        }
        for (inner, outer) in [(inner.first(), first.first()), (inner.last(), last.first())] {
            if let Some(&knot) = inner.filter(|_| inner == outer) {
                return Err(MachiningError::KnotRepeated { knot, most: order });
            }
        }
        let torn = inner
            .windows(order)
            .find(|window| window.first() >= window.last());
        match torn {
            Some(window) => Err(MachiningError::KnotRepeated {
                knot: window[0],
                most: order - 1,
            }),
            None => Ok(()),
        }
    }
}

impl Interpreter {
    /// A block of a spline with knots: its first one, one with a point, or one with a knot alone.
    pub(crate) fn knot_block(
        &mut self,
        block: &Block,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Fault> {
        let outcome = self.knot(block).and_then(|complete| match complete {
            true => self.end_knots(block, moves),
            false => Ok(()),
        });
        if outcome.is_err() {
            // What follows is no spline.
            self.knot_spline = None;
        }
        if self.knot_spline.is_none() {
            self.modal.motion = Motion::Off;
        }
        outcome
    }

    /// Takes knot and point; true when the spline is complete.
    fn knot(&mut self, block: &Block) -> Result<bool, Fault> {
        self.check_spline(block, Motion::Knots)?;
        let at = |letter, reason: MachiningError| Fault::new(block.span(letter), reason.into());
        let here = |reason: MachiningError| Fault::new(motion_span(block), reason.into());
        let weight = block.get(b'R').unwrap_or(1.0);
        if weight <= 0.0 {
            let (quantity, value) = ("weight", weight);
            let reason = Reason::NotPositive { quantity, value };
            return Err(Fault::new(block.span(b'R'), reason));
        }
        let named = block.first_of(&AXES).is_some();
        let end = if named {
            self.end(block)?
        } else {
            self.program
        };
        let Some(spline) = &mut self.knot_spline else {
            return self.begin_knots(block, end, weight).map(|()| false);
        };
        if block.has(b'P') {
            return Err(at(b'P', MachiningError::NoKnotOrder));
        }
        if block.has(b'Q') {
            let reason = Reason::Unused { letter: 'Q' };
            return Err(Fault::new(block.span(b'Q'), reason));
        }
        let Some(knot) = block.get(b'K') else {
            return Err(here(MachiningError::NoKnot));
        };
        if std::mem::take(&mut spline.first_knot_open) {
            spline.knots.push(knot);
        }
        if let Some(&before) = spline.knots.last()
            && knot < before
        {
            return Err(at(b'K', MachiningError::KnotFalls { knot, before }));
        }
        if named {
            if spline.has_all_points() {
                return Err(here(MachiningError::LatePoint));
            }
            if spline.points.len() >= MAX_POINTS {
                let bound = MAX_POINTS;
                return Err(here(MachiningError::TooManyPoints { bound }));
            }
            spline.points.push(weighted(end, weight));
            self.program = end;
        }
        spline.knots.push(knot);
        Ok(spline.knots.len() == spline.wanted())
    }

    /// The block of `G6.2` itself.
    fn begin_knots(&mut self, block: &Block, end: Vector<3>, weight: f64) -> Result<(), Fault> {
        if self.modal.feed_mode == FeedMode::InverseTime {
            let state = "with inverse time (G93)";
            let code = Motion::Knots.code();
            let reason = MachiningError::NotNow { code, state };
            return Err(Fault::new(motion_span(block), reason.into()));
        }
        let order = whole(block, b'P', "order of the spline", 2, LARGEST_ORDER)?;
        // How LinuxCNC steps along the curve, whose shape it leaves alone.
        whole(
            block,
            b'Q',
            "way of stepping along the spline",
            1,
            STEPPINGS,
        )?;
        let distance = (end - self.program).norm();
        if distance > START_SLACK {
            let allowed = START_SLACK;
            let reason = MachiningError::SplineStart { distance, allowed };
            return Err(Fault::new(motion_span(block), reason.into()));
        }
        let knot = block.get(b'K');
        self.knot_spline = Some(KnotSpline {
            order: order.unwrap_or(USUAL_ORDER) as usize,
            points: vec![weighted(self.program, weight)],
            knots: knot.into_iter().collect(),
            first_knot_open: knot.is_none(),
        });
        Ok(())
    }

    /// The last knot: the spline becomes moves.
    fn end_knots(&mut self, block: &Block, moves: &mut VecDeque<Move<3>>) -> Result<(), Fault> {
        let Some(spline) = self.knot_spline.take() else {
            return Ok(());
        };
        let refused = |reason: MachiningError| Fault::new(block.span(b'K'), reason.into());
        spline.check().map_err(refused)?;
        let mut chords = Vec::new();
        for curve in beziers(&spline.points, spline.order, &spline.knots) {
            flatten(&curve, self.chord_error(), MAX_HALVINGS, &mut chords);
        }
        self.program = self.offsets.in_program(self.position);
        self.follow(&chords, block, moves)
    }

    /// Refuses the end of the program within a spline.
    pub(crate) fn check_no_spline(&self) -> Result<(), MachiningError> {
        match (&self.knot_spline, &self.nurbs) {
            (Some(spline), _) => Err(spline.incomplete()),
            (None, Some(_)) => Err(MachiningError::OpenSpline),
            (None, None) => Ok(()),
        }
    }
}
