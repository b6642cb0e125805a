//! Which stretches of a path are travelled with superposed corners.
//!
//! Source: ours. The path is cut where it turns sharply or must stop; each stretch between is planned
//! corner by corner and with superposed corners, both from rest to rest, and the faster counts, less
//! what resting at its ends costs against turning there. Not here: either plan.

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

/// Share of the time to stop and start that turning a sharp corner saves against resting at it.
const SAVED_BY_TURNING: f64 = 0.25;

/// How much faster than the plan by corners a stretch at the feedrate would have to be.
const WORTH_TRYING: f64 = 0.97;

/// Plans stretch by stretch.
#[derive(Clone, Debug)]
pub(crate) struct Stretches<const N: usize> {
    merger: Merger<N>,
    legs: Vec<Leg<N>>,
    /// Whether the motion rests where the stretch begins, whatever is chosen.
    from_rest: bool,
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
            from_rest: true,
            corners: Corners::new(start, settings, MOST_LEGS),
            trial: Corners::new(start, settings, MOST_LEGS),
            superposer: Superposer::new(settings.limits),
            end: start,
            events: VecDeque::with_capacity(8),
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
                    self.settle(true);
                    self.events.push_front(Event::Rest);
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
                self.settle(false);
                if !self.superposer.is_done() {
                    self.events.push_front(Event::Leg(leg));
                    return;
                }
            }
        }
        self.legs.push(leg);
    }

    /// Plans the stretch that has been collected.
    fn settle(&mut self, to_rest: bool) {
        let from_rest = self.from_rest;
        self.from_rest = to_rest;
        let Some(last) = self.legs.last() else {
            return;
        };
        let end = last.end;
        if self.legs.len() >= FEWEST_LEGS && self.superpose(from_rest, to_rest) {
            self.corners.close();
            self.end = end;
            self.from_rest = true;
        } else {
            for leg in &self.legs {
                self.corners.push(vertex_of(leg));
            }
        }
        self.legs.clear();
    }

    /// Plans the stretch with superposed corners where that is faster.
    fn superpose(&mut self, from_rest: bool, to_rest: bool) -> bool {
        let (mut at_feedrate, mut slowest) = (0.0, 0.0_f64);
        for leg in &self.legs {
            at_feedrate += leg.length / leg.limits.velocity;
            let stop = leg.limits.velocity / leg.limits.acceleration
                + leg.limits.acceleration / leg.limits.jerk;
            slowest = slowest.max(stop);
        }
        let turned = f64::from(u8::from(!from_rest) + u8::from(!to_rest));
        let penalty = SAVED_BY_TURNING * slowest * turned;
        let by_corners = self.by_corners();
        let most = WORTH_TRYING * by_corners - penalty;
        if at_feedrate + slowest > most {
            return false;
        }
        self.superposer
            .plan(&self.legs, at_feedrate, by_corners - penalty)
            .is_some()
    }

    /// Duration of the stretch planned corner by corner from rest to rest.
    fn by_corners(&mut self) -> f64 {
        let Some(first) = self.legs.first() else {
            return 0.0;
        };
        self.trial.restart(first.start);
        let mut duration = 0.0;
        for leg in &self.legs {
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

fn vertex_of<const N: usize>(leg: &Leg<N>) -> Vertex<N> {
    Vertex {
        point: leg.end,
        bulge: leg.deviation,
        feedrate: leg.feedrate,
        tolerance: leg.tolerance,
        serves: leg.serves,
    }
}
