//! What the axes do while one or two blocks are under way, bounded by their ways alone.
//!
//! Source: the chain rule. The position of an axis is that at the corner, what each block adds to
//! it, and what they add together, which is of second order. Each is bounded over the whole interval, so
//! that nothing between instants is missed; where the bound keeps the limits no inverse kinematics
//! is needed. Not here: more than two blocks at once, see `follow`.

use crate::block::PoseBlock;
use crate::error::FiveAxisError;
use crate::follow::Worst;
use crate::way::{AxisWay, Way};
use toolglide_kinematics::{
    Axis, CubicInTime, MOST_AXES, MachineKinematics, ToolPose, cubic_at, turned,
};

/// Share of both blocks at which is measured what they add together.
const TOGETHER: f64 = 0.5;

/// What blocks add together is less than so many times what is measured.
const RESERVE: f64 = 2.0;

/// How two blocks act together on every axis: the mixed second derivative for shares of 1.
pub(crate) type Mixed = [f64; MOST_AXES];

/// What two blocks add together, by the pose in which half of one lacks while half of the other is
/// done.
pub(crate) fn mixed(
    [before, after]: [&PoseBlock; 2],
    [way_before, way_after]: [&Way; 2],
    machine: &dyn MachineKinematics,
) -> Result<Option<Mixed>, FiveAxisError> {
    if way_before.known().is_none() || way_after.known().is_none() {
        return Ok(None);
    }
    let refused = |reason| FiveAxisError::Path {
        index: after.leg,
        reason,
    };
    let (one, two) = (before.pose(1.0 - TOGETHER)?, after.pose(TOGETHER)?);
    let turn = |orientation| {
        turned(
            orientation,
            &after.turn.axis(),
            TOGETHER * after.turn.angle(),
        )
    };
    let both = ToolPose::new(
        one.tip() + (two.tip() - after.start),
        turn(&one.orientation()),
    )
    .map_err(refused)?;
    let near = way_before.last();
    let follow = |pose: &ToolPose| {
        machine
            .follow(pose, near)
            .map_err(|reason| FiveAxisError::Machine {
                index: after.leg,
                reason,
            })
    };
    let [one, two, both] = [follow(&one)?, follow(&two)?, follow(&both)?];
    let mut mixed = [0.0; MOST_AXES];
    for (axis, mixed) in mixed.iter_mut().enumerate().take(near.len()) {
        let alone = (one[axis] - near[axis]) + (two[axis] - near[axis]);
        *mixed = RESERVE * (both[axis] - near[axis] - alone).abs() / TOGETHER.powi(2);
    }
    Ok(Some(mixed))
}

/// Progress of a block over an interval.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress {
    cubic: CubicInTime,
    duration: f64,
    /// Largest distance from the corner, as a share.
    away: f64,
    /// Largest rate, its largest change, and how that changes.
    most: [f64; 3],
}

impl Progress {
    /// Progress by a polynomial; the corner is at its `end`, or at its start.
    pub(crate) fn new(cubic: CubicInTime, duration: f64, end: bool) -> Self {
        let rate = |time: f64| cubic[1] + (2.0 * cubic[2] + 3.0 * cubic[3] * time) * time;
        let change = |time: f64| 2.0 * cubic[2] + 6.0 * cubic[3] * time;
        let shares = [cubic[0], cubic_at(&cubic, duration)];
        let away = if end {
            1.0 - shares[0].min(shares[1])
        } else {
            shares[0].max(shares[1])
        };
        let turning = (-cubic[2] / (3.0 * cubic[3])).clamp(0.0, duration);
        let most = [0.0, turning, duration]
            .iter()
            .filter(|time| !time.is_nan())
            .map(|time| rate(*time).abs())
            .fold(0.0, f64::max);
        Self {
            cubic,
            duration,
            away: away.clamp(0.0, 1.0),
            most: [
                most,
                change(0.0).abs().max(change(duration).abs()),
                6.0 * cubic[3].abs(),
            ],
        }
    }

