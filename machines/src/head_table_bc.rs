//! Models a machine whose head tilts the tool about Y and whose table turns the workpiece about Z:
//! axes X, Y, Z, B and C.
//!
//! Source: section 5.2 shared out, c0 + Rz(C)·(P + w) = q + Ry(B)·(0, 0, -pivot) and
//! Rz(C)·O = Ry(B)·e_z. Not here: signs, zeros, turns and travel, which [`Assembly`] adds.

use crate::config::{AxisConfig, MachineConfig};
use crate::error::MachineError;
use crate::geometry::{Distance, WORKPIECE_ON_TABLE};
use crate::registry::MachineModel;
use crate::structure::{Assembly, Branches, Structure};
use crate::swivel::{Swivel, about_y, about_z, axes, back, pole};
use toolglide_kinematics::{KinematicsError, MachineKinematics, ToolPose, Vector};

const GEOMETRY: [Distance; 7] = [
    Distance::required("pivot", "from the B axis to the tool tip").positive(),
    Distance::required("c_axis_x", "from machine zero to the C axis, along X"),
    Distance::required("c_axis_y", "from machine zero to the C axis, along Y"),
    Distance::required("c_axis_z", "from machine zero to the table face, along Z"),
    WORKPIECE_ON_TABLE[0],
    WORKPIECE_ON_TABLE[1],
    WORKPIECE_ON_TABLE[2],
];

/// A tilting head over a rotary table.
#[derive(Clone, Debug)]
struct HeadTableBc {
    /// The center of the table, in machine coordinates.
    center: Vector<3>,
    pivot: f64,
}

impl HeadTableBc {
    /// From where the tip is at B = 0 to where it is when the head has tilted. Linear axes are 0
    /// where an upright tool has its tip in machine zero.
    fn swing(&self, tilt: (f64, f64)) -> Vector<3> {
        let hanging = Vector::<3>::new(0.0, 0.0, -self.pivot);
        about_y(tilt, hanging) - hanging
    }

    /// The swivel direction of a tool orientation: O = (sB·cC, -sB·sC, cB).
    fn swivel(orientation: Vector<3>) -> Vector<3> {
        Vector::<3>::new(orientation.x, -orientation.y, orientation.z)
    }
}

impl Structure<5> for HeadTableBc {
    fn tool(&self, joints: &[f64; 5]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        let [x, y, z, b, c] = *joints;
        let swivel = Swivel::at(b, c);
        let on_machine = Vector::<3>::new(x, y, z) + self.swing(swivel.tilted);
        Ok((
            about_z(back(swivel.spun), on_machine - self.center),
            Self::swivel(swivel.direction()),
        ))
    }

    fn branches(&self, pose: &ToolPose, near: &[f64; 5]) -> Result<Branches<5>, KinematicsError> {
        let mut branches = Branches::none();
        for swivel in Swivel::towards(&Self::swivel(pose.orientation()), near[4]) {
            let on_machine = self.center + about_z(swivel.spun, pose.tip());
            let slide = on_machine - self.swing(swivel.tilted);
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
        "head-table-bc",
        "head-table-bc",
        vec![
            AxisConfig::new('X', 700.0, 4_000.0, 200_000.0).with_travel(-800.0, 800.0),
            AxisConfig::new('Y', 700.0, 4_000.0, 200_000.0).with_travel(-500.0, 500.0),
            AxisConfig::new('Z', 700.0, 4_000.0, 200_000.0).with_travel(-300.0, 600.0),
            AxisConfig::new('B', 180.0, 1_500.0, 60_000.0).with_travel(-30.0, 110.0),
            AxisConfig::new('C', 300.0, 2_000.0, 80_000.0),
        ],
    );
    for (name, value) in [
        ("pivot", 220.0),
        ("c_axis_x", 0.0),
        ("c_axis_y", 0.0),
        ("c_axis_z", 0.0),
    ] {
        config.geometry.insert(name.to_owned(), value);
    }
    config
}

fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    let [pivot, cx, cy, cz, wx, wy, wz] = config.distances(&GEOMETRY)?;
    let structure = HeadTableBc {
        center: Vector::<3>::new(cx, cy, cz),
        pivot,
    };
    Assembly::build(structure, [wx, wy, wz], axes('B'), config)
}

/// A head that tilts about Y over a table that turns about Z.
pub static HEAD_TABLE_BC: MachineModel = MachineModel {
    name: "head-table-bc",
    summary: "the head tilts the tool about Y, the table turns about Z: X Y Z B C",
    geometry: &GEOMETRY,
    preset,
    build,
};

inventory::submit!(HEAD_TABLE_BC);

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::AxisVector;

    #[test]
    fn the_table_turns_the_workpiece_and_the_head_tilts_the_tool() {
        let mut config = preset();
        config.geometry.insert("c_axis_x".to_owned(), 100.0);
        let machine = build(&config).unwrap();
        let quarter = std::f64::consts::FRAC_PI_2;
        // The workpiece has turned by a quarter, so that machine X is its -Y.
        let axes = AxisVector::from([100.0, 0.0, 0.0, quarter, quarter]);
        let pose = machine.forward(&axes).unwrap();
        let tip = Vector::<3>::new(0.0, 220.0, 220.0);
        assert!((pose.tip() - tip).norm() < 1e-12, "{pose:?}");
        let orientation = Vector::<3>::new(0.0, -1.0, 0.0);
        assert!(
            (pose.orientation() - orientation).norm() < 1e-15,
            "{pose:?}"
        );
    }

    #[test]
    fn a_branch_that_leaves_the_travel_of_the_head_is_no_solution() {
        let machine = build(&preset()).unwrap();
        let pose = ToolPose::new(Vector::zeros(), Vector::<3>::new(0.8, 0.0, 0.6)).unwrap();
        let near = AxisVector::from([0.0, 0.0, 0.0, -0.9, 3.1]);
        let solutions = machine.solutions(&pose, &near).unwrap();
        assert_eq!(solutions.len(), 1, "{solutions:?}");
        assert!(
            (solutions[0][3] - 0.8_f64.asin()).abs() < 1e-12,
            "{solutions:?}"
        );
        let high = Vector::<3>::new(0.0, 0.0, 200.0);
        let down = ToolPose::new(high, -Vector::<3>::z()).unwrap();
        assert!(
            matches!(
                machine.solutions(&down, &near),
                Err(KinematicsError::Travel { axis: 'B', .. })
            ),
            "below the table"
        );
    }
}
