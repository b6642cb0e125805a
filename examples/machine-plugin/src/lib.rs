//! A table that swivels about an axis halfway between Y and Z, and turns the workpiece: axes X, Y, Z, B
//! and C.
//!
//! With n = (0, 1, 1)/√2, a point P of the workpiece is at p = n0 + R(n, B)·(d + Rz(C)·P), and the
//! tool, which points along Z of the machine, has the orientation O = Rz(-C)·R(n, -B)·e_z. So
//! O_z = (1 + cos B)/2: the tool lies level at B = 180 degrees and never points downward.

use toolglide_kinematics::{AxisKind, KinematicsError, MachineKinematics, ToolPose, Vector};
use toolglide_machines::{
    Assembly, AxisConfig, Branches, Distance, MachineConfig, MachineError, MachineModel, Structure,
    WORKPIECE_ON_TABLE, inventory,
};

/// A tool that leans by less than this leaves C open, rad: the rounding of a unit vector.
const UPRIGHT: f64 = 1e-13;

/// A tool may point below the table by this, dimensionless: the rounding of a unit vector.
const LEVEL: f64 = 1e-15;

/// The axes, in machine order.
const AXES: [(char, AxisKind); 5] = [
    ('X', AxisKind::Linear),
    ('Y', AxisKind::Linear),
    ('Z', AxisKind::Linear),
    ('B', AxisKind::Rotary),
    ('C', AxisKind::Rotary),
];

/// What a machine file says under `[geometry]`, in the order in which `build` reads it.
const GEOMETRY: [Distance; 6] = [
    Distance::required(
        "table_y",
        "from the B axis to the middle of the table at B = 0, along Y",
    ),
    Distance::required(
        "table_z",
        "from the B axis to the table face at B = 0, along Z",
    ),
    Distance::optional("tool_length", "by which Z stands above the tool tip"),
    WORKPIECE_ON_TABLE[0],
    WORKPIECE_ON_TABLE[1],
    WORKPIECE_ON_TABLE[2],
];

/// What this machine does not share with others. The B axis goes through machine zero.
struct NutatingTable {
    /// From the B axis to the middle of the table, at B = 0.
    table: Vector<3>,
    tool_length: f64,
}

/// A vector turned about n by `angle`, after Rodrigues.
fn swivel(angle: f64, v: Vector<3>) -> Vector<3> {
    let half = 0.5_f64.sqrt();
    let axis = Vector::<3>::new(0.0, half, half);
    let (sin, cos) = angle.sin_cos();
    v * cos + axis.cross(&v) * sin + axis * (axis.dot(&v) * (1.0 - cos))
}

/// A vector turned about Z by `angle`.
fn turn(angle: f64, v: Vector<3>) -> Vector<3> {
    let (sin, cos) = angle.sin_cos();
    Vector::<3>::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z)
}

impl Structure<5> for NutatingTable {
    fn tool(&self, joints: &[f64; 5]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        let [x, y, z, b, c] = *joints;
        let point = Vector::<3>::new(x, y, z - self.tool_length);
        let tip = turn(-c, swivel(-b, point) - self.table);
        let orientation = turn(-c, swivel(-b, Vector::<3>::z()));
        Ok((tip, orientation))
    }

    fn branches(&self, pose: &ToolPose, near: &[f64; 5]) -> Result<Branches<5>, KinematicsError> {
        let orientation = pose.orientation();
        if orientation.z < -LEVEL {
            return Err(KinematicsError::Unreachable {
                reason: "the table does not swivel beyond level",
            });
        }
        // sin²(B/2) = 1 - O_z, which loses no digits when it is written with the sine of the lean.
        let lean = orientation.x.hypot(orientation.y);
        let half_sin = lean / (1.0 + orientation.z).sqrt();
        let half_b = half_sin.atan2(orientation.z.max(0.0).sqrt());
        let mut branches = Branches::none();
        for b in [2.0 * half_b, -2.0 * half_b] {
            let up = swivel(-b, Vector::<3>::z());
            let c = if lean < UPRIGHT {
                near[4]
            } else {
                up.y.atan2(up.x) - orientation.y.atan2(orientation.x)
            };
            let point = swivel(b, self.table + turn(c, pose.tip()));
            branches.push([point.x, point.y, point.z + self.tool_length, b, c]);
        }
        Ok(branches)
    }
}

/// The machine that is meant where only its model is named.
fn preset() -> MachineConfig {
    let mut config = MachineConfig::new(
        "nutating-table",
        "nutating-table",
        vec![
            AxisConfig::new('X', 500.0, 5_000.0, 200_000.0).with_travel(-400.0, 400.0),
            AxisConfig::new('Y', 500.0, 5_000.0, 200_000.0).with_travel(-500.0, 500.0),
            AxisConfig::new('Z', 500.0, 5_000.0, 200_000.0).with_travel(-300.0, 500.0),
            AxisConfig::new('B', 180.0, 1_500.0, 60_000.0).with_travel(-5.0, 180.0),
            AxisConfig::new('C', 360.0, 3_000.0, 120_000.0),
        ],
    );
    config.geometry.insert("table_y".to_owned(), 0.0);
    config.geometry.insert("table_z".to_owned(), -20.0);
    config
}

