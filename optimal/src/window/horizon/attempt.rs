//! Solves one window from a guess and decides whether its motion replaces the plan.
//!
//! Source: ours. A motion that takes longer than before over what was planned already, although it need
//! not stop there anymore, is tried again from the plan before, which is feasible. Not here: which spans
//! make a window, and what is handed out of it.

use crate::path::spans::steps;
use crate::solver::budget::Budget;
use crate::window::check::accept;
use crate::window::check::silence::comes_to_rest;
use crate::window::horizon::{Horizon, MARGIN, SILENT_STEPS};
use crate::window::straight_line;
use crate::window::{EndState, Window, WindowMotion, WindowSegment, WindowSolver};
use toolglide_kinematics::Vector;

/// How much slower than a guess the first motion from rest is taken to be.
const FROM_REST: f64 = 1.1;

/// By what factor planned motion differs from its guess at most.
const FACTORS: (f64, f64) = (0.7, 1.6);

/// What was planned already may take this much longer in a new plan, which need not brake at its end;
/// anything more is a bad place to have been led to.
const WORSE: f64 = 1.001;

/// One part in so many of what is left for a window is kept for trying it again.
const RETRY_SHARE: u64 = 3;

/// How much slower than their guess new spans behind a plan are taken to be where modes must rest.
const BEHIND: f64 = 1.4;

/// How much slower than from rest to rest the guess of new spans is, on a grid of intervals.
const STOPPING: f64 = 1.2;

impl<S: WindowSolver<N>, const N: usize> Horizon<S, N> {
    /// Finds a plan for the first `count` spans that is accepted and no worse than the one there is;
    /// from rest, where there is none yet, also for fewer. Gives how many it covers.
    pub(super) fn improve(&mut self, count: usize) -> Option<usize> {
        self.cut_time(count);
        let intervals = self.spans.range(..count).map(|span| span.steps).sum();
        let Some(work) = self.credit.window(intervals, self.leading) else {
            // The plan before comes to its stop; what it earns may do for another window.
            self.given_up = self.planned == 0;
            return None;
        };
        self.budget = Budget {
            solves: self.solves,
            work,
        };
        let found = self.improve_within_budget(count);
        self.credit.pay(work - self.budget.work);
        found
    }

    fn improve_within_budget(&mut self, mut count: usize) -> Option<usize> {
        // Motion that has just left the middle of a long move can stop at the end of its line.
        let fewest = if self.moves() {
            straight_line::on_one_line(self.spans.iter())
        } else {
            1
        };
        loop {
            if self.try_window(count) {
                return Some(count);
            }
            if self.planned > 0 || count <= fewest {
                return None;
            }
            count = (count / 2).max(fewest);
            if !self.swings.is_empty() {
                self.cut_finely_enough(count);
            }
        }
    }

    /// Cuts the time of the first `count` spans into intervals, where that has not been done.
    fn cut_time(&mut self, count: usize) {
        let slower = self.slower_for_silence(count);
        let free = self.free.times.iter().zip(&self.free.steady);
        for (span, (duration, steady)) in self.spans.iter_mut().zip(free).take(count) {
            if span.steps == 0 {
                span.steps = span.steps_for(slower * duration, *steady);
            }
        }
        if !self.swings.is_empty() {
            self.cut_finely_enough(count);
        }
    }

    /// Gives the spans of a window as many intervals as its end conditions need; those that are planned keep theirs.
    fn cut_finely_enough(&mut self, count: usize) {
        let all: usize = self.spans.range(..count).map(|span| span.steps).sum();
        let new = count - self.planned;
        if all < SILENT_STEPS && new > 0 {
            let more = (SILENT_STEPS - all).div_ceil(new);
            for span in self.spans.range_mut(self.planned..count) {
                span.steps += more;
            }
        }
    }

    fn try_window(&mut self, count: usize) -> bool {
        let speed = self.start.velocity.norm();
        let open = self.passes() && count == self.spans.len();
        self.guess
            .fill(self.spans.range(..count), speed, open, self.weakest);
        self.lay_segments(count);
        if self.swings.is_empty() || self.planned == 0 {
            self.guess_motion(count);
        } else {
            // A plan that ends silent is not silent in another time.
            self.keep_plan(count);
        }
        // Something is left for another guess, or for fewer spans.
        let kept = self.budget.work / RETRY_SHARE;
        self.budget.work -= kept;
        let mut found = self.solve(count);
        self.budget.work += kept;
        let retained: f64 = self.current.durations.iter().sum();
        let worse = found
            && self.planned > 0
            && self.candidate.durations[..self.planned].iter().sum::<f64>() > WORSE * retained;
        if self.planned > 0 && (!found || worse) {
            self.tally.retried += 1;
            std::mem::swap(&mut self.candidate, &mut self.other);
            self.continue_plan(count);
            let again = self.solve(count);
            if found && (!again || self.other.duration() <= self.candidate.duration()) {
                std::mem::swap(&mut self.candidate, &mut self.other);
            }
            found = found || again;
        }
        if !found {
            return false;
        }
        let stopping: f64 = self
            .spans
            .range(self.planned..count)
            .map(straight_line::stop_to_stop)
            .sum();
        if self.candidate.duration() > retained + stopping && self.planned > 0 {
            return false;
        }
        std::mem::swap(&mut self.current, &mut self.candidate);
        self.planned = count;
        self.expected.clear();
        self.expected.extend(&self.guess.times);
        true
    }

