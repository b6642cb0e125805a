//! Runs the stages of time-optimal planning, from moves to pieces.
//!
//! Source: ours. Moves become straight vertices, those become runs, runs are cut into spans, and spans
//! are planned in windows. Stops and pauses divide the path into stretches. Not here: any formula, and
//! the comparison with other motion.

use crate::path::chords::Chords;
use crate::path::merge::{Segment, SegmentMerger, Vertex};
use crate::path::spans::{Fineness, Part, cut};
use crate::settings::Settings;
use crate::window::horizon::Horizon;
use crate::window::output::Event;
use crate::window::{Follow, WindowSolver};
use std::collections::VecDeque;
use toolglide_kinematics::numeric::SHORTEST_LENGTH;
use toolglide_kinematics::{Limits, Move, MoveRange, Path, PathSide, Pause, Vector, WindowTally};

/// Events that are kept room for: those of a window and a few stops.
const EVENTS: usize = 2048;

/// Moves that wait while planning is behind.
const MAX_WAITING: usize = 8;

/// Work of windows after which planning waits for the next move, unless none comes: what a long arc costs is spread
/// over the moves behind it.
const WORK_A_MOVE: u64 = 80_000;

/// Plans a stream of moves by a window solver.
#[derive(Clone, Debug)]
pub(crate) struct Stream<S, const N: usize> {
    limits: Limits<N>,
    fineness: Fineness,
    /// Time that modes of vibration take to come to rest, s.
    silence: f64,
    joiner: SegmentMerger<N>,
    /// Whether a move that stops is planned when the next is known: the side that it keeps depends on that.
    looks_ahead: bool,
    horizon: Horizon<S, N>,
    position: Vector<N>,
    index: u32,
    /// The arc under way, and its move.
    arc: Option<(Chords<N>, Move<N>, u32)>,
    waiting: VecDeque<Move<N>>,
    /// Work of windows when the last move came.
    work_before: u64,
    finished: bool,
    rests: bool,
    events: VecDeque<Event<N>>,
}

impl<S: WindowSolver<N>, const N: usize> Stream<S, N> {
    pub(crate) fn new(solver: S, start: Vector<N>, settings: &Settings<N>) -> Self {
        Self {
            limits: settings.limits,
            fineness: settings.effort.fineness(),
            silence: settings.modes.settling_time(),
            joiner: SegmentMerger::new(start)
                .joining_only_collinear(settings.side != PathSide::Both),
            looks_ahead: settings.side == PathSide::Inside,
            horizon: Horizon::new(solver, start, settings),
            position: start,
            index: 0,
            arc: None,
            waiting: VecDeque::with_capacity(MAX_WAITING),
            work_before: 0,
            finished: false,
            rests: false,
            events: VecDeque::with_capacity(EVENTS),
        }
    }

    /// Takes the next move, which begins where the last one ended. It is planned while motion is pulled.
    pub(crate) fn push(&mut self, next: &Move<N>) {
        while self.waiting.len() >= MAX_WAITING && self.advance() {}
        self.work_before = self.horizon.tally().work;
        self.waiting.push_back(*next);
    }

    /// Begins a move.
    fn take(&mut self, next: &Move<N>) {
        let index = self.index;
        self.index += 1;
        self.position = next.end(self.position);
        match next.path() {
            Path::Line { end } => self.take_point(next, index, *end, (0.0, None)),
            Path::Arc(arc) => {
                let chords = Chords::following(
                    *arc,
                    next.tolerance().length(),
                    next.feedrate().speed(),
                    &self.limits,
                    self.fineness,
                );
                self.arc = Some((chords, *next, index));
                return;
            }
            Path::Dwell { duration } => {
                self.rest(Some(Pause {
                    duration: *duration,
                    serves: MoveRange::one(index),
                    end: self.position,
                }));
                return;
            }
        }
        if next.stops() {
            self.horizon.turn_to(self.direction_of_next());
            self.rest(None);
        }
    }

