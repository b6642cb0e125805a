//! Checks a machine file field by field.
//!
//! Source: the fields of [`toolglide_kinematics::Axis`]. Not here: which axes a model needs, which
//! the model itself checks.

use crate::drive::DriveConfig;
use crate::error::MachineError;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use toolglide_kinematics::numeric::LARGEST_MAGNITUDE;
use toolglide_kinematics::{Axis, AxisKind, AxisLimits, SamplePeriod, Tolerance};

/// Tolerance where a machine file names none, mm: fine milling.
const DEFAULT_TOLERANCE: f64 = 0.01;

/// Period of the set-points where a machine file names none, s: what most drives take.
const DEFAULT_PERIOD: f64 = 0.001;

/// Reference points that an axis may have.
const MAX_REFERENCES: usize = 4;

/// What is asked of every limit, tolerance and period.
const POSITIVE: &str = "positive and finite";

/// A machine: its model, its axes in machine order, and how it is used where nobody says otherwise.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MachineConfig {
    /// Model of the machine, such as "gantry".
    pub model: String,
    /// Name of this machine.
    pub name: String,
    /// Corner tolerance where a program asks for none, mm.
    #[serde(default = "default_tolerance")]
    #[schemars(range(min = 0.0))]
    pub tolerance_mm: f64,
    /// Time between two set-points, s.
    #[serde(default = "default_period")]
    #[schemars(range(min = 0.0))]
    pub period_s: f64,
    /// Distances in the structure of the machine that its model asks for, mm.
    #[serde(default)]
    pub geometry: BTreeMap<String, f64>,
    /// Time constants of the filters of the method fir, s; without them they are chosen.
    #[serde(default)]
    pub fir_s: Vec<f64>,
    /// Modes of vibration, which the filters of the method fir silence where no time constants are
    /// given.
    #[serde(default)]
    pub mode: Vec<ModeConfig>,
    /// The drives of all axes; without it only the plan is known.
    #[serde(default)]
    pub drive: Option<DriveConfig>,
    /// The axes, in machine order.
    pub axis: Vec<AxisConfig>,
}

/// A mode of vibration of the structure.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModeConfig {
    /// Letter of the axis whose acceleration excites it.
    pub axis: char,
    /// Undamped natural frequency, Hz.
    #[schemars(range(min = 0.0))]
    pub frequency_hz: f64,
    /// Damping ratio, from 0 to below 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub damping: f64,
    /// Modal mass as a share of the mass of the axis; 0 for what the drive does not feel.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub mass_share: f64,
    /// What the tool moves along X, Y and Z per unit of the mode; none for a beam that is only watched.
    #[serde(default)]
    pub tool: [f64; 3],
    /// What the encoder sees of the mode: 1 for a ball screw with a scale at the table.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub encoder: f64,
}

impl ModeConfig {
    /// A mode that the drive does not feel and the tool does not have.
    #[must_use]
    pub fn new(axis: char, frequency_hz: f64, damping: f64) -> Self {
        Self {
            axis,
            frequency_hz,
            damping,
            mass_share: 0.0,
            tool: [0.0; 3],
            encoder: 0.0,
        }
    }
}

/// One axis. Limits and travel are in mm for a linear axis and in degrees for a rotary one.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisConfig {
    /// Letter of the axis, as programs write it.
    pub name: char,
    /// Largest velocity, mm/s or degrees/s.
    #[schemars(range(min = 0.0))]
    pub velocity: f64,
    /// Largest acceleration, mm/s² or degrees/s².
    #[schemars(range(min = 0.0))]
    pub acceleration: f64,
    /// Largest jerk, mm/s³ or degrees/s³.
    #[schemars(range(min = 0.0))]
    pub jerk: f64,
    /// Lowest and highest position, mm or degrees; an axis without travel has no ends.
    pub travel: Option<[f64; 2]>,
    /// Whether the axis counts against the direction that its model draws.
    #[serde(default)]
    pub reversed: bool,
    /// Position of the axis where its model is at 0, mm or degrees.
    #[serde(default)]
    pub zero: f64,
    /// Positions at the reference points, mm or degrees: that of `G28` first, then those of `G30`, `G30 P3`
    /// and `G30 P4`; 0 where none is written.
    #[serde(default)]
    #[schemars(length(max = 4))]
    pub reference: Vec<f64>,
    /// What is different about the drive of this axis.
    #[serde(default)]
    pub drive: Option<DriveConfig>,
}

fn default_tolerance() -> f64 {
    DEFAULT_TOLERANCE
}

fn default_period() -> f64 {
    DEFAULT_PERIOD
}

impl MachineConfig {
    /// A machine of these axes with the usual tolerance and period.
    #[must_use]
    pub fn new(model: &str, name: &str, axis: Vec<AxisConfig>) -> Self {
        Self {
            model: model.to_owned(),
            name: name.to_owned(),
            tolerance_mm: DEFAULT_TOLERANCE,
            period_s: DEFAULT_PERIOD,
            geometry: BTreeMap::new(),
            fir_s: Vec::new(),
            mode: Vec::new(),
            drive: None,
            axis,
        }
    }

