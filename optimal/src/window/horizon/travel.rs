//! Hands out motion: the plan of a window, the middle of a long move, a line from rest to rest.
//!
//! Source: ours. What is handed out earns what the windows behind it may cost. Not here: when that is, see
//! [`horizon`](super).

use crate::path::spans::{Cruise, steps};
use crate::window::horizon::Horizon;
use crate::window::output::{Event, Joint};
use crate::window::straight_line;
use crate::window::straight_line::Line;
use crate::window::swings::Swings;
use crate::window::{EndState, WindowSolver};
use toolglide_kinematics::{MoveRange, Piece, Sample};

impl<S: WindowSolver<N>, const N: usize> Horizon<S, N> {
    /// The last span leads to the middle of a long move, on which motion needs no planning.
    pub(crate) fn cruise(&mut self, cruise: &Cruise<N>) {
        let Cruise {
            direction, speed, ..
        } = *cruise;
        let at = |position| EndState {
            velocity: direction * speed,
            ..EndState::rest(position)
        };
        self.close(at(cruise.start));
        if self.swings.is_empty() {
            // Where no window led to it, the motion rests here.
            let entry = if self.moves() { speed } else { 0.0 };
            let line = Line::middle(cruise, cruise.limits);
            if !line.travel([entry, speed], |piece| self.pass(&piece, cruise)) {
                self.events.push_back(Event::Lost);
            }
        } else if !self.cruise_silently(cruise) {
            self.start = EndState::rest(cruise.end);
            return;
        }
        self.start = at(cruise.end);
    }

    /// Keeps the speed of the middle of a long move, or travels it from rest to rest; whether it ends moving.
    fn cruise_silently(&mut self, cruise: &Cruise<N>) -> bool {
        // A gain of speed would set modes swinging.
        let speed = cruise.speed;
        let mut limits = cruise.limits;
        limits.velocity = speed;
        let line = Line::middle(cruise, limits);
        if self.moves() && line.travel([speed, speed], |piece| self.pass(&piece, cruise)) {
            return true;
        }
        if !self.travel_silently(&line, [0.0, 0.0]) {
            self.events.push_back(Event::Lost);
        }
        false
    }

    /// Travels a line so that modes of vibration come to rest; whether it is long enough.
    fn travel_silently(&mut self, line: &Line<N>, speeds: [f64; 2]) -> bool {
        self.shaper.fit(&self.swings.modes, &line.direction);
        let (events, swings) = (&mut self.events, &mut self.swings);
        line.travel_shaped(speeds, &mut self.shaper, |piece| {
            follow(swings, &piece);
            events.push_back(Event::Piece(piece));
        })
    }

    fn travel_in_least_time(&mut self, line: &Line<N>, speeds: [f64; 2]) -> bool {
        let (events, swings) = (&mut self.events, &mut self.swings);
        line.travel(speeds, |piece| {
            follow(swings, &piece);
            events.push_back(Event::Piece(piece));
        })
    }

    /// Hands out a piece of the middle of a long move, with a joint where that is at the feedrate.
    fn pass(&mut self, piece: &Piece<N>, cruise: &Cruise<N>) {
        self.credit.earn(piece.duration());
        let start = piece.at(0.0);
        let steady = start.acceleration.norm_squared() <= 0.0 && start.jerk.norm_squared() <= 0.0;
        let MoveRange { first, last } = cruise.serves;
        if !steady || first != last {
            self.events.push_back(Event::Piece(*piece));
            return;
        }
        let half = 0.5 * piece.duration();
        let joint = Joint {
            index: first,
            position: piece.position_at(half),
            velocity: start.velocity,
        };
        let rest = Sample {
            position: joint.position,
            ..start
        };
        let halves = [
            Piece::new(&start, half, joint.position, cruise.serves),
            Piece::new(&rest, half, piece.end(), cruise.serves),
        ];
        self.events.push_back(Event::Piece(halves[0]));
        self.events.push_back(Event::Joint(joint));
        self.events.push_back(Event::Piece(halves[1]));
    }

    /// Hands out the plan of the first `count` spans.
    pub(super) fn commit(&mut self, count: usize) {
        let mut node = 0;
        self.leave_behind(count);
        for (span, duration) in self.spans.drain(..count).zip(&self.current.durations) {
            self.credit.earn(*duration);
            let interval = duration / steps(span.steps);
            for _ in 0..span.steps {
                let state = &self.current.states[node];
                let jerk = &self.current.jerks[node];
                self.swings.pass(&state.acceleration, jerk, interval);
                let start = Sample {
                    position: state.position,
                    velocity: state.velocity,
                    acceleration: state.acceleration,
                    jerk: self.current.jerks[node],
                };
                node += 1;
                let end = self.current.states[node].position;
                let piece = Piece::new(&start, interval, end, span.serves);
                self.events.push_back(Event::Piece(piece));
            }
        }
        self.start = self.current.states[node];
        self.planned -= count;
        self.current.durations.drain(..count);
        self.expected.drain(..count);
        self.current.states.drain(..node);
        self.current.jerks.drain(..node);
        if self.planned == 0 {
            self.current.states.clear();
        }
    }

    /// Travels the next straight line to its end: to the goal if that is there, else to a stop.
    pub(super) fn travel_a_line(&mut self) {
        let count = straight_line::on_one_line(self.spans.iter());
        let (Some(first), Some(last)) = (self.spans.front(), self.spans.get(count - 1)) else {
            return;
        };
        let line = Line::of(first, last);
        let entry = self.start.velocity.norm();
        let goal = self.end(count);
        let exit = goal.velocity.norm();
        let stop = EndState::rest(line.end);
        let silent = !self.swings.is_empty();
        let end = if silent && self.travel_silently(&line, [entry, exit]) {
            goal
        } else if silent && self.travel_silently(&line, [entry, 0.0]) {
            stop
        } else if self.travel_in_least_time(&line, [entry, exit]) {
            goal
        } else {
            if !self.travel_in_least_time(&line, [entry, 0.0]) {
                self.events.push_back(Event::Lost);
            }
            stop
        };
        self.start = end;
        self.leave_behind(count);
        for span in self.spans.drain(..count) {
            // Others would not stop here.
            self.credit.earn(span.length / span.limits.velocity);
        }
        self.expected.clear();
    }
}

fn follow<const N: usize>(swings: &mut Swings, piece: &Piece<N>) {
    let start = piece.at(0.0);
    swings.pass(&start.acceleration, &start.jerk, piece.duration());
}
