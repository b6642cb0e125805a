//! States the rows that keep a motion near its course.
//!
//! Source: every node belongs to a leg and lies within the tolerance of it (a capsule: one more unknown,
//! the length along the leg); where legs meet, within the tolerance of the corner. For cubic
//! pieces the Bezier points keep the capsule too, so that all of the piece does. Not here: dynamics.

use crate::course::{Hold, Join, Segment};
use crate::formulation::{Formulation, Kind, Stated};
use toolglide_kinematics::Vector;

/// Below this a direction counts as zero, dimensionless: a reversal has no inner side.
const NO_DIRECTION: f64 = 1e-9;

/// A point of the motion: per axis the columns that it is made of.
type Point = Vec<Vec<(usize, f64)>>;

/// The rows of one program under construction.
pub(crate) struct Tube<'a, 'b, const N: usize> {
    pub(crate) formulation: &'a Formulation<'b, N>,
    pub(crate) stated: &'a mut Stated<N>,
}

impl<const N: usize> Tube<'_, '_, N> {
    /// Adds all rows.
    pub(crate) fn keep(&mut self) {
        let grid = self.formulation.grid;
        let intervals = grid.intervals();
        for node in 1..intervals {
            let (before, after) = (grid.serves[node - 1], grid.serves[node]);
            let point = self.node(node);
            if before == after {
                self.hold(node, before, &point);
            } else {
                self.junction(node, before, after, &point);
            }
            self.inside(before, &point);
            if after != before {
                self.inside(after, &point);
            }
        }
        let course = self.formulation.course;
        for (interval, &leg) in grid.serves.iter().enumerate() {
            if course.legs[leg].hold == Hold::Line {
                self.straight_jerk(interval, leg);
            } else if self.formulation.kind == Kind::Enclosed {
                // Beside a rest the Bezier point is the rest itself.
                for (node, sign) in [(interval, 1.0), (interval + 1, -1.0)] {
                    if node > 0 && node < intervals {
                        let point = self.bezier(interval, node, sign);
                        self.hold(node, leg, &point);
                        self.inside(leg, &point);
                    }
                }
            }
        }
    }

    fn node(&self, node: usize) -> Point {
        let columns = &self.stated.columns;
        (0..N)
            .map(|axis| vec![(columns.position(node, axis), 1.0)])
            .collect()
    }

    /// The inner Bezier point of an interval beside a node.
    fn bezier(&self, interval: usize, node: usize, sign: f64) -> Point {
        let third = sign * self.formulation.grid.steps[interval] / 3.0;
        let (columns, scales) = (&self.stated.columns, &self.stated.scales);
        (0..N)
            .map(|axis| {
                vec![
                    (columns.position(node, axis), 1.0),
                    (columns.velocity(node, axis), third * scales.velocity[axis]),
                ]
            })
            .collect()
    }

    fn radius(&self, node: usize, leg: &Segment<N>) -> f64 {
        let needed = self.formulation.room.and_then(|room| room.nodes.get(node));
        match self.formulation.kind {
            Kind::Relaxed => needed.map_or(leg.outer, |&needed| leg.outer.max(needed)),
            _ => leg.inner * (1.0 - self.formulation.margin),
        }
    }

    fn hold(&mut self, node: usize, index: usize, point: &Point) {
        let leg = self.formulation.course.legs[index];
        if leg.hold == Hold::Tube {
            let radius = self.radius(node, &leg);
            self.capsule(&leg, radius, point);
        }
    }

    /// Where the motion changes from one leg to a later one; legs between take no time.
    fn junction(&mut self, node: usize, before: usize, after: usize, point: &Point) {
        let course = self.formulation.course;
        let mut near = false;
        for join in before..after {
            let corner = course.legs[join].end;
            match course.joins[join] {
                Join::Within(radius) => {
                    let needed = self.formulation.room.and_then(|room| room.joins.get(join));
                    let radius = match self.formulation.kind {
                        Kind::Relaxed => needed.map_or(radius, |&needed| radius.max(needed)),
                        _ => radius * (1.0 - self.formulation.margin),
                    };
                    self.ball(corner, radius, point);
                    near = true;
                }
                Join::Through => self.through(node, before, after, corner),
                Join::Anywhere => {}
            }
        }
        // A corner lies on both legs, so what is near it is near both.
        if !near && !matches!(course.joins[before], Join::Through) {
            self.hold(node, before, point);
            self.hold(node, after, point);
        }
    }

    fn ball(&mut self, center: Vector<N>, radius: f64, point: &Point) {
        let origin = self.stated.scales.origin;
        let rows = &mut self.stated.rows;
        rows.cone().cone_row([], 1.0);
        for (axis, terms) in point.iter().enumerate() {
            rows.cone_row(
                terms
                    .iter()
                    .map(|&(column, factor)| (column, factor / radius)),
                (origin[axis] - center[axis]) / radius,
            );
        }
    }

    fn capsule(&mut self, leg: &Segment<N>, radius: f64, point: &Point) {
        let origin = self.stated.scales.origin;
        let rows = &mut self.stated.rows;
        let along = rows.columns(1);
        rows.nonnegative([(along, 1.0)], 0.0);
        rows.nonnegative([(along, -1.0)], leg.length);
        rows.cone().cone_row([], 1.0);
        for (axis, terms) in point.iter().enumerate() {
            let scaled = terms
                .iter()
                .map(|&(column, factor)| (column, factor / radius));
            rows.cone_row(
                scaled.chain([(along, -leg.direction[axis] / radius)]),
                (origin[axis] - leg.start[axis]) / radius,
            );
        }
    }

