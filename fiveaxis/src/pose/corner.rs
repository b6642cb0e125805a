//! Computes the blend time at a corner of poses inside both tolerances.
//!
//! Source: sections 5.3.1 and 5.3.2. At a corner the motion lacks `b` of the move before and has `a`
//! of the move after. On the tip that is a distance |a t2 - b t1|, and on the sphere equation 5.27,
//! exactly. Both are inside the tolerance when `a` and `b` are the *reach* of the corner, which
//! has a closed form; the quartics 5.31 to 5.33 and 5.43 to 5.47 are not needed, and feedrates may
//! differ. Not here: more than two moves at once, see `accumulate`.

use crate::pose::block::PoseBlock;
use toolglide_fir::FilterChain;
use toolglide_kinematics::Vector;

/// A corner, as its reach: how far from it both moves may be at the same time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseCorner {
    /// Reach of the tip, mm; infinite where the path goes straight on.
    pub tip: f64,
    /// Reach of the orientation, rad; infinite where the tool goes on turning about one axis.
    pub orientation: f64,
    /// Twice the sine of half the turn of the tip.
    pub tip_turn: f64,
    /// Twice the sine of half the turn of the axis about which the tool turns, or of the way of the rotary axes.
    pub orientation_turn: f64,
    /// Tolerance of the tip at the corner, mm.
    pub tip_tolerance: f64,
    /// Tolerance of the orientation at the corner, rad.
    pub orientation_tolerance: f64,
}

/// Twice the sine of half the angle between two unit vectors.
fn turn_between(one: &Vector<3>, other: &Vector<3>) -> f64 {
    (other - one).norm()
}

impl PoseCorner {
    /// The corner between two blocks.
    ///
    /// # Examples
    /// ```
    /// use toolglide_fiveaxis::{PoseBlock, PoseCorner};
    /// use toolglide_kinematics::{
    ///     Feedrate, OrientationTolerance, PoseFeed, PoseLeg, Tolerance, ToolPose, Vector,
    /// };
    /// let pose = |x, y| ToolPose::upright(Vector::<3>::new(x, y, 0.0));
    /// let block = |start, end, number| {
    ///     let leg = PoseLeg::between(
    ///         &start,
    ///         &end,
    ///         PoseFeed::Speed(Feedrate::new(50.0)?),
    ///         Tolerance::new(0.01)?,
    ///         OrientationTolerance::new(0.01)?,
    ///     )?;
    ///     Ok::<_, toolglide_kinematics::ToolpathError>(PoseBlock::of(&leg, number, f64::INFINITY))
    /// };
    /// let before = block(pose(0.0, 0.0)?, pose(10.0, 0.0)?, 0)?;
    /// let after = block(pose(10.0, 0.0)?, pose(10.0, 10.0)?, 1)?;
    /// let corner = PoseCorner::between(&before.unwrap(), &after.unwrap());
    /// assert!((corner.tip - 0.01 / 2.0_f64.sqrt()).abs() < 1e-12);
    /// assert!(corner.orientation.is_infinite(), "the tool does not turn");
    /// # Ok::<(), toolglide_kinematics::ToolpathError>(())
    /// ```
    #[must_use]
    pub fn between(before: &PoseBlock, after: &PoseBlock) -> Self {
        Self::of_parts([before, after], [before, after])
    }

    /// The corner between two blocks whose tip and tool last moved, and next move, in others.
    pub(crate) fn of_parts(tip: [&PoseBlock; 2], orientation: [&PoseBlock; 2]) -> Self {
        let [before, after] = tip;
        let tip_tolerance = before.tip_tolerance.min(after.tip_tolerance);
        let tip_turn = if before.length > 0.0 && after.length > 0.0 {
            turn_between(
                &((before.end - before.start) / before.length),
                &((after.end - after.start) / after.length),
            )
        } else {
            0.0
        };
        let [before, after] = orientation;
        let orientation_tolerance = before
            .orientation_tolerance
            .min(after.orientation_tolerance);
        let orientation_turn = after.turn.turn_from(&before.turn);
        let orientation = if after.turn.rotary().is_some() {
            orientation_tolerance / orientation_turn
        } else {
            orientation_reach(orientation_tolerance, orientation_turn)
        };
        Self {
            tip: tip_tolerance / tip_turn,
            orientation,
            tip_turn,
            orientation_turn,
            tip_tolerance,
            orientation_tolerance,
        }
    }

    /// How long the transients of the two blocks may overlap, s; at most the delay of the chain,
    /// where nothing dwells.
    ///
    /// # Source
    /// In place of equations 5.24 and 5.27 to 5.35: the shorter overlap of tip and orientation.
    #[must_use]
    pub fn overlap(&self, before: &PoseBlock, after: &PoseBlock, chain: &FilterChain) -> f64 {
        let time = |reach: f64, rates: [f64; 2]| {
            if rates[0].min(rates[1]) > 0.0 && reach.is_finite() {
                chain.time_to(reach / rates[0]) + chain.time_to(reach / rates[1])
            } else {
                f64::INFINITY
            }
        };
        time(self.tip, [before.feedrate(), after.feedrate()])
            .min(time(
                self.orientation,
                [before.turn_rate(), after.turn_rate()],
            ))
            .min(chain.total_delay())
    }

    /// The share of its speed at which a block may be near the corner for half the delay of the
    /// chain so that nothing dwells there.
    ///
    /// # Source
    /// In place of equations 5.36 to 5.47, with one scale for tip and orientation and each block by
    /// itself.
    #[must_use]
    pub fn slow_share(&self, block: &PoseBlock, chain: &FilterChain) -> f64 {
        // What is commanded at unit rate for half the delay, and has come through by its end.
        let gone = chain.position(0.5 * chain.total_delay());
        let share = |reach: f64, rate: f64| {
            if rate > 0.0 {
                reach / (gone * rate)
            } else {
                f64::INFINITY
            }
        };
        share(self.tip, block.feedrate())
            .min(share(self.orientation, block.turn_rate()))
            .min(1.0)
    }
}

/// How far two turns may both be from their common orientation so that the tool, turned by both, is
/// within a tolerance of it.
///
/// # Source
/// Equation 5.27 with equal angles: sin(tolerance / 2) = sin(reach) sin(turn / 2), solved.
fn orientation_reach(tolerance: f64, turn: f64) -> f64 {
    let sine = (0.5 * tolerance).sin() / (0.5 * turn);
    if sine < 1.0 {
        sine.asin()
    } else {
        f64::INFINITY
    }
}
