//! Finds the durations of a window by sequential convex programming in a trust region.
//!
//! With the durations fixed, the motion through a window is a convex problem; with them free it is
//! linearised where the last one ended, shortened within a trust region, and linearised again. The
//! point of linearisation need not obey the dynamics, because the next problem makes it so. Every
//! fourth time, and at the end, the motion is restored with the durations fixed; only a restored
//! motion is an answer. Where none can be restored, the durations grow a little.
//!
//! Source: sequential convex programming; the linearisation in the durations is our own. Not here:
//! how one problem is solved, see [`interior`](crate::solver::interior).

use crate::problem::b_spline::State;
use crate::problem::{Problem, count};
use crate::settings::Smoothing;
use crate::solver::budget::Budget;
use crate::solver::interior::{Ending, Goal, Interior, Precision};
use crate::window::{
    EndState, Silence, Solved, Unsolved, Window, WindowDefect, WindowMotion, WindowSolver,
};
use toolglide_kinematics::{AxisMode, ModeState, Vector, vector::is_finite};

/// Weight of the excess against the duration: ten leaves local minima with an excess, from fifty on
/// it makes no difference.
const EXCESS_WEIGHT: f64 = 50.0;

/// Share by which a duration may change at first; below the least the window is given up.
const FIRST_TRUST: f64 = 0.4;
const MIN_TRUST: f64 = 1e-3;

/// Share to which the trust falls at least where a motion cannot be restored.
const RESTORED_TRUST: f64 = 0.02;

/// What is left of [`ENOUGH`] by the next trust where nothing is gained anymore: durations then go to and
/// fro as far as they may, and the excess goes with the square of that.
const LEAVES: f64 = 0.5;

/// A predicted gain below this share of the duration is not worth another problem.
const MIN_GAIN: f64 = 1e-3;

/// Excess that counts as none: the caller leaves a margin of twice that.
const ENOUGH: f64 = 1e-4;

/// Excess at which a restoration ends early.
const PLENTY: f64 = 2e-5;

/// After so many shortenings the motion is restored.
const RESTORE_EVERY: usize = 4;

/// Shortenings more, carefully, where no motion was restored.
const REPAIRS: usize = 2;
const REPAIR_TRUST: f64 = 0.1;
const REPAIR_WEIGHT: f64 = 250.0;

/// Shares by which all durations grow, one after the other, where nothing else gives a motion.
const SLOWER: [f64; 5] = [2e-3, 4e-3, 8e-3, 1.6e-2, 3.2e-2];

/// What a shortening must come to where durations hardly change anymore.
const SHORTENED: Precision = Precision {
    gap: 1e-4,
    miss: 1e-4,
    smoothing: SMOOTHING,
};

/// The gap that is left, as a share of what the shortening before gained, and at the most. It is linearised
/// again, so more digits are of no use.
const GAP_SHARE: f64 = 0.1;
const LARGEST_GAP: f64 = 1e-2;

/// What a restoration must come to.
const RESTORED: Precision = Precision {
    gap: 1e-6,
    miss: 1e-8,
    smoothing: SMOOTHING,
};

/// What a smoothing must come to. With the weight of the excess some thousand times that of the jerk no excess
/// is traded for jerk.
const SMOOTHED: Precision = Precision {
    gap: 1e-5,
    miss: 1e-8,
    smoothing: 1e-2,
};

/// Weight of the mean square of the distance from the path in tolerances, against that of jerk in limits.
const CENTRING: f64 = 0.15;

/// Weight of the mean square of jerk against the duration: costs two parts in a hundred thousand of
/// time, makes the motion smoother and the problems easier.
const SMOOTHING: f64 = 1e-3;

/// A shortening that stalled may still be used below this gap and miss.
const USABLE: f64 = 1e-2;

/// Steps of the interior-point method that one problem is expected to take at the most, and those that preparing
/// it costs as much as.
const EXPECTED: u64 = 20;
const PREPARING: u32 = 2;

/// So many modes cost as much as all else in a window.
const MODES_AS_MUCH: usize = 4;

/// A restoration that stalled may still be used below this miss.
const USABLE_MISS: f64 = 1e-6;

