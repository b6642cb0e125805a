//! Holds a section of tool motion between two rests while it is slowed down to the axis limits.
//!
//! Source: ours. Not here: how much, see `relax`; the formulas of corners and timing.

use crate::axis_limits::axis_bounds::{Worst, worst};
use crate::axis_limits::axis_path::AxisPaths;
use crate::axis_limits::quick_bounds::{Mixed, Progress, alone, mixed, together};
use crate::axis_limits::slow_down::{AIM, Stretch};
use crate::error::FiveAxisError;
use crate::output::pieces::piece;
use crate::pose::block::PoseBlock;
use crate::pose::corner::PoseCorner;
use crate::settings::PoseMethod;
use crate::timing::commanded_progress::Steps;
use crate::timing::{corners, goes_on, time};
use std::sync::Arc;
use toolglide_fir::FilterChain;
use toolglide_kinematics::{Axis, MachineKinematics};

/// Factors by which a corner is taken more gently at once.
const MIN_EASING: f64 = 1.08;
const MAX_EASING: f64 = 2.0;

/// A corner taken more gently than this is a stop.
const MIN_SCALE: f64 = 0.05;

/// Blocks of tool motion between two rests, and the way of the axes along each.
pub(crate) struct ToolStretch<'a> {
    machine: &'a dyn MachineKinematics,
    axes: &'a [Axis],
    chain: &'a FilterChain,
    method: PoseMethod,
    pub(crate) blocks: Vec<PoseBlock>,
    pub(crate) ways: Vec<Arc<AxisPaths>>,
    corners: Vec<PoseCorner>,
    /// How gently each corner is taken, as a share of what the tolerances allow.
    scales: Vec<f64>,
    /// How long the blocks overlap at each corner.
    overlaps: Vec<f64>,
    /// What the blocks at each corner add together to the positions of the axes.
    mixed: Vec<Option<Mixed>>,
}

impl<'a> ToolStretch<'a> {
    /// The blocks in a row, with the way of the axes along each; whether they are slowed down within the limits of
    /// the axes.
    pub(crate) fn new(
        machine: &'a dyn MachineKinematics,
        axes: &'a [Axis],
        (chain, method): (&'a FilterChain, PoseMethod),
        (blocks, ways): (Vec<PoseBlock>, Vec<Arc<AxisPaths>>),
        keeps_limits: bool,
    ) -> Result<Self, FiveAxisError> {
        let corners = corners(&blocks);
        let mixed = if keeps_limits {
            blocks
                .windows(2)
                .zip(ways.windows(2))
                .map(|(pair, ways)| mixed([&pair[0], &pair[1]], [&ways[0], &ways[1]], machine))
                .collect::<Result<_, _>>()?
        } else {
            Vec::new()
        };
        Ok(Self {
            machine,
            axes,
            chain,
            method,
            scales: vec![1.0; corners.len()],
            overlaps: vec![0.0; corners.len()],
            corners,
            blocks,
            ways,
            mixed,
        })
    }

    /// The scale of a corner after it was taken more gently.
    fn eased(&self, scale: f64, worst: &Worst) -> f64 {
        // As long as two blocks overlap at all, their jerks add up.
        let adds_up = worst.order == 2 && self.method == PoseMethod::DwellControlled;
        let eased = scale / worst.share.clamp(MIN_EASING, MAX_EASING);
        if adds_up || eased < MIN_SCALE {
            0.0
        } else {
            eased
        }
    }

    /// A bound by the ways of the axes alone, where it can be had.
    fn screened(
        &self,
        steps: &[Steps],
        [begin, end]: [f64; 2],
        [oldest, newest]: [usize; 2],
    ) -> Option<Worst> {
        let (middle, half) = (0.5 * (begin + end), 0.5 * (end - begin));
        let progress = |block: usize| Progress::new(steps[block].state(self.chain, middle), half);
        if oldest == newest {
            let way = self.ways[oldest].known()?;
            Some(alone(self.axes, way, progress(oldest), half))
        } else if oldest + 1 == newest {
            let ways = [self.ways[oldest].known()?, self.ways[newest].known()?];
            let mixed = self.mixed[oldest].as_ref()?;
            let progress = [progress(oldest), progress(newest)];
            together(self.axes, ways, progress, mixed, half)
        } else {
            None
        }
    }

    /// The limit that an interval comes nearest to, by inverse kinematics.
    fn measured(
        &self,
        steps: &[Steps],
        interval: [f64; 2],
        range: [usize; 2],
    ) -> Result<Worst, FiveAxisError> {
        let chain = self.chain;
        let piece = piece(&self.blocks, self.axes, steps, chain, interval, range);
        // The axes are near those of the path of the block that is half done.
        let mut near = self.ways[range[0]].first();
        let under_way = range[0]..=range[1];
        for (steps, way) in steps[under_way.clone()].iter().zip(&self.ways[under_way]) {
            let done = steps.cubic(chain, interval[0], interval[0])[0];
            if done > 0.0 {
                near = way.near(done);
            }
        }
        worst(self.machine, self.axes, &piece, near).map_err(|reason| FiveAxisError::Machine {
            index: self.blocks[range[0]].leg,
            reason,
        })
    }
}

impl Stretch for ToolStretch<'_> {
    fn steps(&mut self, changed: &[bool]) -> Vec<Steps> {
        time(
            &mut self.blocks,
            &self.corners,
            &self.scales,
            self.method,
            self.chain,
            changed,
            &mut self.overlaps,
        )
    }

