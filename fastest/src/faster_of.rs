//! Compares the motions of two planners along the same path and hands out the faster one of every section.
//!
//! Source: ours. A section ends at a place that both motions pass in the same state. One that is too long to be held
//! is led by the motion that is ahead. The section is asked to end in a stop where the second motion leads and its lead
//! is nearly used up, or where the first motion leads and the second is far ahead. Not here: either motion, and what
//! makes a state the same.

use crate::joint::{cut, is_rest, is_same_rest, is_steady};
use std::collections::VecDeque;
use toolglide_kinematics::numeric::TIME_SLACK;
use toolglide_kinematics::{
    Limits, MotionPlanner, Move, Path, PathLimits, Piece, PlanError, Vector,
};

/// Most pieces of a move of the second motion among which a place on that move is sought: a line has fewer, an arc has no
/// such place.
const MAX_SOUGHT: usize = 32;

/// Moves after which it is looked again who is ahead in a section that is too long to be held.
const PATIENCE: usize = 32;

/// What a stop costs at the most, in times to stop from the largest feedrate.
const STOP_COST: f64 = 4.0;

/// Length of a line that is long, as a multiple of what a stop takes at its feedrate, and most such lines that are remembered.
const LONG: f64 = 8.0;
const MAX_LINES: usize = 256;

/// How much further than a stop costs the second motion must be ahead for the first to stop.
const WORTH_STOPPING: f64 = 2.0;

/// Plans with two planners and hands out the faster motion of every section between places that both pass in the same
/// state.
///
/// The first planner must take every move; where it refuses one, so does this. Where the second does, the motion is that of
/// the first from there on.
#[derive(Clone, Debug)]
pub struct FasterOf<A, B, const N: usize> {
    first: A,
    second: B,
    held: usize,
    ours: Lane<N>,
    theirs: Lane<N>,
    /// Pieces of the first motion that have been looked at, and their duration.
    walked: usize,
    walked_time: f64,
    /// Whether the section under way begins with the second part of a steady piece.
    cut: bool,
    /// Whether the second planner has given up.
    lost: bool,
    finished: bool,
    /// Who travels the section under way, once that is settled, and how many pieces of it are left, once that is known.
    source: Option<Source>,
    left: Option<usize>,
    /// By how much longer the first motion took than the second for what is no longer held of the section, s.
    passed: f64,
    /// What a stop from a speed takes along the axis that stops the slowest, and the largest feedrate so far.
    weakest: PathLimits,
    feedrate: f64,
    /// Moves since it was looked who is ahead, and whether the section has been asked to end in a stop.
    since: usize,
    asked: bool,
    /// Moves taken, where the path has come to, and the latest moves that are long lines.
    count: u32,
    at: Vector<N>,
    lines: VecDeque<u32>,
}

/// Which motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    First,
    Second,
}

/// Pieces of one motion that have not been handed out.
type Lane<const N: usize> = VecDeque<Piece<N>>;

/// Where a piece of the first motion meets the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// After so many pieces of the first and of the second.
    After(usize, usize),
    /// It is not known yet.
    NotYet,
    /// Nowhere.
    Nowhere,
}

impl<A, B, const N: usize> FasterOf<A, B, N> {
    /// The faster of two planners, both at rest at `start`, within limits.
    ///
    /// So many pieces of the first motion, and twice as many of the second, are held before the section is led by one
    /// of them.
    #[must_use]
    pub fn new(start: Vector<N>, first: A, second: B, limits: &Limits<N>, held: usize) -> Self {
        Self {
            first,
            second,
            held,
            ours: VecDeque::with_capacity(held + 2),
            theirs: VecDeque::with_capacity(2 * held + 2),
            walked: 0,
            walked_time: 0.0,
            cut: false,
            lost: false,
            finished: false,
            source: None,
            left: None,
            passed: 0.0,
            weakest: PathLimits {
                velocity: limits.velocity().max(),
                acceleration: limits.acceleration().min(),
                jerk: limits.jerk().min(),
            },
            feedrate: 0.0,
            since: 0,
            asked: false,
            count: 0,
            at: start,
            lines: VecDeque::with_capacity(MAX_LINES),
        }
    }

    /// Ends the section after so many pieces of either motion.
    fn end(&mut self, ours: usize, theirs: usize) {
        let time: f64 = self.theirs.range(..theirs).map(Piece::duration).sum();
        debug_assert!(
            ours <= self.ours.len(),
            "a section ends among the pieces held"
        );
        let source = self
            .source
            .unwrap_or(if time < self.walked_time - TIME_SLACK {
                Source::Second
            } else {
                Source::First
            });
        match source {
            Source::First => {
                self.theirs.drain(..theirs);
                self.left = Some(ours);
            }
            Source::Second => {
                self.ours.drain(..ours);
                self.left = Some(theirs);
            }
        }
        self.source = Some(source);
        (self.walked, self.walked_time) = (0, 0.0);
        (self.passed, self.asked) = (0.0, false);
    }

