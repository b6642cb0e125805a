//! Offers the time-optimal motion as a planning method for short programs.
//!
//! Source: each section between stops is one optimum. A section of more than [`LONGEST`] legs is cut
//! at a sharp corner, where the motion then stops, so that memory stays bounded and the time grows with
//! the length of the program only. Not here: streaming without such stops.

use crate::course::Course;
use crate::optimum::{Settings, upper_bound};
use crate::sections::{Section, Sections};
use crate::straight::{Straight, along};
use std::collections::VecDeque;
use toolglide_kinematics::{
    Limits, MotionPlanner, Move, MoveRange, Piece, Plan, PlanError, Sample, Toolpath, Vector,
};

/// Legs that are planned as one at most.
pub const LONGEST: usize = 96;

/// Plans the time-optimal motion between stops.
///
/// It takes about a second for ten moves, and a minute for a hundred. Where the solver fails, a course
/// is halved; a single leg has its closed form, so there is always a motion.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Feedrate, Limits, Tolerance, Toolpath, Trajectory, Vector};
/// let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
/// let path = Toolpath::from_points(&corner, Feedrate::new(100.0)?, Tolerance::new(0.1)?)?;
/// let motion = toolglide_reference::plan(&path, Limits::uniform(500.0, 2500.0, 2e5)?)?;
/// // Stopping at the corner would take 0.305 s.
/// assert!((motion.duration() - 0.2715).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ReferencePlanner<const N: usize> {
    sections: Sections<N>,
    settings: Settings,
    pieces: VecDeque<Piece<N>>,
    pushed: u32,
    finished: bool,
}

/// Plans a whole toolpath.
///
/// # Errors
/// As [`MotionPlanner::push`].
pub fn plan<const N: usize>(path: &Toolpath<N>, limits: Limits<N>) -> Result<Plan<N>, PlanError> {
    let mut planner = ReferencePlanner::new(path.start(), limits);
    for next in path.moves() {
        planner.push(next)?;
    }
    planner.finish()?;
    let mut plan = Plan::starting_at(path.start());
    plan.extend(std::iter::from_fn(|| planner.pull()));
    Ok(plan)
}

impl<const N: usize> ReferencePlanner<N> {
    /// A planner at rest at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, limits: Limits<N>) -> Self {
        Self {
            sections: Sections::new(start, limits),
            settings: Settings::default(),
            pieces: VecDeque::new(),
            pushed: 0,
            finished: false,
        }
    }

    fn take(&mut self, section: Section<N>) {
        match section {
            Section::Course(course) => self.along(&course),
            Section::Rest {
                duration,
                place,
                serves,
            } => {
                let serves = MoveRange::one(serves);
                let still = Sample::at_rest(place);
                self.pieces
                    .push_back(Piece::new(&still, duration, place, serves));
            }
        }
    }

    fn along(&mut self, course: &Course<N>) {
        if let [leg] = course.legs.as_slice() {
            let straight = Straight::over(leg.length, &along(&course.limits, leg));
            self.pieces.extend(straight.pieces(leg));
            return;
        }
        match upper_bound(course, &[course.stopping_times()], &self.settings) {
            Ok(optimum) => self.pieces.extend(optimum.plan().pieces().iter().copied()),
            Err(_) => {
                let (one, other) = course.halves();
                self.along(&one);
                self.along(&other);
            }
        }
    }
}

impl<const N: usize> MotionPlanner<N> for ReferencePlanner<N> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        if self.finished {
            return Err(PlanError::Finished { index: self.pushed });
        }
        for section in self.sections.push(next)?.into_iter().flatten() {
            self.take(section);
        }
        self.pushed += 1;
        while self.sections.legs() > LONGEST
            && let Some(section) = self.sections.cut_at_sharpest()
        {
            self.take(section);
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        self.finished = true;
        if let Some(section) = self.sections.cut() {
            self.take(section);
        }
        Ok(())
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        self.pieces.pop_front()
    }
}
