//! Models three carriages on upright towers that carry the tool by rods of equal length: axes U, V
//! and W.
//!
//! Source: Pythagoras for the inverse, the cut of three spheres for the forward map. The towers stand
//! at 90, 210 and 330 degrees. Not here: deltas with turning arms.

use crate::config::{AxisConfig, MachineConfig};
use crate::error::MachineError;
use crate::geometry::{Distance, WORKPIECE};
use crate::registry::MachineModel;
use crate::structure::{Assembly, Branches, Structure, upright};
use toolglide_kinematics::{AxisKind, KinematicsError, MachineKinematics, ToolPose, Vector};

const GEOMETRY: [Distance; 5] = [
    Distance::required("rod", "between the joints of a rod").positive(),
    Distance::required(
        "radius",
        "from the joints on the carriages to the center, less that on the tool holder",
    )
    .positive(),
    WORKPIECE[0],
    WORKPIECE[1],
    WORKPIECE[2],
];

/// Towers and rods. A carriage at height h has its rod end at h; the tool holder hangs below.
#[derive(Clone, Debug)]
struct Delta {
    towers: [[f64; 2]; 3],
    rod: f64,
}

impl Delta {
    fn new(rod: f64, radius: f64) -> Self {
        let side = radius * 0.75_f64.sqrt();
        let half = 0.5 * radius;
        Self {
            towers: [[0.0, radius], [-side, -half], [side, -half]],
            rod,
        }
    }
}

impl Structure<3> for Delta {
    fn tool(&self, joints: &[f64; 3]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        let [first, second, third] = std::array::from_fn(|tower| -> Vector<3> {
            let [x, y] = self.towers[tower];
            Vector::<3>::new(x, y, joints[tower])
        });
        // The tool holder is a rod away from all three rod ends: below the center of their circle.
        let (one, two) = (second - first, third - first);
        let normal = one.cross(&two);
        let area = normal.norm_squared();
        let to_center = (two.cross(&normal) * one.norm_squared()
            + normal.cross(&one) * two.norm_squared())
            / (2.0 * area);
        let drop = self.rod * self.rod - to_center.norm_squared();
        if drop.is_nan() || drop < 0.0 {
            return Err(KinematicsError::Reach {
                part: "the circle through the upper ends of the rods",
                distance: to_center.norm(),
                low: 0.0,
                high: self.rod,
            });
        }
        let down = normal * (drop / area).sqrt();
        Ok((first + to_center - down, Vector::<3>::z()))
    }

    fn branches(&self, pose: &ToolPose, _near: &[f64; 3]) -> Result<Branches<3>, KinematicsError> {
        let tip = upright(pose)?;
        let mut heights = [0.0; 3];
        for (height, [x, y]) in heights.iter_mut().zip(self.towers) {
            let beside = (tip.x - x).hypot(tip.y - y);
            if beside > self.rod {
                return Err(KinematicsError::Reach {
                    part: "a rod, seen from above,",
                    distance: beside,
                    low: 0.0,
                    high: self.rod,
                });
            }
            *height = tip.z + ((self.rod - beside) * (self.rod + beside)).sqrt();
        }
        Ok(Branches::one(heights))
    }
}

fn preset() -> MachineConfig {
    let mut config = MachineConfig::new(
        "delta",
        "delta",
        ['U', 'V', 'W']
            .map(|name| AxisConfig::new(name, 500.0, 8_000.0, 300_000.0).with_travel(100.0, 600.0))
            .to_vec(),
    );
    config.geometry.insert("rod".to_owned(), 300.0);
    config.geometry.insert("radius".to_owned(), 150.0);
    config
}

fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    let [rod, radius, wx, wy, wz] = config.distances(&GEOMETRY)?;
    if rod <= radius {
        return Err(MachineError::field(
            "geometry.rod",
            rod,
            "more than geometry.radius",
        ));
    }
    let axes = ['U', 'V', 'W'].map(|letter| (letter, AxisKind::Linear));
    Assembly::build(Delta::new(rod, radius), [wx, wy, wz], axes, config)
}

/// Three carriages on towers that carry the tool by rods.
pub static DELTA: MachineModel = MachineModel {
    name: "delta",
    summary: "three carriages on towers carry the tool by rods: U V W",
    geometry: &GEOMETRY,
    preset,
    build,
};

inventory::submit!(DELTA);

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::AxisVector;

    fn tip(x: f64, y: f64, z: f64) -> ToolPose {
        ToolPose::upright(Vector::<3>::new(x, y, z)).unwrap()
    }

    #[test]
    fn carriages_at_one_height_hold_the_tool_in_the_middle() {
        let machine = build(&preset()).unwrap();
        let height = (300.0_f64.powi(2) - 150.0_f64.powi(2)).sqrt();
        let axes = AxisVector::from([height + 7.0; 3]);
        let pose = machine.forward(&axes).unwrap();
        assert!(
            (pose.tip() - tip(0.0, 0.0, 7.0).tip()).norm() < 1e-12,
            "{pose:?}"
        );
    }

    #[test]
    fn towards_a_tower_its_carriage_rises() {
        let machine = build(&preset()).unwrap();
        let axes = machine
            .inverse(&tip(0.0, 100.0, 0.0), &AxisVector::zeros(3))
            .unwrap();
        let height = (300.0_f64.powi(2) - 50.0_f64.powi(2)).sqrt();
        assert!((axes[0] - height).abs() < 1e-12, "{axes:?}");
        assert!(
            (axes[1] - axes[2]).abs() < 1e-12 && axes[1] < axes[0],
            "{axes:?}"
        );
    }

    #[test]
    fn what_the_rods_cannot_span_is_refused() {
        let machine = build(&preset()).unwrap();
        let refused = machine.inverse(&tip(0.0, -160.0, 0.0), &AxisVector::zeros(3));
        assert_eq!(
            refused.unwrap_err().to_string(),
            "out of reach: a rod, seen from above, would span 310 mm, but can span 0 to 300 mm; \
             10 mm too far"
        );
        let apart = machine.forward(&AxisVector::from([600.0, 0.0, 0.0]));
        assert!(
            matches!(apart, Err(KinematicsError::Reach { .. })),
            "{apart:?}"
        );
        let mut config = preset();
        config.geometry.insert("rod".to_owned(), 150.0);
        assert!(build(&config).is_err(), "rods that span nothing");
    }
}