    /// What a unit of slope adds to velocity and acceleration at both ends, and to the jerk.
    fn of_slope(&self) -> [f64; 5] {
        let [_, one, two, three] = self.cubic;
        let time = self.duration;
        [
            one,
            one + (2.0 * two + 3.0 * three * time) * time,
            2.0 * two,
            2.0 * two + 6.0 * three * time,
            6.0 * three,
        ]
    }

    /// What the bends of a way add to the three derivatives at most.
    fn of_bends(&self, way: &AxisWay) -> [f64; 3] {
        let [rate, change, jolt] = self.most;
        let [_, second, third] = way.most;
        [
            second * self.away * rate,
            second * (self.away * change + rate * rate),
            second * (self.away * jolt + 3.0 * rate * change) + third * rate.powi(3),
        ]
    }

    /// What a way adds to the three derivatives at most, wherever on it.
    fn anywhere(&self, way: &AxisWay) -> [f64; 3] {
        let [rate, change, jolt] = self.most;
        let [first, second, third] = way.most;
        [
            first * rate,
            first * change + second * rate * rate,
            first * jolt + 3.0 * second * rate * change + third * rate.powi(3),
        ]
    }
}

/// The limit that one block comes nearest to at most.
pub(crate) fn alone(axes: &[Axis], way: &[AxisWay; MOST_AXES], progress: [Progress; 2]) -> Worst {
    let mut worst = Worst::NONE;
    for (axis, limits) in axes.iter().enumerate() {
        let way = &way[axis];
        let anywhere = progress[0].anywhere(way);
        let from = [0, 1].map(|end| {
            let slope = progress[end].of_slope().map(|part| part * way.ends[end]);
            sum(slope, progress[end].of_bends(way), progress[end].duration)
        });
        let least =
            std::array::from_fn(|order| anywhere[order].min(from[0][order]).min(from[1][order]));
        worst.raise(axis, limits, least);
    }
    worst
}

/// The limit that two blocks come nearest to at most while they are under way together.
pub(crate) fn together(
    axes: &[Axis],
    ways: [&[AxisWay; MOST_AXES]; 2],
    progress: [Progress; 2],
    mixed: &Mixed,
) -> Worst {
    let [before, after] = progress;
    let mut worst = Worst::NONE;
    let slopes = progress.map(|progress| progress.of_slope());
    for (axis, limits) in axes.iter().enumerate() {
        let (one, two) = (&ways[0][axis], &ways[1][axis]);
        let slope = std::array::from_fn(|part| {
            slopes[0][part] * one.ends[1] + slopes[1][part] * two.ends[0]
        });
        let bends = [before.of_bends(one), after.of_bends(two)];
        let mixed = mixed[axis];
        let (one, two) = (before.most, after.most);
        let both = [
            mixed * (one[0] * after.away + two[0] * before.away),
            mixed * (one[1] * after.away + 2.0 * one[0] * two[0] + two[1] * before.away),
            mixed
                * (one[2] * after.away
                    + 3.0 * (one[1] * two[0] + one[0] * two[1])
                    + two[2] * before.away),
        ];
        let rest = std::array::from_fn(|order| bends[0][order] + bends[1][order] + both[order]);
        worst.raise(axis, limits, sum(slope, rest, before.duration));
    }
    worst
}

/// Bounds of the three derivatives from what slopes add at both ends, and the rest.
fn sum(slope: [f64; 5], rest: [f64; 3], duration: f64) -> [f64; 3] {
    let [begin, end, change_begin, change_end, jolt] = slope.map(f64::abs);
    [
        // A parabola is above its ends by an eighth of this at most.
        begin.max(end) + jolt * duration * duration / 8.0 + rest[0],
        change_begin.max(change_end) + rest[1],
        jolt + rest[2],
    ]
}
