//! Moves in, motion out: the stages of time-optimal planning in a row.
//!
//! Source: ours. Moves become straight vertices, those become runs, runs are cut into spans, and spans
//! are planned in windows. Stops and pauses divide the path into stretches. Not here: any formula, and
//! the comparison with other motion.

use crate::chords::Chords;
use crate::event::Event;
use crate::horizon::Horizon;
use crate::runs::{Joiner, Run, Vertex};
use crate::settings::Settings;
use crate::span::{Fineness, Part, cut};
use crate::window::WindowSolver;
use std::collections::VecDeque;
use toolglide_kinematics::{Limits, Move, Path, Pause, Serves, Vector, WindowTally};

/// Events that are kept room for: those of a window and a few stops.
const EVENTS: usize = 2048;

/// Plans a stream of moves by a window solver.
#[derive(Clone, Debug)]
pub(crate) struct Stream<S, const N: usize> {
    limits: Limits<N>,
    fineness: Fineness,
    joiner: Joiner<N>,
    horizon: Horizon<S, N>,
    position: Vector<N>,
    index: u32,
    /// The arc under way, and its move.
    arc: Option<(Chords<N>, Move<N>, u32)>,
    finished: bool,
    events: VecDeque<Event<N>>,
}

impl<S: WindowSolver<N>, const N: usize> Stream<S, N> {
    pub(crate) fn new(solver: S, start: Vector<N>, settings: &Settings<N>) -> Self {
        Self {
            limits: settings.limits,
            fineness: settings.effort.fineness(),
            joiner: Joiner::new(start),
            horizon: Horizon::new(solver, start, settings),
            position: start,
            index: 0,
            arc: None,
            finished: false,
            events: VecDeque::with_capacity(EVENTS),
        }
    }

    /// Takes the next move, which begins where the last one ended.
    pub(crate) fn push(&mut self, next: &Move<N>) {
        while self.advance_arc() {}
        let index = self.index;
        self.index += 1;
        self.position = next.end(self.position);
        match next.path() {
            Path::Line { end } => self.take_point(next, index, *end, 0.0),
            Path::Arc(arc) => {
                let chords = Chords::new(*arc, next.tolerance().length());
                self.arc = Some((chords, *next, index));
                return;
            }
            Path::Dwell { duration } => {
                self.rest(Some(Pause {
                    duration: *duration,
                    serves: Serves::one(index),
                    end: self.position,
                }));
                return;
            }
            _ => {}
        }
        if next.stops() {
            self.rest(None);
        }
    }

    /// No more moves come: the motion rests.
    pub(crate) fn finish(&mut self) {
        self.finished = true;
        if self.arc.is_none() {
            self.rest(None);
        }
    }

    /// What has been planned next.
    pub(crate) fn pull(&mut self) -> Option<Event<N>> {
        loop {
            if let Some(event) = self.events.pop_front() {
                return Some(event);
            }
            if !self.advance_arc() {
                return None;
            }
        }
    }

    /// How many windows there were.
    pub(crate) fn tally(&self) -> WindowTally {
        self.horizon.tally()
    }

    /// Takes the next chord of the arc under way; `false` when there is none.
    fn advance_arc(&mut self) -> bool {
        let Some((chords, step, index)) = &mut self.arc else {
            return false;
        };
        let (step, index, bulge) = (*step, *index, chords.bulge());
        if let Some(point) = chords.next() {
            self.take_point(&step, index, point, bulge);
        } else {
            self.arc = None;
            if step.stops() {
                self.rest(None);
            }
            if self.finished {
                self.rest(None);
            }
        }
        true
    }

    fn take_point(&mut self, step: &Move<N>, index: u32, point: Vector<N>, bulge: f64) {
        let vertex = Vertex {
            point,
            bulge,
            feedrate: step.feedrate().speed(),
            tolerance: step.tolerance().length(),
            index,
        };
        if let Some(run) = self.joiner.push(vertex) {
            self.take_run(&run);
        }
    }

    fn take_run(&mut self, run: &Run<N>) {
        cut(run, &self.limits, self.fineness, |part| match part {
            Part::Span(span) => self.horizon.push(span),
            Part::Cruise(cruise) => self.horizon.cruise(&cruise),
        });
        self.horizon.plan();
        self.collect();
    }

    /// Comes to rest where the path has come to, and pauses there.
    fn rest(&mut self, pause: Option<Pause<N>>) {
        if let Some(run) = self.joiner.flush() {
            self.take_run(&run);
        }
        self.horizon.rest(self.joiner.anchor());
        self.collect();
        let at = self.joiner.anchor();
        let pause = match (self.joiner.take_carried(), pause) {
            (Some(carried), Some(pause)) => Some(carried.then(pause)),
            (carried, pause) => carried.or(pause),
        };
        if let Some(pause) = pause {
            self.events.push_back(Event::Piece(pause.piece(at)));
        }
        self.events
            .push_back(Event::Rest(self.index.saturating_sub(1)));
    }

    fn collect(&mut self) {
        while let Some(event) = self.horizon.pull() {
            self.events.push_back(event);
        }
    }
}
