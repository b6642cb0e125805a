//! Compares two motions along the same path and hands out the faster one of every section.
//!
//! Source: ours. A stretch ends where both motions rest, or where both pass the middle of a long move on
//! its line at its feedrate: there the one may take the place of the other. A stretch too long to be held
//! is led by whoever is ahead, and is asked to end in a stop should that lead be used up. Not here: either
//! motion.

use crate::window::output::{Event, Joint};
use std::collections::VecDeque;
use toolglide_kinematics::Piece;
use toolglide_kinematics::numeric::TIME_SLACK;

/// Events held of either motion before a stretch is led by one of them: some minutes, and some ten
/// megabytes.
const MAX_HELD: usize = 1 << 16;

/// What a motion costs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Cost {
    /// s.
    time: f64,
    /// Integral of the square of jerk over time, mm²/s⁵.
    energy: f64,
}

impl Cost {
    fn of<'a, const N: usize>(pieces: impl Iterator<Item = &'a Piece<N>>) -> Self {
        pieces.fold(Self::default(), |mut sum, piece| {
            sum.add(piece);
            sum
        })
    }

    fn add<const N: usize>(&mut self, piece: &Piece<N>) {
        self.time += piece.duration();
        self.energy += piece.at(0.0).jerk.norm_squared() * piece.duration();
    }

    /// Whether it is faster than another motion, or about as fast with less jerk.
    fn beats(&self, other: &Self, indifference: f64) -> bool {
        let room = indifference * self.time.max(other.time);
        if (self.time - other.time).abs() <= room.max(TIME_SLACK) {
            self.energy < other.energy
        } else {
            self.time < other.time
        }
    }
}

/// Which motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    Optimal,
    Smoothed,
}

/// How many events and pieces are left up to the end of a stretch, and whether it ends at rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Bound {
    events: usize,
    pieces: usize,
    rests: bool,
}

/// Where a joint lies among the pieces of the other motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// After so many pieces.
    After(usize),
    /// It is not known yet.
    NotYet,
    /// Motion is another one there.
    Nowhere,
}

/// Two motions, as far as they are known and not handed out.
#[derive(Clone, Debug)]
pub(crate) struct FasterOf<const N: usize> {
    mine: VecDeque<Event<N>>,
    theirs: VecDeque<Piece<N>>,
    /// Last move of each stretch that ends in a stop.
    ends: VecDeque<u32>,
    /// Who travels the stretch under way, once that is settled, and to where, once that is known.
    lane: Option<Source>,
    bound: Option<Bound>,
    /// Whether one of two motions is missing in this stretch, and in one that was led by it.
    lost: bool,
    broken: bool,
    /// Events of this stretch that have been looked at, and what they cost.
    walked: usize,
    walked_cost: Cost,
    /// By how much longer the other motion takes over what has been handed out of a stretch that is led,
    /// s.
    lead: f64,
    /// What a stop may cost, s.
    reserve: f64,
    /// Share of a duration below which a difference does not matter.
    indifference: f64,
    /// Whether a stretch that is led may take longer by that share, because it has less jerk.
    smoother: bool,
    finished: bool,
    stretches: u64,
    yielded: u64,
}

impl<const N: usize> FasterOf<N> {
    /// Two motions at rest; a stop costs less than `reserve` seconds. Of durations that differ by less than the
    /// share `indifference` the motion with less jerk is taken.
    pub(crate) fn new(reserve: f64, indifference: f64) -> Self {
        Self {
            mine: VecDeque::with_capacity(MAX_HELD + 1),
            theirs: VecDeque::with_capacity(MAX_HELD + 2),
            ends: VecDeque::with_capacity(MAX_HELD),
            lane: None,
            bound: None,
            lost: false,
            broken: false,
            walked: 0,
            walked_cost: Cost::default(),
            lead: 0.0,
            reserve,
            indifference,
            smoother: false,
            finished: false,
            stretches: 0,
            yielded: 0,
        }
    }

    /// Both motions rest at the end of this move.
    pub(crate) fn end_at(&mut self, index: u32) {
        self.ends.push_back(index);
    }

    /// Nothing comes after what has been announced.
    pub(crate) fn finish(&mut self) {
        self.finished = true;
    }

