//! Writes the program of a window as a table of cones for a general solver.
//!
//! Source: as [`problem`](crate::problem), written once more without chains and coefficients. Not here: what
//! is compared.

use crate::problem::constraints::{Constraint, Rows, Tube};
use crate::problem::{NodeRows, Problem, Visit};
use crate::solver::interior::Goal;
use crate::solver::interior::conic::{PRECISION, ROWS_PER_UNIT, weight_of_excess};
use crate::solver::riccati::Chain;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT,
};
use toolglide_kinematics::Vector;

/// Number of unknowns of a state and of a whole problem: states, jerks, stretches, excess, and one
/// progress per tube.
struct Numbering<const N: usize> {
    steps: usize,
    segments: usize,
}

impl<const N: usize> Numbering<N> {
    fn state(&self, node: usize, order: usize, axis: usize) -> usize {
        (node * 3 + order) * N + axis
    }

    fn jerk(&self, interval: usize, axis: usize) -> usize {
        self.state(self.steps + 1, 0, 0) + interval * N + axis
    }

    fn stretch(&self, segment: usize) -> usize {
        self.jerk(self.steps, 0) + segment
    }

    fn excess(&self) -> usize {
        self.stretch(self.segments)
    }

    /// The unit in which the general solver sees an unknown: about its largest value.
    fn unit(&self, unknown: usize) -> f64 {
        if unknown < self.jerk(0, 0) {
            [1.0, 100.0, 2500.0][unknown / N % 3]
        } else if unknown < self.stretch(0) {
            1e5
        } else {
            1.0
        }
    }
}

/// Rows `constant + Σ factor × unknown` that lie in a cone each.
#[derive(Default)]
struct Table {
    constants: Vec<f64>,
    entries: Vec<(usize, usize, f64)>,
    cones: Vec<SupportedConeT<f64>>,
    unknowns: usize,
    /// Unknowns whose squares are minimised, and weights of half of those.
    squares: Vec<(usize, f64)>,
}

impl Table {
    fn row(&mut self, constant: f64, entries: &[(usize, f64)]) {
        for (column, factor) in entries {
            self.entries.push((self.constants.len(), *column, *factor));
        }
        self.constants.push(constant);
    }

    fn positive(&mut self, constant: f64, entries: &[(usize, f64)]) {
        self.row(constant, entries);
        self.cones.push(SupportedConeT::NonnegativeConeT(1));
    }
}

/// Lists what every point keeps.
struct List<const N: usize> {
    points: Vec<(Chain<N>, Constraint<N>)>,
}

impl<const N: usize> Visit<N> for List<N> {
    fn rows<R: Rows<N>>(&mut self, _: &mut R, bound: &R::Bound, chain: &Chain<N>) {
        self.points.push((*chain, R::kept(bound)));
    }
}

/// The tubes of a node, and which points of the motion keep to them.
pub(super) fn tubes<const N: usize>(
    problem: &Problem<N>,
    node: usize,
) -> impl Iterator<Item = (Chain<N>, Tube<N>)> {
    let mut list = List { points: Vec::new() };
    let mut rows = NodeRows::default();
    if node < problem.steps() {
        problem.visit_ahead(node, &mut rows, &mut list);
    }
    if node > 0 {
        problem.visit_behind(node, &mut rows, &mut list);
    }
    list.points
        .into_iter()
        .filter_map(|(chain, kept)| match kept {
            Constraint::Tube(tube) => Some((chain, tube)),
            _ => None,
        })
}

