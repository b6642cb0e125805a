//! Words of rotary axes with words of the tool tip: the axes go evenly to the very angles that are written, the tip keeps its
//! line, and the tool swings as the axes do.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{Planned, judge, plan, settings};
use proptest::prelude::*;
use std::f64::consts::TAU;
use toolglide_fiveaxis::{FiveAxisError, PoseMethod, PoseSettings, Resolver};
use toolglide_kinematics::{
    AxisVector, Feedrate, KinematicsError, MachineKinematics, OrientationTolerance, PoseEnd,
    PoseFeed, PoseLeg, PoseMove, PosePath, PosePiece, SamplePeriod, Tolerance, Vector,
};
use toolglide_machines::find;
use toolglide_verify::PoseReport;
use toolglide_verify::PoseSetPointJudge;

const METHODS: [PoseMethod; 3] = [
    PoseMethod::PointToPoint,
    PoseMethod::DwellControlled,
    PoseMethod::VelocityControlled,
];

const WITHIN: f64 = 0.001;

fn machine(name: &str) -> Box<dyn MachineKinematics> {
    let model = find(name).unwrap();
    (model.build)(&(model.preset)()).unwrap()
}

/// Words X Y Z A B C, mm and degrees, at 20 mm/s.
fn words(row: [f64; 6], great_circle: bool) -> PoseMove {
    let [x, y, z, a, b, c] = row;
    let end = PoseEnd::Axes {
        linear: Vector::<3>::new(x, y, z),
        rotary: [a, b, c].map(f64::to_radians),
        tip: true,
        great_circle,
    };
    let feed = PoseFeed::Speed(Feedrate::new(20.0).unwrap());
    PoseMove::new(end, feed, Tolerance::new(0.02).unwrap()).unwrap()
}

fn legs(
    machine: &dyn MachineKinematics,
    rows: &[[f64; 6]],
    great_circle: bool,
) -> (AxisVector, Vec<PoseLeg>) {
    let within = OrientationTolerance::new(WITHIN).unwrap();
    let near = AxisVector::zeros(machine.axes().len());
    let mut resolver = Resolver::new(machine, near, within).unwrap();
    let mut rapid = words(rows[0], false);
    rapid = PoseMove::new(*rapid.end(), PoseFeed::Rapid, rapid.tolerance()).unwrap();
    resolver.leg(&rapid).unwrap();
    let start = machine
        .place(&resolver.pose().tip(), &turned(machine, rows[0]))
        .unwrap();
    let rest = rows[1..]
        .iter()
        .map(|row| resolver.leg(&words(*row, great_circle)).unwrap());
    (start, rest.collect())
}

fn turned(machine: &dyn MachineKinematics, row: [f64; 6]) -> AxisVector {
    let mut at = AxisVector::zeros(machine.axes().len());
    for (at, axis) in at.iter_mut().zip(machine.axes()) {
        if let Some(word) = ['A', 'B', 'C']
            .iter()
            .position(|letter| *letter == axis.name)
        {
            *at = row[3 + word].to_radians();
        }
    }
    at
}

fn planned(
    name: &str,
    rows: &[[f64; 6]],
    method: PoseMethod,
) -> (Vec<PoseLeg>, Planned, PoseReport) {
    let machine = machine(name);
    let (start, legs) = legs(machine.as_ref(), rows, false);
    let settings = settings([0.05, 0.025], method);
    let planned = plan(machine.as_ref(), machine.axes(), start, &legs, &settings);
    let report = judge(machine.as_ref(), machine.axes(), &legs, &planned);
    (legs, planned, report)
}

#[test]
fn c_turns_once_and_once_more_while_a_stands_and_the_tip_keeps_its_line() {
    let rows = [
        [20.0, 0.0, 0.0, -45.0, 0.0, 0.0],
        [40.0, 0.0, 0.0, -45.0, 0.0, 360.0],
        [40.0, 5.0, 0.0, -45.0, 0.0, 720.0],
    ];
    for method in METHODS {
        let (legs, planned, report) = planned("table-ac", &rows, method);
        assert!(report.passes(), "{method:?}: {:#?}", report.examples);
        let swept = 45.0_f64.to_radians().sin() * TAU;
        assert!(
            (legs[0].angle() - swept).abs() < 1e-4 * swept,
            "{}",
            legs[0].angle()
        );
        assert!(
            (report.axes[4].highest - 2.0 * TAU).abs() < 1e-9,
            "{method:?}: C"
        );
        assert!(
            report.axes[3].highest - report.axes[3].lowest < 1e-9,
            "{method:?}: A"
        );
        let Some(PosePiece::Rotary(last)) = planned.pieces.last() else {
            panic!("{method:?}: motion with the rotary axes");
        };
        assert!(
            (last.end[4] - 2.0 * TAU).abs() < 1e-12,
            "{method:?}: {:?}",
            last.end
        );
    }
}

