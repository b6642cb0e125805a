//! Decides the change of each step: the strongest after which the motion can still go on for ever.
//!
//! Source: ours. Safety is an induction. The way out of the present state is stored; a change is applied when a way out of
//! the state behind it was found, and else the first change of the stored way, whose rest is the way out of what follows.
//! Commands concern only what is accepted, never what is safe. A hold runs against a deadline: as soon as the stored way
//! and the law for every plan would miss it, that law takes over, which cannot fail.

use crate::backup::{Backup, Course, Ground, settled};
use crate::law::{Law, Rate, landing, snapped};
use crate::step::{Bounds, Reached, State};
use crate::terms::Caps;
use crate::track::Track;

/// How often changes are tried in a step, and how the share of the strongest change that was taken grows when it was
/// accepted and shrinks when it was refused.
#[derive(Clone, Copy, Debug)]
struct Search {
    tries: u32,
    grow: f64,
    shrink: f64,
}

/// Without caps one try is enough: what fails now is tried again a step later.
const FREE: Search = Search {
    tries: 1,
    grow: 1.6,
    shrink: 0.4,
};

/// Along a cap each refused step costs speed.
const CAPPED: Search = Search {
    tries: 4,
    grow: 2.0,
    shrink: 0.5,
};

/// How much faster than the law ways out brake: so much less after one that failed, so much more after one that did not,
/// between these, and in the second try.
const LESS: f64 = 0.7;
const MORE: f64 = 1.3;
const GAINS: (f64, f64) = (1.0, 50.0);
const SECOND: f64 = 2.0;

/// The smallest share.
const SMALLEST: f64 = 0.01;

/// Rates that are tried at a start lie so far apart.
const START_STEP: f64 = 0.1;

/// Time beyond the braking distance in which the caps are known, s.
const CAP_REACH: f64 = 0.3;

/// The aim of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    /// The rate that is wanted.
    pub(crate) c: f64,
    /// Whether it must be reached in the promised time.
    pub(crate) promised: bool,
    /// The caps that are wanted.
    pub(crate) caps: Caps,
    /// Whether the stored way is what is wanted.
    pub(crate) follow: bool,
}

/// Everything that decides.
#[derive(Clone, Debug)]
pub(crate) struct Driver<const N: usize> {
    pub(crate) track: Track<N>,
    pub(crate) bounds: Bounds<N>,
    pub(crate) law: Law,
    pub(crate) backup: Backup,
    scratch: Backup,
    /// The caps that the stored way keeps.
    pub(crate) proven: Caps,
    share: f64,
    /// How much faster than the law ways out brake.
    gain: f64,
    /// Steps that are left of a promise; infinite where none was given.
    pub(crate) left: f64,
    /// Whether the law for every plan has taken over.
    pub(crate) lawful: bool,
    /// How much longer than the law takes a hold may last, as a share.
    patience: f64,
    /// Steps without any way, which must not be.
    pub(crate) infeasible: u64,
}

impl<const N: usize> Driver<N> {
    pub(crate) fn new(
        track: Track<N>,
        bounds: Bounds<N>,
        law: Law,
        caps: Caps,
        patience: f64,
    ) -> Self {
        Self {
            track,
            bounds,
            law,
            backup: Backup::new(),
            scratch: Backup::new(),
            proven: caps,
            share: 1.0,
            gain: 4.0,
            left: f64::INFINITY,
            lawful: false,
            patience,
            infeasible: 0,
        }
    }

    /// Steps in which a hold that is commanded now is over, at most.
    pub(crate) fn promise(&self) -> f64 {
        if self.left.is_finite() {
            return self.left;
        }
        self.backup.steps() + (1.0 + self.patience) * self.law.steps_from(self.backup.rate)
    }

