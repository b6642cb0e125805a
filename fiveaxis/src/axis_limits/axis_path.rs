//! Computes the path of the axes along a block as polynomials.
//!
//! Source: ours. Inverse kinematics at some stations of a block, and the polynomials through them. They
//! bound how fast a block can be at best, and what its axes do while it is timed. Not here: more than
//! one block at a time.

use crate::axis_limits::axis_bounds::Worst;
use crate::axis_limits::chebyshev::{
    AT_STATIONS, STATIONS, Series, bound, falls, last, slope, through_stations, value,
};
use crate::axis_limits::slow_down::AIM;
use crate::error::FiveAxisError;
use crate::pose::block::PoseBlock;
use toolglide_fir::FilterChain;
use toolglide_kinematics::{Axis, AxisVector, MAX_AXES, MachineKinematics, Vector};

/// Largest angle of the tool along one polynomial, rad, and largest length of the tip, mm.
const ANGLE: f64 = 0.25;
const LENGTH: f64 = 25.0;

/// Most polynomials of a block before one is halved.
const MOST: f64 = 12.0;

/// A polynomial whose last coefficients add less than this share of a derivative to it is believed.
const BELIEVED: f64 = 0.1;

/// What the last coefficients may add to a position, mm and rad.
const RESOLVED: f64 = 1e-4;

/// Shares shorter than this are not halved: a motion that changes within it goes through a pole.
const SHORTEST: f64 = 1e-7;

/// The first three derivatives of the position of an axis along a block, each for a share of 1.
pub(crate) type Slopes = [f64; 3];

/// What is known of one axis along a block.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AxisPath {
    /// First derivative at the start and at the end.
    pub(crate) ends: [f64; 2],
    /// What the derivatives are at most, at any share.
    pub(crate) most: Slopes,
    /// What they are seen to be, at some share.
    seen: Slopes,
}

/// A part of a block that has a polynomial of its own.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Share at which it ends.
    pub(crate) end: f64,
    /// What the derivatives are at most, axis by axis.
    pub(crate) most: [Slopes; MAX_AXES],
}

/// The way of the axes along a block.
#[derive(Clone, Debug)]
pub(crate) struct AxisPaths {
    /// Shares of the block in increasing order, and axis positions there.
    positions: Vec<(f64, AxisVector)>,
    axes: Vec<AxisPath>,
    /// Parts of the block, where it has more than one.
    pub(crate) parts: Vec<Part>,
    /// Whether the polynomials are near enough.
    known: bool,
}

impl AxisPaths {
    /// The way of a machine along a block from axis positions near `at`.
    pub(crate) fn along(
        block: &PoseBlock,
        machine: &dyn MachineKinematics,
        at: &AxisVector,
    ) -> Result<Self, FiveAxisError> {
        let parts = (block.turn.amount() / ANGLE)
            .max(block.length / LENGTH)
            .ceil()
            .clamp(1.0, MOST);
        let mut way = Self {
            positions: Vec::with_capacity(STATIONS),
            axes: vec![AxisPath::default(); machine.axes().len()],
            parts: Vec::new(),
            known: true,
        };
        let first = block.axes(0.0, machine, at)?;
        way.positions.push((0.0, first));
        let mut part = 0.0;
        while part < parts {
            way.part(block, machine, [part / parts, (part + 1.0) / parts])?;
            part += 1.0;
        }
        Ok(way)
    }

    /// The way along a part of the block, which is halved until a polynomial is near enough.
    fn part(
        &mut self,
        block: &PoseBlock,
        machine: &dyn MachineKinematics,
        [begin, end]: [f64; 2],
    ) -> Result<(), FiveAxisError> {
        let count = self.positions.len();
        let first = *self.last();
        let mut near = first;
        let mut values = [[0.0; STATIONS]; MAX_AXES];
        let mut refused = None;
        for (station, at) in AT_STATIONS.iter().enumerate().skip(1) {
            let share = if station + 1 == STATIONS {
                end
            } else {
                begin + 0.5 * (1.0 + at) * (end - begin)
            };
            match block.axes(share, machine, &near) {
                Ok(next) => near = next,
                Err(reason @ FiveAxisError::Machine { .. }) => {
                    refused = Some(reason);
                    break;
                }
                Err(reason) => return Err(reason),
            }
            self.positions.push((share, near));
            for (values, (now, then)) in values.iter_mut().zip(near.iter().zip(first.iter())) {
                values[station] = now - then;
            }
        }
        let axes = first.len();
        let mut series = [[0.0; STATIONS]; MAX_AXES];
        let mut resolved = refused.is_none();
        for (series, values) in series.iter_mut().zip(&values[..axes]) {
            *series = through_stations(values);
            resolved &= falls(series, RESOLVED);
        }
        if !resolved && end - begin > SHORTEST {
            self.positions.truncate(count);
            let middle = 0.5 * (begin + end);
            self.part(block, machine, [begin, middle])?;
            return self.part(block, machine, [middle, end]);
        }
        if let Some(reason) = refused {
            return Err(reason);
        }
        self.known &= resolved;
        let mut most = [[0.0; 3]; MAX_AXES];
        for (axis, series) in series[..axes].iter().enumerate() {
            most[axis] = self.learn(axis, series, [begin, end]);
        }
        if end - begin < 1.0 {
            self.parts.push(Part { end, most });
        }
        Ok(())
    }

