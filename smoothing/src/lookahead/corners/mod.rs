//! Plans a path of straight vertices corner by corner.
//!
//! Source: chapter 3. Vertices merge into legs, legs meet in corners, windows scale a motion for each
//! corner, the lattice chooses among them, and the chosen ones are unrolled into pieces when they are
//! asked for. Not here: any formula.

mod division;
mod offer;
mod unroll;

use crate::corner::candidates::{Blenders, Selection};
use crate::lookahead::candidate_graph::{CandidateGraph, Choice};
use crate::lookahead::unroll::{MAX_PIECES, corner_between};
use crate::lookahead::window::{Link, Window};
use crate::method::{Method, Settings};
use crate::segment::Segment;
use crate::segment_merger::{MERGE_SHARE, ROUNDING_SHARE, SegmentMerger, Vertex, vertex_of};
use division::division_of;
pub(crate) use division::room_beside;
use offer::overlapping_of;
use std::collections::VecDeque;
use toolglide_kinematics::{Limits, PathLimits, Pause, Piece, Tolerance, Vector};
use toolglide_profiles::BlendShape;

/// Plans the corners of a stream of vertices, from rest to rest.
#[derive(Clone, Debug)]
pub(crate) struct Corners<const N: usize> {
    merger: SegmentMerger<N>,
    /// The last leg, or part of one, whose end is still open, and the length of the whole.
    pending: Option<Segment<N>>,
    whole: f64,
    /// Whether the plan has been divided since it began, and direction and limits of the leg on which it was: what is
    /// left of that has the very same, whatever the rounding of the place says.
    cruises: bool,
    course: Option<(Vector<N>, PathLimits)>,
    selections: Vec<Selection<N>>,
    windows: Vec<Window>,
    scaled: Vec<VecDeque<BlendShape>>,
    stops_allowed: bool,
    lattice: CandidateGraph,
    /// Legs that have not been unrolled; the first `offered` of them are in the lattice.
    legs: VecDeque<Segment<N>>,
    offered: usize,
    /// Scales of uninterrupted corners that may overlap, see [`overlapping_of`].
    overlapping: &'static [f64],
    limits: Limits<N>,
    /// The leg before the next one to be unrolled.
    last: Option<Segment<N>>,
    /// The leg before the first that is not in the lattice.
    last_offered: Option<Segment<N>>,
    /// How the next leg to be unrolled begins.
    from: Choice,
    pieces: VecDeque<Piece<N>>,
    /// Legs that have been joined in corners since it was made.
    joined: u64,
}

impl<const N: usize> Corners<N> {
    /// A planner that takes `burst` legs without being pulled before it allocates; `blenders` take the place of those
    /// of the method.
    pub(crate) fn new(
        start: Vector<N>,
        settings: &Settings<N>,
        blenders: Option<&Blenders<N>>,
        burst: usize,
    ) -> Self {
        let size = settings.window.max(SHORTEST_WINDOW);
        let selections = Selection::of(settings, blenders);
        let windows: Vec<_> = selections
            .iter()
            .map(|selection| Window::new(size, selection.is_balanced()))
            .collect();
        Self {
            merger: SegmentMerger::new(start, settings.limits, share_of(settings.method)),
            pending: None,
            whole: 0.0,
            cruises: false,
            course: None,
            scaled: windows
                .iter()
                .map(|_| VecDeque::with_capacity(burst + 2 * size + 4))
                .collect(),
            windows,
            selections,
            stops_allowed: matches!(settings.method, Method::Kcs | Method::ExactStop),
            lattice: CandidateGraph::new(size.max(MIN_WAYS), burst),
            legs: VecDeque::with_capacity(burst + 3 * size + 2 * MIN_WAYS),
            offered: 0,
            overlapping: overlapping_of(settings.method),
            limits: settings.limits,
            last: None,
            last_offered: None,
            from: AT_REST,
            pieces: VecDeque::with_capacity(MAX_PIECES + 1),
            joined: 0,
        }
    }

    /// Begins again at rest at `start`; everything must have been closed and pulled.
    pub(crate) fn restart(&mut self, start: Vector<N>) {
        self.restart_after(start, BlendShape::STOP);
    }

    /// Begins again on a leg, with a speed from which the leg has room for a stop.
    pub(crate) fn restart_moving(&mut self, leg: Segment<N>, speed: f64) {
        self.restart_after(leg.end, BlendShape::through(speed));
        self.take_leg(leg);
    }

