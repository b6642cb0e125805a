//! Prints the comparison with the dissertation as rows.

use crate::commands::reproduce::crossover::crossover;
use crate::commands::reproduce::experiments::{Entry, Experiment};
use crate::commands::reproduce::quantity::Quantity;
use crate::commands::reproduce::run::Runs;
use crate::error::CliError;
use serde::Serialize;
use std::fmt::Write;
use toolglide_fir::largest_circle_feed;

/// One printed number and ours, as JSON names it.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Row {
    name: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    program: Option<&'static str>,
    quantity: String,
    unit: &'static str,
    /// As a number; nothing where nothing is printed.
    printed: Option<f64>,
    /// As it is printed.
    printed_as: &'static str,
    ours: f64,
    difference_percent: Option<f64>,
    note: &'static str,
    #[serde(skip)]
    decimals: usize,
}

/// Plans what an experiment needs and gives its rows.
pub(super) fn rows(experiment: &Experiment, runs: &mut Runs) -> Result<Vec<Row>, CliError> {
    let row = |entry: &Entry| {
        let ours = value(&entry.quantity, runs)?;
        let printed = entry.printed.trim_start_matches('<').parse::<f64>().ok();
        let exact = printed.filter(|_| !entry.printed.starts_with('<'));
        Ok(Row {
            name: experiment.name,
            program: entry.quantity.program(),
            quantity: entry.quantity.name(),
            unit: entry.quantity.unit(),
            printed,
            printed_as: entry.printed,
            ours,
            difference_percent: exact.map(|printed| 100.0 * (ours / printed - 1.0)),
            note: entry.note,
            decimals: entry.quantity.decimals(),
        })
    };
    experiment.entries.iter().map(row).collect()
}

fn value(quantity: &Quantity, runs: &mut Runs) -> Result<f64, CliError> {
    let mut time = |course, method| runs.of(course, method).map(|outcome| outcome.cycle_time);
    Ok(match *quantity {
        Quantity::CycleTime(planned) => time(planned.course, planned.method)?,
        Quantity::CornerSpeed(planned) => runs.of(planned.course, planned.method)?.corner_speed,
        Quantity::Ratio(planned, other) => {
            time(planned.course, planned.method)? / time(planned.course, other)?
        }
        Quantity::PerCorner(planned, other, corners) => {
            let more = time(planned.course, planned.method)? - time(planned.course, other)?;
            1e3 * more / f64::from(corners)
        }
        Quantity::ContourRms(planned) => 1e3 * runs.contour(planned)?.rms(),
        Quantity::ContourLargest(planned) => 1e3 * runs.contour(planned)?.largest,
        Quantity::PoseTime(path, method) => path.time(method)?,
        Quantity::PoseGain(path, method, other) => {
            100.0 * (1.0 - path.time(method)? / path.time(other)?)
        }
        Quantity::PoseAcceleration(path, method, other) => {
            path.acceleration(method)? / path.acceleration(other)?
        }
        Quantity::PoseServo(path, method) => 1e3 * path.simulated(method)?.tip.servo.rms(),
        Quantity::PosePart(path, method) => 1e3 * path.simulated(method)?.tip.part.rms(),
        Quantity::BeamLeft(planned, beam) => 1e3 * runs.beam(planned, beam)?.left,
        Quantity::BeamAcceleration(planned, beam) => runs.beam(planned, beam)?.largest_acceleration,
        Quantity::PoseOverlap(path, method) => 1e3 * path.overlap(method)?,
        Quantity::Crossover(tolerance) => crossover(tolerance, runs)?,
        Quantity::CircleFeed(course, radius, tolerance) => {
            let chain = course.chain()?.ok_or_else(|| none(course.name))?;
            largest_circle_feed(&chain, radius, tolerance)
                .map_err(CliError::filters(course.name))?
        }
        Quantity::Gain(course, frequency) => {
            let chain = course.chain()?.ok_or_else(|| none(course.name))?;
            chain.gain(std::f64::consts::TAU * frequency).abs()
        }
        Quantity::Deviation(planned) => 1e3 * runs.of(planned.course, planned.method)?.deviation,
    })
}

fn none(program: &str) -> CliError {
    CliError::Line {
        program: program.to_owned(),
        line: 0,
        reason: "there are no filters".to_owned(),
    }
}

/// Widths of the columns quantity, printed, ours and difference.
const WIDTHS: [usize; 4] = [48, 9, 13, 11];

/// All rows as a table, experiment by experiment.
pub(super) fn text(groups: &[(&Experiment, Vec<Row>)]) -> String {
    let mut text = String::new();
    for (experiment, rows) in groups {
        if !text.is_empty() {
            text.push('\n');
        }
        let _ = writeln!(text, "{}: {}", experiment.name, experiment.title);
        let heads = ["quantity", "printed", "ours", "difference"];
        line(&mut text, heads, "note");
        let mut program = None;
        for row in rows {
            if row.program != program {
                program = row.program;
                if let Some(program) = program {
                    let _ = writeln!(text, "  {program}");
                }
            }
            let decimals = row.decimals;
            let ours = format!("{:.decimals$} {:<4}", row.ours, row.unit);
            let difference = match (row.difference_percent, row.printed) {
                (Some(percent), _) => format!("{percent:+.2} %"),
                (None, Some(bound)) if row.ours < bound => "holds".to_owned(),
                (None, Some(_)) => "fails".to_owned(),
                (None, None) => "-".to_owned(),
            };
            let printed = if row.printed.is_some() {
                row.printed_as
            } else {
                "-"
            };
            line(
                &mut text,
                [&row.quantity, printed, &ours, &difference],
                row.note,
            );
        }
    }
    text
}

fn line(text: &mut String, cells: [&str; 4], note: &str) {
    let [quantity, printed, ours, difference] = WIDTHS;
    let row = format!(
        "  {:<quantity$} {:>printed$} {:>ours$} {:>difference$}  {note}",
        cells[0], cells[1], cells[2], cells[3]
    );
    text.push_str(row.trim_end());
    text.push('\n');
}