    /// Direction of the straight move that waits to be begun.
    fn direction_of_next(&self) -> Option<Vector<N>> {
        match self.waiting.front()?.path() {
            Path::Line { end } => (end - self.position).try_normalize(SHORTEST_LENGTH),
            _ => None,
        }
    }

    /// Whether the next move stops in a corner that is not known yet.
    fn misses_a_corner(&self) -> bool {
        let next = self.waiting.front();
        self.looks_ahead
            && !self.finished
            && self.waiting.len() < 2
            && next.is_some_and(|next| next.stops() && matches!(next.path(), Path::Line { .. }))
    }

    /// No more moves come: the motion rests behind those that wait.
    pub(crate) fn finish(&mut self) {
        self.finished = true;
    }

    /// What has been planned next; `None` too where the move that came last has had its share of work.
    pub(crate) fn pull(&mut self) -> Option<Event<N>> {
        loop {
            if let Some(event) = self.events.pop_front() {
                return Some(event);
            }
            let work = self.horizon.tally().work - self.work_before;
            if work > WORK_A_MOVE && !self.finished || !self.advance() {
                return None;
            }
        }
    }

    /// Takes the next chord of the arc under way, or the next move; `false` when there is neither, or more must be known.
    fn advance(&mut self) -> bool {
        if self.advance_arc() {
            return true;
        }
        if self.misses_a_corner() {
            return false;
        }
        if let Some(next) = self.waiting.pop_front() {
            self.take(&next);
            return true;
        }
        let rest = self.finished && !self.rests;
        if rest {
            self.rests = true;
            self.rest(None);
        }
        rest
    }

    /// Whether the motion is being executed before its end is known.
    pub(crate) fn lead(&mut self, leading: bool) {
        self.horizon.lead(leading);
    }

    /// Whether planning has cost nearly all that motion has earned.
    pub(crate) fn is_short(&self) -> bool {
        self.horizon.is_short()
    }

    /// How many windows there were.
    pub(crate) fn tally(&self) -> WindowTally {
        self.horizon.tally()
    }

    /// Takes the next chord of the arc under way; `false` when there is none.
    fn advance_arc(&mut self) -> bool {
        let Some((chords, step, index)) = &mut self.arc else {
            return false;
        };
        let (step, index, bulge) = (*step, *index, chords.bulge());
        if let Some(point) = chords.next() {
            let follow = chords.follow();
            self.take_point(&step, index, point, (bulge, follow));
        } else {
            self.arc = None;
            if step.stops() {
                self.rest(None);
            }
        }
        true
    }

    fn take_point(
        &mut self,
        step: &Move<N>,
        index: u32,
        point: Vector<N>,
        (bulge, follow): (f64, Option<Follow<N>>),
    ) {
        let vertex = Vertex {
            point,
            bulge,
            feedrate: step.feedrate().speed(),
            tolerance: step.tolerance().length(),
            follow,
            index,
        };
        if let Some(run) = self.joiner.push(vertex) {
            self.take_run(&run);
        }
    }

    fn take_run(&mut self, run: &Segment<N>) {
        cut(
            run,
            &self.limits,
            self.fineness,
            self.silence,
            |part| match part {
                Part::Span(span) => self.horizon.push(span),
                Part::Cruise(cruise) => self.horizon.cruise(&cruise),
            },
        );
        self.horizon.plan();
        self.collect();
    }

    /// Comes to rest where the path has come to, and pauses there.
    fn rest(&mut self, pause: Option<Pause<N>>) {
        if let Some(run) = self.joiner.flush() {
            self.take_run(&run);
        }
        self.horizon.rest(self.joiner.anchor());
        self.collect();
        let at = self.joiner.anchor();
        let pause = match (self.joiner.take_carried(), pause) {
            (Some(carried), Some(pause)) => Some(carried.then(pause)),
            (carried, pause) => carried.or(pause),
        };
        if let Some(pause) = pause {
            self.events.push_back(Event::Piece(pause.piece(at)));
        }
        self.events
            .push_back(Event::Rest(self.index.saturating_sub(1)));
    }

