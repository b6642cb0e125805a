//! Plans the moves between two rests in several ways, and takes the fastest that keeps every limit.
//!
//! Source: ours. The ways differ in their filters, where these may be chosen, and in where they rest: a method that
//! overlaps its moves runs against a rest at the end of each, along the whole row and along every part of it. So no
//! method takes longer than point to point. Not here: how one way is planned, see `relax`.

use super::choice::Choice;
use super::row::{Cut, Section};
use crate::axis_limits::axis_bounds::Worst;
use crate::axis_limits::slow_down::{Stretch, relax};
use crate::error::FiveAxisError;
use crate::output::pieces::{intervals, knots, piece};
use crate::pose::block::PoseBlock;
use crate::pose::tool::ToolStretch;
use crate::settings::{PoseMethod, PoseSettings};
use crate::timing::commanded_progress::Steps;
use toolglide_fir::FilterChain;
use toolglide_kinematics::{Axis, MachineKinematics, PosePiece};
use toolglide_verify::keeps_axis_limits;

/// How often what is left of a row is divided at most, so that the work of a row is bounded.
const DIVISIONS: u32 = 4;

/// A motion that is shorter by less than this share is not shorter.
const SHORTER: f64 = 1e-9;

/// A motion of some moves from rest to rest.
pub(super) struct Contender {
    pub(super) blocks: Vec<PoseBlock>,
    pub(super) steps: Vec<Steps>,
    pub(super) chain: FilterChain,
    /// Duration that was asked for, block by block, s.
    pub(super) asked: Vec<f64>,
    /// The limit for which a block was slowed down.
    pub(super) met: Vec<Option<Worst>>,
}

impl Contender {
    /// The pieces of the motion.
    pub(super) fn pieces(&self, axes: &[Axis]) -> impl Iterator<Item = PosePiece> {
        let knots = knots(&self.steps, &self.chain);
        let within: Vec<_> = intervals(&self.steps, &knots, &self.chain).collect();
        within.into_iter().map(move |(interval, range)| {
            let (blocks, steps) = (&self.blocks, &self.steps);
            piece(blocks, axes, steps, &self.chain, interval, range)
        })
    }

    /// How long it takes, s.
    pub(super) fn duration(&self) -> f64 {
        let end = self.steps.last().map_or(0.0, Steps::command_end);
        end + self.chain.total_delay()
    }

    /// How long each move has the tool until the next one begins, and the last one until rest, s.
    fn times(&self) -> Vec<f64> {
        let mut begins: Vec<f64> = Vec::new();
        let mut leg = None;
        for (block, steps) in self.blocks.iter().zip(&self.steps) {
            if leg.replace(block.leg) != Some(block.leg) {
                begins.push(steps.begin());
            }
        }
        begins.push(self.duration());
        begins.windows(2).map(|pair| pair[1] - pair[0]).collect()
    }
}

fn total(contenders: &[Contender]) -> f64 {
    contenders.iter().map(Contender::duration).sum()
}

/// What ways are planned for.
pub(super) struct Race<'a> {
    pub(super) machine: &'a dyn MachineKinematics,
    pub(super) axes: &'a [Axis],
    pub(super) settings: &'a PoseSettings,
}

