//! Chooses the filters of some moves between two rests by trying.
//!
//! Source: ours. Two filters and the pulse of a straight move from rest to rest are three averages in a row: they
//! are its fastest motion where the pulse lasts as long as its velocity asks for, the longer filter as long as the
//! acceleration, and the shorter as long as the jerk. Where moves bend or corners are passed, no such rule holds, and
//! pairs are tried: first how long, then in which ratio, then whether a little more or less is better. Not
//! here: what the moves take.

use super::row::Section;
use crate::axis_limits::axis_path::Slopes;
use crate::axis_limits::slow_down::AIM;
use crate::pose::joint::JointBlock;
use crate::settings::PoseSettings;
use toolglide_fir::FilterChain;
use toolglide_kinematics::{Axis, SamplePeriod};

/// Longer filters that are tried, s, the shorter one as a share of each.
const LONGER: [f64; 6] = [0.02, 0.03, 0.05, 0.08, 0.12, 0.2];
const SHORTER: f64 = 0.35;

/// Shares of the longer filter that the shorter one may have.
const SHARES: [f64; 4] = [0.12, 0.22, 0.5, 0.7];

/// By what the best pair is made longer and shorter at last.
const NEAR: [f64; 2] = [0.8, 1.25];

/// Share of a period that is added to lengths that are the least before they are rounded.
const AS_SHORT: f64 = 0.49;

/// Chains to try, one after the other.
pub(super) struct Choice<'a> {
    settings: &'a PoseSettings,
    own: Vec<[f64; 2]>,
    tried: Vec<[u64; 2]>,
    number: usize,
}

impl<'a> Choice<'a> {
    pub(super) fn new(settings: &'a PoseSettings, axes: &[Axis], row: &[Section]) -> Self {
        let own = match settings.choice() {
            Some(_) => own(axes, row),
            None => Vec::new(),
        };
        Self {
            settings,
            own,
            tried: Vec::new(),
            number: 0,
        }
    }

    /// Chains for a straight move of axes from rest to rest.
    pub(super) fn of_straight(
        settings: &'a PoseSettings,
        axes: &[Axis],
        block: &JointBlock,
    ) -> Self {
        let spans = block.start.iter().zip(block.end.iter());
        let slopes: Vec<Slopes> = spans
            .map(|(start, end)| [(end - start).abs(), 0.0, 0.0])
            .collect();
        let own = match settings.choice() {
            Some(_) => of_straight(axes, &slopes, block.duration),
            None => None,
        };
        Self {
            settings,
            own: own.into_iter().flat_map(with_coinciding_ramps).collect(),
            tried: Vec::new(),
            number: 0,
        }
    }

    /// The next chain, after the pair that was best so far; `None` when there is none left to try.
    pub(super) fn next(&mut self, best: Option<&[f64]>) -> Option<FilterChain> {
        let Some(period) = self.settings.choice() else {
            self.number += 1;
            return (self.number == 1).then(|| self.settings.chain().clone());
        };
        loop {
            let number = self.number;
            self.number += 1;
            let (first, second) = match best {
                Some(&[first, second]) => (first, second),
                _ => (LONGER[2], 0.5 * LONGER[2]),
            };
            let own = self.own.len();
            let shares = own + LONGER.len();
            let near = shares + SHARES.len();
            // Filters that are too short by a moment cost more than those that are too long by a period.
            let pair = if number < own {
                self.own[number].map(|length| length + AS_SHORT * period.seconds())
            } else if number < shares {
                let longer = LONGER[number - own];
                [longer, SHORTER * longer]
            } else if number < near {
                [first, SHARES[number - shares] * first]
            } else if number < near + NEAR.len() {
                [first, second].map(|length| NEAR[number - near] * length)
            } else {
                return None;
            };
            let pair = pair.map(|length| ticks(length, period));
            if self.tried.contains(&pair) {
                continue;
            }
            self.tried.push(pair);
            let lengths = pair.map(|ticks| whole(ticks) * period.seconds());
            if let Ok(chain) = FilterChain::with_time_constants(&lengths) {
                return Some(chain);
            }
        }
    }
}

/// Periods that a filter lasts: one at least.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a filter lasts from one period to some millions, and the cast saturates"
)]
fn ticks(length: f64, period: SamplePeriod) -> u64 {
    (length / period.seconds()).round().max(1.0) as u64
}

#[allow(
    clippy::cast_precision_loss,
    reason = "filters last less than 2^53 periods"
)]
fn whole(ticks: u64) -> f64 {
    ticks as f64
}

/// The pairs with which the moves would be fastest alone and straight: the longest and the shortest.
fn own(axes: &[Axis], row: &[Section]) -> Vec<[f64; 2]> {
    let slopes = row.iter().map(|section| {
        let way = &section.way;
        (section.block.duration, way.slopes())
    });
    let pairs = slopes.map(|(asked, slopes)| of_straight(axes, &slopes, asked));
    let mut longest: Option<[f64; 2]> = None;
    let mut shortest: Option<[f64; 2]> = None;
    for pair in pairs.flatten() {
        let sum = |pair: &[f64; 2]| pair[0] + pair[1];
        if longest.is_none_or(|other| sum(&pair) > sum(&other)) {
            longest = Some(pair);
        }
        if shortest.is_none_or(|other| sum(&pair) < sum(&other)) {
            shortest = Some(pair);
        }
    }
    [longest, shortest]
        .into_iter()
        .flatten()
        .flat_map(with_coinciding_ramps)
        .collect()
}

/// A pair, and the same where the ramps of a short move coincide.
fn with_coinciding_ramps(pair: [f64; 2]) -> [[f64; 2]; 2] {
    [pair, [pair[0], 2.0 * pair[1]]]
}

/// Filters of the fastest straight motion from rest to rest of axes that move at most so much for a share of 1,
/// and that has to last some time at least.
fn of_straight(axes: &[Axis], slopes: &[Slopes], asked: f64) -> Option<[f64; 2]> {
    let mut least = [asked, 0.0, 0.0];
    for (axis, [slope, ..]) in axes.iter().zip(slopes) {
        let limits = &axis.limits;
        let bounds = [limits.velocity(), limits.acceleration(), limits.jerk()];
        for (least, bound) in least.iter_mut().zip(bounds) {
            *least = least.max(slope / (AIM * bound));
        }
    }
    // The way is 1: with the pulse V long the rate is 1/V, the acceleration 1/(V T), the jerk 1/(V T S).
    let [mut pulse, acceleration, jerk] = least;
    if !(pulse > 0.0 && acceleration > 0.0 && jerk > 0.0) {
        return None;
    }
    let mut long = acceleration / pulse;
    if long > pulse {
        (pulse, long) = (acceleration.sqrt(), acceleration.sqrt());
    }
    let mut short = jerk / (pulse * long);
    if short > long {
        long = (jerk / pulse).sqrt();
        if long > pulse {
            long = jerk.cbrt();
        }
        short = long;
    }
    Some([long, short])
}
