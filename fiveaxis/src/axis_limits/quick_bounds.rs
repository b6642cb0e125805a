//! Bounds the axes while one or two blocks are under way, from their axis paths alone.
//!
//! Source: the chain rule. The position of an axis is that at the corner, what each block adds to
//! it, and what they add together, which is of second order. Each is bounded over the whole interval, so
//! that nothing between instants is missed; where the bound keeps the limits no inverse kinematics
//! is needed. Not here: more than two blocks at once, see `follow`.

use crate::axis_limits::axis_bounds::Worst;
use crate::axis_limits::axis_path::{AxisPath, AxisPaths};
use crate::error::FiveAxisError;
use crate::pose::block::PoseBlock;
use crate::pose::swing::{RotarySwing, Swing};
use toolglide_kinematics::{
    Axis, AxisVector, GreatCircle, MAX_AXES, MachineKinematics, ToolPose, Vector, angle_between,
    turned,
};

/// Share of both blocks at which is measured what they add together.
const TOGETHER: f64 = 0.5;

/// What blocks add together is less than so many times what is measured.
const RESERVE: f64 = 2.0;

/// Where blocks turn the tool together by more than this share of its angle to the pole, what they
/// add together is not of second order any more.
const BESIDE_POLE: f64 = 0.25;

/// Nearer to the pole than this, rad, so many times as little is too much: an axis turns far there.
const NEAR_POLE: f64 = 0.15;
const STRICTER: f64 = 12.5;

/// How two blocks act together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mixed {
    /// The mixed second derivative of every axis for shares of 1.
    axes: [f64; MAX_AXES],
    /// Angle by which each block turns the tool, as a share of the angle to the pole at the corner.
    turns: [f64; 2],
}

/// What two blocks add together, by the pose in which half of one lacks while half of the other is
/// done.
pub(crate) fn mixed(
    [before, after]: [&PoseBlock; 2],
    [way_before, way_after]: [&AxisPaths; 2],
    machine: &dyn MachineKinematics,
) -> Result<Option<Mixed>, FiveAxisError> {
    if way_before.known().is_none() || way_after.known().is_none() {
        return Ok(None);
    }
    let near = way_before.last();
    let (lacking, done) = (1.0 - TOGETHER, TOGETHER);
    let both = both([before, after], [lacking, done], machine, near)?;
    let one = before.axes(lacking, machine, near)?;
    let two = after.axes(done, machine, near)?;
    let mut mixed = [0.0; MAX_AXES];
    for (axis, mixed) in mixed.iter_mut().enumerate().take(near.len()) {
        let alone = (one[axis] - near[axis]) + (two[axis] - near[axis]);
        *mixed = RESERVE * (both[axis] - near[axis] - alone).abs() / TOGETHER.powi(2);
    }
    let corner = after.turn.circle().map(GreatCircle::start);
    let pole = corner.and_then(|corner| Some((machine.pole(&corner)?, corner)));
    let turns = pole.map_or([0.0; 2], |(pole, corner)| {
        let beside = angle_between(&pole, &corner).max(f64::EPSILON);
        let weight = if beside < NEAR_POLE { STRICTER } else { 1.0 };
        [before, after].map(|block| weight * block.turn.amount() / beside)
    });
    Ok(Some(Mixed { axes: mixed, turns }))
}

/// Axis positions where one block is done up to a share of it, and the next one from its start on.
fn both(
    [before, after]: [&PoseBlock; 2],
    [lacking, done]: [f64; 2],
    machine: &dyn MachineKinematics,
    near: &AxisVector,
) -> Result<AxisVector, FiveAxisError> {
    let tip = before.tip(lacking) + (after.tip(done) - after.start);
    let refused = |reason| FiveAxisError::Machine {
        index: after.leg,
        reason,
    };
    match (&before.turn, &after.turn) {
        (Swing::Rotary(one), Swing::Rotary(two)) => {
            let mut rotary = one.at(lacking);
            for (rotary, span) in rotary.iter_mut().zip(two.spans()) {
                *rotary += done * span;
            }
            let at = RotarySwing::put(machine, &rotary, near);
            machine.place(&tip, &at).map_err(refused)
        }
        (one, two) => {
            let tool = one
                .circle()
                .map_or_else(Vector::<3>::z, |turn| turn.at(lacking));
            let tool = two.circle().map_or(tool, |turn| {
                turned(&tool, &turn.axis(), done * turn.angle())
            });
            let pose = ToolPose::new(tip, tool).map_err(|reason| FiveAxisError::Path {
                index: after.leg,
                reason,
            })?;
            machine.follow(&pose, near).map_err(refused)
        }
    }
}

/// Progress of a block over an interval.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress {
    /// Rate at the start and at the end, its change there, and how that changes.
    of_slope: [f64; 5],
    /// Largest distance from the start and from the end of the block, as a share.
    away: [f64; 2],
    /// Largest rate, its largest change, and how that changes.
    most: [f64; 3],
}