impl Race<'_> {
    /// The fastest motion along a row, in parts between rests.
    pub(super) fn run(&self, row: &[Section]) -> Result<Vec<Contender>, FiveAxisError> {
        self.divided(row, DIVISIONS)
    }

    fn divided(&self, row: &[Section], divisions: u32) -> Result<Vec<Contender>, FiveAxisError> {
        let method = self.settings.method();
        let legs: Vec<&[Section]> = row.chunk_by(Section::goes_on).collect();
        if legs.is_empty() {
            return Ok(Vec::new());
        }
        if !self.settings.keeps_axis_limits() {
            return Ok(vec![self.fastest(row, method)?]);
        }
        if method == PoseMethod::PointToPoint || legs.len() == 1 {
            return self.resting(&legs);
        }
        let together = match self.fastest(row, method) {
            Ok(together) => together,
            // Whatever a corner asks for, at rest it is passed.
            Err(_) if divisions == 0 => return self.resting(&legs),
            Err(_) => {
                let middle = legs[..legs.len() / 2].iter().map(|leg| leg.len()).sum();
                let (before, behind) = row.split_at(middle);
                let mut parts = self.divided(before, divisions - 1)?;
                parts.extend(self.divided(behind, divisions - 1)?);
                return Ok(parts);
            }
        };
        // By how much the row would be faster with a rest at both ends of a move.
        let mut resting = Vec::with_capacity(legs.len());
        let mut gains = Vec::with_capacity(legs.len());
        for (leg, time) in legs.iter().zip(together.times()) {
            let alone = self.fastest(leg, PoseMethod::PointToPoint)?;
            gains.push(time - alone.duration());
            resting.push(alone);
        }
        let part = largest_part(&gains);
        if part.is_empty() {
            return Ok(vec![together]);
        }
        let mut best = vec![together];
        if divisions > 0 && part.len() < legs.len() {
            let sections = |range: &[&[Section]]| range.iter().map(|leg| leg.len()).sum::<usize>();
            let (begin, end) = (sections(&legs[..part.start]), sections(&legs[..part.end]));
            let mut other = self.divided(&row[..begin], divisions - 1)?;
            let behind = self.divided(&row[end..], divisions - 1)?;
            if total(&other) + total(&resting[part.clone()]) + total(&behind) < total(&best) {
                other.extend(resting.drain(part));
                other.extend(behind);
                best = other;
                return Ok(best);
            }
        }
        if total(&resting) < total(&best) {
            best = resting;
        }
        Ok(best)
    }

    /// Every move from rest to rest.
    fn resting(&self, legs: &[&[Section]]) -> Result<Vec<Contender>, FiveAxisError> {
        legs.iter()
            .map(|leg| self.fastest(leg, PoseMethod::PointToPoint))
            .collect()
    }

    /// The fastest motion of a method along a row that rests at its ends alone.
    fn fastest(&self, row: &[Section], method: PoseMethod) -> Result<Contender, FiveAxisError> {
        let mut choice = Choice::new(self.settings, self.axes, row);
        let mut best: Option<Result<Contender, FiveAxisError>> = None;
        let mut doubtful: Option<Contender> = None;
        while let Some(chain) = choice.next(fast(&best).map(|best| best.chain.time_constants())) {
            let made = self.plan(row, method, chain);
            let shorter = match (&made, fast(&best)) {
                (Ok(made), Some(best)) => made.duration() < best.duration() * (1.0 - SHORTER),
                (Ok(_), None) => true,
                (Err(_), _) => best.is_none(),
            };
            if !shorter {
                continue;
            }
            match made {
                Ok(made) if !self.is_certain(row, &made) => {
                    doubtful.get_or_insert(made);
                }
                made => best = Some(made),
            }
        }
        if fast(&best).is_none()
            && let Some(doubtful) = doubtful
        {
            // What is not certain is better than nothing only where there is no other way of passing a pose.
            return if method == PoseMethod::PointToPoint {
                Ok(doubtful)
            } else {
                Err(FiveAxisError::NoRate {
                    index: row[0].block.leg,
                })
            };
        }
        best.unwrap_or(Err(FiveAxisError::NoRate {
            index: row.first().map_or(0, |section| section.block.leg),
        }))
    }

    /// Whether a motion keeps the limits of the axes beyond doubt: beside a pole, where rounding turns an axis, and
    /// polynomials of any length miss what happens, the judge is asked before it is handed out.
    fn is_certain(&self, row: &[Section], made: &Contender) -> bool {
        let beside_pole = row
            .iter()
            .any(|section| section.block.is_beside_pole(self.machine));
        if !(self.settings.keeps_axis_limits() && beside_pole) {
            return true;
        }
        let start = row.first().map(|section| section.way.first());
        let pieces: Vec<_> = made.pieces(self.axes).collect();
        start.is_none_or(|start| keeps_axis_limits(self.machine, self.axes, start, &pieces))
    }

    fn plan(
        &self,
        row: &[Section],
        method: PoseMethod,
        chain: FilterChain,
    ) -> Result<Contender, FiveAxisError> {
        let Cut {
            blocks,
            ways,
            asked,
            mut met,
        } = Cut::of(row, self.machine, self.axes, self.settings, &chain)?;
        let count = blocks.len();
        let keeps = self.settings.keeps_axis_limits();
        let (how, row) = ((&chain, method), (blocks, ways));
        let mut stretch = ToolStretch::new(self.machine, self.axes, how, row, keeps)?;
        let steps = if keeps {
            relax(&mut stretch, &chain, self.axes, &mut met)?
        } else {
            stretch.steps(&vec![true; count])
        };
        let blocks = stretch.blocks;
        Ok(Contender {
            blocks,
            steps,
            chain,
            asked,
            met,
        })
    }
}

fn fast(best: &Option<Result<Contender, FiveAxisError>>) -> Option<&Contender> {
    best.as_ref().and_then(|best| best.as_ref().ok())
}

/// The part of a list whose sum is largest; empty where no sum is positive.
fn largest_part(gains: &[f64]) -> std::ops::Range<usize> {
    let mut best = (0.0, 0..0);
    let (mut sum, mut start) = (0.0, 0);
    for (index, gain) in gains.iter().enumerate() {
        if sum <= 0.0 {
            (sum, start) = (0.0, index);
        }
        sum += gain;
        if sum > best.0 {
            best = (sum, start..index + 1);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::largest_part;

    #[test]
    fn the_part_with_the_largest_sum_is_found() {
        assert_eq!(largest_part(&[-1.0, 2.0, -0.5, 3.0, -4.0, 1.0]), 1..4);
        assert!(largest_part(&[-1.0, -2.0]).is_empty(), "nothing to gain");
    }
}