    /// Looks for the end of the section under way; whether its beginning may be handed out.
    fn settle(&mut self) -> bool {
        while self.walked < self.ours.len() {
            match self.place(self.walked) {
                Place::After(ours, theirs) => {
                    self.walked_time += self
                        .ours
                        .range(self.walked..ours)
                        .map(Piece::duration)
                        .sum::<f64>();
                    self.end(ours, theirs);
                    return true;
                }
                Place::NotYet => {
                    if self.source.is_none() && self.is_rise(self.walked) {
                        self.source = Some(Source::First);
                    }
                    break;
                }
                Place::Nowhere => {
                    self.walked_time += self.ours[self.walked].duration();
                    self.walked += 1;
                }
            }
        }
        if self.is_complete() && self.walked == self.ours.len() && !self.ours.is_empty() {
            if self.lost || self.theirs.is_empty() {
                self.source = Some(Source::First);
            }
            self.end(self.walked, self.theirs.len());
            return true;
        }
        if self.source.is_none() && (self.is_full() || self.lost) {
            let leads = !self.lost && self.ahead() > self.reserve();
            self.source = Some(if leads { Source::Second } else { Source::First });
        }
        self.source.is_some() && self.walked > 0
    }

    /// Whether all up to a steady piece is a rise from rest along one long line, where nothing is faster.
    fn is_rise(&mut self, at: usize) -> bool {
        let (first, piece) = (&self.ours[0], &self.ours[at]);
        let serves = piece.serves();
        while self.lines.front().is_some_and(|line| *line < serves.first) {
            self.lines.pop_front();
        }
        is_steady(piece)
            && serves.first == serves.last
            && self.lines.front() == Some(&serves.first)
            && first.serves() == serves
            && first.at(0.0).velocity.norm_squared() <= 0.0
    }

    /// Where a piece of the first motion, or its end, meets the second motion.
    fn place(&mut self, at: usize) -> Place {
        let piece = self.ours[at];
        if is_steady(&piece) {
            return if at == 0 && std::mem::take(&mut self.cut) {
                Place::Nowhere
            } else {
                self.place_of_steady(at, &piece)
            };
        }
        let Some(next) = self.ours.get(at + 1).copied() else {
            return if self.is_complete() {
                Place::Nowhere
            } else {
                Place::NotYet
            };
        };
        if !is_rest(&piece, &next) {
            return Place::Nowhere;
        }
        let index = piece.serves().last;
        let after = self
            .theirs
            .partition_point(|piece| piece.serves().last <= index);
        if after == self.theirs.len() {
            return self.beyond();
        }
        if after > 0
            && is_same_rest(
                [&piece, &next],
                [&self.theirs[after - 1], &self.theirs[after]],
            )
        {
            return Place::After(at + 1, after);
        }
        Place::Nowhere
    }

    fn place_of_steady(&mut self, at: usize, piece: &Piece<N>) -> Place {
        let index = piece.serves().first;
        let first = self
            .theirs
            .partition_point(|piece| piece.serves().last < index);
        for place in first..self.theirs.len() {
            if place > first + MAX_SOUGHT {
                return Place::Nowhere;
            }
            let other = self.theirs[place];
            if other.serves().first > index {
                return Place::Nowhere;
            }
            if let Some([ours, theirs]) = cut(piece, &other) {
                self.ours[at] = ours[0];
                self.ours.insert(at + 1, ours[1]);
                self.theirs[place] = theirs[0];
                self.theirs.insert(place + 1, theirs[1]);
                self.cut = true;
                return Place::After(at + 1, place + 1);
            }
        }
        self.beyond()
    }

    /// Whether all motion up to the end of the path is known.
    fn is_complete(&self) -> bool {
        self.finished && self.ours.len() < self.held && self.theirs.len() < 2 * self.held
    }

    /// Whether no more can be held of what both motions do on the same moves.
    fn is_full(&self) -> bool {
        let (Some(our_last), Some(their_last)) = (self.ours.back(), self.theirs.back()) else {
            return self.ours.len() >= self.held;
        };
        self.ours.len() >= self.held
            || (self.theirs.len() >= 2 * self.held
                && our_last.serves().last >= their_last.serves().first)
    }

    /// What is beyond all that is known of the second motion.
    fn beyond(&self) -> Place {
        if self.is_complete() || self.lost {
            Place::Nowhere
        } else {
            Place::NotYet
        }
    }

    /// Hands out a piece of the section under way.
    fn hand_out(&mut self) -> Option<Piece<N>> {
        if self.left == Some(0) {
            (self.source, self.left) = (None, None);
        }
        if self.left.is_none() && !self.settle() {
            return None;
        }
        match (self.source?, self.left) {
            (Source::Second, Some(left)) => {
                self.left = Some(left.checked_sub(1)?);
                self.theirs.pop_front()
            }
            (Source::Second, None) => self.lead(),
            (Source::First, Some(left)) => {
                self.left = Some(left.checked_sub(1)?);
                self.ours.pop_front()
            }
            (Source::First, None) => {
                self.walked = self.walked.checked_sub(1)?;
                let piece = self.ours.pop_front()?;
                self.walked_time -= piece.duration();
                self.passed += piece.duration() - drop_before(&mut self.theirs, &piece).1;
                Some(piece)
            }
        }
    }

