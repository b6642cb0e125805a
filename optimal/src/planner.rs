//! The planner: time-optimal motion, and smoothed corners where they are faster.
//!
//! Source: ours. Both plan every stretch between two stops of the path; the faster motion is handed
//! out, so that it is never slower than smoothed corners. A stretch too long to be held is settled in
//! favor of whoever is ahead. Not here: either plan.

use crate::durations::SequentialSolver;
use crate::settings::Settings;
use crate::stream::{Event, Stream};
use crate::window::WindowSolver;
use std::collections::VecDeque;
use toolglide_kinematics::numeric::TIME_SLACK;
use toolglide_kinematics::{
    MotionPlanner, Move, Piece, Plan, PlanError, Toolpath, Vector, WindowTally, check_contact,
};
use toolglide_smoothing::KinematicSmoothing;

/// Pieces held of either motion before a stretch is settled: some minutes, and some ten megabytes.
const MOST_HELD: usize = 1 << 16;

/// Plans time-optimal motion while the path is being read.
#[derive(Clone, Debug)]
pub struct TimeOptimal<const N: usize, S = SequentialSolver<N>> {
    position: Vector<N>,
    index: u32,
    finished: bool,
    optimal: Stream<S, N>,
    smoothing: KinematicSmoothing<N>,
    /// Pieces of the time-optimal motion, and where its stretches end.
    mine: VecDeque<Event<N>>,
    /// The last rest among them so far.
    last_rest: Option<u32>,
    /// Pieces of the smoothed corners.
    theirs: VecDeque<Piece<N>>,
    /// Last move of each stretch that ends in a stop.
    ends: VecDeque<u32>,
    settled: Settled,
    /// Whether the time-optimal motion of the stretch under way has been taken to its end.
    rested: bool,
    tally: WindowTally,
}

/// What is known of the stretch under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Settled {
    /// Not yet which motion is faster.
    Open,
    /// Time-optimal motion up to the end of the stretch.
    Mine,
    /// Smoothed corners up to the end of the stretch.
    Theirs,
}

impl<const N: usize> TimeOptimal<N> {
    /// A planner whose motion begins at rest at `start`.
    #[must_use]
    pub fn new(start: Vector<N>, settings: &Settings<N>) -> Self {
        Self::with_solver(SequentialSolver::new(), start, settings)
    }
}

impl<const N: usize, S: WindowSolver<N>> TimeOptimal<N, S> {
    /// A planner whose motion begins at rest at `start`, with a solver for its windows.
    #[must_use]
    pub fn with_solver(solver: S, start: Vector<N>, settings: &Settings<N>) -> Self {
        Self {
            position: start,
            index: 0,
            finished: false,
            optimal: Stream::new(solver, start, settings),
            smoothing: KinematicSmoothing::new(
                start,
                &toolglide_smoothing::Settings::new(settings.limits),
            ),
            mine: VecDeque::with_capacity(MOST_HELD + 1),
            last_rest: None,
            theirs: VecDeque::with_capacity(MOST_HELD + 1),
            ends: VecDeque::new(),
            settled: Settled::Open,
            rested: false,
            tally: WindowTally::default(),
        }
    }

    /// Takes what both planners have ready, as far as there is room for it.
    fn gather(&mut self) {
        while self.mine.len() < MOST_HELD
            && let Some(event) = self.optimal.pull()
        {
            if let Event::Rest(index) = event {
                self.last_rest = Some(index);
            }
            self.mine.push_back(event);
        }
        while self.theirs.len() < MOST_HELD
            && let Some(piece) = self.smoothing.pull()
        {
            self.theirs.push_back(piece);
        }
    }

    /// Pieces of the smoothed corners in the stretch under way; `None` while it is not complete.
    fn their_stretch(&self) -> Option<usize> {
        let end = *self.ends.front()?;
        let beyond = self
            .theirs
            .back()
            .is_some_and(|piece| piece.serves().last > end);
        let complete = beyond || (self.finished && self.theirs.len() < MOST_HELD);
        complete.then(|| {
            self.theirs
                .partition_point(|piece| piece.serves().last <= end)
        })
    }

    /// Settles the stretch under way if that is possible by now.
    fn settle(&mut self) {
        if self.settled != Settled::Open {
            return;
        }
        if self.is_complete()
            && let Some(count) = self.their_stretch()
        {
            let mine: f64 = self
                .mine
                .iter()
                .map_while(|event| match event {
                    Event::Piece(piece) => Some(piece.duration()),
                    Event::Rest(index) if self.is_end(*index) => None,
                    Event::Rest(_) => Some(0.0),
                })
                .sum();
            let theirs: f64 = self.theirs.range(..count).map(Piece::duration).sum();
            self.decide(mine, theirs, count > 0);
        } else if self.mine.len() >= MOST_HELD || self.theirs.len() >= MOST_HELD {
            let (mine, theirs) = self.progress();
            self.decide(mine, theirs, true);
        }
    }

