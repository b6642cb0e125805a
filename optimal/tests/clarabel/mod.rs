//! The same windows solved in another way: positions, velocities, accelerations and jerks as unknowns
//! of a conic program, by a general solver.
//!
//! Source: ours. Shares no formula and no arithmetic with the solver of the crate. The durations enter
//! linearised about a motion that need not obey its own dynamics; then the motion is found again at fixed
//! durations.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT,
};
use toolglide_kinematics::Vector;
use toolglide_optimal::{Budget, EndState, Solved, Unsolved, Window, WindowMotion, WindowSolver};

/// Weight of a share by which limits are exceeded, against a share of the duration.
const ELASTIC: f64 = 50.0;

/// What counts as kept: half of what is held back from the solver.
const KEPT: f64 = 2e-4;

/// Gain of a step, as a share of the duration, below which there is nothing more to gain.
const SETTLED: f64 = 1e-3;

#[derive(Default)]
struct Rows {
    entries: Vec<(usize, usize, f64)>,
    constants: Vec<f64>,
}

impl Rows {
    /// A row `constant + sum of coefficient times unknown`.
    fn row(&mut self, constant: f64, terms: &[(usize, f64)]) {
        let row = self.constants.len();
        self.constants.push(constant);
        self.entries.extend(
            terms
                .iter()
                .map(|&(column, coefficient)| (row, column, coefficient)),
        );
    }
}

/// Finds motion by a general conic solver.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Conic {
    /// Windows solved so far that found no motion.
    pub failures: u32,
    /// Conic programs solved so far.
    pub solves: u32,
}

struct Answer<const N: usize> {
    excess: f64,
    changes: Vec<f64>,
    motion: WindowMotion<N>,
}