    /// Stretches, and how many of them were travelled by the other motion.
    pub(crate) fn tally(&self) -> (u64, u64) {
        (self.stretches, self.yielded)
    }

    /// Events and pieces held.
    pub(crate) fn held(&self) -> (usize, usize) {
        (self.mine.len(), self.theirs.len())
    }

    /// Whether the motion that leads a stretch came to a place behind which there is none.
    pub(crate) fn is_broken(&self) -> bool {
        self.broken
    }

    /// Whether the lead of a stretch that is led is nearly used up, so that it had better end.
    pub(crate) fn wants_stop(&self) -> bool {
        self.leads() && self.mine.len() == self.walked && self.lead < self.reserve
    }

    /// Whether the motion is handed out before the end of its stretch is known.
    pub(crate) fn leads(&self) -> bool {
        self.lane == Some(Source::Optimal) && self.bound.is_none()
    }

    /// Takes what both have ready, as far as there is room for it.
    pub(crate) fn gather(
        &mut self,
        mut mine: impl FnMut() -> Option<Event<N>>,
        mut theirs: impl FnMut() -> Option<Piece<N>>,
    ) {
        while self.mine.len() < MAX_HELD
            && let Some(event) = mine()
        {
            self.mine.push_back(event);
        }
        while self.theirs.len() < MAX_HELD
            && let Some(piece) = theirs()
        {
            self.theirs.push_back(piece);
        }
    }

    /// The next piece that is settled, of what has been gathered.
    pub(crate) fn next(&mut self) -> Option<Piece<N>> {
        loop {
            self.join_stretches();
            self.settle();
            if self.broken {
                return None;
            }
            match (self.lane?, self.bound) {
                (Source::Optimal, Some(bound)) => {
                    if bound.events == 0 {
                        self.begin(bound);
                        continue;
                    }
                    self.bound = Some(Bound {
                        events: bound.events - 1,
                        ..bound
                    });
                    if let Event::Piece(piece) = self.mine.pop_front()? {
                        return Some(piece);
                    }
                }
                (Source::Smoothed, Some(bound)) => {
                    if bound.pieces == 0 {
                        self.begin(bound);
                        continue;
                    }
                    self.bound = Some(Bound {
                        pieces: bound.pieces - 1,
                        ..bound
                    });
                    return self.theirs.pop_front();
                }
                (Source::Optimal, None) => {
                    self.walked = self.walked.checked_sub(1)?;
                    if let Event::Piece(piece) = self.mine.pop_front()? {
                        self.follow(&piece);
                        return Some(piece);
                    }
                }
                (Source::Smoothed, None) => {
                    self.mine.drain(..self.walked);
                    self.walked = 0;
                    let front = self.theirs.front()?;
                    let ends = self.ends.front();
                    if ends.is_some_and(|end| front.serves().last > *end) {
                        return None;
                    }
                    return self.theirs.pop_front();
                }
            }
        }
    }

    /// The next stretch begins.
    fn begin(&mut self, bound: Bound) {
        if bound.rests {
            self.ends.pop_front();
        }
        (self.lane, self.bound, self.lead) = (None, None, 0.0);
        self.lost = false;
        self.walked = 0;
        self.walked_cost = Cost::default();
    }

    /// Leaves behind what the other motion does on the moves before those of a piece.
    fn follow(&mut self, piece: &Piece<N>) {
        while let Some(other) = self.theirs.front()
            && other.serves().last < piece.serves().first
        {
            self.lead += other.duration() * (1.0 + self.tolerated());
            self.theirs.pop_front();
        }
        self.lead -= piece.duration();
    }

