//! Which motion each corner gets: the cheapest way through the candidates of all corners.
//!
//! Source: ours; section 8 of our derivation shows that no single kind is always the fastest. Each
//! corner offers a full stop and the motions that the windows have scaled; every motion of a window
//! is followed by one of the same window that fits, and a stop is followed by a stop, so no choice
//! leads into a dead end. The plan that stops at every corner is one of the ways, so the cheapest is
//! never slower. A way that lies behind another by more than the time to stop is given up: the other
//! could have stopped by then, and would still be ahead. Not here: where the candidates come from.

use crate::turn::TurnShape;
use crate::window::Link;
use std::collections::VecDeque;
use toolglide_profiles::Connection;

/// Most candidates of one corner.
pub(crate) const MOST_CANDIDATES: usize = 8;

/// Share of a move that two corners must leave free, lest they are tried overlapping.
const OVERLAPPING: f64 = 2.0;

/// Times to stop by which a way that does not stop may lie behind the cheapest.
const STOPS_BEHIND: f64 = 4.0;

/// Corners between two attempts to commit.
const PATIENCE: usize = 16;

/// A corner, its candidates, and the cheapest way to each.
#[derive(Clone, Copy, Debug)]
struct Column {
    shapes: [TurnShape; MOST_CANDIDATES],
    /// Time to the middle of the corner.
    costs: [f64; MOST_CANDIDATES],
    origins: [u8; MOST_CANDIDATES],
    /// Duration of the overlap in which the corner is reached; zero when it is reached on the move.
    overlaps: [f64; MOST_CANDIDATES],
    count: usize,
    /// How many of the candidates, the first ones, can always be followed by another.
    safe: usize,
}

/// The motion chosen for a corner.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    pub(crate) shape: TurnShape,
    /// Duration from the middle of the corner before to the middle of this one where both overlap.
    pub(crate) overlap: Option<f64>,
}

/// The cheapest way through a stream of corners, committed as soon as all ways agree.
#[derive(Clone, Debug)]
pub(crate) struct Lattice {
    columns: VecDeque<Column>,
    chosen: VecDeque<Choice>,
    way: Vec<u8>,
    size: usize,
    wait: usize,
    finished: bool,
    /// The last move.
    last: Option<Link>,
}

impl Lattice {
    /// A lattice that holds `size` corners at the most and begins at rest.
    /// After `burst` corners that nobody has pulled it allocates.
    pub(crate) fn new(size: usize, burst: usize) -> Self {
        let size = size.max(1);
        let mut lattice = Self {
            columns: VecDeque::with_capacity(size + 2),
            chosen: VecDeque::with_capacity(burst + 2 * size + 2),
            way: Vec::with_capacity(size + 2),
            size,
            wait: 0,
            finished: false,
            last: None,
        };
        lattice.restart_after(TurnShape::STOP);
        lattice
    }

    /// Begins again with the exit of a motion, from which a stop can be reached.
    pub(crate) fn restart_after(&mut self, shape: TurnShape) {
        self.columns.clear();
        let mut first = Column::empty();
        first.offer(shape);
        first.safe = 1;
        first.costs[0] = 0.0;
        self.columns.push_back(first);
        self.chosen.clear();
        self.wait = PATIENCE.min(self.size);
        self.finished = false;
        self.last = None;
    }

    /// Takes a move and the candidates of the corner at its end, first those that can always be followed
    /// by another (at least one), then those that may lead into a dead end; `overlap` gives the duration from the
    /// middle of one corner to the middle of the next where they can overlap.
    pub(crate) fn push(
        &mut self,
        link: &Link,
        safe: &[TurnShape],
        candidates: &[TurnShape],
        overlap: impl Fn(&TurnShape, &TurnShape) -> Option<f64>,
    ) {
        let mut column = Column::empty();
        for candidate in safe {
            column.offer(*candidate);
        }
        column.safe = column.count;
        for candidate in candidates {
            column.offer(*candidate);
        }
        if let Some(last) = self.columns.back() {
            column.reach_from(last, link, overlap);
        }
        self.last = Some(*link);
        self.columns.push_back(column);
        self.wait = self.wait.saturating_sub(1);
        if self.wait == 0 || self.columns.len() > self.size {
            self.commit();
            self.wait = PATIENCE.min(self.size);
        }
    }

    /// Says that the motion ends at the last corner pushed.
    pub(crate) fn finish(&mut self) {
        self.finished = true;
        self.commit();
    }

    /// The motion chosen for the corner before the last that has been chosen.
    pub(crate) fn before_last(&self) -> Option<Choice> {
        self.chosen.iter().rev().nth(1).copied()
    }

    /// The motion chosen for the next corner.
    pub(crate) fn pull(&mut self) -> Option<Choice> {
        self.chosen.pop_front()
    }