impl Conic {
    #[allow(clippy::too_many_lines, reason = "one program, row by row")]
    fn program<const N: usize>(
        &mut self,
        window: &Window<'_, N>,
        motion: &WindowMotion<N>,
        trust: Option<f64>,
    ) -> Option<Answer<N>> {
        self.solves += 1;
        let count = window.segments.len();
        let total = window.steps();
        let nodes = total + 1;
        let origin = window.start.position;
        let fastest = window
            .segments
            .iter()
            .map(|segment| segment.feedrate)
            .fold(0.0, f64::max);
        let scale_v = window.limits.velocity().map(|limit| limit.min(fastest));
        let (scale_a, scale_j) = (*window.limits.acceleration(), *window.limits.jerk());
        // Unknowns: elastic, changes of duration, then blocks of node and axis.
        let change = |segment: usize| 1 + segment;
        let base = 1 + count;
        let at = |block: usize, node: usize, axis: usize| base + (block * nodes + node) * N + axis;
        let place = |interval: usize, which: usize| base + 4 * nodes * N + 2 * interval + which;
        let unknowns = base + 4 * nodes * N + 2 * total;
        let owner: Vec<usize> = window
            .segments
            .iter()
            .enumerate()
            .flat_map(|(index, segment)| std::iter::repeat_n(index, segment.steps))
            .collect();
        let tau: Vec<f64> = owner
            .iter()
            .map(|&index| motion.durations[index] / window.segments[index].steps as f64)
            .collect();
        let (mut equal, mut above, mut cones) = (Rows::default(), Rows::default(), Rows::default());
        let mut cone_sizes = Vec::new();
        for k in 0..total {
            let (h, own) = (tau[k], change(owner[k]));
            let step = trust.map_or(0.0, |_| 1.0);
            let (state, jerk) = (&motion.states[k], &motion.jerks[k]);
            for i in 0..N {
                let (v, a, j) = (scale_v[i], scale_a[i], scale_j[i]);
                let (vb, ab, jb) = (
                    step * state.velocity[i],
                    step * state.acceleration[i],
                    step * jerk[i],
                );
                equal.row(
                    0.0,
                    &[
                        (at(2, k + 1, i), 1.0),
                        (at(2, k, i), -1.0),
                        (at(3, k, i), -h * j / a),
                        (own, -h * jb / a),
                    ],
                );
                equal.row(
                    0.0,
                    &[
                        (at(1, k + 1, i), 1.0),
                        (at(1, k, i), -1.0),
                        (at(2, k, i), -h * a / v),
                        (at(3, k, i), -h * h * j / (2.0 * v)),
                        (own, -(h * ab + h * h * jb) / v),
                    ],
                );
                equal.row(
                    0.0,
                    &[
                        (at(0, k + 1, i), 1.0 / (h * v)),
                        (at(0, k, i), -1.0 / (h * v)),
                        (at(1, k, i), -1.0),
                        (at(2, k, i), -h * a / (2.0 * v)),
                        (at(3, k, i), -h * h * j / (6.0 * v)),
                        (own, -(vb + h * ab + 0.5 * h * h * jb) / v),
                    ],
                );
            }
        }
        for (node, state) in [(0, &window.start), (total, &window.end)] {
            for i in 0..N {
                equal.row(-(state.position[i] - origin[i]), &[(at(0, node, i), 1.0)]);
                equal.row(-state.velocity[i] / scale_v[i], &[(at(1, node, i), 1.0)]);
                equal.row(
                    -state.acceleration[i] / scale_a[i],
                    &[(at(2, node, i), 1.0)],
                );
            }
        }
        for i in 0..N {
            // There is no jerk after the last node.
            equal.row(0.0, &[(at(3, total, i), 1.0)]);
        }
        above.row(0.0, &[(0, 1.0)]);
        let within = |rows: &mut Rows, terms: &[(usize, f64)], bound: f64| {
            for sign in [1.0, -1.0] {
                let mut all: Vec<_> = terms.iter().map(|&(c, x)| (c, sign * x / bound)).collect();
                all.push((0, 1.0));
                rows.row(1.0, &all);
            }
        };
        for segment in 0..count {
            for sign in [1.0, -1.0] {
                above.row(trust.unwrap_or(0.0), &[(change(segment), sign)]);
            }
        }
        for k in 0..total {
            for i in 0..N {
                within(&mut above, &[(at(3, k, i), 1.0)], 1.0);
                if k > 0 {
                    within(&mut above, &[(at(2, k, i), 1.0)], 1.0);
                }
                let half = 0.5 * tau[k] / scale_v[i];
                let middle = [
                    (at(1, k, i), 1.0),
                    (at(2, k, i), half * scale_a[i]),
                    (change(owner[k]), half * motion.states[k].acceleration[i]),
                ];
                let bound = window.limits.velocity()[i] / scale_v[i];
                within(&mut above, &middle, bound);
            }
            let segment = &window.segments[owner[k]];
            let (h, own) = (tau[k], change(owner[k]));
            let span = segment.end - segment.start;
            if segment.feedrate.is_finite() {
                cones.row(1.0, &[(0, 1.0)]);
                for i in 0..N {
                    let half = 0.5 * h / segment.feedrate;
                    cones.row(
                        0.0,
                        &[
                            (at(1, k, i), scale_v[i] / segment.feedrate),
                            (at(2, k, i), half * scale_a[i]),
                            (own, half * motion.states[k].acceleration[i]),
                        ],
                    );
                }
                cone_sizes.push(N + 1);
            }
            for (which, node, third) in [(0, k, h / 3.0), (1, k + 1, -h / 3.0)] {
                above.row(0.0, &[(place(k, which), 1.0)]);
                above.row(1.0, &[(place(k, which), -1.0)]);
                let tube = segment.tolerance;
                cones.row(1.0, &[(0, 1.0)]);
                for i in 0..N {
                    cones.row(
                        -(segment.start[i] - origin[i]) / tube,
                        &[
                            (at(0, node, i), 1.0 / tube),
                            (at(1, node, i), third * scale_v[i] / tube),
                            (own, third * motion.states[node].velocity[i] / tube),
                            (place(k, which), -span[i] / tube),
                        ],
                    );
                }
                cone_sizes.push(N + 1);
            }
            let last = k + 1 == total || owner[k + 1] != owner[k];
            if last && let Some(ball) = segment.corner_tolerance {
                cones.row(1.0, &[(0, 1.0)]);
                for i in 0..N {
                    cones.row(
                        -(segment.end[i] - origin[i]) / ball,
                        &[(at(0, k + 1, i), 1.0 / ball)],
                    );
                }
                cone_sizes.push(N + 1);
            }
        }
        let mut kinds = vec![
            SupportedConeT::ZeroConeT(equal.constants.len()),
            SupportedConeT::NonnegativeConeT(above.constants.len()),
        ];
        kinds.extend(cone_sizes.into_iter().map(SupportedConeT::SecondOrderConeT));
        let (mut rows, mut columns, mut values, mut constants) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for group in [equal, above, cones] {
            let first = constants.len();
            for (row, column, value) in group.entries {
                rows.push(first + row);
                columns.push(column);
                values.push(-value);
            }
            constants.extend(group.constants);
        }
        let matrix = CscMatrix::new_from_triplets(constants.len(), unknowns, rows, columns, values);
        let mut cost = vec![0.0; unknowns];
        if trust.is_some() {
            let whole = motion.duration();
            for (segment, duration) in motion.durations.iter().enumerate() {
                cost[change(segment)] = duration / whole;
            }
            cost[0] = ELASTIC;
        } else {
            cost[0] = 1.0;
        }
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .max_iter(80)
            .tol_gap_abs(1e-6)
            .tol_gap_rel(1e-6)
            .tol_feas(1e-6)
            .build()
            .ok()?;
        let nothing = CscMatrix::zeros((unknowns, unknowns));
        let mut solver =
            DefaultSolver::new(&nothing, &cost, &matrix, &constants, &kinds, settings).ok()?;
        solver.solve();
        let solution = &solver.solution;
        if !matches!(
            solution.status,
            SolverStatus::Solved | SolverStatus::AlmostSolved
        ) {
            return None;
        }
        let x = &solution.x;
        let states = (0..nodes)
            .map(|k| EndState {
                position: origin + Vector::from_fn(|i, _| x[at(0, k, i)]),
                velocity: Vector::from_fn(|i, _| x[at(1, k, i)] * scale_v[i]),
                acceleration: Vector::from_fn(|i, _| x[at(2, k, i)] * scale_a[i]),
            })
            .collect();
        let jerks = (0..total)
            .map(|k| Vector::from_fn(|i, _| x[at(3, k, i)] * scale_j[i]))
            .collect();
        Some(Answer {
            excess: x[0],
            changes: (0..count).map(|segment| x[change(segment)]).collect(),
            motion: WindowMotion {
                durations: motion.durations.clone(),
                states,
                jerks,
            },
        })
    }
}

