//! Branches, turns and travel: where axes start, and how they go on.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{judge, plan, settings};
use std::f64::consts::PI;
use toolglide_fiveaxis::{FiveAxisError, PoseMethod, Resolver, start_of};
use toolglide_kinematics::{
    Axis, AxisVector, Feedrate, MachineKinematics, OrientationTolerance, PoseEnd, PoseFeed,
    PoseLeg, PoseMove, PosePath, Tolerance, ToolPose, Vector,
};
use toolglide_machines::find;

fn tolerance() -> OrientationTolerance {
    OrientationTolerance::new(0.001).unwrap()
}

/// A move whose tool leans by `tilt` towards `spin`.
fn leaning(x: f64, tilt: f64, spin: f64, feed: PoseFeed) -> PoseMove {
    let tool = Vector::<3>::new(tilt.sin() * spin.cos(), tilt.sin() * spin.sin(), tilt.cos());
    let end = PoseEnd::Pose(ToolPose::new(Vector::<3>::new(x, 0.0, 50.0), tool).unwrap());
    PoseMove::new(end, feed, Tolerance::new(0.05).unwrap()).unwrap()
}

fn cut() -> PoseFeed {
    PoseFeed::Speed(Feedrate::new(50.0).unwrap())
}

fn machine(name: &str) -> (Box<dyn MachineKinematics>, Vec<Axis>) {
    let model = find(name).unwrap();
    let machine = (model.build)(&(model.preset)()).unwrap();
    let axes = machine.axes().to_vec();
    (machine, axes)
}

fn legs(
    machine: &dyn MachineKinematics,
    start: AxisVector,
    moves: &[PoseMove],
) -> Result<Vec<PoseLeg>, FiveAxisError> {
    let mut resolver = Resolver::new(machine, start, tolerance())?;
    moves.iter().map(|next| resolver.leg(next)).collect()
}

/// The axis positions of a planned motion from `start`, which keeps everything: lowest and highest.
fn range_of(
    machine: &dyn MachineKinematics,
    axes: &[Axis],
    start: AxisVector,
    moves: &[PoseMove],
    axis: usize,
) -> [f64; 2] {
    let legs = legs(machine, start, moves).unwrap();
    let settings = settings([0.05, 0.025], PoseMethod::DwellControlled);
    let planned = plan(machine, axes, start, &legs, &settings);
    let report = judge(machine, axes, &legs, &planned);
    assert!(report.passes(), "{:#?}", report.examples);
    [report.axes[axis].lowest, report.axes[axis].highest]
}

#[test]
fn a_path_that_leaves_the_travel_on_one_branch_is_planned_on_the_other() {
    let (machine, axes) = machine("head-table-bc");
    // The head tilts by 30 degrees to one side and by 110 to the other.
    let moves: Vec<PoseMove> = (0..8)
        .map(|step| {
            leaning(
                5.0 * f64::from(step),
                0.2 + 0.1 * f64::from(step),
                PI - 0.1,
                cut(),
            )
        })
        .collect();
    let zero = AxisVector::zeros(5);
    let PoseEnd::Pose(first) = *moves[0].end() else {
        panic!("a pose");
    };
    let nearest = machine.inverse(&first, &zero).unwrap();
    assert!(nearest[3] < 0.0, "the nearest branch is the short one");
    let refused = legs(machine.as_ref(), nearest, &moves).unwrap_err();
    assert!(refused.to_string().contains("axis B"), "{refused}");
    let start = start_of(machine.as_ref(), &moves, &zero, tolerance()).unwrap();
    let [low, high] = range_of(machine.as_ref(), &axes, start, &moves, 3);
    assert!(
        (low - 0.2).abs() < 1e-3 && (high - 0.9).abs() < 1e-3,
        "{low} {high}"
    );
}