    /// Commits the part of the way on which all survivors agree; when the lattice is full, half of
    /// the way that could stop now.
    fn commit(&mut self) {
        let Some(last) = self.columns.back_mut() else {
            return;
        };
        if let Some(link) = &self.last {
            last.give_up(link);
        }
        let last = *last;
        let end = self.columns.len() - 1;
        // Walk all survivors back at once until they meet.
        let mut alive = [false; MOST_CANDIDATES];
        for (candidate, cost) in last.costs.iter().enumerate().take(last.count) {
            alive[candidate] = cost.is_finite();
        }
        if self.finished {
            alive = [false; MOST_CANDIDATES];
            alive[last.cheapest()] = true;
        }
        let mut index = end;
        while index > 0 && alive.iter().filter(|alive| **alive).count() > 1 {
            let mut before = [false; MOST_CANDIDATES];
            for candidate in 0..self.columns[index].count {
                if alive[candidate] {
                    before[usize::from(self.columns[index].origins[candidate])] = true;
                }
            }
            alive = before;
            index -= 1;
        }
        let mut candidate = alive.iter().position(|alive| *alive).unwrap_or(0);
        if index == 0 && end >= self.size {
            (index, candidate) = self.force();
        }
        // Read the agreed way backwards, then commit it forwards.
        self.way.clear();
        for at in (1..=index).rev() {
            self.way.push(u8::try_from(candidate).unwrap_or(0));
            candidate = usize::from(self.columns[at].origins[candidate]);
        }
        for at in 1..=index {
            let choice = usize::from(self.way[index - at]);
            let column = &self.columns[at];
            let overlap = column.overlaps[choice];
            self.chosen.push_back(Choice {
                shape: column.shapes[choice],
                overlap: (overlap > 0.0).then_some(overlap),
            });
        }
        self.columns.drain(..index);
        self.settle();
    }

    /// Half of the cheapest way, or of the cheapest that stops now while that is not far behind; ways
    /// that left it before are given up.
    fn force(&mut self) -> (usize, usize) {
        let end = self.columns.len() - 1;
        let middle = (end / 2).max(1);
        let last = self.columns[end];
        let goal = last.stop();
        let target = self.origin_at(end, goal, middle);
        for candidate in 0..last.count {
            if last.costs[candidate].is_finite() && self.origin_at(end, candidate, middle) != target
            {
                self.columns[end].costs[candidate] = f64::INFINITY;
            }
        }
        (middle, target)
    }

    fn origin_at(&self, from: usize, candidate: usize, at: usize) -> usize {
        let mut candidate = candidate;
        for index in (at + 1..=from).rev() {
            candidate = usize::from(self.columns[index].origins[candidate]);
        }
        candidate
    }

    /// Counts costs from the newest column, so that they do not grow with the program.
    fn settle(&mut self) {
        if let Some(last) = self.columns.back_mut() {
            let base = last.costs[..last.count]
                .iter()
                .fold(f64::INFINITY, |least, cost| least.min(*cost));
            if base.is_finite() {
                for cost in &mut last.costs[..last.count] {
                    *cost -= base;
                }
            }
        }
    }
}

impl Column {
    fn empty() -> Self {
        Self {
            shapes: [TurnShape::STOP; MOST_CANDIDATES],
            costs: [f64::INFINITY; MOST_CANDIDATES],
            origins: [0; MOST_CANDIDATES],
            overlaps: [0.0; MOST_CANDIDATES],
            count: 0,
            safe: 0,
        }
    }

    /// Adds a candidate unless it is there already.
    fn offer(&mut self, shape: TurnShape) {
        let known = self.shapes[..self.count].contains(&shape);
        if !known && self.count < MOST_CANDIDATES {
            self.shapes[self.count] = shape;
            self.count += 1;
        }
    }

    /// The stop, unless it was given up or is not offered; the cheapest safe one otherwise.
    fn stop(&self) -> usize {
        (0..self.safe)
            .find(|&candidate| {
                self.shapes[candidate].is_stop() && self.costs[candidate].is_finite()
            })
            .unwrap_or_else(|| self.cheapest())
    }

    /// Gives up what lies too far behind the cheapest safe one, given the time in which that could stop
    /// on a move like the last: it could have stopped, or stopped and started again.
    fn give_up(&mut self, link: &Link) {
        let cheapest = self.cheapest();
        let least = self.costs[cheapest];
        let speed = self.shapes[cheapest].exit.speed;
        let time_to_stop = link.limits.time_to_change(speed);
        for candidate in 0..self.count {
            let times = if self.shapes[candidate].is_stop() {
                1.0
            } else {
                STOPS_BEHIND
            };
            if self.costs[candidate] > least + times * time_to_stop {
                self.costs[candidate] = f64::INFINITY;
            }
        }
    }

    /// The cheapest of those that can always be followed by another.
    fn cheapest(&self) -> usize {
        let mut best = 0;
        for candidate in 1..self.safe {
            if self.costs[candidate] < self.costs[best] {
                best = candidate;
            }
        }
        best
    }

    /// Finds the cheapest way to each candidate over `link`.
    fn reach_from(
        &mut self,
        last: &Self,
        link: &Link,
        overlap: impl Fn(&TurnShape, &TurnShape) -> Option<f64>,
    ) {
        for candidate in 0..self.count {
            let to = self.shapes[candidate];
            let mut best = f64::INFINITY;
            for origin in 0..last.count {
                let from = &last.shapes[origin];
                let length = link.length - from.exit.distance - to.entry.distance;
                let before = last.costs[origin];
                let halves = 0.5 * (from.duration + to.duration);
                // No way is shorter than the whole length at the feedrate.
                if length >= 0.0 && before + halves + length / link.limits.velocity < best {
                    let connection = Connection {
                        from: [from.exit.speed, from.exit.acceleration],
                        to: [to.entry.speed, to.entry.acceleration],
                        limits: link.limits,
                    };
                    if let Some(duration) = connection.duration_over(length) {
                        let cost = before + halves + duration;
                        if cost < best {
                            best = cost;
                            self.origins[candidate] = u8::try_from(origin).unwrap_or(0);
                            self.overlaps[candidate] = 0.0;
                        }
                    }
                }
                let short = length < OVERLAPPING * link.length;
                if short
                    && before < best
                    && let Some(duration) = overlap(from, &to)
                    && before + duration < best
                {
                    best = before + duration;
                    self.origins[candidate] = u8::try_from(origin).unwrap_or(0);
                    self.overlaps[candidate] = duration;
                }
            }
            self.costs[candidate] = best;
        }
    }
}