    /// Hands out a piece of the second motion before the end of the section is known.
    fn lead(&mut self) -> Option<Piece<N>> {
        // Where the first motion has not been looked at, both may still meet.
        let open = match self.ours.get(self.walked) {
            Some(piece) => piece.serves().first,
            None => self.ours.back()?.serves().last,
        };
        if self.theirs.front()?.serves().last >= open {
            return None;
        }
        let piece = self.theirs.pop_front()?;
        let (count, time) = drop_before(&mut self.ours, &piece);
        self.walked = self.walked.saturating_sub(count);
        self.walked_time -= time;
        self.passed += time - piece.duration();
        Some(piece)
    }

    /// What a stop on the path costs at the most, s.
    fn reserve(&self) -> f64 {
        let speed = self.feedrate.min(self.weakest.velocity);
        STOP_COST * self.weakest.time_to_change(speed)
    }

    /// By how much the second motion is ahead at the last move that both have finished, s.
    fn ahead(&self) -> f64 {
        let (Some(our_last), Some(their_last)) = (self.ours.back(), self.theirs.back()) else {
            return f64::NEG_INFINITY;
        };
        let common = our_last.serves().first.min(their_last.serves().first);
        let time = |lane: &Lane<N>| -> f64 {
            lane.iter()
                .take_while(|piece| piece.serves().last < common)
                .map(Piece::duration)
                .sum()
        };
        self.passed + time(&self.ours) - time(&self.theirs)
    }

    /// Whether a move is a line in the middle of which every motion passes at its feedrate.
    fn is_long(&self, step: &Move<N>) -> bool {
        let speed = step.feedrate().speed().min(self.weakest.velocity);
        let stop = speed * self.weakest.time_to_change(speed);
        matches!(step.path(), Path::Line { .. }) && step.length(self.at) > LONG * stop
    }

    /// Whether the section under way had better end in a stop.
    fn wants_stop(&mut self) -> bool {
        if self.source.is_none() || self.left.is_some() || self.asked || self.lost {
            self.since = 0;
            return false;
        }
        self.since += 1;
        if self.since < PATIENCE {
            return false;
        }
        self.since = 0;
        let ahead = self.ahead();
        self.asked = match self.source {
            Some(Source::Second) => ahead < self.reserve(),
            _ => ahead > WORTH_STOPPING * self.reserve(),
        };
        self.asked
    }
}

/// Drops the pieces that end before the moves of another; how many there were, and their duration.
fn drop_before<const N: usize>(lane: &mut Lane<N>, piece: &Piece<N>) -> (usize, f64) {
    let count = lane.partition_point(|other| other.serves().last < piece.serves().first);
    let time = lane.drain(..count).map(|piece| piece.duration()).sum();
    (count, time)
}

impl<A: MotionPlanner<N>, B: MotionPlanner<N>, const N: usize> FasterOf<A, B, N> {
    /// Takes what both have ready, as far as there is room for it; whether there was anything.
    fn gather(&mut self) -> bool {
        let before = self.ours.len() + self.theirs.len();
        while self.ours.len() < self.held
            && let Some(piece) = self.first.pull()
        {
            self.ours.push_back(piece);
        }
        while !self.lost
            && self.theirs.len() < 2 * self.held
            && let Some(piece) = self.second.pull()
        {
            self.theirs.push_back(piece);
        }
        self.ours.len() + self.theirs.len() > before
    }
}

impl<A: MotionPlanner<N>, B: MotionPlanner<N>, const N: usize> MotionPlanner<N>
    for FasterOf<A, B, N>
{
    fn push(&mut self, next: &Move<N>) -> Result<(), PlanError> {
        self.feedrate = self.feedrate.max(next.feedrate().speed());
        let next = if self.wants_stop() {
            next.with_exact_stop()
        } else {
            *next
        };
        self.first.push(&next)?;
        if self.is_long(&next) {
            if self.lines.len() == MAX_LINES {
                self.lines.pop_front();
            }
            self.lines.push_back(self.count);
        }
        self.count = self.count.saturating_add(1);
        self.at = next.end(self.at);
        self.lost |= !self.lost && self.second.push(&next).is_err();
        Ok(())
    }

    fn finish(&mut self) -> Result<(), PlanError> {
        self.first.finish()?;
        self.lost |= !self.lost && self.second.finish().is_err();
        self.finished = true;
        Ok(())
    }

    fn pull(&mut self) -> Option<Piece<N>> {
        loop {
            let more = self.gather();
            if let Some(piece) = self.hand_out() {
                return Some(piece);
            }
            if !more {
                return None;
            }
        }
    }
}
