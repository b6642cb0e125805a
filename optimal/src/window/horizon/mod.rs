//! Plans windows one after the other: each ends at rest, and its first part is handed out.
//!
//! Source: ours. The plan always ends in a full stop at the end of what has been planned. Each window
//! starts in the state up to which motion has been handed out, covers what was planned behind it and
//! something new, and ends at rest, or where the middle of a long move begins: that is travelled in
//! closed form, and the next window starts behind it. A motion takes the place of the plan only when it
//! has been accepted and is not worse; else the plan stays as it is, the motion comes to its stop, and goes on
//! from rest. A stretch whose windows cost more than its motion earns is given up: the plan before is carried out, and
//! every line up to the next goal is travelled from rest to rest. Not here: one window, see [`attempt`].

mod attempt;
mod sides;
mod travel;

use crate::path::spans::{Span, weakest};
use crate::settings::{Settings, Smoothing};
use crate::solver::budget::{Budget, Credit};
use crate::window::initial_guess::Guess;
use crate::window::output::Event;
use crate::window::shaped_line::Shaper;
use crate::window::straight_line;
use crate::window::swings::Swings;
use crate::window::{EndState, WindowMotion, WindowSegment, WindowSolver};
use std::collections::VecDeque;
use toolglide_kinematics::{Limits, PathSide, Vector, WindowTally};

/// What is handed out of a window, in times to stop.
const COMMIT: f64 = 4.0;

/// Of the spans of a window one in so many is not handed out at least, however short they are.
const UNCOMMITTED: usize = 3;

/// How much longer a window up to a stop of the path may be, in times to stop: then what is left is
/// planned at once.
const LONGER: f64 = 2.5;

/// How many more intervals a stretch has that is planned at once: there is but one window to be solved.
const REFINED: f64 = 1.3;

/// The same where modes of vibration take some of their freedom.
const REFINED_SILENT: f64 = 1.7;

/// So many intervals are few for a window.
const FEW: f64 = 200.0;

/// Fewest spans of a window, where there are as many.
const MIN_SPANS: usize = 4;

/// Most spans of a window.
pub(crate) const MAX_SPANS: usize = 100;

/// Most intervals of a window: rounding grows with the sixth power of their number.
const MAX_STEPS: usize = 560;

/// The same with modes of vibration, whose problems cost more.
const MAX_SILENT_STEPS: usize = 320;

/// Room for the intervals of a window, whose last span may reach beyond the most.
pub(crate) const ROOM: usize = MAX_STEPS + crate::path::spans::MAX_STEPS;

/// How much longer windows are with modes of vibration, in periods of the slowest.
const MORE_PERIODS: f64 = 2.0;

/// Least duration of motion from rest to rest that leaves every mode at rest, in periods of the slowest.
const SILENT_PERIODS: f64 = 1.4;

/// Fewest intervals of a window that ends silent: beyond those for the end, so many for each condition of an axis.
const SILENT_STEPS: usize = 24;

/// Share of every limit that is kept back from the solver, which meets them to its own precision only.
const MARGIN: f64 = 2e-4;

/// Plans spans from stop to stop.
#[derive(Clone, Debug)]
pub(crate) struct Horizon<S, const N: usize> {
    solver: S,
    solves: usize,
    /// Length of a window in times to stop.
    window: f64,
    limits: Limits<N>,
    shrunk: Limits<N>,
    weakest: (f64, f64),
    spans: VecDeque<Span<N>>,
    /// Where motion has been handed out to.
    start: EndState<N>,
    /// Where the last span leads, once that is known.
    goal: Option<EndState<N>>,
    /// The plan from there to a stop at the end of the first `planned` spans.
    current: WindowMotion<N>,
    planned: usize,
    /// What the guess of those spans was.
    expected: Vec<f64>,
    free: Guess,
    guess: Guess,
    segments: Vec<WindowSegment<N>>,
    shrunk_segments: Vec<WindowSegment<N>>,
    candidate: WindowMotion<N>,
    other: WindowMotion<N>,
    ratios: Vec<f64>,
    events: VecDeque<Event<N>>,
    tally: WindowTally,
    credit: Credit,
    /// What the window under way may still cost.
    budget: Budget,
    /// Whether the stretch up to the next goal is given up: its windows cost more than its motion earns.
    given_up: bool,
    /// Whether the motion is being executed, so that nothing is given up.
    leading: bool,
    /// Modes of vibration, at where motion has been handed out to and at the end of a window.
    pub(super) swings: Swings,
    pub(super) trial: Swings,
    pub(super) shaper: Shaper,
    /// Period of the slowest mode, s; 0 without any.
    longest_period: f64,
    /// Whether the goal is one of rest, or of constant velocity, so that modes stay at rest behind it.
    silent_goal: bool,
    side: PathSide,
    overshoot: f64,
    /// Direction of the last line that was handed out to its end.
    pub(super) direction_before: Option<Vector<N>>,
    /// Direction of the line behind the next rest.
    direction_after: Option<Vector<N>>,
}