/// Finds the motion through a window by a sequence of convex problems.
///
/// The workspace grows to the largest window and is reused. Same window, same guess: same motion,
/// bit for bit.
///
/// # Examples
/// ```
/// use toolglide_kinematics::{Limits, Vector};
/// use toolglide_optimal::{
///     Budget, EndState, WindowSegment, ScpSolver, Window, WindowMotion, WindowSolver,
/// };
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let limits = Limits::<2>::uniform(500.0, 2_500.0, 2e5)?;
/// let corner = Vector::<2>::new(10.0, 0.0);
/// let segment = |start, end| WindowSegment {
///     start,
///     end,
///     tolerance: 0.01,
///     corner_tolerance: Some(0.01),
///     feedrate: 100.0,
///     steps: 40,
///     follow: None,
///     walls: [None; 2],
/// };
/// let segments = [
///     segment(Vector::<2>::new(0.0, 0.0), corner),
///     segment(corner, Vector::<2>::new(10.0, 10.0)),
/// ];
/// let window = Window {
///     start: EndState::rest(segments[0].start),
///     end: EndState::rest(segments[1].end),
///     segments: &segments,
///     limits: &limits,
///     silence: None,
/// };
/// let mut motion = WindowMotion {
///     durations: vec![0.16, 0.16],
///     ..WindowMotion::new()
/// };
/// let solved = ScpSolver::new().solve(&window, &mut motion, &mut Budget::solves(8))?;
/// assert!(solved.duration < 0.288);
/// assert_eq!(motion.jerks.len(), 80);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, Default)]
pub struct ScpSolver<const N: usize> {
    problem: Problem<N>,
    interior: Interior<N>,
    durations: Vec<f64>,
    base: Base<N>,
    best: Base<N>,
    best_durations: Vec<f64>,
    best_duration: Option<f64>,
    budget: Budget,
    /// Share by which the smoothest motion may be slower than the fastest; 0 leaves the fastest.
    slower: f64,
    /// Modes of the window at hand, and their states at its start.
    modes: Vec<AxisMode>,
    swings: Vec<ModeState>,
    solves: u32,
    iterations: u32,
}

/// States and jerks, relative to the origin of the problem.
#[derive(Clone, Debug, Default)]
struct Base<const N: usize> {
    states: Vec<State<N>>,
    jerks: Vec<Vector<N>>,
}

/// What a shortening promises.
#[derive(Clone, Copy, Debug)]
struct Promise {
    gain: f64,
    excess: f64,
}

impl<const N: usize> ScpSolver<N> {
    /// A solver with an empty workspace.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A solver with room for windows of so many segments and intervals: up to that it allocates
    /// nothing.
    #[must_use]
    pub fn with_room(segments: usize, steps: usize) -> Self {
        let mut solver = Self::default();
        solver.problem.reserve(segments, steps);
        solver.interior.reserve(segments, steps);
        for base in [&mut solver.base, &mut solver.best] {
            base.states.reserve(steps + 1);
            base.jerks.reserve(steps);
        }
        solver.durations.reserve(segments);
        solver.best_durations.reserve(segments);
        solver
    }

    /// The same, looking for the smoothest motion that is slower than the fastest by a share of its duration.
    #[must_use]
    pub fn with_smoothing(mut self, smoothing: Smoothing) -> Self {
        self.slower = smoothing.share();
        self
    }

    /// The same with room for so many modes in windows of so many segments and intervals.
    #[must_use]
    pub fn with_room_for_modes(mut self, modes: usize, segments: usize, steps: usize) -> Self {
        self.problem.reserve_modes(modes, segments, steps);
        self.interior.reserve_conditions(4 * modes, segments, steps);
        self.modes.reserve(modes);
        self.swings.reserve(modes);
        self
    }

    /// Intervals of the window, and what its modes cost as more of them.
    fn work_intervals(&self) -> usize {
        let steps = self.problem.steps();
        steps + steps * self.modes.len() / MODES_AS_MUCH
    }

    fn load(
        &mut self,
        window: &Window<'_, N>,
        motion: &WindowMotion<N>,
    ) -> Result<(), WindowDefect> {
        self.problem.load(window)?;
        self.modes.clear();
        self.swings.clear();
        if let Some(silence) = &window.silence {
            self.modes.extend_from_slice(silence.modes);
            self.swings.extend_from_slice(silence.start);
        }
        self.best_duration = None;
        self.solves = 0;
        self.iterations = 0;
        let usable = |duration: &f64| *duration > 0.0 && duration.is_finite();
        if motion.durations.len() != self.problem.segments() || !motion.durations.iter().all(usable)
        {
            return Err(WindowDefect::Guess);
        }
        self.durations.clone_from(&motion.durations);
        self.base.states.clear();
        self.base.jerks.clear();
        if motion.states.is_empty() && motion.jerks.is_empty() {
            self.guess(window);
        } else if motion.states.len() == self.problem.steps() + 1
            && motion.jerks.len() == self.problem.steps()
        {
            let states = motion.states.iter();
            self.base
                .states
                .extend(states.map(|state| self.problem.relative(state)));
            self.base.jerks.extend_from_slice(&motion.jerks);
        } else {
            return Err(WindowDefect::Guess);
        }
        let finite = self.base.states.iter().flatten().all(is_finite)
            && self.base.jerks.iter().all(is_finite);
        finite.then_some(()).ok_or(WindowDefect::Guess)
    }

