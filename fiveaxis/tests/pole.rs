//! Motion past the pole of a machine, where a rotary axis turns half around at once.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{judge, legs, plan, pose, settings, start_of, table_ac};
use proptest::prelude::*;
use toolglide_fiveaxis::{PoseMethod, Resolver, start_of as start_of_moves};
use toolglide_kinematics::{
    Axis, AxisVector, Feedrate, MachineKinematics, OrientationTolerance, PoseEnd, PoseFeed,
    PoseLeg, PoseMove, PosePath, Tolerance, Vector,
};
use toolglide_machines::find;

/// A pose whose tool leans by so much along X and Y.
fn leaning(tip: [f64; 3], lean: [f64; 2]) -> [f64; 6] {
    let up = (1.0 - lean[0].powi(2) - lean[1].powi(2)).sqrt();
    [tip[0], tip[1], tip[2], lean[0], lean[1], up]
}

/// A machine whose axes have no ends.
fn endless(name: &str) -> (Box<dyn MachineKinematics>, Vec<Axis>) {
    let model = find(name).unwrap();
    let mut config = (model.preset)();
    for axis in &mut config.axis {
        axis.travel = None;
    }
    let machine = (model.build)(&config).unwrap();
    let axes = machine.axes().to_vec();
    (machine, axes)
}

#[test]
fn moves_past_the_pole_at_any_distance_keep_every_limit() {
    for name in ["table-ac", "table-bc", "head-bc"] {
        let model = find(name).unwrap();
        let machine = (model.build)(&(model.preset)()).unwrap();
        let axes = machine.axes().to_vec();
        for case in 0..300_u32 {
            let distance = 1e-10 * 5e8_f64.powf(f64::from(case / 6) / 49.0);
            let from = [0.05, 0.2, 0.4][case as usize % 3];
            let length = if case % 2 == 0 { 20.0 } else { 1.0 };
            let (sin, cos) = (0.7 + 1.3 * f64::from(case)).sin_cos();
            let at = |along: f64| [along * cos - distance * sin, along * sin + distance * cos];
            let rows = [
                leaning([0.0, 0.0, 0.0], at(-from)),
                leaning([length, 0.3 * length, 0.0], at(0.6 * from)),
            ];
            let start = start_of(machine.as_ref(), &rows[0]);
            let legs = legs(&rows, 100.0, 0.05, 0.002);
            let settings = settings([0.1, 0.05], PoseMethod::PointToPoint);
            let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
            let report = judge(machine.as_ref(), &axes, &legs, &planned);
            assert!(
                report.passes(),
                "{name} from {from} past the pole at {distance:.1e}: {:#?}",
                report.examples
            );
            // As much as C needs for half a turn, and not as if the whole move were as slow.
            assert!(
                report.cycle_time < 4.0,
                "{name} from {from} past the pole at {distance:.1e}: {} s",
                report.cycle_time
            );
        }
    }
}

const METHODS: [PoseMethod; 3] = [
    PoseMethod::DwellControlled,
    PoseMethod::VelocityControlled,
    PoseMethod::PointToPoint,
];

#[test]
fn a_path_that_starts_or_turns_at_the_pole_rests_there_while_one_axis_turns() {
    let rows = [
        leaning([0.0, 0.0, 0.0], [0.0, 0.0]),
        leaning([10.0, 0.0, 0.0], [0.15, 0.1]),
        leaning([20.0, 5.0, 0.0], [0.0, 0.0]),
        leaning([30.0, 5.0, 2.0], [-0.1, 0.2]),
        leaning([30.0, 9.0, 2.0], [0.0, 0.0]),
        leaning([25.0, 9.0, 2.0], [0.1, -0.2]),
    ];
    for name in ["table-ac", "table-bc", "head-bc", "head-table-bc"] {
        let (machine, axes) = endless(name);
        let start = start_of(machine.as_ref(), &rows[0]);
        let legs = legs(&rows, 50.0, 0.05, 0.001);
        for method in METHODS {
            let settings = settings([0.05, 0.025], method);
            let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
            let report = judge(machine.as_ref(), &axes, &legs, &planned);
            assert!(report.passes(), "{name} {method:?}: {:#?}", report.examples);
            assert!(
                report.cycle_time < 8.0,
                "{name} {method:?}: {} s",
                report.cycle_time
            );
        }
    }
}

#[test]
fn poses_an_arc_second_beside_the_pole_are_at_the_pole() {
    let (machine, axes) = table_ac();
    let tolerance = OrientationTolerance::new(0.001).unwrap();
    let moves = [[0.2, 0.1], [3e-6, -2e-6], [-0.1, 0.2]].map(|lean| {
        let end = PoseEnd::Pose(pose(&leaning([100.0 * lean[0], 0.0, 0.0], lean)));
        let feed = PoseFeed::Speed(Feedrate::new(50.0).unwrap());
        PoseMove::new(end, feed, Tolerance::new(0.05).unwrap()).unwrap()
    });
    let start = start_of_moves(machine.as_ref(), &moves, &AxisVector::zeros(5), tolerance).unwrap();
    let mut resolver = Resolver::new(machine.as_ref(), start, tolerance).unwrap();
    let legs: Vec<PoseLeg> = moves
        .iter()
        .map(|next| resolver.leg(next).unwrap())
        .collect();
    assert!(
        matches!(&legs[1].path, PosePath::Tool { turn, .. } if (turn.end() - Vector::<3>::z()).norm() < 1e-15),
        "{:?}",
        legs[1]
    );
    let settings = settings([0.05, 0.025], PoseMethod::DwellControlled);
    let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
    let report = judge(machine.as_ref(), &axes, &legs, &planned);
    assert!(report.passes(), "{:#?}", report.examples);
    assert!(report.cycle_time < 4.0, "{} s", report.cycle_time);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn chains_around_the_pole_keep_everything(
        steps in prop::collection::vec(
            (
                prop_oneof![
                    1 => Just((0.0, 0.0)),
                    1 => (-0.001..0.001_f64, -0.001..0.001_f64),
                    3 => (-0.15..0.15_f64, -0.15..0.15_f64),
                ],
                -10.0..10.0_f64,
                -10.0..10.0_f64,
            ),
            2..8,
        ),
        name in prop::sample::select(vec!["table-ac", "table-bc", "head-bc", "head-table-bc"]),
        speed in 5.0..200.0_f64,
        tip in 0.005..0.2_f64,
        orientation in 0.0005..0.02_f64,
    ) {
        let rows: Vec<[f64; 6]> = steps
            .iter()
            .map(|&((i, j), x, y)| leaning([x, y, 0.1 * x], [i, j]))
            .collect();
        let (machine, axes) = endless(name);
        let start = start_of(machine.as_ref(), &rows[0]);
        let legs = legs(&rows, speed, tip, orientation);
        for method in METHODS {
            let settings = settings([0.05, 0.025], method);
            let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
            let report = judge(machine.as_ref(), &axes, &legs, &planned);
            prop_assert!(report.passes(), "{method:?}: {:#?}", report.examples);
        }
    }
}
