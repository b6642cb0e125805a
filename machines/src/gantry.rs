//! Models two or three linear axes at right angles.
//!
//! Source: the machines of chapters 2 to 4, whose kinematics is the identity. Not here: anything
//! that turns.

use crate::config::{AxisConfig, MachineConfig};
use crate::error::MachineError;
use crate::registry::MachineModel;
use crate::structure::{Assembly, Branches, Structure, upright};
use toolglide_kinematics::numeric::LENGTH_SLACK;
use toolglide_kinematics::{AxisKind, KinematicsError, MachineKinematics, ToolPose, Vector};

/// Largest velocity of an axis of the preset, mm/s.
pub(crate) const VELOCITY: f64 = 500.0;
/// Largest acceleration of an axis of the preset, mm/s².
pub(crate) const ACCELERATION: f64 = 2_500.0;
/// Largest jerk of an axis of the preset, mm/s³.
pub(crate) const JERK: f64 = 200_000.0;

/// Two or three straight axes.
#[derive(Clone, Copy, Debug)]
struct Gantry;

impl Structure<3> for Gantry {
    fn tool(&self, joints: &[f64; 3]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        Ok(((*joints).into(), Vector::<3>::z()))
    }

    fn branches(&self, pose: &ToolPose, _near: &[f64; 3]) -> Result<Branches<3>, KinematicsError> {
        Ok(Branches::one(upright(pose)?.into()))
    }
}

impl Structure<2> for Gantry {
    fn tool(&self, &[x, y]: &[f64; 2]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        Ok((Vector::<3>::new(x, y, 0.0), Vector::<3>::z()))
    }

    fn branches(&self, pose: &ToolPose, _near: &[f64; 2]) -> Result<Branches<2>, KinematicsError> {
        let tip = upright(pose)?;
        if tip.z.abs() > LENGTH_SLACK {
            return Err(KinematicsError::Unreachable {
                reason: "no axis moves the tool along Z",
            });
        }
        Ok(Branches::one([tip.x, tip.y]))
    }
}

fn preset() -> MachineConfig {
    let axes = ['X', 'Y', 'Z'];
    MachineConfig::new(
        "gantry",
        "gantry",
        axes.map(|name| AxisConfig::new(name, VELOCITY, ACCELERATION, JERK))
            .to_vec(),
    )
}

fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    let [] = config.distances(&[])?;
    // Programs are planned in the coordinates of a gantry, so its axes are those.
    if let Some(axis) = config.axis.iter().find(|axis| axis.reversed) {
        let field = format!("axis {}: reversed", axis.name);
        return Err(MachineError::field(field, true, "false for a gantry"));
    }
    if let Some(axis) = config.axis.iter().find(|axis| axis.zero.abs() > 0.0) {
        let field = format!("axis {}: zero", axis.name);
        return Err(MachineError::field(field, axis.zero, "0 for a gantry"));
    }
    let linear = |letter| (letter, AxisKind::Linear);
    if config.axis.len() == 2 {
        return Assembly::build(Gantry, [0.0; 3], ['X', 'Y'].map(linear), config);
    }
    Assembly::build(Gantry, [0.0; 3], ['X', 'Y', 'Z'].map(linear), config)
}

/// Two or three linear axes at right angles.
pub static GANTRY: MachineModel = MachineModel {
    name: "gantry",
    summary: "two or three linear axes at right angles: X Y or X Y Z",
    geometry: &[],
    preset,
    build,
};

inventory::submit!(GANTRY);

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::AxisVector;

    fn flat() -> Box<dyn MachineKinematics> {
        let mut config = preset();
        config.axis.truncate(2);
        config.axis[0].travel = Some([0.0, 400.0]);
        build(&config).unwrap()
    }

    #[test]
    fn inverse_undoes_forward() {
        let machine = build(&preset()).unwrap();
        let axes = AxisVector::from([1.5, -2.0, 30.0]);
        let pose = machine.forward(&axes).unwrap();
        assert_eq!(machine.inverse(&pose, &axes).unwrap(), axes);
    }

    #[test]
    fn a_flat_machine_takes_no_height() {
        let near = AxisVector::zeros(2);
        let level = ToolPose::upright(Vector::<3>::new(1.0, 2.0, 0.0)).unwrap();
        assert_eq!(flat().inverse(&level, &near).unwrap().len(), 2, "level");
        let high = ToolPose::upright(Vector::<3>::new(1.0, 2.0, 3.0)).unwrap();
        assert!(
            matches!(
                flat().inverse(&high, &near),
                Err(KinematicsError::Unreachable { .. })
            ),
            "high"
        );
    }

    #[test]
    fn travel_and_tilt_are_refused() {
        let near = AxisVector::zeros(2);
        let outside = ToolPose::upright(Vector::<3>::new(400.5, 0.0, 0.0)).unwrap();
        assert_eq!(
            flat().inverse(&outside, &near).unwrap_err().to_string(),
            "axis X: position 400.5 is outside the travel 0 to 400 mm by 0.5"
        );
        let tilted = ToolPose::new(Vector::zeros(), Vector::<3>::x()).unwrap();
        assert!(flat().inverse(&tilted, &near).is_err(), "tilted");
        assert!(
            flat().forward(&AxisVector::zeros(3)).is_err(),
            "three positions"
        );
    }

    #[test]
    fn other_axes_and_geometry_are_refused() {
        let mut config = preset();
        config.axis.swap(0, 1);
        assert!(
            build(&config)
                .err()
                .unwrap()
                .to_string()
                .contains("the axes are Y X Z, but must be X Y Z"),
            "order"
        );
        let mut config = preset();
        config.geometry.insert("offset".to_owned(), 3.0);
        assert!(
            build(&config)
                .err()
                .unwrap()
                .to_string()
                .contains("geometry.offset"),
            "geometry"
        );
        let mut config = preset();
        config.axis[1].reversed = true;
        assert!(
            build(&config)
                .err()
                .unwrap()
                .to_string()
                .contains("axis Y: reversed"),
            "sign"
        );
        let mut config = preset();
        config.axis[2].zero = 3.0;
        assert!(build(&config).is_err(), "zero");
        let mut config = preset();
        config.tolerance_mm = f64::NAN;
        assert!(build(&config).is_err(), "tolerance");
        config.tolerance_mm = 0.01;
        config.period_s = 0.0;
        assert!(build(&config).is_err(), "period");
    }
}
