//! Finds the part of a section that must be measured again after some of its blocks changed.
//!
//! Source: ours. A block that is slowed down shifts everything after it, which moves as before. Not here: the
//! measures, and what is done about them.

use crate::error::FiveAxisError;
use crate::output::pieces::{intervals, knots_within};
use crate::timing::commanded_progress::Steps;
use toolglide_fir::FilterChain;

/// Instants nearer than this are one, s.
const SAME_INSTANT: f64 = 1e-12;

/// Blocks in a row that have changed, or exceed a limit, with those under way at the same time.
pub(crate) struct Window {
    /// First and last block under way.
    range: [usize; 2],
    /// Last block that has changed.
    pub(crate) last: usize,
    begin: f64,
    end: f64,
}

impl Window {
    /// Hands on the intervals of the window with the blocks under way.
    pub(crate) fn measure(
        &self,
        steps: &[Steps],
        chain: &FilterChain,
        mut take: impl FnMut([f64; 2], [usize; 2]) -> Result<(), FiveAxisError>,
    ) -> Result<(), FiveAxisError> {
        let [low, high] = self.range;
        let steps = &steps[low..=high];
        let knots = knots_within(steps, chain, [self.begin, self.end]);
        for (interval, [oldest, newest]) in intervals(steps, &knots, chain) {
            take(interval, [oldest + low, newest + low])?;
        }
        Ok(())
    }
}

/// The next blocks to be measured, from `first` on.
pub(crate) fn next_window(
    fresh: &[bool],
    still: &[bool],
    first: usize,
    steps: &[Steps],
    chain: &FilterChain,
) -> Option<Window> {
    let delay = chain.total_delay();
    let wanted = |block: usize| fresh[block] || still[block];
    let start = (first..steps.len()).find(|&block| wanted(block))?;
    let begin = steps[start].begin();
    let mut low = start;
    while low > 0 && steps[low - 1].command_end() + delay > begin {
        low -= 1;
    }
    let (mut last, mut high) = (start, start);
    let mut end = steps[start].command_end() + delay;
    loop {
        while high + 1 < steps.len() && steps[high + 1].begin() < end {
            high += 1;
        }
        let Some(next) = (last + 1..=high).rev().find(|&block| wanted(block)) else {
            break;
        };
        last = next;
        end = end.max(steps[last].command_end() + delay);
    }
    Some(Window {
        range: [low, high],
        last,
        begin,
        end,
    })
}

/// Whether a block has changed in time but for when it begins, or the way to the next has.
pub(crate) fn differs(before: &[Steps], now: &[Steps], block: usize) -> bool {
    let (then, this) = (&before[block], &now[block]);
    let shifts = this.begin() - then.begin();
    let near = |one: f64, two: f64| (one - two - shifts).abs() <= SAME_INSTANT;
    let same = this.times().count() == then.times().count()
        && this
            .times()
            .zip(then.times())
            .all(|(now, then)| near(now, then));
    let next = match (now.get(block + 1), before.get(block + 1)) {
        (Some(now), Some(then)) => near(now.begin(), then.begin()),
        _ => true,
    };
    !(same && next)
}