    /// A rate that keeps the caps everywhere as far as a stop by the law may lead, and how far that is, s.
    pub(crate) fn safe_rate(&self, x: &State, caps: &Caps, direction: f64) -> (f64, f64) {
        if caps.open() {
            return (1.0, f64::INFINITY);
        }
        let reach = self.law.uses_from(1.0) + CAP_REACH;
        let mut safe: f64 = 1.0;
        let mut look = |at: u64| {
            let entry = self.track.get(at);
            safe = safe.min(caps.rate(&entry.terms, entry.speed));
        };
        look(x.at);
        if direction >= 0.0 || x.rate.r > 0.0 {
            let mut at = x.at + 1;
            while at < self.track.next() && self.track.get(at).begin <= x.tau + reach {
                look(at);
                at += 1;
            }
        }
        if direction < 0.0 || x.rate.r < 0.0 {
            let mut at = x.at;
            while at > self.track.first() && self.track.get(at).begin >= x.tau - reach {
                at -= 1;
                look(at);
            }
        }
        (safe, reach)
    }

    /// The change of the next step, and where it leads.
    pub(crate) fn step(&mut self, x: State, aim: &Aim) -> (f64, Reached) {
        // Higher caps concern no way that was found; lower ones only from the first way on that keeps them.
        let proven = Caps {
            feed: self.proven.feed.max(aim.caps.feed),
            rapid: self.proven.rapid.max(aim.caps.rapid),
            ..aim.caps
        };
        let standing = x.rate.r.abs() <= 0.0 && x.rate.s.abs() <= 0.0;
        self.proven = if standing { aim.caps } else { proven };
        if !aim.promised || standing {
            self.left = f64::INFINITY;
        } else if self.left.is_infinite() {
            self.left = self.promise();
        }
        let change = self.change(&x, aim);
        if aim.promised {
            self.left -= 1.0;
        }
        match change {
            Some((u, reached)) => (u, self.tidy(reached, aim.c)),
            None => {
                self.infeasible += 1;
                self.backup.settle_at(0.0);
                let state = State {
                    rate: Rate { r: 0.0, s: 0.0 },
                    ..x
                };
                let took = self.bounds.step;
                let rest = false;
                (0.0, Reached { state, took, rest })
            }
        }
    }

    /// The state reached, at the wanted rate exactly when it has come to it.
    fn tidy(&mut self, mut reached: Reached, c: f64) -> Reached {
        reached.state = settled(reached.state, self.bounds.step);
        reached.state.rate = snapped(reached.state.rate, c, self.bounds.step);
        reached
    }

    fn change(&mut self, x: &State, aim: &Aim) -> Option<(f64, Reached)> {
        if aim.follow && self.backup.next().is_some() {
            return self.stored(x);
        }
        let lower = self.proven != aim.caps;
        let wanted = self.safe_rate(x, &aim.caps, aim.c);
        if self.lawful {
            let away = aim.c.abs() > 0.0 || !aim.promised;
            let side = 1.0_f64.copysign(aim.c - x.rate.r);
            if !(away && self.accept(x, Course { side, c: aim.c }, &aim.caps, wanted, x)) {
                return self.by_law(x);
            }
            self.lawful = false;
            self.share = SMALLEST;
        }
        let share = self.share;
        let gap = aim.c - x.rate.r;
        if gap.abs() <= 0.0 && x.rate.s.abs() <= 0.0 {
            if self.ground(&aim.caps, wanted, x).goes_on(x) {
                self.proven = aim.caps;
                self.backup.settle_at(x.rate.r);
                return self.bounds.drift(&self.track, x, 0.0).map(|to| (0.0, to));
            }
        } else {
            let found = self.landed(x, aim.c, &aim.caps, wanted);
            if found.is_some() {
                self.proven = aim.caps;
                return found;
            }
            if let Some(found) = self.toward(x, aim, &aim.caps, wanted) {
                self.proven = aim.caps;
                return Some(found);
            }
        }
        if lower {
            let proven = self.proven;
            let safe = self.safe_rate(x, &proven, aim.c);
            // Anything slower than the way that is stored; the search begins where it left off.
            self.share = share;
            let r = x.rate.r;
            let slower = Aim {
                c: if aim.c * r > 0.0 {
                    aim.c.abs().min(wanted.0).min(r.abs()).copysign(r)
                } else {
                    0.0
                },
                ..*aim
            };
            if let Some(found) = self.toward(x, &slower, &proven, safe) {
                return Some(found);
            }
        }
        if self.backup.next().is_some() {
            return self.stored(x);
        }
        let proven = self.proven;
        let safe = self.safe_rate(x, &proven, aim.c);
        let late = aim.promised && self.left < self.law.steps_from(x.rate.r) + 1.0;
        if !late && self.ground(&proven, safe, x).goes_on(x) {
            return self.bounds.drift(&self.track, x, 0.0).map(|to| (0.0, to));
        }
        self.lawful = true;
        self.by_law(x)
    }

