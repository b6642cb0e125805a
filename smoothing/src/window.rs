//! The look-ahead window: how much of each corner motion the moves between them leave room for.
//!
//! Source: section 3.3.1, with a proof where the text has an unproven backward pass. Every corner has
//! a motion and a scale between 0 (a full stop) and 1. If two scales fit a move, both times any factor
//! below 1 fit too, because the scaled connection needs the cube of the factor in length. So the
//! scales from which a stop at the end of the window can still be reached form an interval that
//! begins at 0, the backward pass finds a bound within it together with a witness for the next
//! corner, and the forward pass never leaves it: a safe stop always exists. Not here: which kind of
//! motion a corner gets.

use crate::turn::TurnShape;
use std::collections::VecDeque;
use toolglide_kinematics::Tangential;
use toolglide_kinematics::numeric::{CLOSURE, SEARCH_PRECISION};
use toolglide_profiles::{Boundary, Connection, Rise};

/// A straight move as the window sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Link {
    pub(crate) length: f64,
    /// Limits along the move; the velocity is the feedrate where that is lower.
    pub(crate) limits: Tangential,
}

/// A corner in the window.
#[derive(Clone, Copy, Debug)]
struct Node {
    shape: TurnShape,
    /// No scale above this is tried.
    cap: f64,
    /// Largest scale from which the end of the window is known to be reachable.
    upper: f64,
    /// A scale of the next corner that fits when this one has `upper`.
    witness: f64,
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

/// Speed that is reached when the acceleration at the boundary of a turn runs out on `link`.
#[inline]
fn peak(boundary: &Boundary, link: &Link) -> f64 {
    Rise::least_peak(boundary.speed, boundary.acceleration, link.limits.jerk)
}

/// Largest scale whose peak stays below the feedrate.
fn feed_cap(boundary: &Boundary, link: &Link) -> f64 {
    let peak = peak(boundary, link);
    if peak > link.limits.velocity {
        (link.limits.velocity / peak).sqrt()
    } else {
        1.0
    }
}

/// Length that a turn and the running out of its acceleration need on one side.
fn footprint(boundary: &Boundary, jerk: f64) -> f64 {
    let Boundary {
        distance,
        speed,
        acceleration,
    } = *boundary;
    let time = acceleration / jerk;
    time * (speed + time * acceleration / 3.0) + distance
}

/// Scales of two turns with equal peaks that together just fill the move between them; `None` where
/// one is a stop.
fn balance(left: &Boundary, right: &Boundary, link: &Link) -> Option<(f64, f64)> {
    let (left_peak, right_peak) = (peak(left, link), peak(right, link));
    if left_peak <= 0.0 || right_peak <= 0.0 {
        return None;
    }
    let common = left_peak.min(right_peak);
    let (left_scale, right_scale) = ((common / left_peak).sqrt(), (common / right_peak).sqrt());
    let needed = left_scale.powi(3) * footprint(left, link.limits.jerk)
        + right_scale.powi(3) * footprint(right, link.limits.jerk);
    let factor = if needed > 0.0 {
        (link.length / needed).cbrt()
    } else {
        f64::INFINITY
    };
    Some((factor * left_scale, factor * right_scale))
}

/// Length left over on `link` by two scaled turns and the shortest connection between them.
#[inline]
fn room(
    left: &TurnShape,
    left_scale: f64,
    right: &TurnShape,
    right_scale: f64,
    link: &Link,
) -> f64 {
    let left = left.scaled(left_scale).exit;
    let right = right.scaled(right_scale).entry;
    let connection = Connection {
        from: [left.speed, left.acceleration],
        to: [right.speed, right.acceleration],
        limits: link.limits,
    };
    link.length * (1.0 - CLOSURE) - (connection.least_distance() + left.distance + right.distance)
}

/// Largest scale of `node` known to fit `link` together with some reachable scale of `next`, and that
/// scale.
fn reachable(node: &Node, next: &Node, link: &Link) -> (f64, f64) {
    if node.cap <= 0.0 {
        return (0.0, 0.0);
    }
    let ratio = {
        let (own, other) = (peak(&node.shape.exit, link), peak(&next.shape.entry, link));
        if other > 0.0 {
            (own / other).sqrt()
        } else {
            f64::INFINITY
        }
    };
    // With the next corner at the same peak, or at its own bound where that is lower.
    let partner = |scale: f64| {
        if next.upper > 0.0 {
            next.upper.min(scale * ratio)
        } else {
            0.0
        }
    };
    let fits = |scale: f64| room(&node.shape, scale, &next.shape, partner(scale), link);
    if fits(node.cap) >= 0.0 {
        return (node.cap, partner(node.cap));
    }
    let mut best = (0.0, 0.0);
    if next.upper > 0.0 {
        // Below the kink both scales are proportional, and lengths go with the cube.
        let kink = (next.upper / ratio).min(node.cap);
        let proportional = if fits(kink) >= 0.0 {
            largest(fits, kink, node.cap)
        } else {
            let needed = link.length - room(&node.shape, kink, &next.shape, partner(kink), link);
            kink * (link.length * (1.0 - SEARCH_PRECISION) / needed).cbrt()
        };
        best = (proportional, partner(proportional));
    }
    // With a stop at the next corner.
    let stops = |scale: f64| room(&node.shape, scale, &next.shape, 0.0, link);
    if stops(best.0) > 0.0 {
        let scale = largest(stops, best.0, node.cap);
        if scale > best.0 {
            best = (scale, 0.0);
        }
    }
    if room(&node.shape, best.0, &next.shape, best.1, link) >= 0.0 {
        best
    } else {
        (0.0, 0.0)
    }
}

/// Largest scale found for `next` that fits after `from`, whose scale is 1.
fn furthest(from: &Node, next: &Node, link: &Link) -> f64 {
    let fits = |scale: f64| room(&from.shape, 1.0, &next.shape, scale, link);
    if next.upper <= 0.0 || fits(next.upper) >= 0.0 {
        return next.upper;
    }
    let witness = (from.witness).min(next.upper);
    let other = peak(&next.shape.entry, link);
    let equal = if other > 0.0 {
        (peak(&from.shape.exit, link) / other)
            .sqrt()
            .min(next.upper)
    } else {
        0.0
    };
    let mut lower = witness;
    for share in [1.0, 0.9, 0.75, 0.5] {
        let scale = share * equal;
        if scale <= witness {
            break;
        }
        if fits(scale) >= 0.0 {
            lower = scale;
            break;
        }
    }
    largest(fits, lower, next.upper)
}

/// A zero of a function from its positive side, between `low`, where it is not negative, and `high`,
/// where it is negative: secant steps that keep the bracket.
fn largest(function: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let (mut at_low, mut at_high) = (function(low), function(high));
    if at_high >= 0.0 {
        return high;
    }
    let mut last_side = 0_i8;
    for _ in 0..40 {
        if high - low <= SEARCH_PRECISION * high {
            break;
        }
        let span = high - low;
        let guess = (low + span * at_low / (at_low - at_high))
            .clamp(low + 0.02 * SEARCH_PRECISION * span, high);
        // Aim a little inside, so that the bracket closes from the feasible side too.
        let guess = guess - 0.5 * SEARCH_PRECISION * guess.min(span);
        let value = function(guess);
        if value >= 0.0 {
            if last_side > 0 {
                at_high *= 0.5;
            }
            last_side = 1;
            low = guess;
            at_low = value;
        } else {
            if last_side < 0 {
                at_low *= 0.5;
            }
            last_side = -1;
            high = guess;
            at_high = value;
        }
    }
    low
}
