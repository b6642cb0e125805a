//! Axes side by side: straight ones at right angles, and beside them rotary and secondary ones that a
//! program moves itself.
//!
//! Source: a rotary table under a router, a wrap axis of a plasma cutter, a hot wire between two carriages:
//! words of RS274/NGC name the axes, and no tool pose stands behind them. Not here: machines whose axes
//! follow from a tool pose.

use crate::config::{AxisConfig, MachineConfig};
use crate::error::MachineError;
use crate::gantry::{ACCELERATION, JERK, VELOCITY};
use crate::registry::MachineModel;
use crate::structure::{Assembly, Branches, Structure, upright};
use toolglide_kinematics::numeric::LENGTH_SLACK;
use toolglide_kinematics::{AxisKind, KinematicsError, MachineKinematics, ToolPose, Vector};

/// Letters of the axes, in machine order.
const LETTERS: [char; 9] = ['X', 'Y', 'Z', 'A', 'B', 'C', 'U', 'V', 'W'];

/// Letters of the rotary ones.
const ROTARY: std::ops::Range<usize> = 3..6;

/// Most axes.
const MAX_AXES: usize = 6;

/// Names of the models, which differ in their presets alone.
const MODELS: [&str; 6] = [
    "gantry-a",
    "gantry-b",
    "gantry-c",
    "gantry-abc",
    "gantry-uvw",
    "hot-wire",
];

/// Limits of a rotary axis of the presets: degrees/s, degrees/s², degrees/s³.
const TURNING: [f64; 3] = [180.0, 1_800.0, 90_000.0];

/// Whether programs of a machine are planned in its axes, which no tool pose ties to each other: X Y, or
/// X Y Z, and others beside them.
#[must_use]
pub fn is_plain(config: &MachineConfig) -> bool {
    MODELS.contains(&config.model.as_str())
}

/// `N` axes of which the first are X and Y, and the third is Z where there is one.
#[derive(Clone, Copy, Debug)]
struct Plain<const N: usize> {
    height: bool,
}

impl<const N: usize> Structure<N> for Plain<N> {
    fn tool(&self, joints: &[f64; N]) -> Result<(Vector<3>, Vector<3>), KinematicsError> {
        let z = if self.height { joints[2] } else { 0.0 };
        Ok((Vector::<3>::new(joints[0], joints[1], z), Vector::<3>::z()))
    }

    fn branches(&self, pose: &ToolPose, near: &[f64; N]) -> Result<Branches<N>, KinematicsError> {
        let tip = upright(pose)?;
        let mut joints = *near;
        (joints[0], joints[1]) = (tip.x, tip.y);
        if self.height {
            joints[2] = tip.z;
        } else if tip.z.abs() > LENGTH_SLACK {
            return Err(KinematicsError::Unreachable {
                reason: "no axis moves the tool along Z",
            });
        }
        Ok(Branches::one(joints))
    }
}

/// The kinds of axes with these letters, in the order of all letters.
fn kinds(config: &MachineConfig) -> Result<Vec<(char, AxisKind)>, MachineError> {
    let given: Vec<char> = config.axis.iter().map(|axis| axis.name).collect();
    let mut wanted: Vec<char> = LETTERS
        .into_iter()
        .filter(|letter| matches!(letter, 'X' | 'Y') || given.contains(letter))
        .collect();
    // A machine of straight axes alone is a gantry.
    if wanted.iter().all(|letter| "XYZ".contains(*letter)) {
        wanted.push('A');
    }
    if given != wanted || given.len() > MAX_AXES {
        wanted.truncate(MAX_AXES);
        return Err(MachineError::Axes { given, wanted });
    }
    let rotary = |letter: &char| LETTERS[ROTARY].contains(letter);
    let kind = |letter: &char| match rotary(letter) {
        true => AxisKind::Rotary,
        false => AxisKind::Linear,
    };
    Ok(given.iter().map(|letter| (*letter, kind(letter))).collect())
}

