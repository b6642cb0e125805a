//! Straight vertices in, motion out: a path planned corner by corner.
//!
//! Source: chapter 3. Vertices merge into legs, legs meet in corners, windows scale a motion for each
//! corner, the lattice chooses among them, and the chosen ones are unrolled into pieces when they are
//! asked for. Not here: any formula.

use crate::lattice::{Choice, Lattice, MOST_CANDIDATES};
use crate::leg::{Dwell, Leg};
use crate::merge::{MERGE_SHARE, Merger, ROUNDING_SHARE, Vertex};
use crate::method::{Method, Settings};
use crate::overlap::Between;
use crate::pieces::{MOST_PIECES, corner_between, cruise_on, unroll_corner, unroll_leg};
use crate::select::Selection;
use crate::turn::{Part, TurnShape};
use crate::window::{Link, Window};
use std::collections::VecDeque;
use toolglide_kinematics::numeric::CLOSURE;
use toolglide_kinematics::{Limits, Piece, Tolerance, Vector};

/// Plans the corners of a stream of vertices, from rest to rest.
#[derive(Clone, Debug)]
pub(crate) struct Corners<const N: usize> {
    merger: Merger<N>,
    /// The last leg, whose end is still open.
    pending: Option<Leg<N>>,
    selections: Vec<Selection<N>>,
    windows: Vec<Window>,
    scaled: Vec<VecDeque<TurnShape>>,
    stops_allowed: bool,
    lattice: Lattice,
    /// Legs that have not been unrolled; the first `offered` of them are in the lattice.
    legs: VecDeque<Leg<N>>,
    offered: usize,
    /// Scales of uninterrupted corners that may overlap, see [`overlapping_of`].
    overlapping: &'static [f64],
    limits: Limits<N>,
    /// The leg before the next one to be unrolled.
    last: Option<Leg<N>>,
    /// The leg before the first that is not in the lattice.
    last_offered: Option<Leg<N>>,
    /// How the next leg to be unrolled begins.
    from: Choice,
    /// Distance on the last leg at which another motion takes over.
    until: f64,
    pieces: VecDeque<Piece<N>>,
}

impl<const N: usize> Corners<N> {
    /// A planner that takes `burst` legs without being pulled before it allocates.
    pub(crate) fn new(start: Vector<N>, settings: &Settings<N>, burst: usize) -> Self {
        let size = settings.window.max(SHORTEST_WINDOW);
        let selections = Selection::of(settings);
        let windows: Vec<_> = selections
            .iter()
            .map(|selection| Window::new(size, selection.is_balanced()))
            .collect();
        Self {
            merger: Merger::new(start, settings.limits, share_of(settings.method)),
            pending: None,
            scaled: windows
                .iter()
                .map(|_| VecDeque::with_capacity(burst + 2 * size + 4))
                .collect(),
            windows,
            selections,
            stops_allowed: matches!(settings.method, Method::Kcs | Method::ExactStop),
            lattice: Lattice::new(size.max(FEWEST_WAYS), burst),
            legs: VecDeque::with_capacity(burst + 3 * size + 2 * FEWEST_WAYS),
            offered: 0,
            overlapping: overlapping_of(settings.method),
            limits: settings.limits,
            last: None,
            last_offered: None,
            from: AT_REST,
            until: f64::INFINITY,
            pieces: VecDeque::with_capacity(MOST_PIECES + 1),
        }
    }

    /// Begins again at rest at `start`; everything must have been closed and pulled.
    pub(crate) fn restart(&mut self, start: Vector<N>) {
        self.restart_after(start, TurnShape::STOP);
    }

    /// Begins again on a leg, with a speed from which the leg has room for a stop.
    pub(crate) fn restart_moving(&mut self, leg: Leg<N>, speed: f64) {
        self.restart_after(leg.end, TurnShape::through(speed));
        self.take_leg(leg);
    }

