//! The look-ahead window: how much of each corner motion the moves between them leave room for.
//!
//! Source: section 3.3.1, with a proof where the text has an unproven backward pass. Every corner has
//! a motion and a scale between 0 (a full stop) and 1. If two scales fit a move, both times any factor
//! below 1 fit too, because the scaled connection needs the cube of the factor in length. So the
//! scales from which a stop at the end of the window can still be reached form an interval that
//! begins at 0, the backward pass finds a bound within it together with a witness for the next
//! corner, and the forward pass never leaves it: a safe stop always exists. Not here: which kind of
//! motion a corner gets.

use crate::scale::{balance, feed_cap, furthest, reachable};
use crate::turn::TurnShape;
use std::collections::VecDeque;
use toolglide_kinematics::Tangential;
use toolglide_kinematics::numeric::{CLOSURE, SEARCH_PRECISION};

/// A straight move as the window sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Link {
    pub(crate) length: f64,
    /// Limits along the move; the velocity is the feedrate where that is lower.
    pub(crate) limits: Tangential,
}

/// A corner in the window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) shape: TurnShape,
    /// No scale above this is tried.
    pub(crate) cap: f64,
    /// Largest scale from which the end of the window is known to be reachable.
    pub(crate) upper: f64,
    /// A scale of the next corner that fits when this one has `upper`.
    pub(crate) witness: f64,
}

/// Scales the motions of consecutive corners, one kind of motion per corner, as moves stream in.
#[derive(Clone, Debug)]
pub(crate) struct Window {
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
    finished: bool,
    balanced: bool,
}

impl Window {
    /// A window over `size` corners (at least 1) that begins at rest.
    ///
    /// A balanced window starts from scales at which both ends of every move run out at the same
    /// speed; without it, one large corner may leave no room to the next.
    pub(crate) fn new(size: usize, balanced: bool) -> Self {
        let size = size.max(1);
        let mut window = Self {
            nodes: VecDeque::with_capacity(size + 3),
            links: VecDeque::with_capacity(size + 3),
            size,
            batch: (size / 4).max(1),
            due: 0,
            passed: 0,
            finished: false,
            balanced,
        };
        window.restart();
        window
    }

    /// Begins again at rest.
    pub(crate) fn restart(&mut self) {
        self.restart_after(TurnShape::STOP);
    }

    /// Begins again with the exit of a motion; whether a stop can be reached from it is not known.
    pub(crate) fn restart_after(&mut self, shape: TurnShape) {
        self.nodes.clear();
        self.nodes.push_back(Node {
            shape,
            cap: 1.0,
            upper: 1.0,
            witness: 0.0,
        });
        self.links.clear();
        self.due = 0;
        self.passed = 0;
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
        self.finished = other.finished;
        self.balanced = other.balanced;
    }

    /// Takes the first move.
    pub(crate) fn begin(&mut self, link: Link) {
        self.links.push_back(link);
    }

    /// Takes the corner at the end of the last move, and the move after it.
    pub(crate) fn push(&mut self, shape: TurnShape, link: Link) {
        let mut node = Node {
            shape,
            cap: 1.0,
            upper: 0.0,
            witness: 0.0,
        };
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

    /// Says that the last move ends at rest.
    pub(crate) fn finish(&mut self) {
        self.finished = true;
    }

    /// The motion of the next corner, scaled; `None` until enough of the path is known.
    pub(crate) fn pull(&mut self) -> Option<TurnShape> {
        let known = self.known();
        if known == 0 {
            return None;
        }
        if known > self.size {
            self.due = self.due.max(self.batch);
        }
        let fresh = known - self.passed;
        if fresh > 0 && (self.finished || self.due > 0 || fresh >= self.batch) {
            self.backward();
        }
        let next = self.nodes.get(1).filter(|_| self.passed > 0)?;
        let settled = next.upper >= next.cap * (1.0 - CLOSURE);
        if settled || self.finished || self.due > 0 {
            self.due = self.due.saturating_sub(1);
            Some(self.commit())
        } else {
            None
        }
    }

    /// How many nodes after the first have both neighbours known.
    fn known(&self) -> usize {
        let inner = self.nodes.len() - 1;
        if self.finished {
            inner
        } else {
            inner.saturating_sub(1)
        }
    }

    /// Bounds the scales from the end of what is known to its beginning.
    fn backward(&mut self) {
        let known = self.known();
        let mut next = Node {
            shape: TurnShape::STOP,
            cap: 0.0,
            upper: 0.0,
            witness: 0.0,
        };
        for index in (1..=known).rev() {
            let node = self.nodes[index];
            let (upper, witness) = reachable(&node, &next, &self.links[index]);
            if upper > node.upper * (1.0 + SEARCH_PRECISION) {
                self.nodes[index].upper = upper;
                self.nodes[index].witness = witness;
            } else if index <= self.passed {
                break;
            }
            next = self.nodes[index];
        }
        self.passed = known;
    }

    /// Fixes the scale of node 1 and makes it the first.
    fn commit(&mut self) -> TurnShape {
        let from = self.nodes[0];
        let next = self.nodes[1];
        let scale = furthest(&from, &next, &self.links[0]);
        let shape = next.shape.scaled(scale);
        self.nodes.pop_front();
        self.links.pop_front();
        self.passed -= 1;
        let share = if next.upper > 0.0 {
            scale / next.upper
        } else {
            0.0
        };
        self.nodes[0] = Node {
            shape,
            cap: 1.0,
            upper: 1.0,
            witness: next.witness * share,
        };
        shape
    }
}
