//! Judges set-points of axes against a program of tool poses.
//!
//! Not here: reading the table, and judging.

use crate::commands::poses::inputs::Inputs;
use crate::commands::poses::summary::PoseSummary;
use crate::error::CliError;
use crate::input::args::VerifyArgs;
use crate::input::csv_reader::Table;
use crate::input::source::open_file;
use crate::output::files::same_file;
use crate::output::report::show;
use std::fs::File;
use std::io::{BufReader, Write};
use std::path::Path;
use toolglide_kinematics::{AxisKind, AxisVector};
use toolglide_verify::PoseSetPointJudge;

/// Runs the command.
pub(crate) fn verify(
    args: &VerifyArgs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let inputs = Inputs::new(
        &args.job,
        None,
        args.orientation_tolerance,
        args.turn_about.as_ref(),
        None,
    )?;
    match inputs.setup.axes.len() {
        2 => judge::<2>(args, &inputs, out, err),
        3 => judge::<3>(args, &inputs, out, err),
        4 => judge::<4>(args, &inputs, out, err),
        5 => judge::<5>(args, &inputs, out, err),
        6 => judge::<6>(args, &inputs, out, err),
        count => Err(CliError::Option {
            option: "--machine",
            value: format!("a machine of {count} axes"),
            bound: "set-points of 2 to 6 axes are judged".to_owned(),
        }),
    }
}

fn judge<const N: usize>(
    args: &VerifyArgs,
    inputs: &Inputs,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<u8, CliError> {
    let file = args.set_points.as_path();
    if same_file(file, &args.job.program) {
        return Err(CliError::Option {
            option: "SETPOINTS.csv",
            value: file.display().to_string(),
            bound: "this is the program".to_owned(),
        });
    }
    let mut legs = inputs.open(&args.job)?;
    let resolution = {
        let mut table = Table::<_, N>::open(file, open(file)?, &inputs.setup.axes)?;
        while table.row()?.is_some() {}
        0.5 * table.resolution()
    };
    let rounding: Vec<f64> = inputs
        .setup
        .axes
        .iter()
        .map(|axis| match axis.kind {
            AxisKind::Linear => resolution,
            AxisKind::Rotary => resolution.to_radians(),
        })
        .collect();
    let mut judge = PoseSetPointJudge::new(
        inputs.machine.as_ref(),
        inputs.setup.axes.clone(),
        &rounding,
    );
    while let Some(leg) = legs.next()? {
        judge.expect(&leg);
    }
    let mut table = Table::<_, N>::open(file, open(file)?, &inputs.setup.axes)?;
    let mut rows = 0;
    while let Some((time, row)) = table.row()? {
        let mut at = AxisVector::zeros(N);
        for ((to, from), axis) in at.iter_mut().zip(row.iter()).zip(&inputs.setup.axes) {
            *to = match axis.kind {
                AxisKind::Linear => *from,
                AxisKind::Rotary => from.to_radians(),
            };
        }
        judge
            .observe(time, &at)
            .map_err(|reason| table.refuse(reason.to_string()))?;
        rows += 1;
    }
    let verdict = judge.finish();
    legs.warn(err);
    let blocks = legs.program.blocks();
    let mut summary = PoseSummary::of(&legs.name, &inputs.setup, &verdict, blocks, rows);
    summary.set_points = Some(file.display().to_string());
    show(&summary, args.job.json, out, err)
}

fn open(file: &Path) -> Result<BufReader<File>, CliError> {
    let (opened, length) = open_file(file)?;
    if length.is_none() {
        return Err(CliError::Read {
            file: file.to_owned(),
            reason: std::io::Error::other("it is read twice, so it must be a regular file"),
        });
    }
    Ok(BufReader::with_capacity(1 << 16, opened))
}
