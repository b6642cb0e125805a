//! Both tolerances and the limits of every axis, on known paths.

mod common;

use common::{FAN, STAR, judge, legs, plan, settings, start_of, table_ac};
use toolglide_fiveaxis::PoseMethod;

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
