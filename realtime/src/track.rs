//! Keeps the pieces in hand and those just passed in a ring.
//!
//! Source: ours. Planned time counts from the first piece ever fed; the sum is the one of
//! [`toolglide_kinematics::Sampler`], so that ticks fall on the same instants. Not here: at what rate it passes.

use crate::terms::Terms;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::{MoveRange, Piece, Vector};

/// A velocity below this share of its limit is none; the same for acceleration.
const AT_REST: f64 = 1e-6;

/// A piece with what is asked of it again and again.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry<const N: usize> {
    /// Planned time at which it begins and ends, s.
    pub(crate) begin: f64,
    pub(crate) end: f64,
    /// Velocity, acceleration and jerk at its start.
    pub(crate) v: [f64; N],
    pub(crate) a: [f64; N],
    pub(crate) j: [f64; N],
    /// A bound of the planned speed along the path.
    pub(crate) speed: f64,
    /// Whether it stands still throughout.
    pub(crate) rests: bool,
    /// Whether the plan rests where it begins.
    pub(crate) from_rest: bool,
    pub(crate) terms: Terms,
    pub(crate) piece: Piece<N>,
}

impl<const N: usize> Entry<N> {
    /// Planned velocity of an axis at a time since its start.
    #[inline]
    pub(crate) fn x1(&self, axis: usize, d: f64) -> f64 {
        self.v[axis] + (self.a[axis] + 0.5 * self.j[axis] * d) * d
    }

    /// Planned acceleration of an axis at a time since its start.
    #[inline]
    pub(crate) fn x2(&self, axis: usize, d: f64) -> f64 {
        self.a[axis] + self.j[axis] * d
    }

    /// Planned speed along the path at a time since its start, squared.
    #[inline]
    pub(crate) fn speed2(&self, d: f64) -> f64 {
        (0..N).map(|axis| self.x1(axis, d)).map(|v| v * v).sum()
    }
}

/// The ring. Entries are named by how many came before.
#[derive(Clone, Debug)]
pub(crate) struct Track<const N: usize> {
    ring: Vec<Entry<N>>,
    mask: u64,
    first: u64,
    next: u64,
    /// Pieces kept behind.
    behind: u64,
    sum: f64,
    compensation: f64,
    /// Velocity and acceleration below which an axis rests.
    still: ([f64; N], [f64; N]),
    /// Whether the motion known so far ends at rest.
    rests_at_end: bool,
    /// Whether what is before the first piece is a rest, too: nothing was forgotten yet.
    rests_at_begin: bool,
    /// Planned time beyond which the motion must not go.
    limit: Option<f64>,
}

impl<const N: usize> Track<N> {
    /// Room for so many pieces ahead and behind.
    pub(crate) fn new(
        at: Vector<N>,
        ahead: usize,
        behind: usize,
        still: ([f64; N], [f64; N]),
    ) -> Self {
        let room = (ahead + behind + 2).next_power_of_two();
        let blank = Entry {
            begin: 0.0,
            end: 0.0,
            v: [0.0; N],
            a: [0.0; N],
            j: [0.0; N],
            speed: 0.0,
            rests: true,
            from_rest: true,
            terms: Terms::default(),
            piece: Piece::new(
                &toolglide_kinematics::Sample::at_rest(at),
                0.0,
                at,
                MoveRange::one(0),
            ),
        };
        Self {
            ring: vec![blank; room],
            mask: room as u64 - 1,
            first: 0,
            next: 0,
            behind: behind as u64,
            sum: 0.0,
            compensation: 0.0,
            still: (still.0.map(|v| v * AT_REST), still.1.map(|a| a * AT_REST)),
            rests_at_end: true,
            rests_at_begin: true,
            limit: None,
        }
    }

    /// Sets a planned time beyond which the motion must not go, or none.
    pub(crate) fn limit(&mut self, limit: Option<f64>) {
        self.limit = limit;
    }

