//! Joins stretches: at rest, or at speed where that is faster.
//!
//! Source: ours. What is handed out can always be brought to rest in no more time than full stops at all
//! moves so far would have taken: a stretch goes on corner by corner only where the end of the
//! known path is reached at rest sooner that way than by a rest before it. Not here: plans from rest to
//! rest.

use super::choose::{Choice, Material, has_arc, least_alone};
use super::{Cause, Event, MAX_LEGS, SHARP, Stretches};
use crate::segment::Segment;
use crate::segment_merger::vertex_of;
use toolglide_kinematics::PathLimits;
use toolglide_kinematics::numeric::LENGTH_SLACK;
use toolglide_profiles::SpeedRamp;

/// Share of the velocity of a leg at which superposed corners are entered on it.
const ENTERING: f64 = 0.995;

/// Length of the time steps with which they begin there, as a share of the time in which the jerk gives the speed.
const STEPS_IN: f64 = 2.0;

/// Where superposed corners are entered on the first leg of a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Entry {
    distance: f64,
    speed: f64,
}

/// Speed at which superposed corners are entered on a leg, the rise from rest to it, and the distance from which
/// that is possible.
fn entering_on<const N: usize>(first: &Segment<N>) -> (f64, SpeedRamp, f64) {
    let speed = ENTERING * first.limits.velocity;
    let PathLimits {
        acceleration, jerk, ..
    } = first.limits;
    // The corner before it ends within its reach, and from whatever speed the rise is no longer.
    let least = (0.5 * acceleration * acceleration / jerk).min(speed);
    let rise = SpeedRamp::to_peak(0.0, 0.0, speed, acceleration, jerk);
    let distance = (0.5 * (speed + least) * (speed + least) / acceleration
        + 4.0 * first.tolerance.length() / SHARP)
        .max(rise.distance * (1.0 + LENGTH_SLACK));
    (speed, rise, distance)
}

/// Length of a leg on which superposed corners are entered.
pub(super) fn way_in<const N: usize>(first: &Segment<N>) -> f64 {
    let (speed, _, distance) = entering_on(first);
    distance + STEPS_IN * speed * (speed / first.limits.jerk).sqrt()
}

impl<const N: usize> Stretches<N> {
    /// Plans a stretch where the motion is at rest, or is turning corners.
    pub(super) fn set_out(&mut self, legs: &mut Vec<Segment<N>>, cause: Cause) {
        match self.decide(legs) {
            Choice::Corners(material) => {
                self.watched |= has_arc(legs);
                self.turn(legs, material);
                self.pass(legs);
            }
            Choice::Superposed(entry) => {
                match entry {
                    Some(entry) => self.corners.close_cruising(
                        std::iter::once(vertex_of(&legs[0])),
                        entry.distance,
                        entry.speed,
                    ),
                    None => self.corners.close(),
                }
                self.travel(legs, cause);
            }
            Choice::Afresh => {
                // In the middle of a leg nothing rests.
                let lead = usize::from(self.corners.is_cruising()).min(legs.len());
                self.turn(&legs[..lead], Material::Vertices);
                if let Some(last) = legs[..lead].last() {
                    self.end = last.end;
                }
                self.come_to_rest();
                self.put_back(legs, lead);
                legs.clear();
            }
            Choice::Apart => {
                self.come_to_rest();
                self.put_back_apart(legs);
            }
        }
    }

    /// The legs are behind the motion that has been planned.
    fn pass(&mut self, legs: &mut Vec<Segment<N>>) {
        if let Some(last) = legs.last() {
            self.end = last.end;
        }
        legs.clear();
    }

    /// Brings corners under way to rest; what follows begins again there.
    pub(super) fn come_to_rest(&mut self) {
        if self.corners.has_begun() {
            self.corners.close();
            self.reopen = true;
        }
    }

    /// Puts the legs from an index on back before everything that waits.
    pub(super) fn put_back(&mut self, legs: &mut Vec<Segment<N>>, from: usize) {
        for leg in legs.drain(from..).rev() {
            self.events.push_front(Event::Segment(leg));
        }
    }

    /// Puts all legs back, with a rest between moves.
    fn put_back_apart(&mut self, legs: &mut Vec<Segment<N>>) {
        let mut next: Option<Segment<N>> = None;
        for leg in legs.drain(..).rev() {
            if next.is_some_and(|next| leg.ends_before(&next)) {
                self.events.push_front(Event::Rest);
            }
            self.events.push_front(Event::Segment(leg));
            next = Some(leg);
        }
    }

    /// Plans a stretch that has been planned from rest so that it is entered at speed, on its first leg;
    /// how, and how long all takes from when the corners under way began, when that is possible and
    /// faster.
    pub(super) fn plan_entering(&mut self, legs: &[Segment<N>]) -> Option<(Entry, f64)> {
        let first = legs.first()?;
        if first.bend.is_some() {
            return None;
        }
        let (speed, rise, distance) = entering_on(first);
        let before = rise.duration() + (distance - rise.distance) / speed;
        // Where the motion cruises already there is no rest to be compared with.
        let most = if self.corners.is_cruising() {
            self.superposer.planned()
        } else {
            self.superposer.planned() - before
        };
        self.trial.follow(&self.corners);
        self.trial
            .close_cruising(std::iter::once(vertex_of(&legs[0])), distance, speed);
        let until = self.trial.duration();
        if until.is_infinite() {
            // Corners of one kind may leave too little of the leg.
            return None;
        }
        let duration = self.superposer.plan_entering(legs, distance, speed, most)?;
        Some((Entry { distance, speed }, until + duration))
    }

    /// Plans a stretch from where the motion under way may still go on, or else brings that to rest where
    /// it was planned to.
    pub(super) fn go_on(&mut self, legs: &mut Vec<Segment<N>>, cause: Cause) {
        let fresh = &legs[self.planned..];
        // Nothing from rest to rest takes less.
        let sure = self.superposer.remaining() + least_alone(fresh);
        if has_arc(fresh) && self.superposer.plan_onward(legs, sure).is_some() {
            self.travel(legs, cause);
            return;
        }
        let apart = match cause {
            _ if fresh.is_empty() => None,
            // Arcs by themselves may be superposed where all moves stop; of lines, stops are among corners.
            Cause::Full if has_arc(fresh) => Some(self.choose(fresh).1),
            Cause::Full => Some(self.by_corners(fresh).0),
            // Where the stretch is not cut only for its length, corners, which have not to rest at its ends,
            // may be faster.
            _ => match self.choose(fresh) {
                (Choice::Superposed(_), least) => Some(least),
                _ => None,
            },
        };
        let most = apart.map(|apart| self.superposer.remaining() + apart);
        if most.is_some_and(|most| self.superposer.plan_onward(legs, most).is_some()) {
            self.travel(legs, cause);
            return;
        }
        let is_last = fresh.is_empty();
        self.put_back(legs, self.planned);
        self.planned = 0;
        if let Some(last) = legs.pop() {
            self.end = last.end;
            legs.clear();
            if !is_last
                && last.bend.is_none()
                && apart.is_none()
                && let Some((point, speed)) = self.superposer.leave()
            {
                let rest = Segment {
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
    fn travel(&mut self, legs: &mut Vec<Segment<N>>, cause: Cause) {
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
            Some(passed) if legs.len() - passed <= MAX_LEGS / 2 => {
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
}
