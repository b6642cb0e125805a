//! Chooses the modes of vibration that a run leaves at rest.
//!
//! Source: ours. Those of the machine file, unless the command line says otherwise. Not here: how they come to rest.

use crate::error::CliError;
use crate::input::args::{Silent, TuningArgs};
use crate::input::setup::Setup;
use toolglide_kinematics::{AxisMode, AxisModes, Mode};

/// All modes of a machine.
pub(crate) fn all_modes(setup: &Setup) -> Result<AxisModes, CliError> {
    let asked = &setup.modes_asked;
    let modes: Vec<AxisMode> = setup
        .modes
        .iter()
        .filter_map(|mode| {
            let axis = setup.axes.iter().position(|axis| axis.name == mode.axis)?;
            let checked = Mode::new(mode.frequency_hz, mode.damping);
            let mode = checked.map_err(CliError::mode(asked));
            Some(mode.map(|mode| AxisMode { axis, mode }))
        })
        .collect::<Result<_, _>>()?;
    AxisModes::new(&modes).map_err(CliError::mode(asked))
}

/// The modes that must rest wherever the motion rests.
pub(crate) fn silent_modes(args: &TuningArgs, setup: &Setup) -> Result<AxisModes, CliError> {
    match args.silent {
        Some(Silent::Off) => return Ok(AxisModes::default()),
        Some(Silent::On) if setup.modes.is_empty() => {
            return Err(CliError::Option {
                option: "--silent",
                value: "on".to_owned(),
                bound: format!(
                    "{} has no modes of vibration: give it [[mode]]",
                    setup.asked
                ),
            });
        }
        Some(Silent::On) | None => {}
    }
    all_modes(setup)
}