    #[inline]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "masked to the length of the ring"
    )]
    pub(crate) fn get(&self, at: u64) -> &Entry<N> {
        &self.ring[(at & self.mask) as usize]
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.first == self.next
    }

    /// One more than the last piece.
    pub(crate) fn next(&self) -> u64 {
        self.next
    }

    /// The first piece that is kept.
    pub(crate) fn first(&self) -> u64 {
        self.first
    }

    /// Planned time at which the motion known so far ends.
    pub(crate) fn end(&self) -> f64 {
        self.sum
    }

    /// Planned time at which the motion begins that is kept.
    pub(crate) fn begin(&self) -> f64 {
        self.get(self.first).begin
    }

    /// Planned time up to which the motion may be executed without a stop: all of it when it ends at rest.
    pub(crate) fn open_end(&self) -> f64 {
        match self.limit {
            Some(limit) => limit,
            None if self.rests_at_end => f64::INFINITY,
            None => self.sum,
        }
    }

    /// The same towards the past.
    pub(crate) fn open_begin(&self) -> f64 {
        if self.rests_at_begin {
            f64::NEG_INFINITY
        } else {
            self.begin()
        }
    }

    pub(crate) fn ends_at_rest(&self) -> bool {
        self.rests_at_end
    }

    /// How many more pieces may be fed while piece `at` is executed.
    pub(crate) fn room(&self, at: u64) -> u64 {
        // What lies behind may be forgotten; one piece is.
        let kept = self.behind.min(at.saturating_sub(self.first));
        (self.mask + 1).saturating_sub(self.next.saturating_sub(at) + kept)
    }

    /// Appends a piece; what is `behind` pieces back is forgotten when the ring is full.
    pub(crate) fn push(&mut self, piece: &Piece<N>, terms: Terms) {
        let start = piece.at(0.0);
        let begin = self.sum;
        let step = piece.duration() - self.compensation;
        let sum = begin + step;
        self.compensation = (sum - begin) - step;
        self.sum = sum;
        let (v, a, j): ([f64; N], [f64; N], [f64; N]) = (
            start.velocity.into(),
            start.acceleration.into(),
            start.jerk.into(),
        );
        let t = piece.duration();
        // The velocity is a parabola in time, its control points bound it.
        let middle = start.velocity + start.acceleration * (0.5 * t);
        let last = piece.at(t);
        let speed = start
            .velocity
            .norm_squared()
            .max(middle.norm_squared())
            .max(last.velocity.norm_squared());
        let zero = |values: &[f64; N]| values.iter().all(|value| value.abs() <= 0.0);
        if self.next - self.first > self.mask {
            self.first += 1;
            self.rests_at_begin = false;
        }
        let from_rest = self.rests_at_end;
        self.rests_at_end = self.still(&last.velocity, &last.acceleration);
        let entry = Entry {
            begin,
            end: sum,
            v,
            a,
            j,
            speed: toolglide_kinematics::nalgebra::ComplexField::sqrt(speed),
            rests: t > 0.0 && zero(&v) && zero(&a) && zero(&j),
            from_rest,
            terms,
            piece: *piece,
        };
        let place = self.next & self.mask;
        #[allow(
            clippy::cast_possible_truncation,
            reason = "masked to the length of the ring"
        )]
        {
            self.ring[place as usize] = entry;
        }
        self.next += 1;
    }

    fn still(&self, velocity: &Vector<N>, acceleration: &Vector<N>) -> bool {
        (0..N).all(|axis| {
            velocity[axis].abs() <= self.still.0[axis]
                && acceleration[axis].abs() <= self.still.1[axis]
        })
    }

    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        self.first = self.next;
        self.rests_at_end = true;
        self.rests_at_begin = true;
    }

    /// The piece that holds a planned time, from one near by; a knot belongs to the piece that follows.
    #[inline]
    pub(crate) fn seek(&self, mut at: u64, tau: f64) -> u64 {
        while at + 1 < self.next && tau >= self.get(at).end {
            at += 1;
        }
        while at > self.first && tau < self.get(at).begin {
            at -= 1;
        }
        at
    }
}