impl<const N: usize> WindowSolver<N> for Conic {
    fn solve(
        &mut self,
        window: &Window<'_, N>,
        motion: &mut WindowMotion<N>,
        budget: &mut Budget,
    ) -> Result<Solved, Unsolved> {
        let before = self.solves;
        let mut best: Option<WindowMotion<N>> = None;
        let mut base = motion.clone();
        let mut trust = 0.4;
        let effort = budget.solves;
        for round in 0..effort {
            let Some(step) = self.program(window, &base, Some(trust)) else {
                trust *= 0.25;
                if trust < 1e-3 {
                    break;
                }
                continue;
            };
            let duration = base.duration();

            let gain = -base
                .durations
                .iter()
                .zip(&step.changes)
                .map(|(duration, change)| duration * change)
                .sum::<f64>()
                / duration;
            let durations = base.durations.iter().zip(&step.changes);
            let durations = durations
                .map(|(time, change)| time * (1.0 + change))
                .collect();
            base = WindowMotion {
                durations,
                ..step.motion
            };
            let last = round + 1 == effort || (gain.abs() < SETTLED && step.excess < KEPT);
            if !last && round % 3 != 2 {
                continue;
            }
            let Some(restored) = self.program(window, &base, None) else {
                continue;
            };
            base = restored.motion;

            if restored.excess < KEPT {
                if best
                    .as_ref()
                    .is_none_or(|best| base.duration() < best.duration())
                {
                    best = Some(base.clone());
                }
                if gain.abs() < SETTLED {
                    break;
                }
            } else {
                trust = (0.5 * trust).max(0.02);
            }
        }
        // What does not settle is slowed down until it fits.
        let mut slower = 0.002;
        while best.is_none() && slower < 0.1 {
            for duration in &mut base.durations {
                *duration *= 1.0 + slower;
            }
            if let Some(restored) = self.program(window, &base, None) {
                base = restored.motion;
                if restored.excess < KEPT {
                    best = Some(base.clone());
                }
            }
            slower *= 2.0;
        }
        let solves = self.solves - before;
        let Some(best) = best else {
            self.failures += 1;
            return Err(Unsolved::NotConverged {
                solves,
                excess: f64::INFINITY,
            });
        };
        *motion = best;
        Ok(Solved {
            duration: motion.duration(),
            solves,
            iterations: 0,
        })
    }
}