    /// Takes the polynomial of an axis along a part of the block, and says what its derivatives are at most.
    fn learn(&mut self, axis: usize, series: &Series<STATIONS>, [begin, end]: [f64; 2]) -> Slopes {
        let scale = 2.0 / (end - begin);
        let rests = last(series);
        let mut series = *series;
        let mut factor = 1.0;
        let mut believed = true;
        let mut all = [0.0; 3];
        for (order, rest) in rests.into_iter().enumerate() {
            series = slope(&series);
            factor *= scale;
            let most = bound(&series, 1.0);
            believed &= order > 1 || rest <= BELIEVED * most || most <= f64::EPSILON;
            let way = &mut self.axes[axis];
            all[order] = factor * (most + rest);
            way.most[order] = way.most[order].max(all[order]);
            if order == 0 {
                if begin <= 0.0 {
                    way.ends[0] = factor * value(&series, -1.0);
                }
                way.ends[1] = factor * value(&series, 1.0);
            }
            if believed {
                // Not at the ends, where a block is not at its full rate.
                let seen = [-0.5, 0.0, 0.5]
                    .iter()
                    .map(|at| value(&series, *at).abs())
                    .fold(0.0, f64::max);
                way.seen[order] = way.seen[order].max(factor * seen);
            }
        }
        all
    }

    /// What the derivatives of each axis are seen to be.
    pub(crate) fn slopes(&self) -> Vec<Slopes> {
        self.axes.iter().map(|way| way.seen).collect()
    }

    /// Where the axes are at the start.
    pub(crate) fn first(&self) -> &AxisVector {
        &self.positions[0].1
    }

    /// Where the axes are at the end.
    pub(crate) fn last(&self) -> &AxisVector {
        &self.positions[self.positions.len() - 1].1
    }

    /// Axis positions at a share of the block, or a little before.
    pub(crate) fn near(&self, share: f64) -> &AxisVector {
        let after = self.positions.partition_point(|(at, _)| *at <= share);
        &self.positions[after.saturating_sub(1)].1
    }

    /// What is known of an axis, where the polynomials are near enough.
    pub(crate) fn known(&self) -> Option<&[AxisPath]> {
        self.known.then_some(self.axes.as_slice())
    }

    /// A duration that the block has at least, and the limit that asks for it.
    ///
    /// Velocity bounds the slope of the way; the steps of velocity at both ends bound by acceleration
    /// and jerk of the chain; bends of the way by its second and third derivatives.
    pub(crate) fn least_duration(&self, axes: &[Axis], chain: &FilterChain) -> (f64, Worst) {
        let [long, short] = *chain.time_constants() else {
            return (0.0, Worst::NONE);
        };
        let mut least = (0.0, Worst::NONE);
        for (axis, (limits, way)) in axes.iter().zip(&self.axes).enumerate() {
            let velocity = AIM * limits.limits.velocity();
            let acceleration = AIM * limits.limits.acceleration();
            let jerk = AIM * limits.limits.jerk();
            let [first, second, third] = way.seen;
            let end = if self.known {
                way.ends[0].abs().max(way.ends[1].abs())
            } else {
                first
            };
            for (duration, order) in [
                (first / velocity, 0),
                (end / (acceleration * long), 1),
                (end / (jerk * long * short), 2),
                ((second / acceleration).sqrt(), 1),
                ((third / jerk).cbrt(), 2),
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

impl PoseBlock {
    /// Tool tip at a share of the block.
    pub(crate) fn tip(&self, share: f64) -> Vector<3> {
        if share >= 1.0 {
            self.end
        } else {
            self.start + (self.end - self.start) * share
        }
    }
}
