//! Computes the largest feedrate of an arc behind a chain.
//!
//! Source: section 4.2.3 for the radius behind the filters; centripetal acceleration and the bound in
//! the middle of an arc are ours. Not here: the exact root, see the circle, nor where chords end.

use crate::chords::Chords;
use crate::filter::cubic::CubicChain;
use crate::lookahead::circle_feed::angular_velocity;
#[cfg(not(feature = "std"))]
use toolglide_kinematics::no_std::*;
use toolglide_kinematics::{Arc, Vector, largest_multiple};

/// By how much the bound may exceed the tolerance in the middle of an arc, where it is larger than the
/// distance itself; what is beyond the tolerance is what the planner keeps back on arcs.
pub(crate) const STEADY_EXCESS: f64 = 1.0015;

/// By how much chords that just fill the longest filter are taken slower, relative: far above the
/// rounding of their lengths and times.
const EXACTLY: f64 = 1e-6;

/// What limits the feedrate of an arc, whatever the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ArcFeed<const N: usize> {
    /// Largest share of the radius that an axis has.
    turning: Vector<N>,
    radius: f64,
    /// Of the way, the part that turns.
    share: f64,
    tolerance: f64,
    /// Turn `|t2 - t1|` between its chords.
    turn: f64,
    /// Length of the shortest chord.
    shortest: f64,
}

impl<const N: usize> ArcFeed<N> {
    pub(crate) fn new(arc: &Arc<N>, chords: &Chords<N>, tolerance: f64) -> Self {
        let (start_radius, end_radius) = arc.radii();
        let radius = start_radius.max(end_radius);
        let (radial, lateral) = arc.frame();
        Self {
            turning: radial.zip_map(&lateral, f64::hypot),
            radius,
            share: radius * arc.sweep().abs() / arc.length(),
            tolerance,
            turn: chords.turn(),
            shortest: chords.shortest(),
        }
    }

    /// Largest turn `|t2 - t1|` between two chords but the first and the last.
    pub(crate) fn turn(&self) -> f64 {
        self.turn
    }

    /// How fast the arc may be followed, `change` being the largest change of velocity of each axis in
    /// the window of the chain.
    pub(crate) fn pace(&self, feedrate: f64, chain: &CubicChain, change: &Vector<N>) -> f64 {
        let (radius, tolerance) = (self.radius, self.tolerance);
        // The change of velocity within the longest filter is at most what an axis may have.
        let step = largest_multiple(&(self.turning * self.turn), change);
        let feed = feedrate.min(chord_feed(step, self.shortest, chain.long()));
        let around = radius / self.share;
        let slow = (2.0 * tolerance / (radius * chain.variance())).sqrt();
        if feed <= slow * around {
            return feed;
        }
        let mut angular = slow * STEADY_EXCESS.sqrt();
        if tolerance < radius {
            let most = angular.min(core::f64::consts::TAU / chain.long());
            let share = tolerance / radius;
            angular = angular_velocity(|w| chain.gain(w), share, slow, most);
        }
        feed.min(angular * around)
    }
}

/// Feedrate at which equal turns, exactly `spacing` apart, of which one alone may be passed at `step`,
/// may be passed one after the other: as many as are in the longest filter at most.
fn chord_feed(step: f64, spacing: f64, long: f64) -> f64 {
    // So many times the spacing is the way within the filter if turns are small.
    let square = step * long / spacing;
    // As long as the way is no longer than a number of chords, no more turns are in the filter; the way
    // is that number, or what one more turn leaves.
    let turns = square.sqrt().floor();
    let way = (turns * (1.0 - EXACTLY)).max(square / (turns + 1.0));
    way * spacing / long
}

/// Feedrate at which equal turns, `spacing` apart, of which one alone may be passed at `step`, may be
/// passed one after the other: as many as may be in the longest filter, and one more.
pub(crate) fn turning_feed(step: f64, spacing: f64, long: f64) -> f64 {
    let share = spacing / long;
    // The root of feed (feed / share + 1) = step, without a difference of large numbers.
    2.0 * step / (1.0 + (1.0 + 4.0 * step / share).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many turns are in the filter together at a feedrate: chords with less of the way between them
    /// than the filter sees.
    fn turns_within(feed: f64, spacing: f64, long: f64) -> f64 {
        (feed * long / spacing).ceil()
    }

    #[test]
    fn equal_chords_are_as_fast_as_the_turns_that_are_together_allow_and_no_faster() {
        let (spacing, long) = (0.25, 0.125);
        for step in [
            0.01, 0.3, 1.0, 1.99, 2.0, 2.01, 3.0, 7.7, 12.0, 50.0, 1234.5,
        ] {
            let feed = chord_feed(step, spacing, long);
            let turns = turns_within(feed, spacing, long);
            assert!(feed * turns <= step * (1.0 + 1e-12), "{step}: {feed}");
            let more = turns_within(feed * (1.0 + 1e-5), spacing, long);
            assert!(feed * (1.0 + 1e-5) * more > step, "{step}: {feed}");
            let careful = turning_feed(step, spacing, long);
            assert!(feed >= careful, "{step}: {feed} below {careful}");
        }
    }
}
