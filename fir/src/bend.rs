//! How fast an arc may be followed behind a chain.
//!
//! Source: section 4.2.3 for the radius behind the filters; centripetal acceleration and the bound in
//! the middle of an arc are ours. Not here: the exact root, see the circle, nor where chords end.

use crate::chords::Chords;
use crate::circle::angular_velocity;
use crate::cubic::CubicChain;
use toolglide_kinematics::{Arc, Vector, largest_multiple};

/// By how much the bound may exceed the tolerance in the middle of an arc, where it is larger than the
/// distance itself; what is beyond the tolerance is what the planner keeps back on arcs.
const STEADY_EXCESS: f64 = 1.0015;

/// What limits the feedrate of an arc, whatever the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend<const N: usize> {
    /// Largest share of its direction that an axis has.
    reach: Vector<N>,
    /// Largest share of the radius that an axis has.
    turning: Vector<N>,
    radius: f64,
    /// Of the way, the part that turns.
    share: f64,
    tolerance: f64,
    /// Turn `|t2 - t1|` between its chords.
    turn: f64,
    /// Length of the longest chord.
    longest: f64,
    /// How far the vertices of the chords lie outside.
    outward: f64,
}

/// A feedrate, and what the bound comes to in the middle of the arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pace {
    pub(crate) feed: f64,
    pub(crate) steady: f64,
}

impl<const N: usize> Bend<N> {
    pub(crate) fn new(arc: &Arc<N>, chords: &Chords<N>, tolerance: f64) -> Self {
        let (start_radius, end_radius) = arc.radii();
        let radius = start_radius.max(end_radius);
        let (radial, lateral) = arc.frame();
        let mut reach = Vector::<N>::zeros();
        let mut from = arc.start();
        for vertex in chords.vertices() {
            let span = vertex - from;
            let length = span.norm();
            if length > 0.0 {
                reach = reach.sup(&(span / length).abs());
            }
            from = vertex;
        }
        Self {
            reach,
            turning: radial.zip_map(&lateral, f64::hypot),
            radius,
            share: radius * arc.sweep().abs() / arc.length(),
            tolerance,
            turn: 2.0 * (0.5 * chords.angle()).sin(),
            longest: chords.longest(),
            outward: chords.outward(),
        }
    }

    /// The feedrate that velocities of the axes leave.
    pub(crate) fn largest_feed(&self, velocity: &Vector<N>) -> f64 {
        largest_multiple(&self.reach, velocity)
    }

    /// How fast the arc may be followed, `change` being the largest change of velocity of each axis in
    /// the window of the chain.
    pub(crate) fn pace(&self, feedrate: f64, chain: &CubicChain, change: &Vector<N>) -> Pace {
        let (radius, tolerance) = (self.radius, self.tolerance);
        let slow = (2.0 * tolerance / (radius * chain.variance())).sqrt();
        let mut angular = slow * STEADY_EXCESS.sqrt();
        if tolerance < radius {
            let most = angular.min(std::f64::consts::TAU / chain.long());
            let share = tolerance / radius;
            angular = angular_velocity(|w| chain.gain(w), share, slow, most);
        }
        // The change of velocity within the longest filter is at most what an axis may have.
        let step = largest_multiple(&(self.turning * (self.turn * self.share)), change);
        let feed = (angular * radius / self.share)
            .min(turning_feed(step, self.longest, chain.long()))
            .min(feedrate);
        // Vertices lie outside, where what they miss is no deviation yet.
        let most = STEADY_EXCESS * tolerance + self.outward;
        let steady = self.bound(feed, chain).min(most);
        Pace { feed, steady }
    }

    /// What the bound comes to at the vertices in the middle of the arc.
    fn bound(&self, feed: f64, chain: &CubicChain) -> f64 {
        let half = 0.5 * chain.total();
        let step = self.longest / feed;
        let mut sum = 0.5 * chain.position(half);
        let mut distance = step;
        while distance < half {
            sum += chain.position(half - distance);
            distance += step;
        }
        2.0 * self.turn * feed * sum
    }
}

/// Feedrate at which equal turns, `spacing` apart, of which one alone may be passed at `step`, may be
/// passed one after the other: as many as may be in the longest filter, and one more.
pub(crate) fn turning_feed(step: f64, spacing: f64, long: f64) -> f64 {
    let share = spacing / long;
    // The root of feed (feed / share + 1) = step, without a difference of large numbers.
    2.0 * step / (1.0 + (1.0 + 4.0 * step / share).sqrt())
}
