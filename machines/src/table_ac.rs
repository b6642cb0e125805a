//! Models a vertical machine whose table tilts about X and turns the workpiece: axes X, Y, Z, A and
//! C.
//!
//! Source: section 5.2, p = a0 + Rx(A)·(d + Rz(C)·(P + w)) and Rx(A)·Rz(C)·O = e_z. Not here:
//! the kinematics of tilting tables, see `tilting_table`.

use crate::config::MachineConfig;
use crate::error::MachineError;
use crate::geometry::{Distance, WORKPIECE_ON_TABLE};
use crate::registry::MachineModel;
use crate::swivel::about_x;
use crate::tilting_table::{self, Tilt, geometry};
use toolglide_kinematics::{MachineKinematics, Vector};

const GEOMETRY: [Distance; 10] = geometry!("a", "A");

/// The table tilts about X; O = (sA·sC, sA·cC, cA).
#[derive(Debug)]
struct AboutX;

impl Tilt for AboutX {
    const LETTER: char = 'A';

    fn about(angle: (f64, f64), vector: Vector<3>) -> Vector<3> {
        about_x(angle, vector)
    }

    fn swivel(orientation: Vector<3>) -> Vector<3> {
        Vector::<3>::new(orientation.y, orientation.x, orientation.z)
    }
}

fn preset() -> MachineConfig {
    tilting_table::preset::<AboutX>(
        "table-ac",
        std::array::from_fn(|distance| GEOMETRY[distance].name),
    )
}

fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    tilting_table::build::<AboutX>(config, &GEOMETRY)
}

/// A table that tilts about X and carries a rotary table.
pub static TABLE_AC: MachineModel = MachineModel {
    name: "table-ac",
    summary: "the table tilts about X and turns the workpiece: X Y Z A C",
    geometry: &GEOMETRY,
    preset,
    build,
};