fn build(config: &MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError> {
    let [] = config.distances(&[])?;
    if let Some(axis) = config.axis.iter().find(|axis| axis.reversed) {
        let field = format!("axis {}: reversed", axis.name);
        return Err(MachineError::field(
            field,
            true,
            "false where axes are those of the program",
        ));
    }
    if let Some(axis) = config.axis.iter().find(|axis| axis.zero.abs() > 0.0) {
        let field = format!("axis {}: zero", axis.name);
        return Err(MachineError::field(
            field,
            axis.zero,
            "0 where axes are those of the program",
        ));
    }
    let kinds = kinds(config)?;
    let height = kinds.get(2).is_some_and(|(letter, _)| *letter == 'Z');
    match *kinds.as_slice() {
        [a, b, c] => assembled([a, b, c], height, config),
        [a, b, c, d] => assembled([a, b, c, d], height, config),
        [a, b, c, d, e] => assembled([a, b, c, d, e], height, config),
        [a, b, c, d, e, f] => assembled([a, b, c, d, e, f], height, config),
        _ => Err(MachineError::Axes {
            given: config.axis.iter().map(|axis| axis.name).collect(),
            wanted: vec!['X', 'Y', 'Z', 'A'],
        }),
    }
}

fn assembled<const N: usize>(
    wanted: [(char, AxisKind); N],
    height: bool,
    config: &MachineConfig,
) -> Result<Box<dyn MachineKinematics>, MachineError> {
    Assembly::build(Plain { height }, [0.0; 3], wanted, config)
}

/// The preset of a model with these axes.
fn preset(model: &str, letters: &str) -> MachineConfig {
    let axis = |letter: char| {
        if LETTERS[ROTARY].contains(&letter) {
            AxisConfig::new(letter, TURNING[0], TURNING[1], TURNING[2])
        } else {
            AxisConfig::new(letter, VELOCITY, ACCELERATION, JERK)
        }
    };
    MachineConfig::new(model, model, letters.chars().map(axis).collect())
}

/// A gantry with a rotary axis along X, as under a plasma cutter or a router.
pub static GANTRY_A: MachineModel = MachineModel {
    name: MODELS[0],
    summary: "a gantry with a rotary axis that the program moves itself: X Y Z A",
    geometry: &[],
    preset: || preset(MODELS[0], "XYZA"),
    build,
};

/// A gantry with a rotary axis along Y.
pub static GANTRY_B: MachineModel = MachineModel {
    name: MODELS[1],
    summary: "the same with another one: X Y Z B",
    preset: || preset(MODELS[1], "XYZB"),
    ..GANTRY_A
};

/// A gantry with a turntable.
pub static GANTRY_C: MachineModel = MachineModel {
    name: MODELS[2],
    summary: "the same with another one: X Y Z C",
    preset: || preset(MODELS[2], "XYZC"),
    ..GANTRY_A
};

/// A gantry with three rotary axes.
pub static GANTRY_ABC: MachineModel = MachineModel {
    name: MODELS[3],
    summary: "the same with three of them: X Y Z A B C",
    preset: || preset(MODELS[3], "XYZABC"),
    ..GANTRY_A
};

/// A gantry with a second set of straight axes.
pub static GANTRY_UVW: MachineModel = MachineModel {
    name: MODELS[4],
    summary: "a gantry with a second set of straight axes: X Y Z U V W",
    preset: || preset(MODELS[4], "XYZUVW"),
    ..GANTRY_A
};

/// Two carriages with a hot wire between them.
pub static HOT_WIRE: MachineModel = MachineModel {
    name: MODELS[5],
    summary: "a wire between two carriages: X Y U V",
    preset: || preset(MODELS[5], "XYUV"),
    ..GANTRY_A
};

inventory::submit!(GANTRY_A);
inventory::submit!(GANTRY_B);
inventory::submit!(GANTRY_C);
inventory::submit!(GANTRY_ABC);
inventory::submit!(GANTRY_UVW);
inventory::submit!(HOT_WIRE);

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::AxisVector;

    /// Why a machine of these axes is refused.
    fn refused(letters: &str) -> String {
        match build(&preset("gantry-a", letters)) {
            Ok(_) => format!("{letters} is built"),
            Err(reason) => reason.to_string(),
        }
    }

    #[test]
    fn any_axes_in_their_order_are_a_machine() {
        for letters in ["XYA", "XYZA", "XYZAC", "XYUV", "XYZU", "XYZABC", "XYZAUV"] {
            let machine = build(&preset("gantry-a", letters)).unwrap();
            let kinds: Vec<_> = machine.axes().iter().map(|axis| axis.kind).collect();
            let rotary = letters.chars().map(|letter| "ABC".contains(letter));
            let rotary: Vec<_> = rotary.collect();
            let found: Vec<_> = kinds.iter().map(|kind| *kind == AxisKind::Rotary).collect();
            assert_eq!(found, rotary, "{letters}");
        }
        for (letters, wanted) in [
            ("XYAZ", "X Y Z A"),
            ("XZA", "X Y Z A"),
            ("XYZ", "X Y Z A"),
            ("XYZABCU", "X Y Z A B C"),
            ("XYQ", "X Y A"),
        ] {
            let reason = refused(letters);
            assert!(
                reason.ends_with(&format!("must be {wanted}, in this order")),
                "{reason}"
            );
        }
    }

    #[test]
    fn the_tool_is_where_the_straight_axes_are_and_the_others_stay() {
        let machine = build(&preset("gantry-a", "XYZA")).unwrap();
        let axes = AxisVector::from([1.0, 2.0, 3.0, 4.0]);
        let pose = machine.forward(&axes).unwrap();
        assert_eq!(pose.tip(), Vector::<3>::new(1.0, 2.0, 3.0), "tip");
        let back = machine.inverse(&pose, &AxisVector::from([0.0, 0.0, 0.0, 4.0]));
        assert_eq!(back.unwrap(), axes, "A stays");
    }

    #[test]
    fn axes_count_as_the_program_does() {
        let mut config = preset("gantry-a", "XYZA");
        config.axis[3].reversed = true;
        let reason = build(&config).map(drop).unwrap_err().to_string();
        let bound =
            "axis A: reversed is true, but must be false where axes are those of the program";
        assert_eq!(reason, bound);
    }
}
