//! Both tolerances and the limits of every axis, on known paths.

mod common;

use common::{FAN, STAR, judge, legs, plan, settings, start_of, table_ac};
use toolglide_fiveaxis::PoseMethod;
use toolglide_machines::find;

const METHODS: [PoseMethod; 3] = [
    PoseMethod::PointToPoint,
    PoseMethod::DwellControlled,
    PoseMethod::VelocityControlled,
];

fn every_method_keeps_everything(rows: &[[f64; 6]], speeds: [f64; 2], tolerances: [f64; 2]) {
    let (machine, axes) = table_ac();
    let start = start_of(machine.as_ref(), &rows[0]);
    for speed in speeds {
        for constants in [[0.1, 0.06], [0.05, 0.02]] {
            for method in METHODS {
                let legs = legs(rows, speed, tolerances[0], tolerances[1]);
                let settings = settings(constants, method);
                let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
                let report = judge(machine.as_ref(), &axes, &legs, &planned);
                assert!(
                    report.passes(),
                    "{method:?} at {speed} mm/s: {:#?}",
                    report.examples
                );
            }
        }
    }
}

#[test]
fn the_star_path_keeps_both_tolerances_and_every_limit() {
    every_method_keeps_everything(&STAR, [50.0, 500.0], [0.1, 0.001]);
}

#[test]
fn the_fan_path_keeps_both_tolerances_and_every_limit() {
    every_method_keeps_everything(&FAN, [50.0, 500.0], [0.05, 0.002]);
}

/// A pose whose tool leans by so much along X and Y.
fn leaning(tip: [f64; 3], lean: [f64; 2]) -> [f64; 6] {
    let up = (1.0 - lean[0].powi(2) - lean[1].powi(2)).sqrt();
    [tip[0], tip[1], tip[2], lean[0], lean[1], up]
}

#[test]
fn an_axis_that_turns_fast_beside_the_pole_keeps_its_limits() {
    let model = find("head-bc").unwrap();
    let machine = (model.build)(&(model.preset)()).unwrap();
    let axes = machine.axes().to_vec();
    for past in [0.4, 0.3, 0.1, 0.01] {
        let rows = [
            leaning([0.0, 0.0, 0.0], [0.05, 0.1]),
            leaning([20.0, 10.0, 0.0], [-0.2, -past]),
        ];
        let start = start_of(machine.as_ref(), &rows[0]);
        for method in METHODS {
            let legs = legs(&rows, 100.0, 0.05, 0.002);
            let planned = plan(
                machine.as_ref(),
                &axes,
                start,
                &legs,
                &settings([0.1, 0.05], method),
            );
            let report = judge(machine.as_ref(), &axes, &legs, &planned);
            assert!(
                report.passes(),
                "{method:?} to {past}: {:#?}",
                report.examples
            );
        }
    }
}
