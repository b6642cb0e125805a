//! Checks one step of constant `u` against the limits, on the planned pieces themselves, at every instant.
//!
//! Source: ours. With primes for derivatives by planned time, `r` its rate, `s = r'`, `u = s'`, each axis moves at
//! `v = x' r`, `a = x'' r^2 + x' s`, `j = x''' r^3 + 3 x'' r s + x' u`. A step is cut at the knots of the plan. On each part
//! `a` and `j` are polynomials in time, and none of them leaves the range of its ends by more than an eighth of the
//! squared length times a bound of its second derivative: `a'' = 6 x''' r^2 s + x'' (3 s^2 + 4 r u)` and
//! `j'' = x''' (15 r s^2 + 10 r^2 u) + 10 x'' s u`. So no margin is needed, and at constant rate the rows are exact.

use crate::law::{ROUNDING, Rate};
use crate::terms::Caps;
use crate::track::{Entry, Track};

/// Changes of a step at most: where the plan rests nothing else bounds them.
const MAX_RATE_STEP: f64 = 0.1;

/// How far inside the rows a change is taken when the rows lead elsewhere, as a share of their interval: one pass each.
const INSIDE: [f64; 4] = [0.0, 0.0, 0.01, 0.1];

/// Rounding of a row, as a share of the limit.
const RELATIVE: f64 = 1e-12;

/// Place on the plan, and the rate there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct State {
    /// The piece.
    pub(crate) at: u64,
    /// Planned time, s.
    pub(crate) tau: f64,
    pub(crate) rate: Rate,
}

/// What the executed motion must keep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds<const N: usize> {
    pub(crate) acceleration: [f64; N],
    pub(crate) jerk: [f64; N],
    /// Length of a step, s.
    pub(crate) step: f64,
}

/// How a step ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reached {
    pub(crate) state: State,
    /// How much of the step it took, s: less where a rest begins, at which any rate may follow.
    pub(crate) took: f64,
    /// Whether it came to a rest of the plan.
    pub(crate) rest: bool,
}

/// An instant of a step on one piece.
#[derive(Clone, Copy)]
struct Instant {
    /// Time since the start of the piece, s.
    d: f64,
    /// Time since the start of the step, s.
    f: f64,
    rate: Rate,
}

/// Bounds over a step.
#[derive(Clone, Copy)]
struct Worst {
    r: f64,
    s: f64,
}

/// The interval of changes that the rows allow.
#[derive(Clone, Copy)]
struct Interval {
    low: f64,
    high: f64,
}

impl Interval {
    /// Narrows it to `|c + m u| + k |u| <= most`.
    #[inline]
    fn narrow(&mut self, c: f64, m: f64, k: f64, most: f64) {
        let c = if m < 0.0 { -c } else { c };
        let m = m.abs();
        let (above, below) = (most - c, most + c);
        let divided = |left: f64| {
            let slope = if left >= 0.0 { m + k } else { m - k };
            if slope > 1e-9 {
                left / slope
            } else if left >= 0.0 {
                f64::INFINITY
            } else {
                f64::NEG_INFINITY
            }
        };
        self.high = self.high.min(divided(above));
        self.low = self.low.max(-divided(below));
    }
}

impl<const N: usize> Bounds<N> {
    /// Largest change of a step.
    #[inline]
    pub(crate) fn most(&self) -> f64 {
        0.2 * MAX_RATE_STEP / (self.step * self.step)
    }

    /// Where a step under `u` leads when it keeps every limit and the caps.
    #[inline]
    pub(crate) fn check(
        &self,
        track: &Track<N>,
        x: &State,
        u: f64,
        caps: Option<&Caps>,
    ) -> Option<Reached> {
        let h = self.step;
        let end = x.rate.after(u, h);
        if end.s.abs() * h > MAX_RATE_STEP * (1.0 + ROUNDING) && end.s.abs() > x.rate.s.abs() {
            return None;
        }
        let worst = worst(x.rate, end, u);
        if worst.r > 1.0 + ROUNDING {
            return None;
        }
        if turns(x.rate, end, u) {
            return self.turning(track, x, u, worst);
        }
        walk(track, x, u, h, |entry, from, to| {
            self.part(entry, u, from, to, worst) && keeps_caps(entry, from, to, caps)
        })
    }

    /// Where a step under `u` leads, whose limits are known to be kept.
    #[inline]
    pub(crate) fn drift(&self, track: &Track<N>, x: &State, u: f64) -> Option<Reached> {
        self.drift_for(track, x, u, self.step)
    }

