//! Set-points of planned pose motion, judged row by row: no worse than the motion itself, and what is spoiled is found.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod common;

use common::{FAN, Planned, STAR, judge, legs, plan, pose, settings, start_of};
use toolglide_fiveaxis::{PoseMethod, PoseSampler};
use toolglide_kinematics::{
    Axis, AxisVector, Feedrate, MachineKinematics, OrientationTolerance, PoseFeed, PoseLeg,
    PosePath, SamplePeriod, Tolerance,
};
use toolglide_machines::find;
use toolglide_verify::PoseReport;
use toolglide_verify::PoseSetPointJudge;

/// A machine of the house whose axes have no ends.
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

/// Set-points: when, and where the axes are.
type Rows = Vec<(f64, AxisVector)>;

/// The set-points of a motion at every millisecond, and at its end.
fn rows(machine: &dyn MachineKinematics, planned: Planned) -> Rows {
    let period = SamplePeriod::new(1e-3).unwrap();
    let mut sampler = PoseSampler::new(machine, period, planned.start);
    let mut rows = Vec::new();
    for piece in planned.pieces {
        sampler.feed(piece);
        while let Some(tick) = sampler.next_tick() {
            let tick = tick.unwrap();
            rows.push((tick.time, tick.axes));
        }
    }
    let last = sampler.last().unwrap().unwrap();
    if last.time > rows[rows.len() - 1].0 + 1e-9 {
        rows.push((last.time, last.axes));
    }
    rows
}

/// A case: poses of a path, its tolerances, and a method.
struct Case<'a> {
    machine: &'a str,
    poses: &'a [[f64; 6]],
    tolerances: [f64; 2],
    method: PoseMethod,
}

impl Case<'_> {
    /// The set-points of the motion that is planned along the path, with what its judge says.
    fn rows(&self) -> (Vec<PoseLeg>, Rows, PoseReport) {
        let (machine, axes) = endless(self.machine);
        let [tip, orientation] = self.tolerances;
        let legs = legs(self.poses, 50.0, tip, orientation);
        let start = start_of(machine.as_ref(), &self.poses[0]);
        let settings = settings([0.05, 0.025], self.method);
        let planned = plan(machine.as_ref(), &axes, start, &legs, &settings);
        let report = judge(machine.as_ref(), &axes, &legs, &planned);
        (legs, rows(machine.as_ref(), planned), report)
    }

    fn judged(&self, legs: &[PoseLeg], rows: &Rows) -> PoseReport {
        let (machine, axes) = endless(self.machine);
        let rounding = vec![1e-12; axes.len()];
        let mut judge = PoseSetPointJudge::new(machine.as_ref(), axes, &rounding);
        for leg in legs {
            judge.expect(leg);
        }
        for (time, at) in rows {
            judge.observe(*time, at).unwrap();
        }
        judge.finish()
    }

    /// Judges the set-points as they were planned, and compares with what the judge of the motion says.
    fn agrees(&self, what: &str) {
        let (legs, rows, planned) = self.rows();
        assert!(planned.passes(), "{what}: {:#?}", planned.examples);
        let judged = self.judged(&legs, &rows);
        assert!(judged.passes(), "{what}: {:#?}", judged.examples);
        let shares = |report: &PoseReport| {
            [
                report.tip_ratio.value,
                report.tip_corner_ratio.value,
                report.orientation_ratio.value,
                report.orientation_corner_ratio.value,
            ]
        };
        for (found, planned) in shares(&judged).into_iter().zip(shares(&planned)) {
            assert!(
                found <= 1.0001 * planned + 1e-5,
                "{what}: {found} of a tolerance, but {planned} was planned"
            );
        }
        for (found, planned) in judged.axes.iter().zip(&planned.axes) {
            let jerks = [found.jerk.value, planned.jerk.value];
            assert!(jerks[0] <= 1.001 * jerks[1] + 0.1, "{what}: {jerks:?}");
        }
    }
}

const METHODS: [PoseMethod; 3] = [
    PoseMethod::PointToPoint,
    PoseMethod::DwellControlled,
    PoseMethod::VelocityControlled,
];

/// Poses that go to and fro by some millimetres while the tool stands still.
fn to_and_fro() -> Vec<[f64; 6]> {
    let mut number = 0.0_f64;
    std::iter::repeat_with(|| {
        number += 1.0;
        [
            (2.3 * number).sin(),
            (3.1 * number).cos(),
            30.0 + 0.5 * (1.7 * number).sin(),
            0.1,
            -0.2,
            0.95_f64.sqrt(),
        ]
    })
    .take(25)
    .collect()
}

/// Poses on a circle, close together, whose tool nods now and then.
fn nodding() -> Vec<[f64; 6]> {
    let mut number = 0.0_f64;
    std::iter::repeat_with(|| {
        number += 1.0;
        let nod = 0.2 + 0.05 * ((0.4 * number).sin() * 3.0).tanh();
        let around = 0.02 * number;
        [
            20.0 * around.cos(),
            20.0 * around.sin(),
            30.0,
            nod,
            0.0,
            (1.0 - nod * nod).sqrt(),
        ]
    })
    .take(120)
    .collect()
}

#[test]
fn set_points_are_judged_no_worse_than_their_plan() {
    let (to_and_fro, nodding) = (to_and_fro(), nodding());
    let paths: [(&str, &[[f64; 6]]); 4] = [
        ("star", &STAR),
        ("fan", &FAN),
        ("to and fro", &to_and_fro),
        ("nodding", &nodding),
    ];
    for (name, poses) in paths {
        for tolerances in [[0.01, 0.001], [0.3, 0.0005], [5.0, 0.05]] {
            for method in METHODS {
                let case = Case {
                    machine: "table-ac",
                    poses,
                    tolerances,
                    method,
                };
                case.agrees(&format!("{name} {tolerances:?} {method:?}"));
            }
        }
    }
}

