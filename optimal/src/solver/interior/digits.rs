//! Solves random windows to many digits, so that rounding never ends a solve.

use crate::solver::interior::*;
use crate::window::{EndState, Window, WindowSegment};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use toolglide_kinematics::{AxisLimits, Limits};

/// Some digits more than a window needs, some less than rounding leaves.
const FINE: Precision = Precision {
    gap: 1e-7,
    miss: 1e-9,
    smoothing: 1e-3,
};

/// Solves a chain of segments from a guess at constant speed, which need not keep any limit.
fn solves<const N: usize>(
    ways: &[([f64; 3], f64, usize)],
    tolerance: f64,
    limits: &Limits<N>,
    speed: f64,
    trust: f64,
) -> Result<(), TestCaseError> {
    let mut corner = Vector::<N>::zeros();
    let (mut segments, mut durations) = (Vec::new(), Vec::new());
    for (way, length, steps) in ways {
        let way = Vector::<N>::from_fn(|axis, _| way[axis]);
        if way.norm() < 0.1 {
            continue;
        }
        let way = way.normalize() * *length;
        segments.push(WindowSegment {
            start: corner,
            end: corner + way,
            tolerance,
            corner_tolerance: Some(tolerance),
            feedrate: if segments.len() % 2 == 0 { 90.0 } else { 40.0 },
            steps: *steps,
            follow: None,
            walls: [None; 2],
        });
        durations.push(0.04 + length / 50.0);
        corner += way;
    }
    prop_assume!(!segments.is_empty());
    let mut start = EndState::rest(segments[0].start);
    start.velocity = (segments[0].end - segments[0].start).normalize() * speed;
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
    let mut states = Vec::new();
    for (segment, duration) in segments.iter().zip(&durations) {
        let way = segment.end - segment.start;
        for step in 0..segment.steps {
            let part = crate::problem::count(step) / crate::problem::count(segment.steps);
            states.push([segment.start + way * part, way / *duration, Vector::zeros()]);
        }
    }
    states.push([corner, Vector::zeros(), Vector::zeros()]);
    let jerks = vec![Vector::zeros(); problem.steps()];
    let mut interior = Interior::default();
    for goal in [
        Goal::Shorten { excess: 50.0 },
        Goal::Restore { enough: -1.0 },
    ] {
        let base = matches!(goal, Goal::Shorten { .. });
        problem.set_base(base.then_some((states.as_slice(), jerks.as_slice())));
        interior.trust = vec![trust; segments.len()];
        interior.states.clone_from(&states);
        interior.jerks.clone_from(&jerks);
        let outcome = interior.solve(&mut problem, goal, &FINE, u32::MAX);
        prop_assert_eq!(outcome.ending, Ending::Solved, "{:?}: {:?}", goal, outcome);
    }
    Ok(())
}

fn limits<const N: usize>(shares: &[[f64; 3]]) -> Limits<N> {
    Limits::new(std::array::from_fn(|axis| {
        let [velocity, acceleration, jerk] = shares[axis];
        AxisLimits::new(100.0 * velocity, 2500.0 * acceleration, 1e5 * jerk).unwrap()
    }))
}

fn chain() -> impl Strategy<Value = Vec<([f64; 3], f64, usize)>> {
    let length = (0.05_f64.ln()..10.0_f64.ln()).prop_map(f64::exp);
    let way = (prop::array::uniform3(-1.0..1.0_f64), length, 4..20_usize);
    prop::collection::vec(way, 1..9)
}

fn shares() -> impl Strategy<Value = Vec<[f64; 3]>> {
    let axis = (0.5..1.5_f64, 0.5..1.5_f64, 0.3..2.0_f64);
    prop::collection::vec(axis.prop_map(<[f64; 3]>::from), 3)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2),
        ..ProptestConfig::default()
    })]

    #[test]
    fn windows_on_two_axes_are_solved_to_many_digits(
        ways in chain(), tolerance in 0.005..0.1_f64, shares in shares(),
        speed in 0.0..20.0_f64, trust in 0.001..0.4_f64,
    ) {
        solves::<2>(&ways, tolerance, &limits(&shares), speed, trust)?;
    }

    #[test]
    fn windows_on_three_axes_are_solved_to_many_digits(
        ways in chain(), tolerance in 0.005..0.1_f64, shares in shares(),
        speed in 0.0..20.0_f64, trust in 0.001..0.4_f64,
    ) {
        solves::<3>(&ways, tolerance, &limits(&shares), speed, trust)?;
    }
}