#[test]
fn a_tool_that_swings_with_the_axes_is_off_the_great_circle_and_the_judge_tells_them_apart() {
    let rows = |turn: f64| {
        [
            [20.0, 0.0, 0.0, 30.0, 0.0, 0.0],
            [40.0, 0.0, 0.0, 30.0, 0.0, turn],
        ]
    };
    let machine = machine("table-ac");
    // At A = 30 degrees the small circle leaves the great one by 1.06 mrad for 8 degrees of C, by 4 for 15.5.
    for (turn, kept) in [(7.0, true), (8.5, false), (15.5, false)] {
        let (start, by_axes) = legs(machine.as_ref(), &rows(turn), false);
        let (_, by_circle) = legs(machine.as_ref(), &rows(turn), true);
        assert!(
            matches!(by_circle[0].path, PosePath::Tool { .. }),
            "great circle"
        );
        let settings = settings([0.05, 0.025], PoseMethod::DwellControlled);
        for (moved, asked) in [(&by_axes, &by_circle), (&by_circle, &by_axes)] {
            let planned = plan(machine.as_ref(), machine.axes(), start, moved, &settings);
            let own = judge(machine.as_ref(), machine.axes(), moved, &planned);
            assert!(own.passes(), "{turn}: {:#?}", own.examples);
            let other = judge(machine.as_ref(), machine.axes(), asked, &planned);
            if matches!(asked[0].path, PosePath::Tool { .. }) {
                assert_eq!(other.passes(), kept, "{turn}: {:#?}", other.examples);
            }
        }
    }
}

#[test]
fn corners_of_rotary_axes_use_the_tolerance_that_they_have() {
    let rows = [
        [20.0, 0.0, 0.0, -45.0, 0.0, 0.0],
        [20.5, 0.0, 0.0, -45.0, 0.0, 20.0],
        [21.0, 0.0, 0.0, -25.0, 0.0, 20.0],
        [21.5, 0.0, 0.0, -25.0, 0.0, 0.0],
    ];
    let (_, _, resting) = planned("table-ac", &rows, PoseMethod::PointToPoint);
    let (_, _, passing) = planned("table-ac", &rows, PoseMethod::DwellControlled);
    assert!(
        resting.passes() && passing.passes(),
        "{:#?}",
        passing.examples
    );
    assert!(
        passing.cycle_time < resting.cycle_time - 0.03,
        "{} s, and {} s from rest to rest",
        passing.cycle_time,
        resting.cycle_time
    );
    let used = passing.orientation_corner_ratio.value;
    assert!((0.9..=1.0).contains(&used), "{used} of the tolerance");
}

#[test]
fn axes_pass_the_pole_like_any_other_place() {
    let over = [
        [0.0, 0.0, 0.0, -20.0, 0.0, 30.0],
        [20.0, 0.0, 0.0, 20.0, 0.0, 30.0],
    ];
    let beside = [
        [0.0, 0.0, 0.0, 5.0, 0.0, 30.0],
        [20.0, 0.0, 0.0, 45.0, 0.0, 30.0],
    ];
    for method in METHODS {
        let (_, _, over) = planned("table-ac", &over, method);
        let (_, _, beside) = planned("table-ac", &beside, method);
        assert!(over.passes(), "{method:?}: {:#?}", over.examples);
        assert!(
            over.cycle_time < beside.cycle_time * 1.05,
            "{method:?}: {} s",
            over.cycle_time
        );
    }
}

#[test]
fn words_beyond_the_travel_of_an_axis_are_refused_with_the_axis_and_its_ends() {
    let machine = machine("table-ac");
    let within = OrientationTolerance::new(WITHIN).unwrap();
    let start = AxisVector::zeros(5);
    let mut resolver = Resolver::new(machine.as_ref(), start, within).unwrap();
    let refused = resolver
        .leg(&words([0.0, 0.0, 0.0, 130.0, 0.0, 0.0], false))
        .unwrap_err();
    assert!(
        matches!(
            refused,
            FiveAxisError::Machine {
                index: 0,
                reason: KinematicsError::Travel { axis: 'A', .. }
            }
        ),
        "{refused}"
    );
}

/// Set-points of a plan, with `shift` added to C.
fn told(
    machine: &dyn MachineKinematics,
    legs: &[PoseLeg],
    planned: &Planned,
    shift: impl Fn(f64) -> f64,
) -> PoseReport {
    let period = SamplePeriod::new(0.001).unwrap();
    let mut sampler = toolglide_fiveaxis::PoseSampler::new(machine, period, planned.start);
    let mut judge = PoseSetPointJudge::new(machine, machine.axes().to_vec(), &[1e-9; 5]);
    for leg in legs {
        judge.expect(leg);
    }
    let mut row = |time: f64, mut axes: AxisVector| {
        axes[4] += shift(time);
        judge.observe(time, &axes).unwrap();
    };
    for piece in &planned.pieces {
        sampler.feed(piece.clone());
        while let Some(tick) = sampler.next_tick() {
            let tick = tick.unwrap();
            row(tick.time, tick.axes);
        }
    }
    let last = sampler.last().unwrap().unwrap();
    row(last.time + 1e-6, last.axes);
    judge.finish()
}