#[test]
fn what_rounding_of_an_orientation_does_beside_the_pole_is_no_jerk() {
    // In its first milliseconds the tool is so near to the pole that C turns by rounding.
    let leaning = |lean: f64| {
        let up = (1.0 - lean * lean).sqrt();
        [0.0, 0.0, 30.0, 0.6 * lean, 0.8 * lean, up]
    };
    let (most, lasts) = (1e-4, 0.5);
    let case = Case {
        machine: "head-table-bc",
        poses: &[leaning(0.0), leaning(most)],
        tolerances: [0.01, 1e-6],
        method: PoseMethod::PointToPoint,
    };
    let legs = legs(case.poses, 50.0, 0.01, 1e-6);
    let (machine, _) = endless(case.machine);
    let mut near = start_of(machine.as_ref(), &leaning(1e-6));
    let rows: Rows = (0..=500_u32)
        .map(|tick| {
            let time = 1e-3 * f64::from(tick);
            let share = time / lasts;
            let gone = share.powi(3) * (10.0 - 15.0 * share + 6.0 * share * share);
            near = machine.follow(&pose(&leaning(most * gone)), &near).unwrap();
            (time, near)
        })
        .collect();
    let report = case.judged(&legs, &rows);
    assert!(report.passes(), "{:#?}", report.examples);
}

#[test]
fn an_axis_goes_on_at_the_pole_from_where_its_own_move_has_ended() {
    let (machine, axes) = endless("table-bc");
    let tolerances = (
        Tolerance::new(0.01).unwrap(),
        OrientationTolerance::new(1e-3).unwrap(),
    );
    let at = |x: f64, c: f64| AxisVector::from([x, 0.0, 0.0, 0.0, c]);
    let (start, turned) = (at(5.0, 0.0), at(5.0, 0.4));
    let poses = [turned, at(6.0, 0.4)].map(|axes| machine.forward(&axes).unwrap());
    let turn = PoseLeg {
        path: PosePath::Axes { start, end: turned },
        feed: PoseFeed::Rapid,
        tip_tolerance: tolerances.0,
        orientation_tolerance: tolerances.1,
        stop: false,
        line: 0,
    };
    let feed = PoseFeed::Speed(Feedrate::new(50.0).unwrap());
    let [from, to] = &poses;
    let go = PoseLeg::between(from, to, feed, tolerances.0, tolerances.1).unwrap();
    let settings = settings([0.05, 0.025], PoseMethod::DwellControlled);
    let planned = plan(machine.as_ref(), &axes, start, &[turn, go], &settings);
    let rows = rows(machine.as_ref(), planned);
    let c = rows[rows.len() - 1].1[4];
    assert!((c - 0.4).abs() < 1e-12, "C ends at {c} rad");
}

/// The star on a table, with room at its corners.
fn star() -> Case<'static> {
    Case {
        machine: "table-ac",
        poses: &STAR,
        tolerances: [0.2, 0.002],
        method: PoseMethod::DwellControlled,
    }
}

fn tells(report: &PoseReport, words: &str) -> bool {
    report
        .examples
        .iter()
        .any(|violation| violation.to_string().contains(words))
}

#[test]
fn a_tip_beside_its_path_is_found_and_followed_on() {
    let (legs, mut rows, _) = star().rows();
    let middle = rows.len() / 2;
    for (_, at) in &mut rows[middle..middle + 40] {
        at[2] += 0.5;
    }
    let report = star().judged(&legs, &rows);
    assert!(tells(&report, "mm from the path"), "{:#?}", report.examples);
    let beside = report.violations;
    assert!(
        (30..=80).contains(&beside),
        "{beside} are wrong, limits of the jump among them"
    );
    assert!(!tells(&report, "from the corner"), "{:#?}", report.examples);
    assert!(
        (0.4..=0.5).contains(&report.tip_deviation.value),
        "{} mm",
        report.tip_deviation.value
    );
}

#[test]
fn a_tool_turned_away_from_its_path_is_found() {
    let (legs, mut rows, _) = star().rows();
    let middle = rows.len() / 2;
    for (_, at) in &mut rows[middle..middle + 40] {
        at[3] += 0.01;
    }
    let report = star().judged(&legs, &rows);
    assert!(
        tells(&report, "rad away from the path"),
        "{:#?}",
        report.examples
    );
}

#[test]
fn corners_that_are_left_out_are_found() {
    let (_, rows, _) = star().rows();
    let mut poses = STAR.to_vec();
    poses.insert(6, [10.0, 70.0, 11.0, 0.2357, -0.2357, 0.9428]);
    poses.insert(7, STAR[5]);
    let [tip, orientation] = star().tolerances;
    let legs = legs(&poses, 50.0, tip, orientation);
    let report = star().judged(&legs, &rows);
    assert_eq!(report.violations, 1, "{:#?}", report.examples);
    assert!(tells(&report, "(move 5"), "{:#?}", report.examples);
    assert!(
        (report.tip_corner.value - 1.0).abs() < 0.2,
        "{} mm",
        report.tip_corner.value
    );
}

#[test]
fn rows_that_end_early_miss_the_end() {
    let (legs, mut rows, _) = star().rows();
    rows.truncate(rows.len() - 300);
    let report = star().judged(&legs, &rows);
    assert!(tells(&report, "no stop"), "{:#?}", report.examples);
    assert!(tells(&report, "from the corner"), "{:#?}", report.examples);
}
