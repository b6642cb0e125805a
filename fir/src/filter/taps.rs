//! Computes the jerk behind a chain from commanded velocities at a few delays.
//!
//! Source: equations 4.1 to 4.7; the third derivative of two moving averages is four impulses, and a comb
//! repeats them. Not here: what the jerk is integrated to.

use crate::filter::cubic::CubicChain;
use crate::lookahead::queue::Queue;
use toolglide_kinematics::Vector;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;

/// Instants nearer than this are one, s: far below any period and above the rounding of times of some
/// minutes.
pub(crate) const SAME_INSTANT: f64 = 1e-12;

/// Taps of a chain without a comb.
const FEW: usize = 4;

/// A change of the commanded velocity.
#[derive(Clone, Copy, Debug)]
struct Step<const N: usize> {
    time: f64,
    velocity: Vector<N>,
}

/// A delay at which the commanded velocity enters the jerk.
#[derive(Clone, Copy, Debug)]
struct Tap<const N: usize> {
    delay: f64,
    weight: f64,
    /// What the last step to arrive contributes to the jerk.
    held: Vector<N>,
    /// Index of the next step to arrive.
    next: usize,
    /// When it arrives; never while it is not known.
    due: f64,
}

/// All delays of a chain, and the steps that have not passed all of them.
#[derive(Clone, Debug)]
pub(crate) struct Taps<const N: usize> {
    /// The last one has the longest delay.
    taps: Vec<Tap<N>>,
    steps: Queue<Step<N>>,
    /// When the next step arrives at any tap; never while none is known.
    due: f64,
    jerk: Vector<N>,
}

impl<const N: usize> Taps<N> {
    /// Room for a chain and for some steps.
    pub(crate) fn new(chain: &CubicChain, capacity: usize) -> Self {
        Self {
            taps: Vec::with_capacity(FEW * chain.comb().len()),
            steps: Queue::with_capacity(capacity),
            due: f64::INFINITY,
            jerk: Vector::zeros(),
        }
    }

    /// Begins afresh at rest.
    pub(crate) fn restart(&mut self, chain: &CubicChain) {
        self.steps.clear();
        let (long, short) = (chain.long(), chain.short());
        let product = long * short;
        self.taps.clear();
        self.due = f64::INFINITY;
        self.jerk = Vector::zeros();
        for tooth in chain.comb() {
            for (delay, sign) in [(0.0, 1.0), (short, -1.0), (long, -1.0), (long + short, 1.0)] {
                self.taps.push(Tap {
                    delay: tooth.delay + delay,
                    weight: sign * tooth.weight / product,
                    held: Vector::zeros(),
                    next: 0,
                    due: f64::INFINITY,
                });
            }
        }
    }

    /// Whether there is no comb.
    pub(crate) fn are_few(&self) -> bool {
        self.taps.len() <= FEW
    }

    /// The commanded velocity changes.
    pub(crate) fn push(&mut self, time: f64, velocity: Vector<N>) {
        let index = self.steps.len();
        self.steps.push(Step { time, velocity });
        for tap in &mut self.taps {
            if tap.next == index {
                tap.due = time + tap.delay;
                self.due = self.due.min(tap.due);
            }
        }
    }

    /// When the jerk changes next, as far as is known.
    pub(crate) fn next_knot(&self) -> f64 {
        self.due
    }

    /// Lets the steps that are due arrive at their taps; gives the jerk, and the acceleration that comes
    /// too early.
    pub(crate) fn arrive(&mut self, knot: f64) -> (Vector<N>, Vector<N>) {
        let mut ahead = Vector::zeros();
        // Few taps are summed, of many only what changes.
        let few = self.are_few();
        let steps = self.steps.items();
        let mut jerk = if few { Vector::zeros() } else { self.jerk };
        let mut soonest = f64::INFINITY;
        for tap in &mut self.taps {
            while tap.due <= knot + SAME_INSTANT {
                // Instants that are one are not quite the same: what the jerk does too early.
                let early = tap.due - knot;
                let held = steps[tap.next].velocity * tap.weight;
                let change = held - tap.held;
                ahead += change * early;
                if !few {
                    jerk += change;
                }
                tap.held = held;
                tap.next += 1;
                let next = steps.get(tap.next);
                tap.due = next.map_or(f64::INFINITY, |step| step.time + tap.delay);
            }
            if few {
                jerk += tap.held;
            }
            soonest = soonest.min(tap.due);
        }
        self.due = soonest;
        self.jerk = jerk;
        // What has passed the longest delay has passed all.
        let oldest = self.taps.last().map_or(0, |tap| tap.next);
        if oldest > 0 {
            self.steps.drop_oldest(oldest);
            for tap in &mut self.taps {
                tap.next -= oldest;
            }
        }
        (self.jerk, ahead)
    }

    /// The jerk from what every tap holds, exactly none where they hold the same.
    pub(crate) fn sum(&mut self) -> Vector<N> {
        self.jerk = self.taps.iter().map(|tap| tap.held).sum();
        self.jerk
    }

    /// Sets the clock back.
    pub(crate) fn set_back(&mut self, span: f64) {
        for step in self.steps.items_mut() {
            step.time -= span;
        }
        self.due = f64::INFINITY;
        for tap in &mut self.taps {
            // Found afresh, as exactly as the clock is now.
            let next = self.steps.items().get(tap.next);
            tap.due = next.map_or(f64::INFINITY, |step| step.time + tap.delay);
            self.due = self.due.min(tap.due);
        }
    }
}
