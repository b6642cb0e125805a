//! Finds the sharpest corner of a program and the motion near it while both stream past.
//!
//! A corner is known when its second move is read, before its motion is planned; so whoever leads
//! gathers the pieces that follow until a sharper one has gathered its own. Not here: drawing.

use std::collections::VecDeque;
use toolglide_kinematics::{Arc, Move, Path, Piece, Tolerance, Vector, vector};

/// Points of the path that are remembered from before a corner.
const BEFORE: usize = 96;

/// Pieces of the motion that are remembered from before a corner.
const PIECES_BEFORE: usize = 512;

/// Points of the path that are gathered after a corner.
const AFTER: usize = 96;

/// Moves before and after a corner whose motion is gathered.
const MOVES_AROUND: u32 = 40;

/// Most pieces that are gathered for one corner.
const MAX_PIECES: usize = 4096;

/// A corner must be sharper than the last one by this to take its place, rad; so that few are
/// gathered for.
const SHARPER: f64 = 0.01;

/// Turns beyond this count less and less, rad: a reversal shows nothing but a line.
const NEARLY_REVERSAL: f64 = 160.0 * std::f64::consts::PI / 180.0;

/// A corner at which the motion stops anyway counts this share.
const STOP_SHARE: f64 = 0.01;

/// A corner, the path and the motion near it.
#[derive(Clone, Debug)]
pub(crate) struct SharpCorner<const N: usize> {
    /// Line of the move that ends there; 0 when unknown.
    pub(crate) line: u32,
    /// The corner.
    pub(crate) point: Vector<N>,
    /// Direction in which the path arrives.
    pub(crate) incoming: Vector<N>,
    /// Direction in which it leaves.
    pub(crate) outgoing: Vector<N>,
    /// Angle between them, rad.
    pub(crate) turn: f64,
    /// How far the motion may pass from it.
    pub(crate) tolerance: Tolerance,
    /// The path through it, in order.
    pub(crate) path: Vec<Vector<N>>,
    /// The motion near it, in order.
    pub(crate) pieces: Vec<Piece<N>>,
    index: u32,
    rank: f64,
    missing: usize,
}

impl<const N: usize> SharpCorner<N> {
    /// Whether a piece serves one of the two moves that meet here.
    pub(crate) fn is_served_by(&self, piece: &Piece<N>) -> bool {
        let serves = piece.serves();
        serves.first <= self.index && serves.last.saturating_add(1) >= self.index
    }
}

/// Looks for the sharpest corner.
#[derive(Clone, Debug)]
pub(crate) struct CornerFinder<const N: usize> {
    moves: u32,
    at: Vector<N>,
    last: Option<Arrival<N>>,
    path: VecDeque<Vector<N>>,
    pieces: VecDeque<Piece<N>>,
    best: Option<SharpCorner<N>>,
    gathering: Vec<SharpCorner<N>>,
}

#[derive(Clone, Copy, Debug)]
struct Arrival<const N: usize> {
    direction: Vector<N>,
    length: f64,
    tolerance: Tolerance,
    stops: bool,
    line: u32,
}

impl<const N: usize> CornerFinder<N> {
    /// Begins at the start of the path.
    pub(crate) fn starting_at(start: Vector<N>) -> Self {
        Self {
            moves: 0,
            at: start,
            last: None,
            path: VecDeque::from([start]),
            pieces: VecDeque::new(),
            best: None,
            gathering: Vec::new(),
        }
    }

    /// Takes the next move of the path.
    pub(crate) fn expect(&mut self, next: &Move<N>) {
        let index = self.moves;
        self.moves = self.moves.saturating_add(1);
        let Some((leaving, arriving)) = directions(next, self.at) else {
            if let Some(last) = &mut self.last {
                last.stops |= next.stops();
            }
            return;
        };
        let length = next.length(self.at);
        let tolerance = next.tolerance();
        if let Some(last) = self.last {
            self.consider(index, &last, leaving, length, tolerance);
        }
        let mut points = Vec::new();
        flatten(next, self.at, &mut points);
        for point in points {
            for corner in &mut self.gathering {
                if corner.missing > 0 {
                    corner.missing -= 1;
                    corner.path.push(point);
                }
            }
            if self.path.len() >= BEFORE {
                self.path.pop_front();
            }
            self.path.push_back(point);
        }
        self.at = next.end(self.at);
        self.last = Some(Arrival {
            direction: arriving,
            length,
            tolerance,
            stops: next.stops(),
            line: next.line(),
        });
    }

    /// Takes the next piece of the motion.
    pub(crate) fn observe(&mut self, piece: &Piece<N>) {
        let serves = piece.serves();
        while let Some(first) = self.gathering.first()
            && serves.first > first.index + MOVES_AROUND
        {
            self.best = Some(self.gathering.remove(0));
        }
        for corner in &mut self.gathering {
            if serves.last + MOVES_AROUND >= corner.index && corner.pieces.len() < MAX_PIECES {
                corner.pieces.push(*piece);
            }
        }
        if self.pieces.len() >= PIECES_BEFORE {
            self.pieces.pop_front();
        }
        self.pieces.push_back(*piece);
    }

