//! Poses, machines and plans that tests share.
#![allow(dead_code, reason = "every test uses a part of it")]
#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot build its case has failed"
)]

use toolglide_fir::FilterChain;
use toolglide_fiveaxis::{PoseMethod, PosePlanner, PoseSettings, Slowdown};
use toolglide_kinematics::{
    Axis, AxisLimits, AxisVector, Feedrate, MachineKinematics, OrientationTolerance, PoseFeed,
    PoseLeg, PosePiece, Tolerance, ToolPose, Vector,
};
use toolglide_machines::find;
use toolglide_verify::{PoseJudge, PoseReport};

/// Table 5.1: tips and orientations of three poses.
pub(crate) const TABLE_5_1: [[f64; 6]; 3] = [
    [0.0, 0.0, 0.0, -0.1302, -0.3906, 0.9113],
    [17.6090, 8.8045, 3.5218, 0.4262, 0.0947, 0.8997],
    [1.8059, 13.1032, 15.0015, -0.1255, 0.3137, 0.9412],
];

/// Table 5.2: the path in the form of a star.
pub(crate) const STAR: [[f64; 6]; 16] = [
    [0.0, 0.0, 0.0, 0.5025, 0.5025, 0.7035],
    [100.0, 0.0, 0.0, -0.5025, 0.5025, 0.7035],
    [100.0, 100.0, 0.0, -0.5025, -0.5025, 0.7035],
    [50.0, 100.0, 10.0, 0.0, -0.3511, 0.9363],
    [40.0, 70.0, 20.0, 0.1562, -0.3123, 0.9370],
    [10.0, 70.0, 10.0, 0.2357, -0.2357, 0.9428],
    [30.0, 45.0, 20.0, 0.3162, 0.0, 0.9487],
    [20.0, 10.0, 10.0, 0.2357, 0.2357, 0.9428],
    [50.0, 30.0, 20.0, 0.0, 0.3162, 0.9487],
    [80.0, 10.0, 10.0, -0.2357, 0.2357, 0.9428],
    [70.0, 45.0, 20.0, -0.3162, 0.0, 0.9487],
    [90.0, 70.0, 10.0, -0.2357, -0.2357, 0.9428],
    [60.0, 70.0, 20.0, -0.1562, -0.3123, 0.9370],
    [50.0, 100.0, 10.0, 0.0, -0.3511, 0.9363],
    [0.0, 100.0, 0.0, 0.5025, -0.5025, 0.7035],
    [0.0, 0.0, 0.0, 0.5025, 0.5025, 0.7035],
];

/// A fan-shaped path of flank milling: Y. Zhang and others, Feedrate blending method for five-axis
/// linear tool path under geometric and kinematic constraints, 2021, table B.1.
pub(crate) const FAN: [[f64; 6]; 25] = [
    [113.5608, 7.7353, -2.2093, -0.1073, 0.6249, 0.7733],
    [117.8649, -10.9501, -0.9741, -0.003, 0.653, 0.7573],
    [115.5029, -34.8088, 0.7796, 0.135, 0.6488, 0.7489],
    [104.086, -55.8401, 2.6826, 0.2639, 0.5968, 0.7578],
    [95.2257, -63.9596, 4.0735, 0.3172, 0.5518, 0.7713],
    [88.8206, -65.9723, 6.0218, 0.3295, 0.5161, 0.7906],
    [80.1628, -65.0964, 7.0315, 0.3268, 0.478, 0.8153],
    [72.4782, -61.1095, 6.8631, 0.3137, 0.4461, 0.8382],
    [65.9858, -54.6664, 6.143, 0.2887, 0.4164, 0.8621],
    [54.252, -39.5681, 4.9312, 0.217, 0.3575, 0.9084],
    [38.039, -23.1115, 3.5361, 0.1295, 0.2618, 0.9564],
    [31.6791, -18.7113, 3.0176, 0.1055, 0.2209, 0.9696],
    [26.1926, -16.7813, 2.4549, 0.0968, 0.1849, 0.978],
    [22.3378, -16.4864, 1.9074, 0.0979, 0.1597, 0.9823],
    [18.7698, -17.9379, 0.2587, 0.1106, 0.1379, 0.9843],
    [17.0042, -21.3334, -1.3755, 0.1335, 0.1275, 0.9828],
    [16.7631, -27.0829, -2.5738, 0.1711, 0.1277, 0.9769],
    [20.0593, -38.2107, -3.5736, 0.239, 0.1533, 0.9588],
    [26.9912, -67.7863, -5.5703, 0.3999, 0.2013, 0.8942],
    [28.0807, -86.648, -6.2051, 0.4879, 0.2082, 0.8477],
    [21.8131, -103.5714, -4.4425, 0.5679, 0.1822, 0.8027],
    [6.1563, -114.1796, -2.0441, 0.6287, 0.0985, 0.7714],
    [-12.6615, -117.9888, -0.8723, 0.6542, -0.0066, 0.7563],
    [-31.8162, -116.324, 0.5145, 0.652, -0.1172, 0.7491],
    [-49.4389, -108.7844, 2.0895, 0.6189, -0.2239, 0.7529],
];