    fn worst(
        &self,
        steps: &[Steps],
        interval: [f64; 2],
        range: [usize; 2],
    ) -> Result<Worst, FiveAxisError> {
        if let Some(found) = self.screened(steps, interval, range)
            && found.share <= AIM
        {
            return Ok(found);
        }
        let mut found = self.measured(steps, interval, range)?;
        found.share /= AIM;
        Ok(found)
    }

    fn pace(&self, block: usize) -> f64 {
        let block = &self.blocks[block];
        // A turn of one radian counts as much as a way of a hundred millimetres.
        block.feedrate().max(100.0 * block.turn_rate())
    }

    fn duration(&mut self, block: usize) -> &mut f64 {
        &mut self.blocks[block].duration
    }

    fn cost_of_easing(&self, block: usize, worst: &Worst) -> f64 {
        let Some(&scale) = self.scales.get(block) else {
            return f64::INFINITY;
        };
        if scale <= 0.0 {
            return f64::INFINITY;
        }
        let pair = [&self.blocks[block], &self.blocks[block + 1]];
        if goes_on(pair[0], pair[1]) {
            return f64::INFINITY;
        }
        let corner = &self.corners[block];
        let lost = scale - self.eased(scale, worst);
        match self.method {
            PoseMethod::DwellControlled => lost * corner.overlap(pair[0], pair[1], self.chain),
            PoseMethod::VelocityControlled => {
                let shares = pair.map(|block| corner.slow_share(block, self.chain));
                0.5 * self.chain.total_delay() * lost * (shares[0] + shares[1])
            }
            _ => f64::INFINITY,
        }
    }

    fn ease(&mut self, block: usize, worst: &Worst) {
        if let Some(&scale) = self.scales.get(block)
            && !goes_on(&self.blocks[block], &self.blocks[block + 1])
        {
            self.scales[block] = self.eased(scale, worst);
        }
    }

    fn leg(&self, block: usize) -> u32 {
        self.blocks[block].leg
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::pieces::{intervals, knots};
    use toolglide_kinematics::{
        AxisVector, Feedrate, OrientationTolerance, PoseFeed, PoseLeg, Tolerance, ToolPose, Vector,
    };

    /// A point of a wavy path whose tool nods and turns, the more the higher the number.
    fn pose(number: f64) -> ToolPose {
        let (tilt, spin) = (0.5 + 0.3 * (1.7 * number).sin(), 0.9 * number.sin());
        let tip = Vector::<3>::new(
            15.0 * (0.9 * number).sin(),
            15.0 * (0.5 * number).cos(),
            5.0 * number.cos(),
        );
        let tool = Vector::<3>::new(tilt.sin() * spin.cos(), tilt.sin() * spin.sin(), tilt.cos());
        ToolPose::new(tip, tool).unwrap()
    }

    fn stretch<'a>(
        machine: &'a dyn MachineKinematics,
        how: (&'a FilterChain, PoseMethod),
        step: f64,
    ) -> ToolStretch<'a> {
        let (mut blocks, mut ways) = (Vec::new(), Vec::new());
        let mut at = machine.inverse(&pose(0.0), &AxisVector::zeros(5)).unwrap();
        let mut number = 0.0;
        for leg in 0..40 {
            let made = PoseLeg::between(
                &pose(number),
                &pose(number + step),
                PoseFeed::Speed(Feedrate::new(80.0).unwrap()),
                Tolerance::new(0.1).unwrap(),
                OrientationTolerance::new(0.01).unwrap(),
            )
            .unwrap();
            number += step;
            let mut block = PoseBlock::of(&made, leg, 2.0).unwrap();
            block.duration = block.duration.max(0.05);
            let way = AxisPaths::along(&block, machine, &at).unwrap();
            at = *way.last();
            blocks.push(block);
            ways.push(Arc::new(way));
        }
        ToolStretch::new(machine, machine.axes(), how, (blocks, ways), true).unwrap()
    }

    #[test]
    fn bounds_by_the_ways_are_above_what_inverse_kinematics_shows() {
        let (mut seen, mut tight) = (0, 0);
        for name in ["table-ac", "table-bc", "head-bc", "head-table-bc"] {
            let model = toolglide_machines::find(name).unwrap();
            let mut config = (model.preset)();
            for axis in &mut config.axis {
                axis.travel = None;
            }
            let machine = (model.build)(&config).unwrap();
            for method in [PoseMethod::DwellControlled, PoseMethod::VelocityControlled] {
                for step in [0.03, 0.1, 0.3] {
                    let chain = FilterChain::with_time_constants(&[0.05, 0.025]).unwrap();
                    let mut stretch = stretch(machine.as_ref(), (&chain, method), step);
                    let steps = stretch.steps(&[true; 40]);
                    for (interval, range) in intervals(&steps, &knots(&steps, &chain), &chain) {
                        let Some(bound) = stretch.screened(&steps, interval, range) else {
                            continue;
                        };
                        let found = stretch.measured(&steps, interval, range).unwrap();
                        seen += 1;
                        tight += i32::from(bound.share < 1.5 * found.share);
                        // What is measured is a bound as well, a little above the value.
                        assert!(
                            bound.share > 0.99 * found.share.min(1.0),
                            "{name} {method:?} by {step} at {interval:?}: {bound:?} is below {found:?}"
                        );
                    }
                }
            }
        }
        assert!(seen > 2000, "{seen} bounds only");
        assert!(2 * tight > seen, "{tight} of {seen} bounds are tight");
    }
}
