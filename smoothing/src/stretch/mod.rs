//! Divides a section into stretches for short-segment smoothing.
//!
//! Source: ours. The path is cut where it turns sharply or must stop; each stretch between is planned
//! corner by corner, with superposed corners, and, where it has arcs, move by move, each from rest to
//! rest, and the fastest counts. Not here: the plans.

mod choose;
mod divide;
mod travel;
mod vertices;

use crate::lookahead::corners::Corners;

use crate::corner::candidates::Blenders;
use crate::method::{Method, Settings};
use crate::segment::Segment;
use crate::segment_merger::{MAX_MERGED, SegmentMerger, Vertex};
use crate::short_segments::{Effort, ShortSegmentSmoother};
use crate::work::Work;
use choose::{Ideal, MIN_LEGS, has_arc};
use std::collections::VecDeque;
use toolglide_kinematics::{Limits, Pause, Piece, Tolerance, Vector};
use vertices::Vertices;

/// Share of the tolerance that cleaning the path may use: enough for rounding of programs, and little enough that the
/// curve stays fine.
pub(crate) const FINE_SHARE: f64 = 0.05;

/// Sine of half the turn angle from which a corner is sharp: a turn of 25 degrees.
const SHARP: f64 = 0.216;

/// A part of an arc is tiny up to so many stops.
const TINY: f64 = 0.3;

/// Most legs of a stretch, but for those of an arc.
const MAX_LEGS: usize = 4096;

/// Most chords of an arc that is not taken by itself, from rest to rest.
pub(crate) const LONGEST_ARC: usize = 2048;

/// Most vertices of the legs that have not been planned, but for those of an arc.
const MAX_VERTICES: usize = 8192;

/// A stretch is planned without waiting for more of the path when it has so many legs and is longer than
/// so many stops; in a window of fewer corners as many legs, and stops in proportion.
const LEGS_AHEAD: usize = 512;
/// The same where some of the legs are parts of arcs, of an eighth of a turn at the most.
const PARTS_AHEAD: usize = 64;
const STOPS_AHEAD: f64 = 8.0;

/// Plans stretch by stretch.
#[derive(Clone, Debug)]
pub(crate) struct Stretches<const N: usize> {
    limits: Limits<N>,
    merger: SegmentMerger<N>,
    vertices: Vertices<N>,
    legs: Vec<Segment<N>>,
    corners: Corners<N>,
    trial: Corners<N>,
    superposer: ShortSegmentSmoother<N>,
    /// Legs, the first ones, over which the motion under way with superposed corners has been planned
    /// already: it goes on from there if it can.
    planned: usize,
    /// Length of the legs that have not been planned, each as a share of what a stop takes on it.
    ahead: f64,
    /// Legs, and stops, with which a stretch is planned without waiting for more.
    enough: (usize, f64),
    /// Whether lines are turned by one kind of corner throughout.
    forced: bool,
    /// Whether the corners under way have turned an arc: only then may stopping be faster.
    watched: bool,
    /// Whether the corners have been closed and begin again at rest.
    reopen: bool,
    /// Where the motion that has been closed ends.
    end: Vector<N>,
    /// What waits until a stretch with superposed corners has been pulled.
    events: VecDeque<Event<N>>,
}

/// What comes from the path, in order.
#[derive(Clone, Copy, Debug)]
enum Event<const N: usize> {
    Segment(Segment<N>),
    Rest,
    Dwell(Pause<N>),
    Close,
}

impl<const N: usize> Stretches<N> {
    pub(crate) fn new(
        start: Vector<N>,
        settings: &Settings<N>,
        blenders: Option<&Blenders<N>>,
    ) -> Self {
        Self {
            limits: settings.limits,
            merger: SegmentMerger::new(start, settings.limits, FINE_SHARE),
            vertices: Vertices::with_capacity(MAX_VERTICES + LONGEST_ARC + 2 * MAX_MERGED),
            legs: Vec::with_capacity(MAX_LEGS + LONGEST_ARC),
            corners: Corners::new(start, settings, blenders, MAX_VERTICES + LONGEST_ARC),
            trial: Corners::new(start, settings, blenders, 1),
            superposer: ShortSegmentSmoother::new(settings.limits, MAX_LEGS + LONGEST_ARC),
            planned: 0,
            ahead: 0.0,
            enough: enough_ahead(settings.window),
            forced: !matches!(settings.method, Method::Kcs | Method::ExactStop),
            watched: false,
            reopen: false,
            end: start,
            events: VecDeque::with_capacity(2 * (MAX_LEGS + LONGEST_ARC) + 8),
        }
    }

