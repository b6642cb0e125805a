//! Stores a motion of any length in fixed memory: least and greatest value of each curve per interval of time.
//!
//! When time outgrows the intervals, neighbours are joined and the width doubles, so that no peak is ever lost.
//! Not here: motions that are short enough to be kept piece by piece.

use crate::columns::Packer;
use crate::motion::STEP;
use std::io;
use toolglide_kinematics::{Piece, Sample, Vector};

/// Most intervals.
const MAX_BINS: usize = 1 << 14;

/// Width of an interval at the beginning, s.
const FIRST_WIDTH: f64 = 1e-3;

/// One interval.
#[derive(Clone, Debug)]
struct Bin<const N: usize> {
    /// Where the motion is when it begins.
    position: Vector<N>,
    /// The move that it serves then.
    mv: u32,
    /// Least and greatest value: speed, deviation, then velocity, acceleration and jerk of each axis.
    speed: [f64; 2],
    deviation: [f64; 2],
    curves: [[[f64; 2]; N]; 3],
}

/// Nothing was seen.
const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn widen(range: &mut [f64; 2], value: f64) {
    range[0] = range[0].min(value);
    range[1] = range[1].max(value);
}

fn join(one: &mut [f64; 2], other: [f64; 2]) {
    one[0] = one[0].min(other[0]);
    one[1] = one[1].max(other[1]);
}

/// The envelope of a motion.
#[derive(Clone, Debug)]
pub(crate) struct Envelope<const N: usize> {
    width: f64,
    bins: Vec<Bin<N>>,
    time: f64,
    end: Vector<N>,
}

impl<const N: usize> Envelope<N> {
    pub(crate) fn new() -> Self {
        Self {
            width: FIRST_WIDTH,
            bins: Vec::with_capacity(MAX_BINS),
            time: 0.0,
            end: Vector::zeros(),
        }
    }

    /// The interval of a time.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "times are not negative, and there are some thousand intervals"
    )]
    fn bin(&self, time: f64) -> usize {
        (time / self.width) as usize
    }

    /// Takes the next piece, and its largest deviation.
    pub(crate) fn observe(&mut self, piece: &Piece<N>, deviation: f64) {
        let begin = self.time;
        let end = begin + piece.duration();
        while end / self.width >= MAX_BINS as f64 {
            self.double();
        }
        let mut from = begin;
        loop {
            let bin = self.bin(from);
            while self.bins.len() <= bin {
                let at = self.bins.len() as f64 * self.width - begin;
                self.bins.push(Bin {
                    position: piece.position_at(at.max(0.0)),
                    mv: piece.serves().first,
                    speed: NOTHING,
                    deviation: NOTHING,
                    curves: [[NOTHING; N]; 3],
                });
            }
            let until = end.min((bin + 1) as f64 * self.width);
            self.add(bin, piece, [from - begin, until - begin], deviation);
            if until >= end || until <= from {
                break;
            }
            from = until;
        }
        self.time = end;
        self.end = piece.end();
    }

    fn add(&mut self, bin: usize, piece: &Piece<N>, span: [f64; 2], deviation: f64) {
        let bin = &mut self.bins[bin];
        let mut note = |state: &Sample<N>| {
            widen(&mut bin.speed, state.velocity.norm());
            for axis in 0..N {
                widen(&mut bin.curves[0][axis], state.velocity[axis]);
                widen(&mut bin.curves[1][axis], state.acceleration[axis]);
                widen(&mut bin.curves[2][axis], state.jerk[axis]);
            }
        };
        let first = piece.at(span[0]);
        note(&first);
        note(&piece.at(span[1]));
        for axis in 0..N {
            // The velocity is extreme where the acceleration is none.
            let at = span[0] - first.acceleration[axis] / first.jerk[axis];
            if at > span[0] && at < span[1] {
                note(&piece.at(at));
            }
        }
        widen(&mut bin.deviation, deviation);
    }

    fn double(&mut self) {
        let mut joined = Vec::with_capacity(MAX_BINS);
        for pair in self.bins.chunks(2) {
            let mut one = pair[0].clone();
            if let Some(two) = pair.get(1) {
                join(&mut one.speed, two.speed);
                join(&mut one.deviation, two.deviation);
                for (ours, theirs) in one.curves.iter_mut().zip(&two.curves) {
                    for (our, their) in ours.iter_mut().zip(theirs) {
                        join(our, *their);
                    }
                }
            }
            joined.push(one);
        }
        self.bins = joined;
        self.width *= 2.0;
    }

    /// Width of an interval, s.
    pub(crate) fn width(&self) -> f64 {
        self.width
    }

    pub(crate) fn pack(&self, prefix: &str, packer: &mut Packer) -> io::Result<()> {
        let bins = || self.bins.iter();
        packer.counts(&format!("{prefix}move"), bins().map(|bin| bin.mv))?;
        for axis in 0..N {
            let points = || bins().map(|bin| bin.position[axis]);
            packer.steps(&format!("{prefix}p{axis}"), STEP, points())?;
        }
        for (side, name) in ["lo", "hi"].into_iter().enumerate() {
            let pair = |name: &str| format!("{prefix}{name}");
            packer.f32(
                &pair(&format!("s{name}")),
                15,
                bins().map(|bin| bin.speed[side]),
            )?;
            packer.f32(
                &pair(&format!("d{name}")),
                15,
                bins().map(|bin| bin.deviation[side]),
            )?;
            for (order, letter) in ["v", "a", "j"].into_iter().enumerate() {
                for axis in 0..N {
                    let values = bins().map(|bin| bin.curves[order][axis][side]);
                    packer.f32(&pair(&format!("{letter}{axis}{name}")), 15, values)?;
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::MoveRange;

    #[test]
    fn peaks_and_places_outlive_any_number_of_doublings() {
        let mut envelope = Envelope::<1>::new();
        for step in 0..200_000_u32 {
            let speed = if step == 77_777 { 9.0 } else { 1.0 };
            let start = Sample {
                velocity: Vector::<1>::new(speed),
                ..Sample::at_rest(Vector::<1>::new(f64::from(step)))
            };
            let end = Vector::<1>::new(f64::from(step + 1));
            let piece = Piece::new(&start, 0.01, end, MoveRange::one(step));
            envelope.observe(&piece, 0.0);
        }
        assert!(envelope.bins.len() <= MAX_BINS, "bounded");
        let at = envelope.bin(777.77);
        let found = (at - 1..=at + 1).any(|bin| envelope.bins[bin].speed[1] > 8.9);
        assert!(found, "the peak is where it was");
        for bin in [0, 5, envelope.bins.len() - 1] {
            let time = bin as f64 * envelope.width();
            let error = (envelope.bins[bin].position[0] - 100.0 * time).abs();
            assert!(error <= 1.0, "bin {bin} begins {error} away");
        }
    }
}
