//! Compensates for the cutter: the tool moves beside the path, at the distance of its radius.
//!
//! Source: `G40` to `G42.1` of LinuxCNC. Around an outside corner goes an arc; in an inside corner both
//! moves end where their offsets meet. A move waits until the next one is known. The first move leads
//! in, straight and longer than the radius; the first one after `G40` leads out. Not here: the radius.

pub(crate) mod offset_curve;
pub(crate) mod offset_moves;

use crate::block::codes::Plane;
use crate::error::machining::MachiningError;
use crate::error::reason::Reason;
use offset_curve::{Curve, Flat, cross, dot, minus, norm};
use std::collections::VecDeque;
use toolglide_kinematics::numeric::SHORTEST_LENGTH;
use toolglide_kinematics::{Move, Path, Vector};

/// Moves whose directions differ by less than this at a corner go on smoothly, rad: what coordinates
/// of four decimals leave of a tangent.
const SMOOTH: f64 = 1e-3;

/// Moves along the normal of the plane that may wait behind the last one in the plane.
const MAX_WAITING: usize = 10_000;

/// Compensation that is on, or about to end.
#[derive(Debug)]
pub(crate) struct Compensation {
    pub(crate) axes: [usize; 2],
    pub(crate) normal: usize,
    /// Whether the lead-in ends on the normal of the move behind it, as for Sinumerik; else on its own.
    leads_to_normal: bool,
    /// Distance of the tool to the left of the path, mm; negative to the right.
    distance: f64,
    /// Where the moves that are handed on end.
    pub(crate) at: Vector<3>,
    state: State,
    /// The last move in the plane, and what must stay behind it.
    waiting: Option<Waiting>,
    behind: VecDeque<Behind>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// The next move leads in.
    LeadIn,
    On,
    /// The next move leads out.
    LeadOut,
}

/// A move beside the path, whose end may still change.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    curve: Curve,
    /// Its course beside the path: that of the curve, but for a lead-in.
    course: Curve,
    /// End of the programmed move.
    corner: Flat,
    heights: [f64; 2],
    step: Move<3>,
    leads_in: bool,
}

/// What happens where the last move ends.
#[derive(Clone, Copy, Debug)]
enum Behind {
    /// A move to a height.
    Height(f64, Move<3>),
    /// A dwell.
    Rest(Move<3>),
}

impl Compensation {
    /// Compensation of a tool of `radius` in mm, beginning at a point.
    pub(crate) fn new(plane: Plane, radius: f64, left: bool, at: Vector<3>) -> Self {
        Self {
            axes: plane.axes(),
            normal: plane.normal(),
            leads_to_normal: false,
            distance: if left { radius } else { -radius },
            at,
            state: State::LeadIn,
            waiting: None,
            behind: VecDeque::new(),
        }
    }

    /// The same compensation, whose lead-in ends on the normal of the move behind it.
    pub(crate) fn leading_to_normal(mut self) -> Self {
        self.leads_to_normal = true;
        self
    }

    /// Where the tool is once all moves so far are made.
    pub(crate) fn position(&self) -> Vector<3> {
        self.at
    }

    /// The code that says on which side it is, times ten.
    pub(crate) fn code(&self) -> f64 {
        match self.state {
            State::LeadOut => 400.0,
            _ if self.distance >= 0.0 => 410.0,
            _ => 420.0,
        }
    }

    /// Whether only the lead-out is left.
    pub(crate) fn is_ending(&self) -> bool {
        self.state == State::LeadOut
    }

    /// Whether it ended before it began.
    pub(crate) fn is_over(&self) -> bool {
        self.state == State::LeadOut && self.distance == 0.0
    }

    /// The next move leads out.
    pub(crate) fn end(&mut self, moves: &mut VecDeque<Move<3>>) {
        self.flush(moves);
        if self.state == State::LeadIn {
            self.distance = 0.0;
        }
        self.state = State::LeadOut;
    }

    /// Makes all moves that wait.
    pub(crate) fn flush(&mut self, moves: &mut VecDeque<Move<3>>) {
        if let Some(waiting) = self.waiting.take() {
            self.make(&waiting.curve, waiting.heights, &waiting.step, moves);
        }
        while let Some(next) = self.behind.pop_front() {
            match next {
                Behind::Height(height, step) => {
                    let mut end = self.at;
                    end[self.normal] = height;
                    self.line(end, &step, moves);
                }
                Behind::Rest(step) => moves.push_back(step),
            }
        }
    }

    /// A dwell, in its place among the moves.
    pub(crate) fn pass(&mut self, step: Move<3>, moves: &mut VecDeque<Move<3>>) {
        if self.waiting.is_some() {
            self.behind.push_back(Behind::Rest(step));
        } else {
            moves.push_back(step);
        }
    }