    fn restart_after(&mut self, start: Vector<N>, shape: TurnShape) {
        self.merger.restart(start);
        self.pending = None;
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
        self.until = f64::INFINITY;
        self.pieces.clear();
    }

    /// Takes the next vertex.
    pub(crate) fn push(&mut self, vertex: Vertex<N>) {
        if let Some(leg) = self.merger.push(vertex) {
            self.take_leg(leg);
        }
    }

    /// The motion must rest where the path has come to.
    pub(crate) fn rest(&mut self) {
        if let Some(leg) = self.merger.flush() {
            self.take_leg(leg);
        }
        if let Some(last) = &mut self.pending {
            last.stop = true;
        }
    }

    /// The motion must pause where the path has come to.
    pub(crate) fn dwell(&mut self, pause: Dwell<N>) {
        self.rest();
        let pause = match self.merger.take_carried() {
            Some(carried) => carried.then(pause),
            None => pause,
        };
        self.pause(pause);
    }

    fn pause(&mut self, pause: Dwell<N>) {
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
            let link = link_of(&last);
            self.legs.push_back(last);
            self.lattice
                .push(&link, &[TurnShape::STOP], &[], |_, _| None);
            self.offered += 1;
            self.lattice.finish();
        }
    }

    /// Whether the motion need not rest at the end of the last leg so far.
    pub(crate) fn is_under_way(&self) -> bool {
        self.pending.as_ref().is_some_and(|last| !last.stop)
    }

    /// After it has been closed: ends the motion where it cruises over a distance from the start of the
    /// last leg, instead of bringing it to rest at its end, if it does so at this speed.
    pub(crate) fn end_cruising(&mut self, start: &Vector<N>, distance: f64, speed: f64) -> bool {
        let Some(leg) = self.legs.back().filter(|leg| leg.start == *start) else {
            return false;
        };
        let from = self.lattice.before_last().unwrap_or(self.from);
        let cruises = cruise_on(leg, &from.shape, &TurnShape::STOP).is_some_and(
            |(cruising, [begin, end])| {
                begin <= distance && distance <= end && (cruising - speed).abs() <= CLOSURE * speed
            },
        );
        if cruises {
            self.until = distance;
        }
        cruises
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
    fn take_leg(&mut self, leg: Leg<N>) {
        let link = link_of(&leg);
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
                        TurnShape::STOP
                    } else {
                        selection.shape(&corner, last.length, leg.length)
                    };
                    window.push(shape, link);
                }
                self.legs.push_back(last);
                self.offer();
            }
        }
    }

    /// Hands corners to the lattice that all windows have scaled.
    fn offer(&mut self) {
        for (window, scaled) in self.windows.iter_mut().zip(&mut self.scaled) {
            while let Some(shape) = window.pull() {
                scaled.push_back(shape);
            }
        }
        while self.offered < self.legs.len() && self.scaled.iter().all(|queue| !queue.is_empty()) {
            let mut candidates = [TurnShape::STOP; MOST_CANDIDATES];
            let mut count = 0;
            let leg = &self.legs[self.offered];
            for queue in &mut self.scaled {
                if let Some(shape) = queue.pop_front() {
                    candidates[count] = shape;
                    count += 1;
                }
            }
            let next = self.legs.get(self.offered + 1).or(self.pending.as_ref());
            if leg.stop {
                count = 0;
            }
            if self.stops_allowed || leg.stop {
                candidates[count] = TurnShape::STOP;
                count += 1;
            }
            let safe = count;
            if let (Some(selection), Some(next)) = (self.selections.first(), next)
                && !(leg.stop || self.overlapping.is_empty())
            {
                let corner = corner_between(leg, next, corner_tolerance(leg, next));
                let reach = 4.0 * corner.tolerance.length() / corner.half_turn_sine();
                if reach > OVERLAPPING_REACH * leg.length.min(next.length)
                    && let Some(shape) = selection.unscaled(&corner)
                {
                    let reach = shape.entry.distance.max(shape.exit.distance);
                    let filling = (leg.length.min(next.length) / reach).cbrt();
                    for share in self.overlapping {
                        candidates[count] = shape.scaled((share * filling).min(1.0));
                        count += 1;
                    }
                }
            }
            let link = link_of(leg);
            let last = self.last_offered.as_ref();
            self.lattice.push(
                &link,
                &candidates[..safe],
                &candidates[safe..count],
                |from, to| {
                    let between = Between {
                        before: last?,
                        leg,
                        after: next?,
                    };
                    between.duration(from, to, &self.limits)
                },
            );
            self.last_offered = Some(*leg);
            self.offered += 1;
        }
    }

    /// Unrolls what is left of the corner before the next leg, and the leg.
    fn unroll(&mut self, to: &Choice) {
        let Some(leg) = self.legs.pop_front() else {
            return;
        };
        self.offered -= 1;
        let pieces = &mut self.pieces;
        let from = self.from;
        let part = match (from.overlap, to.overlap) {
            (None, None) => Some(Part::Whole),
            (None, Some(_)) => Some(Part::FirstHalf),
            (Some(_), None) => Some(Part::SecondHalf),
            (Some(_), Some(_)) => None,
        };
        if let (Some(last), Some(part)) = (&self.last, part) {
            let corner = corner_between(last, &leg, corner_tolerance(last, &leg));
            unroll_corner(&from.shape, part, corner, last, &leg, |piece| {
                pieces.push_back(piece);
            });
        }
        let next = self.legs.front().or(self.pending.as_ref());
        match (to.overlap, &self.last, next) {
            (Some(duration), Some(before), Some(after)) => {
                let between = Between {
                    before,
                    leg: &leg,
                    after,
                };
                between.pieces(&from.shape, &to.shape, duration, |piece| {
                    pieces.push_back(piece);
                });
            }
            _ => {
                let until = if next.is_none() {
                    self.until
                } else {
                    f64::INFINITY
                };
                unroll_leg(&leg, &from.shape, &to.shape, until, |piece| {
                    pieces.push_back(piece);
                });
            }
        }
        if let Some(pause) = leg.dwell {
            pieces.push_back(pause.piece(leg.end));
        }
        self.last = Some(leg);
        self.from = *to;
    }
}

