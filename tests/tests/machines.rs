//! Every machine is planned on: both tolerances and the limits of all axes, to the judge's verdict.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use toolglide_fir::FilterChain;
use toolglide_fiveaxis::{FiveAxisError, PoseMethod, PosePlanner, PoseSettings};
use toolglide_kinematics::{
    AxisVector, Feedrate, KinematicsError, MachineKinematics, OrientationTolerance, PoseFeed,
    PoseLeg, Tolerance, ToolPose, Vector,
};
use toolglide_machines::{MachineConfig, find, models};
use toolglide_verify::{PoseJudge, PoseReport};

/// A path around a block: out, over it, past upright, and back; a tip and a lean each.
const AROUND: [[f64; 5]; 9] = [
    [-30.0, -20.0, 0.0, 0.05, -0.1],
    [30.0, -20.0, 0.0, 0.1, -0.2],
    [34.0, 0.0, 4.0, 0.3, 0.1],
    [30.0, 25.0, 0.0, 0.2, 0.3],
    [0.0, 30.0, 8.0, 0.0, 0.2],
    [-30.0, 25.0, 0.0, -0.2, -0.3],
    [-32.0, 24.0, 0.0, -0.25, -0.25],
    [-33.0, 22.0, 0.0, -0.3, -0.15],
    [-30.0, -20.0, 0.0, 0.0, -0.2],
];

/// The path, turned upright where the machine cannot tilt and level where it cannot rise, at a place that the machine reaches.
fn poses(machine: &dyn MachineKinematics, place: Vector<3>) -> Vec<ToolPose> {
    let near = AxisVector::zeros(machine.axes().len());
    let tilts = {
        let leaning = Vector::<3>::new(0.1, 0.0, 1.0).normalize();
        let pose = ToolPose::new(place, leaning).unwrap();
        machine.inverse(&pose, &near).is_ok()
    };
    let rises = {
        let above = place + Vector::<3>::new(0.0, 0.0, 8.0);
        machine
            .inverse(&ToolPose::upright(above).unwrap(), &near)
            .is_ok()
    };
    AROUND
        .iter()
        .map(|&[x, y, z, i, j]| {
            let lean = if tilts { [i, j] } else { [0.0; 2] };
            let orientation = Vector::<3>::new(lean[0], lean[1], 1.0).normalize();
            let z = if rises { z } else { 0.0 };
            ToolPose::new(place + Vector::<3>::new(x, y, z), orientation).unwrap()
        })
        .collect()
}

/// A place well inside of what the preset reaches.
fn place(model: &str) -> Vector<3> {
    match model {
        "delta" => Vector::<3>::new(0.0, 0.0, 50.0),
        "hot-wire" => Vector::<3>::new(5.0, -8.0, 0.0),
        _ => Vector::<3>::new(5.0, -8.0, 20.0),
    }
}

fn planned(
    config: &MachineConfig,
    poses: &[ToolPose],
    method: PoseMethod,
) -> Result<PoseReport, FiveAxisError> {
    let machine = (find(&config.model).unwrap().build)(config).unwrap();
    let axes = machine.axes().to_vec();
    let near = AxisVector::zeros(axes.len());
    let start = machine.inverse(&poses[0], &near).unwrap();
    let chain = FilterChain::with_time_constants(&[0.1, 0.05]).unwrap();
    let settings = PoseSettings::new(chain, method)?;
    let legs: Vec<PoseLeg> = poses
        .windows(2)
        .map(|ends| {
            PoseLeg::between(
                &ends[0],
                &ends[1],
                PoseFeed::Speed(Feedrate::new(100.0).unwrap()),
                Tolerance::new(0.05).unwrap(),
                OrientationTolerance::new(0.002).unwrap(),
            )
            .unwrap()
        })
        .collect();
    let mut planner = PosePlanner::new(machine.as_ref(), axes.clone(), start, settings)?;
    let mut judge = PoseJudge::new(machine.as_ref(), axes, &start);
    for leg in legs {
        judge.expect(&leg);
        planner.push(leg)?;
    }
    planner.finish()?;
    while let Some(piece) = planner.pull() {
        judge.observe(&piece);
    }
    Ok(judge.finish())
}

#[test]
fn every_machine_keeps_its_limits_and_both_tolerances() {
    for model in models() {
        let config = (model.preset)();
        let machine = (model.build)(&config).unwrap();
        let poses = poses(machine.as_ref(), place(model.name));
        for method in [PoseMethod::PointToPoint, PoseMethod::DwellControlled] {
            let report = planned(&config, &poses, method)
                .unwrap_or_else(|refused| panic!("{}, {method:?}: {refused}", model.name));
            assert!(
                report.passes(),
                "{}, {method:?}: {:#?}",
                model.name,
                report.examples
            );
        }
    }
}
#[test]
fn a_motion_that_needs_more_turns_than_there_are_is_refused() {
    let mut config = (find("table-ac").unwrap().preset)();
    config.axis[4].travel = Some([-200.0, 200.0]);
    config.axis[3].travel = Some([0.0, 90.0]);
    let around: Vec<ToolPose> = (0..=24)
        .map(|step| {
            let (sin, cos) = f64::from(20 * step).to_radians().sin_cos();
            let orientation = Vector::<3>::new(0.4 * sin, 0.4 * cos, 1.0).normalize();
            ToolPose::new(Vector::<3>::new(20.0 * sin, 20.0 * cos, 0.0), orientation).unwrap()
        })
        .collect();
    let refused = planned(&config, &around, PoseMethod::DwellControlled);
    assert!(
        matches!(
            refused,
            Err(FiveAxisError::Machine {
                reason: KinematicsError::Travel { axis: 'C', .. },
                ..
            })
        ),
        "{refused:?}"
    );
}
