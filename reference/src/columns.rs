//! Assigns each unknown of the program its column and its scale.
//!
//! Source: time is scaled so that the dynamics do not contain its stretch `g`: velocity `V v / g`,
//! acceleration `A a / g²`, jerk `J j / g³`, and `gamma = g³` is the unknown that is minimized. All
//! unknowns but positions are then near 1. Positions are counted from the middle of the course, in
//! mm. Not here: rows.

use crate::course::Course;
use crate::grid::Grid;
use crate::rows::Rows;
use toolglide_kinematics::Vector;

/// What the unknowns are scaled by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scales<const N: usize> {
    /// The middle of the course.
    pub(crate) origin: Vector<N>,
    /// No position is farther from the middle, mm.
    pub(crate) extent: f64,
    /// Largest velocity that an axis can be asked for, mm/s.
    pub(crate) velocity: Vector<N>,
    pub(crate) acceleration: Vector<N>,
    pub(crate) jerk: Vector<N>,
}

impl<const N: usize> Scales<N> {
    /// The scales of a course, of which nothing lies farther than `beyond` mm away.
    pub(crate) fn of(course: &Course<N>, beyond: f64) -> Self {
        let (mut low, mut high) = (course.start(), course.start());
        let mut feed = 0.0_f64;
        for leg in &course.legs {
            low = low.inf(&leg.end);
            high = high.sup(&leg.end);
            feed = feed.max(leg.feed);
        }
        Self {
            origin: (low + high) * 0.5,
            extent: 0.5 * (high - low).norm() + beyond,
            velocity: course.limits.velocity().map(|limit| limit.min(feed)),
            acceleration: *course.limits.acceleration(),
            jerk: *course.limits.jerk(),
        }
    }
}

/// First column of each kind of unknown.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns<const N: usize> {
    /// `gamma`: the cube of the stretch of time.
    pub(crate) stretch: usize,
    /// At most the first power of the stretch: bounds velocities.
    pub(crate) speed: usize,
    /// At most the second power: bounds accelerations.
    pub(crate) rate: usize,
    nodes: usize,
    jerks: usize,
    moments: Option<usize>,
    changes: Option<usize>,
    intervals: usize,
}

impl<const N: usize> Columns<N> {
    /// Takes the columns for a grid.
    pub(crate) fn take(rows: &mut Rows, grid: &Grid, moments: bool, changes: bool) -> Self {
        let intervals = grid.intervals();
        let stretch = rows.columns(3);
        Self {
            stretch,
            speed: stretch + 1,
            rate: stretch + 2,
            nodes: rows.columns((intervals + 1) * 3 * N),
            jerks: rows.columns(intervals * N),
            moments: moments.then(|| rows.columns(intervals * 2 * N)),
            changes: changes.then(|| rows.columns(grid.firsts.len() - 1)),
            intervals,
        }
    }

    pub(crate) fn position(&self, node: usize, axis: usize) -> usize {
        self.nodes + node * 3 * N + axis
    }

    pub(crate) fn velocity(&self, node: usize, axis: usize) -> usize {
        self.nodes + node * 3 * N + N + axis
    }

    pub(crate) fn acceleration(&self, node: usize, axis: usize) -> usize {
        self.nodes + node * 3 * N + 2 * N + axis
    }

    /// Jerk of an interval, or its mean.
    pub(crate) fn jerk(&self, interval: usize, axis: usize) -> usize {
        self.jerks + interval * N + axis
    }

    /// First and second moment of the jerk of an interval, where there are moments.
    pub(crate) fn moments(&self, interval: usize, axis: usize) -> Option<[usize; 2]> {
        let first = self.moments? + (interval * N + axis) * 2;
        Some([first, first + 1])
    }

    /// Relative change of the duration of a leg, where it may change.
    pub(crate) fn change(&self, leg: usize) -> Option<usize> {
        Some(self.changes? + leg)
    }

    /// Largest magnitude of every column in a program of `width` columns whose stretch is at most
    /// `g`; the columns after these are lengths along legs and auxiliary powers of the stretch.
    pub(crate) fn largest(&self, width: usize, scales: &Scales<N>, g: f64) -> Vec<f64> {
        let (first, second, third) = (g, g * g, g * g * g);
        // Lengths along legs and auxiliary powers.
        let mut largest = vec![(2.0 * scales.extent).max(first).max(second); width];
        largest[self.stretch] = third;
        largest[self.speed] = first;
        largest[self.rate] = second;
        for node in 0..=self.intervals {
            for axis in 0..N {
                largest[self.position(node, axis)] = scales.extent;
                largest[self.velocity(node, axis)] = first;
                largest[self.acceleration(node, axis)] = second;
            }
        }
        for interval in 0..self.intervals {
            for axis in 0..N {
                largest[self.jerk(interval, axis)] = third;
                for moment in self.moments(interval, axis).into_iter().flatten() {
                    largest[moment] = 0.5 * third;
                }
            }
        }
        largest
    }
}
