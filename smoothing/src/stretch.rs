//! Which stretches of a path are travelled with superposed corners.
//!
//! Source: ours. The path is cut where it turns sharply or must stop; each stretch between is planned
//! corner by corner, with superposed corners, and, where it has arcs, move by move, each from rest to
//! rest, and the fastest counts. Not here: the plans.

use crate::corners::Corners;
use crate::leg::{Dwell, Leg};
use crate::merge::{Merger, Vertex};
use crate::method::Settings;
use crate::superposed::{MOST_LEGS, Superposer};
use std::collections::VecDeque;
use toolglide_kinematics::{Piece, Tangential, Vector};
use toolglide_profiles::Rise;

/// Share of the tolerance that cleaning the path may use: enough for rounding of programs and for the
/// chords of arcs, and little enough that the curve stays fine.
pub(crate) const FINE_SHARE: f64 = 0.05;

/// Sine of half the turn angle from which a corner is sharp: a turn of 25 degrees.
const SHARP: f64 = 0.216;

/// Share of the velocity of a leg at which superposed corners are entered on it.
const ENTERING: f64 = 0.995;

/// A stretch is planned without waiting for more of the path when it has so many legs and is longer than
/// so many stops.
const LEGS_AHEAD: usize = 512;
const STOPS_AHEAD: f64 = 8.0;

/// Fewest legs of a stretch worth trying.
const FEWEST_LEGS: usize = 4;

/// How much faster than the plan by corners a stretch at the feedrate would have to be.
const WORTH_TRYING: f64 = 0.97;

/// Plans stretch by stretch.
#[derive(Clone, Debug)]
pub(crate) struct Stretches<const N: usize> {
    merger: Merger<N>,
    legs: Vec<Leg<N>>,
    corners: Corners<N>,
    trial: Corners<N>,
    superposer: Superposer<N>,
    /// Legs, the first ones, over which the motion under way with superposed corners has been planned
    /// already: it goes on from there if it can.
    planned: usize,
    /// Length of the legs that have not been planned, each as a share of what a stop takes on it.
    ahead: f64,
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
    Leg(Leg<N>),
    Rest,
    Dwell(Dwell<N>),
    Close,
}

impl<const N: usize> Stretches<N> {
    pub(crate) fn new(start: Vector<N>, settings: &Settings<N>) -> Self {
        Self {
            merger: Merger::new(start, settings.limits, FINE_SHARE),
            legs: Vec::with_capacity(MOST_LEGS),
            corners: Corners::new(start, settings, MOST_LEGS),
            trial: Corners::new(start, settings, MOST_LEGS),
            superposer: Superposer::new(settings.limits),
            planned: 0,
            ahead: 0.0,
            reopen: false,
            end: start,
            events: VecDeque::with_capacity(2 * MOST_LEGS + 8),
        }
    }

    /// Takes the next vertex.
    pub(crate) fn push(&mut self, vertex: Vertex<N>) {
        if let Some(leg) = self.merger.push(vertex) {
            self.take(Event::Leg(leg));
        }
    }

    /// The motion must rest where the path has come to.
    pub(crate) fn rest(&mut self) {
        if let Some(leg) = self.merger.flush() {
            self.take(Event::Leg(leg));
        }
        self.take(Event::Rest);
    }

    /// The motion must pause where the path has come to.
    pub(crate) fn dwell(&mut self, pause: Dwell<N>) {
        self.rest();
        let pause = match self.merger.take_carried() {
            Some(carried) => carried.then(pause),
            None => pause,
        };
        self.take(Event::Dwell(pause));
    }

