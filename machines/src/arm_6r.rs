//! Models an arm of six rotary axes with two parallel ones and a spherical wrist: axes 1 to 6.
//!
//! Source: Brandstötter, Angerer and Hofbaur, *An analytical solution of the inverse kinematics problem of
//! industrial serial manipulators with an ortho-parallel basis and a spherical wrist* (2014), whose
//! lengths a1, a2, b and c1 to c4 the machine file gives. Not here: tools beside the axis of the
//! flange. As the tool lies on axis 6, a tool pose leaves that axis free, and it stays where it is.

use crate::config::{AxisConfig, MachineConfig};
use crate::elbow::Links;
use crate::error::MachineError;
use crate::geometry::{Distance, WORKPIECE};
use crate::registry::MachineModel;
use crate::structure::{Assembly, Branches, Structure};
use crate::swivel::{Swivel, about_y, about_z, back};
use std::f64::consts::PI;
use toolglide_kinematics::{AxisKind, KinematicsError, MachineKinematics, ToolPose, Vector};

/// A wrist nearer to axis 1 than this has no direction about it, mm: the rounding of an arm of some
/// metres.
const NO_DIRECTION: f64 = 1e-12;

const GEOMETRY: [Distance; 11] = [
    Distance::required("a1", "from axis 1 to axis 2, forward"),
    Distance::required(
        "a2",
        "from axis 3 to the forearm, forward with the arm straight up",
    ),
    Distance::required("b", "from axis 1 to the plane of the arm, sideways"),
    Distance::required("c1", "from the base to axis 2, up"),
    Distance::required("c2", "from axis 2 to axis 3").positive(),
    Distance::required("c3", "from axis 3 to the wrist, along the forearm").positive(),
    Distance::required("c4", "from the wrist to the flange"),
    Distance::optional("tool_length", "from the flange to the tool tip"),
    WORKPIECE[0],
    WORKPIECE[1],
    WORKPIECE[2],
];

/// Base, arm and wrist. All joints are at 0 with the arm straight up.
#[derive(Clone, Debug)]
struct Arm {
    /// a1, b and c1: from the base to axis 2, at 0.
    shoulder: Vector<3>,
    /// c2, and the distance from axis 3 to the wrist.
    links: Links,
    /// Angle at axis 3 between the forearm and the line to the wrist.
    bend: f64,
    /// From the wrist to the tool tip.
    hand: f64,
}

impl Arm {
    /// Joints 1 to 3 that bring the wrist to a point of the base frame: facing it, and turned away.
    fn arms(
        &self,
        wrist: Vector<3>,
        near: f64,
    ) -> Result<[Option<[[f64; 3]; 2]>; 2], KinematicsError> {
        let sideways = self.shoulder.y;
        let distance = wrist.x.hypot(wrist.y);
        if distance < sideways.abs() {
            return Err(KinematicsError::Reach {
                part: "the wrist, from axis 1,",
                distance,
                low: sideways.abs(),
                high: f64::INFINITY,
            });
        }
        let forward = ((distance - sideways) * (distance + sideways)).sqrt();
        let to_plane = sideways.atan2(forward);
        let facing = if distance > NO_DIRECTION {
            wrist.y.atan2(wrist.x) - to_plane
        } else {
            near
        };
        let away = facing + 2.0 * to_plane + PI;
        let up = wrist.z - self.shoulder.z;
        let reach = |turn: f64, forward: f64, near: f64| {
            let hand = [up, forward - self.shoulder.x];
            let arms = self
                .links
                .reaching(hand, near, "the arm, from axis 2 to the wrist,")?;
            Ok(arms.map(|[second, third]| [turn, second, third - self.bend]))
        };
        match (reach(facing, forward, near), reach(away, -forward, near)) {
            (Err(refused), Err(_)) => Err(refused),
            (front, behind) => Ok([front.ok(), behind.ok()]),
        }
    }
}

impl Structure<6> for Arm {
    fn tool(&self, joints: &[f64; 6]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        let [first, second, third, fourth, fifth, _] = *joints;
        let [up, forward] = self.links.hand(second, third + self.bend);
        let turn = first.sin_cos();
        let wrist = about_z(turn, self.shoulder + Vector::<3>::new(forward, 0.0, up));
        let forearm = (second + third).sin_cos();
        let along = about_z(
            turn,
            about_y(forearm, Swivel::at(fifth, fourth).direction()),
        );
        Ok((wrist + along * self.hand, -along))
    }

    fn branches(&self, pose: &ToolPose, near: &[f64; 6]) -> Result<Branches<6>, KinematicsError> {
        let along = -pose.orientation();
        let wrist = pose.tip() - along * self.hand;
        let mut branches = Branches::none();
        for [first, second, third] in self.arms(wrist, near[0])?.into_iter().flatten().flatten() {
            let forearm = (second + third).sin_cos();
            let seen = about_y(back(forearm), about_z(back(first.sin_cos()), along));
            for wrist in Swivel::towards(&seen, near[3]) {
                branches.push([first, second, third, wrist.spin, wrist.tilt, near[5]]);
            }
        }
        Ok(branches)
    }
}

fn preset() -> MachineConfig {
    let axis = |name, velocity: f64, low, high| {
        AxisConfig::new(name, velocity, 5.0 * velocity, 100.0 * velocity).with_travel(low, high)
    };
    let mut config = MachineConfig::new(
        "arm-6r",
        "arm-6r",
        vec![
            axis('1', 150.0, -180.0, 180.0),
            axis('2', 150.0, -100.0, 110.0),
            AxisConfig {
                zero: -90.0,
                ..axis('3', 150.0, -170.0, 80.0)
            },
            axis('4', 360.0, -200.0, 200.0),
            axis('5', 360.0, -120.0, 120.0),
            axis('6', 450.0, -400.0, 400.0),
        ],
    );
    config.tolerance_mm = 0.1;
    config.period_s = 0.004;
    for (name, value) in [
        ("a1", 100.0),
        ("a2", -135.0),
        ("b", 0.0),
        ("c1", 615.0),
        ("c2", 705.0),
        ("c3", 755.0),
        ("c4", 85.0),
        ("tool_length", 150.0),
        ("workpiece_x", 900.0),
        ("workpiece_z", 400.0),
    ] {
        config.geometry.insert(name.to_owned(), value);
    }
    config
}

fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    let [a1, a2, b, c1, c2, c3, c4, tool_length, wx, wy, wz] = config.distances(&GEOMETRY)?;
    let structure = Arm {
        shoulder: Vector::<3>::new(a1, b, c1),
        links: Links {
            upper: c2,
            fore: a2.hypot(c3),
        },
        bend: a2.atan2(c3),
        hand: c4 + tool_length,
    };
    let axes = ['1', '2', '3', '4', '5', '6'].map(|letter| (letter, AxisKind::Rotary));
    Assembly::build(structure, [wx, wy, wz], axes, config)
}

/// An industrial arm of six axes.
pub static ARM_6R: MachineModel = MachineModel {
    name: "arm-6r",
    summary: "an industrial arm with a spherical wrist, the tool on axis 6: 1 2 3 4 5 6",
    geometry: &GEOMETRY,
    preset,
    build,
};

inventory::submit!(ARM_6R);