    /// How sharp the sharpest corner is; 0 without a corner.
    pub(crate) fn sharpness(&self) -> f64 {
        let leader = self.gathering.last().or(self.best.as_ref());
        leader.map_or(0.0, |leader| leader.rank)
    }

    /// The sharpest corner of all.
    pub(crate) fn finish(mut self) -> Option<SharpCorner<N>> {
        self.gathering.pop().or(self.best)
    }

    fn consider(
        &mut self,
        index: u32,
        last: &Arrival<N>,
        outgoing: Vector<N>,
        length: f64,
        tolerance: Tolerance,
    ) {
        let incoming = last.direction;
        let turn = 2.0
            * (outgoing - incoming)
                .norm()
                .atan2((outgoing + incoming).norm());
        let tolerance = tolerance.min(last.tolerance);
        // Moves shorter than the tolerance are the noise of a program, not its shape.
        let room = (last.length.min(length) / tolerance.length()).min(1.0);
        let straightness = (std::f64::consts::PI - turn.max(NEARLY_REVERSAL))
            / (std::f64::consts::PI - NEARLY_REVERSAL);
        let rank = turn * room * straightness * if last.stops { STOP_SHARE } else { 1.0 };
        let leader = self.gathering.last().or(self.best.as_ref());
        if leader.is_some_and(|leader| rank < leader.rank + SHARPER) || turn < SHARPER {
            return;
        }
        self.gathering.push(SharpCorner {
            line: last.line,
            point: self.at,
            incoming,
            outgoing,
            turn,
            tolerance,
            path: self.path.iter().copied().collect(),
            pieces: self
                .pieces
                .iter()
                .filter(|piece| piece.serves().last + MOVES_AROUND >= index)
                .copied()
                .collect(),
            index,
            rank,
            missing: AFTER,
        });
    }
}

/// Directions in which a move leaves and arrives; `None` for a move of no length.
fn directions<const N: usize>(next: &Move<N>, at: Vector<N>) -> Option<(Vector<N>, Vector<N>)> {
    match next.path() {
        Path::Line { end } => {
            let (_, direction) = vector::length_and_direction(&at, end)?;
            Some((direction, direction))
        }
        Path::Arc(arc) => Some((arc.tangent(0.0), arc.tangent(1.0))),
        _ => None,
    }
}

/// Points of a move after its start, denser near the ends of an arc, where corners are.
pub(crate) fn flatten<const N: usize>(next: &Move<N>, at: Vector<N>, points: &mut Vec<Vector<N>>) {
    match next.path() {
        Path::Arc(arc) => {
            let near = ends(arc, next.tolerance());
            points.extend(near.iter().map(|&share| arc.point(share)));
            points.extend((1..32).map(|step| {
                arc.point(
                    near_middle(&near) + f64::from(step) / 32.0 * (1.0 - 2.0 * near_middle(&near)),
                )
            }));
            points.extend(near.iter().rev().map(|&share| arc.point(1.0 - share)));
            points.push(arc.end());
        }
        _ => points.push(next.end(at)),
    }
}

/// Shares of an arc near its start, each twice as far as the one before.
fn ends<const N: usize>(arc: &Arc<N>, tolerance: Tolerance) -> Vec<f64> {
    let first = tolerance.length() / arc.length();
    (0..16)
        .map(|step| first * f64::from(1_u32 << step))
        .take_while(|&share| share < 1.0 / 32.0)
        .collect()
}

fn near_middle(near: &[f64]) -> f64 {
    near.last().copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::{Feedrate, MoveRange, Sample};

    #[test]
    fn the_sharpest_corner_gathers_its_motion_and_reversals_do_not_count() {
        let tolerance = Tolerance::new(0.01).unwrap();
        let feedrate = Feedrate::new(10.0).unwrap();
        // A turn of 90 degrees, one of 135 degrees, a reversal, and a long straight rest.
        let mut points = vec![[10.0, 0.0], [10.0, 10.0], [20.0, 0.0], [10.0, 10.0]];
        points.extend((1..100).map(|step| [10.0 - f64::from(step), 10.0 + f64::from(step)]));
        let mut finder = CornerFinder::starting_at(Vector::<2>::zeros());
        let mut at = Vector::<2>::zeros();
        for (index, point) in (0..).zip(&points) {
            let end = Vector::from(*point);
            let line = Move::line_to(end, feedrate, tolerance).unwrap();
            finder.expect(&line.from_line(index + 1));
            // The motion is known two moves later than the path.
            if let Some(first) = index.checked_sub(2) {
                let serves = MoveRange { first, last: first };
                finder.observe(&Piece::new(&Sample::at_rest(at), 1.0, end, serves));
                at = end;
            }
        }
        let corner = finder.finish().unwrap();
        assert_eq!(corner.line, 2, "{corner:?}");
        assert!((corner.turn.to_degrees() - 135.0).abs() < 1e-9, "turn");
        assert!(corner.path.len() > 40, "path on both sides");
        assert!(corner.pieces.len() > 40, "{} pieces", corner.pieces.len());
    }
}
