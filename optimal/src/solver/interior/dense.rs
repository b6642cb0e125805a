//! Compares the sweep with one dense factorisation of the Newton system.

use crate::problem::Visit;
use crate::solver::cone::{Centre, Reach, Sums};
use crate::solver::interior::*;
use crate::solver::riccati::{Chain, Local};
use crate::window::{EndState, Window, WindowSegment};
use toolglide_kinematics::Limits;
use toolglide_kinematics::nalgebra::{DMatrix, DVector};

/// All quadratics of one iteration, as the rows give them.
struct Collect<'a, const N: usize> {
    node: usize,
    segment: usize,
    state: &'a State<N>,
    stretch: f64,
    excess: f64,
    locals: Vec<(usize, usize, Chain<N>, Local<N>)>,
}

impl<const N: usize> Visit<N> for Collect<'_, N> {
    fn rows<R: Rows<N>>(&mut self, rows: &mut R, bound: &R::Bound, chain: &Chain<N>) {
        let point = chain.point(self.state, self.stretch);
        let local = rows.weigh(bound, &point, self.excess, &mut Sums::default());
        self.locals.push((self.node, self.segment, *chain, local));
    }
}

/// The predicting step by one dense factorisation of the whole Newton system, multipliers of
/// the dynamics included.
fn dense<const N: usize>(
    interior: &mut Interior<N>,
    problem: &Problem<N>,
    goal: Goal,
    unit: f64,
    floor: f64,
) -> DVector<f64> {
    let (steps, segments) = (problem.steps(), problem.segments());
    let state = |node: usize, order: usize, axis: usize| (node * 3 + order) * N + axis;
    let jerk = |interval: usize, axis: usize| 3 * N * (steps + 1) + interval * N + axis;
    let stretch = |segment: usize| 3 * N * (steps + 1) + steps * N + segment;
    let excess = stretch(segments);
    let unknowns = excess + 1;
    let size = unknowns + 3 * N * (steps + 2);
    let mut matrix = DMatrix::<f64>::zeros(size, size);
    let mut side = DVector::<f64>::zeros(size);
    for node in 0..=steps {
        let now = interior.states[node];
        let mut collect = Collect {
            node,
            segment: problem.segment_of(node),
            state: &now,
            stretch: interior.stretches[problem.segment_of(node)],
            excess: interior.excess,
            locals: Vec::new(),
        };
        let rows = &mut interior.rows[node];
        if node < steps {
            problem.visit_ahead(node, rows, &mut collect);
        }
        if node > 0 {
            collect.segment = problem.segment_of(node - 1);
            collect.stretch = interior.stretches[collect.segment];
            problem.visit_behind(node, rows, &mut collect);
        }
        for (node, segment, chain, local) in collect.locals {
            // The point as rows over the unknowns.
            let mut rows = DMatrix::<f64>::zeros(N + 1, unknowns);
            for axis in 0..N {
                rows[(axis, state(node, chain.order, axis))] += 1.0;
                if chain.order < 2 {
                    rows[(axis, state(node, chain.order + 1, axis))] += chain.ahead;
                    rows[(axis, stretch(segment))] += chain.ahead * chain.base[axis];
                }
            }
            rows[(N, excess)] = 1.0;
            let mut curvature = DMatrix::<f64>::zeros(N + 1, N + 1);
            let mut slope = DVector::<f64>::zeros(N + 1);
            for axis in 0..N {
                for other in 0..N {
                    curvature[(axis, other)] = local.point[(axis, other)];
                }
                curvature[(axis, N)] = local.mixed[axis];
                curvature[(N, axis)] = local.mixed[axis];
                slope[axis] = local.slope.point[axis];
            }
            curvature[(N, N)] = local.excess;
            slope[N] = local.slope.excess;
            let full = rows.transpose() * curvature * &rows;
            let gradient = rows.transpose() * slope;
            for one in 0..unknowns {
                side[one] -= gradient[one];
                for two in 0..unknowns {
                    matrix[(one, two)] += full[(one, two)];
                }
            }
        }
    }
    for interval in 0..steps {
        let local = interior.weigh_jerk(problem, interval, 1e-3, &mut Sums::default());
        for axis in 0..N {
            let at = jerk(interval, axis);
            matrix[(at, at)] += local.point[(axis, axis)];
            matrix[(at, excess)] += local.mixed[axis];
            matrix[(excess, at)] += local.mixed[axis];
            side[at] -= local.slope.point[axis];
        }
        matrix[(excess, excess)] += local.excess;
        side[excess] -= local.slope.excess;
    }
    for segment in 0..segments {
        let at = stretch(segment);
        if problem.stretching() {
            let (value, trust) = (interior.stretches[segment], interior.trust[segment]);
            let [upper, lower] = &mut interior.stretch_rows[segment];
            let upper = upper.weigh(trust - value, &mut Sums::default());
            let lower = lower.weigh(trust + value, &mut Sums::default());
            matrix[(at, at)] += upper.0 + lower.0;
            side[at] -= unit * problem.share(segment) + lower.1 - upper.1;
        } else {
            matrix[(at, at)] = 1.0;
        }
    }
    let row = interior
        .excess_row
        .weigh(interior.excess - floor, &mut Sums::default());
    matrix[(excess, excess)] += row.0;
    side[excess] -= row.1 + weight_of_excess(goal) * unit;
    let mut equation = unknowns;
    let mut couple = |entries: &[(usize, f64)], value: f64| {
        for (at, factor) in entries {
            matrix[(equation, *at)] = *factor;
            matrix[(*at, equation)] = *factor;
        }
        side[equation] = value;
        equation += 1;
    };
    for interval in 0..steps {
        let h = problem.duration(interval);
        let by_jerk = [h * h * h / 6.0, 0.5 * h * h, h];
        let zero = [Vector::zeros(); 3];
        let by_stretch = problem.after(interval, &zero, &Vector::zeros(), 1.0);
        let end = problem.after(
            interval,
            &interior.states[interval],
            &interior.jerks[interval],
            interior.stretches[problem.segment_of(interval)],
        );
        let drift = [[1.0, h, 0.5 * h * h], [0.0, 1.0, h], [0.0, 0.0, 1.0]];
        for order in 0..3 {
            for axis in 0..N {
                let mut entries = vec![
                    (jerk(interval, axis), by_jerk[order]),
                    (
                        stretch(problem.segment_of(interval)),
                        by_stretch[order][axis],
                    ),
                    (state(interval + 1, order, axis), -1.0),
                ];
                for (from, share) in drift[order].iter().enumerate() {
                    entries.push((state(interval, from, axis), *share));
                }
                couple(
                    &entries,
                    interior.states[interval + 1][order][axis] - end[order][axis],
                );
            }
        }
    }
    for node in [0, steps] {
        for order in 0..3 {
            for axis in 0..N {
                couple(&[(state(node, order, axis), 1.0)], 0.0);
            }
        }
    }
    let solution = matrix.lu().solve(&side).unwrap();
    solution.rows(0, unknowns).into_owned()
}

