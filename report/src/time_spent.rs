//! Sums the time of a motion by program line, and what keeps it below its feedrate.
//!
//! Lost time is what a piece lasts beyond its length over the feedrate. Its cause is read from the middle of the
//! piece: standing still, an axis at its largest velocity, a change of speed, or a turn. Not here: drawing.

use serde::Serialize;
use std::collections::BTreeMap;
use toolglide_kinematics::{Limits, Piece, Sample};

/// Share of a largest velocity from which an axis counts as being at it.
const AT_LIMIT: f64 = 0.98;

/// What keeps a motion below its feedrate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Cause {
    /// The motion rests: a dwell.
    Rest,
    /// An axis moves at its largest velocity.
    Velocity,
    /// The motion speeds up or slows down.
    Ramp,
    /// The motion turns: a corner or a curve.
    Turn,
}

/// How many causes there are.
pub(crate) const CAUSES: usize = 4;

/// The time of one line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spent {
    /// When the motion comes to it first, s.
    pub(crate) first: f64,
    /// How long all its pieces last, s.
    pub(crate) time: f64,
    /// How long their length takes at its feedrate, s; where that is a rapid, as long as they last.
    pub(crate) ideal: f64,
    /// What is lost to each cause, s.
    pub(crate) lost: [f64; CAUSES],
}

/// The time of all lines.
#[derive(Clone, Debug)]
pub(crate) struct TimeSpent<const N: usize> {
    limits: Limits<N>,
    lines: BTreeMap<u32, Spent>,
}

impl<const N: usize> TimeSpent<N> {
    pub(crate) fn new(limits: Limits<N>) -> Self {
        Self {
            limits,
            lines: BTreeMap::new(),
        }
    }

    /// Takes a piece that begins at a time and serves a line at a feedrate.
    pub(crate) fn observe(&mut self, begin: f64, piece: &Piece<N>, line: u32, feedrate: f64) {
        let duration = piece.duration();
        let spent = self.lines.entry(line).or_insert(Spent {
            first: begin,
            ..Spent::default()
        });
        spent.time += duration;
        if feedrate.is_infinite() {
            spent.ideal += duration;
            return;
        }
        let ideal = if feedrate > 0.0 {
            (length(piece) / feedrate).min(duration)
        } else {
            0.0
        };
        spent.ideal += ideal;
        let cause = cause(&piece.at(0.5 * duration), &self.limits);
        spent.lost[cause as usize] += duration - ideal;
    }

    /// Lines in order.
    pub(crate) fn lines(&self) -> impl ExactSizeIterator<Item = (u32, &Spent)> {
        self.lines.iter().map(|(line, spent)| (*line, spent))
    }
}

/// Length of a piece by Gauss's rule of three points: exact enough for a table of seconds.
fn length<const N: usize>(piece: &Piece<N>) -> f64 {
    const NODE: f64 = 0.774_596_669_241_483_4;
    let duration = piece.duration();
    let speed = |share: f64| piece.at(duration * share).velocity.norm();
    duration / 18.0
        * (5.0 * speed(0.5 - 0.5 * NODE) + 8.0 * speed(0.5) + 5.0 * speed(0.5 + 0.5 * NODE))
}

fn cause<const N: usize>(state: &Sample<N>, limits: &Limits<N>) -> Cause {
    let speed = state.velocity.norm();
    if speed <= 0.0 && state.acceleration.norm() <= 0.0 {
        return Cause::Rest;
    }
    let largest = limits.velocity();
    if (0..N).any(|axis| state.velocity[axis].abs() >= AT_LIMIT * largest[axis]) {
        return Cause::Velocity;
    }
    let along = if speed > 0.0 {
        state.acceleration.dot(&state.velocity).abs() / speed
    } else {
        state.acceleration.norm()
    };
    let across = (state.acceleration.norm_squared() - along * along)
        .max(0.0)
        .sqrt();
    if across > along {
        Cause::Turn
    } else {
        Cause::Ramp
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::{MoveRange, Vector};

    fn piece(velocity: [f64; 2], acceleration: [f64; 2], duration: f64) -> Piece<2> {
        let start = Sample {
            velocity: velocity.into(),
            acceleration: acceleration.into(),
            ..Sample::at_rest(Vector::zeros())
        };
        let whole = Piece::new(&start, duration, Vector::zeros(), MoveRange::one(0));
        let end = whole.at(duration * (1.0 - 1e-16)).position;
        Piece::new(&start, duration, end, MoveRange::one(0))
    }

    #[test]
    fn time_below_the_feedrate_is_lost_to_its_cause() {
        let limits = Limits::<2>::uniform(100.0, 2000.0, 5e4).unwrap();
        let mut spent = TimeSpent::new(limits);
        spent.observe(0.0, &piece([50.0, 0.0], [0.0; 2], 1.0), 7, 50.0);
        spent.observe(1.0, &piece([25.0, 0.0], [0.0, 100.0], 0.01), 7, 50.0);
        spent.observe(1.01, &piece([0.0, 0.0], [1000.0, 0.0], 0.01), 7, 50.0);
        spent.observe(1.02, &piece([99.0, 0.0], [0.0; 2], 1.0), 8, 198.0);
        spent.observe(2.02, &piece([0.0; 2], [0.0; 2], 0.5), 9, 50.0);
        let lines: Vec<_> = spent.lines().collect();
        let (line, seventh) = lines[0];
        assert_eq!(line, 7, "the first line");
        assert!((seventh.time - 1.02).abs() < 1e-12, "{seventh:?}");
        assert!(
            (seventh.lost[Cause::Turn as usize] - 0.005).abs() < 1e-4,
            "{seventh:?}"
        );
        assert!(
            (seventh.lost[Cause::Ramp as usize] - 0.009).abs() < 1e-4,
            "{seventh:?}"
        );
        let (_, eighth) = lines[1];
        assert!(
            (eighth.lost[Cause::Velocity as usize] - 0.5).abs() < 1e-9,
            "{eighth:?}"
        );
        let (_, ninth) = lines[2];
        assert!(
            (ninth.lost[Cause::Rest as usize] - 0.5).abs() < 1e-12,
            "{ninth:?}"
        );
    }

    #[test]
    fn a_rapid_loses_nothing() {
        let limits = Limits::<2>::uniform(100.0, 2000.0, 5e4).unwrap();
        let mut spent = TimeSpent::new(limits);
        spent.observe(0.0, &piece([50.0, 0.0], [0.0; 2], 1.0), 1, f64::INFINITY);
        let (_, first) = spent.lines().next().unwrap();
        assert!(
            first.lost.iter().sum::<f64>() <= 0.0,
            "no feedrate, no loss"
        );
    }
}