fn motion_for<const N: usize>() -> WindowMotion<N> {
    WindowMotion {
        durations: Vec::with_capacity(MAX_SPANS),
        states: Vec::with_capacity(ROOM + 1),
        jerks: Vec::with_capacity(ROOM),
    }
}

impl<S: WindowSolver<N>, const N: usize> Horizon<S, N> {
    /// At rest at `start`.
    pub(crate) fn new(solver: S, start: Vector<N>, settings: &Settings<N>) -> Self {
        Self {
            solver,
            solves: settings.effort.solves(),
            window: settings.effort.window(),
            limits: settings.limits,
            shrunk: settings
                .limits
                .scaled(1.0 - MARGIN)
                .unwrap_or(settings.limits),
            weakest: weakest(&settings.limits),
            spans: VecDeque::with_capacity(4 * MAX_SPANS),
            start: EndState::rest(start),
            goal: None,
            current: motion_for(),
            planned: 0,
            expected: Vec::with_capacity(MAX_SPANS),
            free: Guess::with_capacity(4 * MAX_SPANS),
            guess: Guess::with_capacity(MAX_SPANS),
            segments: Vec::with_capacity(MAX_SPANS),
            shrunk_segments: Vec::with_capacity(MAX_SPANS),
            candidate: motion_for(),
            other: motion_for(),
            ratios: Vec::with_capacity(MAX_SPANS),
            events: VecDeque::with_capacity(2 * MAX_STEPS),
            tally: WindowTally::default(),
            credit: Credit::new(
                N,
                settings.smoothing > Smoothing::NONE,
                settings.modes.len(),
            ),
            budget: Budget::default(),
            given_up: false,
            leading: false,
            swings: Swings::new(&settings.modes, &settings.limits),
            trial: Swings::new(&settings.modes, &settings.limits),
            shaper: Shaper::with_room(),
            longest_period: settings.modes.longest_period(),
            silent_goal: true,
            side: settings.side,
            overshoot: settings.overshoot,
            direction_before: None,
            direction_after: None,
        }
    }

    /// Takes the next span.
    pub(crate) fn push(&mut self, span: Span<N>) {
        self.spans.push_back(span);
    }

    /// Plans as far as can be seen; the last line has been pushed to its end.
    pub(crate) fn plan(&mut self) {
        while self.advance() {}
    }

    /// The motion rests at the end of the last span, `end`.
    pub(crate) fn rest(&mut self, end: Vector<N>) {
        self.close(EndState::rest(end));
        self.direction_after = None;
    }

    /// Behind the next rest the path goes on in a direction.
    pub(crate) fn turn_to(&mut self, direction: Option<Vector<N>>) {
        self.direction_after = direction;
    }

    fn close(&mut self, goal: EndState<N>) {
        self.goal = Some(goal);
        while self.advance() {}
        self.goal = None;
        self.given_up = false;
    }

    /// Whether the motion is being executed before its end is known: nothing is given up then, whatever it costs.
    pub(crate) fn lead(&mut self, leading: bool) {
        self.leading = leading;
        self.given_up &= !leading;
    }

    /// Whether its windows have cost nearly all that motion has earned.
    pub(crate) fn is_short(&self) -> bool {
        self.credit.is_short()
    }

    /// Whether motion was handed out up to a state that is not one of rest.
    fn moves(&self) -> bool {
        self.start.velocity.norm_squared() > 0.0
    }

    /// Whether the last span leads to a state that is not one of rest.
    fn passes(&self) -> bool {
        self.goal
            .is_some_and(|goal| goal.velocity.norm_squared() > 0.0)
    }

    /// The next piece of motion that is settled, or joint.
    pub(crate) fn pull(&mut self) -> Option<Event<N>> {
        self.events.pop_front()
    }

    /// How many windows there were, and what they cost.
    pub(crate) fn tally(&self) -> WindowTally {
        WindowTally {
            work: self.credit.spent(),
            ..self.tally
        }
    }

