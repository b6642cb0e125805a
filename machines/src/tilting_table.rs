//! Solves a table that tilts about a level axis and carries a rotary table.
//!
//! Source: section 5.2, p = t0 + Rt(T)·(d + Rz(C)·(P + w)) and Rt(T)·Rz(C)·O = e_z, solved by atan2, where T
//! tilts about X or Y. Not here: which of the two, see `table_ac` and `table_bc`; signs, zeros, turns and
//! travel, which [`Assembly`](crate::Assembly) adds.

use crate::config::{AxisConfig, MachineConfig};
use crate::error::MachineError;
use crate::geometry::Distance;
use crate::structure::{Assembly, Branches, Structure};
use crate::swivel::{Swivel, about_z, axes, back, pole};
use std::marker::PhantomData;
use toolglide_kinematics::{KinematicsError, MachineKinematics, ToolPose, Vector};

/// The distances of a tilting table whose tilting axis has this letter, small and capital.
macro_rules! geometry {
    ($small:literal, $capital:literal) => {
        [
            Distance::required(
                concat!($small, "_axis_x"),
                concat!("from machine zero to the ", $capital, " axis, along X"),
            ),
            Distance::required(
                concat!($small, "_axis_y"),
                concat!("from machine zero to the ", $capital, " axis, along Y"),
            ),
            Distance::required(
                concat!($small, "_axis_z"),
                concat!("from machine zero to the ", $capital, " axis, along Z"),
            ),
            Distance::required(
                "c_axis_x",
                concat!(
                    "from the ",
                    $capital,
                    " axis to the C axis at ",
                    $capital,
                    " = 0, along X"
                ),
            ),
            Distance::required(
                "c_axis_y",
                concat!(
                    "from the ",
                    $capital,
                    " axis to the C axis at ",
                    $capital,
                    " = 0, along Y"
                ),
            ),
            Distance::required(
                "c_axis_z",
                concat!(
                    "from the ",
                    $capital,
                    " axis to the table face at ",
                    $capital,
                    " = 0, along Z"
                ),
            ),
            Distance::optional("tool_length", "by which Z stands above the tool tip"),
            WORKPIECE_ON_TABLE[0],
            WORKPIECE_ON_TABLE[1],
            WORKPIECE_ON_TABLE[2],
        ]
    };
}
pub(crate) use geometry;

/// How a table tilts.
pub(crate) trait Tilt: std::fmt::Debug + Send + Sync + 'static {
    /// The letter of the tilting axis.
    const LETTER: char;

    /// A vector turned about the tilting axis by an angle of this sine and cosine.
    fn about(angle: (f64, f64), vector: Vector<3>) -> Vector<3>;

    /// The swivel direction of a tool orientation, and the orientation of a swivel direction.
    fn swivel(orientation: Vector<3>) -> Vector<3>;
}

/// A tilting rotary table.
#[derive(Debug)]
struct TiltingTable<T> {
    /// A point of the tilting axis, in machine coordinates.
    tilt_axis: Vector<3>,
    /// From it to the center of the table, where it does not tilt.
    center: Vector<3>,
    tool_length: f64,
    tilt: PhantomData<T>,
}

impl<T: Tilt> TiltingTable<T> {
    /// Where a point on the table, from its center, is in machine coordinates.
    fn on_machine(&self, tilt: (f64, f64), spin: (f64, f64), point: Vector<3>) -> Vector<3> {
        self.tilt_axis + T::about(tilt, self.center + about_z(spin, point))
    }
}

impl<T: Tilt> Structure<5> for TiltingTable<T> {
    fn tool(&self, joints: &[f64; 5]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        let [x, y, z, tilt, c] = *joints;
        let swivel = Swivel::at(tilt, c);
        let point = Vector::<3>::new(x, y, z - self.tool_length) - self.tilt_axis;
        let tip = about_z(
            back(swivel.spun),
            T::about(back(swivel.tilted), point) - self.center,
        );
        Ok((tip, T::swivel(swivel.direction())))
    }

    fn branches(&self, pose: &ToolPose, near: &[f64; 5]) -> Result<Branches<5>, KinematicsError> {
        let mut branches = Branches::none();
        for swivel in Swivel::towards(&T::swivel(pose.orientation()), near[4]) {
            let point = self.on_machine(swivel.tilted, swivel.spun, pose.tip());
            let z = point.z + self.tool_length;
            branches.push([point.x, point.y, z, swivel.tilt, swivel.spin]);
        }
        Ok(branches)
    }

    fn pole(&self, orientation: &Vector<3>) -> Option<Vector<3>> {
        pole(orientation)
    }
}

/// A machine file to begin with. `distances` are those that must be given.
pub(crate) fn preset<T: Tilt>(name: &str, distances: [&'static str; 6]) -> MachineConfig {
    let mut config = MachineConfig::new(
        name,
        name,
        vec![
            AxisConfig::new('X', 500.0, 2_500.0, 200_000.0).with_travel(-400.0, 400.0),
            AxisConfig::new('Y', 500.0, 2_500.0, 200_000.0).with_travel(-400.0, 400.0),
            AxisConfig::new('Z', 400.0, 2_500.0, 200_000.0).with_travel(-200.0, 500.0),
            AxisConfig::new(T::LETTER, 180.0, 1_500.0, 60_000.0).with_travel(-120.0, 120.0),
            AxisConfig::new('C', 360.0, 3_000.0, 120_000.0),
        ],
    );
    // The table face is 60 mm below the tilting axis, so that work of that height turns about it.
    let values = [0.0, 0.0, 60.0, 0.0, 0.0, -60.0];
    for (name, value) in distances.into_iter().zip(values) {
        config.geometry.insert(name.to_owned(), value);
    }
    config
}

/// The machine that a machine file describes.
pub(crate) fn build<T: Tilt>(
    config: &MachineConfig,
    geometry: &[Distance; 10],
) -> Result<Box<dyn MachineKinematics>, MachineError> {
    let [tx, ty, tz, cx, cy, cz, tool_length, wx, wy, wz] = config.distances(geometry)?;
    let structure = TiltingTable::<T> {
        tilt_axis: Vector::<3>::new(tx, ty, tz),
        center: Vector::<3>::new(cx, cy, cz),
        tool_length,
        tilt: PhantomData,
    };
    Assembly::build(structure, [wx, wy, wz], axes(T::LETTER), config)
}