    /// Takes the next vertex.
    pub(crate) fn push(&mut self, vertex: Vertex<N>) {
        let next = self.vertices.push(vertex);
        if let Some(leg) = self.merger.push(Vertex { next, ..vertex }) {
            self.take(Event::Segment(leg));
        }
        let waiting = self.events.iter().find_map(|event| match event {
            Event::Segment(leg) => Some(leg),
            _ => None,
        });
        let oldest = self.legs.get(self.planned).or(waiting);
        self.vertices
            .forget_before(oldest.map_or(self.merger.first(), |leg| leg.vertices[0]));
    }

    /// An arc of some tolerance begins: its legs are the same whatever is beside it.
    pub(crate) fn begin_arc(&mut self, tolerance: Tolerance) {
        self.part();
        if self.merger.narrows(tolerance) {
            self.rest();
        }
    }

    /// The motion must rest where the path has come to.
    pub(crate) fn rest(&mut self) {
        self.part();
        self.take(Event::Rest);
        if let Some(carried) = self.merger.take_carried() {
            self.take(Event::Dwell(carried));
        }
    }

    /// The motion must pause where the path has come to.
    pub(crate) fn dwell(&mut self, pause: Pause<N>) {
        self.part();
        self.take(Event::Rest);
        let pause = match self.merger.take_carried() {
            Some(carried) => carried.then(pause),
            None => pause,
        };
        self.take(Event::Dwell(pause));
    }

    /// What has been planned so far.
    pub(crate) fn work_done(&self) -> Work {
        Work {
            pieces: self.superposer.proposed(),
            corners: self.corners.joined() + self.trial.joined(),
        }
    }

    /// Where the motion that has been pulled ends, at rest.
    pub(crate) fn position(&self) -> Vector<N> {
        self.merger.anchor()
    }

    /// Plans legs to where the motion has come to rest once more, superposed throughout, in less than `most`
    /// seconds; the duration, and the effort that is left. All that has been
    /// planned must have been pulled.
    pub(crate) fn superpose_whole(
        &mut self,
        legs: &[Segment<N>],
        most: f64,
        effort: Effort,
    ) -> (Option<f64>, usize) {
        let ideal = Ideal::of(legs);
        if ideal.at_feedrate + ideal.stop > most {
            return (None, effort.ways + effort.pulses);
        }
        self.superposer
            .plan_whole(legs, ideal.at_feedrate, most, effort)
    }

    /// Whether that comes as near to points as is said, one after the other.
    pub(crate) fn whole_passes(&self, points: impl Iterator<Item = (Vector<N>, f64, u32)>) -> bool {
        self.superposer.passes(points)
    }

    /// What was planned last in this way is pulled next.
    pub(crate) fn travel_whole(&mut self) {
        self.superposer.travel();
    }

    /// The path ends.
    pub(crate) fn close(&mut self) {
        self.rest();
        self.take(Event::Close);
    }

    /// The leg under way ends where the path has come to.
    pub(crate) fn part(&mut self) {
        if let Some(leg) = self.merger.flush() {
            self.take(Event::Segment(leg));
        }
    }

    /// The next piece of finished motion.
    pub(crate) fn pull(&mut self) -> Option<Piece<N>> {
        loop {
            if let Some(piece) = self.corners.pull() {
                return Some(piece);
            }
            // The corners before a stretch have been closed, and begin again at rest after it.
            if let Some(piece) = self.superposer.pull() {
                if self.superposer.is_done() {
                    self.reopen = self.planned == 0;
                    self.resume();
                }
                return Some(piece);
            }
            if !self.reopen {
                return None;
            }
            self.resume();
        }
    }

