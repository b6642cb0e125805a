//! A vertical machine whose table tilts about Y and turns the workpiece: axes X, Y, Z, B and C.
//!
//! Source: section 5.2, p = b0 + Ry(B)·(d + Rz(C)·(P + w)) and Ry(B)·Rz(C)·O = e_z, solved by atan2. Not
//! here: signs, zeros, turns and travel, which [`Assembly`] adds.

use crate::config::{AxisConfig, MachineConfig};
use crate::error::MachineError;
use crate::geometry::{Distance, WORKPIECE_ON_TABLE};
use crate::registry::MachineModel;
use crate::structure::{Assembly, Branches, Structure};
use crate::swivel::{Swivel, about_y, about_z, back};
use toolglide_kinematics::{AxisKind, KinematicsError, MachineKinematics, ToolPose, Vector};

/// The axes, in machine order.
const AXES: [(char, AxisKind); 5] = [
    ('X', AxisKind::Linear),
    ('Y', AxisKind::Linear),
    ('Z', AxisKind::Linear),
    ('B', AxisKind::Rotary),
    ('C', AxisKind::Rotary),
];

const GEOMETRY: [Distance; 10] = [
    Distance::required("b_axis_x", "from machine zero to the B axis, along X"),
    Distance::required("b_axis_y", "from machine zero to the B axis, along Y"),
    Distance::required("b_axis_z", "from machine zero to the B axis, along Z"),
    Distance::required(
        "c_axis_x",
        "from the B axis to the C axis at B = 0, along X",
    ),
    Distance::required(
        "c_axis_y",
        "from the B axis to the C axis at B = 0, along Y",
    ),
    Distance::required(
        "c_axis_z",
        "from the B axis to the table face at B = 0, along Z",
    ),
    Distance::optional("tool_length", "by which Z stands above the tool tip"),
    WORKPIECE_ON_TABLE[0],
    WORKPIECE_ON_TABLE[1],
    WORKPIECE_ON_TABLE[2],
];

/// A tilting rotary table.
#[derive(Clone, Debug)]
struct TableBc {
    /// A point of the B axis, in machine coordinates.
    tilt_axis: Vector<3>,
    /// From it to the center of the table, at B = 0.
    center: Vector<3>,
    tool_length: f64,
}

impl TableBc {
    /// Where a point on the table, from its center, is in machine coordinates.
    fn on_machine(&self, tilt: (f64, f64), spin: (f64, f64), point: Vector<3>) -> Vector<3> {
        self.tilt_axis + about_y(tilt, self.center + about_z(spin, point))
    }

    /// The swivel direction of a tool orientation: O = (-sB·cC, sB·sC, cB).
    fn swivel(orientation: Vector<3>) -> Vector<3> {
        Vector::<3>::new(-orientation.x, orientation.y, orientation.z)
    }
}

impl Structure<5> for TableBc {
    fn tool(&self, joints: &[f64; 5]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        let [x, y, z, b, c] = *joints;
        let swivel = Swivel::at(b, c);
        let point = Vector::<3>::new(x, y, z - self.tool_length) - self.tilt_axis;
        let tip = about_z(
            back(swivel.spun),
            about_y(back(swivel.tilted), point) - self.center,
        );
        Ok((tip, Self::swivel(swivel.direction())))
    }

    fn branches(&self, pose: &ToolPose, near: &[f64; 5]) -> Result<Branches<5>, KinematicsError> {
        let mut branches = Branches::none();
        for swivel in Swivel::towards(&Self::swivel(pose.orientation()), near[4]) {
            let point = self.on_machine(swivel.tilted, swivel.spun, pose.tip());
            let z = point.z + self.tool_length;
            branches.push([point.x, point.y, z, swivel.tilt, swivel.spin]);
        }
        Ok(branches)
    }
}

fn preset() -> MachineConfig {
    let mut config = MachineConfig::new(
        "table-bc",
        "table-bc",
        vec![
            AxisConfig::new('X', 500.0, 2_500.0, 200_000.0).with_travel(-400.0, 400.0),
            AxisConfig::new('Y', 500.0, 2_500.0, 200_000.0).with_travel(-400.0, 400.0),
            AxisConfig::new('Z', 400.0, 2_500.0, 200_000.0).with_travel(-200.0, 500.0),
            AxisConfig::new('B', 180.0, 1_500.0, 60_000.0).with_travel(-120.0, 120.0),
            AxisConfig::new('C', 360.0, 3_000.0, 120_000.0),
        ],
    );
    // The table face is 60 mm below the B axis, so that work of that height turns about it.
    for (name, value) in [
        ("b_axis_x", 0.0),
        ("b_axis_y", 0.0),
        ("b_axis_z", 60.0),
        ("c_axis_x", 0.0),
        ("c_axis_y", 0.0),
        ("c_axis_z", -60.0),
    ] {
        config.geometry.insert(name.to_owned(), value);
    }
    config
}

fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    let [bx, by, bz, cx, cy, cz, tool_length, wx, wy, wz] = config.distances(&GEOMETRY)?;
    let structure = TableBc {
        tilt_axis: Vector::<3>::new(bx, by, bz),
        center: Vector::<3>::new(cx, cy, cz),
        tool_length,
    };
    Assembly::build(structure, [wx, wy, wz], AXES, config)
}

/// A table that tilts about Y and carries a rotary table.
pub static TABLE_BC: MachineModel = MachineModel {
    name: "table-bc",
    summary: "the table tilts about Y and turns the workpiece: X Y Z B C",
    geometry: &GEOMETRY,
    preset,
    build,
};

inventory::submit!(TABLE_BC);
