//! Overlaps filtered feed pulses by the rule of a single corner, as it is printed.
//!
//! Source: equation 4.26 for the blend time of two lines. Every corner is taken as if its moves were endless, so where moves
//! are shorter than the delay of the filters the deviations of several corners add up beyond the tolerance; `fir` bounds their
//! sum instead. The whole path is held. Not here: a motion that keeps its tolerance.

use toolglide_fir::{FilterChain, FirError, PulseTrain};
use toolglide_kinematics::numeric::SHORTEST_LENGTH;
use toolglide_kinematics::{
    Limits, MotionPlanner, Move, MoveRange, Path, PathCursor, Piece, PlanError, Sample, Vector,
};

/// Halvings of the search for a blend time.
const HALVINGS: u32 = 60;

/// Longest piece of an arc, s: its motion is no polynomial.
const ARC_PIECE: f64 = 1e-3;

/// Knots nearer than this are one, s.
const SAME_TIME: f64 = 1e-9;

/// A pulse that is to be commanded.
#[derive(Clone, Copy, Debug)]
struct Waiting<const N: usize> {
    step: Move<N>,
    start: Vector<N>,
    feedrate: f64,
    index: u32,
    /// Pause before it, s, beside that of the corner.
    pause: f64,
    /// Whether the motion comes to rest before it.
    rest: bool,
}

/// Plans filtered pulses by the local rule alone; hands out everything when the path is over.
#[derive(Clone, Debug)]
pub struct LocalOverlap<const N: usize> {
    cursor: PathCursor<N>,
    limits: Limits<N>,
    chain: FilterChain,
    start: Vector<N>,
    waiting: Vec<Waiting<N>>,
    pause: f64,
    rest: bool,
    pieces: std::collections::VecDeque<Piece<N>>,
}

impl<const N: usize> LocalOverlap<N> {
    /// A planner at rest at `start`, with one chain of filters for all axes.
    #[must_use]
    pub fn new(start: Vector<N>, limits: Limits<N>, chain: FilterChain) -> Self {
        Self {
            cursor: PathCursor::new(start),
            limits,
            chain,
            start,
            waiting: Vec::new(),
            pause: 0.0,
            rest: true,
            pieces: std::collections::VecDeque::new(),
        }
    }

    /// Position behind the filters a time after a step of velocity by 1.
    fn response(&self, time: f64) -> f64 {
        // The response of a chain of moving averages: the commanded position, later by half the delay, once all is over.
        let delay = self.chain.total_delay();
        let mut train = PulseTrain::<1>::starting_at(Vector::zeros(), self.chain.clone());
        match train.line_to(Vector::<1>::new(2.0 * delay), 1.0, 0.0) {
            Ok(()) => train.position(time.min(2.0 * delay)).x,
            Err(_) => time,
        }
    }

