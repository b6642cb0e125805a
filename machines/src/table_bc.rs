//! Models a vertical machine whose table tilts about Y and turns the workpiece: axes X, Y, Z, B and
//! C.
//!
//! Source: section 5.2, p = b0 + Ry(B)·(d + Rz(C)·(P + w)) and Ry(B)·Rz(C)·O = e_z. Not here:
//! the kinematics of tilting tables, see `tilting_table`.

use crate::config::MachineConfig;
use crate::error::MachineError;
use crate::geometry::{Distance, WORKPIECE_ON_TABLE};
use crate::registry::MachineModel;
use crate::swivel::about_y;
use crate::tilting_table::{self, Tilt, geometry};
use toolglide_kinematics::{MachineKinematics, Vector};

const GEOMETRY: [Distance; 10] = geometry!("b", "B");

/// The table tilts about Y; O = (-sB·cC, sB·sC, cB).
#[derive(Debug)]
struct AboutY;

impl Tilt for AboutY {
    const LETTER: char = 'B';

    fn about(angle: (f64, f64), vector: Vector<3>) -> Vector<3> {
        about_y(angle, vector)
    }

    fn swivel(orientation: Vector<3>) -> Vector<3> {
        Vector::<3>::new(-orientation.x, orientation.y, orientation.z)
    }
}

fn preset() -> MachineConfig {
    tilting_table::preset::<AboutY>(
        "table-bc",
        std::array::from_fn(|distance| GEOMETRY[distance].name),
    )
}

fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    tilting_table::build::<AboutY>(config, &GEOMETRY)
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
