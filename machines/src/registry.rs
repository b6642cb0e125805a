//! Lists the registered machines.
//!
//! Source: machines register themselves by the `inventory` crate, which promises no order, so every
//! list is sorted here. Not here: machines.

use crate::config::MachineConfig;
use crate::error::MachineError;
use crate::geometry::Distance;
use toolglide_kinematics::MachineKinematics;

/// A kind of machine, and how to build one.
#[derive(Clone, Copy, Debug)]
pub struct MachineModel {
    /// Name by which machine files and users ask for it.
    pub name: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
    /// The distances that it asks for under `[geometry]`.
    pub geometry: &'static [Distance],
    /// The machine that is meant where only the model is named.
    pub preset: fn() -> MachineConfig,
    /// Builds the machine that a machine file describes.
    pub build: fn(&MachineConfig) -> Result<Box<dyn MachineKinematics>, MachineError>,
}

inventory::collect!(MachineModel);

/// All registered models, sorted by name.
#[must_use]
pub fn models() -> Vec<&'static MachineModel> {
    Registry::registered().models
}

/// The registered model of this name.
///
/// # Errors
/// [`MachineError::Unknown`] lists what is registered, [`MachineError::Twice`] when the name is
/// registered more than once.
///
/// # Examples
/// ```
/// let gantry = toolglide_machines::find("gantry")?;
/// let machine = (gantry.build)(&(gantry.preset)())?;
/// assert_eq!(machine.axes().len(), 3);
/// # Ok::<(), toolglide_machines::MachineError>(())
/// ```
pub fn find(name: &str) -> Result<&'static MachineModel, MachineError> {
    Registry::registered().find(name)
}

/// A list of models: those registered by `inventory`, or those that a program names itself.
#[derive(Clone, Debug, Default)]
pub struct Registry {
    models: Vec<&'static MachineModel>,
}

impl Registry {
    /// The given models, without any help of the linker.
    #[must_use]
    pub fn of(models: impl IntoIterator<Item = &'static MachineModel>) -> Self {
        let mut models: Vec<_> = models.into_iter().collect();
        models.sort_by_key(|model| model.name);
        Self { models }
    }

    /// Every model that a linked crate has registered.
    #[must_use]
    pub fn registered() -> Self {
        Self::of(inventory::iter::<MachineModel>)
    }

    /// The models, sorted by name.
    #[must_use]
    pub fn models(&self) -> &[&'static MachineModel] {
        &self.models
    }

    /// The model of this name.
    ///
    /// # Errors
    /// As [`find`].
    pub fn find(&self, name: &str) -> Result<&'static MachineModel, MachineError> {
        let mut named = self.models.iter().filter(|model| model.name == name);
        let Some(&first) = named.next() else {
            return Err(MachineError::Unknown {
                name: name.to_owned(),
                registered: self.models.iter().map(|model| model.name).collect(),
            });
        };
        match named.count() {
            0 => Ok(first),
            more => Err(MachineError::Twice {
                name: first.name,
                times: 1 + more,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gantry::GANTRY;

    #[test]
    fn the_built_in_machines_are_registered() {
        let names: Vec<_> = models().iter().map(|model| model.name).collect();
        assert_eq!(
            names,
            [
                "arm-6r",
                "corexy",
                "delta",
                "gantry",
                "gantry-a",
                "gantry-abc",
                "gantry-b",
                "gantry-c",
                "gantry-uvw",
                "head-bc",
                "head-table-bc",
                "hot-wire",
                "scara",
                "table-ac",
                "table-bc"
            ],
            "linked and sorted"
        );
    }

    #[test]
    fn an_unknown_machine_is_answered_with_those_there_are() {
        let refused = find("lathe").unwrap_err();
        assert_eq!(
            refused.to_string(),
            "machine \"lathe\" is not registered; registered: arm-6r, corexy, delta, gantry, gantry-a, gantry-abc, gantry-b, gantry-c, gantry-uvw, head-bc, head-table-bc, hot-wire, scara, table-ac, table-bc"
        );
    }

    #[test]
    fn a_name_registered_twice_means_neither() {
        static AGAIN: MachineModel = GANTRY;
        static OTHER: MachineModel = MachineModel {
            name: "a-first",
            ..GANTRY
        };
        let registry = Registry::of([&AGAIN, &OTHER, &GANTRY]);
        assert!(
            matches!(
                registry.find("gantry"),
                Err(MachineError::Twice {
                    name: "gantry",
                    times: 2
                })
            ),
            "{registry:?}"
        );
        assert!(registry.find("a-first").is_ok(), "others are still found");
        assert_eq!(registry.models()[0].name, "a-first", "sorted");
    }
}