    /// At constant speed along every segment.
    fn guess(&mut self, window: &Window<'_, N>) {
        for (segment, duration) in window.segments.iter().zip(&self.durations) {
            let way = segment.end - segment.start;
            for step in 0..segment.steps {
                let state = EndState {
                    position: segment.start + way * (count(step) / count(segment.steps)),
                    velocity: way / *duration,
                    acceleration: Vector::zeros(),
                };
                self.base.states.push(self.problem.relative(&state));
                self.base.jerks.push(Vector::zeros());
            }
        }
        self.base.states.push(*self.problem.end());
    }

    /// Solves one problem from the base, which it replaces where it can be used.
    fn run(&mut self, goal: Goal, trust: f64, precision: &Precision) -> bool {
        let steps = self.problem.steps();
        let restoring = matches!(goal, Goal::Restore { .. });
        let shortening = matches!(goal, Goal::Shorten { .. });
        // What is shortened must be restored.
        let kept = if shortening { EXPECTED } else { 0 };
        let left = self
            .budget
            .steps(self.work_intervals())
            .saturating_sub(kept);
        let most = u32::try_from(left).unwrap_or(u32::MAX);
        let most = most.saturating_sub(PREPARING);
        if most == 0 {
            return false;
        }
        self.base.states[0] = *self.problem.start();
        self.base.states[steps] = *self.problem.end();
        self.interior.states.clone_from(&self.base.states);
        self.interior.jerks.clone_from(&self.base.jerks);
        self.interior.trust.clear();
        self.interior.trust.resize(self.problem.segments(), trust);
        self.problem.set_durations(&self.durations);
        self.problem.set_places(&self.base.states);
        let base = (self.base.states.as_slice(), self.base.jerks.as_slice());
        self.problem.set_base(shortening.then_some(base));
        let silence = Silence {
            modes: &self.modes,
            start: &self.swings,
        };
        self.problem.set_silence(Some(&silence));
        let smoothing = matches!(goal, Goal::Smooth { .. });
        let centring = CENTRING * precision.smoothing;
        self.problem.set_centring(smoothing.then_some(centring));
        let outcome = self
            .interior
            .solve(&mut self.problem, goal, precision, most);
        self.solves += 1;
        self.iterations += outcome.iterations;
        self.budget
            .spend(self.work_intervals(), outcome.iterations + PREPARING);
        let used = match outcome.ending {
            Ending::Solved => true,
            _ if restoring => outcome.miss < USABLE_MISS,
            _ => outcome.gap < USABLE && outcome.miss < USABLE,
        };
        if used {
            self.base.states.clone_from(&self.interior.states);
            self.base.jerks.clone_from(&self.interior.jerks);
        }
        used
    }

    fn shorten(&mut self, trust: f64, excess: f64, gap: f64) -> Option<Promise> {
        let precision = Precision { gap, ..SHORTENED };
        if !self.run(Goal::Shorten { excess }, trust, &precision) {
            return None;
        }
        let mut gain = 0.0;
        for (segment, stretch) in self.interior.stretches.iter().enumerate() {
            gain -= self.problem.share(segment) * stretch;
            self.durations[segment] *= 1.0 + stretch;
        }
        Some(Promise {
            gain,
            excess: self.interior.excess,
        })
    }

    /// Restores the motion and keeps it where it is the best so far; gives the excess.
    fn restore(&mut self) -> Option<f64> {
        if !self.run(Goal::Restore { enough: PLENTY }, 1.0, &RESTORED) {
            return None;
        }
        let excess = self.interior.excess;
        let duration: f64 = self.durations.iter().sum();
        if excess <= ENOUGH && self.best_duration.is_none_or(|best| duration < best) {
            self.keep_best();
        }
        Some(excess)
    }

