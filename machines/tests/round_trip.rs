//! Forward kinematics undoes inverse kinematics, on every machine and every branch.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]
#![allow(
    clippy::cast_possible_truncation,
    reason = "random bits are cut into halves"
)]

mod common;

use common::Chance;
use std::f64::consts::{PI, TAU};
use toolglide_kinematics::{
    AxisKind, AxisVector, KinematicsError, MachineKinematics, ToolPose, Vector,
};
use toolglide_machines::{MachineConfig, models};

/// Poses that are tried on each machine.
const POSES: u32 = 100_000;

/// Largest miss of an orientation, and of a tip as a share of the largest distance in play.
const MISS: f64 = 1e-12;

/// The preset of a model with every offset, sign and zero in use, and without ends.
fn awkward(config: &MachineConfig, chance: &mut Chance) -> MachineConfig {
    let mut config = config.clone();
    let model = toolglide_machines::find(&config.model).unwrap();
    for distance in model.geometry {
        let usual = distance.usual.unwrap_or_default();
        let value = config.geometry.get(distance.name).copied();
        let value = value.unwrap_or(usual) + chance.between(-40.0, 40.0);
        config.geometry.insert(distance.name.to_owned(), value);
    }
    let own = config.model == "gantry" || toolglide_machines::is_plain(&config);
    for axis in &mut config.axis {
        axis.travel = None;
        if !own {
            axis.reversed = chance.share() < 0.5;
            axis.zero = chance.between(-90.0, 90.0);
        }
    }
    config
}

/// Random positions of the axes, some hundred mm and some turns.
fn position(machine: &dyn MachineKinematics, chance: &mut Chance) -> AxisVector {
    let mut axes = AxisVector::zeros(machine.axes().len());
    let mut high = 0.0_f64;
    for (position, axis) in axes.iter_mut().zip(machine.axes()) {
        *position = match axis.kind {
            AxisKind::Linear => chance.between(-100.0, 100.0),
            AxisKind::Rotary => chance.between(-8.0, 8.0),
        };
        high = high.max(*position);
    }
    axes
}

/// Orientations all over the sphere, every third at a pole, near one, or where an angle jumps.
fn orientation(chance: &mut Chance) -> Vector<3> {
    let z = chance.between(-1.0, 1.0);
    let (sin, cos) = chance.between(-3.2, 3.2).sin_cos();
    let across = (1.0 - z * z).sqrt();
    let anywhere = Vector::<3>::new(across * cos, across * sin, z);
    let near = 10.0_f64.powf(chance.between(-17.0, -1.0));
    match (chance.share() * 18.0) as u32 {
        0 => Vector::<3>::z(),
        1 => -Vector::<3>::z(),
        2 | 3 => Vector::<3>::new(near * cos, near * sin, 1.0).normalize(),
        4 => Vector::<3>::new(near * cos, near * sin, -1.0).normalize(),
        5 => Vector::<3>::new(-1.0, near, z).normalize(),
        6 => Vector::<3>::new(near, -1.0, z).normalize(),
        _ => anywhere,
    }
}

/// Largest distance in play, mm: what the rounding of a tip is a share of.
fn size(config: &MachineConfig, axes: &AxisVector, tip: &Vector<3>) -> f64 {
    let zeros = config.axis.iter().map(|axis| axis.zero);
    let lengths = config.geometry.values().copied().chain(zeros);
    lengths
        .chain(axes.iter().copied())
        .chain(tip.iter().copied())
        .fold(1.0, |most, length| most.max(length.abs()))
}

#[test]
fn every_branch_of_every_machine_gives_the_pose_it_was_asked_for() {
    for model in models() {
        let mut chance = Chance::new(7);
        let (mut turned, mut shifted, mut most, mut tried) = (0.0_f64, 0.0_f64, 0, 0);
        let mut config = (model.preset)();
        let mut machine = (model.build)(&config).unwrap();
        while tried < POSES {
            if tried % 1000 == 0 {
                config = awkward(&(model.preset)(), &mut chance);
                machine = (model.build)(&config).unwrap();
            }
            let Ok(mut pose) = machine.forward(&position(&*machine, &mut chance)) else {
                continue; // the rods of a delta do not meet everywhere
            };
            let near = position(&*machine, &mut chance);
            let other = ToolPose::new(pose.tip(), orientation(&mut chance)).unwrap();
            let solutions = match machine.solutions(&other, &near) {
                Ok(solutions) => {
                    pose = other;
                    solutions
                }
                Err(KinematicsError::Unreachable { .. } | KinematicsError::Reach { .. }) => {
                    machine.solutions(&pose, &near).unwrap()
                }
                Err(refused) => panic!("{}: {refused} at {pose:?}", model.name),
            };
            assert_eq!(
                machine.inverse(&pose, &near).unwrap(),
                solutions[0],
                "{}: the nearest is first",
                model.name
            );
            for axes in solutions.iter() {
                let again = machine.forward(axes).unwrap();
                let miss = (again.tip() - pose.tip()).norm();
                shifted = shifted.max(miss / size(&config, axes, &pose.tip()));
                turned = turned.max((again.orientation() - pose.orientation()).norm());
                for (axis, (near, position)) in machine.axes().iter().zip(near.iter().zip(&**axes))
                {
                    assert!(
                        axis.kind == AxisKind::Linear || (near - position).abs() < PI + 1e-9,
                        "{}: axis {} went from {near} to {position}",
                        model.name,
                        axis.name
                    );
                }
            }
            most = most.max(solutions.len());
            tried += 1;
        }
        eprintln!(
            "{:<14} {most} branches, orientation {turned:.1e}, tip {shifted:.1e} of the size",
            model.name
        );
        assert!(turned <= MISS, "{}: orientation {turned:e}", model.name);
        assert!(shifted <= MISS, "{}: tip {shifted:e}", model.name);
        let branches = match model.name {
            "arm-6r" => 8,
            "gantry" | "corexy" | "delta" => 1,
            _ if toolglide_machines::is_plain(&config) => 1,
            _ => 2,
        };
        assert_eq!(most, branches, "{}: branches", model.name);
    }
}

#[test]
fn rotary_axes_go_on_from_turn_to_turn() {
    for name in ["table-ac", "table-bc", "head-bc", "head-table-bc"] {
        let model = toolglide_machines::find(name).unwrap();
        let config = awkward(&(model.preset)(), &mut Chance::new(3));
        let machine = (model.build)(&config).unwrap();
        let lean = 0.5_f64;
        let steps = 3_000;
        let pose = |step: i32| {
            let (sin, cos) = (TAU * f64::from(step) / 1000.0).sin_cos();
            let orientation = Vector::<3>::new(lean.sin() * cos, lean.sin() * sin, lean.cos());
            ToolPose::new(Vector::<3>::new(10.0, 20.0, 30.0), orientation).unwrap()
        };
        let start = machine.inverse(&pose(0), &AxisVector::zeros(5)).unwrap();
        let mut axes = start;
        for step in 1..=steps {
            let next = machine.inverse(&pose(step), &axes).unwrap();
            let turned = (next[4] - axes[4]).abs();
            assert!(turned < 6.3e-3, "{name}: C turned by {turned} in one step");
            assert!((next[3] - axes[3]).abs() < 1e-12, "{name}: A or B stays");
            axes = next;
        }
        let turns = ((axes[4] - start[4]) / TAU).abs();
        assert!((turns - 3.0).abs() < 1e-12, "{name}: {turns} turns");
    }
}