    /// Plans a window and hands out its first part; `false` when nothing can be done yet. Where there is
    /// a goal, the motion comes to it.
    fn advance(&mut self) -> bool {
        let known = self.spans.len();
        if known == 0 {
            return false;
        }
        if self.given_up {
            self.carry_out();
            return true;
        }
        let closing = self.goal.is_some();
        let speed = self.start.velocity.norm();
        let open = !closing || self.passes();
        self.free.fill(self.spans.iter(), speed, open, self.weakest);
        let more = MORE_PERIODS * self.longest_period;
        let (reach, enough) = self.reach(self.window, more, MIN_SPANS);
        let mut window = reach.max((self.planned + 1).min(known));
        if closing && self.fits_at_once(known) {
            window = known;
            if self.planned == 0 {
                self.refine();
            }
        }
        if closing && window == known && self.planned == known && !self.passes() {
            self.commit(known);
            return true;
        }
        // What comes after the window is known, too: the path may end there.
        let enough = enough && self.reach(self.window + LONGER, more, MIN_SPANS).1;
        if !closing && (!enough || window == self.planned) {
            return false;
        }
        let closed_form = self.swings.is_empty();
        if closed_form
            && closing
            && self.planned == 0
            && straight_line::on_one_line(self.spans.iter()) == known
        {
            // A straight line is known in closed form.
            self.travel_a_line();
            return true;
        }
        self.tally.windows += 1;
        if let Some(planned) = self.improve(window) {
            let (first, _) = self.reach(COMMIT, 0.0, 1);
            let part = if closing && planned == known {
                known
            } else {
                first.min(planned - planned.div_ceil(UNCOMMITTED)).max(1)
            };
            self.commit(part);
        } else {
            self.tally.kept += 1;
            self.carry_out();
        }
        true
    }

    /// Hands out the plan there is to its stop; where there is none, the next line.
    fn carry_out(&mut self) {
        if self.planned > 0 {
            self.commit(self.planned);
        } else {
            self.travel_a_line();
        }
    }

    /// How many spans take some times to stop and `more` seconds, and whether there are as many.
    fn reach(&mut self, stops: f64, more: f64, fewest: usize) -> (usize, bool) {
        let (mut time, mut stop_time, mut nodes) = (0.0, 0.0_f64, 0);
        let most = if self.swings.is_empty() {
            MAX_STEPS
        } else {
            MAX_SILENT_STEPS
        };
        let free = self.free.times.iter().zip(&self.free.steady);
        for (index, (span, (duration, steady))) in self.spans.iter().zip(free).enumerate() {
            if index >= fewest && time >= stops * stop_time + more {
                return (index, true);
            }
            let steps = if span.steps > 0 {
                span.steps
            } else {
                span.steps_for(*duration, *steady)
            };
            if index > 0 && nodes + steps > most || index >= MAX_SPANS {
                return (index, true);
            }
            nodes += steps;
            time += duration;
            stop_time = stop_time.max(span.stop_time);
        }
        let enough = time >= stops * stop_time + more && self.spans.len() >= fewest;
        (self.spans.len(), enough)
    }

    /// Cuts the time of a stretch that is planned at once more finely.
    fn refine(&mut self) {
        let whole: f64 = self.free.times.iter().sum();
        let intervals = self.spans.iter().map(|span| whole / span.interval);
        let few = intervals.fold(0.0, f64::max) < FEW;
        let finer = if few && !self.swings.is_empty() {
            REFINED_SILENT
        } else {
            REFINED
        };
        let slower = finer * self.slower_for_silence(self.spans.len());
        let free = self.free.times.iter().zip(&self.free.steady);
        for (span, (duration, steady)) in self.spans.iter_mut().zip(free) {
            if span.steps == 0 {
                span.steps = span.steps_for(slower * duration, *steady);
            }
        }
    }

    /// Whether all that is left makes one window that is not much longer than usual.
    fn fits_at_once(&mut self, known: usize) -> bool {
        let more = MORE_PERIODS * self.longest_period;
        self.reach(self.window + LONGER, more, MIN_SPANS).0 == known
    }

    /// Whether modes must rest where a window of the first `count` spans ends; a goal may keep them swinging.
    fn ends_silent(&self, count: usize) -> bool {
        let at_goal = self.goal.is_some() && count == self.spans.len();
        (self.silent_goal || !at_goal) && !self.swings.is_empty()
    }

    /// How much longer than their guess spans take to leave the modes at rest, where they begin and end at rest.
    fn slower_for_silence(&self, count: usize) -> f64 {
        if self.longest_period > 0.0 && self.planned == 0 && !self.moves() {
            let whole: f64 = self.free.times.iter().take(count).sum();
            (SILENT_PERIODS * self.longest_period / whole).max(1.0)
        } else {
            1.0
        }
    }

    /// Where a window of the first `count` spans ends: at rest, or at the goal.
    fn end(&self, count: usize) -> EndState<N> {
        match self.goal {
            Some(goal) if count == self.spans.len() => goal,
            _ => EndState::rest(self.spans[count - 1].end),
        }
    }
}
