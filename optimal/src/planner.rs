//! Plans time-optimal motion, and smoothed corners where they are faster.
//!
//! Source: ours. Both plan the whole path; of every stretch the faster motion is handed out, so that it is
//! never slower than smoothed corners. Not here: either plan, and what a stretch is.

use crate::best_of::FasterOf;
use crate::path::spans::weakest;
use crate::settings::Settings;
use crate::solver::sequential::ScpSolver;
use crate::stream::Stream;
use crate::window::WindowSolver;
use crate::window::horizon::{MAX_SPANS, ROOM};
use crate::window::output::Event;
use toolglide_kinematics::{
    Limits, MotionPlanner, Move, PathCursor, PathLimits, PathSide, Piece, Plan, PlanError,
    Toolpath, Vector, WindowTally,
};
use toolglide_smoothing::KinematicSmoothing;

/// What a stop costs at the most, in times to stop from the largest velocity of any axis.
const STOP_COST: f64 = 4.0;

/// Plans time-optimal motion while the path is being read.
#[derive(Clone, Debug)]
pub struct TimeOptimal<const N: usize, S = ScpSolver<N>> {
    intake: PathCursor<N>,
    optimal: Stream<S, N>,
    smoothing: KinematicSmoothing<N>,
    race: FasterOf<N>,
    /// Whether modes of vibration must rest, or a side is kept: then smoothed corners are no alternative.
    alone: bool,
    lost: bool,
}

impl<const N: usize> TimeOptimal<N> {
    /// A planner whose motion begins at rest at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, settings: &Settings<N>) -> Self {
        Self::with_solver(solver(settings), start, settings)
    }
}

impl<const N: usize, S: WindowSolver<N>> TimeOptimal<N, S> {
    /// A planner whose motion begins at rest at `start`, with a solver for its windows.
    #[must_use]
    pub fn with_solver(solver: S, start: Vector<N>, settings: &Settings<N>) -> Self {
        Self {
            alone: !settings.modes.is_empty() || settings.side != PathSide::Both,
            lost: false,
            intake: PathCursor::new(start),
            optimal: Stream::new(solver, start, settings),
            smoothing: KinematicSmoothing::new(
                start,
                &toolglide_smoothing::Settings::new(settings.limits),
            ),
            race: FasterOf::new(
                STOP_COST * time_to_stop(&settings.limits),
                settings.smoothing.indifference(),
            ),
        }
    }
}

/// The solver of the windows of a plan.
fn solver<const N: usize>(settings: &Settings<N>) -> ScpSolver<N> {
    ScpSolver::with_room(MAX_SPANS, ROOM)
        .with_smoothing(settings.smoothing)
        .with_room_for_modes(settings.modes.len(), MAX_SPANS, ROOM)
}

/// Time to stop from the largest velocity of any axis with the weakest acceleration and jerk, s.
fn time_to_stop<const N: usize>(limits: &Limits<N>) -> f64 {
    let velocity = limits.velocity().max();
    let (acceleration, jerk) = weakest(limits);
    let weak = PathLimits {
        velocity,
        acceleration,
        jerk,
    };
    weak.time_to_change(velocity)
}

impl<const N: usize, S: WindowSolver<N>> MotionPlanner<N> for TimeOptimal<N, S> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        let index = self.intake.take(next)?;
        if self.lost || self.race.is_broken() {
            return Err(PlanError::Magnitude { index });
        }
        if self.alone {
            self.optimal.push(next);
            return Ok(());
        }
        let leads = self.race.leads();
        self.optimal.lead(leads);
        let next = if self.race.wants_stop() || leads && self.optimal.is_short() {
            next.with_exact_stop()
        } else {
            *next
        };
        self.smoothing.push(&next)?;
        self.optimal.push(&next);
        if next.stops() {
            self.race.end_at(index);
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        if self.intake.close() {
            if self.lost || self.race.is_broken() {
                let index = self.intake.count();
                return Err(PlanError::Magnitude { index });
            }
            if self.alone {
                self.optimal.finish();
                return Ok(());
            }
            self.smoothing.finish()?;
            self.optimal.finish();
            self.race.end_at(self.intake.count().saturating_sub(1));
            self.race.finish();
        }
        Ok(())
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        while self.alone {
            match self.optimal.pull()? {
                Event::Piece(piece) => return Some(piece),
                Event::Lost => self.lost = true,
                Event::Rest(_) | Event::Joint(_) => {}
            }
        }
        loop {
            self.race
                .gather(|| self.optimal.pull(), || self.smoothing.pull());
            let before = self.race.held();
            if let Some(piece) = self.race.next() {
                return Some(piece);
            }
            if before == self.race.held() {
                return None;
            }
        }
    }

    fn windows(&self) -> Option<WindowTally> {
        let (stretches, yielded) = self.race.tally();
        Some(WindowTally {
            stretches,
            yielded,
            ..self.optimal.tally()
        })
    }
}

/// Plans a whole toolpath: a loop over the streaming planner.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Feedrate, Limits, Tolerance, Toolpath, Trajectory, Vector};
/// use toolglide_optimal::{Settings, plan};
/// let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
/// let path = Toolpath::from_points(&corner, Feedrate::new(100.0)?, Tolerance::new(0.1)?)?;
/// let motion = plan(&path, &Settings::new(Limits::uniform(500.0, 2500.0, 2e5)?))?;
/// // Smoothed corners take 0.2793 s; the optimum is 0.2715 s.
/// assert!(motion.duration() < 0.2725, "{}", motion.duration());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`MotionPlanner::push`].
pub fn plan<const N: usize>(
    path: &Toolpath<N>,
    settings: &Settings<N>,
) -> Result<Plan<N>, PlanError> {
    plan_with(solver(settings), path, settings)
}

/// Plans a whole toolpath with a solver for its windows.
///
/// # Errors
/// As [`MotionPlanner::push`].
pub fn plan_with<S: WindowSolver<N>, const N: usize>(
    solver: S,
    path: &Toolpath<N>,
    settings: &Settings<N>,
) -> Result<Plan<N>, PlanError> {
    Plan::of(
        path,
        &mut TimeOptimal::with_solver(solver, path.start(), settings),
    )
}
