//! States the least time along a course as one convex program.
//!
//! Source: with scaled unknowns (see [`Columns`]) the limits of velocity, acceleration and jerk are the
//! powers 1/3, 2/3 and 1 of `gamma`, all concave, so least time is one program of second-order cones
//! for given shares of time on the legs. Three kinds differ in what they say of the time between
//! samples. Not here: the shares of time, see [`durations`](crate::durations); the tube, see
//! [`tube`](crate::tube).

use crate::columns::{Columns, Scales};
use crate::course::Course;
use crate::grid::Grid;
use crate::motion::Motion;
use crate::rows::Rows;
use crate::tube::Tube;

/// Integral of the magnitude of the second Legendre polynomial, rounded up: the second moment of a
/// jerk is at most this share of its limit.
const SECOND_MOMENT: f64 = 0.384_900_18;

/// What is said of the time between samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Nothing: jerk is constant in each interval, the tube is kept at the samples.
    Sampled,
    /// Jerk is constant, and Bezier points keep tube and feedrate at every instant.
    Enclosed,
    /// Everything that any motion with these samples must keep: a bound from below.
    Relaxed,
}

/// What a motion was found to need beyond the course, so that a bound is a bound for it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Room {
    /// Distance of each node from its legs, mm.
    pub(crate) nodes: Vec<f64>,
    /// Distance at which each corner is passed, mm.
    pub(crate) joins: Vec<f64>,
    /// Largest speed allowed in each interval, mm/s.
    pub(crate) feeds: Vec<f64>,
}

/// One program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Formulation<'a, const N: usize> {
    pub(crate) course: &'a Course<N>,
    pub(crate) grid: &'a Grid,
    pub(crate) kind: Kind,
    pub(crate) room: Option<&'a Room>,
    /// Share by which the tube is narrower than the tolerance.
    pub(crate) margin: f64,
}

/// The program, and where its unknowns stand.
#[derive(Clone, Debug)]
pub(crate) struct Stated<const N: usize> {
    pub(crate) rows: Rows,
    pub(crate) columns: Columns<N>,
    pub(crate) scales: Scales<N>,
}