    /// The segments of a window, for the check and, a little smaller, for the solver.
    fn lay_segments(&mut self, count: usize) {
        self.segments.clear();
        for (index, span) in self.spans.range(..count).enumerate() {
            let next = self.spans.get(index + 1).filter(|_| index + 1 < count);
            let walls = self.walls(index);
            self.segments.push(WindowSegment {
                start: span.start,
                end: span.end,
                tolerance: span.tube,
                corner_tolerance: next.map(|next| span.balls[1].min(next.balls[0])),
                feedrate: span.feedrate,
                steps: span.steps,
                follow: span.follow,
                walls,
            });
        }
        self.shrunk_segments.clear();
        let less = |value: f64| value * (1.0 - MARGIN);
        self.shrunk_segments
            .extend(self.segments.iter().map(|segment| WindowSegment {
                tolerance: less(segment.tolerance),
                corner_tolerance: segment.corner_tolerance.map(less),
                feedrate: less(segment.feedrate),
                ..*segment
            }));
    }

    /// A guess of durations: what was planned, sped up or slowed down as its guess was; what is new, as
    /// much slower than its guess as the rest.
    fn guess_motion(&mut self, count: usize) {
        self.ratios.clear();
        self.ratios.extend(
            self.current
                .durations
                .iter()
                .zip(&self.expected)
                .map(|(duration, expected)| duration / expected),
        );
        self.candidate.durations.clear();
        for (ratio, time) in self.ratios.iter().zip(&self.guess.times) {
            self.candidate.durations.push(time * ratio);
        }
        self.ratios.sort_unstable_by(f64::total_cmp);
        let usual = match self.ratios.get(self.ratios.len() / 2) {
            Some(median) => median.clamp(FACTORS.0, FACTORS.1),
            None => FROM_REST * self.slower_for_silence(count),
        };
        let new = self.guess.times[self.planned.min(count)..count].iter();
        self.candidate
            .durations
            .extend(new.map(|time| time * usual));
        self.guess_states();
    }

    /// The plan there is, and new spans a little slower than their guess behind it.
    fn keep_plan(&mut self, count: usize) {
        self.candidate.durations.clear();
        self.candidate.durations.extend(&self.current.durations);
        let new = self.guess.times[self.planned..count].iter();
        self.candidate
            .durations
            .extend(new.map(|time| BEHIND * time));
        self.guess_states();
    }

    /// The plan there is, and new spans from stop to stop behind it.
    fn continue_plan(&mut self, count: usize) {
        self.candidate.durations.clear();
        self.candidate.durations.extend(&self.current.durations);
        let new = self.spans.range(self.planned..count);
        self.candidate
            .durations
            .extend(new.map(|span| STOPPING * straight_line::stop_to_stop(span)));
        self.guess_states();
    }

    /// States and jerks for the durations of the candidate: those of the plan in its own time, and
    /// constant speed along what is new, on the arc where that is followed.
    fn guess_states(&mut self) {
        let end = self.end(self.segments.len());
        let WindowMotion {
            durations,
            states,
            jerks,
        } = &mut self.candidate;
        states.clear();
        jerks.clear();
        let mut node = 0;
        for (index, (segment, &duration)) in self.segments.iter().zip(durations.iter()).enumerate()
        {
            if index < self.planned {
                let ratio = self.current.durations[index] / duration;
                for _ in 0..segment.steps {
                    let state = &self.current.states[node];
                    states.push(EndState {
                        position: state.position,
                        velocity: state.velocity * ratio,
                        acceleration: state.acceleration * (ratio * ratio),
                    });
                    jerks.push(self.current.jerks[node] * ratio.powi(3));
                    node += 1;
                }
                continue;
            }
            let span = segment.end - segment.start;
            let arc = segment
                .follow
                .map_or(Vector::zeros(), |follow| follow.sagitta * 4.0);
            for step in 0..segment.steps {
                let share = steps(step) / steps(segment.steps);
                states.push(EndState {
                    position: segment.start + span * share + arc * (share * (1.0 - share)),
                    velocity: (span + arc * (1.0 - 2.0 * share)) / duration,
                    acceleration: arc * (-2.0 / (duration * duration)),
                });
                jerks.push(Vector::zeros());
            }
        }
        states.push(end);
        if let Some(first) = states.first_mut() {
            *first = self.start;
        }
    }

    /// Solves the window for the candidate; whether its motion may be executed.
    fn solve(&mut self, count: usize) -> bool {
        let window = Window {
            start: self.start,
            end: self.end(count),
            segments: &self.shrunk_segments,
            limits: &self.shrunk,
            silence: self.ends_silent(count).then(|| self.swings.silence()),
        };
        let solved = self
            .solver
            .solve(&window, &mut self.candidate, &mut self.budget);
        if solved.is_err() {
            return false;
        }
        let window = Window {
            segments: &self.segments,
            limits: &self.limits,
            ..window
        };
        accept(&window, &mut self.candidate).is_ok()
            && (window.silence.is_none()
                || comes_to_rest(&window, &self.candidate, &mut self.trial))
    }
}
