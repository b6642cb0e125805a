//! Rounds corners by curvature-optimal quintics, the baseline of the dissertation.
//!
//! Source: Sencer, Ishizaki and Shamoto (2015). Each corner is replaced by one symmetric quintic
//! Bezier curve that fits the tolerance and half of each leg, is travelled at constant speed, and is
//! joined by jerk-limited changes of speed on the straight parts alone. What cannot be rounded, or not
//! faster than by a stop, is a stop. Not here: anything that makes corners faster than that.

mod bend;
mod course;
mod quintic;

use course::Course;
use toolglide_kinematics::{
    Limits, MotionPlanner, Move, MoveRange, Path, PathCursor, Pause, Piece, Plan, PlanError,
    Toolpath, Vector,
};
use toolglide_smoothing::parts::{Chords, MERGE_SHARE, Vertex};

/// Jerk of a corner without a limit, in limits: beyond what any corner of a machine asks for.
const FREE_JERK: f64 = 1e4;

/// Plans corners of curvature-optimal quintics while the path is being read.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Feedrate, Limits, Tolerance, Toolpath, Trajectory, Vector};
/// use toolglide_baselines::plan_bezier;
/// let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
/// let path = Toolpath::from_points(&corner, Feedrate::new(100.0)?, Tolerance::new(0.1)?)?;
/// let motion = plan_bezier(&path, &Limits::uniform(500.0, 2500.0, 2e6)?)?;
/// // Stopping at the corner would take 0.2825 s.
/// assert!(motion.duration() < 0.28);
/// assert_eq!(motion.end(), path.end());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct BezierSmoothing<const N: usize> {
    intake: PathCursor<N>,
    arc: Option<(Chords<N>, Move<N>, u32)>,
    course: Box<Course<N>>,
}

impl<const N: usize> BezierSmoothing<N> {
    /// A planner whose motion begins at rest at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, limits: Limits<N>) -> Self {
        Self {
            intake: PathCursor::new(start),
            arc: None,
            course: Box::new(Course::new(start, limits, limits)),
        }
    }

    /// The same without a limit of jerk at the corners, as section 2.3.2 describes its baseline: acceleration alone bounds the
    /// speed through a corner. The motion breaks the jerk limit there.
    ///
    /// # Errors
    /// [`LimitsError`](toolglide_kinematics::LimitsError) for limits that have no room for a larger jerk.
    pub fn without_corner_jerk(
        start: Vector<N>,
        limits: Limits<N>,
    ) -> Result<Self, toolglide_kinematics::LimitsError> {
        let mut axes = Vec::with_capacity(N);
        for axis in 0..N {
            axes.push(toolglide_kinematics::AxisLimits::new(
                limits.velocity()[axis],
                limits.acceleration()[axis],
                limits.jerk()[axis] * FREE_JERK,
            )?);
        }
        let mut free = limits;
        if let Ok(axes) = <[toolglide_kinematics::AxisLimits; N]>::try_from(axes) {
            free = Limits::new(axes);
        }
        Ok(Self {
            intake: PathCursor::new(start),
            arc: None,
            course: Box::new(Course::new(start, limits, free)),
        })
    }

    /// Takes the next chord of the arc under way; `false` when there is none.
    fn advance_arc(&mut self) -> bool {
        let Some((chords, step, index)) = &mut self.arc else {
            return false;
        };
        let (step, index, bulge) = (*step, *index, chords.bulge());
        match chords.next() {
            Some(point) => self.take_point(&step, index, point, bulge),
            None => {
                self.arc = None;
                if step.stops() {
                    self.course.rest();
                }
                if self.intake.is_closed() {
                    self.course.close();
                }
            }
        }
        true
    }

    fn take_point(&mut self, step: &Move<N>, index: u32, point: Vector<N>, bulge: f64) {
        self.course.push(Vertex {
            point,
            bulge,
            bend: None,
            feedrate: step.feedrate().speed(),
            tolerance: step.tolerance(),
            serves: MoveRange::one(index),
            next: 0,
        });
    }
}

impl<const N: usize> MotionPlanner<N> for BezierSmoothing<N> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        let index = self.intake.take(next)?;
        while self.advance_arc() {}
        match next.path() {
            Path::Line { end } => {
                self.take_point(next, index, *end, 0.0);
                if next.stops() {
                    self.course.rest();
                }
            }
            Path::Arc(arc) => {
                let chords = Chords::new(*arc, MERGE_SHARE * next.tolerance().length());
                self.arc = Some((chords, *next, index));
            }
            Path::Dwell { duration } => self.course.dwell(Pause {
                duration: *duration,
                serves: MoveRange::one(index),
                end: self.intake.end(),
            }),
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        if self.intake.close() && self.arc.is_none() {
            self.course.close();
        }
        Ok(())
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        loop {
            if let Some(piece) = self.course.pull() {
                return Some(piece);
            }
            if !self.advance_arc() {
                return None;
            }
        }
    }
}

/// Plans a whole toolpath with corners of curvature-optimal quintics.
///
/// # Errors
/// As [`MotionPlanner::push`].
pub fn plan_bezier<const N: usize>(
    path: &Toolpath<N>,
    limits: &Limits<N>,
) -> Result<Plan<N>, PlanError> {
    Plan::of(path, &mut BezierSmoothing::new(path.start(), *limits))
}