    fn decide(&mut self, mine: f64, theirs: f64, moved: bool) {
        let faster = mine < theirs - TIME_SLACK || !moved;
        self.settled = if faster {
            Settled::Mine
        } else {
            Settled::Theirs
        };
        if moved {
            self.tally.stretches += 1;
            self.tally.yielded += u64::from(!faster);
        }
    }

    /// Time that either motion takes to the last move that both have finished.
    fn progress(&self) -> (f64, f64) {
        let mine = || {
            self.mine.iter().filter_map(|event| match event {
                Event::Piece(piece) => Some(piece),
                Event::Rest(_) => None,
            })
        };
        let (Some(my_last), Some(their_last)) = (mine().next_back(), self.theirs.back()) else {
            return (0.0, 1.0);
        };
        let common = my_last.serves().first.min(their_last.serves().first);
        let time = |pieces: &mut dyn Iterator<Item = &Piece<N>>| -> f64 {
            pieces
                .take_while(|piece| piece.serves().last < common)
                .map(Piece::duration)
                .sum()
        };
        (time(&mut mine()), time(&mut self.theirs.iter()))
    }

    /// The next piece of a settled stretch; leaves the stretch when both motions have.
    fn hand_out(&mut self) -> Option<Piece<N>> {
        match self.settled {
            Settled::Open => return None,
            Settled::Mine => {
                self.drop_theirs();
                if let Some(piece) = self.next_of_mine() {
                    return Some(piece);
                }
            }
            Settled::Theirs => {
                while self.next_of_mine().is_some() {}
                if let Some(piece) = self.theirs.front()
                    && self.is_in_stretch(piece)
                {
                    return self.theirs.pop_front();
                }
            }
        }
        if self.rested && self.their_stretch() == Some(0) {
            self.rested = false;
            self.ends.pop_front();
            self.settled = Settled::Open;
        }
        None
    }

    /// The next time-optimal piece of the stretch under way.
    fn next_of_mine(&mut self) -> Option<Piece<N>> {
        if self.rested {
            return None;
        }
        loop {
            match self.mine.pop_front()? {
                Event::Piece(piece) => return Some(piece),
                Event::Rest(index) if self.is_end(index) => {
                    self.rested = true;
                    return None;
                }
                // A stop within the stretch.
                Event::Rest(_) => {}
            }
        }
    }

    /// Whether a rest at the end of this move ends the stretch under way.
    fn is_end(&self, index: u32) -> bool {
        self.ends.front().is_some_and(|end| index >= *end)
    }

    /// Whether the time-optimal motion of the stretch under way is complete.
    fn is_complete(&self) -> bool {
        self.last_rest.is_some_and(|index| self.is_end(index))
    }

    /// Stretches between which the smoothed motion has one piece for moves of both, as for pauses that
    /// follow each other, are one stretch.
    fn join_stretches(&mut self) {
        while let Some(&end) = self.ends.front() {
            let within = self
                .theirs
                .partition_point(|piece| piece.serves().last <= end);
            let straddles = self
                .theirs
                .get(within)
                .is_some_and(|piece| piece.serves().first <= end);
            if !straddles {
                return;
            }
            self.ends.pop_front();
            self.rested = false;
        }
    }

    fn drop_theirs(&mut self) {
        while let Some(piece) = self.theirs.front()
            && self.is_in_stretch(piece)
        {
            self.theirs.pop_front();
        }
    }

    fn is_in_stretch(&self, piece: &Piece<N>) -> bool {
        self.ends
            .front()
            .is_none_or(|end| piece.serves().last <= *end)
    }
}

impl<const N: usize, S: WindowSolver<N>> MotionPlanner<N> for TimeOptimal<N, S> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        let index = self.index;
        if self.finished {
            return Err(PlanError::Finished { index });
        }
        check_contact(next, self.position).map_err(|reason| PlanError::Path { index, reason })?;
        self.smoothing.push(next)?;
        self.index = index.checked_add(1).ok_or(PlanError::TooMany { index })?;
        self.position = next.end(self.position);
        self.optimal.push(next);
        if next.stops() {
            self.ends.push_back(index);
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        if !self.finished {
            self.finished = true;
            self.smoothing.finish()?;
            self.optimal.finish();
            self.ends.push_back(self.index.saturating_sub(1));
        }
        Ok(())
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        loop {
            self.gather();
            self.join_stretches();
            let before = (self.settled, self.ends.len(), self.rested);
            self.settle();
            if let Some(piece) = self.hand_out() {
                return Some(piece);
            }
            if before == (self.settled, self.ends.len(), self.rested) {
                return None;
            }
        }
    }

    fn windows(&self) -> Option<WindowTally> {
        Some(WindowTally {
            stretches: self.tally.stretches,
            yielded: self.tally.yielded,
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
    plan_with(SequentialSolver::new(), path, settings)
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
    let mut planner = TimeOptimal::with_solver(solver, path.start(), settings);
    let mut plan = Plan::starting_at(path.start());
    for step in path.moves() {
        planner.push(step)?;
        while let Some(piece) = planner.pull() {
            plan.push(piece);
        }
    }
    planner.finish()?;
    while let Some(piece) = planner.pull() {
        plan.push(piece);
    }
    Ok(plan)
}