impl Progress {
    /// Progress and its derivatives in the middle of an interval, and half of its duration.
    pub(crate) fn new([share, rate, change, jolt]: [f64; 4], half: f64) -> Self {
        let rise = rate + 0.5 * jolt * half * half;
        let rates = [rise - change * half, rise + change * half];
        let changes = [change - jolt * half, change + jolt * half];
        let middle = share + 0.5 * change * half * half;
        let gone = (rate + jolt * half * half / 6.0) * half;
        let away = |share: f64| share.clamp(0.0, 1.0);
        // The rate is at its peak where its change is 0.
        let peak = if changes[0] * changes[1] < 0.0 {
            rate - 0.5 * change * change / jolt
        } else {
            0.0
        };
        Self {
            of_slope: [rates[0], rates[1], changes[0], changes[1], jolt],
            // A rate is never negative, so that the distance is largest at one of the ends.
            away: [away(middle + gone.abs()), away(1.0 - middle + gone.abs())],
            most: [
                rates[0].abs().max(rates[1].abs()).max(peak.abs()),
                changes[0].abs().max(changes[1].abs()),
                jolt.abs(),
            ],
        }
    }

    /// What the bends of a way add to the three derivatives at most, seen from its start or its `end`.
    fn of_bends(&self, way: &AxisPath, end: usize) -> [f64; 3] {
        let [rate, change, jolt] = self.most;
        let [_, second, third] = way.most;
        let away = self.away[end];
        [
            second * away * rate,
            second * (away * change + rate * rate),
            second * (away * jolt + 3.0 * rate * change) + third * rate * rate * rate,
        ]
    }

    /// What a way adds to the three derivatives at most, wherever on it.
    fn anywhere(&self, way: &AxisPath) -> [f64; 3] {
        let [rate, change, jolt] = self.most;
        let [first, second, third] = way.most;
        [
            first * rate,
            first * change + second * rate * rate,
            first * jolt + 3.0 * second * rate * change + third * rate * rate * rate,
        ]
    }
}

/// The limit that one block comes nearest to at most.
pub(crate) fn alone(axes: &[Axis], ways: &[AxisPath], progress: Progress, half: f64) -> Worst {
    let mut worst = Worst::NONE;
    for (axis, (limits, way)) in axes.iter().zip(ways).enumerate() {
        let anywhere = progress.anywhere(way);
        let from = [0, 1].map(|end| {
            let slope = progress.of_slope.map(|part| part * way.ends[end]);
            sum(slope, progress.of_bends(way, end), half)
        });
        let least =
            std::array::from_fn(|order| anywhere[order].min(from[0][order]).min(from[1][order]));
        worst.raise(axis, limits, least);
    }
    worst
}

/// The limit that two blocks come nearest to at most while they are under way together; none beside a
/// pole.
pub(crate) fn together(
    axes: &[Axis],
    ways: [&[AxisPath]; 2],
    [before, after]: [Progress; 2],
    mixed: &Mixed,
    half: f64,
) -> Option<Worst> {
    let mut worst = Worst::NONE;
    let (one, two) = (before.most, after.most);
    let (away_before, away_after) = (before.away[1], after.away[0]);
    if away_before * mixed.turns[0] + away_after * mixed.turns[1] > BESIDE_POLE {
        return None;
    }
    // What the mixed derivative is multiplied with.
    let both = [
        one[0] * away_after + two[0] * away_before,
        one[1] * away_after + 2.0 * one[0] * two[0] + two[1] * away_before,
        one[2] * away_after + 3.0 * (one[1] * two[0] + one[0] * two[1]) + two[2] * away_before,
    ];
    for (axis, limits) in axes.iter().enumerate() {
        let (one, two) = (&ways[0][axis], &ways[1][axis]);
        let slope = std::array::from_fn(|part| {
            before.of_slope[part] * one.ends[1] + after.of_slope[part] * two.ends[0]
        });
        let bends = [before.of_bends(one, 1), after.of_bends(two, 0)];
        let rest = std::array::from_fn(|order| {
            bends[0][order] + bends[1][order] + mixed.axes[axis] * both[order]
        });
        worst.raise(axis, limits, sum(slope, rest, half));
    }
    Some(worst)
}

/// Bounds of the three derivatives from what slopes add at both ends, and the rest.
fn sum(slope: [f64; 5], rest: [f64; 3], half: f64) -> [f64; 3] {
    let [begin, end, change_begin, change_end, jolt] = slope.map(f64::abs);
    [
        // A parabola is above its ends by half of this at most.
        begin.max(end) + 0.5 * jolt * half * half + rest[0],
        change_begin.max(change_end) + rest[1],
        jolt + rest[2],
    ]
}
