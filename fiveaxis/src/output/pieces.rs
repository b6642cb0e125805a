//! Builds pieces of tool motion from the commanded progress of blocks.
//!
//! Source: filtered velocity pulses integrate to a filtered position (section 5.2). The orientation
//! is the product of the turns of the blocks that are under way, the oldest first, each by its own
//! filtered angle: of unit length always, on the great circle while one block is alone, and exactly
//! as programmed when it is over. Not here: when the steps are.

use crate::pose::block::PoseBlock;
use crate::pose::swing::{RotarySwing, Swing};
use crate::timing::commanded_progress::Steps;
use toolglide_fir::FilterChain;
use toolglide_kinematics::{
    Axis, AxisKind, AxisVector, CubicInTime, MoveRange, PosePiece, RotaryPiece, Sample, ToolPiece,
    ToolPose, Turn, Vector,
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
    kinds: &[Axis],
    steps: &[Steps],
    chain: &FilterChain,
    [begin, end]: [f64; 2],
    [oldest, newest]: [usize; 2],
) -> PosePiece {
    let mut tip = Sample::at_rest(blocks[oldest].start);
    let mut turns = Vec::with_capacity(newest + 1 - oldest);
    let mut rotary = Rotary::of(&blocks[oldest], kinds);
    let inside = 0.5 * (begin + end);
    for (block, steps) in blocks[oldest..=newest].iter().zip(&steps[oldest..=newest]) {
        let progress = steps.cubic(chain, begin, inside);
        let span = block.end - block.start;
        tip.position += span * progress[0];
        tip.velocity += span * progress[1];
        tip.acceleration += span * (2.0 * progress[2]);
        tip.jerk += span * (6.0 * progress[3]);
        match &block.turn {
            Swing::Circle(turn) if turn.angle() > 0.0 => turns.push(Turn {
                axis: turn.axis(),
                angle: scaled(&progress, turn.angle()),
            }),
            Swing::Circle(_) => {}
            Swing::Rotary(swing) => rotary.add(swing, &progress),
        }
    }
    let last = &blocks[newest];
    let over = steps[newest].command_end() + chain.total_delay() <= end + SAME_KNOT;
    let duration = end - begin;
    let serves = MoveRange {
        first: blocks[oldest].leg,
        last: last.leg,
    };
    let turn = match (&blocks[oldest].turn, &last.turn) {
        (Swing::Circle(first), Swing::Circle(last)) => (first.start(), last.end()),
        (_, last) => return rotary.piece(tip, (last, over), blocks[newest].end, duration, serves),
    };
    let mut piece = ToolPiece {
        tip,
        base: turn.0,
        turns,
        end: pose(last.end, turn.1),
        duration,
        serves,
    };
    if !over {
        piece.end = piece.extended(piece.duration);
    }
    PosePiece::Tool(piece)
}

/// Rotary axes against time, as they are added up.
struct Rotary {
    cubics: Vec<Option<CubicInTime>>,
}

impl Rotary {
    fn of(first: &PoseBlock, kinds: &[Axis]) -> Self {
        let Some(swing) = first.turn.rotary() else {
            return Self { cubics: Vec::new() };
        };
        let axes = kinds.iter().zip(swing.start().iter());
        Self {
            cubics: axes
                .map(|(axis, &start)| {
                    (axis.kind == AxisKind::Rotary).then_some([start, 0.0, 0.0, 0.0])
                })
                .collect(),
        }
    }

    fn add(&mut self, swing: &RotarySwing, progress: &CubicInTime) {
        for (cubic, span) in self.cubics.iter_mut().zip(swing.spans()) {
            if let Some(cubic) = cubic {
                for (sum, part) in cubic.iter_mut().zip(scaled(progress, span)) {
                    *sum += part;
                }
            }
        }
    }

    fn piece(
        self,
        tip: Sample<3>,
        (last, over): (&Swing, bool),
        end_tip: Vector<3>,
        duration: f64,
        serves: MoveRange,
    ) -> PosePiece {
        let mut piece = RotaryPiece {
            tip,
            end: last
                .rotary()
                .map_or(AxisVector::zeros(self.cubics.len()), |swing| swing.at(1.0)),
            rotary: self.cubics,
            end_tip,
            duration,
            serves,
        };
        if !over {
            (piece.end_tip, piece.end) = piece.extended(duration, &piece.end);
        }
        PosePiece::Rotary(piece)
    }
}

/// A piece of standing still.
pub(crate) fn rest(pose: ToolPose, duration: f64, leg: u32) -> PosePiece {
    PosePiece::Tool(ToolPiece {
        tip: Sample::at_rest(pose.tip()),
        base: pose.orientation(),
        turns: Vec::new(),
        end: pose,
        duration,
        serves: MoveRange {
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
