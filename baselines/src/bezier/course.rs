//! Plans straight vertices into segments and rounded corners in a look-ahead window.
//!
//! Source: ours, for the feed between the corners of constant speed. The window of kinematic smoothing
//! scales turns that have speeds alone, over links that are the straight parts of the legs; that a
//! stop always fits is its promise. Not here: the corners themselves.

use super::bend::{BezierBlend, PIECES};
use std::collections::VecDeque;
use toolglide_kinematics::{Limits, MoveRange, Pause, Piece, Vector};
use toolglide_profiles::BlendShape;
use toolglide_smoothing::parts::{
    Link, MAX_PIECES, ROUNDING_SHARE, Segment, SegmentMerger, Vertex, Window, corner_between,
    unroll_leg,
};

/// Corners that the look-ahead window sees.
const WINDOW: usize = 256;

/// Plans a stream of vertices, from rest to rest.
#[derive(Clone, Debug)]
pub(super) struct Course<const N: usize> {
    /// Limits of corners.
    limits: Limits<N>,
    merger: SegmentMerger<N>,
    /// The last leg, whose end is still open.
    pending: Option<Segment<N>>,
    /// The corner at its start.
    corner: BezierBlend,
    /// Whether the window has been given a link.
    begun: bool,
    window: Window,
    /// Speeds of the next corners, as far as they are decided.
    speeds: VecDeque<f64>,
    /// Legs that have not been unrolled, each with the corner at its end.
    legs: VecDeque<(Segment<N>, BezierBlend)>,
    /// How the next leg to be unrolled begins.
    from: BlendShape,
    pieces: VecDeque<Piece<N>>,
}

impl<const N: usize> Course<N> {
    /// A course of legs within `limits`, whose corners are within others.
    pub(super) fn new(start: Vector<N>, limits: Limits<N>, corners: Limits<N>) -> Self {
        Self {
            limits: corners,
            merger: SegmentMerger::new(start, limits, ROUNDING_SHARE),
            pending: None,
            corner: BezierBlend::STOP,
            begun: false,
            window: Window::new(WINDOW, false),
            speeds: VecDeque::with_capacity(WINDOW + 4),
            legs: VecDeque::with_capacity(2 * WINDOW + 8),
            from: BlendShape::STOP,
            pieces: VecDeque::with_capacity(PIECES + MAX_PIECES + 1),
        }
    }

    /// Takes the next vertex.
    pub(super) fn push(&mut self, vertex: Vertex<N>) {
        if let Some(leg) = self.merger.push(vertex) {
            self.take_leg(leg);
        }
    }

    /// The motion must rest where the path has come to.
    pub(super) fn rest(&mut self) {
        if let Some(leg) = self.merger.flush() {
            self.take_leg(leg);
        }
        if let Some(last) = &mut self.pending {
            last.stop = true;
        }
    }

    /// The motion must pause where the path has come to.
    pub(super) fn dwell(&mut self, pause: Pause<N>) {
        self.rest();
        let pause = match self.merger.take_carried() {
            Some(carried) => carried.then(pause),
            None => pause,
        };
        self.pause(pause);
    }

    /// Brings the motion to rest at the end of the last leg.
    pub(super) fn close(&mut self) {
        self.rest();
        if let Some(carried) = self.merger.take_carried() {
            self.pause(carried);
        }
        if let Some(last) = self.pending.take() {
            self.settle(last, BezierBlend::STOP);
            self.window.finish();
            self.decide();
            self.speeds.push_back(0.0);
        }
    }

    /// The next piece of finished motion.
    pub(super) fn pull(&mut self) -> Option<Piece<N>> {
        loop {
            if let Some(piece) = self.pieces.pop_front() {
                return Some(piece);
            }
            let speed = self.speeds.pop_front()?;
            self.unroll(speed);
        }
    }

    fn pause(&mut self, pause: Pause<N>) {
        match &mut self.pending {
            Some(last) => {
                last.dwell = Some(match last.dwell {
                    Some(before) => before.then(pause),
                    None => pause,
                });
            }
            None => self.pieces.push_back(pause.piece(self.merger.anchor())),
        }
    }

    /// Takes a leg, which completes the corner at its start.
    fn take_leg(&mut self, leg: Segment<N>) {
        if let Some(last) = self.pending.replace(leg) {
            let bend = if last.stop {
                BezierBlend::STOP
            } else {
                let corner = corner_between(&last, &leg, last.room().min(leg.room()));
                let lengths = [last.length, leg.length];
                BezierBlend::new(&corner, lengths, [&last.limits, &leg.limits], &self.limits)
            };
            self.settle(last, bend);
            self.decide();
        }
    }

    /// Gives the window a leg whose two corners are known.
    fn settle(&mut self, leg: Segment<N>, end: BezierBlend) {
        let link = Link {
            length: (leg.length - self.corner.reach - end.reach).max(0.0),
            limits: leg.limits,
        };
        if self.begun {
            self.window
                .push(BlendShape::through(self.corner.speed), link);
        } else {
            self.window.begin(link);
            self.begun = true;
        }
        self.legs.push_back((leg, end));
        self.corner = end;
    }

    fn decide(&mut self) {
        while let Some(turn) = self.window.pull() {
            self.speeds.push_back(turn.entry.speed);
        }
    }

    /// Unrolls the next leg and the corner at its end.
    fn unroll(&mut self, speed: f64) {
        let Some((leg, bend)) = self.legs.pop_front() else {
            return;
        };
        let next = self.legs.front().map(|(next, _)| next);
        let next = next.or(self.pending.as_ref());
        let to = next.map_or(BlendShape::STOP, |next| {
            bend.turn(speed, [&leg.limits, &next.limits])
        });
        let pieces = &mut self.pieces;
        unroll_leg(&leg, &self.from, &to, |piece| {
            pieces.push_back(piece);
        });
        if let Some(pause) = leg.dwell {
            pieces.push_back(pause.piece(leg.end));
        }
        if let Some(next) = next {
            let corner = corner_between(&leg, next, leg.room().min(next.room()));
            let serves = MoveRange {
                first: leg.serves.first,
                last: next.serves.last,
            };
            bend.unroll(&corner, to.entry.speed, serves, |piece| {
                pieces.push_back(piece)
            });
        }
        self.from = to;
    }
}