#[test]
fn a_path_of_many_turns_starts_where_the_travel_is_long_enough() {
    let (machine, axes) = machine("head-bc");
    // Six hundred degrees, of which C has 360 on either side.
    let moves: Vec<PoseMove> = (0..=60)
        .map(|step| {
            let spin = 10.0_f64.to_radians() * f64::from(step);
            leaning(f64::from(step), 0.5, spin, cut())
        })
        .collect();
    let start = start_of(machine.as_ref(), &moves, &AxisVector::zeros(5), tolerance()).unwrap();
    let [low, high] = range_of(machine.as_ref(), &axes, start, &moves, 4);
    assert!(
        (high - low - 600.0_f64.to_radians()).abs() < 1e-6,
        "{low} {high}"
    );
    assert!(
        legs(machine.as_ref(), AxisVector::zeros(5), &moves).is_err(),
        "from 0"
    );
}

#[test]
fn a_rapid_unwinds_an_axis_that_has_come_to_its_end() {
    let (machine, axes) = machine("head-bc");
    let turn = |from: i32, to: i32| {
        (from..=to).map(|step| {
            let spin = 10.0_f64.to_radians() * f64::from(step);
            leaning(f64::from(step), 0.5, spin, cut())
        })
    };
    let mut moves: Vec<PoseMove> = turn(0, 34).collect();
    moves.push(leaning(40.0, 0.5, 380.0_f64.to_radians(), PoseFeed::Rapid));
    moves.extend(turn(39, 50));
    let PoseEnd::Pose(first) = *moves[0].end() else {
        panic!("a pose");
    };
    let start = machine.inverse(&first, &AxisVector::zeros(5)).unwrap();
    let made = legs(machine.as_ref(), start, &moves).unwrap();
    assert!(matches!(made[35].path, PosePath::Axes { .. }), "the rapid");
    let [low, high] = range_of(machine.as_ref(), &axes, start, &moves, 4);
    assert!(low > -1e-6 && high < 341.0_f64.to_radians(), "{low} {high}");
}

#[test]
fn opposite_orientations_are_named_before_any_travel_unless_an_axis_is_given() {
    let (machine, axes) = machine("head-bc");
    let up = leaning(0.0, 0.3, 0.0, cut());
    let down = leaning(0.0, 0.3 - PI, 0.0, cut());
    let PoseEnd::Pose(first) = *up.end() else {
        panic!("a pose");
    };
    let start = machine.inverse(&first, &AxisVector::zeros(5)).unwrap();
    let refused = legs(machine.as_ref(), start, &[up, down]).unwrap_err();
    assert!(
        matches!(refused, FiveAxisError::Opposite { index: 1, from, to }
            if from.iter().zip(to).all(|(from, to)| (from + to).abs() < 1e-12)),
        "{refused}"
    );
    // On a machine that can turn around, an axis that is given is turned about.
    let free: Vec<Axis> = axes
        .iter()
        .map(|axis| Axis {
            travel: None,
            ..axis.clone()
        })
        .collect();
    let model = find("head-bc").unwrap();
    let mut config = (model.preset)();
    for axis in &mut config.axis {
        axis.travel = None;
    }
    let machine = (model.build)(&config).unwrap();
    let mut resolver = Resolver::new(machine.as_ref(), start, tolerance())
        .unwrap()
        .turning_about(-Vector::<3>::y());
    let legs: Vec<PoseLeg> = [
        up,
        leaning(10.0, 0.3, 0.0, cut()),
        leaning(20.0, 0.3 - PI, 0.0, cut()),
    ]
    .iter()
    .map(|next| resolver.leg(next).unwrap())
    .collect();
    let settings = settings([0.05, 0.025], PoseMethod::PointToPoint);
    let planned = plan(machine.as_ref(), &free, start, &legs, &settings);
    let report = judge(machine.as_ref(), &free, &legs, &planned);
    assert!(report.passes(), "{:#?}", report.examples);
    assert!(
        (report.axes[3].lowest - (0.3 - PI)).abs() < 1e-6,
        "{:?}",
        report.axes[3]
    );
}
