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
use toolglide_kinematics::{Piece, Vector};

/// Share of the tolerance that cleaning the path may use: enough for rounding of programs and for the
/// chords of arcs, and little enough that the curve stays fine.
pub(crate) const FINE_SHARE: f64 = 0.05;

/// Sine of half the turn angle from which a corner is sharp: a turn of 25 degrees.
const SHARP: f64 = 0.216;

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
    /// Where the stretch under way with superposed corners ends.
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
        if let Some(piece) = self.corners.pull() {
            return Some(piece);
        }
        // The corners before a stretch have been closed, and begin again at rest after it.
        let piece = self.superposer.pull()?;
        if self.superposer.is_done() {
            self.corners.restart(self.end);
            self.work();
        }
        Some(piece)
    }

    fn take(&mut self, event: Event<N>) {
        self.events.push_back(event);
        self.work();
    }

    /// Works off what has come, up to the next stretch with superposed corners.
    fn work(&mut self) {
        while self.superposer.is_done()
            && let Some(event) = self.events.pop_front()
        {
            match event {
                Event::Leg(leg) => self.take_leg(leg),
                Event::Rest if self.legs.is_empty() => self.corners.rest(),
                Event::Rest => {
                    // After whatever the stretch may put before it.
                    self.events.push_front(Event::Rest);
                    self.settle();
                }
                Event::Dwell(pause) => self.corners.dwell(pause),
                Event::Close => self.corners.close(),
            }
        }
    }

    fn take_leg(&mut self, leg: Leg<N>) {
        if let Some(last) = self.legs.last() {
            let half_sine = 0.5 * (leg.direction - last.direction).norm();
            if half_sine > SHARP || self.legs.len() >= MOST_LEGS {
                self.events.push_front(Event::Leg(leg));
                self.settle();
                return;
            }
        }
        self.legs.push(leg);
    }

    /// Plans the stretch that has been collected.
    fn settle(&mut self) {
        let legs = std::mem::take(&mut self.legs);
        if let Some(last) = legs.last() {
            let choice = if legs.len() < FEWEST_LEGS {
                Choice::Corners
            } else {
                self.choose(&legs)
            };
            if choice != Choice::Superposed {
                self.superposer.discard();
            }
            match choice {
                Choice::Corners => {
                    for leg in &legs {
                        self.corners.push(vertex_of(leg));
                    }
                }
                Choice::Superposed => {
                    self.corners.close();
                    self.end = last.end;
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
                }
            }
        }
        self.legs = legs;
        self.legs.clear();
    }

    /// How a stretch is travelled fastest. With superposed corners it is planned when that is chosen.
    fn choose(&mut self, legs: &[Leg<N>]) -> Choice {
        let ideal = Ideal::of(legs);
        let by_corners = self.by_corners(legs);
        let superposed = self.superpose(legs, &ideal, by_corners);
        let best = superposed.unwrap_or(by_corners);
        // Stops are among the choices at every corner, but not inside an arc, which begins and ends
        // afresh where the motion stops beside it.
        let has_arc = legs
            .windows(2)
            .any(|pair| pair[0].serves.first == pair[1].serves.last);
        let several =
            legs.first().map(|leg| leg.serves.first) != legs.last().map(|leg| leg.serves.last);
        if has_arc && several {
            let apart: f64 = legs
                .chunk_by(|leg, next| !begins_a_move(leg, next))
                .map(|group| self.alone(group))
                .sum();
            if apart < best {
                return Choice::Apart;
            }
            if superposed.is_some() {
                // The moves by themselves have taken the place of the plan.
                self.superpose(legs, &ideal, by_corners);
            }
        }
        if superposed.is_some() {
            Choice::Superposed
        } else {
            Choice::Corners
        }
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
