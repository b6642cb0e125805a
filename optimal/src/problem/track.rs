//! States the constraints of one segment of a window.
//!
//! Source: as [`problem`](super). Not here: which point of the motion keeps it.

use super::{Problem, count};
use crate::problem::b_spline::State;
use crate::problem::constraints::{Disc, Tube};
use crate::window::{WindowDefect, WindowSegment};
use toolglide_kinematics::{Vector, vector::length_and_direction};

/// Distance beyond a side that is kept which counts as one of excess, mm.
const WALL: f64 = 0.005;

/// So many intervals at each end of a segment have a tube with round ends.
const ROUND_INTERVALS: usize = 2;

/// One segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Track<const N: usize> {
    pub(super) tube: Tube<N>,
    /// From the chord to the arc that is followed, at the middle, mm; zero elsewhere.
    pub(super) sagitta: Vector<N>,
    /// The side that is kept over either half of its length.
    pub(super) walls: [Option<(Vector<N>, f64)>; 2],
    /// Intervals over the first half.
    half: usize,
    pub(super) corner: Option<Disc<N>>,
    pub(super) feed: Disc<N>,
    /// The same in its first and in its last interval.
    passing: [Disc<N>; 2],
    /// Whether an axis alone may be slower than the feedrate.
    pub(super) slow_axis: bool,
    pub(super) first: usize,
    pub(super) steps: usize,
    pub(super) duration: f64,
    /// Weight of an interval in means over time, over that of a mean interval; 1 where all count alike.
    pub(super) time_weight: f64,
}

impl<const N: usize> Problem<N> {
    /// Makes a track of the next segment.
    pub(super) fn track(
        &self,
        index: usize,
        segment: &WindowSegment<N>,
        [before, next]: [Option<&WindowSegment<N>>; 2],
    ) -> Result<Track<N>, WindowDefect> {
        if segment.steps < WindowSegment::<N>::MIN_STEPS {
            return Err(WindowDefect::TooFewSteps { segment: index });
        }
        let (length, direction) = length_and_direction(&segment.start, &segment.end)
            .ok_or(WindowDefect::NoLength { segment: index })?;
        let corner = segment.corner_tolerance;
        if !(segment.tolerance > 0.0
            && segment.feedrate > 0.0
            && corner.is_none_or(|tolerance| tolerance > 0.0))
        {
            return Err(WindowDefect::NotPositive { segment: index });
        }
        let speed = |feedrate: f64| Disc {
            center: Vector::zeros(),
            by_radius: 1.0 / feedrate,
            room: 1.0,
        };
        Ok(Track {
            tube: Tube {
                start: segment.start - self.origin,
                direction,
                length,
                by_radius: 1.0
                    / segment
                        .follow
                        .map_or(segment.tolerance, |follow| follow.radius),
                room: 1.0,
                capsule: true,
                centring: 0.0,
                wall: None,
            },
            sagitta: segment
                .follow
                .map_or(Vector::zeros(), |follow| follow.sagitta),
            walls: segment
                .walls
                .map(|wall| wall.map(|wall| (wall.outward / WALL, wall.allowed / WALL))),
            half: segment.steps.div_ceil(2),
            corner: corner.filter(|_| next.is_some()).map(|tolerance| Disc {
                center: segment.end - self.origin,
                by_radius: 1.0 / tolerance,
                room: 1.0,
            }),
            feed: speed(segment.feedrate),
            passing: [before, next].map(|other| {
                let feedrate = other.map_or(segment.feedrate, |other| other.feedrate);
                speed(feedrate.min(segment.feedrate))
            }),
            slow_axis: self.by_velocity.max() * segment.feedrate > 1.0,
            first: self.segment_of.len(),
            steps: segment.steps,
            duration: 0.0,
            time_weight: 1.0,
        })
    }
}

impl<const N: usize> Track<N> {
    /// Largest speed in an interval. Where the feedrate changes the lower one holds on both sides, so that
    /// the velocity between them, which is a mean of both, keeps it too.
    #[inline(always)]
    pub(super) fn feed(&self, interval: usize) -> Disc<N> {
        if interval == 0 {
            self.passing[0]
        } else if interval + 1 == self.steps {
            self.passing[1]
        } else {
            self.feed
        }
    }

    #[inline(always)]
    pub(super) fn is_round(&self, interval: usize) -> bool {
        interval < ROUND_INTERVALS || interval + ROUND_INTERVALS >= self.steps
    }

    pub(super) fn whole(&self) -> f64 {
        self.duration * count(self.steps)
    }

    /// The side that is kept in an interval.
    #[inline(always)]
    pub(super) fn wall(&self, interval: usize) -> Option<(Vector<N>, f64)> {
        self.walls[usize::from(interval >= self.half)]
    }

    /// Finds how many intervals the first half of the length takes in a motion.
    pub(super) fn find_half(&mut self, states: &[State<N>]) {
        let along = |state: &State<N>| self.tube.direction.dot(&(state[0] - self.tube.start));
        let nodes = states.iter().skip(self.first);
        let ends = nodes.clone().skip(1);
        self.half = nodes
            .zip(ends)
            .take(self.steps)
            .take_while(|(from, to)| along(from) + along(to) < self.tube.length)
            .count();
    }

    /// How far the arc over a chord is from it where the Bezier point `ahead` (s) of a node's velocity lies, in
    /// sagittas: the curve touches the line to that point at the node, and bends away from it.
    pub(super) fn height(&self, state: &State<N>, ahead: f64) -> f64 {
        let along = |of: &Vector<N>| self.tube.direction.dot(of) / self.tube.length;
        let further = along(&state[1]) * ahead;
        let share = (along(&(state[0] - self.tube.start)) + further).clamp(0.0, 1.0);
        4.0 * share * (1.0 - share) + 4.0 * further * further
    }

    /// Share of the tolerance that a point uses.
    pub(super) fn used(&self, point: &Vector<N>) -> f64 {
        let offset = point - self.tube.start;
        let along = self
            .tube
            .direction
            .dot(&offset)
            .clamp(0.0, self.tube.length);
        (offset - self.tube.direction * along).norm() * self.tube.by_radius
    }
}
