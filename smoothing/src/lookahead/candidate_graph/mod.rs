//! Finds the fastest path through the candidates of all corners by dynamic programming.
//!
//! Source: ours; section 8 of our derivation shows that no single kind is always the fastest. Each
//! corner offers a full stop and the motions that the windows have scaled; every motion of a window
//! is followed by one of the same window that fits, and a stop is followed by a stop, so no choice
//! leads into a dead end. The plan that stops at every corner is one of the ways, so the cheapest is
//! never slower. A way that lies far behind another is given up, except the one that stops now: on it
//! rests the promise. Not here: where the candidates come from.

mod stage;

use crate::lookahead::window::Link;
pub(crate) use stage::MAX_CANDIDATES;
use stage::Stage;
use std::collections::VecDeque;
use toolglide_profiles::BlendShape;

/// Most corners between two attempts to commit, each of which looks at all that wait.
const PATIENCE: usize = 16;

/// An attempt to commit waits until so many times as many corners at the most wait as are new.
const ATTEMPTS: usize = 4;

/// The motion chosen for a corner.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    pub(crate) shape: BlendShape,
    /// Duration from the middle of the corner before to the middle of this one where both overlap.
    pub(crate) overlap: Option<f64>,
}

/// The cheapest way through a stream of corners, committed as soon as all ways agree.
#[derive(Clone, Debug)]
pub(crate) struct CandidateGraph {
    columns: VecDeque<Stage>,
    chosen: VecDeque<Choice>,
    way: Vec<u8>,
    size: usize,
    wait: usize,
    finished: bool,
    /// The last move.
    last: Option<Link>,
    /// Time from the beginning from which the costs are counted.
    spent: f64,
}

impl CandidateGraph {
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
            spent: 0.0,
        };
        lattice.restart_after(BlendShape::STOP);
        lattice
    }

    /// Begins again with the exit of a motion, from which a stop can be reached.
    pub(crate) fn restart_after(&mut self, shape: BlendShape) {
        self.columns.clear();
        let mut first = Stage::empty();
        first.offer(shape);
        first.safe = 1;
        first.costs[0] = 0.0;
        self.columns.push_back(first);
        self.chosen.clear();
        self.wait = 1;
        self.finished = false;
        self.last = None;
        self.spent = 0.0;
    }

    /// Becomes a copy of another, without the choices that wait to be pulled.
    pub(crate) fn follow(&mut self, other: &Self) {
        self.columns.clone_from(&other.columns);
        self.chosen.clear();
        self.size = other.size;
        self.wait = other.wait;
        self.finished = other.finished;
        self.last = other.last;
        self.spent = other.spent;
    }

    /// After it has been finished: the time from the beginning to the end; infinite where there is no way.
    pub(crate) fn duration(&self) -> f64 {
        self.spent
    }

    /// Drops the choices that wait to be pulled.
    pub(crate) fn forget(&mut self) {
        self.chosen.clear();
    }

    /// Takes a move and the candidates of the corner at its end, first those that can always be followed
    /// by another (at least one), then those that may lead into a dead end; `overlap` gives the duration from the
    /// middle of one corner to the middle of the next where they can overlap in less than it is told.
    pub(crate) fn push(
        &mut self,
        link: &Link,
        safe: &[BlendShape],
        candidates: &[BlendShape],
        overlap: impl Fn(&BlendShape, &BlendShape, f64) -> Option<f64>,
    ) {
        let mut column = Stage::empty();
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
        // A single candidate is on every way.
        let settles = self.columns.back().is_some_and(|last| last.count == 1);
        if self.wait == 0 || settles || self.columns.len() > self.size {
            self.commit();
            self.wait = (self.columns.len() / ATTEMPTS).clamp(1, PATIENCE);
        }
    }

    /// Says that the motion ends at the last corner pushed.
    pub(crate) fn finish(&mut self) {
        self.finished = true;
        self.commit();
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
        let mut alive = [false; MAX_CANDIDATES];
        for (candidate, cost) in last.costs.iter().enumerate().take(last.count) {
            alive[candidate] = cost.is_finite();
        }
        if self.finished {
            alive = [false; MAX_CANDIDATES];
            alive[last.cheapest()] = true;
        }
        let mut index = end;
        while index > 0 && alive.iter().filter(|alive| **alive).count() > 1 {
            let mut before = [false; MAX_CANDIDATES];
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
                self.spent += base;
            } else {
                // Where no stop is among the candidates, there may be no way to the end.
                self.spent = f64::INFINITY;
            }
        }
    }
}
