//! Finds and keeps the way out of a state: the changes that lead to a rate at which the motion may go on.
//!
//! Source: ours. At constant rate every limit holds for ever, because the plan keeps them and velocity, acceleration and
//! jerk scale with the rate, its square and its cube. So a state is safe when `s` can be brought to 0 within the limits
//! (settling), at a rate that keeps the caps ahead, and when the law for every plan can stop from there before the known
//! motion ends at speed. The changes of the way are stored: pieces that arrive later do not concern it.

use crate::law::{Law, ROUNDING};
use crate::step::{Bounds, State};
use crate::terms::Caps;
use crate::track::Track;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// Steps of a way at most.
pub(crate) const MAX_STEPS: usize = 1024;

/// The way in which a rate may go: towards `c`, on the side of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Course {
    /// 1 where the rate is to rise, -1 where it is to fall.
    pub(crate) side: f64,
    /// The rate that must not be passed on that side.
    pub(crate) c: f64,
}

/// The changes of the way out.
#[derive(Clone, Debug)]
pub(crate) struct Backup {
    changes: Vec<f64>,
    used: usize,
    /// Rate at its end; 0 where it ends at a rest of the plan.
    pub(crate) rate: f64,
    /// Planned time at its end, s; negative infinity where that is here.
    pub(crate) tau: f64,
}

impl Backup {
    /// Nothing to do, at a rate.
    pub(crate) fn new() -> Self {
        Self {
            changes: Vec::with_capacity(MAX_STEPS),
            used: 0,
            rate: 0.0,
            tau: f64::NEG_INFINITY,
        }
    }

    /// Forgets the way: the rate does not change.
    pub(crate) fn settle_at(&mut self, rate: f64) {
        self.changes.clear();
        self.used = 0;
        self.rate = rate;
        self.tau = f64::NEG_INFINITY;
    }

    /// The next change, if there is one.
    pub(crate) fn next(&self) -> Option<f64> {
        self.changes.get(self.used).copied()
    }

    /// Counts the next change as done.
    pub(crate) fn advance(&mut self) {
        self.used += 1;
    }

    /// Steps left.
    #[allow(clippy::cast_precision_loss, reason = "a few hundred")]
    pub(crate) fn steps(&self) -> f64 {
        (self.changes.len() - self.used) as f64
    }

    /// Appends a change; `false` when it is too long.
    pub(crate) fn push(&mut self, change: f64) -> bool {
        if self.changes.len() >= MAX_STEPS {
            return false;
        }
        self.changes.push(change);
        true
    }
}

/// Everything that a way is looked for on.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a, const N: usize> {
    pub(crate) track: &'a Track<N>,
    pub(crate) bounds: &'a Bounds<N>,
    pub(crate) law: &'a Law,
    /// The caps; `None` where there are none.
    pub(crate) caps: Option<&'a Caps>,
    /// A rate that keeps the caps everywhere in the time ahead that matters.
    pub(crate) safe: f64,
    /// Planned time from which on that is so, and for how long, s.
    pub(crate) from: f64,
    pub(crate) reach: f64,
    /// How much faster than the law it brakes on the way.
    pub(crate) gain: f64,
}

impl<const N: usize> Ground<'_, N> {
    /// Whether the motion may go on at the rate of a state at which `s` is 0.
    pub(crate) fn goes_on(&self, x: &State) -> bool {
        let r = x.rate.r;
        if r.abs() > self.safe * (1.0 + 1e-9) {
            return false;
        }
        if r.abs() > 0.0 && self.caps.is_some() {
            let used = (x.tau - self.from).abs() + r.abs() * self.bounds.step;
            if used + self.law.uses_from(r) > self.reach {
                return false;
            }
        }
        self.stops_in_time(x.tau, r)
    }

    /// Whether the law for every plan stops before the known motion ends at speed.
    #[inline]
    fn stops_in_time(&self, tau: f64, r: f64) -> bool {
        let step = r * self.bounds.step;
        if r > 0.0 {
            let end = self.track.open_end();
            end.is_infinite() || tau + step + self.law.uses_from(r) <= end
        } else if r < 0.0 {
            let begin = self.track.open_begin();
            begin.is_infinite() || tau + step - self.law.uses_from(r) >= begin
        } else {
            true
        }
    }

    /// The way out of a state: settling, after braking as long as the caps ahead ask for it. Written to `into`.
    pub(crate) fn way_out(&self, mut x: State, course: Course, into: &mut Backup) -> bool {
        into.settle_at(0.0);
        let h = self.bounds.step;
        loop {
            if (course.c - x.rate.r) * course.side < -ROUNDING {
                return false;
            }
            let brakes = self.safe < 1.0 && self.must_brake(&x);
            if !brakes && x.rate.s.abs() <= 0.0 {
                (into.rate, into.tau) = (x.rate.r, x.tau);
                return self.goes_on(&x);
            }
            let want = if brakes {
                let slope = self.gain * self.law.slope(x.rate.r.abs());
                ((-slope).copysign(-x.rate.r) - x.rate.s) / h
            } else {
                -x.rate.s / h
            };
            let Some((u, reached)) = self.bounds.choose(self.track, &x, want, self.caps) else {
                return false;
            };
            if !into.push(u) {
                return false;
            }
            if reached.rest {
                into.rate = 0.0;
                return true;
            }
            x = settled(reached.state, h);
        }
    }

    /// Whether settling at once would leave the rate too high for the caps ahead.
    fn must_brake(&self, x: &State) -> bool {
        let (r, s) = (x.rate.r.abs(), x.rate.s * 1.0_f64.copysign(x.rate.r));
        if r <= self.safe * (1.0 + 1e-9) {
            return false;
        }
        let entry = self.track.get(x.at);
        let d = x.tau - entry.begin;
        let strongest = (0..N)
            .map(|axis| self.bounds.jerk[axis] / entry.x1(axis, d).abs().max(1e-9))
            .fold(self.bounds.most(), f64::min);
        s >= 0.0 || r - 0.5 * s * s / (0.6 * strongest) > self.safe
    }
}

/// A state whose `s` has become 0, exactly so.
#[inline]
pub(crate) fn settled(mut x: State, h: f64) -> State {
    if (x.rate.s * h).abs() < ROUNDING {
        x.rate.s = 0.0;
    }
    x
}
