//! Schedules when every block of a section begins, for each method.
//!
//! Source: sections 5.3.1 and 5.3.2. A stretch is what is planned between two rests. Not here: more
//! than two blocks at once, see `accumulate`.

pub(crate) mod accumulate;
pub(crate) mod commanded_progress;
pub(crate) mod pulses;

use crate::pose::block::PoseBlock;
use crate::pose::corner::PoseCorner;
use crate::settings::PoseMethod;
use accumulate::settle;
use commanded_progress::Steps;
use toolglide_fir::FilterChain;

/// The corners of a stretch: one between any two blocks in a row.
///
/// A block that moves no tip, or turns no tool, leaves the corner of that kind to the next block that
/// does.
pub(crate) fn corners(blocks: &[PoseBlock]) -> Vec<PoseCorner> {
    let mut tip_before = 0;
    let mut turn_before = 0;
    let mut corners = Vec::with_capacity(blocks.len().saturating_sub(1));
    for (index, pair) in blocks.windows(2).enumerate() {
        if pair[0].length > 0.0 {
            tip_before = index;
        }
        if pair[0].turn.amount() > 0.0 {
            turn_before = index;
        }
        corners.push(PoseCorner::of_parts(
            [&blocks[tip_before], &pair[1]],
            [&blocks[turn_before], &pair[1]],
        ));
    }
    corners
}

/// Whether a block is the next part of the same move, so that nothing stops, slows down or leaves its path
/// between them.
pub(crate) fn goes_on(before: &PoseBlock, after: &PoseBlock) -> bool {
    before.leg == after.leg
}

/// Steps of all blocks, from time 0 on. Every corner is taken as gently as its scale says, from 1 down
/// to 0; blocks may be slowed down where many corners are close. Overlaps stay as they were where no
/// block and no corner has changed.
pub(crate) fn time(
    blocks: &mut [PoseBlock],
    corners: &[PoseCorner],
    scales: &[f64],
    method: PoseMethod,
    chain: &FilterChain,
    changed: &[bool],
    overlaps: &mut [f64],
) -> Vec<Steps> {
    match method {
        PoseMethod::PointToPoint => {
            for (overlap, pair) in overlaps.iter_mut().zip(blocks.windows(2)) {
                *overlap = if goes_on(&pair[0], &pair[1]) {
                    chain.total_delay()
                } else {
                    0.0
                };
            }
        }
        PoseMethod::DwellControlled => settle(blocks, corners, scales, chain, changed, overlaps),
        PoseMethod::VelocityControlled => return slow(blocks, corners, scales, chain),
        PoseMethod::JointSpace { .. } => overlaps.fill(chain.total_delay()),
    }
    schedule(blocks, overlaps, chain)
}

/// One pulse a block, with the dwells that the overlaps leave between them.
fn schedule(blocks: &[PoseBlock], overlaps: &[f64], chain: &FilterChain) -> Vec<Steps> {
    let mut start = 0.0;
    blocks
        .iter()
        .enumerate()
        .map(|(index, block)| {
            let steps = Steps::pulse(start, block.duration);
            let dwell = overlaps
                .get(index)
                .map_or(0.0, |overlap| chain.total_delay() - overlap);
            start += block.duration + dwell;
            steps
        })
        .collect()
}

/// Up to three pulses a block: slow for half the delay of the chain on each side of a corner.
fn slow(
    blocks: &[PoseBlock],
    corners: &[PoseCorner],
    scales: &[f64],
    chain: &FilterChain,
) -> Vec<Steps> {
    let half = 0.5 * chain.total_delay();
    let mut time = 0.0;
    blocks
        .iter()
        .enumerate()
        .map(|(index, block)| {
            let share = |corner: usize| {
                let at = corners.get(corner)?;
                if goes_on(&blocks[corner], &blocks[corner + 1]) {
                    return None;
                }
                Some(scales[corner] * at.slow_share(block, chain))
            };
            let before = index.checked_sub(1).and_then(share);
            let after = share(index);
            // What the slow pulses do not cover at full rate.
            let used = half * (before.unwrap_or(0.0) + after.unwrap_or(0.0));
            let scale = (block.duration / used).min(1.0);
            let rate = 1.0 / block.duration;
            let mut steps = Steps::default();
            let mut current = 0.0;
            let mut pulse = |level: f64, lasts: f64| {
                if lasts > 0.0 {
                    steps.push(time, level - current);
                    current = level;
                    time += lasts;
                }
            };
            if let Some(before) = before {
                pulse(before * scale * rate, half);
            }
            pulse(rate, (block.duration - used).max(0.0));
            if let Some(after) = after {
                pulse(after * scale * rate, half);
            }
            let end = -current;
            steps.push(time, end);
            steps
        })
        .collect()
}
