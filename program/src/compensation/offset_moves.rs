//! Moves a tool beside its path, between the plane of compensation and the machine.
//!
//! Not here: which moves, see `compensation`.

use crate::compensation::Compensation;
use crate::compensation::offset_curve::{Curve, Flat};
use std::collections::VecDeque;
use toolglide_kinematics::{Arc, Move, Path, Vector};

impl Compensation {
    /// Appends a move along a curve, from the first height to the second.
    pub(crate) fn make(
        &mut self,
        curve: &Curve,
        heights: [f64; 2],
        step: &Move<3>,
        moves: &mut VecDeque<Move<3>>,
    ) {
        let end = self.raised(curve.end(), heights[1]);
        if let Curve::Arc {
            center,
            counter_clockwise,
            extra_turns,
            ..
        } = curve
        {
            let center = self.raised(*center, heights[0]);
            let arc = Arc::about(
                self.at,
                end,
                center,
                self.axes,
                *counter_clockwise,
                *extra_turns,
            );
            if let Ok(arc) = arc {
                let next = Move::arc(arc, step.feedrate(), step.tolerance());
                self.push_like(next, step, moves);
                self.at = end;
                return;
            }
            // Both radii are those of arcs that were legal, so that this is never reached but by
            // arcs shorter than rounding.
        }
        self.line(end, step, moves);
    }

    pub(crate) fn line(&mut self, end: Vector<3>, step: &Move<3>, moves: &mut VecDeque<Move<3>>) {
        // The end comes from finite coordinates, so that it is always a move.
        if let Ok(next) = Move::line_to(end, step.feedrate(), step.tolerance()) {
            self.push_like(next, step, moves);
            self.at = end;
        }
    }

    fn push_like(&self, next: Move<3>, step: &Move<3>, moves: &mut VecDeque<Move<3>>) {
        let next = next.from_line(step.line());
        moves.push_back(if step.stops() {
            next.with_exact_stop()
        } else {
            next
        });
    }

    /// A programmed move in the plane.
    pub(crate) fn curve(&self, step: &Move<3>, start: Vector<3>) -> Curve {
        match step.path() {
            Path::Arc(arc) => Curve::Arc {
                center: self.flat(arc.center()),
                from: self.flat(start),
                to: self.flat(arc.end()),
                counter_clockwise: arc.sweep() > 0.0,
                extra_turns: whole_turns(arc.sweep()),
            },
            _ => Curve::Line {
                from: self.flat(start),
                to: self.flat(step.end(start)),
            },
        }
    }

    pub(crate) fn flat(&self, point: Vector<3>) -> Flat {
        self.axes.map(|axis| point[axis])
    }

    fn raised(&self, point: Flat, height: f64) -> Vector<3> {
        let mut raised = Vector::zeros();
        raised[self.axes[0]] = point[0];
        raised[self.axes[1]] = point[1];
        raised[self.normal] = height;
        raised
    }
}

/// Whole turns of an arc beyond the first.
fn whole_turns(sweep: f64) -> u32 {
    let turns = (sweep.abs() / std::f64::consts::TAU - 1e-9)
        .floor()
        .max(0.0);
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "programs are refused beyond a million turns"
    )]
    let turns = turns as u32;
    turns
}
