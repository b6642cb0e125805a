//! No machine file, pose or position makes a machine panic or answer with what is no number.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use proptest::prelude::*;
use toolglide_kinematics::{AxisVector, ToolPose, Vector};
use toolglide_machines::{MachineConfig, models};

/// Numbers of every size, and those that are none.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -500.0..500.0,
        2 => (-12.0..40.0_f64, prop::bool::ANY)
            .prop_map(|(power, minus)| 10.0_f64.powf(power) * if minus { -1.0 } else { 1.0 }),
        1 => prop::num::f64::ANY,
        1 => prop::sample::select(vec![0.0, -0.0, 1e-308, f64::MAX, f64::INFINITY, f64::NAN]),
    ]
}

/// A preset with some numbers replaced.
fn config() -> impl Strategy<Value = MachineConfig> {
    let model = 0..models().len();
    let changes = prop::collection::vec((0_usize..20, number()), 0..4);
    (model, changes, prop::bool::ANY).prop_map(|(model, changes, ends)| {
        let model = models()[model];
        let mut config = (model.preset)();
        if !ends {
            for axis in &mut config.axis {
                axis.travel = None;
            }
        }
        for (place, value) in changes {
            if let Some(distance) = model.geometry.get(place) {
                config.geometry.insert(distance.name.to_owned(), value);
            } else if let Some(axis) = config.axis.get_mut(place - model.geometry.len()) {
                axis.zero = value;
                axis.reversed = model.name != "gantry";
            }
        }
        config
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn every_answer_is_a_refusal_or_a_number(
        config in config(),
        tip in [number(), number(), number()],
        direction in [-1.0..1.0, -1.0..1.0, -1.0..1.0],
        positions in prop::collection::vec(number(), 0..=9),
    ) {
        let model = toolglide_machines::find(&config.model).unwrap();
        let Ok(machine) = (model.build)(&config) else {
            return Ok(());
        };
        let finite = |axes: &AxisVector| axes.iter().all(|position| position.is_finite());
        let mut axes = AxisVector::from_slice(&positions).unwrap();
        if axes.len() > machine.axes().len() {
            axes = AxisVector::from_slice(&positions[..machine.axes().len()]).unwrap();
        }
        let mut poses = vec![ToolPose::upright(Vector::from(tip))];
        let direction = Vector::<3>::from(direction);
        if direction.norm() > 0.1 {
            poses.push(ToolPose::new(Vector::from(tip), direction.normalize()));
        }
        if let Ok(pose) = machine.forward(&axes) {
            poses.push(Ok(pose));
        } else {
            axes = AxisVector::zeros(machine.axes().len());
        }
        for pose in poses.into_iter().flatten() {
            if let Ok(found) = machine.inverse(&pose, &axes) {
                prop_assert!(finite(&found), "{} {:?}", model.name, found);
            }
            if let Ok(found) = machine.solutions(&pose, &axes) {
                prop_assert!(!found.is_empty() && found.iter().all(finite), "{:?}", found);
            }
        }
    }
}