fn bend() -> (Vec<WindowSegment<2>>, Limits<2>, Vec<f64>) {
    let points = [[0.0, 0.0], [3.0, 0.0], [3.2, 0.3], [2.0, 2.0]];
    let segments = (0..3)
        .map(|index| WindowSegment {
            start: Vector::from(points[index]),
            end: Vector::from(points[index + 1]),
            tolerance: 0.02,
            corner_tolerance: Some(0.015),
            feedrate: [80.0, 50.0, 80.0][index],
            steps: [10, 8, 9][index],
            follow: None,
            walls: [None; 2],
        })
        .collect();
    let limits = Limits::uniform(60.0, 2000.0, 5e4).unwrap();
    (segments, limits, vec![0.12, 0.03, 0.11])
}

#[test]
fn the_sweep_solves_what_a_dense_factorisation_solves() {
    let (segments, limits, durations) = bend();
    let window = Window {
        start: EndState {
            position: segments[0].start,
            velocity: Vector::from([20.0, 0.0]),
            acceleration: Vector::from([300.0, 0.0]),
        },
        end: EndState::rest(segments[2].end),
        segments: &segments,
        limits: &limits,
        silence: None,
    };
    for goal in [
        Goal::Shorten { excess: 50.0 },
        Goal::Restore { enough: -1.0 },
    ] {
        let mut problem = Problem::default();
        problem.load(&window).unwrap();
        problem.set_durations(&durations);
        let mut interior = Interior::default();
        let steps = problem.steps();
        for node in 0..=steps {
            let segment = &segments[problem.segment_of(node)];
            let velocity = (segment.end - segment.start) / durations[problem.segment_of(node)];
            interior
                .states
                .push([segment.start, velocity, Vector::from([100.0, -50.0])]);
        }
        interior.jerks.resize(steps, Vector::from([2e3, -3e3]));
        interior.trust = vec![0.2; 3];
        let (states, jerks) = (interior.states.clone(), interior.jerks.clone());
        if matches!(goal, Goal::Shorten { .. }) {
            problem.set_base(Some((&states, &jerks)));
        }
        let unit = problem.degree() / ROWS_PER_UNIT;
        interior.prepare(&problem);
        let floor = interior.reset(&problem, goal);
        for iteration in 0..10 {
            let mut sums = Sums::default();
            assert!(
                interior.weigh(&problem, goal, unit, 1e-3, floor, &mut sums),
                "a pivot of iteration {iteration} is not positive"
            );
            interior.go(&problem);
            let dense = dense(&mut interior, &problem, goal, unit, floor);
            let mut worst = 0.0_f64;
            for (order, floor) in [1e-3_f64, 1.0, 50.0].into_iter().enumerate() {
                let (mut difference, mut largest) = (0.0_f64, floor);
                for node in 0..=steps {
                    for axis in 0..2 {
                        let change = interior.state_changes[node][order][axis];
                        let other = dense[(node * 3 + order) * 2 + axis];
                        difference = difference.max((change - other).abs());
                        largest = largest.max(other.abs());
                    }
                }
                worst = worst.max(difference / largest);
            }
            let excess = dense[dense.len() - 1];
            worst = worst.max((interior.excess_change - excess).abs() / (excess.abs() + 1e-3));
            assert!(worst < 1e-6, "iteration {iteration}: {worst:e}");
            let mut reach = Reach::default();
            interior.predict(&problem, &mut reach);
            let centre = Centre {
                complementarity: 0.1 * sums.complementarity / problem.degree(),
                second_order: 1.0,
                kept: 0.0,
            };
            interior.correct(&problem, goal, unit, 1e-3, centre);
            interior.go(&problem);
            let mut reach = Reach::default();
            interior.aim(&problem, &mut reach);
            let primal = (STEP_SHARE / reach.primal.max(STEP_SHARE)).min(1.0);
            let dual = (STEP_SHARE / reach.dual.max(STEP_SHARE)).min(1.0);
            interior.advance(&problem, primal, dual);
        }
    }
}
