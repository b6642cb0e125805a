//! Stops and starts every plan in closed form, from the limits alone.
//!
//! Source: ours. A plan keeps (V, rho^2 A, rho^3 J) on every axis, the machine may use (V, A, J). Then, with `r` the
//! rate of planned time and `s` its derivative, `|s| <= k (1 - (rho r)^3)` can be settled and stopped whatever the plan
//! does, with `k = min((-A + sqrt(A^2 + 4 V J / 3)) / (2 V), 2 A / (3 V))`. Here the law runs in steps of constant `u = s'`,
//! for which `rho^3 r^3 + 3 rho^2 (A / J) r |s| + (V / J) |u| <= 1` and `rho^2 r^2 + (V / A) |s| <= 1` hold at every
//! instant when they hold at the worst end. Not here: the plan.

use crate::step::sqrt;

/// Rates of the table of stops.
const RATES: usize = 32;

/// Steps after which the law counts as one that never stops.
const MAX_STOP: u32 = 20_000;

/// Steps after which settling counts as impossible.
const MAX_SETTLE: u32 = 4_000;

/// Shares of the strongest change that are tried, the strongest first.
const SHARES: [f64; 7] = [1.0, 0.6, 0.36, 0.2, 0.1, 0.04, 0.01];

/// Rates nearer than this are reached in two steps, exactly.
const LANDING: f64 = 0.05;

/// Rounding of a rate, and of its derivative times the step.
pub(crate) const ROUNDING: f64 = 1e-12;

/// The largest quotients of the limits of the axes, which are all that the law knows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ratios {
    /// Largest acceleration by jerk, s.
    pub(crate) rise: f64,
    /// Largest planned velocity by jerk, s^2.
    pub(crate) by_jerk: f64,
    /// Largest planned velocity by acceleration, s.
    pub(crate) by_acceleration: f64,
}

/// Rate of planned time and its derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rate {
    /// Planned time by time.
    pub(crate) r: f64,
    /// Its derivative, 1/s.
    pub(crate) s: f64,
}

impl Rate {
    /// The rate a time `t` later, under `u`.
    #[inline]
    pub(crate) fn after(self, u: f64, t: f64) -> Self {
        Self {
            r: self.r + (self.s + 0.5 * u * t) * t,
            s: self.s + u * t,
        }
    }
}

/// The two changes that bring a rate to `c` exactly, at rest.
#[inline]
pub(crate) fn landing(at: Rate, c: f64, h: f64) -> Option<(f64, f64)> {
    let gap = c - at.r;
    (gap.abs() < LANDING).then(|| {
        let first = (gap - 1.5 * at.s * h) / (h * h);
        (first, -at.s / h - first)
    })
}

/// The law for every plan, in steps of constant length.
#[derive(Clone, Debug)]
pub(crate) struct Law {
    rho2: f64,
    rho3: f64,
    ratios: Ratios,
    /// The factor `k` of the law, 1/s.
    k: f64,
    step: f64,
    /// Steps to a stop from each rate of the table.
    steps: [f64; RATES + 1],
    /// Planned time used up meanwhile, s.
    uses: [f64; RATES + 1],
}

impl Law {
    /// The law for plans that keep `rho^2` of the acceleration and `rho^3` of the jerk.
    pub(crate) fn new(ratios: Ratios, rho: f64, step: f64) -> Self {
        let mut law = Self {
            rho2: rho * rho,
            rho3: rho * rho * rho,
            ratios,
            k: factor(&ratios),
            step,
            steps: [0.0; RATES + 1],
            uses: [0.0; RATES + 1],
        };
        for index in 1..=RATES {
            let (steps, used) = if law.steps[index - 1].is_finite() {
                law.stop(rate_of(index))
            } else {
                (f64::INFINITY, f64::INFINITY)
            };
            // Between two rates the larger one counts, so the table never falls.
            law.steps[index] = steps.max(law.steps[index - 1]);
            law.uses[index] = used.max(law.uses[index - 1]);
        }
        law
    }

