//! Sweeps pulses through a chain of filters into exact pieces of constant jerk.
//!
//! Source: equations 4.1 to 4.7 for any sequence of pulses. Behind two moving averages the jerk is a
//! sum of commanded velocities at four delays, so a knot costs a few additions however many pulses
//! are under way; the closed form of position, velocity and acceleration takes the rounding out
//! every few knots. Not here: when pulses begin.

use crate::filter::cubic::CubicChain;
use crate::filter::taps::{SAME_INSTANT, Taps};
use crate::lookahead::command::{Command, TimedPulse};
use crate::lookahead::queue::Queue;
use alloc::collections::VecDeque;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::{MoveRange, Piece, Sample, Vector};

/// Knots after which the state is computed afresh, without a comb and with one: rounding of so many steps is
/// far below what the judge can see.
const KNOTS_TO_ANCHOR: u32 = 32;
const TEETH_TO_ANCHOR: u32 = 128;

/// Pieces longer than this share of the delay of the chain start from a state computed afresh,
/// because time squared makes the rounding of the acceleration a length.
const LONG_PIECE: f64 = 0.5;

/// The same where so many times the shorter filter, whose jerk makes the rounding of knots an acceleration,
/// would be over since then.
const LONG_BESIDE_SHORT: f64 = 100.0;

/// Time after which the clock is set back by a multiple of it, s: a power of two, so that subtracting
/// it is exact, and short, so that times keep their digits.
const CLOCK_SPAN: f64 = 16.0;

/// A pulse under way.
#[derive(Clone, Copy, Debug)]
struct Active<const N: usize> {
    begin: f64,
    end: f64,
    from: Vector<N>,
    to: Vector<N>,
    velocity: Vector<N>,
    serves: MoveRange,
}

/// The exact motion behind a chain, piece by piece.
#[derive(Clone, Debug)]
pub(crate) struct Sweep<const N: usize> {
    chain: CubicChain,
    commands: VecDeque<Command<N>>,
    taps: Taps<N>,
    active: Queue<Active<N>>,
    /// How many of the active pulses have begun.
    begun: usize,
    /// Where the state was computed afresh last: positions are told from here, so that what many steps add up keeps
    /// the digits of steps, however far from zero they are.
    origin: Vector<N>,
    /// The state, its position from the origin.
    state: Sample<N>,
    time: f64,
    /// End of the last pulse commanded.
    commanded: f64,
    resting: bool,
    since_anchor: u32,
    /// When the state was computed afresh last.
    anchored: f64,
}

impl<const N: usize> Sweep<N> {
    /// At rest at `start`, with room for `capacity` commands.
    pub(crate) fn new(start: Vector<N>, chain: CubicChain, capacity: usize) -> Self {
        let mut sweep = Self {
            taps: Taps::new(&chain, 2 * capacity),
            chain,
            commands: VecDeque::with_capacity(capacity),
            active: Queue::with_capacity(capacity),
            begun: 0,
            origin: start,
            state: Sample::at_rest(Vector::zeros()),
            time: 0.0,
            commanded: 0.0,
            resting: false,
            since_anchor: 0,
            anchored: 0.0,
        };
        sweep.restart(start);
        sweep
    }

    /// Takes what comes next.
    pub(crate) fn push(&mut self, command: Command<N>) {
        self.commands.push_back(command);
    }

    /// The next piece; `None` when more commands are needed.
    pub(crate) fn pull(&mut self) -> Option<Piece<N>> {
        loop {
            let knot = self.taps.next_knot();
            if knot <= self.horizon() {
                if let Some(piece) = self.advance(knot) {
                    return Some(piece);
                }
                continue;
            }
            if self.resting {
                // Every step has arrived at every tap.
                let at = self.here();
                self.restart(at);
                continue;
            }
            let Some(command) = self.commands.pop_front() else {
                // What comes next lies where it was just read, not behind all that ever came.
                self.commands.clear();
                return None;
            };
            match command {
                Command::Pulse(pulse) => self.begin(&pulse),
                Command::Rest => {
                    if self.active.items().is_empty() {
                        continue;
                    }
                    self.resting = true;
                    self.set_back_clock_while_steady();
                    self.taps.push(self.commanded, Vector::zeros());
                }
                Command::Pause { duration, serves } => {
                    let at = self.here();
                    return Some(Piece::new(&Sample::at_rest(at), duration, at, serves));
                }
                Command::Filters { long, short } => {
                    self.chain = CubicChain::of_two(long, short);
                    let at = self.here();
                    self.restart(at);
                }
            }
        }
    }

