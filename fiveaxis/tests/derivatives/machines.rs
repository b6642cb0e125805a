//! Inverse kinematics of two kinds of machine, written out for series in time.
//!
//! Source: the directions of the machine axes as the workpiece sees them, without any angle. Not here:
//! choosing a branch.

use crate::jet::{Jet, JetVector};
use toolglide_kinematics::{Axis, MachineKinematics};
use toolglide_machines::find;

/// Which inverse kinematics a machine has.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Form {
    TableAc,
    HeadBc,
}

/// A machine, its form, and its distances.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    form: Form,
    pub(crate) machine: Box<dyn MachineKinematics>,
    pub(crate) axes: Vec<Axis>,
    /// From machine zero to the tilting axis.
    tilt_axis: [f64; 3],
    /// From there to the center of the table; or from the C axis of a head to its spindle.
    offset: [f64; 3],
    pivot: f64,
}

impl Case {
    pub(crate) fn new(name: &'static str, changes: &[(&str, f64)]) -> Self {
        let model = find(name).unwrap();
        let mut config = (model.preset)();
        for axis in &mut config.axis {
            axis.travel = None;
        }
        for &(distance, value) in changes {
            config.geometry.insert(distance.to_owned(), value);
        }
        let of = |distance: &str| config.geometry.get(distance).copied().unwrap_or(0.0);
        let (form, tilt_axis, offset) = if name == "table-ac" {
            (
                Form::TableAc,
                ["a_axis_x", "a_axis_y", "a_axis_z"].map(of),
                ["c_axis_x", "c_axis_y", "c_axis_z"].map(of),
            )
        } else {
            (
                Form::HeadBc,
                [0.0; 3],
                [of("b_axis_x"), of("spindle_y"), 0.0],
            )
        };
        let pivot = of("pivot");
        let machine = (model.build)(&config).unwrap();
        let axes = machine.axes().to_vec();
        Self {
            name,
            form,
            machine,
            axes,
            tilt_axis,
            offset,
            pivot,
        }
    }

    /// The axes where the tilting axis is at a positive angle (`side` 1) or a negative one (-1).
    pub(crate) fn axes_at(&self, tip: JetVector, tool: JetVector, side: f64) -> [Jet; 5] {
        let [i, j, k] = tool.0;
        let across = (i * i + j * j).root();
        let scale = Jet::constant(side).over(across);
        let spin = match self.form {
            Form::TableAc => Jet::angle(i.times(side), j.times(side)),
            Form::HeadBc => Jet::angle(j.times(side), i.times(side)),
        };
        let [x, y, z] = self.linear(tip, tool, [i * scale, j * scale]);
        [x, y, z, Jet::angle(across, k).times(side), spin]
    }

    /// The axes while the tool stays at the pole and C where it is.
    pub(crate) fn axes_at_pole(&self, tip: JetVector, spin: f64) -> [Jet; 5] {
        let up = JetVector::constant([0.0, 0.0, 1.0]);
        let (sine, cosine) = spin.sin_cos();
        let lean = match self.form {
            Form::TableAc => [sine, cosine],
            Form::HeadBc => [cosine, sine],
        };
        let [x, y, z] = self.linear(tip, up, lean.map(Jet::constant));
        [x, y, z, Jet::constant(0.0), Jet::constant(spin)]
    }

    /// The axes while the rotary ones go as they are told.
    pub(crate) fn axes_of_rotary(&self, tip: JetVector, tilt: Jet, spin: Jet) -> [Jet; 5] {
        let ((lean, up), (sine, cosine)) = (tilt.sin_cos(), spin.sin_cos());
        let [i, j] = match self.form {
            Form::TableAc => [sine, cosine],
            Form::HeadBc => [cosine, sine],
        };
        let tool = JetVector([lean * i, lean * j, up]);
        let [x, y, z] = self.linear(tip, tool, [i, j]);
        [x, y, z, tilt, spin]
    }

    /// The linear axes, where a tool that tilts to the positive side leans along X and Y like this.
    fn linear(&self, tip: JetVector, tool: JetVector, [i, j]: [Jet; 2]) -> [Jet; 3] {
        let up = JetVector::constant([0.0, 0.0, 1.0]);
        let [x, y, z] = self.offset.map(Jet::constant);
        match self.form {
            // The directions of the machine axes seen from the workpiece: Z is the tool, and X is the
            // tilting axis, across the tool and the axis of the table.
            Form::TableAc => {
                let along_x = JetVector([j, -i, Jet::constant(0.0)]);
                let along_y = tool.cross(along_x);
                let point = tip + along_x.scaled(x) + up.cross(along_x).scaled(y) + up.scaled(z);
                let [a, b, c] = self.tilt_axis.map(Jet::constant);
                [
                    a + along_x.dot(point),
                    b + along_y.dot(point),
                    c + tool.dot(point),
                ]
            }
            // The pivot is behind the tip along the tool.
            Form::HeadBc => {
                let forward = JetVector([i, j, Jet::constant(0.0)]);
                let sideward = up.cross(forward);
                let reach = Jet::constant(self.pivot);
                let slide = tip + tool.scaled(reach) - forward.scaled(x) - sideward.scaled(y);
                let [p, q, r] = slide.0;
                [p + x, q + y, r - reach]
            }
        }
    }
}

/// The machines that are looked at.
pub(crate) fn cases() -> [Case; 4] {
    [
        Case::new("table-ac", &[]),
        Case::new("head-bc", &[]),
        Case::new("table-ac", &[("c_axis_x", 1.0), ("c_axis_y", -2.0)]),
        Case::new("head-bc", &[("b_axis_x", 20.0), ("spindle_y", 3.0)]),
    ]
}

/// Velocity, acceleration and jerk that an axis may have.
pub(crate) fn limits(axis: &Axis) -> [f64; 3] {
    let limits = &axis.limits;
    [limits.velocity(), limits.acceleration(), limits.jerk()]
}
