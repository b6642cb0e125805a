//! Models two motors that share one belt: axes U and V, or U, V and Z.
//!
//! Source: the belt's length, U = X + Y and V = X - Y. Not here: anything that tilts the tool.

use crate::config::{AxisConfig, MachineConfig};
use crate::error::MachineError;
use crate::geometry::WORKPIECE;
use crate::registry::MachineModel;
use crate::structure::{Assembly, Branches, Structure, upright};
use toolglide_kinematics::numeric::LENGTH_SLACK;
use toolglide_kinematics::{AxisKind, KinematicsError, MachineKinematics, ToolPose, Vector};

/// Belt and carriage.
#[derive(Clone, Copy, Debug)]
struct CoreXy;

impl Structure<3> for CoreXy {
    fn tool(&self, &[u, v, z]: &[f64; 3]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        Ok((
            Vector::<3>::new(0.5 * (u + v), 0.5 * (u - v), z),
            Vector::<3>::z(),
        ))
    }

    fn branches(&self, pose: &ToolPose, _near: &[f64; 3]) -> Result<Branches<3>, KinematicsError> {
        let tip = upright(pose)?;
        Ok(Branches::one([tip.x + tip.y, tip.x - tip.y, tip.z]))
    }
}

impl Structure<2> for CoreXy {
    fn tool(&self, &[u, v]: &[f64; 2]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        self.tool(&[u, v, 0.0])
    }

    fn branches(&self, pose: &ToolPose, _near: &[f64; 2]) -> Result<Branches<2>, KinematicsError> {
        let tip = upright(pose)?;
        if tip.z.abs() > LENGTH_SLACK {
            return Err(KinematicsError::Unreachable {
                reason: "no axis moves the tool along Z",
            });
        }
        Ok(Branches::one([tip.x + tip.y, tip.x - tip.y]))
    }
}

fn preset() -> MachineConfig {
    MachineConfig::new(
        "corexy",
        "corexy",
        vec![
            AxisConfig::new('U', 500.0, 10_000.0, 400_000.0),
            AxisConfig::new('V', 500.0, 10_000.0, 400_000.0),
            AxisConfig::new('Z', 20.0, 500.0, 20_000.0).with_travel(0.0, 300.0),
        ],
    )
}

fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    let workpiece = config.distances(&WORKPIECE)?;
    let linear = |letter| (letter, AxisKind::Linear);
    if config.axis.len() == 2 {
        return Assembly::build(CoreXy, workpiece, ['U', 'V'].map(linear), config);
    }
    Assembly::build(CoreXy, workpiece, ['U', 'V', 'Z'].map(linear), config)
}

/// A carriage that two standing motors move by one belt.
pub static COREXY: MachineModel = MachineModel {
    name: "corexy",
    summary: "two standing motors move the tool by one belt: U V or U V Z",
    geometry: &WORKPIECE,
    preset,
    build,
};

inventory::submit!(COREXY);

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::AxisVector;

    #[test]
    fn both_motors_turn_for_x_and_against_each_other_for_y() {
        let machine = build(&preset()).unwrap();
        let near = AxisVector::zeros(3);
        for (tip, axes) in [
            ([10.0, 0.0, 1.0], [10.0, 10.0, 1.0]),
            ([0.0, 10.0, 2.0], [10.0, -10.0, 2.0]),
        ] {
            let pose = ToolPose::upright(tip.into()).unwrap();
            assert_eq!(
                machine.inverse(&pose, &near).unwrap(),
                AxisVector::from(axes),
                "{tip:?}"
            );
        }
    }

    #[test]
    fn a_belt_without_z_takes_no_height() {
        let mut config = preset();
        config.axis.truncate(2);
        let machine = build(&config).unwrap();
        let near = AxisVector::zeros(2);
        let level = ToolPose::upright(Vector::<3>::new(3.0, 4.0, 0.0)).unwrap();
        let axes = machine.inverse(&level, &near).unwrap();
        assert_eq!(axes, AxisVector::from([7.0, -1.0]), "level");
        assert_eq!(machine.forward(&axes).unwrap(), level, "and back");
        let high = ToolPose::upright(Vector::<3>::new(3.0, 4.0, 1.0)).unwrap();
        assert!(machine.inverse(&high, &near).is_err(), "high");
    }
}