/// The objective that the general solver finds, in shares of the duration.
pub(super) fn conic<const N: usize>(
    problem: &Problem<N>,
    trust: &[f64],
    goal: Goal,
) -> Option<f64> {
    let at = Numbering::<N> {
        steps: problem.steps(),
        segments: problem.segments(),
    };
    let unit = problem.degree() / ROWS_PER_UNIT;
    let excess = at.excess();
    let mut table = Table {
        unknowns: excess + 1,
        ..Table::default()
    };
    // Dynamics and ends.
    for interval in 0..at.steps {
        let h = problem.duration(interval);
        let zero = [Vector::zeros(); 3];
        let by_stretch = problem.after(interval, &zero, &Vector::zeros(), 1.0);
        let drift = [[1.0, h, 0.5 * h * h], [0.0, 1.0, h], [0.0, 0.0, 1.0]];
        let by_jerk = [h * h * h / 6.0, 0.5 * h * h, h];
        for order in 0..3 {
            // In units of what the limits allow within an interval.
            let scale = [1.0 / (100.0 * h), 1e-2, 4e-4][order];
            for (axis, by_stretch) in by_stretch[order].iter().enumerate() {
                let mut entries = vec![
                    (at.state(interval + 1, order, axis), -scale),
                    (at.jerk(interval, axis), by_jerk[order] * scale),
                    (at.stretch(problem.segment_of(interval)), by_stretch * scale),
                ];
                for (from, share) in drift[order].iter().enumerate() {
                    entries.push((at.state(interval, from, axis), share * scale));
                }
                table.row(0.0, &entries);
            }
        }
    }
    for (node, state) in [(0, problem.start()), (at.steps, problem.end())] {
        for (order, value) in state.iter().enumerate() {
            for axis in 0..N {
                table.row(-value[axis], &[(at.state(node, order, axis), 1.0)]);
            }
        }
    }
    table
        .cones
        .push(SupportedConeT::ZeroConeT(table.constants.len()));
    // What every point keeps.
    let mut rows = NodeRows::default();
    for node in 0..=at.steps {
        let mut list = List { points: Vec::new() };
        if node < at.steps {
            for axis in 0..N {
                let share = problem.by_jerk()[axis];
                for sign in [1.0, -1.0] {
                    let jerk = (at.jerk(node, axis), sign * share);
                    table.positive(1.0, &[jerk, (excess, 1.0)]);
                }
            }
            problem.visit_ahead(node, &mut rows, &mut list);
            keep(&mut table, &at, node, problem.segment_of(node), &list);
        }
        if node > 0 {
            list.points.clear();
            problem.visit_behind(node, &mut rows, &mut list);
            keep(&mut table, &at, node, problem.segment_of(node - 1), &list);
        }
    }
    let mut objective = vec![0.0; table.unknowns];
    for (segment, trust) in trust.iter().enumerate() {
        let trust = if problem.stretching() { *trust } else { 0.0 };
        for sign in [1.0, -1.0] {
            table.positive(trust, &[(at.stretch(segment), sign)]);
        }
        objective[at.stretch(segment)] = match goal {
            Goal::Shorten { .. } => problem.share(segment),
            Goal::Restore { .. } | Goal::Smooth { .. } => 0.0,
        };
    }
    objective[excess] = weight_of_excess(goal);
    let floor = match goal {
        Goal::Shorten { .. } | Goal::Smooth { .. } => 0.0,
        Goal::Restore { .. } => 0.5,
    };
    table.positive(floor, &[(excess, 1.0)]);
    let (mut diagonal, mut weights) = (Vec::new(), Vec::new());
    for interval in 0..at.steps {
        for axis in 0..N {
            let share = problem.by_jerk()[axis];
            diagonal.push(at.jerk(interval, axis));
            let weight = share * at.unit(at.jerk(interval, axis));
            let smoothing = PRECISION.smoothing * problem.time_weight(interval);
            weights.push(smoothing / unit * weight * weight);
        }
    }
    for (unknown, weight) in &table.squares {
        diagonal.push(*unknown);
        weights.push(weight / unit);
    }
    let unknowns = table.unknowns;
    let square =
        CscMatrix::new_from_triplets(unknowns, unknowns, diagonal.clone(), diagonal, weights);
    let (mut from, mut to, mut factors) = (Vec::new(), Vec::new(), Vec::new());
    for (row, column, factor) in table.entries {
        from.push(row);
        to.push(column);
        factors.push(-factor * at.unit(column));
    }
    let matrix = CscMatrix::new_from_triplets(table.constants.len(), unknowns, from, to, factors);
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_abs(1e-9)
        .tol_gap_rel(1e-9)
        .tol_feas(1e-9)
        .build()
        .ok()?;
    let mut solver = DefaultSolver::new(
        &square,
        &objective,
        &matrix,
        &table.constants,
        &table.cones,
        settings,
    )
    .ok()?;
    solver.solve();
    (solver.solution.status == SolverStatus::Solved).then_some(solver.solution.obj_val)
}

