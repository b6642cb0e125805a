//! Scales every corner blend of the look-ahead window so that a stop at its end stays possible.
//!
//! Source: section 3.3.1, with a proof where the text has an unproven backward pass. Every corner has
//! a motion and a scale between 0 (a full stop) and 1. If two scales fit a move, both times any factor
//! below 1 fit too, because the scaled connection needs the cube of the factor in length. So the
//! scales from which a stop at the end of the window can still be reached form an interval that
//! begins at 0, the backward pass finds a bound within it together with a witness for the next
//! corner, and the forward pass never leaves it: a safe stop always exists. Not here: which kind of
//! motion a corner gets.

use crate::lookahead::scale::{balance, feed_cap, furthest, reachable};
use std::collections::VecDeque;
use toolglide_kinematics::PathLimits;
use toolglide_kinematics::numeric::SEARCH_PRECISION;
use toolglide_profiles::BlendShape;

/// A backward pass waits until of the nodes that it looks at at most so many times as many are old as are new.
const PASSES: usize = 2;

/// Fewest new nodes that a pass waits for: a corner that is fixed before the next one is known leaves it too little of the
/// move between them.
const MIN_FRESH: usize = 2;

/// A straight move as the window sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// Length, mm.
    pub length: f64,
    /// Limits along the move; the velocity is the feedrate where that is lower.
    pub limits: PathLimits,
}

/// A corner in the window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) shape: BlendShape,
    /// No scale above this is tried.
    pub(crate) cap: f64,
    /// Largest scale from which the end of the window is known to be reachable.
    pub(crate) upper: f64,
    /// A scale of the next corner that fits when this one has `upper`.
    pub(crate) witness: f64,
    /// Whether it is a place on a long move that is passed at its velocity whatever is around it.
    cruises: bool,
}

impl Node {
    fn new(shape: BlendShape, upper: f64) -> Self {
        Self {
            shape,
            cap: 1.0,
            upper,
            witness: 0.0,
            cruises: false,
        }
    }

    /// Whether nothing that comes later lets it have a larger scale, but for precision.
    fn is_final(&self) -> bool {
        self.upper >= self.cap * (1.0 - SEARCH_PRECISION)
    }
}

/// Scales the motions of consecutive corners, one kind of motion per corner, as moves stream in.
#[derive(Clone, Debug)]
pub struct Window {
    /// The first node is committed: its shape is scaled already.
    nodes: VecDeque<Node>,
    /// Link `i` leads from node `i` to node `i + 1`, the last one to what has not been read.
    links: VecDeque<Link>,
    size: usize,
    /// Nodes that are read between two backward passes, and committed at once when the window is full.
    batch: usize,
    /// Nodes that are to be committed now.
    due: usize,
    /// Nodes up to here have an `upper`.
    passed: usize,
    /// Nodes up to here have the `upper` that they will keep.
    settled: usize,
    finished: bool,
    balanced: bool,
}

impl Window {
    /// A window over `size` corners (at least 1) that begins at rest.
    ///
    /// A balanced window starts from scales at which both ends of every move run out at the same
    /// speed; without it, one large corner may leave no room to the next.
    #[must_use]
    pub fn new(size: usize, balanced: bool) -> Self {
        let size = size.max(1);
        let mut window = Self {
            nodes: VecDeque::with_capacity(size + 3),
            links: VecDeque::with_capacity(size + 3),
            size,
            batch: (size / 4).max(1),
            due: 0,
            passed: 0,
            settled: 0,
            finished: false,
            balanced,
        };
        window.restart();
        window
    }

    /// Begins again at rest.
    pub(crate) fn restart(&mut self) {
        self.restart_after(BlendShape::STOP);
    }

    /// Begins again with the exit of a motion; whether a stop can be reached from it is not known.
    pub(crate) fn restart_after(&mut self, shape: BlendShape) {
        self.nodes.clear();
        self.nodes.push_back(Node::new(shape, 1.0));
        self.links.clear();
        self.due = 0;
        self.passed = 0;
        self.settled = 0;
        self.finished = false;
    }

