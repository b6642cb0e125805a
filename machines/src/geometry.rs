//! Reads the distances in the structure of a machine, as its model asks for them.
//!
//! Source: the table `[geometry]` of machine files. Not here: what a distance means to the
//! kinematics.

use crate::config::MachineConfig;
use crate::error::MachineError;
use toolglide_kinematics::numeric::LARGEST_MAGNITUDE;

/// A distance that a model asks for under `[geometry]`, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Its name in the machine file.
    pub name: &'static str,
    /// What it is, in one line.
    pub meaning: &'static str,
    /// Its value where a machine file leaves it out; `None` where it must be given.
    pub usual: Option<f64>,
    /// Whether it must be more than 0.
    pub positive: bool,
}

impl Distance {
    /// A distance that every machine file must give: wrong silence here is a crash.
    #[must_use]
    pub const fn required(name: &'static str, meaning: &'static str) -> Self {
        Self {
            name,
            meaning,
            usual: None,
            positive: false,
        }
    }

    /// A distance that is 0 where a machine file leaves it out.
    #[must_use]
    pub const fn optional(name: &'static str, meaning: &'static str) -> Self {
        Self {
            usual: Some(0.0),
            ..Self::required(name, meaning)
        }
    }

    /// The same distance, which must be more than 0.
    #[must_use]
    pub const fn positive(self) -> Self {
        Self {
            positive: true,
            ..self
        }
    }
}

/// Where the workpiece zero lies on a machine that does not move the workpiece.
pub const WORKPIECE: [Distance; 3] = [
    Distance::optional(
        "workpiece_x",
        "from machine zero to workpiece zero, along X",
    ),
    Distance::optional(
        "workpiece_y",
        "from machine zero to workpiece zero, along Y",
    ),
    Distance::optional(
        "workpiece_z",
        "from machine zero to workpiece zero, along Z",
    ),
];

/// Where the workpiece zero lies on a table, which carries it along.
pub const WORKPIECE_ON_TABLE: [Distance; 3] = [
    Distance::optional(
        "workpiece_x",
        "from the middle of the table to workpiece zero, along X",
    ),
    Distance::optional(
        "workpiece_y",
        "from the middle of the table to workpiece zero, along Y",
    ),
    Distance::optional(
        "workpiece_z",
        "from the table face to workpiece zero, along Z",
    ),
];

impl MachineConfig {
    /// The distances that a model asks for, in its order.
    ///
    /// # Errors
    /// [`MachineError::MissingDistance`], [`MachineError::UnknownDistance`], and
    /// [`MachineError::Field`] for one that is not finite, or not positive where it must be.
    ///
    /// # Examples
    /// ```
    /// use toolglide_machines::{Distance, MachineConfig};
    /// let asked = [Distance::required("pivot", "from the B axis to the tool tip").positive()];
    /// let mut config = MachineConfig::new("head-bc", "fork", Vec::new());
    /// assert!(config.distances(&asked).is_err());
    /// config.geometry.insert("pivot".to_owned(), 250.0);
    /// assert_eq!(config.distances(&asked)?, [250.0]);
    /// # Ok::<(), toolglide_machines::MachineError>(())
    /// ```
    pub fn distances<const M: usize>(
        &self,
        asked: &[Distance; M],
    ) -> Result<[f64; M], MachineError> {
        let known = |name: &String| asked.iter().any(|distance| distance.name == name);
        if let Some(name) = self.geometry.keys().find(|&name| !known(name)) {
            return Err(MachineError::UnknownDistance {
                name: name.clone(),
                known: asked.iter().map(|distance| distance.name).collect(),
            });
        }
        let mut values = [0.0; M];
        for (value, distance) in values.iter_mut().zip(asked) {
            let given = self.geometry.get(distance.name).copied();
            *value = given
                .or(distance.usual)
                .ok_or(MachineError::MissingDistance {
                    name: distance.name,
                    meaning: distance.meaning,
                })?;
            let possible = value.abs() < LARGEST_MAGNITUDE;
            let (legal, bound) = if distance.positive {
                (*value > 0.0 && possible, "positive and finite")
            } else {
                (possible, "finite")
            };
            if !legal {
                let field = format!("geometry.{}", distance.name);
                return Err(MachineError::field(field, *value, bound));
            }
        }
        Ok(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASKED: [Distance; 2] = [
        Distance::required("pivot", "from the axis to the tip").positive(),
        Distance::optional("shift", "sideways"),
    ];

    fn read(given: &[(&str, f64)]) -> Result<[f64; 2], MachineError> {
        let mut config = MachineConfig::new("m", "m", Vec::new());
        for &(name, value) in given {
            config.geometry.insert(name.to_owned(), value);
        }
        config.distances(&ASKED)
    }

    #[test]
    fn what_may_be_left_out_is_zero() {
        let near = |got: [f64; 2], wanted: [f64; 2]| {
            got.iter()
                .zip(wanted)
                .all(|(got, wanted)| (got - wanted).abs() < 1e-15)
        };
        assert!(
            near(read(&[("pivot", 3.0)]).unwrap(), [3.0, 0.0]),
            "left out"
        );
        let both = [("shift", -2.0), ("pivot", 3.0)];
        assert!(
            near(read(&both).unwrap(), [3.0, -2.0]),
            "in the order asked"
        );
    }

    #[test]
    fn what_is_missing_unknown_or_no_distance_is_named() {
        assert_eq!(
            read(&[]).unwrap_err().to_string(),
            "geometry.pivot is missing: the distance from the axis to the tip, mm"
        );
        assert_eq!(
            read(&[("pivot", 3.0), ("piviot", 3.0)])
                .unwrap_err()
                .to_string(),
            "geometry.piviot is unknown; known: pivot, shift"
        );
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(
                read(&[("pivot", value)]).unwrap_err().to_string(),
                format!("geometry.pivot is {value}, but must be positive and finite")
            );
        }
        assert!(
            matches!(
                read(&[("pivot", 1.0), ("shift", f64::NAN)]),
                Err(MachineError::Field { .. })
            ),
            "shift"
        );
    }
}
