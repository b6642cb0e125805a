//! Adds up the deviations of corners that short blocks pass at the same time.
//!
//! Source: ours. With `E` the filtered length of path, the motion is no farther from the point of the
//! path at `E` than the sum over all corners of `turn * min(A, B)`, where `A` is what is done beyond
//! the corner and `B` what is lacking before it. The sum is largest where `E` is at a corner. The
//! same sum over angles bounds the orientation wherever it was tried, without a proof. Blocks of
//! which no two corners overlap need none of this. Not here: single corners, see `corner`.

use crate::pose::block::PoseBlock;
use crate::pose::corner::PoseCorner;
use crate::timing::pulses::Pulses;
use toolglide_fir::FilterChain;

/// Rounds of adjusting before what cannot fail is taken instead.
const ROUNDS: u32 = 60;

/// A sum above its tolerance by this share is small enough: the judge finds the motion itself to be
/// nearer than the sum.
const CLOSE_ENOUGH: f64 = 1.0;

/// What a round aims at, as a share of the tolerance, so that the rounds come to an end.
const AIM: f64 = 0.998;

/// Corners that turn less than this may be passed without any dwell at a lower feedrate, as twice the
/// sine of half the turn: 30 degrees.
const GENTLE: f64 = 0.517_638;

/// A corner that adds less than this share of the tolerance is left as it is.
const MINOR: f64 = 0.02;

/// How much a corner turns, and its tolerance.
type Turning = fn(&PoseCorner) -> (f64, f64);

/// How corners are chosen that are slowed down for instead of dwelling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rule {
    /// Where slowing down costs less than dwelling.
    Cost,
    /// Where blocks are much shorter than the delay of the chain.
    Dense,
}

/// Overlaps at all corners, inside both tolerances; blocks become slower where that costs less.
///
/// Only what is near a block or a corner that has changed is settled again.
pub(crate) fn settle(
    blocks: &mut [PoseBlock],
    corners: &[PoseCorner],
    scales: &[f64],
    chain: &FilterChain,
    changed: &[bool],
    overlaps: &mut [f64],
) {
    let delay = chain.total_delay();
    // A block as long as the delay keeps what is before it from what is after it.
    let mut first = 0;
    while first + 1 < blocks.len() {
        let mut last = first + 1;
        while last + 1 < blocks.len() && blocks[last].duration < delay {
            last += 1;
        }
        if changed[first..=last].iter().any(|changed| *changed) {
            for index in first..last {
                let [before, after] = [&blocks[index], &blocks[index + 1]];
                overlaps[index] = scales[index] * corners[index].overlap(before, after, chain);
            }
            let crowded = (first + 1..last).any(|index| {
                overlaps[index - 1] + overlaps[index] > blocks[index].duration + delay
            });
            if crowded {
                let run = Run {
                    corners: &corners[first..last],
                    scales: &scales[first..last],
                    chain,
                };
                run.settle(&mut blocks[first..=last], &mut overlaps[first..last]);
            }
        }
        first = last;
    }
}

/// Short blocks in a row, with a long one, or none, on either side.
struct Run<'a> {
    corners: &'a [PoseCorner],
    scales: &'a [f64],
    chain: &'a FilterChain,
}

/// Durations of blocks and overlaps of corners.
struct Proposal {
    durations: Vec<f64>,
    overlaps: Vec<f64>,
}

impl Proposal {
    fn total(&self) -> f64 {
        self.durations.iter().sum::<f64>() - self.overlaps.iter().sum::<f64>()
    }
}

