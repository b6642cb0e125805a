//! Represents timed motion: a trajectory, a plan of pieces, and the sampler that ticks through
//! either.
//!
//! Source: section 2.2 for the pieces, sampled at exact instants instead of rounding the phases to
//! the period. Not here: planning.

#[cfg(not(feature = "std"))]
use crate::no_std::*;
use crate::piece::Piece;
use crate::sample::{Sample, SamplePeriod};
use crate::vector::Vector;

/// A motion of `N` axes over `0.0..=duration`.
pub trait Trajectory<const N: usize> {
    /// How long the motion lasts.
    fn duration(&self) -> f64;
    /// State at `time`; a time outside the motion gives the nearer end.
    fn sample(&self, time: f64) -> Sample<N>;
    /// Increasing times, ends included, between which the motion is smooth.
    fn knots(&self) -> &[f64];
}

/// The pieces of a motion, in order, from rest at a start to rest at an end.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan<const N: usize> {
    start: Vector<N>,
    pieces: Vec<Piece<N>>,
    knots: Vec<f64>,
}

impl<const N: usize> Plan<N> {
    /// A plan of no pieces: standing still at `start`.
    #[must_use]
    pub fn starting_at(start: Vector<N>) -> Self {
        Self {
            start,
            pieces: Vec::new(),
            knots: vec![0.0],
        }
    }

    /// Appends the piece that follows.
    pub fn push(&mut self, piece: Piece<N>) {
        self.knots.push(self.duration() + piece.duration());
        self.pieces.push(piece);
    }

    /// Where the motion begins.
    #[must_use]
    pub fn start(&self) -> Vector<N> {
        self.start
    }

    /// Where the motion ends.
    #[must_use]
    pub fn end(&self) -> Vector<N> {
        self.pieces.last().map_or(self.start, Piece::end)
    }

    /// The pieces, in order.
    #[must_use]
    pub fn pieces(&self) -> &[Piece<N>] {
        &self.pieces
    }
}

impl<const N: usize> Extend<Piece<N>> for Plan<N> {
    fn extend<I: IntoIterator<Item = Piece<N>>>(&mut self, pieces: I) {
        for piece in pieces {
            self.push(piece);
        }
    }
}

impl<const N: usize> Trajectory<N> for Plan<N> {
    fn duration(&self) -> f64 {
        self.knots.last().copied().unwrap_or(0.0)
    }

    fn sample(&self, time: f64) -> Sample<N> {
        let after = self.knots.partition_point(|&knot| knot <= time);
        let index = after
            .saturating_sub(1)
            .min(self.pieces.len().saturating_sub(1));
        match self.pieces.get(index) {
            Some(piece) => piece.at(time - self.knots[index]),
            None => Sample::at_rest(self.start),
        }
    }

    fn knots(&self) -> &[f64] {
        &self.knots
    }
}

/// Ticks through a motion that arrives piece by piece.
///
/// Tick `k` stands at the time `k * period`, computed from `k`, so that no error adds up. The
/// sampler holds one piece and never allocates.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Sampler, SamplePeriod};
/// let mut sampler = Sampler::<3>::new(SamplePeriod::new(0.001)?);
/// assert!(sampler.next_tick().is_none(), "no motion was given yet");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sampler<const N: usize> {
    period: f64,
    tick: u64,
    piece_start: f64,
    piece_end: f64,
    compensation: f64,
    piece: Option<Piece<N>>,
}

impl<const N: usize> Sampler<N> {
    /// A sampler that has not been given any motion.
    #[must_use]
    pub fn new(period: SamplePeriod) -> Self {
        Self {
            period: period.seconds(),
            tick: 0,
            piece_start: 0.0,
            piece_end: 0.0,
            compensation: 0.0,
            piece: None,
        }
    }

    /// Takes the piece that follows, once [`Sampler::next_tick`] has given `None`.
    #[inline]
    pub fn feed(&mut self, piece: &Piece<N>) {
        self.piece_start = self.piece_end;
        // Compensated sum: ten million pieces add up as well as ten.
        let step = piece.duration() - self.compensation;
        let sum = self.piece_end + step;
        self.compensation = (sum - self.piece_end) - step;
        self.piece_end = sum;
        self.piece = Some(*piece);
    }

    /// Time and position of the next tick inside the current piece; `None` when the next piece is
    /// needed. A tick on a knot belongs to the piece that follows.
    #[inline]
    pub fn next_tick(&mut self) -> Option<(f64, Vector<N>)> {
        let (time, since) = self.advance()?;
        self.piece.map(|piece| (time, piece.position_at(since)))
    }

    /// As [`Sampler::next_tick`], with velocity, acceleration and jerk.
    #[inline]
    pub fn next_sample(&mut self) -> Option<(f64, Sample<N>)> {
        let (time, since) = self.advance()?;
        self.piece.map(|piece| (time, piece.at(since)))
    }

    /// Time at which the motion given so far ends.
    #[must_use]
    pub fn end_time(&self) -> f64 {
        self.piece_end
    }

    /// End of the motion given so far; `None` before any.
    #[must_use]
    pub fn end(&self) -> Option<Vector<N>> {
        self.piece.map(|piece| piece.end())
    }

    #[inline]
    #[allow(
        clippy::cast_precision_loss,
        reason = "ticks stay below 2^53 for a hundred thousand years"
    )]
    fn advance(&mut self) -> Option<(f64, f64)> {
        let time = self.tick as f64 * self.period;
        if time < self.piece_end {
            self.tick += 1;
            Some((time, time - self.piece_start))
        } else {
            None
        }
    }
}