pub(crate) fn pose(row: &[f64; 6]) -> ToolPose {
    let [x, y, z, i, j, k] = *row;
    ToolPose::new(Vector::<3>::new(x, y, z), Vector::<3>::new(i, j, k)).unwrap()
}

pub(crate) fn legs(rows: &[[f64; 6]], speed: f64, tip: f64, orientation: f64) -> Vec<PoseLeg> {
    rows.windows(2)
        .map(|pair| {
            PoseLeg::between(
                &pose(&pair[0]),
                &pose(&pair[1]),
                PoseFeed::Speed(Feedrate::new(speed).unwrap()),
                Tolerance::new(tip).unwrap(),
                OrientationTolerance::new(orientation).unwrap(),
            )
            .unwrap()
        })
        .collect()
}

/// A table-ac machine without offsets, and its axes without ends.
pub(crate) fn table_ac() -> (Box<dyn MachineKinematics>, Vec<Axis>) {
    let model = find("table-ac").unwrap();
    let mut config = (model.preset)();
    for axis in &mut config.axis {
        axis.travel = None;
    }
    for distance in config.geometry.values_mut() {
        *distance = 0.0;
    }
    let machine = (model.build)(&config).unwrap();
    let axes = machine.axes().to_vec();
    (machine, axes)
}

/// The same axes with limits that nothing meets.
pub(crate) fn limitless(axes: &[Axis]) -> Vec<Axis> {
    axes.iter()
        .map(|axis| Axis {
            limits: AxisLimits::new(1e9, 1e12, 1e15).unwrap(),
            ..axis.clone()
        })
        .collect()
}

pub(crate) struct Planned {
    pub(crate) pieces: Vec<PosePiece>,
    pub(crate) slowdowns: Vec<Slowdown>,
    pub(crate) start: AxisVector,
}

pub(crate) fn settings(constants: [f64; 2], method: PoseMethod) -> PoseSettings {
    PoseSettings::new(
        FilterChain::with_time_constants(&constants).unwrap(),
        method,
    )
    .unwrap()
}

/// Axis positions of the start of the first leg.
pub(crate) fn start_of(machine: &dyn MachineKinematics, first: &[f64; 6]) -> AxisVector {
    let near = AxisVector::zeros(machine.axes().len());
    machine.inverse(&pose(first), &near).unwrap()
}

pub(crate) fn plan(
    machine: &dyn MachineKinematics,
    axes: &[Axis],
    start: AxisVector,
    legs: &[PoseLeg],
    settings: &PoseSettings,
) -> Planned {
    let mut planner = PosePlanner::new(machine, axes.to_vec(), start, settings.clone()).unwrap();
    for leg in legs {
        planner.push(leg.clone()).unwrap();
    }
    planner.finish().unwrap();
    let mut pieces = Vec::new();
    while let Some(piece) = planner.pull() {
        pieces.push(piece);
    }
    Planned {
        pieces,
        slowdowns: planner.slowdowns().to_vec(),
        start,
    }
}

pub(crate) fn judge(
    machine: &dyn MachineKinematics,
    axes: &[Axis],
    legs: &[PoseLeg],
    planned: &Planned,
) -> PoseReport {
    let mut judge = PoseJudge::new(machine, axes.to_vec(), &planned.start);
    for leg in legs {
        judge.expect(leg);
    }
    for piece in &planned.pieces {
        judge.observe(piece);
    }
    judge.finish()
}