    /// The same for another time.
    pub(crate) fn drift_for(&self, track: &Track<N>, x: &State, u: f64, h: f64) -> Option<Reached> {
        if turns(x.rate, x.rate.after(u, h), u) {
            let (tau, rate) = (moved(x, u, h), x.rate.after(u, h));
            let state = State {
                at: track.seek(x.at, tau),
                tau,
                rate,
            };
            return Some(Reached {
                state,
                took: h,
                rest: false,
            });
        }
        walk(track, x, u, h, |_, _, _| true)
    }

    /// Where a rate that does not change leads in a time when it keeps the caps; the limits hold, because the plan keeps
    /// them.
    pub(crate) fn steady(
        &self,
        track: &Track<N>,
        x: &State,
        h: f64,
        caps: Option<&Caps>,
    ) -> Option<Reached> {
        walk(track, x, 0.0, h, |entry, from, to| {
            keeps_caps(entry, from, to, caps)
        })
    }

    /// Whether a part of a step keeps the limits.
    #[inline]
    fn part(&self, e: &Entry<N>, u: f64, from: &Instant, to: &Instant, worst: Worst) -> bool {
        let span = to.f - from.f;
        let eighth = 0.125 * span * span;
        let (r0, s0, r1, s1) = (from.rate.r, from.rate.s, to.rate.r, to.rate.s);
        let size = u.abs();
        // Factors of x''' and x'' in the second derivatives.
        let (a3, a2) = (
            eighth * 6.0 * worst.r * worst.r * worst.s,
            eighth * (3.0 * worst.s * worst.s + 4.0 * worst.r * size),
        );
        let (j3, j2) = (
            eighth * worst.r * (15.0 * worst.s * worst.s + 10.0 * worst.r * size),
            eighth * 10.0 * worst.s * size,
        );
        let (c0, b0) = (r0 * r0 * r0, 3.0 * r0 * s0);
        let (c1, b1) = (r1 * r1 * r1, 3.0 * r1 * s1);
        let mut kept = true;
        for axis in 0..N {
            let x3 = e.j[axis];
            let (p1, q1) = (e.x1(axis, from.d), e.x1(axis, to.d));
            let (p2, q2) = (e.x2(axis, from.d), e.x2(axis, to.d));
            let bend = p2.abs().max(q2.abs());
            let third = x3.abs();
            let a = (p2 * r0 * r0 + p1 * s0)
                .abs()
                .max((q2 * r1 * r1 + q1 * s1).abs())
                + third * a3
                + bend * a2;
            let j = (x3 * c0 + p2 * b0 + p1 * u)
                .abs()
                .max((x3 * c1 + q2 * b1 + q1 * u).abs())
                + third * j3
                + bend * j2;
            kept &= a <= self.acceleration[axis] && j <= self.jerk[axis];
        }
        kept
    }

    /// A step in which the rate changes its sign: everything at its worst.
    fn turning(&self, track: &Track<N>, x: &State, u: f64, worst: Worst) -> Option<Reached> {
        let h = self.step;
        let way = worst.r * h;
        let (low, high) = (x.tau - way, x.tau + way);
        if high > track.end() || low < track.begin() {
            return None;
        }
        let mut at = track.seek(x.at, low);
        let last = track.seek(x.at, high);
        while at <= last {
            let e = track.get(at);
            let from = low.max(e.begin) - e.begin;
            let half = (0.5 * (high.min(e.end) - e.begin - from)).max(0.0);
            let middle = from + half;
            for axis in 0..N {
                let x3 = e.j[axis].abs();
                let x2 = e.x2(axis, middle).abs() + x3 * half;
                let x1 = e.x1(axis, middle).abs() + x2 * half;
                let a = x2 * worst.r * worst.r + x1 * worst.s;
                let j =
                    x3 * worst.r * worst.r * worst.r + 3.0 * x2 * worst.r * worst.s + x1 * u.abs();
                if a > self.acceleration[axis] || j > self.jerk[axis] {
                    return None;
                }
            }
            at += 1;
        }
        let (tau, rate) = (moved(x, u, h), x.rate.after(u, h));
        Some(Reached {
            state: State {
                at: track.seek(x.at, tau),
                tau,
                rate,
            },
            took: h,
            rest: false,
        })
    }

    /// The change nearest to `want` that keeps every limit over a step, and where it leads.
    #[inline]
    pub(crate) fn choose(
        &self,
        track: &Track<N>,
        x: &State,
        want: f64,
        caps: Option<&Caps>,
    ) -> Option<(f64, Reached)> {
        let want = want.clamp(-self.most(), self.most());
        if let Some(reached) = self.check(track, x, want, caps) {
            return Some((want, reached));
        }
        self.narrowed(track, x, want, caps)
    }