impl<const N: usize> Formulation<'_, N> {
    /// The program of least time.
    pub(crate) fn least_time(&self) -> Stated<N> {
        let mut stated = self.begin(false);
        let (rows, columns) = (&mut stated.rows, stated.columns);
        rows.set_cost(columns.stretch, 1.0);
        powers(rows, columns.stretch, columns.speed, columns.rate);
        self.dynamics(&mut stated, None);
        self.keep(&mut stated);
        stated
    }

    /// The program of the best small change of the durations of legs: the dynamics linearized about a
    /// motion on the same grid, whose stretch is fixed, and each duration changed by a share of at
    /// most `most`.
    pub(crate) fn best_change(&self, about: &Motion<N>, most: f64) -> Stated<N> {
        let mut stated = self.begin(true);
        let (rows, columns) = (&mut stated.rows, stated.columns);
        for column in [columns.stretch, columns.speed, columns.rate] {
            rows.zero([(column, 1.0)], -1.0);
        }
        let total = self.grid.duration();
        for leg in 0..self.course.legs.len() {
            if let Some(change) = columns.change(leg) {
                let range = self.grid.firsts[leg]..self.grid.firsts[leg + 1];
                rows.set_cost(change, self.grid.steps[range].iter().sum::<f64>() / total);
                rows.nonnegative([(change, 1.0)], most);
                rows.nonnegative([(change, -1.0)], most);
            }
        }
        self.dynamics(&mut stated, Some(about));
        self.keep(&mut stated);
        stated
    }

    fn begin(&self, changes: bool) -> Stated<N> {
        let mut rows = Rows::default();
        let moments = self.kind == Kind::Relaxed;
        let columns = Columns::take(&mut rows, self.grid, moments, changes);
        Stated {
            rows,
            columns,
            scales: Scales::of(self.course, self.beyond()),
        }
    }

    /// How far from the course the motion can be, mm.
    fn beyond(&self) -> f64 {
        let mut beyond = self.course.legs.iter().fold(0.0, |most: f64, leg| {
            let radius = if leg.hold == crate::course::Hold::Free {
                leg.length
            } else {
                leg.outer
            };
            most.max(radius)
        });
        if let Some(room) = self.room {
            for radius in room.nodes.iter().chain(&room.joins) {
                beyond = beyond.max(*radius);
            }
        }
        beyond
    }

    /// Every sample follows from the one before; the course begins and ends at rest.
    fn dynamics(&self, stated: &mut Stated<N>, about: Option<&Motion<N>>) {
        let (rows, columns, scales) = (&mut stated.rows, &stated.columns, &stated.scales);
        let last = self.grid.intervals();
        for (k, &t) in self.grid.steps.iter().enumerate() {
            let change = columns.change(self.grid.serves[k]);
            for axis in 0..N {
                let (v, a, j) = (
                    scales.velocity[axis],
                    scales.acceleration[axis],
                    scales.jerk[axis],
                );
                let jerk = columns.jerk(k, axis);
                let mut lines = [
                    vec![
                        (columns.acceleration(k + 1, axis), 1.0),
                        (columns.acceleration(k, axis), -1.0),
                        (jerk, -t * j / a),
                    ],
                    vec![
                        (columns.velocity(k + 1, axis), 1.0),
                        (columns.velocity(k, axis), -1.0),
                        (columns.acceleration(k, axis), -t * a / v),
                        (jerk, -t * t * j / (2.0 * v)),
                    ],
                    vec![
                        (columns.position(k + 1, axis), 1.0 / (t * v)),
                        (columns.position(k, axis), -1.0 / (t * v)),
                        (columns.velocity(k, axis), -1.0),
                        (columns.acceleration(k, axis), -t * a / (2.0 * v)),
                        (jerk, -t * t * j / (6.0 * v)),
                    ],
                ];
                if let Some([first, second]) = columns.moments(k, axis) {
                    lines[1].push((first, -t * t * j / (2.0 * v)));
                    lines[2].push((first, -t * t * j / (4.0 * v)));
                    lines[2].push((second, -t * t * j / (12.0 * v)));
                }
                if let (Some(change), Some(about)) = (change, about) {
                    let (speed, rate, jerk) = (
                        about.velocities[k][axis],
                        about.accelerations[k][axis],
                        about.jerks[k][axis],
                    );
                    lines[0].push((change, -t * jerk / a));
                    lines[1].push((change, -(t * rate + t * t * jerk) / v));
                    lines[2].push((change, -(speed + t * rate + 0.5 * t * t * jerk) / v));
                }
                for line in lines {
                    rows.zero(line, 0.0);
                }
            }
        }
        for (node, point) in [(0, self.course.start()), (last, self.course.end())] {
            for axis in 0..N {
                let place = point[axis] - scales.origin[axis];
                rows.zero([(columns.position(node, axis), 1.0)], -place);
                rows.zero([(columns.velocity(node, axis), 1.0)], 0.0);
                rows.zero([(columns.acceleration(node, axis), 1.0)], 0.0);
            }
        }
    }

    fn keep(&self, stated: &mut Stated<N>) {
        self.velocities(stated);
        self.accelerations_and_jerks(stated);
        Tube {
            formulation: self,
            stated,
        }
        .keep();
    }

    /// Largest speed allowed in an interval, mm/s.
    pub(crate) fn feed(&self, interval: usize) -> f64 {
        match self.room.and_then(|room| room.feeds.get(interval)) {
            Some(&feed) => feed,
            None => self.course.legs[self.grid.serves[interval]].feed,
        }
    }

    fn velocities(&self, stated: &mut Stated<N>) {
        let intervals = self.grid.intervals();
        let Stated {
            rows,
            columns,
            scales,
        } = stated;
        for node in 1..intervals {
            let feed = self.feed(node - 1).min(self.feed(node));
            let terms = |axis| vec![(columns.velocity(node, axis), scales.velocity[axis])];
            self.speed(rows, columns, feed, terms);
        }
        for (k, &t) in self.grid.steps.iter().enumerate() {
            let feed = self.feed(k);
            match self.kind {
                Kind::Sampled => {}
                Kind::Enclosed => {
                    let terms = |axis: usize| {
                        let ramp = 0.5 * t * scales.acceleration[axis];
                        vec![
                            (columns.velocity(k, axis), scales.velocity[axis]),
                            (columns.acceleration(k, axis), ramp),
                        ]
                    };
                    self.speed(rows, columns, feed, terms);
                }
                Kind::Relaxed => {
                    let terms = |axis| {
                        vec![
                            (columns.position(k + 1, axis), 1.0 / t),
                            (columns.position(k, axis), -1.0 / t),
                        ]
                    };
                    self.speed(rows, columns, feed, terms);
                }
            }
        }
    }

    /// A velocity, mm/s times the stretch, keeps the feedrate and the limit of every axis.
    fn speed(
        &self,
        rows: &mut Rows,
        columns: &Columns<N>,
        feed: f64,
        terms: impl Fn(usize) -> Vec<(usize, f64)>,
    ) {
        let limits = self.course.limits.velocity();
        for axis in 0..N {
            if limits[axis] < feed {
                for sign in [1.0, -1.0] {
                    let share =
                        |(column, factor): (usize, f64)| (column, sign * factor / limits[axis]);
                    let all = terms(axis).into_iter().map(share);
                    rows.nonnegative(all.chain([(columns.speed, 1.0)]), 0.0);
                }
            }
        }
        if feed < limits.norm() {
            rows.cone().cone_row([(columns.speed, 1.0)], 0.0);
            for axis in 0..N {
                let share = |(column, factor): (usize, f64)| (column, factor / feed);
                rows.cone_row(terms(axis).into_iter().map(share), 0.0);
            }
        }
    }

    fn accelerations_and_jerks(&self, stated: &mut Stated<N>) {
        let Stated {
            rows,
            columns,
            scales,
        } = stated;
        for node in 1..self.grid.intervals() {
            for axis in 0..N {
                rows.magnitude(columns.acceleration(node, axis), columns.rate);
            }
        }
        for (k, &t) in self.grid.steps.iter().enumerate() {
            for axis in 0..N {
                let jerk = columns.jerk(k, axis);
                let Some([first, second]) = columns.moments(k, axis) else {
                    rows.magnitude(jerk, columns.stretch);
                    continue;
                };
                // Moments of anything that is at most gamma, and of anything at most its second power.
                moments(rows, columns.stretch, &[(jerk, 1.0)], &[(first, 1.0)]);
                for sign in [1.0, -1.0] {
                    rows.nonnegative([(columns.stretch, SECOND_MOMENT), (second, sign)], 0.0);
                }
                let (v, a) = (scales.velocity[axis], scales.acceleration[axis]);
                let (c, d) = (v / (t * a), 2.0 / (t * t * a));
                let mean = [
                    (columns.velocity(k + 1, axis), c),
                    (columns.velocity(k, axis), -c),
                ];
                let moment = [
                    (columns.position(k + 1, axis), d),
                    (columns.position(k, axis), -d),
                    (columns.velocity(k, axis), -c),
                    (columns.velocity(k + 1, axis), -c),
                ];
                moments(rows, columns.rate, &mean, &moment);
            }
        }
    }
}

