//! Filters straight motion of the axes: NS-JCB, and moves of axes by themselves.
//!
//! Source: section 5.4, where joint-space interpolation is the usual way to compare with: inverse
//! kinematics at the poses and at way-points between them, then every axis for itself. Where the
//! tool goes between is nobody's concern. Not here: tool motion.

use crate::axis_limits::axis_bounds::Worst;
use crate::axis_limits::slow_down::{AIM, Stretch};
use crate::error::FiveAxisError;
use crate::output::pieces::scaled;
use crate::pose::block::PoseBlock;
use crate::timing::commanded_progress::Steps;
use toolglide_fir::FilterChain;
use toolglide_kinematics::{AxesPiece, Axis, AxisVector, CubicInTime, MoveRange, cubic_at};

/// A straight move of all axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointBlock {
    pub(crate) leg: u32,
    pub(crate) line: u32,
    pub(crate) start: AxisVector,
    pub(crate) end: AxisVector,
    pub(crate) duration: f64,
}

impl JointBlock {
    /// The straight move of all axes in place of a block of tool motion.
    pub(crate) fn between(block: &PoseBlock, start: AxisVector, end: AxisVector) -> Self {
        Self {
            leg: block.leg,
            line: block.line,
            start,
            end,
            duration: block.duration,
        }
    }

    /// The least duration within the limits of all axes, and the limit that asks for it.
    pub(crate) fn least_duration(&self, axes: &[Axis], chain: &FilterChain) -> (f64, Worst) {
        let [long, short] = *chain.time_constants() else {
            return (0.0, Worst::NONE);
        };
        let mut least = (0.0, Worst::NONE);
        for (axis, limits) in axes.iter().enumerate() {
            let span = (self.end[axis] - self.start[axis]).abs();
            let limits = &limits.limits;
            for (duration, order) in [
                (span / (AIM * limits.velocity()), 0),
                (span / (AIM * limits.acceleration() * long), 1),
                (span / (AIM * limits.jerk() * long * short), 2),
            ] {
                if duration > least.0 {
                    let share = 1.0;
                    least = (duration, Worst { share, axis, order });
                }
            }
        }
        least
    }
}

/// Straight moves of all axes between two rests.
pub(crate) struct JointStretch<'a> {
    pub(crate) blocks: Vec<JointBlock>,
    pub(crate) chain: &'a FilterChain,
    pub(crate) axes: &'a [Axis],
    /// How long the transients of two blocks overlap.
    pub(crate) overlap: f64,
}

impl JointStretch<'_> {
    /// Positions of all axes in an interval, from its start on.
    fn positions(
        &self,
        steps: &[Steps],
        [begin, end]: [f64; 2],
        [oldest, newest]: [usize; 2],
    ) -> Vec<CubicInTime> {
        let inside = 0.5 * (begin + end);
        let progress: Vec<CubicInTime> = steps[oldest..=newest]
            .iter()
            .map(|steps| steps.cubic(self.chain, begin, inside))
            .collect();
        (0..self.axes.len())
            .map(|axis| {
                let mut cubic = [self.blocks[oldest].start[axis], 0.0, 0.0, 0.0];
                for (block, progress) in self.blocks[oldest..=newest].iter().zip(&progress) {
                    let span = block.end[axis] - block.start[axis];
                    for (sum, part) in cubic.iter_mut().zip(scaled(progress, span)) {
                        *sum += part;
                    }
                }
                cubic
            })
            .collect()
    }

    /// The piece of an interval.
    pub(crate) fn piece(
        &self,
        steps: &[Steps],
        interval: [f64; 2],
        blocks: [usize; 2],
    ) -> AxesPiece {
        let [begin, end] = interval;
        let positions = self.positions(steps, interval, blocks);
        let last = &self.blocks[blocks[1]];
        let over =
            steps[blocks[1]].command_end() + self.chain.total_delay() <= end + f64::EPSILON * end;
        let mut reached = last.end;
        if !over {
            for (at, cubic) in reached.iter_mut().zip(&positions) {
                *at = cubic_at(cubic, end - begin);
            }
        }
        AxesPiece {
            positions,
            end: reached,
            duration: end - begin,
            serves: MoveRange {
                first: self.blocks[blocks[0]].leg,
                last: last.leg,
            },
        }
    }
}

impl Stretch for JointStretch<'_> {
    fn steps(&mut self, _changed: &[bool]) -> Vec<Steps> {
        let mut start = 0.0;
        self.blocks
            .iter()
            .map(|block| {
                let steps = Steps::pulse(start, block.duration);
                start += block.duration + self.chain.total_delay() - self.overlap;
                steps
            })
            .collect()
    }

    fn worst(
        &self,
        steps: &[Steps],
        interval: [f64; 2],
        blocks: [usize; 2],
    ) -> Result<Worst, FiveAxisError> {
        let duration = interval[1] - interval[0];
        let mut worst = Worst::NONE;
        let positions = self.positions(steps, interval, blocks);
        for (axis, cubic) in positions.iter().enumerate() {
            let turning = (-cubic[2] / (3.0 * cubic[3])).clamp(0.0, duration);
            for time in [0.0, turning, duration] {
                if time.is_nan() {
                    continue;
                }
                worst.raise(
                    axis,
                    &self.axes[axis],
                    [
                        cubic[1] + (2.0 * cubic[2] + 3.0 * cubic[3] * time) * time,
                        2.0 * cubic[2] + 6.0 * cubic[3] * time,
                        6.0 * cubic[3],
                    ],
                );
            }
        }
        worst.share /= AIM;
        Ok(worst)
    }

    fn pace(&self, block: usize) -> f64 {
        let block = &self.blocks[block];
        block
            .start
            .iter()
            .zip(block.end.iter())
            .zip(self.axes)
            .map(|((start, end), axis)| {
                (end - start).abs() / (block.duration * axis.limits.velocity())
            })
            .fold(0.0, f64::max)
    }

    fn duration(&mut self, block: usize) -> &mut f64 {
        &mut self.blocks[block].duration
    }

    fn cost_of_easing(&self, _block: usize, _worst: &Worst) -> f64 {
        f64::INFINITY
    }

    fn ease(&mut self, _block: usize, _worst: &Worst) {}

    fn leg(&self, block: usize) -> u32 {
        self.blocks[block].leg
    }
}