    fn ground<'a>(&'a self, caps: &'a Caps, (safe, reach): (f64, f64), x: &State) -> Ground<'a, N> {
        Ground {
            track: &self.track,
            bounds: &self.bounds,
            law: &self.law,
            caps: (!caps.open()).then_some(caps),
            safe,
            from: x.tau,
            reach,
            gain: 1.0,
        }
    }

    /// Looks for the way out of `to`; keeps it when there is one.
    fn accept(
        &mut self,
        to: &State,
        course: Course,
        caps: &Caps,
        (safe, reach): (f64, f64),
        x: &State,
    ) -> bool {
        let mut ground = Ground {
            track: &self.track,
            bounds: &self.bounds,
            law: &self.law,
            caps: (!caps.open()).then_some(caps),
            safe,
            from: x.tau,
            reach,
            gain: self.gain,
        };
        if ground.way_out(*to, course, &mut self.scratch) {
            self.gain = (self.gain * MORE).min(GAINS.1);
        } else {
            self.gain = (self.gain * LESS).max(GAINS.0);
            ground.gain = SECOND;
            if safe >= 1.0 || !ground.way_out(*to, course, &mut self.scratch) {
                return false;
            }
        }
        if self.left.is_finite() {
            let need = self.scratch.steps() + self.law.steps_from(self.scratch.rate);
            if need > self.left - 1.0 {
                return false;
            }
        }
        core::mem::swap(&mut self.scratch, &mut self.backup);
        true
    }

    /// The first of the two steps that reach the wanted rate exactly.
    fn landed(
        &mut self,
        x: &State,
        c: f64,
        caps: &Caps,
        safe: (f64, f64),
    ) -> Option<(f64, Reached)> {
        let (first, second) = landing(x.rate, c, self.bounds.step)?;
        let some = (!caps.open()).then_some(caps);
        let (bounds, track) = (&self.bounds, &self.track);
        let to = bounds.check(track, x, first, some)?;
        if to.rest {
            self.backup.settle_at(0.0);
            return Some((first, to));
        }
        let last = bounds.check(track, &to.state, second, some)?;
        let mut end = settled(last.state, bounds.step);
        end.rate = snapped(end.rate, c, bounds.step);
        if end.rate.s.abs() > 0.0 || !(last.rest || self.ground(caps, safe, x).goes_on(&end)) {
            return None;
        }
        self.backup.settle_at(if last.rest { 0.0 } else { c });
        self.backup.tau = end.tau;
        if settled(to.state, self.bounds.step).rate.s.abs() > 0.0 {
            self.backup.push(second);
        }
        Some((first, to))
    }