    /// Becomes a copy of another.
    pub(crate) fn follow(&mut self, other: &Self) {
        self.nodes.clone_from(&other.nodes);
        self.links.clone_from(&other.links);
        self.size = other.size;
        self.batch = other.batch;
        self.due = other.due;
        self.passed = other.passed;
        self.settled = other.settled;
        self.finished = other.finished;
        self.balanced = other.balanced;
    }

    /// Takes the first move, or the first after a place that is passed at speed.
    pub fn begin(&mut self, link: Link) {
        self.links.push_back(link);
    }

    /// Takes the corner at the end of the last move, and the move after it.
    pub fn push(&mut self, shape: BlendShape, link: Link) {
        let mut node = Node::new(shape, 0.0);
        if let (Some(before), Some(last)) = (self.links.back(), self.nodes.back_mut()) {
            node.cap = feed_cap(&shape.entry, before).min(feed_cap(&shape.exit, &link));
            if self.balanced
                && let Some((left, right)) = balance(&last.shape.exit, &shape.entry, before)
            {
                last.cap = last.cap.min(left);
                node.cap = node.cap.min(right);
            }
        }
        self.nodes.push_back(node);
        self.links.push_back(link);
    }

    /// Says that the last move is so long that its end is passed at a speed, whatever is before it and whatever
    /// follows, with room for a stop.
    pub(crate) fn divide(&mut self, speed: f64) {
        self.nodes.push_back(Node {
            cruises: true,
            ..Node::new(BlendShape::through(speed), 1.0)
        });
    }

    /// Says that the last move ends at rest.
    pub fn finish(&mut self) {
        self.finished = true;
    }

    /// The motion of the next corner, scaled; `None` until enough of the path is known.
    pub fn pull(&mut self) -> Option<BlendShape> {
        let known = self.known();
        if known == 0 {
            return None;
        }
        if known > self.size {
            self.due = self.due.max(self.batch);
        }
        let fresh = known - self.passed;
        // A pass costs as much as it looks at, so it waits until a share of that is new.
        let patience = (self.passed / PASSES).clamp(MIN_FRESH, self.batch.max(MIN_FRESH));
        let divided = self.ends_cruising();
        if fresh > 0 && (self.finished || divided || self.due > 0 || fresh >= patience) {
            self.backward();
        }
        if self.passed > 0 && (self.settled > 0 || self.finished || self.due > 0) {
            self.due = self.due.saturating_sub(1);
            Some(self.commit())
        } else {
            None
        }
    }

    /// Whether the last node is passed at speed whatever follows.
    fn ends_cruising(&self) -> bool {
        self.nodes.back().is_some_and(|last| last.cruises)
    }

    /// How many nodes after the first have both neighbours known.
    fn known(&self) -> usize {
        let inner = self.nodes.len() - 1;
        if self.finished || self.ends_cruising() {
            inner
        } else {
            inner.saturating_sub(1)
        }
    }

    /// Bounds the scales from the end of what is known to its beginning.
    fn backward(&mut self) {
        let known = self.known();
        let mut next = Node {
            cap: 0.0,
            ..Node::new(BlendShape::STOP, 0.0)
        };
        for index in (1..=known).rev() {
            let node = self.nodes[index];
            if !node.cruises {
                let (upper, witness) = reachable(&node, &next, &self.links[index]);
                if upper > node.upper * (1.0 + SEARCH_PRECISION) {
                    self.nodes[index].upper = upper;
                    self.nodes[index].witness = witness;
                } else if index <= self.passed {
                    break;
                }
            }
            next = self.nodes[index];
            // What is before a node whose bound will not change has found its own.
            if next.is_final() {
                self.settled = self.settled.max(index);
            }
        }
        self.passed = known;
    }

    /// Fixes the scale of node 1 and makes it the first.
    fn commit(&mut self) -> BlendShape {
        let from = self.nodes[0];
        let next = self.nodes[1];
        let scale = furthest(&from, &next, &self.links[0]);
        let shape = next.shape.scaled(scale);
        self.nodes.pop_front();
        self.links.pop_front();
        self.passed -= 1;
        self.settled = self.settled.saturating_sub(1);
        let share = if next.upper > 0.0 {
            scale / next.upper
        } else {
            0.0
        };
        self.nodes[0] = Node {
            witness: next.witness * share,
            ..Node::new(shape, 1.0)
        };
        shape
    }
}
