//! Chooses the filters of a run.
//!
//! Source: section 4.2.2. The command line goes before the machine file, time constants before modes;
//! where none of them says anything, the planner chooses. Not here: the filters.

use crate::error::CliError;
use crate::input::args::TuningArgs;
use crate::input::setup::Setup;
use toolglide_fir::FilterChain;
use toolglide_kinematics::Mode;

/// The chain of a run; `None` where the planner chooses.
pub(crate) fn chain(args: &TuningArgs, setup: &Setup) -> Result<Option<FilterChain>, CliError> {
    let asked = asked(args, setup);
    let refuse = CliError::filters(&asked);
    let time_constants = time_constants(args, setup);
    if !time_constants.is_empty() {
        return FilterChain::with_time_constants(time_constants)
            .and_then(|chain| chain.rounded_to(setup.period))
            .map(Some)
            .map_err(refuse);
    }
    if setup.modes.is_empty() {
        return Ok(None);
    }
    // Axes that vibrate alike need one filter.
    let mut modes = Vec::<Mode>::new();
    for mode in &setup.modes {
        let mode = Mode::new(mode.frequency_hz, mode.damping).map_err(CliError::mode(&asked))?;
        if !modes.contains(&mode) {
            modes.push(mode);
        }
    }
    let further = if modes.len() == 1 {
        further(setup)
    } else {
        None
    };
    FilterChain::silencing(&modes, further.as_slice(), setup.period)
        .map(Some)
        .map_err(refuse)
}

fn time_constants<'a>(args: &'a TuningArgs, setup: &'a Setup) -> &'a [f64] {
    match &args.fir {
        Some(given) => &given.0,
        None => &setup.time_constants,
    }
}

/// Who asks for filters, as messages about them say it: an option, or a field of the machine file.
pub(crate) fn asked(args: &TuningArgs, setup: &Setup) -> String {
    if args.fir.is_some() {
        "--fir".to_owned()
    } else if time_constants(args, setup).is_empty() {
        setup.modes_asked.clone()
    } else {
        format!("{}: fir_s", setup.asked)
    }
}

/// Jerk is bounded by a second filter; twice the time that it takes to change the acceleration, because
/// ramps may coincide.
fn further(setup: &Setup) -> Option<f64> {
    setup
        .axes
        .iter()
        .map(|axis| 2.0 * axis.limits.acceleration() / axis.limits.jerk())
        .reduce(f64::max)
}