/// `speed <= gamma^(1/3)` and `rate <= gamma^(2/3)` by four second-order cones.
fn powers(rows: &mut Rows, gamma: usize, speed: usize, rate: usize) {
    let (first, third) = (rows.columns(1), rows.columns(1));
    // speed² <= first · 1 and first² <= gamma · speed.
    product(rows, (&[(first, 1.0)], 0.0), (&[], 1.0), speed);
    product(rows, (&[(gamma, 1.0)], 0.0), (&[(speed, 1.0)], 0.0), first);
    // third² <= rate · 1 and rate² <= gamma · third.
    product(rows, (&[(rate, 1.0)], 0.0), (&[], 1.0), third);
    product(rows, (&[(gamma, 1.0)], 0.0), (&[(third, 1.0)], 0.0), rate);
}

/// The square of a column is at most the product of two expressions.
fn product(
    rows: &mut Rows,
    one: (&[(usize, f64)], f64),
    other: (&[(usize, f64)], f64),
    root: usize,
) {
    let half = |sign: f64| {
        let both = one.0.iter().map(|&(column, factor)| (column, 0.5 * factor));
        let rest = other.0.iter();
        both.chain(rest.map(move |&(column, factor)| (column, 0.5 * sign * factor)))
            .collect::<Vec<_>>()
    };
    rows.cone()
        .cone_row(half(1.0), 0.5 * (one.1 + other.1))
        .cone_row(half(-1.0), 0.5 * (one.1 - other.1))
        .cone_row([(root, 1.0)], 0.0);
}

/// Mean and first moment over an interval of something of magnitude at most `bound`:
/// `mean² <= bound (bound - 2 |moment|)`, attained by switching once.
fn moments(rows: &mut Rows, bound: usize, mean: &[(usize, f64)], moment: &[(usize, f64)]) {
    for sign in [1.0, -1.0] {
        let signed = |sign: f64| move |&(column, factor): &(usize, f64)| (column, sign * factor);
        rows.cone()
            .cone_row(moment.iter().map(signed(-sign)).chain([(bound, 1.0)]), 0.0)
            .cone_row(moment.iter().map(signed(sign)), 0.0)
            .cone_row(mean.iter().copied(), 0.0);
    }
}