    /// The path ends.
    pub(crate) fn close(&mut self) {
        self.rest();
        if let Some(carried) = self.merger.take_carried() {
            self.take(Event::Dwell(carried));
        }
        self.take(Event::Close);
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
                Event::Leg(leg) => self.take_leg(leg),
                Event::Rest if self.legs.is_empty() => self.corners.rest(),
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

    fn take_leg(&mut self, leg: Leg<N>) {
        if let Some(last) = self.legs.last()
            && self.legs.len() > self.planned
        {
            let half_sine = 0.5 * (leg.direction - last.direction).norm();
            let cause = if half_sine > SHARP {
                Some(Cause::Sharp)
            } else if self.legs.len() >= MOST_LEGS || self.is_long() {
                Some(Cause::Full)
            } else {
                None
            };
            if let Some(cause) = cause {
                self.events.push_front(Event::Leg(leg));
                self.settle(cause);
                return;
            }
        }
        self.ahead += stops_within(&leg);
        self.legs.push(leg);
    }

    /// Whether the legs that have not been planned reach so far that what follows matters little.
    fn is_long(&self) -> bool {
        self.legs.len() >= self.planned + LEGS_AHEAD && self.ahead > STOPS_AHEAD
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

    /// Plans a stretch from rest.
    fn set_out(&mut self, legs: &mut Vec<Leg<N>>, cause: Cause) {
        match self.choose(legs) {
            Choice::Corners => {
                for leg in legs.iter() {
                    self.corners.push(vertex_of(leg));
                }
                legs.clear();
            }
            Choice::Superposed => {
                if !(self.corners.is_under_way() && self.enter(legs)) {
                    self.corners.close();
                }
                if !legs.is_empty() {
                    self.travel(legs, cause);
                }
            }
            Choice::Apart => {
                let mut next: Option<&Leg<N>> = None;
                for leg in legs.iter().rev() {
                    if next.is_some_and(|next| begins_a_move(leg, next)) {
                        self.events.push_front(Event::Rest);
                    }
                    self.events.push_front(Event::Leg(*leg));
                    next = Some(leg);
                }
                legs.clear();
            }
        }
    }

    /// Plans a stretch that has been planned from rest so that it is entered at speed, on its first leg;
    /// `false` when that is not possible or not faster.
    fn enter(&mut self, legs: &mut Vec<Leg<N>>) -> bool {
        let [first, second, ..] = legs[..] else {
            return false;
        };
        if !begins_a_move(&first, &second) {
            return false;
        }
        let speed = ENTERING * first.limits.velocity;
        let Tangential {
            acceleration, jerk, ..
        } = first.limits;
        // The corner before it ends within its reach, and from whatever speed the rise is no longer.
        let least = (0.5 * acceleration * acceleration / jerk).min(speed);
        let distance = 0.5 * (speed + least) * (speed + least) / acceleration
            + 4.0 * first.tolerance.length() / SHARP;
        let rise = Rise::to_peak(0.0, 0.0, speed, acceleration, jerk);
        let before = rise.duration() + (distance - rise.distance) / speed;
        let most = self.superposer.planned() - before;
        if self
            .superposer
            .plan_entering(legs, distance, speed, most)
            .is_none()
        {
            return false;
        }
        self.corners.push(Vertex {
            feedrate: speed,
            ..vertex_of(&first)
        });
        self.corners.close();
        if !self.corners.end_cruising(&first.start, distance, speed) {
            // The motion rests at the end of the first leg.
            for leg in legs.drain(1..).rev() {
                self.events.push_front(Event::Leg(leg));
            }
            self.end = first.end;
            legs.clear();
            self.superposer.discard();
            self.reopen = true;
        }
        true
    }

    /// Plans a stretch from where the motion under way may still go on, or else brings that to rest where
    /// it was planned to.
    fn go_on(&mut self, legs: &mut Vec<Leg<N>>, cause: Cause) {
        let fresh = &legs[self.planned..];
        let apart = match cause {
            _ if fresh.is_empty() => None,
            // Where the stretch is not cut only for its length, corners, which have not to rest at its ends,
            // may be faster.
            Cause::Full => Some(self.by_corners(fresh)),
            _ => match self.choose(fresh) {
                Choice::Superposed => Some(self.superposer.planned()),
                _ => None,
            },
        };
        let most = apart.map(|apart| self.superposer.remaining() + apart);
        if most.is_some_and(|most| self.superposer.plan_onward(legs, most).is_some()) {
            self.travel(legs, cause);
            return;
        }
        let is_last = fresh.is_empty();
        for leg in legs.drain(self.planned..).rev() {
            self.events.push_front(Event::Leg(leg));
        }
        self.planned = 0;
        if let Some(last) = legs.pop() {
            self.end = last.end;
            legs.clear();
            if !is_last
                && apart.is_none()
                && let Some((point, speed)) = self.superposer.leave()
            {
                let rest = Leg {
                    start: point,
                    length: (last.end - point).norm(),
                    ..last
                };
                self.corners.restart_moving(rest, speed);
                return;
            }
        }
        self.superposer.finish();
    }

    /// Travels what has been planned with superposed corners.
    fn travel(&mut self, legs: &mut Vec<Leg<N>>, cause: Cause) {
        if let Some(last) = legs.last() {
            self.end = last.end;
        }
        let passed = if cause == Cause::Rest {
            self.superposer.travel();
            None
        } else {
            self.superposer.travel_openly()
        };
        match passed {
            Some(passed) if legs.len() - passed <= MOST_LEGS / 2 => {
                legs.drain(..passed);
                self.planned = legs.len();
            }
            _ => {
                self.superposer.finish();
                legs.clear();
                self.planned = 0;
            }
        }
    }

    /// How a stretch is travelled fastest from rest to rest. With superposed corners it is planned when
    /// that is chosen.
    fn choose(&mut self, legs: &[Leg<N>]) -> Choice {
        if legs.len() < FEWEST_LEGS {
            return Choice::Corners;
        }
        let by_corners = self.by_corners(legs);
        let mut best = by_corners;
        // Stops are among the choices at every corner, but not inside an arc, which begins and ends
        // afresh where the motion stops beside it.
        let has_arc = legs
            .windows(2)
            .any(|pair| pair[0].serves.first == pair[1].serves.last);
        let several = legs
            .windows(2)
            .any(|pair| begins_a_move(&pair[0], &pair[1]));
        let mut choice = Choice::Corners;
        if has_arc && several {
            let apart: f64 = legs
                .chunk_by(|leg, next| !begins_a_move(leg, next))
                .map(|group| self.alone(group))
                .sum();
            if apart < best {
                best = apart;
                choice = Choice::Apart;
            }
        }
        // Last, so that this is what has been planned.
        if self.superpose(legs, &Ideal::of(legs), best).is_some() {
            choice = Choice::Superposed;
        }
        choice
    }

    /// Duration of a stretch by itself.
    fn alone(&mut self, legs: &[Leg<N>]) -> f64 {
        let by_corners = self.by_corners(legs);
        if legs.len() < FEWEST_LEGS {
            return by_corners;
        }
        self.superpose(legs, &Ideal::of(legs), by_corners)
            .unwrap_or(by_corners)
    }

    /// Plans a stretch with superposed corners; its duration, when that is worth while and less than
    /// `most`.
    fn superpose(&mut self, legs: &[Leg<N>], ideal: &Ideal, most: f64) -> Option<f64> {
        if ideal.at_feedrate + ideal.stop > WORTH_TRYING * most {
            return None;
        }
        self.superposer.plan(legs, ideal.at_feedrate, most)
    }

    /// Duration of a stretch planned corner by corner from rest to rest.
    fn by_corners(&mut self, legs: &[Leg<N>]) -> f64 {
        let Some(first) = legs.first() else {
            return 0.0;
        };
        self.trial.restart(first.start);
        let mut duration = 0.0;
        for leg in legs {
            self.trial.push(vertex_of(leg));
            while let Some(piece) = self.trial.pull() {
                duration += piece.duration();
            }
        }
        self.trial.close();
        while let Some(piece) = self.trial.pull() {
            duration += piece.duration();
        }
        duration
    }
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

/// How a stretch is travelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    /// Corner by corner.
    Corners,
    /// With superposed corners.
    Superposed,
    /// Each move by itself, from rest to rest.
    Apart,
}

/// What a stretch would take without corners.
struct Ideal {
    /// The whole way at the feedrate.
    at_feedrate: f64,
    /// Starting at one end and stopping at the other.
    stop: f64,
}

impl Ideal {
    fn of<const N: usize>(legs: &[Leg<N>]) -> Self {
        let at_feedrate = legs
            .iter()
            .map(|leg| leg.length / leg.limits.velocity)
            .sum();
        let length: f64 = legs.iter().map(|leg| leg.length).sum();
        let ends = [legs.first(), legs.last()];
        // Half of a start or a stop is lost against passing at speed.
        let stop = ends
            .iter()
            .flatten()
            .map(|leg| {
                0.5 * leg
                    .limits
                    .time_to_change(leg.limits.reachable_within(length))
            })
            .sum();
        Self { at_feedrate, stop }
    }
}

/// Length of a leg as a share of what a stop takes.
fn stops_within<const N: usize>(leg: &Leg<N>) -> f64 {
    let speed = leg.limits.velocity;
    leg.length / (0.5 * speed * leg.limits.time_to_change(speed))
}

/// Whether a move of the path begins with `next`.
fn begins_a_move<const N: usize>(leg: &Leg<N>, next: &Leg<N>) -> bool {
    leg.serves.last < next.serves.first
}

fn vertex_of<const N: usize>(leg: &Leg<N>) -> Vertex<N> {
    Vertex {
        point: leg.end,
        bulge: leg.deviation,
        feedrate: leg.feedrate,
        tolerance: leg.tolerance,
        serves: leg.serves,
    }
}
