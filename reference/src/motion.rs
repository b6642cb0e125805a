//! Solves the program for the states of a motion on a grid until its scale is sane.
//!
//! Source: a program scaled far from its solution ends "solved" with a wrong stretch, because all of it
//! then lies below the precision. So it is scaled by what it found and solved again. Not here:
//! pieces, see [`pieces`](crate::pieces).

use crate::columns::{Columns, Scales};
use crate::course::Course;
use crate::formulation::{Formulation, Kind, Room, Stated};
use crate::grid::Grid;
use crate::solve::{Solution, solve};
use toolglide_kinematics::Vector;

/// A stretch of time within this of 1 leaves the scaled unknowns where the solver is precise.
const SANE_STRETCH: std::ops::RangeInclusive<f64> = 0.3..=3.0;

/// How often a program is scaled again at most: each time corrects some powers of ten.
const ATTEMPTS: usize = 12;

/// By how much a grid is changed at most in one attempt: what a badly scaled program finds is not to
/// be trusted far.
const LARGEST_CORRECTION: f64 = 30.0;

/// States at the ends of intervals of constant jerk.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Motion<const N: usize> {
    pub(crate) steps: Vec<f64>,
    pub(crate) positions: Vec<Vector<N>>,
    pub(crate) velocities: Vec<Vector<N>>,
    pub(crate) accelerations: Vec<Vector<N>>,
    pub(crate) jerks: Vec<Vector<N>>,
}

impl<const N: usize> Motion<N> {
    fn of(columns: &Columns<N>, scales: &Scales<N>, grid: &Grid, values: &[f64], g: f64) -> Self {
        let nodes = 0..=grid.intervals();
        let state = |column: &dyn Fn(usize, usize) -> usize, scale: Vector<N>| {
            nodes
                .clone()
                .map(|node| Vector::from_fn(|axis, _| values[column(node, axis)] * scale[axis]))
                .collect::<Vec<_>>()
        };
        let mut positions = state(&|k, axis| columns.position(k, axis), Vector::repeat(1.0));
        for position in &mut positions {
            *position += scales.origin;
        }
        Self {
            steps: grid.steps.iter().map(|step| step * g).collect(),
            positions,
            velocities: state(&|k, axis| columns.velocity(k, axis), scales.velocity / g),
            accelerations: state(
                &|k, axis| columns.acceleration(k, axis),
                scales.acceleration / (g * g),
            ),
            jerks: (0..grid.intervals())
                .map(|k| {
                    Vector::from_fn(|axis, _| {
                        values[columns.jerk(k, axis)] * scales.jerk[axis] / (g * g * g)
                    })
                })
                .collect(),
        }
    }
}

/// A solved program of least time.
#[derive(Clone, Debug)]
pub(crate) struct Least<const N: usize> {
    /// The grid at its true length.
    pub(crate) grid: Grid,
    pub(crate) motion: Motion<N>,
    /// Duration of the motion, s.
    pub(crate) duration: f64,
    stated: Stated<N>,
    solution: Solution,
    /// Duration of the grid that the program was stated on, s.
    stated_duration: f64,
}

impl<const N: usize> Least<N> {
    /// No motion that this program allows takes less, s; `upper` is the duration of one that it
    /// allows, or a little more.
    pub(crate) fn bound(&self, upper: f64) -> f64 {
        let g = upper / self.stated_duration;
        let rows = &self.stated.rows;
        let largest = self
            .stated
            .columns
            .largest(rows.width(), &self.stated.scales, g);
        // Either the stretch is above that of `upper`, or every column is at most `largest`.
        let gamma = rows.bound(&self.solution.dual, &largest).min(g * g * g);
        gamma.max(0.0).cbrt() * self.stated_duration
    }
}

/// Solves the program of least time; `None` when the solver gives no solution at any scale.
pub(crate) fn least_time<const N: usize>(
    course: &Course<N>,
    grid: &Grid,
    kind: Kind,
    room: Option<&Room>,
    margin: f64,
) -> Option<Least<N>> {
    let mut grid = grid.clone();
    for _ in 0..ATTEMPTS {
        let stated = Formulation {
            course,
            grid: &grid,
            kind,
            room,
            margin,
        }
        .least_time();
        let solution = solve(&stated.rows);
        let g = solution.columns[stated.columns.stretch].max(0.0).cbrt();
        if solution.usable() && SANE_STRETCH.contains(&g) {
            let motion = Motion::of(&stated.columns, &stated.scales, &grid, &solution.columns, g);
            let stated_duration = grid.duration();
            return Some(Least {
                grid: grid.stretched(g),
                motion,
                duration: stated_duration * g,
                stated,
                solution,
                stated_duration,
            });
        }
        let sensible = g.is_finite() && g > 0.0 && !SANE_STRETCH.contains(&g);
        grid = grid.stretched(if sensible {
            g.clamp(1.0 / LARGEST_CORRECTION, LARGEST_CORRECTION)
        } else {
            // Too short a grid is the commoner mistake, and the harder one for the solver.
            *SANE_STRETCH.end()
        });
    }
    None
}

/// The best small change of the durations of all legs about a motion on `grid`: a share for each leg,
/// and the share of time it promises to save.
pub(crate) fn best_change<const N: usize>(
    course: &Course<N>,
    grid: &Grid,
    kind: Kind,
    margin: f64,
    about: &Motion<N>,
    most: f64,
) -> Option<(Vec<f64>, f64)> {
    let stated = Formulation {
        course,
        grid,
        kind,
        room: None,
        margin,
    }
    .best_change(about, most);
    let solution = solve(&stated.rows);
    if !solution.usable() {
        return None;
    }
    let changes: Vec<f64> = (0..course.legs.len())
        .filter_map(|leg| stated.columns.change(leg))
        .map(|column| solution.columns[column])
        .collect();
    let cost = stated.rows.cost().iter().zip(&solution.columns);
    let promised: f64 = cost.map(|(cost, value)| -cost * value).sum();
    Some((changes, promised))
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::{Feedrate, Limits, Tolerance};

    #[test]
    fn a_little_less_than_the_least_time_is_not_possible() {
        let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(Vector::<2>::from);
        let limits = Limits::uniform(500.0, 2500.0, 2e5).unwrap();
        let (feedrate, tolerance) = (Feedrate::new(100.0).unwrap(), Tolerance::new(0.01).unwrap());
        let course = Course::through(&points, limits, feedrate, tolerance).unwrap();
        let grid = Grid::new(&[0.15; 2], &[40; 2]);
        let least = least_time(&course, &grid, Kind::Sampled, None, 0.0).unwrap();
        for (factor, possible) in [(0.999_f64, false), (1.001, true)] {
            let formulation = Formulation {
                course: &course,
                grid: &least.grid,
                kind: Kind::Sampled,
                room: None,
                margin: 0.0,
            };
            let mut stated = formulation.least_time();
            let column = stated.columns.stretch;
            stated.rows.zero([(column, 1.0)], -factor.powi(3));
            assert_eq!(solve(&stated.rows).usable(), possible, "{factor}");
        }
    }
}