    /// Settles the stretch under way if that is possible by now.
    fn settle(&mut self) {
        if self.bound.is_some() {
            return;
        }
        if let Some(bound) = self.boundary() {
            let mine = self.walked_cost;
            let theirs = Cost::of(self.theirs.range(..bound.pieces));
            let moved = bound.pieces > 0;
            let lane = self.lane.unwrap_or_else(|| {
                self.stretches += u64::from(moved);
                if !self.lost && (mine.beats(&theirs, self.indifference) || !moved) {
                    return Source::Optimal;
                }
                // A line alone is the same for both.
                self.yielded += u64::from(theirs.time < mine.time - TIME_SLACK);
                Source::Smoothed
            });
            match lane {
                Source::Optimal => drop(self.theirs.drain(..bound.pieces)),
                Source::Smoothed => drop(self.mine.drain(..bound.events)),
            }
            (self.lane, self.bound) = (Some(lane), Some(bound));
        } else if self.lane.is_none()
            && (self.mine.len() >= MAX_HELD || self.theirs.len() >= MAX_HELD)
        {
            let [mine, theirs] = self.costs_so_far();
            self.smoother = mine.energy < theirs.energy;
            let allowed = theirs.time * (1.0 + self.tolerated());
            let ahead = !self.lost && allowed - mine.time > self.reserve;
            self.stretches += 1;
            self.yielded += u64::from(!ahead);
            self.lane = Some(if ahead {
                Source::Optimal
            } else {
                Source::Smoothed
            });
        }
    }

    /// The end of the stretch under way, where either motion may go on with the other; `None` while it
    /// is not known.
    fn boundary(&mut self) -> Option<Bound> {
        while let Some(event) = self.mine.get(self.walked) {
            let events = self.walked + 1;
            match *event {
                Event::Piece(piece) => self.walked_cost.add(&piece),
                Event::Lost => {
                    self.broken |= self.lane == Some(Source::Optimal);
                    self.lost = true;
                }
                Event::Joint(joint) => match self.place(&joint) {
                    Place::After(pieces) => {
                        return Some(Bound {
                            events,
                            pieces,
                            rests: false,
                        });
                    }
                    Place::NotYet => return None,
                    Place::Nowhere => {}
                },
                Event::Rest(index) => {
                    if self.ends.front().is_some_and(|end| index >= *end) {
                        let pieces = self.their_stretch()?;
                        return Some(Bound {
                            events,
                            pieces,
                            rests: true,
                        });
                    }
                }
            }
            self.walked = events;
        }
        None
    }

    /// Finds a joint in the other motion, whose piece there it cuts in two.
    fn place(&mut self, joint: &Joint<N>) -> Place {
        let first = self
            .theirs
            .partition_point(|piece| piece.serves().last < joint.index);
        for at in first..self.theirs.len() {
            let piece = self.theirs[at];
            if piece.serves().first > joint.index {
                return Place::Nowhere;
            }
            if let Some([before, after]) = joint.cut(&piece) {
                self.theirs[at] = before;
                self.theirs.insert(at + 1, after);
                return Place::After(at + 1);
            }
        }
        if self.finished && self.theirs.len() < MAX_HELD {
            Place::Nowhere
        } else {
            Place::NotYet
        }
    }

    /// Pieces of the other motion up to the next stop; `None` while they are not complete.
    fn their_stretch(&self) -> Option<usize> {
        let end = *self.ends.front()?;
        let beyond = self
            .theirs
            .back()
            .is_some_and(|piece| piece.serves().last > end);
        let complete = beyond || (self.finished && self.theirs.len() < MAX_HELD);
        complete.then(|| {
            self.theirs
                .partition_point(|piece| piece.serves().last <= end)
        })
    }

    /// What either motion costs up to the last move that both have finished.
    fn costs_so_far(&self) -> [Cost; 2] {
        let mine = || {
            self.mine.iter().filter_map(|event| match event {
                Event::Piece(piece) => Some(piece),
                _ => None,
            })
        };
        let (Some(my_last), Some(their_last)) = (mine().next_back(), self.theirs.back()) else {
            return [Cost::default(); 2];
        };
        let common = my_last.serves().first.min(their_last.serves().first);
        let done = |piece: &&Piece<N>| piece.serves().last < common;
        [
            Cost::of(mine().take_while(done)),
            Cost::of(self.theirs.iter().take_while(done)),
        ]
    }

    /// By which share a stretch that is led may take longer than the other motion.
    fn tolerated(&self) -> f64 {
        if self.smoother {
            self.indifference
        } else {
            0.0
        }
    }

    /// Stretches between which the other motion has one piece for moves of both, as for pauses that
    /// follow each other, are one stretch.
    fn join_stretches(&mut self) {
        if self.bound.is_some() {
            return;
        }
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
        }
    }
}
