//! Moves from rest to rest over a short way of planned time, exactly.
//!
//! Source: ours. The change of the rate is +U for m steps, -U for 2 m, +U for m; then the way is 2 U (m H)^3.

use crate::backup::{Backup, settled};
use crate::step::{Bounds, State};
use crate::track::Track;

/// Growth of the number of steps from one try to the next.
const GROWTH: f64 = 1.15;

/// Writes the changes of the move to `into`; `false` when the limits do not allow it in as many steps as this try has.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a small count that is not negative"
)]
pub(crate) fn micro_move<const N: usize>(
    bounds: &Bounds<N>,
    track: &Track<N>,
    from: &State,
    way: f64,
    tried: u32,
    into: &mut Backup,
) -> bool {
    let h = bounds.step;
    // The rate rises to way / (2 m h), at most 1.
    let least = (0.5 * way / h).max(1.0);
    let mut steps = least;
    for _ in 0..tried {
        steps = (steps * GROWTH).max(steps + 1.0);
    }
    let steps = (steps + 0.999) as u32;
    let half = f64::from(steps) * h;
    let strength = way / (2.0 * half * half * half);
    into.settle_at(0.0);
    let mut x = *from;
    for (sign, count) in [(1.0, steps), (-1.0, 2 * steps), (1.0, steps)] {
        for _ in 0..count {
            let u = sign * strength;
            match bounds.check(track, &x, u, None) {
                Some(reached) if !reached.rest && into.push(u) => {
                    x = settled(reached.state, h);
                    if x.rate.r < 0.0 {
                        x.rate.r = 0.0;
                    }
                }
                _ => {
                    into.settle_at(0.0);
                    return false;
                }
            }
        }
    }
    true
}