impl Run<'_> {
    fn settle(&self, blocks: &mut [PoseBlock], overlaps: &mut [f64]) {
        let mut best = self.isolated(blocks, overlaps);
        for rule in [Rule::Cost, Rule::Dense] {
            if let Some(proposal) = self.propose(blocks, overlaps, rule)
                && proposal.total() < best.total()
            {
                best = proposal;
            }
        }
        for (block, duration) in blocks.iter_mut().zip(&best.durations) {
            block.duration = *duration;
        }
        overlaps.copy_from_slice(&best.overlaps);
    }

    /// Overlaps cut until no two corners are passed at once, which is always possible.
    fn isolated(&self, blocks: &[PoseBlock], overlaps: &[f64]) -> Proposal {
        let mut overlaps = overlaps.to_vec();
        for index in 1..overlaps.len() {
            let room = blocks[index].duration + self.chain.total_delay();
            let excess = overlaps[index - 1] + overlaps[index] - room;
            if excess > 0.0 {
                let (one, two) = (overlaps[index - 1], overlaps[index]);
                let larger = if one > two { index - 1 } else { index };
                let taken = excess.min((one - two).abs());
                overlaps[larger] -= taken;
                if excess > taken {
                    overlaps[index - 1] = 0.5 * room;
                    overlaps[index] = 0.5 * room;
                }
            }
        }
        Proposal {
            durations: blocks.iter().map(|block| block.duration).collect(),
            overlaps,
        }
    }

    /// Which corners are passed without a wait, at less speed.
    fn gentle(&self, blocks: &[PoseBlock], overlaps: &[f64], rule: Rule) -> Vec<bool> {
        let delay = self.chain.total_delay();
        let gone = self.chain.position(0.5 * delay);
        self.corners
            .iter()
            .enumerate()
            .map(|(index, corner)| {
                let pair = [&blocks[index], &blocks[index + 1]];
                if corner.tip_turn.max(corner.orientation_turn) > GENTLE || self.scales[index] < 1.0
                {
                    return false;
                }
                match rule {
                    Rule::Dense => {
                        pair[0].duration.min(pair[1].duration) < 0.5 * delay
                            && overlaps[index] > 0.25 * delay
                    }
                    Rule::Cost => {
                        let share = |reach: f64, rates: [f64; 2]| {
                            reach / (gone * rates[0].min(rates[1])).max(f64::MIN_POSITIVE)
                        };
                        let share = share(corner.tip, pair.map(PoseBlock::feedrate))
                            .min(share(corner.orientation, pair.map(PoseBlock::turn_rate)))
                            .min(1.0);
                        (1.0 / share - 1.0) * 0.5 * (pair[0].duration + pair[1].duration)
                            < delay - overlaps[index]
                    }
                }
            })
            .collect()
    }

    fn propose(&self, blocks: &[PoseBlock], overlaps: &[f64], rule: Rule) -> Option<Proposal> {
        let delay = self.chain.total_delay();
        let gone = self.chain.position(0.5 * delay);
        let mut durations: Vec<f64> = blocks.iter().map(|block| block.duration).collect();
        let mut overlaps = overlaps.to_vec();
        let gentle = self.gentle(blocks, &overlaps, rule);
        for (index, corner) in self.corners.iter().enumerate() {
            if gentle[index] {
                overlaps[index] = delay;
                for side in [index, index + 1] {
                    let block = &blocks[side];
                    let least = (block.length / (corner.tip / gone))
                        .max(block.turn.amount() / (corner.orientation / gone));
                    durations[side] = durations[side].max(least);
                }
            }
        }
        for _ in 0..ROUNDS {
            let mut slower = vec![1.0_f64; blocks.len()];
            let mut shorter = vec![1.0_f64; overlaps.len()];
            let mut starts = Vec::with_capacity(blocks.len());
            let mut time = 0.0;
            for (index, duration) in durations.iter().enumerate() {
                starts.push(time);
                time += duration + delay - overlaps.get(index).copied().unwrap_or(delay);
            }
            let pulses = Pulses {
                chain: self.chain,
                starts: &starts,
                durations: &durations,
            };
            let tip: Vec<f64> = blocks.iter().map(|block| block.length).collect();
            let turn: Vec<f64> = blocks.iter().map(|block| block.turn.amount()).collect();
            let mut worst: f64 = 0.0;
            let channels: [(&[f64], Turning); 2] = [
                (&tip, |corner| (corner.tip_turn, corner.tip_tolerance)),
                (&turn, |corner| {
                    (corner.orientation_turn, corner.orientation_tolerance)
                }),
            ];
            for (amounts, of) in channels {
                pulses.each_sum(amounts, self.corners, of, |sum, tolerance, parts| {
                    worst = worst.max(sum / tolerance);
                    let excess = (sum / (AIM * tolerance)).min(4.0);
                    if sum <= tolerance * CLOSE_ENOUGH {
                        return;
                    }
                    for &(corner, part) in parts {
                        if part <= MINOR * tolerance {
                            continue;
                        }
                        if gentle[corner] {
                            for side in [corner, corner + 1] {
                                slower[side] = slower[side].max(excess.sqrt());
                            }
                        } else {
                            shorter[corner] = shorter[corner].min(excess.powf(-1.0 / 3.0));
                        }
                    }
                });
            }
            if worst <= CLOSE_ENOUGH {
                return Some(Proposal {
                    durations,
                    overlaps,
                });
            }
            for (duration, factor) in durations.iter_mut().zip(&slower) {
                *duration *= factor;
            }
            for (overlap, factor) in overlaps.iter_mut().zip(&shorter) {
                *overlap *= factor;
            }
        }
        None
    }
}
