//! Unrolls a corner blend at its corner into pieces, and measures how far it passes from the corner.
//!
//! Source: sections 2.3 and 3.2 in vector form. Both ends are anchored at the corner, so that rounding
//! does not add up along a path.

use crate::blend::{BlendPhase, BlendShape};
use crate::phase::{Phase, integrate};
use crate::profile::State;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::numeric::SEARCH_PRECISION;
use toolglide_kinematics::{Corner, MoveRange, Piece, Sample, Vector};

/// Parts of a blend among which the one that is nearest to the corner is sought.
const PARTS: u32 = 64;

/// Which part of a corner motion is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// All of it.
    Whole,
    /// From its beginning to its middle.
    FirstHalf,
    /// From its middle to its end.
    SecondHalf,
}

impl BlendShape {
    /// Unrolls a part of the blend at a corner, phase by phase; nothing for a full stop.
    ///
    /// `serves` are the moves that the pieces belong to, and `take` is given the pieces in order.
    pub fn unroll<const N: usize>(
        &self,
        corner: &Corner<N>,
        part: Part,
        serves: MoveRange,
        mut take: impl FnMut(Piece<N>),
    ) {
        let duration = self.duration;
        let Some(last) = self.phases().len().checked_sub(1) else {
            return;
        };
        if duration <= 0.0 {
            return;
        }
        let Corner {
            point,
            incoming,
            outgoing,
            ..
        } = *corner;
        let (entry, exit) = (self.entry, self.exit);
        let mut state = Sample {
            position: point - incoming * entry.distance,
            velocity: incoming * entry.speed,
            acceleration: incoming * -entry.acceleration,
            jerk: Vector::zeros(),
        };
        let end = point + outgoing * exit.distance;
        let middle = 0.5 * duration;
        let mut time = 0.0;
        for (index, phase) in self.phases().iter().enumerate() {
            state.jerk = jerk_of(phase, &incoming, &outgoing);
            let phase_end = if index == last {
                duration
            } else {
                time + phase.duration
            };
            let (from, to) = match part {
                Part::Whole => (time, phase_end),
                Part::FirstHalf => (time, phase_end.min(middle)),
                Part::SecondHalf => (time.max(middle), phase_end),
            };
            if to > from {
                let start = after(&state, from - time);
                let next = after(&state, to - time);
                let piece_end = if to >= duration { end } else { next.position };
                take(Piece::new(&start, to - from, piece_end, serves));
            }
            state = after(&state, phase.duration);
            time = phase_end;
        }
    }

    /// Least distance between the blend and the corner itself, mm.
    ///
    /// What is left of the incoming move and what is done of the outgoing one are two lengths `f` and
    /// `g`; the distance is the root of `(g - f)² cos² + (g + f)² sin²` of half the turn angle, which is
    /// exact near straight on and near a reversal.
    #[must_use]
    pub fn corner_error<const N: usize>(&self, corner: &Corner<N>) -> f64 {
        let duration = self.duration;
        if duration <= 0.0 {
            return 0.0;
        }
        let (sine, cosine) = (corner.half_turn_sine(), corner.half_turn_cosine());
        let distance = |time: f64| {
            let (left, done) = self.beside(time);
            ((done - left) * cosine).hypot((done + left) * sine)
        };
        let part = duration / f64::from(PARTS);
        let nearest = (0..=PARTS)
            .map(|index| part * f64::from(index))
            .min_by(|one, other| distance(*one).total_cmp(&distance(*other)))
            .unwrap_or(0.0);
        let mut low = (nearest - part).max(0.0);
        let mut high = (nearest + part).min(duration);
        while high - low > SEARCH_PRECISION * duration {
            let third = (high - low) / 3.0;
            if distance(low + third) <= distance(high - third) {
                high -= third;
            } else {
                low += third;
            }
        }
        distance(0.5 * (low + high)).min(distance(nearest))
    }

    /// What is left of the incoming move at a time, and what is done of the outgoing one, mm.
    fn beside(&self, time: f64) -> (f64, f64) {
        let mut incoming = State {
            position: -self.entry.distance,
            velocity: self.entry.speed,
            acceleration: -self.entry.acceleration,
            jerk: 0.0,
        };
        let mut outgoing = State::default();
        let mut left = time;
        for phase in self.phases() {
            let duration = phase.duration.min(left);
            let with = |jerk| [Phase { duration, jerk }];
            incoming = integrate(incoming, &with(phase.jerk_in));
            outgoing = integrate(outgoing, &with(phase.jerk_out));
            left -= duration;
        }
        (-incoming.position, outgoing.position)
    }
}

/// The jerk of a phase. The directions are summed before they are multiplied: near a reversal they all but cancel.
fn jerk_of<const N: usize>(
    phase: &BlendPhase,
    incoming: &Vector<N>,
    outgoing: &Vector<N>,
) -> Vector<N> {
    let BlendPhase {
        jerk_in, jerk_out, ..
    } = *phase;
    if jerk_in == 0.0 {
        outgoing * jerk_out
    } else {
        (incoming + outgoing * (jerk_out / jerk_in)) * jerk_in
    }
}

fn after<const N: usize>(state: &Sample<N>, time: f64) -> Sample<N> {
    Sample {
        position: state.position
            + (state.velocity + (state.acceleration * 0.5 + state.jerk * (time / 6.0)) * time)
                * time,
        velocity: state.velocity + (state.acceleration + state.jerk * (0.5 * time)) * time,
        acceleration: state.acceleration + state.jerk * time,
        jerk: state.jerk,
    }
}