    /// The time at which the response reaches a value, at most the delay of the filters.
    fn time_of(&self, value: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.chain.total_delay());
        if self.response(high) <= value {
            return high;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.response(middle) < value {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// The pause between two pulses, s, so that a single corner keeps its tolerance.
    fn dwell(&self, before: &Waiting<N>, after: &Waiting<N>) -> f64 {
        let delay = self.chain.total_delay();
        if after.rest {
            return delay + after.pause;
        }
        let (one, other) = (leaving(before), entering(after));
        let sine = 0.5 * (other - one).norm();
        let tolerance = before
            .step
            .tolerance()
            .length()
            .min(after.step.tolerance().length());
        if sine <= f64::EPSILON {
            return 0.0;
        }
        let share = |feedrate: f64| self.time_of(tolerance / (2.0 * feedrate * sine));
        (delay - share(before.feedrate) - share(after.feedrate)).max(0.0)
    }

    /// Commands all pulses and hands out the motion behind the filters.
    fn plan(&mut self) -> Result<(), FirError> {
        let mut train = PulseTrain::starting_at(self.start, self.chain.clone());
        let mut times: Vec<f64> = Vec::new();
        let mut spans: Vec<(f64, f64, u32)> = Vec::new();
        let mut clock = 0.0;
        let mut has_arcs = false;
        for (place, next) in self.waiting.iter().enumerate() {
            let dwell = match place
                .checked_sub(1)
                .and_then(|before| self.waiting.get(before))
            {
                Some(before) => self.dwell(before, next),
                None => next.pause,
            };
            let length = next.step.length(next.start);
            match next.step.path() {
                Path::Arc(arc) => {
                    has_arcs = true;
                    train.arc(*arc, next.feedrate, dwell)?;
                }
                _ => train.line_to(next.step.end(next.start), next.feedrate, dwell)?,
            }
            let begin = clock + dwell;
            clock = begin + length / next.feedrate;
            spans.push((begin, clock, next.index));
            times.extend([begin, clock]);
        }
        let knots = self.knots(&times, has_arcs);
        self.hand_out(&train, &knots, &spans);
        Ok(())
    }

    /// Times at which the motion behind the filters changes its polynomial.
    fn knots(&self, times: &[f64], has_arcs: bool) -> Vec<f64> {
        let mut sums = vec![0.0];
        for constant in self.chain.time_constants() {
            let shifted: Vec<f64> = sums.iter().map(|sum| sum + constant).collect();
            sums.extend(shifted);
        }
        let mut knots: Vec<f64> = times
            .iter()
            .flat_map(|time| sums.iter().map(move |sum| time + sum))
            .collect();
        if has_arcs && let Some(end) = knots.iter().copied().reduce(f64::max) {
            let mut time = ARC_PIECE;
            while time < end {
                knots.push(time);
                time += ARC_PIECE;
            }
        }
        knots.push(0.0);
        knots.sort_by(f64::total_cmp);
        knots.dedup_by(|next, kept| *next - *kept < SAME_TIME);
        knots
    }

    fn hand_out(&mut self, train: &PulseTrain<N>, knots: &[f64], spans: &[(f64, f64, u32)]) {
        let delay = self.chain.total_delay();
        let mut first = 0;
        for pair in knots.windows(2) {
            let (begin, end) = (pair[0], pair[1]);
            let time = end - begin;
            let (from, to) = (train.position(begin), train.position(end));
            let (leaves, arrives) = (train.velocity(begin), train.velocity(end));
            let span = to - from;
            // A cubic between two knots is known by its ends.
            let state = Sample {
                position: from,
                velocity: leaves,
                acceleration: (span * 6.0 - (leaves * 4.0 + arrives * 2.0) * time) / (time * time),
                jerk: ((leaves + arrives) * 6.0 * time - span * 12.0) / (time * time * time),
            };
            // A pulse moves the tool from where it begins until the delay after it has ended.
            let middle = begin + 0.5 * time;
            while spans
                .get(first)
                .is_some_and(|(_, stop, _)| stop + delay <= middle)
                && first + 1 < spans.len()
            {
                first += 1;
            }
            let mut last = first;
            while spans
                .get(last + 1)
                .is_some_and(|(start, ..)| *start < middle)
            {
                last += 1;
            }
            let index = |place: usize| spans.get(place).map_or(0, |span| span.2);
            let serves = MoveRange {
                first: index(first),
                last: index(last),
            };
            self.pieces.push_back(Piece::new(&state, time, to, serves));
        }
    }
}

/// Direction at the end of a move.
fn leaving<const N: usize>(waiting: &Waiting<N>) -> Vector<N> {
    match waiting.step.path() {
        Path::Arc(arc) => arc.tangent(1.0),
        _ => straight(waiting),
    }
}

/// Direction at the start of a move.
fn entering<const N: usize>(waiting: &Waiting<N>) -> Vector<N> {
    match waiting.step.path() {
        Path::Arc(arc) => arc.tangent(0.0),
        _ => straight(waiting),
    }
}

fn straight<const N: usize>(waiting: &Waiting<N>) -> Vector<N> {
    (waiting.step.end(waiting.start) - waiting.start)
        .try_normalize(0.0)
        .unwrap_or_else(Vector::zeros)
}

impl<const N: usize> MotionPlanner<N> for LocalOverlap<N> {
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        let start = self.cursor.end();
        let index = self.cursor.take(next)?;
        if let Path::Dwell { duration } = next.path() {
            self.pause += duration;
            self.rest = true;
            return Ok(());
        }
        if next.length(start) > SHORTEST_LENGTH {
            let direction = match next.path() {
                Path::Arc(arc) => arc.tangent(0.0),
                _ => next.end(start) - start,
            };
            let along = self
                .limits
                .along(&direction.try_normalize(0.0).unwrap_or_else(Vector::zeros));
            self.waiting.push(Waiting {
                step: *next,
                start,
                feedrate: next.feedrate().speed().min(along.velocity),
                index,
                pause: std::mem::take(&mut self.pause),
                rest: std::mem::take(&mut self.rest),
            });
        }
        self.rest |= next.stops();
        Ok(())
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        if self.cursor.close() {
            let index = self.cursor.count();
            self.plan().map_err(|_| PlanError::Magnitude { index })?;
        }
        Ok(())
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        self.pieces.pop_front()
    }
}
