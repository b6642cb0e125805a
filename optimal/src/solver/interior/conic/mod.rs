//! Compares the interior-point method with a general conic solver on random windows.

mod table;

use crate::solver::interior::*;
use crate::window::{EndState, Window, WindowSegment};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use table::{conic, tubes};
use toolglide_kinematics::{AxisLimits, Limits};

const PRECISION: Precision = Precision {
    gap: 1e-8,
    miss: 1e-10,
    smoothing: 1e-3,
};

/// Weight of the distance from the path where the motion is smoothed.
const CENTRING: f64 = 1e-3;

/// Relative difference of the objectives that two solvers of this precision may leave.
const AGREEMENT: f64 = 1e-6;

/// What rounding may leave of the gap where it ends a solve early.
const MIN_PRECISION: f64 = 1e-6;

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
        segments.push(WindowSegment {
            start: corner,
            end: corner + way,
            tolerance,
            corner_tolerance: Some(tolerance),
            feedrate: if segments.len() % 2 == 0 { 90.0 } else { 40.0 },
            steps: usize::from(*steps),
            follow: None,
            walls: [None; 2],
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
        silence: None,
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
        Goal::Smooth { excess: 50.0 },
    ] {
        problem.set_base(match goal {
            Goal::Shorten { .. } => Some((&states, &jerks)),
            Goal::Restore { .. } | Goal::Smooth { .. } => None,
        });
        let smoothing = matches!(goal, Goal::Smooth { .. });
        problem.set_centring(smoothing.then_some(CENTRING));
        interior.trust = vec![0.3; segments.len()];
        interior.states.clone_from(&states);
        interior.jerks.clone_from(&jerks);
        let outcome = interior.solve(&mut problem, goal, &PRECISION, u32::MAX);
        // Rounding may end it a little earlier; then it is as good as that.
        prop_assert!(
            outcome.gap < MIN_PRECISION && outcome.miss < MIN_PRECISION,
            "{goal:?}: {outcome:?}"
        );
        let unit = problem.degree() / ROWS_PER_UNIT;
        let mut own = weight_of_excess(goal) * interior.excess;
        if let Goal::Shorten { .. } = goal {
            for (segment, stretch) in interior.stretches.iter().enumerate() {
                own += problem.share(segment) * stretch;
            }
        }
        for (interval, jerk) in interior.jerks.iter().enumerate() {
            let share = jerk.component_mul(problem.by_jerk()).norm_squared();
            own += 0.5 * PRECISION.smoothing * problem.time_weight(interval) / unit * share;
        }
        for (node, state) in interior.states.iter().enumerate() {
            for (chain, tube) in tubes(&problem, node) {
                let share = tube.offset(&chain.point(state, 0.0)) * tube.by_radius;
                own += 0.5 * tube.centring / unit * share.norm_squared();
            }
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
    // The same instances every time.
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