    /// Jerk across an exact line is zero, and so are its moments; with the state at its start this keeps
    /// all of it.
    fn straight_jerk(&mut self, interval: usize, leg: usize) {
        let Stated {
            rows,
            columns,
            scales,
        } = &mut *self.stated;
        let most = scales.jerk.max();
        for across in across(&self.formulation.course.legs[leg].direction) {
            let share = |axis: usize| across[axis] * scales.jerk[axis] / most;
            let terms = (0..N).map(|axis| (columns.jerk(interval, axis), share(axis)));
            rows.zero(terms, 0.0);
            for order in 0..2 {
                let moment = |axis| {
                    let moments = columns.moments(interval, axis)?;
                    Some((moments[order], share(axis)))
                };
                let terms: Vec<_> = (0..N).filter_map(moment).collect();
                if !terms.is_empty() {
                    rows.zero(terms, 0.0);
                }
            }
        }
    }

    /// An end of an exact line: what the line before or the rest at the end does not say already.
    fn through(&mut self, node: usize, before: usize, after: usize, corner: Vector<N>) {
        let legs = &self.formulation.course.legs;
        let Stated {
            rows,
            columns,
            scales,
        } = &mut *self.stated;
        let at = corner - scales.origin;
        let ends_at_rest = after + 1 == legs.len();
        let position = |direction: &Vector<N>, rows: &mut crate::rows::Rows| {
            let terms = (0..N).map(|axis| (columns.position(node, axis), direction[axis]));
            rows.zero(terms, -direction.dot(&at));
        };
        if legs[before].hold == Hold::Line {
            position(&legs[before].direction, rows);
        } else if ends_at_rest {
            position(&legs[after].direction, rows);
        } else {
            for axis in 0..N {
                position(&unit(axis), rows);
            }
        }
        if legs[before].hold != Hold::Line && legs[after].hold == Hold::Line && !ends_at_rest {
            for across in across(&legs[after].direction) {
                let velocity =
                    |axis: usize| across[axis] * scales.velocity[axis] / scales.velocity.max();
                rows.zero(
                    (0..N).map(|axis| (columns.velocity(node, axis), velocity(axis))),
                    0.0,
                );
                let rate = |axis: usize| {
                    across[axis] * scales.acceleration[axis] / scales.acceleration.max()
                };
                rows.zero(
                    (0..N).map(|axis| (columns.acceleration(node, axis), rate(axis))),
                    0.0,
                );
            }
        }
    }

    /// Where it is asked for, a point stays on the inner side of its leg at both corners.
    fn inside(&mut self, index: usize, point: &Point) {
        let course = self.formulation.course;
        if !course.inside {
            return;
        }
        let leg = course.legs[index];
        let around = index.saturating_sub(1)..(index + 2).min(course.legs.len());
        for pair in course.legs[around].windows(2) {
            let (into, from) = (&pair[0], &pair[1]);
            let turn = from.direction - into.direction;
            let across = turn - leg.direction * turn.dot(&leg.direction);
            let Some(inner) = across.try_normalize(NO_DIRECTION) else {
                continue;
            };
            let offset = inner.dot(&(self.stated.scales.origin - leg.start)) / leg.inner;
            let terms = point.iter().enumerate().flat_map(|(axis, terms)| {
                let share = inner[axis] / leg.inner;
                terms
                    .iter()
                    .map(move |&(column, factor)| (column, factor * share))
            });
            self.stated.rows.nonnegative(terms, offset);
        }
    }
}

/// The unit vector along an axis.
fn unit<const N: usize>(axis: usize) -> Vector<N> {
    Vector::from_fn(|place, _| if place == axis { 1.0 } else { 0.0 })
}

/// Unit vectors across a direction, each to the others too.
fn across<const N: usize>(direction: &Vector<N>) -> Vec<Vector<N>> {
    let mut found = vec![*direction];
    let mut axes: Vec<usize> = (0..N).collect();
    // The axis along which the direction points most is left out.
    axes.sort_by(|&one, &other| direction[one].abs().total_cmp(&direction[other].abs()));
    for &axis in axes.iter().take(N.saturating_sub(1)) {
        let mut vector = unit::<N>(axis);
        for known in &found {
            vector -= known * known.dot(&vector);
        }
        found.push(vector.normalize());
    }
    found.remove(0);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_across_a_direction_are_orthonormal() {
        for direction in [[1.0, 0.0, 0.0], [0.6, 0.0, 0.8], [0.48, 0.6, 0.64]] {
            let direction = Vector::<3>::from(direction);
            let across = across(&direction);
            assert_eq!(across.len(), 2);
            assert!(across[0].dot(&across[1]).abs() < 1e-12, "{across:?}");
            for vector in &across {
                assert!(vector.dot(&direction).abs() < 1e-12, "{vector:?}");
                assert!((vector.norm() - 1.0).abs() < 1e-12, "{vector:?}");
            }
        }
    }
}
