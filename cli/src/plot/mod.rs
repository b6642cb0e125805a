//! Draws a motion, gathered in fixed memory while it streams past.
//!
//! On the left the path, coloured by speed, and its sharpest corner; on the right feedrate,
//! velocity, acceleration and jerk over time with their limits.

pub(crate) mod canvas;
pub(crate) mod chart;
pub(crate) mod color;
mod contrast;
mod corner;
pub(crate) mod curve;
pub(crate) mod envelope;
mod executed;
mod feeds;
mod motion;
mod path;
mod picture;
mod render;
mod sheet;
mod simulation;
mod spectra;
mod trace;
pub(crate) mod zoom;

use corner::{CornerFinder, flatten};
use envelope::Envelope;
use std::collections::VecDeque;
use toolglide_kinematics::{Limits, Move, Piece, Sample, Vector};
use trace::Trace;

pub(crate) use contrast::Contrast;
pub(crate) use executed::ExecutedPlot;
pub(crate) use feeds::Feeds;
pub(crate) use picture::Picture;
pub(crate) use sheet::Caption;
pub(crate) use simulation::{ResponseCurve, Responses, SimulationPlot, SimulationTrace};
pub(crate) use spectra::{Spectra, Spectrum};

/// Points at which the speed along a piece is drawn.
const POINTS_PER_PIECE: u32 = 8;

/// Gathers what the picture shows.
#[derive(Clone, Debug)]
pub(crate) struct Plot<const N: usize> {
    limits: Limits<N>,
    letters: Vec<char>,
    programmed: Trace<N>,
    motion: Trace<N>,
    curves: Envelope,
    corner: CornerFinder<N>,
    feeds: VecDeque<(u32, f64)>,
    moves: u32,
    at: Vector<N>,
    time: f64,
    cutting_speed: f64,
}

/// What stands for the speed of a rapid, which is coloured like nothing else.
const RAPID: f64 = f64::INFINITY;

/// Order of the curves of the envelope: velocity, acceleration and jerk of each axis, then these.
const fn speed_curve(axes: usize) -> usize {
    3 * axes
}

const fn feed_curve(axes: usize) -> usize {
    3 * axes + 1
}

impl<const N: usize> Plot<N> {
    /// Begins at rest at `start`.
    pub(crate) fn new(start: Vector<N>, limits: Limits<N>, letters: Vec<char>) -> Self {
        Self {
            limits,
            letters,
            programmed: Trace::starting_at(start, 0.0),
            motion: Trace::starting_at(start, 0.0),
            curves: Envelope::new(3 * N + 2),
            corner: CornerFinder::starting_at(start),
            feeds: VecDeque::new(),
            moves: 0,
            at: start,
            time: 0.0,
            cutting_speed: 0.0,
        }
    }

    /// Takes the next move of the path.
    pub(crate) fn expect(&mut self, next: &Move<N>) {
        self.corner.expect(next);
        let mut points = Vec::new();
        flatten(next, self.at, &mut points);
        for point in points {
            self.programmed.push(point, 0.0);
        }
        self.at = next.end(self.at);
        self.feeds.push_back((self.moves, next.feedrate().speed()));
        self.moves = self.moves.saturating_add(1);
    }

    /// Takes the next piece of the motion.
    pub(crate) fn observe(&mut self, piece: &Piece<N>) {
        self.corner.observe(piece);
        let serves = piece.serves();
        while let Some(&(index, _)) = self.feeds.front()
            && index < serves.first
        {
            self.feeds.pop_front();
        }
        let feed = self
            .feeds
            .iter()
            .take_while(|feed| feed.0 <= serves.last)
            .fold(f64::NEG_INFINITY, |most, feed| most.max(feed.1));
        self.trace(piece, feed.is_infinite());
        let start = self.time;
        self.time += piece.duration();
        let mut before = piece.at(0.0);
        for stretch in self.curves.stretches(start, self.time) {
            let until = self.curves.begin(stretch) + self.curves.width() - start;
            let after = piece.at(until.min(piece.duration()));
            self.add(stretch, &before, &after);
            if feed.is_finite() {
                self.curves.add(stretch, feed_curve(N), feed);
            }
            before = after;
        }
    }

    /// Whether an axis moves at all.
    fn moves(&self, axis: usize) -> bool {
        self.curves.peak(axis) > 0.0
    }

    fn add(&mut self, stretch: usize, before: &Sample<N>, after: &Sample<N>) {
        for axis in 0..N {
            for state in [before, after] {
                self.curves.add(stretch, axis, state.velocity[axis]);
                self.curves.add(stretch, N + axis, state.acceleration[axis]);
            }
            self.curves.add(stretch, 2 * N + axis, before.jerk[axis]);
            if before.acceleration[axis] * after.acceleration[axis] < 0.0 {
                let peak = before.velocity[axis]
                    - 0.5 * before.acceleration[axis] * before.acceleration[axis]
                        / before.jerk[axis];
                self.curves.add(stretch, axis, peak);
            }
        }
        self.curves
            .add(stretch, speed_curve(N), before.velocity.norm());
        self.curves
            .add(stretch, speed_curve(N), after.velocity.norm());
    }

    fn trace(&mut self, piece: &Piece<N>, rapid: bool) {
        let duration = piece.duration();
        let far = (piece.end() - piece.start()).norm() >= self.motion.spacing();
        let points = if far && !rapid { POINTS_PER_PIECE } else { 1 };
        for step in 1..=points {
            let state = piece.at(duration * f64::from(step) / f64::from(points));
            let speed = state.velocity.norm();
            if !rapid {
                self.cutting_speed = self.cutting_speed.max(speed);
            }
            self.motion
                .push(state.position, if rapid { RAPID } else { speed });
        }
    }
}