    fn collect(&mut self) {
        while let Some(event) = self.horizon.pull() {
            self.events.push_back(event);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::sequential::ScpSolver;
    use toolglide_kinematics::{Feedrate, Tolerance};

    fn stream() -> Stream<ScpSolver<2>, 2> {
        let limits = Limits::uniform(500.0, 2500.0, 2e5).unwrap();
        Stream::new(ScpSolver::new(), Vector::zeros(), &Settings::new(limits))
    }

    /// A staircase of moves of a length at 100 mm/s.
    fn stairs(count: u32, length: f64) -> impl Iterator<Item = Move<2>> {
        (1..=count).map(move |index| {
            let (x, y) = (f64::from(index.div_ceil(2)), f64::from(index / 2));
            let end = Vector::<2>::new(length * x, length * y);
            let feedrate = Feedrate::new(100.0).unwrap();
            Move::line_to(end, feedrate, Tolerance::new(0.01).unwrap()).unwrap()
        })
    }

    #[test]
    fn a_move_that_reaches_its_feedrate_divides_the_plan_as_soon_as_its_end_is_known() {
        // From rest to 100 mm/s takes 2.63 mm.
        for length in [50.0, 10.0, 7.0, 6.1] {
            let mut stream = stream();
            let mut pushed = 0;
            for next in stairs(2, length) {
                stream.push(&next);
                pushed += 1;
                let joint = std::iter::from_fn(|| stream.pull())
                    .find(|event| matches!(event, Event::Joint(joint) if joint.index == 0));
                if joint.is_some() {
                    break;
                }
                assert!(pushed < 2, "{length} mm: no joint after {pushed} moves");
            }
        }
    }

    #[test]
    fn what_is_planned_does_not_depend_on_when_it_is_pulled() {
        let planned = |every: usize| {
            let mut stream = stream();
            let mut events = Vec::new();
            for (index, next) in stairs(40, 3.0).enumerate() {
                stream.push(&next);
                if index % every == 0 {
                    events.extend(std::iter::from_fn(|| stream.pull()));
                }
            }
            stream.finish();
            events.extend(std::iter::from_fn(|| stream.pull()));
            events
        };
        let events = planned(1);
        assert!(events.len() > 1000, "{}", events.len());
        assert_eq!(events, planned(7));
        assert_eq!(events, planned(1000));
    }

    #[test]
    fn lengths_and_limits_at_the_edge_of_float_arithmetic_give_motion_or_none() {
        for reach in [1.0, 1e150, f64::MAX] {
            for [velocity, acceleration, jerk] in
                [[2.0, 160.0, 100.0], [400.0, 90.0, 0.1], [4e-3, 2e-4, 1e-3]]
            {
                let limits = Limits::<2>::uniform(velocity, acceleration, jerk).unwrap();
                let solver = ScpSolver::new();
                let mut stream = Stream::new(solver, Vector::zeros(), &Settings::new(limits));
                let mut pieces = 0;
                for end in [[reach, 0.0], [reach, reach], [0.0, -reach], [0.0, 0.0]] {
                    let tolerance = Tolerance::new(0.01).unwrap();
                    let end = Vector::<2>::from(end);
                    let Ok(next) = Move::line_to(end, Feedrate::RAPID, tolerance) else {
                        break;
                    };
                    stream.push(&next);
                    pieces += std::iter::from_fn(|| stream.pull()).count();
                }
                stream.finish();
                pieces += std::iter::from_fn(|| stream.pull()).count();
                let usual = (0.1..10.0).contains(&reach);
                assert!(!usual || pieces > 4, "{reach} mm within {limits:?}");
            }
        }
    }
}
