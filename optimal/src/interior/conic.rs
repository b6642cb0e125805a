//! The interior-point method against a general conic solver, on states and jerks with the dynamics
//! as equations, random windows.

use super::*;
use crate::front::Chain;
use crate::problem::Visit;
use crate::rows::Kept;
use crate::window::{EndState, Segment, Window};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use toolglide_kinematics::{AxisLimits, Limits};

const PRECISION: Precision = Precision {
    gap: 1e-8,
    miss: 1e-10,
    smoothing: 1e-3,
};

/// Relative difference of the objectives that two solvers of this precision may leave.
const AGREEMENT: f64 = 1e-6;

/// What rounding may leave of the gap where it ends a solve early.
const LEAST_PRECISION: f64 = 1e-3;

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
    points: Vec<(Chain<N>, Kept<N>)>,
}

impl<const N: usize> Visit<N> for List<N> {
    fn rows<R: Rows<N>>(&mut self, _: &mut R, bound: &R::Bound, chain: &Chain<N>) {
        self.points.push((*chain, R::kept(bound)));
    }
}

/// The objective that the general solver finds, in shares of the duration.
fn conic<const N: usize>(problem: &Problem<N>, trust: &[f64], goal: Goal) -> Option<f64> {
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
            Goal::Restore { .. } => 0.0,
        };
    }
    objective[excess] = weight_of_excess(goal);
    let floor = match goal {
        Goal::Shorten { .. } => 0.0,
        Goal::Restore { .. } => 0.5,
    };
    table.positive(floor, &[(excess, 1.0)]);
    let (mut diagonal, mut weights) = (Vec::new(), Vec::new());
    for interval in 0..at.steps {
        for axis in 0..N {
            let share = problem.by_jerk()[axis];
            diagonal.push(at.jerk(interval, axis));
            let weight = share * at.unit(at.jerk(interval, axis));
            weights.push(PRECISION.smoothing / unit * weight * weight);
        }
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
            Kept::Box(bounds) => {
                for axis in 0..N {
                    for sign in [1.0, -1.0] {
                        let mut entries = along(&unit(axis), sign * bounds[axis]);
                        entries.push((excess, 1.0));
                        table.positive(1.0, &entries);
                    }
                }
            }
            Kept::Disc(disc) => {
                table.row(disc.room, &[(excess, 1.0)]);
                for axis in 0..N {
                    let entries = along(&unit(axis), disc.by_radius);
                    table.row(-disc.center[axis] * disc.by_radius, &entries);
                }
                table.cones.push(SupportedConeT::SecondOrderConeT(N + 1));
            }
            Kept::Tube(tube) => {
                let offset = tube.direction.dot(&tube.start) / tube.length;
                let share = 1.0 / tube.length;
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

/// A random window: turns, lengths, limits, a start at speed.
fn compare<const N: usize>(
    ways: &[[f64; 3]],
    steps: &[u8],
    tolerance: f64,
    limits: &Limits<N>,
    moving: bool,
) -> Result<(), TestCaseError> {
    let mut corner = Vector::<N>::zeros();
    let (mut segments, mut durations) = (Vec::new(), Vec::new());
    for (way, steps) in ways.iter().zip(steps) {
        let way = Vector::<N>::from_fn(|axis, _| way[axis]);
        if way.norm() < 0.1 {
            continue;
        }
        segments.push(Segment {
            start: corner,
            end: corner + way,
            tolerance,
            corner_tolerance: Some(tolerance),
            feedrate: if segments.len() % 2 == 0 { 90.0 } else { 40.0 },
            steps: usize::from(*steps),
        });
        durations.push(0.04 + way.norm() / 50.0);
        corner += way;
    }
    prop_assume!(!segments.is_empty());
    let mut start = EndState::rest(segments[0].start);
    if moving {
        start.velocity = (segments[0].end - segments[0].start).normalize() * 10.0;
    }
    let window = Window {
        start,
        end: EndState::rest(corner),
        segments: &segments,
        limits,
    };
    let mut problem = Problem::default();
    problem.load(&window).unwrap();
    problem.set_durations(&durations);
    let mut interior = Interior::default();
    let mut states = Vec::new();
    for node in 0..=problem.steps() {
        let segment = problem.segment_of(node);
        let way = segments[segment].end - segments[segment].start;
        let part = f64::from(u16::try_from(node).unwrap()) * problem.duration(0);
        states.push([
            segments[segment].start + way * (part / durations[segment]).fract(),
            way / durations[segment],
            Vector::zeros(),
        ]);
    }
    let jerks = vec![Vector::zeros(); problem.steps()];
    for goal in [
        Goal::Shorten { excess: 50.0 },
        Goal::Restore { enough: -1.0 },
    ] {
        problem.set_base(match goal {
            Goal::Shorten { .. } => Some((&states, &jerks)),
            Goal::Restore { .. } => None,
        });
        interior.trust = vec![0.3; segments.len()];
        interior.states.clone_from(&states);
        interior.jerks.clone_from(&jerks);
        let outcome = interior.solve(&mut problem, goal, &PRECISION);
        // Rounding may end it a little earlier; then it is as good as that.
        prop_assert!(
            outcome.gap < LEAST_PRECISION && outcome.miss < LEAST_PRECISION,
            "{goal:?}: {outcome:?}"
        );
        let unit = problem.degree() / ROWS_PER_UNIT;
        let mut own = weight_of_excess(goal) * interior.excess;
        if let Goal::Shorten { .. } = goal {
            for (segment, stretch) in interior.stretches.iter().enumerate() {
                own += problem.share(segment) * stretch;
            }
        }
        for jerk in &interior.jerks {
            let share = jerk.component_mul(problem.by_jerk()).norm_squared();
            own += 0.5 * PRECISION.smoothing / unit * share;
        }
        let Some(other) = conic(&problem, &interior.trust, goal) else {
            continue;
        };
        prop_assert!(
            (own - other).abs() < AGREEMENT * (1.0 + other.abs()) + outcome.gap,
            "{goal:?}: {own} against {other}"
        );
    }
    Ok(())
}

fn limits<const N: usize>(shares: &[[f64; 3]]) -> Limits<N> {
    Limits::new(std::array::from_fn(|axis| {
        let [velocity, acceleration, jerk] = shares[axis];
        AxisLimits::new(100.0 * velocity, 2500.0 * acceleration, 1e5 * jerk).unwrap()
    }))
}

proptest! {
    // Of several hundred instances one ends early, at a gap of a thousandth: the arithmetic gives no step
    // from there. The same instances every time.
    #![proptest_config(ProptestConfig {
        cases: 24,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    #[test]
    fn two_axes_agree_with_a_general_solver(
        ways in prop::collection::vec([-8.0..8.0_f64, -8.0..8.0_f64, -8.0..8.0_f64], 1..5),
        steps in prop::collection::vec(4..20_u8, 5),
        tolerance in 0.01..0.1_f64,
        shares in prop::collection::vec([0.5..1.5_f64, 0.5..1.5_f64, 0.3..2.0_f64], 2),
        moving: bool,
    ) {
        compare::<2>(&ways, &steps, tolerance, &limits(&shares), moving)?;
    }

    #[test]
    fn three_axes_agree_with_a_general_solver(
        ways in prop::collection::vec([-8.0..8.0_f64, -8.0..8.0_f64, -8.0..8.0_f64], 1..5),
        steps in prop::collection::vec(4..16_u8, 5),
        tolerance in 0.01..0.1_f64,
        shares in prop::collection::vec([0.5..1.5_f64, 0.5..1.5_f64, 0.3..2.0_f64], 3),
        moving: bool,
    ) {
        compare::<3>(&ways, &steps, tolerance, &limits(&shares), moving)?;
    }
}