    /// Takes the next programmed move, which begins at `start`; false when it led out.
    pub(crate) fn push(
        &mut self,
        step: Move<3>,
        start: Vector<3>,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<bool, Reason> {
        let end = step.end(start);
        let programmed = self.curve(&step, start);
        if self.state == State::LeadOut {
            if matches!(step.path(), Path::Arc(_)) && self.distance != 0.0 {
                let begins_or_ends = "ends";
                return Err(MachiningError::LeadByArc { begins_or_ends }.into());
            }
            moves.push_back(step);
            return Ok(false);
        }
        let Some(tangents) = programmed.tangents() else {
            let next = Behind::Height(end[self.normal], step);
            if self.behind.len() >= MAX_WAITING {
                let bound = crate::interpreter::MAX_MOVES;
                return Err(MachiningError::TooManyMoves { bound }.into());
            }
            self.behind.push_back(next);
            if self.waiting.is_none() {
                self.flush(moves);
            }
            return Ok(true);
        };
        let radius = self.distance.abs();
        let course = programmed
            .offset(self.distance)
            .map_err(|arc| MachiningError::ToolTooLarge { radius, arc })?;
        let heights = [start[self.normal], end[self.normal]];
        let mut next = Waiting {
            curve: course,
            course,
            corner: programmed.end(),
            heights,
            step,
            leads_in: self.state == State::LeadIn,
        };
        if self.state == State::LeadIn {
            self.check_lead_in(&step, &programmed)?;
            self.state = State::On;
            next.curve.set_start(self.flat(self.at));
        } else if let Some(last) = self.waiting.take() {
            self.corner(last, &mut next, tangents[0], moves)?;
        }
        self.waiting = Some(next);
        Ok(true)
    }

    fn check_lead_in(&self, step: &Move<3>, programmed: &Curve) -> Result<(), MachiningError> {
        if matches!(step.path(), Path::Arc(_)) && self.distance != 0.0 {
            let begins_or_ends = "begins";
            return Err(MachiningError::LeadByArc { begins_or_ends });
        }
        let length = norm(minus(programmed.end(), self.flat(self.at)));
        let radius = self.distance.abs();
        if length <= radius {
            return Err(MachiningError::LeadInTooShort { length, radius });
        }
        Ok(())
    }

    /// Joins the last move with the next one.
    fn corner(
        &mut self,
        mut last: Waiting,
        next: &mut Waiting,
        outgoing: Flat,
        moves: &mut VecDeque<Move<3>>,
    ) -> Result<(), Reason> {
        if last.leads_in && self.leads_to_normal {
            last.curve.set_end(next.curve.start());
            self.hand_on(&last, moves);
            return Ok(());
        }
        // A course without length would have no direction, but such moves do not wait.
        let incoming = last.course.tangents().map_or(outgoing, |ends| ends[1]);
        let turn = cross(incoming, outgoing).atan2(dot(incoming, outgoing));
        let inwards = (turn > 0.0) == (self.distance > 0.0);
        let gap = norm(minus(last.curve.end(), next.curve.start()));
        if gap <= SHORTEST_LENGTH || self.distance == 0.0 {
            next.curve.set_start(last.curve.end());
            next.course.set_start(last.curve.end());
            self.hand_on(&last, moves);
            return Ok(());
        }
        if inwards && turn.abs() < std::f64::consts::PI {
            let meeting = last.course.meets(&next.course, last.corner);
            let meeting = match meeting {
                Some(point) => point,
                // Nearly tangent moves may miss each other by rounding.
                None if turn.abs() <= SMOOTH => last.curve.end(),
                None => {
                    let radius = self.distance.abs();
                    return Err(MachiningError::Gouge { radius }.into());
                }
            };
            last.curve.set_end(meeting);
            next.curve.set_start(meeting);
            next.course.set_start(meeting);
            self.hand_on(&last, moves);
            return Ok(());
        }
        let corner = last.corner;
        self.hand_on(&last, moves);
        if turn.abs() <= SMOOTH {
            let height = self.at[self.normal];
            let bridge = Curve::Line {
                from: self.flat(self.at),
                to: next.curve.start(),
            };
            self.make(&bridge, [height; 2], &next.step, moves);
        } else {
            let height = self.at[self.normal];
            let around = Curve::Arc {
                center: corner,
                from: self.flat(self.at),
                to: next.curve.start(),
                counter_clockwise: self.distance < 0.0,
                extra_turns: 0,
            };
            self.make(&around, [height; 2], &next.step, moves);
        }
        Ok(())
    }

    /// Makes a move whose end is known, and what waits behind it.
    fn hand_on(&mut self, last: &Waiting, moves: &mut VecDeque<Move<3>>) {
        self.waiting = Some(*last);
        self.flush(moves);
    }
}