    /// The tolerance where a program asks for none.
    ///
    /// # Errors
    /// [`MachineError::Field`] unless it is positive and finite.
    pub fn tolerance(&self) -> Result<Tolerance, MachineError> {
        Tolerance::new(self.tolerance_mm)
            .map_err(|_| MachineError::field("tolerance_mm", self.tolerance_mm, POSITIVE))
    }

    /// The period of the set-points.
    ///
    /// # Errors
    /// [`MachineError::Field`] unless it is positive and finite.
    pub fn period(&self) -> Result<SamplePeriod, MachineError> {
        SamplePeriod::new(self.period_s)
            .map_err(|_| MachineError::field("period_s", self.period_s, POSITIVE))
    }

    /// The modes of vibration, each of an axis that there is.
    ///
    /// # Errors
    /// [`MachineError::Field`] names the mode and what is wrong with it.
    pub fn modes(&self) -> Result<&[ModeConfig], MachineError> {
        for mode in &self.mode {
            let field = |quantity: &str| format!("mode of axis {}: {quantity}", mode.axis);
            if !self.axis.iter().any(|axis| axis.name == mode.axis) {
                let letters = self.letters();
                return Err(MachineError::field(
                    "mode: axis",
                    format!("{} of a machine with axes {letters}", mode.axis),
                    "an axis of the machine",
                ));
            }
            if !(mode.frequency_hz > 0.0 && mode.frequency_hz.is_finite()) {
                return Err(MachineError::field(
                    field("frequency_hz"),
                    mode.frequency_hz,
                    POSITIVE,
                ));
            }
            if !(0.0..1.0).contains(&mode.damping) {
                return Err(MachineError::field(
                    field("damping"),
                    mode.damping,
                    "from 0 to below 1",
                ));
            }
            if !(0.0..1.0).contains(&mode.mass_share) {
                return Err(MachineError::field(
                    field("mass_share"),
                    mode.mass_share,
                    "from 0 to below 1",
                ));
            }
            if !(0.0..=1.0).contains(&mode.encoder) {
                return Err(MachineError::field(
                    field("encoder"),
                    mode.encoder,
                    "from 0 to 1",
                ));
            }
            if let Some(share) = mode.tool.iter().find(|share| !share.is_finite()) {
                return Err(MachineError::field(field("tool"), share, "finite"));
            }
        }
        Ok(&self.mode)
    }

    /// The reference points that some axis names: X Y Z in mm and A B C in degrees, 0 for an axis that does
    /// not name one.
    ///
    /// # Errors
    /// [`MachineError::Field`] for an axis with more than four of them, or with one that is not finite.
    pub fn reference_points(&self) -> Result<Vec<[f64; 6]>, MachineError> {
        let most = self.axis.iter().map(|axis| axis.reference.len()).max();
        let mut points = vec![[0.0; 6]; most.unwrap_or(0)];
        for axis in &self.axis {
            let field = || format!("axis {}: reference", axis.name);
            if axis.reference.len() > MAX_REFERENCES {
                let bound = "a list of four numbers at most";
                return Err(MachineError::field(field(), axis.reference.len(), bound));
            }
            let place = "XYZABC".find(axis.name);
            for (point, &value) in points.iter_mut().zip(&axis.reference) {
                if value.is_nan() || value.abs() >= LARGEST_MAGNITUDE {
                    return Err(MachineError::field(field(), value, "finite"));
                }
                if let Some(place) = place {
                    point[place] = value;
                }
            }
        }
        Ok(points)
    }

    /// Letters of the axes, in machine order, as in "XYZ".
    #[must_use]
    pub fn letters(&self) -> String {
        self.axis.iter().map(|axis| axis.name).collect()
    }
}

impl AxisConfig {
    /// An axis without ends.
    #[must_use]
    pub fn new(name: char, velocity: f64, acceleration: f64, jerk: f64) -> Self {
        Self {
            name,
            velocity,
            acceleration,
            jerk,
            travel: None,
            reversed: false,
            zero: 0.0,
            reference: Vec::new(),
            drive: None,
        }
    }

    /// The same axis with ends, mm or degrees.
    #[must_use]
    pub fn with_travel(mut self, low: f64, high: f64) -> Self {
        self.travel = Some([low, high]);
        self
    }

    /// The axis as one that moves in mm.
    ///
    /// # Errors
    /// [`MachineError::Field`] names the limit or travel that it must not have.
    pub fn linear(&self) -> Result<Axis, MachineError> {
        self.of_kind(AxisKind::Linear)
    }

    /// The axis as one that turns: degrees in the file, rad from here on.
    ///
    /// # Errors
    /// As [`AxisConfig::linear`].
    pub fn rotary(&self) -> Result<Axis, MachineError> {
        self.of_kind(AxisKind::Rotary)
    }

