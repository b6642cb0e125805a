//! Two or three linear axes at right angles: the tool goes where the axes go.
//!
//! Source: the machines of chapters 2 to 4, whose kinematics is the identity. Not here: anything
//! that turns.

use crate::config::{AxisConfig, MachineConfig};
use crate::error::MachineError;
use crate::registry::MachineModel;
use toolglide_kinematics::numeric::{LENGTH_SLACK, UNIT_LENGTH_ERROR};
use toolglide_kinematics::{
    Axis, AxisVector, KinematicsError, MachineKinematics, SamplePeriod, Tolerance, ToolPose, Vector,
};

/// Largest velocity of an axis of the preset, mm/s.
const VELOCITY: f64 = 500.0;
/// Largest acceleration of an axis of the preset, mm/s².
const ACCELERATION: f64 = 2_500.0;
/// Largest jerk of an axis of the preset, mm/s³.
const JERK: f64 = 200_000.0;

#[derive(Debug)]
struct Gantry {
    axes: Vec<Axis>,
    tolerance: Tolerance,
    period: SamplePeriod,
}

impl MachineKinematics for Gantry {
    fn axes(&self) -> &[Axis] {
        &self.axes
    }

    fn default_tolerance(&self) -> Tolerance {
        self.tolerance
    }

    fn set_point_period(&self) -> SamplePeriod {
        self.period
    }

    fn forward(&self, axes: &AxisVector) -> Result<ToolPose, KinematicsError> {
        if axes.len() != self.axes.len() {
            return Err(KinematicsError::AxisCount {
                given: axes.len(),
                axes: self.axes.len(),
            });
        }
        let tip = Vector::from_fn(|row, _| axes.get(row).copied().unwrap_or(0.0));
        ToolPose::upright(tip).map_err(|_| KinematicsError::Unreachable {
            reason: "an axis position is not a finite number",
        })
    }

    fn inverse(&self, pose: &ToolPose, _near: &AxisVector) -> Result<AxisVector, KinematicsError> {
        if (pose.orientation() - Vector::<3>::z()).norm() > UNIT_LENGTH_ERROR {
            return Err(KinematicsError::Unreachable {
                reason: "no axis tilts the tool",
            });
        }
        let tip = pose.tip();
        if self.axes.len() < tip.len() && tip.z.abs() > LENGTH_SLACK {
            return Err(KinematicsError::Unreachable {
                reason: "no axis moves the tool along Z",
            });
        }
        for (axis, &position) in self.axes.iter().zip(tip.iter()) {
            if let Some((low, high)) = axis.travel
                && !(low - LENGTH_SLACK..=high + LENGTH_SLACK).contains(&position)
            {
                return Err(KinematicsError::Travel {
                    axis: axis.name,
                    position,
                    low,
                    high,
                });
            }
        }
        Ok(AxisVector::from_iterator(
            self.axes.len(),
            tip.iter().copied().take(self.axes.len()),
        ))
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
    let letters = config.letters();
    if letters != "XY" && letters != "XYZ" {
        return Err(MachineError::field(
            "the list of axes",
            format!("\"{letters}\""),
            "X Y or X Y Z, in this order, for a gantry",
        ));
    }
    if let Some((name, value)) = config.geometry.first_key_value() {
        return Err(MachineError::field(
            format!("geometry.{name}"),
            value,
            "left out: a gantry has no geometry",
        ));
    }
    Ok(Box::new(Gantry {
        axes: config
            .axis
            .iter()
            .map(AxisConfig::linear)
            .collect::<Result<_, _>>()?,
        tolerance: config.tolerance()?,
        period: config.period()?,
    }))
}

/// Two or three linear axes at right angles.
pub static GANTRY: MachineModel = MachineModel {
    name: "gantry",
    summary: "two or three linear axes at right angles: X Y or X Y Z",
    preset,
    build,
};

inventory::submit!(GANTRY);

#[cfg(test)]
mod tests {
    use super::*;

    fn flat() -> Box<dyn MachineKinematics> {
        let mut config = preset();
        config.axis.truncate(2);
        config.axis[0].travel = Some([0.0, 400.0]);
        build(&config).unwrap()
    }

    #[test]
    fn inverse_undoes_forward() {
        let machine = build(&preset()).unwrap();
        let axes = AxisVector::from_vec(vec![1.5, -2.0, 30.0]);
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
            "axis X: position 400.5 is outside the travel 0 to 400"
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
                .contains("\"YXZ\""),
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
        config.tolerance_mm = f64::NAN;
        assert!(build(&config).is_err(), "tolerance");
        config.tolerance_mm = 0.01;
        config.period_s = 0.0;
        assert!(build(&config).is_err(), "period");
    }
}
