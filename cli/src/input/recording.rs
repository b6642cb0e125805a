//! Reads recorded runs of drives from CSV, whoever wrote them, with the line in every refusal.
//!
//! Not here: set-points alone, see `csv_reader`.

use crate::error::CliError;
use crate::input::source::open_file;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use toolglide_kinematics::Axis;

/// Bytes of a recording that are read at most: some minutes at ten kilohertz.
const LARGEST_FILE: u64 = 1 << 30;

/// Rows whose distance differs from that of the first by this share are no recording of one period.
const UNEVEN: f64 = 0.01;

/// A recorded run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns {
    /// Time between two rows, s.
    pub(crate) period: f64,
    /// The columns of each axis, in machine order; none for an axis that was not recorded.
    pub(crate) axes: Vec<Option<AxisColumns>>,
}

/// The columns of one axis.
#[derive(Clone, Debug, Default)]
pub(crate) struct AxisColumns {
    /// Set-points.
    pub(crate) set_points: Vec<f64>,
    /// Positions.
    pub(crate) positions: Vec<f64>,
    /// Specific forces.
    pub(crate) forces: Option<Vec<f64>>,
    /// Accelerations of what swings.
    pub(crate) accelerations: Option<Vec<f64>>,
}

/// Reads a recording.
pub(crate) fn read(file: &Path, axes: &[Axis]) -> Result<Columns, CliError> {
    let refuse = |line: u64, reason: String| CliError::Row {
        file: file.to_owned(),
        line,
        reason,
    };
    let (opened, _) = open_file(file)?;
    let mut reader = BufReader::new(opened.take(LARGEST_FILE));
    let mut line = String::new();
    let mut next = |line: &mut String, number: u64| {
        line.clear();
        reader
            .read_line(line)
            .map_err(|reason| refuse(number, reason.to_string()))
    };
    if next(&mut line, 1)? == 0 {
        return Err(refuse(0, "there is no header and no row".to_owned()));
    }
    let names: Vec<String> = line
        .trim_start_matches('\u{feff}')
        .split(',')
        .map(|name| name.trim().trim_matches('"').to_ascii_lowercase())
        .collect();
    let place = |name: &str| names.iter().position(|other| other == name);
    let time =
        place("t_s").ok_or_else(|| refuse(1, "the header must name the column t_s".to_owned()))?;
    let places: Vec<[Option<usize>; 4]> = axes
        .iter()
        .map(|axis| {
            let letter = axis.name.to_ascii_lowercase();
            ["planned", "actual", "force", "accel"].map(|kind| place(&format!("{kind}_{letter}")))
        })
        .collect();
    let mut columns = Columns {
        period: 0.0,
        axes: places
            .iter()
            .map(|[planned, actual, force, accel]| {
                (planned.is_some() && actual.is_some()).then(|| AxisColumns {
                    forces: force.map(|_| Vec::new()),
                    accelerations: accel.map(|_| Vec::new()),
                    ..AxisColumns::default()
                })
            })
            .collect(),
    };
    let mut before: Option<f64> = None;
    let mut number = 1;
    loop {
        number += 1;
        if next(&mut line, number)? == 0 {
            break;
        }
        if line.trim().is_empty() {
            continue;
        }
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let cell = |place: usize| -> Result<f64, CliError> {
            let text = cells.get(place).copied().unwrap_or("");
            text.parse()
                .ok()
                .filter(|value: &f64| value.is_finite())
                .ok_or_else(|| {
                    let shown: String = text.chars().take(40).collect();
                    refuse(
                        number,
                        format!(
                            "column {} is \"{shown}\", but must be a finite number",
                            place + 1
                        ),
                    )
                })
        };
        let now = cell(time)?;
        if let Some(before) = before {
            let step = now - before;
            if columns.period <= 0.0 {
                columns.period = (step * 1e9).round() / 1e9;
            }
            if !(step > 0.0 && (step / columns.period - 1.0).abs() < UNEVEN) {
                return Err(refuse(
                    number,
                    format!(
                        "the row is {step:.6} s after the one before, but rows must be {} s apart",
                        columns.period
                    ),
                ));
            }
        }
        before = Some(now);
        for (column, [planned, actual, force, accel]) in columns.axes.iter_mut().zip(&places) {
            let (Some(column), Some(planned), Some(actual)) = (column, planned, actual) else {
                continue;
            };
            column.set_points.push(cell(*planned)?);
            column.positions.push(cell(*actual)?);
            for (values, place) in [
                (&mut column.forces, force),
                (&mut column.accelerations, accel),
            ] {
                if let (Some(values), Some(place)) = (values, place) {
                    values.push(cell(*place)?);
                }
            }
        }
    }
    if columns.period <= 0.0 {
        return Err(refuse(number, "a recording needs two rows".to_owned()));
    }
    Ok(columns)
}