    /// Begins again after a stretch.
    fn resume(&mut self) {
        if self.reopen {
            self.reopen = false;
            self.watched = false;
            self.corners.restart(self.end);
        }
        self.work();
    }

    fn take(&mut self, event: Event<N>) {
        self.events.push_back(event);
        self.work();
    }

    /// Works off what has come, up to the next stretch with superposed corners.
    fn work(&mut self) {
        while self.superposer.is_done()
            && !self.reopen
            && let Some(event) = self.events.pop_front()
        {
            match event {
                Event::Segment(leg) => self.take_leg(leg),
                Event::Rest if self.legs.is_empty() => self.come_to_rest(),
                Event::Rest => {
                    // After whatever the stretch may put before it.
                    self.events.push_front(Event::Rest);
                    self.settle(Cause::Rest);
                }
                Event::Dwell(pause) => self.corners.dwell(pause),
                Event::Close => self.corners.close(),
            }
        }
    }

    fn take_leg(&mut self, leg: Segment<N>) {
        if let Some(last) = self.legs.last()
            && self.legs.len() > self.planned
        {
            let sharp = 0.5 * (leg.entry() - last.exit()).norm() > SHARP
                && !(is_tiny(&leg) && is_tiny(last));
            let cause = if !last.ends_before(&leg) {
                (self.is_within_a_long_move() && self.is_full()).then_some(Cause::Full)
            } else if sharp {
                Some(Cause::Sharp)
            } else {
                self.is_full().then_some(Cause::Full)
            };
            if let Some(cause) = cause {
                self.events.push_front(Event::Segment(leg));
                self.settle(cause);
                return;
            }
        }
        let leg = self.divide(leg);
        self.ahead += stops_within(&leg);
        self.legs.push(leg);
    }

    /// Whether the legs that have not been planned reach so far that what follows matters little, or are
    /// as many as can be held.
    fn is_full(&self) -> bool {
        let fresh = &self.legs[self.planned..];
        let (legs, stops) = self.enough;
        let legs = if has_arc(fresh) {
            legs.min(PARTS_AHEAD)
        } else {
            legs
        };
        (fresh.len() >= legs && self.ahead > stops)
            || self.legs.len() >= MAX_LEGS
            || self.vertices.count(fresh) >= MAX_VERTICES
    }

    /// Whether the last legs belong to one move that rests at both ends, because it is so long.
    fn is_within_a_long_move(&self) -> bool {
        let fresh = &self.legs[self.planned..];
        let begin = fresh.partition_point(|leg| leg.ends_before(&fresh[fresh.len() - 1]));
        self.vertices.count(&fresh[begin..]) > LONGEST_ARC
    }

    /// Plans the stretch that has been collected.
    fn settle(&mut self, cause: Cause) {
        self.ahead = 0.0;
        let mut legs = std::mem::take(&mut self.legs);
        if self.planned > 0 {
            self.go_on(&mut legs, cause);
        } else {
            self.set_out(&mut legs, cause);
        }
        self.legs = legs;
    }
}

/// Legs, and stops, with which a stretch is planned in a window of so many corners.
#[allow(clippy::cast_precision_loss, reason = "a few hundred legs")]
fn enough_ahead(window: usize) -> (usize, f64) {
    let legs = window.clamp(MIN_LEGS, LEGS_AHEAD);
    (legs, STOPS_AHEAD * legs as f64 / LEGS_AHEAD as f64)
}

/// Why a stretch ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cause {
    /// The motion must rest.
    Rest,
    /// The path turns sharply.
    Sharp,
    /// There is no room for more.
    Full,
}

/// Whether a leg belongs to an arc so small that the motion hardly changes its speed on it: between two such arcs a
/// corner is superposed like the arcs.
pub(crate) fn is_tiny<const N: usize>(leg: &Segment<N>) -> bool {
    leg.bend.is_some() && stops_within(leg) < TINY
}

/// Length of a leg as a share of what a stop takes.
pub(crate) fn stops_within<const N: usize>(leg: &Segment<N>) -> f64 {
    let speed = leg.limits.velocity;
    leg.length / (0.5 * speed * leg.limits.time_to_change(speed))
}