    /// Until when the command is known.
    fn horizon(&self) -> f64 {
        if self.resting {
            f64::MAX
        } else {
            self.commanded
        }
    }

    fn begin(&mut self, pulse: &TimedPulse<N>) {
        self.set_back_clock_while_steady();
        if pulse.gap > SAME_INSTANT {
            self.taps.push(self.commanded, Vector::zeros());
            self.commanded += pulse.gap;
        }
        let velocity = pulse.velocity;
        let begin = self.commanded;
        self.commanded += pulse.duration;
        self.taps.push(begin, velocity);
        self.active.push(Active {
            begin,
            end: self.commanded,
            from: pulse.from,
            to: pulse.to,
            velocity,
            serves: pulse.serves,
        });
    }

    /// Where the motion is.
    fn here(&self) -> Vector<N> {
        self.origin + self.state.position
    }

    /// Rests at a point, exactly.
    fn rest_at(&mut self, at: Vector<N>) {
        self.origin = at;
        self.state = Sample::at_rest(Vector::zeros());
    }

    /// Begins afresh at rest.
    fn restart(&mut self, at: Vector<N>) {
        self.rest_at(at);
        self.time = 0.0;
        self.commanded = 0.0;
        self.resting = false;
        self.since_anchor = 0;
        self.anchored = 0.0;
        self.begun = 0;
        self.active.clear();
        self.taps.restart(&self.chain);
    }

    /// Goes on to a knot; gives the piece up to it unless it has no length.
    fn advance(&mut self, knot: f64) -> Option<Piece<N>> {
        let duration = knot - self.time;
        if duration <= SAME_INSTANT {
            // What comes a little later comes now, and is told so.
            self.arrive(self.time);
            return None;
        }
        let serves = self.serves();
        let start = Sample {
            position: self.here(),
            ..self.state
        };
        self.time = knot;
        self.state = after(&self.state, duration);
        self.expire();
        self.since_anchor += 1;
        self.arrive(knot);
        let end = self.here();
        self.set_back_clock(self.time);
        Some(Piece::new(&start, duration, end, serves))
    }

    /// Changes the jerk at a knot.
    fn arrive(&mut self, knot: f64) {
        let (jerk, early) = self.taps.arrive(knot);
        self.state.acceleration -= early;
        self.state.jerk = jerk;
        let next = self.taps.next_knot();
        let knots = match self.taps.are_few() {
            true => KNOTS_TO_ANCHOR,
            false => TEETH_TO_ANCHOR,
        };
        let lasts = next.min(self.horizon()) - self.time;
        if self.resting && next.is_infinite() {
            self.land();
        } else if self.since_anchor >= knots
            || lasts > LONG_PIECE * self.chain.total()
            || lasts + self.time - self.anchored > LONG_BESIDE_SHORT * self.chain.short()
        {
            self.anchor();
        }
    }

    /// Rests at the end of the last pulse, exactly.
    fn land(&mut self) {
        if let Some(last) = self.active.items().last() {
            let to = last.to;
            self.rest_at(to);
            self.active.clear();
            self.begun = 0;
        }
    }

    /// The pulses that shape the motion now.
    fn serves(&mut self) -> MoveRange {
        while let Some(next) = self.active.items().get(self.begun)
            && next.begin <= self.time + SAME_INSTANT
        {
            self.begun += 1;
        }
        let none = MoveRange { first: 0, last: 0 };
        let first = self
            .active
            .items()
            .first()
            .map_or(none, |pulse| pulse.serves);
        let last = self
            .active
            .items()
            .get(self.begun.saturating_sub(1))
            .map_or(first, |pulse| pulse.serves);
        MoveRange {
            first: first.first,
            last: last.last,
        }
    }