    /// The axis as one of this kind.
    ///
    /// # Errors
    /// As [`AxisConfig::linear`].
    pub fn of_kind(&self, kind: AxisKind) -> Result<Axis, MachineError> {
        let unit = file_unit(kind);
        for (quantity, value) in [
            ("velocity", self.velocity),
            ("acceleration", self.acceleration),
            ("jerk", self.jerk),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(self.refuse(quantity, value, POSITIVE));
            }
        }
        let limits = AxisLimits::new(
            self.velocity * unit,
            self.acceleration * unit,
            self.jerk * unit,
        )
        .map_err(|refused| self.refuse("a limit", refused, POSITIVE))?;
        let travel = match self.travel {
            Some([low, high]) if low < high && low.is_finite() && high.is_finite() => {
                Some((low * unit, high * unit))
            }
            Some([low, high]) => {
                return Err(self.refuse(
                    "travel",
                    format!("[{low}, {high}]"),
                    "two finite numbers, the lower first",
                ));
            }
            None => None,
        };
        if self.zero.is_nan() || self.zero.abs() >= LARGEST_MAGNITUDE {
            return Err(self.refuse("zero", self.zero, "finite"));
        }
        Ok(Axis {
            name: self.name,
            kind,
            limits,
            travel,
        })
    }

    fn refuse(
        &self,
        quantity: &str,
        value: impl std::fmt::Display,
        bound: &'static str,
    ) -> MachineError {
        MachineError::field(format!("axis {}: {quantity}", self.name), value, bound)
    }
}

/// The unit of positions in machine files, in mm or rad: degrees for rotary axes.
pub(crate) fn file_unit(kind: AxisKind) -> f64 {
    match kind {
        AxisKind::Linear => 1.0,
        AxisKind::Rotary => 1.0_f64.to_radians(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_that_are_not_positive_and_finite_are_named() {
        for value in [0.0, -3.0, f64::NAN, f64::INFINITY] {
            let axis = AxisConfig::new('Y', 100.0, value, 1e5);
            assert_eq!(
                axis.linear().unwrap_err().to_string(),
                format!("axis Y: acceleration is {value}, but must be positive and finite")
            );
        }
    }

    #[test]
    fn travel_that_is_no_interval_is_refused() {
        for travel in [
            [1.0, 1.0],
            [2.0, 1.0],
            [f64::NAN, 1.0],
            [0.0, f64::INFINITY],
        ] {
            let mut axis = AxisConfig::new('X', 100.0, 1000.0, 1e5);
            axis.travel = Some(travel);
            assert!(
                matches!(axis.linear(), Err(MachineError::Field { .. })),
                "{travel:?}"
            );
        }
    }

    #[test]
    fn a_mode_belongs_to_an_axis_and_has_a_frequency_and_a_damping() {
        let axis = AxisConfig::new('X', 100.0, 1000.0, 1e5);
        let mut config = MachineConfig::new("gantry", "m", vec![axis]);
        let mode = ModeConfig::new;
        config.mode = vec![mode('X', 7.4, 0.01)];
        assert_eq!(config.modes().unwrap().len(), 1, "one mode");
        for wrong in [
            mode('Y', 7.4, 0.0),
            mode('X', 0.0, 0.0),
            mode('X', f64::NAN, 0.0),
            mode('X', 7.4, 1.0),
            mode('X', 7.4, -0.1),
        ] {
            config.mode = vec![wrong.clone()];
            assert!(
                matches!(config.modes(), Err(MachineError::Field { .. })),
                "{wrong:?}"
            );
        }
    }

    #[test]
    fn reference_points_are_those_of_all_axes_together() {
        let mut y = AxisConfig::new('Y', 100.0, 1000.0, 1e5);
        y.reference = vec![300.0, 150.0];
        let mut c = AxisConfig::new('C', 100.0, 1000.0, 1e5);
        c.reference = vec![90.0];
        let mut config = MachineConfig::new("gantry", "m", vec![y, c]);
        let points = config.reference_points().unwrap();
        let expected = [
            [0.0, 300.0, 0.0, 0.0, 0.0, 90.0],
            [0.0, 150.0, 0.0, 0.0, 0.0, 0.0],
        ];
        assert_eq!(points, expected, "points");
        for wrong in [vec![f64::NAN], vec![0.0; 5]] {
            config.axis[0].reference = wrong;
            assert!(
                matches!(config.reference_points(), Err(MachineError::Field { .. })),
                "wrong"
            );
        }
    }

    #[test]
    fn a_rotary_axis_is_given_in_degrees() {
        let mut axis = AxisConfig::new('C', 180.0, 360.0, 3600.0);
        axis.travel = Some([-90.0, 90.0]);
        let axis = axis.rotary().unwrap();
        assert!(
            (axis.limits.velocity() - std::f64::consts::PI).abs() < 1e-12,
            "{axis:?}"
        );
        assert_eq!(axis.kind, AxisKind::Rotary, "kind");
        let (low, high) = axis.travel.unwrap();
        assert!(
            (high - low - std::f64::consts::PI).abs() < 1e-12,
            "{axis:?}"
        );
    }
}
