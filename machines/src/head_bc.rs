//! Models a portal machine with a fork head: C turns the fork, B tilts the spindle; axes X, Y, Z, B
//! and C.
//!
//! Source: section 5.2 turned around, P + w = q + Rz(C)·(b + Ry(B)·(0, 0, -pivot)) and
//! O = Rz(C)·Ry(B)·e_z. Not here: signs, zeros, turns and travel, which [`Assembly`] adds.

use crate::config::{AxisConfig, MachineConfig};
use crate::error::MachineError;
use crate::geometry::{Distance, WORKPIECE};
use crate::registry::MachineModel;
use crate::structure::{Assembly, Branches, Structure};
use crate::swivel::{Swivel, about_y, about_z, axes, pole};
use toolglide_kinematics::{KinematicsError, MachineKinematics, ToolPose, Vector};

const GEOMETRY: [Distance; 6] = [
    Distance::required("pivot", "from the B axis to the tool tip").positive(),
    Distance::required(
        "b_axis_x",
        "from the C axis to the B axis at C = 0, along X",
    ),
    Distance::required(
        "spindle_y",
        "from the C axis to the spindle at C = 0, along Y",
    ),
    WORKPIECE[0],
    WORKPIECE[1],
    WORKPIECE[2],
];

/// A fork head.
#[derive(Clone, Debug)]
struct HeadBc {
    /// From the C axis to the spindle at the height of the B axis, at C = 0.
    offset: Vector<3>,
    pivot: f64,
}

impl HeadBc {
    /// From where the tip is at B = C = 0 to where it is when the head has turned. Linear axes are
    /// 0 where an upright tool has its tip in machine zero.
    fn swing(&self, swivel: &Swivel) -> Vector<3> {
        let hanging = Vector::<3>::new(0.0, 0.0, -self.pivot);
        let turned = about_z(swivel.spun, self.offset + about_y(swivel.tilted, hanging));
        turned - (self.offset + hanging)
    }
}

impl Structure<5> for HeadBc {
    fn tool(&self, joints: &[f64; 5]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        let [x, y, z, b, c] = *joints;
        let swivel = Swivel::at(b, c);
        Ok((
            Vector::<3>::new(x, y, z) + self.swing(&swivel),
            swivel.direction(),
        ))
    }

    fn branches(&self, pose: &ToolPose, near: &[f64; 5]) -> Result<Branches<5>, KinematicsError> {
        let mut branches = Branches::none();
        for swivel in Swivel::towards(&pose.orientation(), near[4]) {
            let slide = pose.tip() - self.swing(&swivel);
            branches.push([slide.x, slide.y, slide.z, swivel.tilt, swivel.spin]);
        }
        Ok(branches)
    }

    fn pole(&self, orientation: &Vector<3>) -> Option<Vector<3>> {
        pole(orientation)
    }
}

fn preset() -> MachineConfig {
    let mut config = MachineConfig::new(
        "head-bc",
        "head-bc",
        vec![
            AxisConfig::new('X', 600.0, 3_000.0, 150_000.0).with_travel(-1_500.0, 1_500.0),
            AxisConfig::new('Y', 600.0, 3_000.0, 150_000.0).with_travel(-1_000.0, 1_000.0),
            AxisConfig::new('Z', 500.0, 3_000.0, 150_000.0).with_travel(-300.0, 700.0),
            AxisConfig::new('B', 180.0, 1_200.0, 50_000.0).with_travel(-110.0, 110.0),
            AxisConfig::new('C', 180.0, 1_200.0, 50_000.0).with_travel(-360.0, 360.0),
        ],
    );
    for (name, value) in [("pivot", 250.0), ("b_axis_x", 0.0), ("spindle_y", 0.0)] {
        config.geometry.insert(name.to_owned(), value);
    }
    config
}

fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    let [pivot, x, y, wx, wy, wz] = config.distances(&GEOMETRY)?;
    let structure = HeadBc {
        offset: Vector::<3>::new(x, y, 0.0),
        pivot,
    };
    Assembly::build(structure, [wx, wy, wz], axes('B'), config)
}

/// A fork head that turns about Z and tilts the tool about Y.
pub static HEAD_BC: MachineModel = MachineModel {
    name: "head-bc",
    summary: "a fork head turns about Z and tilts the tool about Y: X Y Z B C",
    geometry: &GEOMETRY,
    preset,
    build,
};

inventory::submit!(HEAD_BC);

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::AxisVector;

    fn machine() -> Box<dyn MachineKinematics> {
        let mut config = preset();
        config.geometry.insert("b_axis_x".to_owned(), 20.0);
        config.geometry.insert("workpiece_z".to_owned(), -40.0);
        build(&config).unwrap()
    }

    #[test]
    fn an_upright_head_goes_where_its_linear_axes_go() {
        let axes = AxisVector::from([1.0, 2.0, 3.0, 0.0, 0.0]);
        let pose = machine().forward(&axes).unwrap();
        let wanted = Vector::<3>::new(1.0, 2.0, 43.0);
        assert!((pose.tip() - wanted).norm() < 1e-12, "{pose:?}");
        assert!(
            (pose.orientation() - Vector::<3>::z()).norm() < 1e-15,
            "{pose:?}"
        );
    }

    #[test]
    fn a_level_tool_lies_beside_its_pivot() {
        // At B = 90 degrees the tool points along X, so its tip is 250 mm on the other side.
        let quarter = std::f64::consts::FRAC_PI_2;
        for (c, tip, orientation) in [
            (0.0, [-250.0, 0.0, 290.0], [1.0, 0.0, 0.0]),
            (quarter, [-20.0, -230.0, 290.0], [0.0, 1.0, 0.0]),
        ] {
            let axes = AxisVector::from([0.0, 0.0, 0.0, quarter, c]);
            let pose = machine().forward(&axes).unwrap();
            assert!((pose.tip() - Vector::from(tip)).norm() < 1e-12, "{pose:?}");
            let miss = pose.orientation() - Vector::from(orientation);
            assert!(miss.norm() < 1e-15, "{pose:?}");
        }
    }

    #[test]
    fn both_branches_are_found_and_the_pivot_must_be_one() {
        let orientation = Vector::<3>::new(0.6, 0.0, 0.8);
        let pose = ToolPose::new(Vector::zeros(), orientation).unwrap();
        let tilt = 0.6_f64.asin();
        let near = AxisVector::from([0.0, 0.0, 0.0, -tilt, 3.0]);
        let solutions = machine().solutions(&pose, &near).unwrap();
        assert_eq!(solutions.len(), 2, "{solutions:?}");
        assert!((solutions[0][3] + tilt).abs() < 1e-15, "{solutions:?}");
        assert!((solutions[1][3] - tilt).abs() < 1e-15, "{solutions:?}");
        for pivot in [0.0, -250.0, f64::NAN] {
            let mut config = preset();
            config.geometry.insert("pivot".to_owned(), pivot);
            assert!(
                matches!(build(&config), Err(MachineError::Field { .. })),
                "{pivot}"
            );
        }
    }
}