    /// Drops the pulses whose effect is over; the last one to go leaves its end behind.
    fn expire(&mut self) {
        let total = self.chain.total();
        while let Some(oldest) = self.active.items().first()
            && oldest.end + total <= self.time + SAME_INSTANT
        {
            if self.active.len() == 1 {
                // A gap as long as the chain remembers, or the end.
                let (to, jerk) = (oldest.to, self.state.jerk);
                self.rest_at(to);
                self.state.jerk = jerk;
            }
            self.active.drop_oldest(1);
            self.begun = self.begun.saturating_sub(1);
        }
    }

    /// The state from the closed form.
    fn anchor(&mut self) {
        self.since_anchor = 0;
        self.anchored = self.time;
        let mut position = self
            .active
            .items()
            .first()
            .map_or(self.here(), |oldest| oldest.from);
        let mut velocity = Vector::zeros();
        let mut acceleration = Vector::zeros();
        for pulse in self.active.items() {
            let (since, after) = (self.time - pulse.begin, self.time - pulse.end);
            if since <= 0.0 {
                break;
            }
            let (begun, ended) = (self.response(since), self.response(after));
            position += pulse.velocity * (begun[0] - ended[0]);
            velocity += pulse.velocity * (begun[1] - ended[1]);
            acceleration += pulse.velocity * (begun[2] - ended[2]);
        }
        self.origin = position;
        self.state.position = Vector::zeros();
        self.state.velocity = velocity;
        self.state.acceleration = acceleration;
        self.state.jerk = self.taps.sum();
    }

    /// Position, velocity and acceleration some time after a unit step: exactly those before it and those
    /// after the whole delay where it is nearly one of these, so that nothing is left of the acceleration.
    fn response(&self, since: f64) -> [f64; 3] {
        let total = self.chain.total();
        if since <= SAME_INSTANT {
            return [0.0; 3];
        }
        if since >= total - SAME_INSTANT {
            return [since - 0.5 * total, 1.0, 0.0];
        }
        let (position, velocity) = self.chain.response(since);
        // So is where a ramp of the acceleration begins or ends.
        let (long, short) = (self.chain.long(), self.chain.short());
        let at = |knot: f64| (since - knot).abs() <= SAME_INSTANT;
        let level = self.taps.are_few() && (at(short) || at(long));
        let instant = if level { 0.5 * total } else { since };
        [position, velocity, self.chain.acceleration(instant)]
    }

    /// What comes next must not be told in the digits that are left of the time of a long pulse; while
    /// nothing changes, it does not matter when the last change was.
    fn set_back_clock_while_steady(&mut self) {
        if self.taps.next_knot().is_infinite() {
            self.set_back_clock(self.commanded);
        }
    }

    /// Sets the clock back so that a time is short of a span.
    fn set_back_clock(&mut self, time: f64) {
        if time < CLOCK_SPAN {
            return;
        }
        let span = (time / CLOCK_SPAN).floor() * CLOCK_SPAN;
        self.time -= span;
        self.anchored -= span;
        self.commanded -= span;
        self.taps.set_back(span);
        for pulse in self.active.items_mut() {
            pulse.begin -= span;
            pulse.end -= span;
        }
    }
}

/// The state some time later at constant jerk.
fn after<const N: usize>(start: &Sample<N>, t: f64) -> Sample<N> {
    let &Sample {
        position,
        velocity,
        acceleration,
        jerk,
    } = start;
    Sample {
        position: position + (velocity + (acceleration * 0.5 + jerk * (t / 6.0)) * t) * t,
        velocity: velocity + (acceleration + jerk * (0.5 * t)) * t,
        acceleration: acceleration + jerk * t,
        jerk,
    }
}