    /// The strongest change towards the wanted rate after which there is a way out.
    fn toward(
        &mut self,
        x: &State,
        aim: &Aim,
        caps: &Caps,
        safe: (f64, f64),
    ) -> Option<(f64, Reached)> {
        let h = self.bounds.step;
        let side = 1.0_f64.copysign(aim.c - x.rate.r);
        let some = (!caps.open()).then_some(*caps);
        let settle = self.backup.next().unwrap_or(0.0);
        let most = side * self.bounds.most();
        let search = if some.is_some() { CAPPED } else { FREE };
        let mut share = (self.share * search.grow).min(1.0);
        let mut top = None;
        for _ in 0..search.tries {
            let found = if share >= 1.0 {
                top = self.bounds.choose(&self.track, x, most, some.as_ref());
                top
            } else {
                if top.is_none() {
                    top = self.bounds.choose(&self.track, x, most, None);
                }
                let (top, _) = top?;
                let want = settle + share * (top - settle);
                self.bounds.choose(&self.track, x, want, some.as_ref())
            };
            if let Some((u, reached)) = found {
                if reached.rest {
                    self.backup.settle_at(0.0);
                    self.share = share;
                    return Some((u, reached));
                }
                let next = settled(reached.state, h);
                // While it still moves away nothing can be passed.
                let away = next.rate.s * side < 0.0;
                let c = if away { 2.0 * side } else { aim.c };
                if self.accept(&next, Course { side, c }, caps, safe, x) {
                    self.share = share;
                    return Some((u, reached));
                }
            }
            share *= search.shrink;
        }
        self.share = share.max(SMALLEST);
        None
    }

    /// The next change of the stored way.
    fn stored(&mut self, x: &State) -> Option<(f64, Reached)> {
        let u = self.backup.next()?;
        self.backup.advance();
        self.bounds.drift(&self.track, x, u).map(|to| (u, to))
    }

    /// The next change of the law for every plan.
    fn by_law(&mut self, x: &State) -> Option<(f64, Reached)> {
        let u = self.law.decide(x.rate, 0.0);
        self.backup.settle_at(x.rate.r);
        let reached = self.bounds.drift(&self.track, x, u)?;
        let end = snapped(reached.state.rate, 0.0, self.bounds.step);
        if reached.rest || (end.r.abs() <= 0.0 && end.s.abs() <= 0.0) {
            self.lawful = false;
        }
        Some((u, reached))
    }

    /// The rate at which a rest may be left at once: the one wanted, as far as the caps allow; `None` where none may.
    /// It does not change for a time `left` of the present step, behind which the stored way begins.
    pub(crate) fn start_rate(&mut self, x: &State, aim: &Aim, left: f64) -> Option<f64> {
        let safe = self.safe_rate(x, &aim.caps, aim.c);
        let side = 1.0_f64.copysign(aim.c);
        let lowest = aim.c.abs().min(safe.0);
        let course = Course {
            side,
            c: 2.0 * side,
        };
        // As fast as there is a way back to a rate that keeps the caps; at least that rate.
        let mut rate = aim.c.abs();
        loop {
            let start = State {
                rate: Rate {
                    r: rate.copysign(aim.c),
                    s: 0.0,
                },
                ..*x
            };
            if rate > 0.0 && self.starts(&start, left, course, &aim.caps, safe) {
                break;
            }
            if rate <= lowest {
                return None;
            }
            rate = (rate - START_STEP).max(lowest);
        }
        let rate = rate.copysign(aim.c);
        self.proven = aim.caps;
        Some(rate)
    }

    /// Whether the rate of a start may last for a time, and there is a way out of the state behind it.
    fn starts(
        &mut self,
        start: &State,
        left: f64,
        course: Course,
        caps: &Caps,
        safe: (f64, f64),
    ) -> bool {
        if left <= 0.0 {
            return self.accept(start, course, caps, safe, start);
        }
        let some = (!caps.open()).then_some(caps);
        match self.bounds.steady(&self.track, start, left, some) {
            Some(reached) if reached.rest => {
                self.backup.settle_at(0.0);
                true
            }
            Some(reached) => self.accept(&reached.state, course, caps, safe, start),
            None => false,
        }
    }
}
