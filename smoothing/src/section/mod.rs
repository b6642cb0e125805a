//! Plans short sections of a path, from rest to rest, in several ways, and hands out the fastest.
//!
//! Source: ours. A section is held back until the path comes to rest, unless it grows long: then motion is handed
//! out as its stretches are planned, until the next rest. Not here: the plans.

mod ways;

use crate::arc_parts::{MAX_CHORDS, without_bends};
use crate::corner::candidates::Blenders;
use crate::method::Settings;
use crate::segment::Segment;
use crate::segment_merger::{SegmentMerger, Vertex};
use crate::stretch::{FINE_SHARE, Stretches, stops_within};
use crate::work::Work;
use std::collections::VecDeque;
use toolglide_kinematics::numeric::TIME_SLACK;
use toolglide_kinematics::{Pause, Piece, Tolerance, Vector};
use ways::Ways;

/// Most vertices, and most legs, of a section that is held back; no more vertices than the window has corners.
const MAX_HELD: usize = 1024;

/// Most stops that the legs of a section that is held back have room for: some 2 s of motion on a mill. Counted in stops,
/// so that a path of other lengths and times is planned in the same way.
const MAX_STOPS: f64 = 80.0;

/// Most pieces of a section that is held back.
const MAX_PIECES: usize = 8192;

/// Most legs on which the motion can reach its feedrate and stop again, of a section that is held back though these
/// take more than such a share of its stops: what is before them hardly depends on what follows.
const MAX_LONG: usize = 1;
const LONG_SHARE: f64 = 0.5;

/// A leg is long if it is longer than so many stops.
const LONG: f64 = 2.0;

/// Plans section by section.
#[derive(Clone, Debug)]
pub(crate) struct Sections<const N: usize> {
    stretches: Stretches<N>,
    state: State,
    /// The section that is held back: where it begins, its legs, and what corners are made of.
    start: Vector<N>,
    merger: SegmentMerger<N>,
    legs: Vec<Segment<N>>,
    vertices: Vec<Vertex<N>>,
    long: usize,
    /// Stops that these have room for, and that all legs have.
    long_stops: f64,
    stops: f64,
    window: usize,
    ways: Ways<N>,
    /// Motion: the first `ready` pieces are to be handed out, those of the section behind them may still become
    /// others.
    held: VecDeque<Piece<N>>,
    ready: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// The motion of the section is held back.
    Held,
    /// It is handed out as it comes.
    Streaming,
    /// A section has come to rest, and no other has begun.
    Rested,
}

impl<const N: usize> Sections<N> {
    pub(crate) fn new(
        start: Vector<N>,
        settings: &Settings<N>,
        blenders: Option<&Blenders<N>>,
    ) -> Self {
        Self {
            stretches: Stretches::new(start, settings, blenders),
            state: State::Rested,
            start,
            merger: SegmentMerger::new(start, settings.limits, FINE_SHARE),
            legs: Vec::with_capacity(MAX_HELD + 2),
            vertices: Vec::with_capacity(MAX_HELD + MAX_CHORDS + 2),
            long: 0,
            long_stops: 0.0,
            stops: 0.0,
            window: settings.window.min(MAX_HELD),
            ways: Ways::new(start, settings),
            held: VecDeque::with_capacity(2 * MAX_PIECES),
            ready: 0,
        }
    }

    /// Takes the next vertex.
    pub(crate) fn push(&mut self, vertex: Vertex<N>) {
        self.begin();
        self.stretches.push(vertex);
        if self.state != State::Held {
            return;
        }
        self.vertices.extend(without_bends(vertex));
        if let Some(leg) = self.merger.push(vertex) {
            self.take(leg);
        }
        self.hold();
    }

    /// An arc of some tolerance begins.
    pub(crate) fn begin_arc(&mut self, tolerance: Tolerance) {
        self.begin();
        self.stretches.begin_arc(tolerance);
        self.end_leg();
    }

    /// The leg under way ends where the path has come to.
    pub(crate) fn part(&mut self) {
        self.stretches.part();
        self.end_leg();
    }

    /// The motion must rest where the path has come to.
    pub(crate) fn rest(&mut self) {
        self.stretches.rest();
        self.end_leg();
        if self.state == State::Held {
            self.choose();
        }
        self.ready = self.held.len();
        self.state = State::Rested;
    }

    /// The motion must pause where the path has come to.
    pub(crate) fn dwell(&mut self, pause: Pause<N>) {
        self.rest();
        self.stretches.dwell(pause);
    }

    /// The path ends.
    pub(crate) fn close(&mut self) {
        self.rest();
        self.stretches.close();
    }

    /// The next piece of finished motion.
    pub(crate) fn pull(&mut self) -> Option<Piece<N>> {
        if self.ready > 0 {
            self.ready -= 1;
            return self.held.pop_front();
        }
        if self.state == State::Held {
            return None;
        }
        self.stretches.pull()
    }

    /// What has been planned so far.
    pub(crate) fn work_done(&self) -> Work {
        let mut work = self.stretches.work_done();
        work.corners += self.ways.joined();
        work
    }

    /// Begins a section where the path has come to rest.
    fn begin(&mut self) {
        if self.state != State::Rested {
            return;
        }
        self.held
            .extend(std::iter::from_fn(|| self.stretches.pull()));
        self.ready = self.held.len();
        self.state = State::Held;
        self.start = self.stretches.position();
        self.merger.restart(self.start);
        self.legs.clear();
        self.vertices.clear();
        self.long = 0;
        self.long_stops = 0.0;
        self.stops = 0.0;
    }

    /// Ends the leg under way.
    fn end_leg(&mut self) {
        if self.state == State::Held {
            if let Some(leg) = self.merger.flush() {
                self.take(leg);
            }
            self.hold();
        }
    }

    fn take(&mut self, leg: Segment<N>) {
        let stops = stops_within(&leg);
        self.stops += stops;
        if stops > LONG {
            self.long += 1;
            self.long_stops += stops;
        }
        self.legs.push(leg);
    }

    /// Holds back what the stretches have ready, unless the section has grown long.
    fn hold(&mut self) {
        let most = self.ready + MAX_PIECES;
        while self.held.len() < most
            && let Some(piece) = self.stretches.pull()
        {
            self.held.push_back(piece);
        }
        let long = self.legs.len() >= MAX_HELD
            || self.vertices.len() >= self.window
            || self.stops > MAX_STOPS
            || self.held.len() >= most
            || (self.long > MAX_LONG && self.long_stops > LONG_SHARE * self.stops);
        if long {
            self.ready = self.held.len();
            self.state = State::Streaming;
        }
    }

    /// Puts another motion in the place of what is held, where there is a faster one.
    fn choose(&mut self) {
        if self.merger.take_carried().is_some() {
            return;
        }
        let held = self.held.range(self.ready..);
        let most = held.map(Piece::duration).sum::<f64>() - TIME_SLACK;
        let Self {
            ways,
            stretches,
            held,
            ..
        } = self;
        if ways.find(stretches, self.start, &self.legs, &self.vertices, most) {
            held.truncate(self.ready);
            held.extend(std::iter::from_fn(|| ways.pull(stretches)));
        }
    }
}