    /// The same where `want` is too much.
    fn narrowed(
        &self,
        track: &Track<N>,
        x: &State,
        want: f64,
        caps: Option<&Caps>,
    ) -> Option<(f64, Reached)> {
        let h = self.step;
        let most = self.most();
        let top = MAX_RATE_STEP / h;
        let mut allowed = Interval {
            low: (-most).max((-top - x.rate.s) / h),
            high: most.min((top - x.rate.s) / h),
        };
        // The rows at the start hold whatever the change; the others are taken where it leads.
        let entry = track.get(x.at);
        let start = Instant {
            d: x.tau - entry.begin,
            f: 0.0,
            rate: x.rate,
        };
        self.rows(
            entry,
            &start,
            x.rate,
            Worst { r: 0.0, s: 0.0 },
            0.0,
            &mut allowed,
        );
        if allowed.low > allowed.high {
            return None;
        }
        let mut u = want.clamp(allowed.low, allowed.high);
        for share in INSIDE {
            let end = x.rate.after(u, h);
            let worst = worst(x.rate, end, u);
            walk(track, x, u, h, |entry, from, to| {
                let span = to.f - from.f;
                self.rows(entry, from, x.rate, worst, span, &mut allowed);
                self.rows(entry, to, x.rate, worst, span, &mut allowed);
                true
            })?;
            if allowed.low > allowed.high {
                return None;
            }
            // Where the rows lead elsewhere, a little inside of them.
            let inside = share * (allowed.high - allowed.low);
            u = want.clamp(allowed.low + inside, allowed.high - inside);
            if let Some(reached) = self.check(track, x, u, caps) {
                return Some((u, reached));
            }
        }
        None
    }

    /// Rows at an instant, linear in the change: with `s = s0 + u f` there.
    #[inline]
    fn rows(
        &self,
        e: &Entry<N>,
        at: &Instant,
        begin: Rate,
        worst: Worst,
        span: f64,
        allowed: &mut Interval,
    ) {
        let eighth = 0.125 * span * span;
        let (r, s, f) = (at.rate.r, begin.s, at.f);
        for axis in 0..N {
            let (x1, x2, x3) = (e.x1(axis, at.d), e.x2(axis, at.d), e.j[axis]);
            let bend = x2.abs() + x3.abs() * span;
            let fixed = eighth * 15.0 * x3.abs() * worst.r * worst.s * worst.s;
            let slope = eighth * 10.0 * (x3.abs() * worst.r * worst.r + bend * worst.s);
            allowed.narrow(
                x3 * r * r * r + 3.0 * x2 * r * s,
                x1 + 3.0 * x2 * r * f,
                slope,
                (self.jerk[axis] - fixed) * (1.0 - RELATIVE),
            );
            if f > 0.0 {
                let fixed = eighth
                    * (6.0 * x3.abs() * worst.r * worst.r * worst.s
                        + 3.0 * bend * worst.s * worst.s);
                allowed.narrow(
                    x2 * r * r + x1 * s,
                    x1 * f,
                    eighth * 4.0 * bend * worst.r,
                    (self.acceleration[axis] - fixed) * (1.0 - RELATIVE),
                );
            }
        }
    }
}

/// Largest rate and derivative over a step.
#[inline]
fn worst(begin: Rate, end: Rate, u: f64) -> Worst {
    let mut r = begin.r.abs().max(end.r.abs());
    if begin.s * end.s < 0.0 {
        r = r.max((begin.r - 0.5 * begin.s * begin.s / u).abs());
    }
    Worst {
        r,
        s: begin.s.abs().max(end.s.abs()),
    }
}

/// Whether the rate changes its sign inside a step.
#[inline]
fn turns(begin: Rate, end: Rate, u: f64) -> bool {
    if begin.r * end.r < 0.0 {
        return true;
    }
    if begin.s * end.s < 0.0 {
        let vertex = begin.r - 0.5 * begin.s * begin.s / u;
        return vertex * begin.r < 0.0 || vertex * end.r < 0.0;
    }
    false
}

/// Planned time after `t` of a step.
#[inline]
pub(crate) fn moved(x: &State, u: f64, t: f64) -> f64 {
    x.tau + (x.rate.r + (0.5 * x.rate.s + u * t / 6.0) * t) * t
}