/// Share of the shorter move beside a corner that the full corner must reach over, lest it is not
/// tried overlapping.
const OVERLAPPING_REACH: f64 = 0.0;

/// Shortest window: two corners, so that one can be seen from the other.
const SHORTEST_WINDOW: usize = 2;

/// Fewest corners among whose motions the fastest way is sought.
const FEWEST_WAYS: usize = 16;

/// How a path begins.
const AT_REST: Choice = Choice {
    shape: TurnShape::STOP,
    overlap: None,
};

/// Scales of the uninterrupted corner that are tried overlapping, as shares of the scale at which it
/// reaches over the whole of the shorter move beside it.
fn overlapping_of(method: Method) -> &'static [f64] {
    match method {
        Method::Kcs => &[1.3],
        Method::KcsGlobal => &[1.2, 1.1, 1.0, 0.9, 0.8, 0.7, 0.6],
        _ => &[],
    }
}

/// Share of the tolerance that merging may use.
fn share_of(method: Method) -> f64 {
    match method {
        Method::KcsLocal | Method::KcsGlobal => ROUNDING_SHARE,
        _ => MERGE_SHARE,
    }
}

fn link_of<const N: usize>(leg: &Leg<N>) -> Link {
    Link {
        length: leg.length,
        limits: leg.limits,
    }
}

/// The tolerance of the corner between two legs: what merging has left of both.
fn corner_tolerance<const N: usize>(leg: &Leg<N>, next: &Leg<N>) -> Tolerance {
    leg.room().min(next.room())
}