fn keep<const N: usize>(
    table: &mut Table,
    at: &Numbering<N>,
    node: usize,
    segment: usize,
    list: &List<N>,
) {
    let excess = at.excess();
    for (chain, kept) in &list.points {
        let along = |direction: &Vector<N>, share: f64| {
            let mut entries = vec![(
                at.stretch(segment),
                share * chain.ahead * chain.base.dot(direction),
            )];
            for axis in 0..N {
                let factor = direction[axis] * share;
                entries.push((at.state(node, chain.order, axis), factor));
                if chain.order < 2 {
                    entries.push((at.state(node, chain.order + 1, axis), factor * chain.ahead));
                }
            }
            entries
        };
        let unit = |axis: usize| Vector::<N>::from_fn(|row, _| f64::from(u8::from(row == axis)));
        match kept {
            Constraint::Box(bounds) => {
                for axis in 0..N {
                    for sign in [1.0, -1.0] {
                        let mut entries = along(&unit(axis), sign * bounds[axis]);
                        entries.push((excess, 1.0));
                        table.positive(1.0, &entries);
                    }
                }
            }
            Constraint::Disc(disc) => {
                table.row(disc.room, &[(excess, 1.0)]);
                for axis in 0..N {
                    let entries = along(&unit(axis), disc.by_radius);
                    table.row(-disc.center[axis] * disc.by_radius, &entries);
                }
                table.cones.push(SupportedConeT::SecondOrderConeT(N + 1));
            }
            Constraint::Tube(tube) => {
                let offset = tube.direction.dot(&tube.start) / tube.length;
                let share = 1.0 / tube.length;
                if tube.centring > 0.0 {
                    for axis in 0..N {
                        let direction = unit(axis) - tube.direction * tube.direction[axis];
                        let mut entries = along(&direction, tube.by_radius);
                        entries.push((table.unknowns, -1.0));
                        let constant = -direction.dot(&tube.start) * tube.by_radius;
                        table.row(constant, &entries);
                        table.squares.push((table.unknowns, tube.centring));
                        table.unknowns += 1;
                    }
                    table.cones.push(SupportedConeT::ZeroConeT(N));
                }
                let progress = table.unknowns;
                if tube.capsule {
                    table.unknowns += 1;
                    table.positive(0.0, &[(progress, 1.0)]);
                    table.positive(1.0, &[(progress, -1.0)]);
                } else {
                    let mut entries = along(&tube.direction, share);
                    entries.push((excess, 1.0));
                    table.positive(-offset, &entries);
                    let mut entries = along(&tube.direction, -share);
                    entries.push((excess, 1.0));
                    table.positive(1.0 + offset, &entries);
                }
                table.row(tube.room, &[(excess, 1.0)]);
                for axis in 0..N {
                    let mut direction = unit(axis);
                    if !tube.capsule {
                        direction -= tube.direction * tube.direction[axis];
                    }
                    let mut entries = along(&direction, tube.by_radius);
                    if tube.capsule {
                        let moved = tube.direction[axis] * tube.length * tube.by_radius;
                        entries.push((progress, -moved));
                    }
                    table.row(-direction.dot(&tube.start) * tube.by_radius, &entries);
                }
                table.cones.push(SupportedConeT::SecondOrderConeT(N + 1));
            }
        }
    }
}