    /// Finds the motion of least jerk, and nearest to the middle of the tube, in a little more time than the best;
    /// keeps the best where there is none.
    fn smooth(&mut self) {
        self.durations.clone_from(&self.best_durations);
        for duration in &mut self.durations {
            *duration *= 1.0 + self.slower;
        }
        self.base.states.clone_from(&self.best.states);
        self.base.jerks.clone_from(&self.best.jerks);
        let goal = Goal::Smooth {
            excess: EXCESS_WEIGHT,
        };
        if self.run(goal, 1.0, &SMOOTHED) && self.interior.excess <= ENOUGH {
            self.keep_best();
        }
    }

    /// Keeps the motion at hand as the best.
    fn keep_best(&mut self) {
        self.best_duration = Some(self.durations.iter().sum());
        self.best.states.clone_from(&self.base.states);
        self.best.jerks.clone_from(&self.base.jerks);
        self.best_durations.clone_from(&self.durations);
    }

    /// Whether there is enough left for so many problems.
    fn affords(&self, problems: u64) -> bool {
        self.budget.steps(self.work_intervals()) >= EXPECTED * problems
    }

    /// Shortens and restores until nothing is gained; gives the least excess of the restored.
    fn improve(&mut self) -> f64 {
        let (mut trust, mut gap) = (FIRST_TRUST, LARGEST_GAP);
        let mut least = f64::INFINITY;
        let effort = self.budget.solves;
        for round in 1..=effort {
            if !self.affords(1) {
                break;
            }
            let Some(promise) = self.shorten(trust, EXCESS_WEIGHT, gap) else {
                trust *= 0.25;
                if trust < MIN_TRUST {
                    break;
                }
                continue;
            };
            gap = (GAP_SHARE * promise.gain.abs()).clamp(SHORTENED.gap, LARGEST_GAP);
            let settled = promise.gain.abs() < MIN_GAIN;
            let last = round == effort || !self.affords(2);
            if (settled && promise.excess < ENOUGH) || round % RESTORE_EVERY == 0 || last {
                let excess = self.restore().unwrap_or(f64::INFINITY);
                least = least.min(excess);
                if excess > ENOUGH {
                    let less = if settled && excess.is_finite() {
                        (LEAVES * ENOUGH / excess).sqrt().min(0.5)
                    } else {
                        0.5
                    };
                    trust = (less * trust).max(RESTORED_TRUST);
                } else if settled {
                    break;
                }
            }
        }
        least
    }
}

impl<const N: usize> WindowSolver<N> for ScpSolver<N> {
    fn solve(
        &mut self,
        window: &Window<'_, N>,
        motion: &mut WindowMotion<N>,
        budget: &mut Budget,
    ) -> Result<Solved, Unsolved> {
        self.load(window, motion)?;
        self.budget = *budget;
        let found = self.find(motion);
        budget.work = self.budget.work;
        found
    }
}

impl<const N: usize> ScpSolver<N> {
    /// Finds a motion through the window that has been loaded.
    fn find(&mut self, motion: &mut WindowMotion<N>) -> Result<Solved, Unsolved> {
        let mut excess = self.improve();
        let mut trust = REPAIR_TRUST;
        for _ in 0..REPAIRS {
            if self.best_duration.is_some() {
                break;
            }
            if self.shorten(trust, REPAIR_WEIGHT, SHORTENED.gap).is_some() {
                excess = excess.min(self.restore().unwrap_or(f64::INFINITY));
            }
            trust *= 0.5;
        }
        for slower in SLOWER {
            if self.best_duration.is_some() {
                break;
            }
            for duration in &mut self.durations {
                *duration *= 1.0 + slower;
            }
            excess = excess.min(self.restore().unwrap_or(f64::INFINITY));
        }
        if self.slower > 0.0 && self.best_duration.is_some() {
            self.smooth();
        }
        let solves = self.solves;
        let Some(duration) = self.best_duration else {
            return Err(if excess.is_finite() {
                Unsolved::NotConverged { solves, excess }
            } else {
                Unsolved::Numerical { solves }
            });
        };
        motion.durations.clone_from(&self.best_durations);
        motion.jerks.clone_from(&self.best.jerks);
        motion.states.clear();
        let states = self.best.states.iter();
        motion
            .states
            .extend(states.map(|state| self.problem.absolute(state)));
        Ok(Solved {
            duration,
            solves,
            iterations: self.iterations,
        })
    }
}