    fn restart_after(&mut self, start: Vector<N>, shape: BlendShape) {
        self.merger.restart(start);
        self.pending = None;
        self.cruises = false;
        for (window, scaled) in self.windows.iter_mut().zip(&mut self.scaled) {
            window.restart_after(shape);
            scaled.clear();
        }
        self.lattice.restart_after(shape);
        self.legs.clear();
        self.offered = 0;
        self.last = None;
        self.last_offered = None;
        self.from = Choice {
            shape,
            overlap: None,
        };
        self.pieces.clear();
    }

    /// Takes the next vertex.
    pub(crate) fn push(&mut self, vertex: Vertex<N>) {
        // What goes on from where the motion cruises goes straight on.
        let goes_on = self.is_cruising() && !self.merger.has_begun();
        if let Some(leg) = self.merger.push(vertex) {
            self.take_leg(leg);
        }
        if goes_on {
            self.part();
        }
    }

    /// The motion must rest where the path has come to.
    pub(crate) fn rest(&mut self) {
        self.part();
        if let Some(last) = &mut self.pending {
            last.stop = true;
        }
    }

    /// The motion must pause where the path has come to.
    pub(crate) fn dwell(&mut self, pause: Pause<N>) {
        self.rest();
        let pause = match self.merger.take_carried() {
            Some(carried) => carried.then(pause),
            None => pause,
        };
        self.pause(pause);
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

    /// Brings the motion to rest at the end of the last leg.
    pub(crate) fn close(&mut self) {
        self.rest();
        if let Some(carried) = self.merger.take_carried() {
            self.pause(carried);
        }
        for window in &mut self.windows {
            window.finish();
        }
        self.offer();
        if let Some(last) = self.pending.take() {
            self.end(last, BlendShape::STOP);
        }
    }

    /// Begins a new leg where the path has come to.
    pub(crate) fn part(&mut self) {
        if let Some(leg) = self.merger.flush() {
            self.take_leg(leg);
        }
    }

    /// Takes the first part of a leg that is long enough behind it to be left at its velocity, and divides the plan at
    /// its end.
    pub(crate) fn push_cruising(&mut self, first: &Segment<N>) {
        self.part();
        self.merger.push(vertex_of(first));
        if let Some(leg) = self.merger.flush() {
            let whole = leg.length;
            let along = Segment {
                direction: first.direction,
                limits: first.limits,
                ..leg
            };
            self.join(along, whole);
            self.divide();
        }
    }

    /// Takes the vertices of one more leg and ends the motion on it, cruising at a distance from its start, instead
    /// of at rest at its end; from rest at its start there must be room to reach the speed.
    pub(crate) fn close_cruising(
        &mut self,
        vertices: impl Iterator<Item = Vertex<N>>,
        distance: f64,
        speed: f64,
    ) {
        self.part();
        // Its start counts, so it is not divided.
        for vertex in vertices {
            if let Some(leg) = self.merger.push(vertex) {
                self.join(leg, leg.length);
            }
        }
        if let Some(leg) = self.merger.flush() {
            self.join(leg, leg.length);
        }
        for window in &mut self.windows {
            window.finish();
        }
        self.offer();
        if let Some(last) = self.pending.take() {
            self.end(
                Segment {
                    length: distance,
                    end: last.start + last.direction * distance,
                    ..last
                },
                BlendShape::through(speed),
            );
        }
    }

    /// Ends the motion at the end of a leg.
    fn end(&mut self, leg: Segment<N>, shape: BlendShape) {
        let link = link_of(&leg);
        self.cruises = false;
        self.legs.push_back(leg);
        self.lattice.push(&link, &[shape], &[], |_, _, _| None);
        self.offered += 1;
        self.lattice.finish();
    }

    /// Whether there is motion that has not been closed.
    pub(crate) fn has_begun(&self) -> bool {
        self.pending.is_some() || self.merger.has_begun() || self.is_cruising()
    }

    /// Whether all motion is planned to where it cruises, in the middle of a leg.
    pub(crate) fn is_cruising(&self) -> bool {
        self.pending.is_none() && self.cruises
    }

    /// Becomes a copy of another, without the motion that waits to be pulled.
    pub(crate) fn follow(&mut self, other: &Self) {
        self.merger.follow(&other.merger);
        self.pending = other.pending;
        self.whole = other.whole;
        self.cruises = other.cruises;
        self.course = other.course;
        for (window, others) in self.windows.iter_mut().zip(&other.windows) {
            window.follow(others);
        }
        for (scaled, others) in self.scaled.iter_mut().zip(&other.scaled) {
            scaled.clone_from(others);
        }
        self.lattice.follow(&other.lattice);
        self.legs.clear();
        self.legs.extend(other.legs.iter().skip(other.offered));
        self.offered = 0;
        self.last_offered = other.last_offered;
        self.pieces.clear();
    }

    /// Time from the beginning to rest after more vertices, of which no motion is made.
    pub(crate) fn time_to_rest(&mut self, vertices: impl IntoIterator<Item = Vertex<N>>) -> f64 {
        for vertex in vertices {
            self.push(vertex);
            self.lattice.forget();
            self.legs.drain(..self.offered);
            self.offered = 0;
        }
        self.close();
        self.duration()
    }

    /// Legs that have been joined in corners since it was made.
    pub(crate) fn joined(&self) -> u64 {
        self.joined
    }

    /// After it has been closed: the time from the beginning to the end.
    pub(crate) fn duration(&self) -> f64 {
        self.lattice.duration()
    }

    /// The next piece of finished motion.
    pub(crate) fn pull(&mut self) -> Option<Piece<N>> {
        loop {
            if let Some(piece) = self.pieces.pop_front() {
                return Some(piece);
            }
            let choice = self.lattice.pull()?;
            self.unroll(&choice);
        }
    }

    /// Takes a leg, which completes the corner at its start.
    fn take_leg(&mut self, leg: Segment<N>) {
        let whole = leg.length;
        match division_of(&leg, &self.limits) {
            Some(distance) => {
                let (first, second) = leg.divided(distance);
                self.join(first, whole);
                self.divide();
                self.join(second, whole);
            }
            None => self.join(leg, whole),
        }
    }

    /// Takes a leg, or a part of one of some length.
    fn join(&mut self, mut leg: Segment<N>, whole: f64) {
        self.joined += 1;
        if self.is_cruising()
            && let Some(course) = self.course
        {
            (leg.direction, leg.limits) = course;
        }
        let link = link_of(&leg);
        let before = std::mem::replace(&mut self.whole, whole);
        match self.pending.replace(leg) {
            None => {
                for window in &mut self.windows {
                    window.begin(link);
                }
            }
            Some(last) => {
                let corner = corner_between(&last, &leg, corner_tolerance(&last, &leg));
                for (selection, window) in self.selections.iter().zip(&mut self.windows) {
                    let shape = if last.stop {
                        BlendShape::STOP
                    } else if self.stops_allowed && goes_round(&last, &leg) {
                        selection.interrupted(&corner)
                    } else {
                        selection.shape(&corner, before, whole)
                    };
                    window.push(shape, link);
                }
                self.legs.push_back(last);
                self.offer();
            }
        }
    }

    /// The last leg, the first part of a long one, is left at its velocity, so that all before it is decided.
    fn divide(&mut self) {
        if let Some(leg) = self.pending.take() {
            for window in &mut self.windows {
                window.divide(leg.limits.velocity);
            }
            self.legs.push_back(Segment {
                cruises: true,
                ..leg
            });
            self.cruises = true;
            self.course = Some((leg.direction, leg.limits));
            self.offer();
        }
    }
}

/// Shortest window: two corners, so that one can be seen from the other.
const SHORTEST_WINDOW: usize = 2;

/// Fewest corners among whose motions the fastest way is sought.
const MIN_WAYS: usize = 16;

/// Largest turn between two chords of an arc at which only interrupted corners are tried, rad.
const ROUND: f64 = 0.2;

/// How a path begins.
const AT_REST: Choice = Choice {
    shape: BlendShape::STOP,
    overlap: None,
};

/// Share of the tolerance that merging may use.
fn share_of(method: Method) -> f64 {
    match method {
        Method::KcsLocal | Method::KcsGlobal => ROUNDING_SHARE,
        _ => MERGE_SHARE,
    }
}

/// Whether two legs are chords of one arc that turn little, as most do: what an interrupted corner loses there is not
/// worth what it costs to try others at every chord.
fn goes_round<const N: usize>(leg: &Segment<N>, next: &Segment<N>) -> bool {
    !leg.ends_before(next) && (next.direction - leg.direction).norm() < ROUND
}

fn link_of<const N: usize>(leg: &Segment<N>) -> Link {
    Link {
        length: leg.length,
        limits: leg.limits,
    }
}

/// The tolerance of the corner between two legs: what merging has left of both.
fn corner_tolerance<const N: usize>(leg: &Segment<N>, next: &Segment<N>) -> Tolerance {
    leg.room().min(next.room())
}
