//! Models two links that turn about upright axes over the workpiece, and a quill: axes A, B and Z.
//!
//! Source: two links in a plane, elbow to either side. Not here: turning the tool about itself, which a
//! tool pose does not ask for.

use crate::config::{AxisConfig, MachineConfig};
use crate::elbow::Links;
use crate::error::MachineError;
use crate::geometry::{Distance, WORKPIECE};
use crate::registry::MachineModel;
use crate::structure::{Assembly, Branches, Structure, upright};
use toolglide_kinematics::{AxisKind, KinematicsError, MachineKinematics, ToolPose, Vector};

/// The axes, in machine order.
const AXES: [(char, AxisKind); 3] = [
    ('A', AxisKind::Rotary),
    ('B', AxisKind::Rotary),
    ('Z', AxisKind::Linear),
];

const GEOMETRY: [Distance; 5] = [
    Distance::required("upper_arm", "from the A axis to the B axis").positive(),
    Distance::required("forearm", "from the B axis to the tool").positive(),
    WORKPIECE[0],
    WORKPIECE[1],
    WORKPIECE[2],
];

/// Two links about upright axes. A counts from X, B from the upper arm.
#[derive(Clone, Debug)]
struct Scara {
    links: Links,
}

impl Structure<3> for Scara {
    fn tool(&self, &[a, b, z]: &[f64; 3]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        let [x, y] = self.links.hand(a, b);
        Ok((Vector::<3>::new(x, y, z), Vector::<3>::z()))
    }

    fn branches(&self, pose: &ToolPose, near: &[f64; 3]) -> Result<Branches<3>, KinematicsError> {
        let tip = upright(pose)?;
        let mut branches = Branches::none();
        for [a, b] in self.links.reaching([tip.x, tip.y], near[0], "the arm")? {
            branches.push([a, b, tip.z]);
        }
        Ok(branches)
    }
}

fn preset() -> MachineConfig {
    let mut config = MachineConfig::new(
        "scara",
        "scara",
        vec![
            AxisConfig::new('A', 360.0, 3_000.0, 100_000.0).with_travel(-140.0, 140.0),
            AxisConfig::new('B', 540.0, 6_000.0, 200_000.0).with_travel(-150.0, 150.0),
            AxisConfig::new('Z', 1_000.0, 10_000.0, 400_000.0).with_travel(-200.0, 0.0),
        ],
    );
    config.geometry.insert("upper_arm".to_owned(), 325.0);
    config.geometry.insert("forearm".to_owned(), 275.0);
    config.geometry.insert("workpiece_x".to_owned(), 350.0);
    config.geometry.insert("workpiece_z".to_owned(), -100.0);
    config
}

fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    let [upper, fore, wx, wy, wz] = config.distances(&GEOMETRY)?;
    let structure = Scara {
        links: Links { upper, fore },
    };
    Assembly::build(structure, [wx, wy, wz], AXES, config)
}

/// An arm of two links that swings over the workpiece, with a quill.
pub static SCARA: MachineModel = MachineModel {
    name: "scara",
    summary: "two links swing over the workpiece, a quill moves the tool: A B Z",
    geometry: &GEOMETRY,
    preset,
    build,
};

inventory::submit!(SCARA);

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::AxisVector;

    #[test]
    fn the_elbow_stays_on_its_side() {
        let machine = build(&preset()).unwrap();
        let pose = ToolPose::upright(Vector::<3>::new(-25.0, 275.0, 90.0)).unwrap();
        let right = std::f64::consts::FRAC_PI_2;
        for b in [0.1, -0.1] {
            let near = AxisVector::from([0.7, b, 0.0]);
            let solutions = machine.solutions(&pose, &near).unwrap();
            assert_eq!(solutions.len(), 2, "{solutions:?}");
            let [a, elbow, z] = solutions[0][..] else {
                panic!("three axes");
            };
            assert!((elbow - right.copysign(b)).abs() < 1e-12, "{solutions:?}");
            assert!((z + 10.0).abs() < 1e-12, "{solutions:?}");
            assert!(b < 0.0 || a.abs() < 1e-12, "along X: {solutions:?}");
        }
    }

    #[test]
    fn a_tool_beyond_the_stretched_arm_is_refused() {
        let machine = build(&preset()).unwrap();
        let pose = ToolPose::upright(Vector::<3>::new(251.5, 0.0, 0.0)).unwrap();
        let refused = machine.inverse(&pose, &AxisVector::zeros(3)).unwrap_err();
        assert!(refused.to_string().ends_with("1.5 mm too far"), "{refused}");
        let tilted = ToolPose::new(Vector::zeros(), Vector::<3>::x()).unwrap();
        assert!(
            machine.inverse(&tilted, &AxisVector::zeros(3)).is_err(),
            "tilted"
        );
    }
}