/// Whether a part of a step keeps the caps of its piece.
#[inline]
fn keeps_caps<const N: usize>(
    e: &Entry<N>,
    from: &Instant,
    to: &Instant,
    caps: Option<&Caps>,
) -> bool {
    let Some(caps) = caps else {
        return true;
    };
    let (cap, top) = caps.of(&e.terms);
    let fastest = from.rate.r.abs().max(to.rate.r.abs());
    if fastest > top * (1.0 + 1e-9) {
        return false;
    }
    if cap.is_infinite() || e.speed * fastest <= cap {
        return true;
    }
    // Between the ends the speed lies below the larger of theirs, but for the change of acceleration.
    let span = to.f - from.f;
    let (r0, r1) = (from.rate.r, to.rate.r);
    let u = if span > 0.0 {
        (to.rate.s - from.rate.s) / span
    } else {
        0.0
    };
    let (mut j0, mut j1) = (0.0, 0.0);
    for axis in 0..N {
        let at = |d: f64, rate: Rate| {
            e.j[axis] * rate.r * rate.r * rate.r
                + 3.0 * e.x2(axis, d) * rate.r * rate.s
                + e.x1(axis, d) * u
        };
        let (a, b) = (at(from.d, from.rate), at(to.d, to.rate));
        j0 += a * a;
        j1 += b * b;
    }
    let room = 0.125 * span * span * sqrt(j0.max(j1));
    let speed = sqrt((e.speed2(from.d) * r0 * r0).max(e.speed2(to.d) * r1 * r1));
    speed + room <= cap * (1.0 + 1e-9)
}

#[inline]
pub(crate) fn sqrt(value: f64) -> f64 {
    toolglide_kinematics::nalgebra::ComplexField::sqrt(value)
}

/// Visits the parts of a step in which the rate keeps its sign, cut at the knots of the plan; `None` where the known
/// motion ends at speed, or the visitor says no.
#[inline]
fn walk<const N: usize>(
    track: &Track<N>,
    x: &State,
    u: f64,
    h: f64,
    mut visit: impl FnMut(&Entry<N>, &Instant, &Instant) -> bool,
) -> Option<Reached> {
    let target = moved(x, u, h);
    let forward = target >= x.tau;
    // At full rate nothing changes at a dwell.
    let full = u.abs() <= 0.0 && x.rate.s.abs() <= 0.0 && (x.rate.r.abs() - 1.0).abs() <= 0.0;
    let mut at = x.at;
    let mut from = Instant {
        d: x.tau - track.get(at).begin,
        f: 0.0,
        rate: x.rate,
    };
    loop {
        let entry = track.get(at);
        let leaves = if forward {
            target > entry.end
        } else {
            target < entry.begin
        };
        if !leaves {
            let to = Instant {
                d: target - entry.begin,
                f: h,
                rate: x.rate.after(u, h),
            };
            return visit(entry, &from, &to).then_some(Reached {
                state: State {
                    at,
                    tau: target,
                    rate: to.rate,
                },
                took: h,
                rest: false,
            });
        }
        let knot = if forward { entry.end } else { entry.begin };
        let f = crossing(x, u, knot, from.f, h, target);
        let rate = x.rate.after(u, f);
        let to = Instant {
            d: knot - entry.begin,
            f,
            rate,
        };
        if !visit(entry, &from, &to) {
            return None;
        }
        let (last, open) = if forward {
            (at + 1 == track.next(), track.ends_at_rest())
        } else {
            (at == track.first(), track.open_begin().is_infinite())
        };
        let neighbour = if forward { at + 1 } else { at.wrapping_sub(1) };
        let rest = if last {
            open
        } else {
            let later = if forward { neighbour } else { at };
            track.get(later).from_rest && !full
        };
        if rest {
            return Some(Reached {
                state: State {
                    at: if last { at } else { neighbour },
                    tau: knot,
                    rate: Rate { r: rate.r, s: 0.0 },
                },
                took: f,
                rest: true,
            });
        }
        if last {
            return None;
        }
        at = neighbour;
        from = Instant {
            d: knot - track.get(at).begin,
            f,
            rate,
        };
    }
}

/// Time in a step at which a knot is crossed.
#[inline]
fn crossing(x: &State, u: f64, knot: f64, after: f64, h: f64, target: f64) -> f64 {
    let share = (knot - x.tau) / (target - x.tau);
    let mut f = (share * h).clamp(after, h);
    for _ in 0..3 {
        let rate = x.rate.after(u, f).r;
        if rate.abs() <= 1e-9 {
            break;
        }
        let miss = moved(x, u, f) - knot;
        f = (f - miss / rate).clamp(after, h);
        if miss.abs() < 1e-13 {
            break;
        }
    }
    f
}
