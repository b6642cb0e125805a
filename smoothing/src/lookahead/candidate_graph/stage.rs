//! Holds the candidates of one corner and the fastest path to each of them.
//!
//! Source: ours, as the lattice. Not here: what is done with the columns.

use crate::lookahead::window::Link;
use toolglide_profiles::{BlendShape, SCurveBoundary};

/// Most candidates of one corner.
pub(crate) const MAX_CANDIDATES: usize = 8;

/// Share of a move that two corners must leave free, lest they are tried overlapping.
const OVERLAPPING: f64 = 2.0;

/// Times to stop by which a way that does not stop may lie behind the cheapest.
const STOPS_BEHIND: f64 = 4.0;

/// A corner, its candidates, and the cheapest way to each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stage {
    pub(super) shapes: [BlendShape; MAX_CANDIDATES],
    /// Time to the middle of the corner.
    pub(super) costs: [f64; MAX_CANDIDATES],
    pub(super) origins: [u8; MAX_CANDIDATES],
    /// Duration of the overlap in which the corner is reached; zero when it is reached on the move.
    pub(super) overlaps: [f64; MAX_CANDIDATES],
    pub(super) count: usize,
    /// How many of the candidates, the first ones, can always be followed by another.
    pub(super) safe: usize,
}

impl Stage {
    pub(super) fn empty() -> Self {
        Self {
            shapes: [BlendShape::STOP; MAX_CANDIDATES],
            costs: [f64::INFINITY; MAX_CANDIDATES],
            origins: [0; MAX_CANDIDATES],
            overlaps: [0.0; MAX_CANDIDATES],
            count: 0,
            safe: 0,
        }
    }

    /// Adds a candidate unless it is there already.
    pub(super) fn offer(&mut self, shape: BlendShape) {
        let known = self.shapes[..self.count].contains(&shape);
        if !known && self.count < MAX_CANDIDATES {
            self.shapes[self.count] = shape;
            self.count += 1;
        }
    }

    /// The stop; the cheapest safe one where none is offered.
    pub(super) fn stop(&self) -> usize {
        (0..self.safe)
            .find(|&candidate| self.shapes[candidate].is_stop())
            .unwrap_or_else(|| self.cheapest())
    }

    /// Gives up what lies too far behind the cheapest safe one, given the time in which the
    /// fastest could stop on a move like the last; never the stop, without which no bound on the whole would hold.
    pub(super) fn give_up(&mut self, link: &Link) {
        let cheapest = self.cheapest();
        let least = self.costs[cheapest];
        let speed = (0..self.count)
            .filter(|&candidate| self.costs[candidate].is_finite())
            .fold(0.0_f64, |most, candidate| {
                most.max(self.shapes[candidate].exit.speed)
            });
        let most = least + STOPS_BEHIND * link.limits.time_to_change(speed);
        for candidate in 0..self.count {
            if self.costs[candidate] > most && !self.shapes[candidate].is_stop() {
                self.costs[candidate] = f64::INFINITY;
            }
        }
    }

    /// The cheapest of those that can always be followed by another.
    pub(super) fn cheapest(&self) -> usize {
        let mut best = 0;
        for candidate in 1..self.safe {
            if self.costs[candidate] < self.costs[best] {
                best = candidate;
            }
        }
        best
    }

    /// Finds the cheapest way to each candidate over `link`; `overlap` is also told the duration beyond
    /// which it need not look.
    pub(super) fn reach_from(
        &mut self,
        last: &Self,
        link: &Link,
        overlap: impl Fn(&BlendShape, &BlendShape, f64) -> Option<f64>,
    ) {
        for candidate in 0..self.count {
            let to = self.shapes[candidate];
            // What looks cheapest comes first, so that little else has to be planned.
            let mut ways = [(f64::INFINITY, 0); MAX_CANDIDATES];
            for (origin, way) in ways.iter_mut().enumerate().take(last.count) {
                let from = &last.shapes[origin];
                *way = (last.costs[origin] + least_duration(from, &to, link), origin);
            }
            let ways = &mut ways[..last.count];
            ways.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
            let mut best = f64::INFINITY;
            for &(bound, origin) in &*ways {
                let from = &last.shapes[origin];
                let length = link.length - from.exit.distance - to.entry.distance;
                let before = last.costs[origin];
                let halves = 0.5 * (from.duration + to.duration);
                if length >= 0.0 && bound < best {
                    let connection = SCurveBoundary {
                        from: [from.exit.speed, from.exit.acceleration],
                        to: [to.entry.speed, to.entry.acceleration],
                        limits: link.limits,
                    };
                    if let Some(duration) = connection.duration_over(length) {
                        let cost = before + halves + duration;
                        if cost < best {
                            best = cost;
                            self.origins[candidate] = u8::try_from(origin).unwrap_or(0);
                            self.overlaps[candidate] = 0.0;
                        }
                    }
                }
                let short = length < OVERLAPPING * link.length;
                if short
                    && before < best
                    && let Some(duration) = overlap(from, &to, best - before)
                    && before + duration < best
                {
                    best = before + duration;
                    self.origins[candidate] = u8::try_from(origin).unwrap_or(0);
                    self.overlaps[candidate] = duration;
                }
            }
            self.costs[candidate] = best;
        }
    }
}

/// No way from the middle of one corner to the middle of the next takes less: the motion between them
/// without a limit of jerk.
fn least_duration(from: &BlendShape, to: &BlendShape, link: &Link) -> f64 {
    let length = (link.length - from.exit.distance - to.entry.distance).max(0.0);
    let limits = &link.limits;
    let (start, end) = (from.exit.speed, to.entry.speed);
    let squares = start * start + end * end;
    let peak = (limits.acceleration * length + 0.5 * squares)
        .sqrt()
        .min(limits.velocity)
        .max(start)
        .max(end);
    let changing = (2.0 * peak - start - end) / limits.acceleration;
    let changed = (peak * peak - 0.5 * squares) / limits.acceleration;
    let cruising = if peak > 0.0 {
        (length - changed).max(0.0) / peak
    } else {
        0.0
    };
    0.5 * (from.duration + to.duration) + changing + cruising
}
