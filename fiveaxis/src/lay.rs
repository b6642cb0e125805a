//! Pieces of tool motion from steps of blocks.
//!
//! Source: filtered velocity pulses integrate to a filtered position (section 5.2). The orientation
//! is the product of the turns of the blocks that are under way, the oldest first, each by its own
//! filtered angle: of unit length always, on the great circle while one block is alone, and exactly
//! as programmed when it is over. Not here: when the steps are.

use crate::block::PoseBlock;
use crate::steps::Steps;
use toolglide_fir::FilterChain;
use toolglide_kinematics::{
    CubicInTime, PosePiece, Sample, Serves, ToolPiece, ToolPose, Turn, Vector,
};

/// Knots nearer than this are one, s: what the motion does between them is below every rounding.
const SAME_KNOT: f64 = 1e-11;

/// Increasing times between which every step response of a stretch is one polynomial.
pub(crate) fn knots(steps: &[Steps], chain: &FilterChain) -> Vec<f64> {
    let [long, short] = *chain.time_constants() else {
        return Vec::new();
    };
    let mut knots: Vec<f64> = steps
        .iter()
        .flat_map(|steps| {
            steps
                .times()
                .flat_map(|time| [time, time + short, time + long, time + long + short])
        })
        .collect();
    knots.sort_by(f64::total_cmp);
    knots.dedup_by(|later, kept| *later - *kept < SAME_KNOT);
    knots
}

/// The same within a stretch of time, and its ends.
pub(crate) fn knots_within(
    steps: &[Steps],
    chain: &FilterChain,
    [begin, end]: [f64; 2],
) -> Vec<f64> {
    let mut knots = knots(steps, chain);
    knots.retain(|knot| (begin - SAME_KNOT..=end + SAME_KNOT).contains(knot));
    knots
}

/// Blocks under way in every interval between knots: first and last.
pub(crate) fn intervals<'a>(
    steps: &'a [Steps],
    knots: &'a [f64],
    chain: &FilterChain,
) -> impl Iterator<Item = ([f64; 2], [usize; 2])> + 'a {
    let delay = chain.total_delay();
    let (mut oldest, mut newest) = (0, 0);
    knots.windows(2).map(move |pair| {
        while oldest + 1 < steps.len() && steps[oldest].command_end() + delay <= pair[0] + SAME_KNOT
        {
            oldest += 1;
        }
        newest = newest.max(oldest);
        while newest + 1 < steps.len() && steps[newest + 1].begin() < pair[1] - SAME_KNOT {
            newest += 1;
        }
        ([pair[0], pair[1]], [oldest, newest])
    })
}

/// The piece of tool motion in one interval, with the blocks that are under way.
pub(crate) fn piece(
    blocks: &[PoseBlock],
    steps: &[Steps],
    chain: &FilterChain,
    [begin, end]: [f64; 2],
    [oldest, newest]: [usize; 2],
) -> ToolPiece {
    let mut tip = Sample::at_rest(blocks[oldest].start);
    let mut turns = Vec::with_capacity(newest + 1 - oldest);
    let inside = 0.5 * (begin + end);
    for (block, steps) in blocks[oldest..=newest].iter().zip(&steps[oldest..=newest]) {
        let progress = steps.cubic(chain, begin, inside);
        let span = block.end - block.start;
        tip.position += span * progress[0];
        tip.velocity += span * progress[1];
        tip.acceleration += span * (2.0 * progress[2]);
        tip.jerk += span * (6.0 * progress[3]);
        if block.turn.angle() > 0.0 {
            turns.push(Turn {
                axis: block.turn.axis(),
                angle: scaled(&progress, block.turn.angle()),
            });
        }
    }
    let last = &blocks[newest];
    let over = steps[newest].command_end() + chain.total_delay() <= end + SAME_KNOT;
    let mut piece = ToolPiece {
        tip,
        base: blocks[oldest].turn.start(),
        turns,
        end: pose(last.end, last.turn.end()),
        duration: end - begin,
        serves: Serves {
            first: blocks[oldest].leg,
            last: last.leg,
        },
    };
    if !over {
        piece.end = piece.extended(piece.duration);
    }
    piece
}

/// A piece of standing still.
pub(crate) fn rest(pose: ToolPose, duration: f64, leg: u32) -> PosePiece {
    PosePiece::Tool(ToolPiece {
        tip: Sample::at_rest(pose.tip()),
        base: pose.orientation(),
        turns: Vec::new(),
        end: pose,
        duration,
        serves: Serves {
            first: leg,
            last: leg,
        },
    })
}

fn pose(tip: Vector<3>, orientation: Vector<3>) -> ToolPose {
    // Both come from a pose, so that neither is refused.
    ToolPose::new(tip, orientation).unwrap_or_else(|_| unreachable!("ends of legs are poses"))
}

pub(crate) fn scaled(cubic: &CubicInTime, factor: f64) -> CubicInTime {
    cubic.map(|coefficient| coefficient * factor)
}
