//! Moves that lead almost nowhere, one after the other.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Planned, judge, plan, pose, settings};
use proptest::prelude::*;
use toolglide_fiveaxis::{PoseMethod, Resolver, start_of as start_of_moves};
use toolglide_kinematics::{
    Feedrate, OrientationTolerance, PoseEnd, PoseFeed, PoseLeg, PoseMove, PosePath, Tolerance,
};
use toolglide_machines::find;
use toolglide_verify::PoseReport;

const METHODS: [PoseMethod; 3] = [
    PoseMethod::DwellControlled,
    PoseMethod::VelocityControlled,
    PoseMethod::PointToPoint,
];

/// Plans a machine along tools that lean by so much, and judges it.
fn planned(name: &str, rows: &[[f64; 5]], method: PoseMethod) -> (Vec<PoseLeg>, PoseReport) {
    let model = find(name).unwrap();
    let machine = (model.build)(&(model.preset)()).unwrap();
    let axes = machine.axes().to_vec();
    let feed = PoseFeed::Speed(Feedrate::new(50.0).unwrap());
    let tolerance = Tolerance::new(0.05).unwrap();
    let moves: Vec<_> = rows
        .iter()
        .map(|&[x, y, z, i, j]| {
            let up = (1.0 - i * i - j * j).sqrt();
            PoseMove::new(PoseEnd::Pose(pose(&[x, y, z, i, j, up])), feed, tolerance).unwrap()
        })
        .collect();
    let wide = OrientationTolerance::new(0.002).unwrap();
    let near = toolglide_kinematics::AxisVector::zeros(5);
    let start = start_of_moves(machine.as_ref(), &moves, &near, wide).unwrap();
    let mut resolver = Resolver::new(machine.as_ref(), start, wide).unwrap();
    let legs: Vec<_> = moves
        .iter()
        .map(|next| resolver.leg(next).unwrap())
        .collect();
    let settings = settings([0.05, 0.025], method);
    let planned: Planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
    let report = judge(machine.as_ref(), &axes, &legs, &planned);
    (legs, report)
}

#[test]
fn poses_that_are_repeated_are_passed_wherever_they_stand() {
    let one = [0.0, 0.0, 30.0, 0.3, 0.1];
    let two = [5.0, 1.0, 30.0, 0.2, 0.1];
    let three = [6.0, 8.0, 31.0, 0.2, 0.15];
    for rows in [
        vec![one, one, one, two],
        vec![one, two, two, two, two, three],
        vec![one, two, three, three],
        vec![one, two, three, three, three],
        vec![one, one, one],
    ] {
        for method in METHODS {
            let (_, report) = planned("head-table-bc", &rows, method);
            assert!(report.passes(), "{method:?}: {:#?}", report.examples);
        }
    }
}

#[test]
fn turns_too_small_to_be_made_do_not_add_up_to_a_jump() {
    let mut rows = vec![[0.0, 0.0, 30.0, 0.3, 0.1]];
    let mut lean = 0.3;
    for step in 0..12 {
        let along = 0.5 * f64::from(step);
        lean += 9e-10;
        rows.push([along, -along, 30.0, lean, 0.1]);
    }
    rows.push([8.0, 3.0, 30.0, 0.2, 0.1]);
    for name in ["head-bc", "table-ac"] {
        for method in METHODS {
            let (legs, report) = planned(name, &rows, method);
            for pair in legs.windows(2) {
                if let [
                    PosePath::Tool { turn: before, .. },
                    PosePath::Tool { turn: after, .. },
                ] = [&pair[0].path, &pair[1].path]
                {
                    let miss = (before.end() - after.start()).norm();
                    assert!(miss < 1e-15, "{name}: the path jumps by {miss}");
                }
            }
            assert!(
                report.passes(),
                "{name}, {method:?}: {:#?}",
                report.examples
            );
        }
    }
}

#[test]
fn the_pole_is_left_in_any_direction_however_near_to_it_the_move_ends() {
    for lean in [1e-4, 2e-5, 9e-6, 6e-6, 5.1e-6] {
        let rows = [
            [0.0, 0.0, 30.0, 0.01, 0.002],
            [0.5, 0.2, 30.0, 0.0, 0.0],
            [0.9, 0.3, 30.5, -lean, 0.3 * lean],
            [1.2, 0.3, 30.5, 0.0, 0.0],
            [1.2, 0.5, 30.7, 0.01, 0.03],
        ];
        for name in ["table-ac", "table-bc", "head-bc"] {
            for method in METHODS {
                let (_, report) = planned(name, &rows, method);
                assert!(
                    report.passes(),
                    "{name}, {method:?}, {lean} rad: {:#?}",
                    report.examples
                );
            }
        }
    }
}

#[test]
fn motion_may_begin_and_end_where_travel_does() {
    let model = find("corexy").unwrap();
    let machine = (model.build)(&(model.preset)()).unwrap();
    let axes = machine.axes().to_vec();
    let (low, _) = axes[2].travel.unwrap();
    let rows = [
        [50.0, 50.0, low, 0.0, 0.0, 1.0],
        [50.014, 50.0, low + 0.055, 0.0, 0.0, 1.0],
        [50.041, 49.994, low, 0.0, 0.0, 1.0],
        [49.996, 49.939, low + 0.4, 0.0, 0.0, 1.0],
    ];
    let legs = common::legs(&rows, 250.0, 1.0, 0.002);
    let start = common::start_of(machine.as_ref(), &rows[0]);
    for constants in [[0.05, 0.025], [0.575, 0.287], [0.004, 0.002]] {
        for method in METHODS {
            let settings = settings(constants, method);
            let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
            let report = judge(machine.as_ref(), &axes, &legs, &planned);
            assert!(report.passes(), "{method:?}: {:#?}", report.examples);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn moves_of_any_size_are_planned_within_their_limits(
        steps in prop::collection::vec(
            (-10.0..1.0_f64, -12.0..-1.0_f64, 0.0..6.3_f64, 0.0..6.3_f64),
            1..12,
        ),
        method in 0..3_usize,
    ) {
        let mut row = [0.0, 0.0, 30.0, 0.3, 0.1];
        let mut rows = vec![row];
        for (length, lean, way, towards) in steps {
            let (length, lean) = (10.0_f64.powf(length), 10.0_f64.powf(lean));
            row[0] += length * way.cos();
            row[1] += length * way.sin();
            row[3] = (row[3] + lean * towards.cos()).clamp(0.2, 0.4);
            row[4] = (row[4] + lean * towards.sin()).clamp(0.0, 0.2);
            rows.push(row);
        }
        let (_, report) = planned("table-ac", &rows, METHODS[method]);
        prop_assert!(report.passes(), "{:#?}", report.examples);
    }
}