#[test]
fn set_points_are_followed_along_the_way_of_the_axes() {
    let rows = [
        [20.0, 0.0, 0.0, -45.0, 0.0, 0.0],
        [40.0, 0.0, 0.0, -45.0, 0.0, 200.0],
        [45.0, 9.0, 0.0, -30.0, 0.0, 360.0],
    ];
    let machine = machine("table-ac");
    for method in METHODS {
        let (legs, planned, _) = planned("table-ac", &rows, method);
        let report = told(machine.as_ref(), &legs, &planned, |_| 0.0);
        assert!(report.passes(), "{method:?}: {:#?}", report.examples);
    }
    let (legs, planned, report) = planned("table-ac", &rows, PoseMethod::DwellControlled);
    let lasts = report.cycle_time;
    // C leans 3 mrad away from its way in the middle, which swings the tool by 2.1.
    let report = told(machine.as_ref(), &legs, &planned, |time| {
        0.003 * (std::f64::consts::PI * time / lasts).sin().powi(4)
    });
    assert!(
        !report.passes(),
        "a tool that swings away from its way passes"
    );
}

fn chains() -> impl Strategy<Value = (Vec<[f64; 5]>, f64, f64, f64)> {
    let length = prop_oneof![Just(0.0), 0.01..1.0_f64, 1.0..30.0_f64];
    let angle = || prop_oneof![Just(0.0), -1.0..1.0_f64, -30.0..30.0_f64];
    let step = (length, 0.0..TAU, angle(), angle());
    (
        prop::collection::vec(step, 2..10),
        5.0..200.0_f64,
        0.002..0.1_f64,
        0.0001..0.01_f64,
    )
        .prop_map(|(steps, speed, tip, tool)| {
            let mut at = [0.0; 5];
            let mut rows = Vec::new();
            for (length, heading, tilt, spin) in steps {
                at[0] += length * heading.cos();
                at[1] += length * heading.sin();
                at[2] += 0.2 * length * (2.0 * heading).cos();
                at[3] = (at[3] + tilt).clamp(-40.0, 40.0);
                at[4] += spin;
                rows.push(at);
            }
            (rows, speed, tip, tool)
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn rotary_words_are_legal_and_never_slower_than_from_rest_to_rest(
        (rows, speed, tip, tool) in chains(),
        name in prop::sample::select(vec!["table-ac", "table-bc", "head-bc", "head-table-bc"]),
        chosen in any::<bool>(),
    ) {
        let machine = machine(name);
        let within = OrientationTolerance::new(tool).unwrap();
        let start = machine.place(&Vector::zeros(), &AxisVector::zeros(5)).unwrap();
        let mut resolver = Resolver::new(machine.as_ref(), start, within).unwrap();
        let tilting = if name == "table-ac" { 3 } else { 4 };
        let mut legs = Vec::new();
        for [x, y, z, tilt, spin] in rows {
            let mut row = [x, y, z, 0.0, 0.0, spin];
            row[tilting] = tilt;
            let next = words(row, false);
            let turn = PoseFeed::Duration(0.3);
            let feed = if (resolver.pose().tip() - Vector::<3>::new(x, y, z)).norm() > 0.0 {
                PoseFeed::Speed(Feedrate::new(speed).unwrap())
            } else {
                turn
            };
            let next = PoseMove::new(*next.end(), feed, Tolerance::new(tip).unwrap()).unwrap();
            match resolver.leg(&next) {
                Ok(leg) => legs.push(leg),
                Err(_) => return Ok(()),
            }
        }
        let mut resting = f64::INFINITY;
        for method in METHODS {
            let mut settings: PoseSettings = settings([0.05, 0.025], method);
            if chosen {
                settings = settings.choosing_filters(SamplePeriod::new(0.001).unwrap());
            }
            let planned = plan(machine.as_ref(), machine.axes(), start, &legs, &settings);
            let report = judge(machine.as_ref(), machine.axes(), &legs, &planned);
            prop_assert!(report.passes(), "{name} {method:?}: {:#?}", report.examples);
            if method == PoseMethod::PointToPoint {
                resting = report.cycle_time;
            }
            prop_assert!(report.cycle_time <= resting * (1.0 + 1e-9), "{name} {method:?}");
        }
    }
}
