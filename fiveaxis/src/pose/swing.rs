//! Describes how the tool turns along a block: along a great circle, or as the rotary axes turn it.
//!
//! Source: ours. Rotary axes go evenly, so that corners between them are those of straight lines, in coordinates in which
//! one radian of an axis counts as much as it swings the tool at most: `|dO| <= |(dA, sin A dC)|` on a table of A and C.
//! Not here: how near the pole the tool comes, which is nothing to axes whose positions are given.

use crate::error::FiveAxisError;
use crate::pose::block::PoseBlock;
use toolglide_kinematics::{
    AxisKind, AxisVector, GreatCircle, KinematicsError, MAX_AXES, MachineKinematics,
    OrientationTolerance, ToolPose,
};

/// Share of an axis that counts where the tool does not tell it.
const FLOOR: f64 = 1.0 / OrientationTolerance::OF_AXIS;

/// Between two looks at how far the axes swing the tool, they turn by no more, rad, or there are so many looks.
const STEP: f64 = 0.02;
const MAX_LOOKS: f64 = 256.0;

/// Directions in which two axes swing the tool that are across each other but for rounding.
const ACROSS: f64 = 1e-9;

/// How the tool turns along a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Swing {
    /// About one axis.
    Circle(GreatCircle),
    /// As the rotary axes turn it.
    Rotary(RotarySwing),
}

/// Rotary axes that go evenly from their positions at the start to those at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotarySwing {
    start: AxisVector,
    end: AxisVector,
    /// How much a radian of each axis counts.
    weights: [f64; MAX_AXES],
}

impl Swing {
    /// How far the tool turns, rad; of rotary axes a bound of it.
    #[must_use]
    pub fn amount(&self) -> f64 {
        match self {
            Self::Circle(turn) => turn.angle(),
            Self::Rotary(swing) => swing.amount(),
        }
    }

    /// The great circle; none for rotary axes.
    #[must_use]
    pub fn circle(&self) -> Option<&GreatCircle> {
        match self {
            Self::Circle(turn) => Some(turn),
            Self::Rotary(_) => None,
        }
    }

    /// The rotary axes; none for a great circle.
    #[must_use]
    pub fn rotary(&self) -> Option<&RotarySwing> {
        match self {
            Self::Circle(_) => None,
            Self::Rotary(swing) => Some(swing),
        }
    }

    /// The part from one share to a larger one.
    pub(crate) fn part(&self, from: f64, to: f64) -> Self {
        match self {
            Self::Circle(turn) => Self::Circle(turn.part(from, to)),
            Self::Rotary(swing) => Self::Rotary(RotarySwing {
                start: swing.at(from),
                end: swing.at(to),
                ..*swing
            }),
        }
    }

    /// Twice the sine of half the angle by which this turns away from the one before; none where one of them does not
    /// turn.
    pub(crate) fn turn_from(&self, before: &Self) -> f64 {
        match (before, self) {
            (Self::Circle(before), Self::Circle(after)) => {
                if before.angle() > 0.0 && after.angle() > 0.0 {
                    (after.axis() - before.axis()).norm()
                } else {
                    0.0
                }
            }
            (Self::Rotary(before), Self::Rotary(after)) => {
                let (one, two) = (before.amount(), after.amount());
                if one > 0.0 && two > 0.0 {
                    let squares = before.spans().zip(after.spans()).enumerate();
                    squares
                        .map(|(axis, (before, after))| {
                            let weight = self.rotary().map_or(0.0, |swing| swing.weights[axis]);
                            (weight * (after / two - before / one)).powi(2)
                        })
                        .sum::<f64>()
                        .sqrt()
                } else {
                    0.0
                }
            }
            // There is a rest between motions of two kinds.
            _ => 2.0,
        }
    }
}

impl RotarySwing {
    /// From the positions at the start to those at the end; every axis counts fully.
    #[must_use]
    pub fn new([start, end]: &[AxisVector; 2]) -> Self {
        Self {
            start: *start,
            end: *end,
            weights: [1.0; MAX_AXES],
        }
    }

    /// Positions at the start.
    #[must_use]
    pub fn start(&self) -> &AxisVector {
        &self.start
    }