inventory::submit!(TABLE_AC);

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::{AxisKind, AxisVector, KinematicsError, ToolPose};

    fn machine(geometry: &[(&str, f64)]) -> Box<dyn MachineKinematics> {
        let mut config = preset();
        for axis in &mut config.axis {
            axis.travel = None;
        }
        for &(name, value) in geometry {
            config.geometry.insert(name.to_owned(), value);
        }
        build(&config).unwrap()
    }

    fn degrees<const N: usize>(angles: [f64; N]) -> [f64; N] {
        angles.map(f64::to_radians)
    }

    #[test]
    fn both_branches_of_a_pose_are_those_of_an_independent_computation() {
        let machine = machine(&[
            ("a_axis_x", 10.0),
            ("a_axis_y", -20.0),
            ("a_axis_z", 30.0),
            ("c_axis_x", 1.0),
            ("c_axis_y", 2.0),
            ("c_axis_z", -60.0),
            ("workpiece_x", -50.0),
            ("workpiece_y", -50.0),
            ("workpiece_z", 5.0),
        ]);
        let orientation = Vector::<3>::new(0.3, -0.4, 0.75_f64.sqrt());
        let pose = ToolPose::new(Vector::<3>::new(12.0, -7.0, 33.0), orientation).unwrap();
        let [thirty] = degrees([30.0]);
        let branches = [
            [75.6, 12.47743001, 23.34744112, thirty, 2.498091544797],
            [-53.6, -49.0133284, 21.34744112, -thirty, -0.643501108793],
        ];
        for (first, second) in [(0, 1), (1, 0)] {
            // A little off in C, or the other branch would be as far on two turns.
            let mut near = AxisVector::from(branches[first]);
            near[4] += 0.001 * (branches[second][4] - branches[first][4]);
            let solutions = machine.solutions(&pose, &near).unwrap();
            assert_eq!(solutions.len(), 2, "both branches");
            for (got, wanted) in solutions.iter().zip([branches[first], branches[second]]) {
                for (got, wanted) in got.iter().zip(wanted) {
                    assert!((got - wanted).abs() < 6e-9, "{solutions:?}");
                }
            }
            assert_eq!(machine.inverse(&pose, &near).unwrap(), solutions[0]);
        }
    }

    #[test]
    fn the_tool_leans_over_the_side_of_the_workpiece_that_faces_it() {
        let machine = machine(&[]);
        let [quarter, eighth] = degrees([90.0, 45.0]);
        let lean = |a, c| {
            let axes = AxisVector::from([0.0, 0.0, 0.0, a, c]);
            machine.forward(&axes).unwrap().orientation()
        };
        let half = 0.5_f64.sqrt();
        for (got, wanted) in [
            (lean(eighth, 0.0), [0.0, half, half]),
            (lean(eighth, quarter), [half, 0.0, half]),
            (lean(-eighth, 0.0), [0.0, -half, half]),
            (lean(quarter, quarter), [1.0, 0.0, 0.0]),
        ] {
            assert!((got - Vector::from(wanted)).norm() < 1e-15, "{got}");
        }
    }

    #[test]
    fn the_turn_of_c_is_the_nearest_within_its_travel() {
        let pose = ToolPose::new(Vector::zeros(), Vector::<3>::new(0.6, 0.0, 0.8)).unwrap();
        let free = machine(&[]);
        let near = |c: f64| AxisVector::from([0.0, 0.0, 0.0, 0.5, c.to_radians()]);
        let c_of = |machine: &dyn MachineKinematics, turns: f64| {
            machine.inverse(&pose, &near(turns)).unwrap()[4].to_degrees()
        };
        for (turns, wanted) in [(80.0, 90.0), (720.0, 810.0), (-700.0, -630.0)] {
            assert!((c_of(&*free, turns) - wanted).abs() < 1e-9, "{turns}");
        }
        let mut config = preset();
        config.axis[3].travel = Some([0.0, 120.0]);
        config.axis[4].travel = Some([-400.0, 300.0]);
        let ended = build(&config).unwrap();
        for (turns, wanted) in [(80.0, 90.0), (720.0, 90.0), (-700.0, -270.0)] {
            assert!((c_of(&*ended, turns) - wanted).abs() < 1e-9, "{turns}");
        }
        config.axis[4].travel = Some([-80.0, 80.0]);
        let refused = build(&config).unwrap().inverse(&pose, &near(0.0));
        assert!(
            matches!(
                refused,
                Err(KinematicsError::Travel { axis: 'C', kind: AxisKind::Rotary, position, .. })
                    if (position.to_degrees() - 90.0).abs() < 1e-9
            ),
            "{refused:?}"
        );
    }

    #[test]
    fn a_motion_ends_where_the_travel_of_c_ends() {
        for travel in [[0.0, 120.0], [-120.0, 120.0]] {
            let mut config = preset();
            config.axis[3].travel = Some(travel);
            config.axis[4].travel = Some([-200.0, 200.0]);
            let machine = build(&config).unwrap();
            let [mut c, step, end] = degrees([0.0, 1.0, 200.0]);
            let mut axes = AxisVector::from([0.0, 0.0, 0.0, 0.5, c]);
            let refused = loop {
                c += step;
                let (lean, height) = 0.5_f64.sin_cos();
                let orientation = Vector::<3>::new(lean * c.sin(), lean * c.cos(), height);
                let pose = ToolPose::new(Vector::zeros(), orientation).unwrap();
                match machine.follow(&pose, &axes) {
                    Ok(next) => axes = next,
                    Err(refused) => break refused,
                }
            };
            assert!((axes[4] - end).abs() < 1e-9, "{axes:?}");
            assert!(
                matches!(refused, KinematicsError::Travel { axis: 'C', position, .. }
                    if (position - end - step).abs() < 1e-9),
                "{refused}"
            );
        }
    }

    #[test]
    fn c_stays_at_the_pole_and_a_changes_sign_through_it() {
        let machine = machine(&[]);
        let mut axes = AxisVector::from([0.0, 0.0, 0.0, 0.1, 0.7]);
        for step in -1000..=1000 {
            let lean = -1e-4 * f64::from(step);
            let orientation = Vector::<3>::new(
                lean.sin() * 0.7_f64.sin(),
                lean.sin() * 0.7_f64.cos(),
                lean.cos(),
            );
            let pose = ToolPose::new(Vector::zeros(), orientation).unwrap();
            axes = machine.inverse(&pose, &axes).unwrap();
            assert!((axes[3] - lean).abs() < 1e-13, "A at {lean}: {axes:?}");
            assert!((axes[4] - 0.7).abs() < 1e-11, "C at {lean}: {axes:?}");
        }
    }

    #[test]
    fn signs_zeros_and_tool_length_move_the_axes_and_not_the_tool() {
        let mut config = preset();
        config.axis[4].reversed = true;
        config.axis[4].zero = 30.0;
        config.axis[0].reversed = true;
        config.axis[2].zero = 100.0;
        config.geometry.insert("tool_length".to_owned(), 80.0);
        let other = build(&config).unwrap();
        let orientation = Vector::<3>::new(0.48, 0.36, 0.8);
        let pose = ToolPose::new(Vector::<3>::new(5.0, 6.0, 7.0), orientation).unwrap();
        let near = AxisVector::zeros(5);
        let usual = build(&preset()).unwrap().inverse(&pose, &near).unwrap();
        let axes = other.inverse(&pose, &near).unwrap();
        let [turn] = degrees([30.0]);
        for (got, wanted) in axes.iter().zip([
            -usual[0],
            usual[1],
            usual[2] + 180.0,
            usual[3],
            turn - usual[4],
        ]) {
            assert!((got - wanted).abs() < 1e-12, "{axes:?} from {usual:?}");
        }
    }

    #[test]
    fn offsets_that_are_missing_unknown_or_no_number_are_refused() {
        let refused = |change: fn(&mut MachineConfig)| {
            let mut config = preset();
            change(&mut config);
            build(&config).err().unwrap()
        };
        let missing = refused(|config| {
            config.geometry.remove("c_axis_z");
        });
        assert!(
            matches!(
                missing,
                MachineError::MissingDistance {
                    name: "c_axis_z",
                    ..
                }
            ),
            "{missing}"
        );
        let unknown = refused(|config| {
            config.geometry.insert("pivot".to_owned(), 1.0);
        });
        assert!(
            matches!(unknown, MachineError::UnknownDistance { .. }),
            "{unknown}"
        );
        let nan = refused(|config| {
            config.geometry.insert("a_axis_y".to_owned(), f64::NAN);
        });
        assert_eq!(
            nan.to_string(),
            "geometry.a_axis_y is NaN, but must be finite"
        );
        let swapped = refused(|config| config.axis.swap(3, 4));
        assert_eq!(
            swapped.to_string(),
            "the axes are X Y Z C A, but must be X Y Z A C, in this order"
        );
    }
}
