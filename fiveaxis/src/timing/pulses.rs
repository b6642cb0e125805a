//! Bounds the deviation of many overlapping pulses at every corner.
//!
//! Source: ours, as `accumulate` says. Not here: what is done about a sum above its tolerance.

use crate::pose::corner::PoseCorner;
use toolglide_fir::FilterChain;

/// Steps in finding when the motion is at a corner.
const STEPS: u32 = 60;

/// Pulses in time.
pub(crate) struct Pulses<'a> {
    pub(crate) chain: &'a FilterChain,
    /// When each pulse begins, s.
    pub(crate) starts: &'a [f64],
    /// How long each lasts, s.
    pub(crate) durations: &'a [f64],
}

impl Pulses<'_> {
    /// Filtered share of a block that is done.
    fn done(&self, block: usize, time: f64) -> f64 {
        let since = time - self.starts[block];
        let duration = self.durations[block];
        if since <= 0.0 {
            0.0
        } else if since >= duration + self.chain.total_delay() {
            1.0
        } else {
            (self.chain.position(since) - self.chain.position(since - duration)) / duration
        }
    }

    fn rate(&self, block: usize, time: f64) -> f64 {
        let since = time - self.starts[block];
        let duration = self.durations[block];
        (self.chain.velocity(since) - self.chain.velocity(since - duration)) / duration
    }

    /// The bound when the motion is at each corner that turns: sum, tolerance, and what each
    /// corner adds.
    pub(crate) fn each_sum(
        &self,
        amounts: &[f64],
        corners: &[PoseCorner],
        of: impl Fn(&PoseCorner) -> (f64, f64),
        mut visit: impl FnMut(f64, f64, &[(usize, f64)]),
    ) {
        let delay = self.chain.total_delay();
        let count = amounts.len();
        let mut parts = Vec::new();
        let mut done = Vec::new();
        let mut oldest = 0;
        for (index, corner) in corners.iter().enumerate() {
            let (turn, tolerance) = of(corner);
            if turn <= 0.0 {
                continue;
            }
            let begin = self.starts[index] + self.durations[index];
            while self.starts[oldest] + self.durations[oldest] + delay <= begin && oldest < index {
                oldest += 1;
            }
            let latest = self.starts[index + 1] + delay;
            let mut newest = index + 1;
            while newest + 1 < count && self.starts[newest + 1] < latest {
                newest += 1;
            }
            // What is done beyond the corner equals what is lacking before it.
            let surplus = |time: f64| {
                (oldest..=newest)
                    .map(|block| {
                        let done = self.done(block, time);
                        amounts[block] * if block <= index { done - 1.0 } else { done }
                    })
                    .sum::<f64>()
            };
            let (mut low, mut high) = (begin.min(latest), latest);
            let mut time = 0.5 * (low + high);
            for _ in 0..STEPS {
                let value = surplus(time);
                if value >= 0.0 {
                    high = time;
                } else {
                    low = time;
                }
                let slope: f64 = (oldest..=newest)
                    .map(|block| amounts[block] * self.rate(block, time))
                    .sum();
                let mut next = time - value / slope;
                if !(next > low && next < high) {
                    next = 0.5 * (low + high);
                }
                if (next - time).abs() <= 1e-12 * delay {
                    break;
                }
                time = next;
            }
            done.clear();
            done.extend((oldest..=newest).map(|block| amounts[block] * self.done(block, time)));
            let mut beyond: f64 = done.iter().skip(1).sum();
            let mut lacking = 0.0;
            let mut sum = 0.0;
            parts.clear();
            for block in oldest..newest {
                lacking += amounts[block] - done[block - oldest];
                let (turn, _) = of(&corners[block]);
                let part = turn * beyond.max(0.0).min(lacking.max(0.0));
                beyond -= done[block + 1 - oldest];
                sum += part;
                parts.push((block, part));
            }
            visit(sum, tolerance, &parts);
        }
    }
}