    /// By how much each axis turns, rad.
    pub(crate) fn spans(&self) -> impl Iterator<Item = f64> + '_ {
        self.start
            .iter()
            .zip(self.end.iter())
            .map(|(start, end)| end - start)
    }

    fn amount(&self) -> f64 {
        let squares = self.spans().zip(&self.weights);
        squares
            .map(|(span, weight)| (span * weight).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// Positions after a share.
    #[must_use]
    pub fn at(&self, share: f64) -> AxisVector {
        if share >= 1.0 {
            return self.end;
        }
        let mut at = self.start;
        for (at, span) in at.iter_mut().zip(self.spans()) {
            *at += share * span;
        }
        at
    }

    /// Axis positions whose rotary axes are these, the linear ones as in `near`.
    pub(crate) fn put(
        machine: &dyn MachineKinematics,
        rotary: &AxisVector,
        near: &AxisVector,
    ) -> AxisVector {
        let mut at = *near;
        for ((at, rotary), axis) in at.iter_mut().zip(rotary.iter()).zip(machine.axes()) {
            if axis.kind == AxisKind::Rotary {
                *at = *rotary;
            }
        }
        at
    }
}

/// Makes every axis of blocks between two rests count as much as it swings the tool at most, anywhere on them.
pub(crate) fn weigh(
    blocks: &mut [PoseBlock],
    machine: &dyn MachineKinematics,
) -> Result<(), FiveAxisError> {
    let rotary: Vec<usize> = machine
        .axes()
        .iter()
        .enumerate()
        .filter(|(_, axis)| axis.kind == AxisKind::Rotary)
        .map(|(index, _)| index)
        .collect();
    let mut weights = [0.0_f64; MAX_AXES];
    let mut crossing = false;
    for block in blocks.iter() {
        let Swing::Rotary(swing) = &block.turn else {
            continue;
        };
        let refused = |reason| FiveAxisError::Machine {
            index: block.leg,
            reason,
        };
        let turned: f64 = swing.spans().map(f64::abs).sum();
        let looks = (turned / STEP).ceil().clamp(1.0, MAX_LOOKS);
        // Between two looks, and as far as the motion may leave the way.
        let beyond = 0.5 * turned / looks + 2.0 * block.orientation_tolerance;
        let mut look = 0.0;
        while look <= looks {
            let swings = machine.swings(&swing.at(look / looks)).map_err(refused)?;
            for (number, &axis) in rotary.iter().enumerate() {
                weights[axis] = weights[axis].max(swings[axis].norm() + beyond);
                for &other in &rotary[number + 1..] {
                    crossing |= swings[axis].dot(&swings[other]).abs() > ACROSS;
                }
            }
            look += 1.0;
        }
    }
    // Axes that do not swing the tool across each other may swing it the same way.
    let count = rotary.iter().fold(0.0, |count, _| count + 1.0);
    let together: f64 = if crossing { f64::sqrt(count) } else { 1.0 };
    for weight in &mut weights {
        *weight = (together * weight.min(1.0)).max(FLOOR);
    }
    for block in blocks {
        if let Swing::Rotary(swing) = &mut block.turn {
            swing.weights = weights;
        }
    }
    Ok(())
}

impl PoseBlock {
    /// Axis positions at a share of the block, of a machine that is near `near`.
    pub(crate) fn axes(
        &self,
        share: f64,
        machine: &dyn MachineKinematics,
        near: &AxisVector,
    ) -> Result<AxisVector, FiveAxisError> {
        let refused = |reason: KinematicsError| FiveAxisError::Machine {
            index: self.leg,
            reason,
        };
        match &self.turn {
            Swing::Circle(turn) => {
                let pose = ToolPose::new(self.tip(share), turn.at(share)).map_err(|reason| {
                    FiveAxisError::Path {
                        index: self.leg,
                        reason,
                    }
                })?;
                machine.follow(&pose, near).map_err(refused)
            }
            Swing::Rotary(swing) => {
                let at = RotarySwing::put(machine, &swing.at(share), near);
                machine.place(&self.tip(share), &at).map_err(refused)
            }
        }
    }
}