    /// Steps to a stop from a rate that does not change, and planned time used up meanwhile, by running the law.
    fn stop(&self, rate: f64) -> (f64, f64) {
        let mut at = Rate { r: rate, s: 0.0 };
        let mut used = 0.0;
        for steps in 0..MAX_STOP {
            if at.r.abs() <= 0.0 && at.s.abs() <= 0.0 {
                return (f64::from(steps), used);
            }
            let u = self.decide(at, 0.0);
            let h = self.step;
            used += (at.r + (0.5 * at.s + u * h / 6.0) * h) * h;
            let next = snapped(at.after(u, h), 0.0, h);
            if next == at {
                break;
            }
            at = next;
        }
        (f64::INFINITY, f64::INFINITY)
    }

    /// Largest acceleration by jerk, s: about the time to settle.
    pub(crate) fn rise(&self) -> f64 {
        self.ratios.rise
    }

    /// Largest derivative of the rate that can be settled at a rate whatever the plan does, 1/s.
    #[inline]
    pub(crate) fn slope(&self, rate: f64) -> f64 {
        self.k * (1.0 - self.rho3 * rate * rate * rate).max(0.0)
    }

    /// Steps in which a rate that does not change is brought to 0.
    pub(crate) fn steps_from(&self, rate: f64) -> f64 {
        above(&self.steps, rate) + f64::from(u8::from(rate.abs() > 0.0))
    }

    /// Planned time that is used up meanwhile, s.
    pub(crate) fn uses_from(&self, rate: f64) -> f64 {
        above(&self.uses, rate)
    }

    /// The change nearest to `want` for which the worst plan keeps every limit over a step.
    #[inline]
    fn reach(&self, at: Rate, want: f64) -> Option<f64> {
        let (h, n) = (self.step, &self.ratios);
        let settling = want * at.s <= 0.0 && (want * h).abs() <= at.s.abs() * (1.0 + ROUNDING);
        let mut fastest = at.r.abs().max(at.after(0.0, h).r.abs());
        let mut most = f64::INFINITY;
        for _ in 0..2 {
            let left = 1.0
                - self.rho3 * fastest * fastest * fastest
                - 3.0 * self.rho2 * n.rise * fastest * at.s.abs();
            if left < 0.0 {
                return None;
            }
            let growth = if settling {
                0.0
            } else {
                3.0 * self.rho2 * n.rise * fastest * h
            };
            most = left / (n.by_jerk + growth);
            let used = most.min(want.abs());
            fastest = fastest.max((at.after(0.0, h).r.abs()) + 0.5 * used * h * h);
            if settling {
                break;
            }
        }
        let top = (1.0 - self.rho2 * fastest * fastest) / n.by_acceleration;
        if top < 0.0 {
            return None;
        }
        let u = if settling {
            want.clamp(-most, most)
        } else {
            let (low, high) = ((-most).max((-top - at.s) / h), most.min((top - at.s) / h));
            if low > high {
                return None;
            }
            want.clamp(low, high)
        };
        (at.after(u, h).r.abs() <= 1.0 + ROUNDING).then_some(u)
    }

    /// Whether `s` can be brought to 0 whatever the plan does, without passing `c` on the way.
    fn settles(&self, mut at: Rate, side: f64, c: f64) -> bool {
        for _ in 0..MAX_SETTLE {
            if (c - at.r) * side < -ROUNDING {
                return false;
            }
            if at.s.abs() <= 0.0 {
                return true;
            }
            let want = -at.s / self.step;
            let Some(u) = self.reach(at, want) else {
                return false;
            };
            let exact = u.to_bits() == want.to_bits();
            at = at.after(u, self.step);
            if exact {
                at.s = 0.0;
            }
        }
        false
    }

    /// The change of the next step that brings the rate towards `c`, whatever the plan does.
    pub(crate) fn decide(&self, at: Rate, c: f64) -> f64 {
        let h = self.step;
        let gap = c - at.r;
        if at.s.abs() <= 0.0 && gap.abs() <= 0.0 {
            return 0.0;
        }
        if let Some((first, second)) = landing(at, c, h)
            && self.reach(at, first).is_some_and(|u| near(u, first))
            && self
                .reach(at.after(first, h), second)
                .is_some_and(|u| near(u, second))
        {
            return first;
        }
        let side = 1.0_f64.copysign(gap);
        let settle = self.reach(at, -at.s / h).unwrap_or(0.0);
        let most = 0.1 / (h * h);
        for share in SHARES {
            let Some(top) = self.reach(at, side * most) else {
                break;
            };
            let Some(u) = self.reach(at, settle + share * (top - settle)) else {
                continue;
            };
            let next = at.after(u, h);
            // While it still moves away nothing can be passed.
            let bound = if next.s * side < 0.0 { 2.0 * side } else { c };
            if self.settles(next, side, bound) {
                return u;
            }
        }
        settle
    }
}

