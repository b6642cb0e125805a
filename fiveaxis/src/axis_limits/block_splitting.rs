//! Splits a block where one part of it must be much slower than the rest.
//!
//! Source: ours. Beside a pole an axis turns half around while the tool turns by a few thousandths; without a
//! cut the whole block would be as slow. Not here: how slow, see `relax`.

use crate::axis_limits::axis_path::AxisPaths;
use crate::pose::block::PoseBlock;
use toolglide_fir::FilterChain;
use toolglide_kinematics::Axis;

/// A block is cut where its parts alone take less than this share of its time.
const WORTH_CUTTING: f64 = 0.7;

/// Parts whose times for a share of 1 differ by less than this factor stay together.
const ALIKE: f64 = 2.0;

/// Shortest duration of what is cut off, as a share of the delay of the chain.
const SHORTEST_CUT: f64 = 0.25;

impl AxisPaths {
    /// Shares at which a block of a given duration is better cut, because a part of it, as beside a pole,
    /// must be much slower than the rest.
    pub(crate) fn cuts(&self, axes: &[Axis], asked: f64, chain: &FilterChain) -> Vec<f64> {
        let mut begin = 0.0;
        let mut paces = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            let mut pace = asked;
            for (limits, [first, second, third]) in axes.iter().zip(part.most) {
                let limits = &limits.limits;
                pace = pace
                    .max(first / limits.velocity())
                    .max((second / limits.acceleration()).sqrt())
                    .max((third / limits.jerk()).cbrt());
            }
            paces.push((pace, part.end - begin));
            begin = part.end;
        }
        let slowest = paces.iter().map(|(pace, _)| *pace).fold(0.0, f64::max);
        let each: f64 = paces.iter().map(|(pace, share)| pace * share).sum();
        let mut cuts = Vec::new();
        if each > WORTH_CUTTING * slowest {
            return cuts;
        }
        let shortest = SHORTEST_CUT * chain.total_delay();
        let (mut least, mut most, mut width) = (f64::INFINITY, 0.0_f64, 0.0);
        for ((pace, share), part) in paces.iter().zip(&self.parts) {
            let alike = *pace <= ALIKE * least && ALIKE * *pace >= most;
            if width > 0.0 && !alike && most * width >= shortest {
                cuts.push(part.end - share);
                (least, most, width) = (f64::INFINITY, 0.0, 0.0);
            }
            (least, most, width) = (least.min(*pace), most.max(*pace), width + share);
        }
        cuts
    }
}

impl PoseBlock {
    /// The part of the block from one share of it to another.
    pub(crate) fn part(&self, from: f64, to: f64) -> Self {
        Self {
            start: self.tip(from),
            end: self.tip(to),
            length: self.length * (to - from),
            turn: self.turn.part(from, to),
            duration: self.duration * (to - from),
            ..*self
        }
    }
}
