//! Verifies that a motion keeps its limits and follows its path, at every instant.
//!
//! Source: the meaning of [`toolglide_kinematics::Tolerance`] and the limits of section 2.2, at every instant. Not
//! here: any formula of any planner. The judge knows pieces of constant jerk, or set-points, and
//! the true path of lines and arcs.
//!
//! A motion passes when
//! - every axis keeps its limits of velocity, acceleration and jerk, and the speed keeps the
//!   largest feedrate of the moves served,
//! - every point lies within the tolerance of the path, the true arc where there is one,
//! - every corner is passed within the smaller tolerance of its two moves, in path order,
//! - every exact stop is made at its point, and every dwell lasts,
//! - position, velocity and acceleration never jump,
//! - it starts and ends at rest, at the start and the end of the path.
//!
//! Set-points must also be near enough to each other to show all this, see [`Gaps`].

mod executed;
pub(crate) mod path;
pub(crate) mod pieces;
mod poses;
mod quality;
mod report;
mod set_points;
mod violation;

#[cfg(test)]
mod tests;

pub use executed::{EXECUTED_SLACK, ExecutedJudge};
pub use path::course::{Course, CourseFoot};
pub use pieces::judge::Judge;
pub use poses::{
    AxisPeaks, AxisQuantity, PoseCourse, PoseFoot, PoseJudge, PoseReport, PoseSetPointJudge,
    PoseViolation, keeps_axis_limits,
};
pub use quality::{FeedRipple, ModeSwing, Smoothness, USUAL_FREQUENCY};
pub use report::{Peak, Place, Report};
pub use set_points::spacing::{Gap, Gaps, Unseen};
pub use set_points::{SetPointJudge, VerifyError, verify_set_points};
pub use violation::Violation;

use toolglide_kinematics::Limits;
use toolglide_kinematics::Plan;
use toolglide_kinematics::Toolpath;

/// Judges a whole plan against the path that it should follow.
///
/// # Examples
/// ```
/// use toolglide_verify::verify;
/// use toolglide_kinematics::{Limits, Plan, Toolpath, Vector};
/// let path = Toolpath::starting_at(Vector::<2>::zeros())?;
/// let report = verify(&Plan::starting_at(path.start()), &path, &Limits::uniform(1.0, 1.0, 1.0)?);
/// assert!(report.passes(), "{:?}", report.examples);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn verify<const N: usize>(plan: &Plan<N>, path: &Toolpath<N>, limits: &Limits<N>) -> Report<N> {
    let mut judge = Judge::new(path.start(), *limits);
    let mut moves = path.moves().iter();
    let mut expected = 0_u32;
    for piece in plan.pieces() {
        // One move more than is served, so that the corner at its end has its tolerance.
        while expected <= piece.serves().last.saturating_add(1)
            && let Some(next) = moves.next()
        {
            // A toolpath has checked its moves already.
            let _ = judge.expect(next);
            expected += 1;
        }
        judge.observe(piece);
    }
    for next in moves {
        let _ = judge.expect(next);
    }
    judge.finish()
}