/// The machine that a machine file describes.
fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    let [table_y, table_z, tool_length, wx, wy, wz] = config.distances(&GEOMETRY)?;
    let structure = NutatingTable {
        table: Vector::<3>::new(0.0, table_y, table_z),
        tool_length,
    };
    Assembly::build(structure, [wx, wy, wz], AXES, config)
}

/// A table that swivels about a slanting axis and turns the workpiece.
pub static NUTATING_TABLE: MachineModel = MachineModel {
    name: "nutating-table",
    summary: "the table swivels about a slanting axis and turns the workpiece: X Y Z B C",
    geometry: &GEOMETRY,
    preset,
    build,
};

inventory::submit!(NUTATING_TABLE);

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::AxisVector;

    fn machine(change: impl Fn(&mut MachineConfig)) -> Box<dyn MachineKinematics> {
        let mut config = preset();
        change(&mut config);
        build(&config).unwrap()
    }

    #[test]
    fn forward_undoes_inverse_on_both_branches() {
        let machine = machine(|config| {
            for axis in &mut config.axis {
                axis.travel = None;
            }
            config.axis[4].reversed = true;
            config.geometry.insert("table_y".to_owned(), 13.0);
        });
        let near = AxisVector::from([0.0, 0.0, 0.0, 0.3, 0.7]);
        for lean in [
            0.0,
            1e-15,
            1e-12,
            1e-6,
            0.3,
            1.0,
            1.5,
            std::f64::consts::FRAC_PI_2,
        ] {
            for step in 0..360 {
                let (sin, cos) = f64::from(step).to_radians().sin_cos();
                let orientation = Vector::<3>::new(lean.sin() * cos, lean.sin() * sin, lean.cos());
                let pose = ToolPose::new(Vector::<3>::new(50.0, -20.0, 30.0), orientation).unwrap();
                let solutions = machine.solutions(&pose, &near).unwrap();
                assert_eq!(solutions.len(), 2, "both branches");
                for axes in solutions.iter() {
                    let again = machine.forward(axes).unwrap();
                    let turned = (again.orientation() - orientation).norm();
                    let moved = (again.tip() - pose.tip()).norm();
                    assert!(turned < 1e-12, "{lean} {step}: {turned:e}");
                    assert!(moved < 1e-10, "{lean} {step}: {moved:e}");
                }
            }
        }
    }

    #[test]
    fn half_a_turn_lays_the_tool_level() {
        let machine = machine(|_| {});
        let axes = AxisVector::from([0.0, 0.0, 0.0, std::f64::consts::PI, 0.0]);
        let orientation = machine.forward(&axes).unwrap().orientation();
        assert!(
            (orientation - Vector::<3>::y()).norm() < 1e-15,
            "{orientation}"
        );
    }

    #[test]
    fn c_stays_where_the_tool_is_upright() {
        let pose = ToolPose::upright(Vector::<3>::new(1.0, 2.0, 3.0)).unwrap();
        let near = AxisVector::from([0.0, 0.0, 0.0, 0.0, 4.0]);
        let axes = machine(|_| {}).inverse(&pose, &near).unwrap();
        assert!((axes[4] - 4.0).abs() < 1e-15, "{axes:?}");
    }

    #[test]
    fn poses_out_of_reach_and_out_of_travel_are_refused() {
        let near = AxisVector::zeros(5);
        let below = ToolPose::new(Vector::zeros(), Vector::<3>::new(0.6, 0.0, -0.8)).unwrap();
        let refused = machine(|_| {}).inverse(&below, &near);
        assert!(
            matches!(refused, Err(KinematicsError::Unreachable { .. })),
            "{refused:?}"
        );
        let far = ToolPose::upright(Vector::<3>::new(401.0, 0.0, 0.0)).unwrap();
        let refused = machine(|_| {}).inverse(&far, &near).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "axis X: position 401 is outside the travel -400 to 400 mm by 1"
        );
    }

    #[test]
    fn offsets_and_axes_that_are_wrong_are_refused() {
        let mut config = preset();
        config.geometry.remove("table_z");
        assert!(
            matches!(build(&config), Err(MachineError::MissingDistance { .. })),
            "missing"
        );
        let mut config = preset();
        config.geometry.insert("pivot".to_owned(), 1.0);
        assert!(
            matches!(build(&config), Err(MachineError::UnknownDistance { .. })),
            "unknown"
        );
        let mut config = preset();
        config.axis.swap(3, 4);
        assert!(
            matches!(build(&config), Err(MachineError::Axes { .. })),
            "order"
        );
    }

    #[test]
    fn the_machine_is_registered() {
        assert!(toolglide_machines::find("nutating-table").is_ok());
    }
}