/// The factor `k` of the law, 1/s.
fn factor(n: &Ratios) -> f64 {
    let root = sqrt(n.rise * n.rise + 4.0 / 3.0 * n.by_jerk);
    ((root - n.rise) / (2.0 * n.by_jerk)).min(2.0 / (3.0 * n.by_acceleration))
}

/// A rate that has come to `c`, exactly.
#[inline]
pub(crate) fn snapped(mut at: Rate, c: f64, h: f64) -> Rate {
    if at.s.abs() * h < ROUNDING {
        at.s = 0.0;
        if (at.r - c).abs() < 100.0 * ROUNDING {
            at.r = c;
        }
    }
    at
}

#[inline]
pub(crate) fn near(u: f64, wanted: f64) -> bool {
    (u - wanted).abs() < 1e-9 * (1.0 + wanted.abs())
}

#[allow(clippy::cast_precision_loss, reason = "a small index")]
fn rate_of(index: usize) -> f64 {
    index as f64 / RATES as f64
}

/// Value of a table at a rate, on the straight line between its entries.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a small index that is not negative"
)]
fn above(table: &[f64; RATES + 1], rate: f64) -> f64 {
    let place = rate.abs().min(1.0) * RATES as f64;
    let below = (place as usize).min(RATES - 1);
    let share = place - below as f64;
    let (low, high) = (table[below], table[below + 1]);
    if share <= 0.0 {
        low
    } else if below == 0 {
        high // the time to a stop rises steeply from 0
    } else {
        low + (high - low) * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ratios(velocity: f64, acceleration: f64, jerk: f64) -> Ratios {
        Ratios {
            rise: acceleration / jerk,
            by_jerk: velocity / jerk,
            by_acceleration: velocity / acceleration,
        }
    }

    /// The closed form of the time to a stop, s.
    fn formula(velocity: f64, acceleration: f64, jerk: f64, rho: f64) -> f64 {
        let a = acceleration;
        let k = ((-a + (a * a + 4.0 * velocity * jerk / 3.0).sqrt()) / (2.0 * velocity))
            .min(2.0 * a / (3.0 * velocity));
        let q = rho;
        let root = 3.0_f64.sqrt();
        (-(1.0 - q).ln() / 3.0
            + (1.0 + q + q * q).ln() / 6.0
            + (((2.0 * q + 1.0) / root).atan() - core::f64::consts::FRAC_PI_6) / root)
            / (k * rho)
    }

    #[test]
    fn the_law_stops_within_its_closed_form_on_machines_of_every_size() {
        for (velocity, acceleration, jerk) in [
            (100.0, 2000.0, 5e4),
            (100.0, 2500.0, 2e5),
            (500.0, 2500.0, 2e5),
            (400.0, 2500.0, 1.2e5),
            (1000.0, 1e4, 1e6),
        ] {
            for rho in [0.95, 0.98, 0.99, 0.995, 0.999] {
                let law = Law::new(ratios(velocity, acceleration, jerk), rho, 0.001);
                let stop = 0.001 * law.steps[RATES];
                let bound = formula(velocity, acceleration, jerk, rho) + 0.002;
                assert!(stop <= bound, "{velocity} {rho}: {stop} > {bound}");
            }
        }
    }

    #[test]
    fn a_plan_without_a_reserve_has_no_stop_that_is_promised() {
        let law = Law::new(ratios(100.0, 2000.0, 5e4), 1.0, 0.001);
        assert!(law.steps_from(1.0).is_infinite(), "locked");
        assert!(
            law.steps_from(0.5).is_finite(),
            "below full rate there is slack"
        );
    }

    #[test]
    fn a_stop_from_a_rate_between_two_of_the_table_is_no_later() {
        let law = Law::new(ratios(100.0, 2000.0, 5e4), 0.99, 0.001);
        for index in 0..400 {
            let rate = (f64::from(index) + 0.5) / 400.0;
            let (steps, used) = law.stop(rate);
            assert!(steps <= law.steps_from(rate) + 1.0, "{rate}: {steps}");
            assert!(used <= law.uses_from(rate) + 0.002, "{rate}: {used}");
        }
    }
}
