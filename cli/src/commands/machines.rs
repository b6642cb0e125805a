//! Lists the machines and describes one.

use crate::error::CliError;
use crate::input::args::MachinesArgs;
use crate::input::setup::machine;
use std::fmt::Write as _;
use std::io::Write;
use toolglide_kinematics::AxisKind;
use toolglide_machines::{find, models, schema};

/// Decimals beyond which a degree that became rad and a degree again shows its rounding.
const DECIMALS: f64 = 1e9;

/// Runs the command.
pub(crate) fn machines(args: &MachinesArgs, out: &mut dyn Write) -> Result<(), CliError> {
    let text = if args.schema {
        let mut text = serde_json::to_string_pretty(&schema())?;
        text.push('\n');
        text
    } else if let Some(name) = &args.name {
        described(name)?
    } else {
        listed()
    };
    out.write_all(text.as_bytes())
        .map_err(|reason| CliError::write("standard output", reason))
}

fn listed() -> String {
    let mut text = String::new();
    let models = models();
    let width = models.iter().map(|model| model.name.len()).max();
    let width = width.unwrap_or_default();
    for model in models {
        let _ = writeln!(text, "{:<width$}  {}", model.name, model.summary);
    }
    text.push_str(
        "\nA machine file (TOML) describes any other; --schema prints its JSON Schema.\n",
    );
    text
}

fn described(name: &str) -> Result<String, CliError> {
    let (config, machine) = machine(name)?;
    let mut text = format!(
        "{} (model {})\n\naxis   velocity   acceleration   jerk         travel\n",
        config.name, config.model
    );
    for (axis, written) in machine.axes().iter().zip(&config.axis) {
        let (unit, factor) = match axis.kind {
            AxisKind::Linear => ("mm", 1.0),
            AxisKind::Rotary => ("deg", 1.0_f64.to_degrees()),
        };
        let shown = |value: f64| (value * factor * DECIMALS).round() / DECIMALS;
        let travel = axis.travel.map_or_else(
            || "no ends".to_owned(),
            |(low, high)| format!("{} to {} {unit}", shown(low), shown(high)),
        );
        let reversed = if written.reversed { ", reversed" } else { "" };
        let zero = if written.zero.abs() > 0.0 {
            format!(", zero at {} {unit}", written.zero)
        } else {
            String::new()
        };
        let _ = writeln!(
            text,
            "{:<6} {:<10} {:<14} {:<12} {travel}{reversed}{zero}",
            axis.name,
            shown(axis.limits.velocity()),
            shown(axis.limits.acceleration()),
            shown(axis.limits.jerk()),
        );
    }
    let _ = writeln!(
        text,
        "\nvelocity in mm/s (deg/s), acceleration per s, jerk per s twice\n\
         tolerance {} mm, set-points every {} s",
        machine.default_tolerance().length(),
        machine.set_point_period().seconds()
    );
    let geometry = find(&config.model)?.geometry;
    if !geometry.is_empty() {
        text.push_str("\ngeometry       mm\n");
    }
    for distance in geometry {
        let value = config.geometry.get(distance.name).copied();
        let _ = writeln!(
            text,
            "{:<14} {:<10} {}",
            distance.name,
            value.or(distance.usual).unwrap_or_default(),
            distance.meaning
        );
    }
    Ok(text)
}
