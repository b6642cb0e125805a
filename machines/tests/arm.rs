//! The arm of six axes against another implementation of the same paper, which shares no line with it.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]
#![allow(
    clippy::cast_possible_truncation,
    reason = "random bits are cut into halves"
)]

mod common;

use common::Chance;
use rs_opw_kinematics::kinematic_traits::Kinematics;
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;
use std::f64::consts::{PI, TAU};
use toolglide_kinematics::{AxisVector, MachineKinematics};

const NAMES: [&str; 7] = ["a1", "a2", "b", "c1", "c2", "c3", "c4"];

/// The same arm by both: lengths in mm, axis 3 level at 0, axis 5 reversed.
fn both(lengths: [f64; 7]) -> (Box<dyn MachineKinematics>, OPWKinematics) {
    let model = toolglide_machines::find("arm-6r").unwrap();
    let mut config = (model.preset)();
    for (name, length) in NAMES.into_iter().zip(lengths) {
        config.geometry.insert(name.to_owned(), length);
    }
    for name in ["tool_length", "workpiece_x", "workpiece_z"] {
        config.geometry.insert(name.to_owned(), 0.0);
    }
    for axis in &mut config.axis {
        axis.travel = None;
    }
    config.axis[2].zero = -90.0;
    config.axis[4].reversed = true;
    let [a1, a2, b, c1, c2, c3, c4] = lengths;
    let other = OPWKinematics::new(Parameters {
        a1,
        a2,
        b,
        c1,
        c2,
        c3,
        c4,
        offsets: [0.0, 0.0, -0.5 * PI, 0.0, 0.0, 0.0],
        sign_corrections: [1, 1, 1, 1, -1, 1],
        dof: 6,
    });
    ((model.build)(&config).unwrap(), other)
}

/// How far two angles are apart, whole turns aside.
fn apart(one: f64, two: f64) -> f64 {
    let difference = (one - two).rem_euclid(TAU);
    difference.min(TAU - difference)
}

#[test]
fn the_arm_agrees_with_another_implementation() {
    let mut chance = Chance::new(11);
    let mut found = 0;
    for lengths in [
        [100.0, -135.0, 0.0, 615.0, 705.0, 755.0, 85.0],
        [25.0, -35.0, 0.0, 400.0, 315.0, 365.0, 80.0],
        [150.0, 0.0, 50.0, 550.0, 625.0, 640.0, 110.0],
    ] {
        let (machine, other) = both(lengths);
        for _ in 0..5_000 {
            let joints: [f64; 6] = std::array::from_fn(|_| chance.between(-3.1, 3.1));
            let wanted = other.forward(&joints);
            let pose = machine.forward(&AxisVector::from(joints)).unwrap();
            let flange = wanted.translation.vector;
            let turned = wanted.rotation.to_rotation_matrix();
            for row in 0..3 {
                let tip = pose.tip()[row] - flange[row];
                assert!(tip.abs() < 1e-9, "tip at {joints:?}: {tip:e}");
                let lean = pose.orientation()[row] + turned[(row, 2)];
                assert!(lean.abs() < 1e-12, "orientation at {joints:?}: {lean:e}");
            }
            if joints[4].sin().abs() < 0.01 {
                continue; // the other gives no second branch there
            }
            let ours = machine.solutions(&pose, &AxisVector::from(joints)).unwrap();
            for theirs in other.inverse(&wanted) {
                let nearest = ours
                    .iter()
                    .map(|axes| {
                        (0..5)
                            .map(|joint| apart(axes[joint], theirs[joint]))
                            .fold(0.0, f64::max)
                    })
                    .fold(PI, f64::min);
                assert!(nearest < 1e-6, "{theirs:?} is missing in {ours:?}");
                found += 1;
            }
        }
    }
    assert!(found > 50_000, "{found} solutions were compared");
}
