//! Reads set-points from CSV, whoever wrote them, with the line in every refusal.
//!
//! Columns are found by their names, so that other columns and another order do no harm. Not here:
//! judging.

use crate::error::CliError;
use crate::output::csv_writer::column;
use crate::output::decimals::Decimals;
use std::io::BufRead;
use std::path::{Path, PathBuf};
use toolglide_kinematics::{Axis, Vector};

/// Longest line that is read, bytes: some hundred columns.
const LONGEST_LINE: usize = 1 << 14;

/// Name of the column of time.
const TIME: &str = "t_s";

/// Rows of time and position, in order.
pub(crate) struct Table<R, const N: usize> {
    file: PathBuf,
    reader: R,
    line: u64,
    text: Vec<u8>,
    columns: usize,
    /// Which quantity stands in a column: 0 for time, then the axes.
    quantities: Vec<Option<usize>>,
    last: Option<f64>,
    decimals: Decimals,
}

impl<R: BufRead, const N: usize> Table<R, N> {
    /// Reads the header.
    pub(crate) fn open(file: &Path, reader: R, axes: &[Axis]) -> Result<Self, CliError> {
        let mut table = Self {
            file: file.to_owned(),
            reader,
            line: 0,
            text: Vec::new(),
            columns: 0,
            quantities: Vec::new(),
            last: None,
            decimals: Decimals::default(),
        };
        if !table.next_line()? {
            return Err(table.refuse("there is no header and no row"));
        }
        let header = table.line_text()?.to_owned();
        let names: Vec<String> = header
            .trim_start_matches('\u{feff}')
            .split(',')
            .map(|name| name.trim().trim_matches('"').to_ascii_lowercase())
            .collect();
        let mut wanted = vec![TIME.to_owned()];
        wanted.extend(axes.iter().map(column));
        for (quantity, name) in wanted.iter().enumerate() {
            let found = names.iter().filter(|other| *other == name).count();
            if found != 1 {
                let shown: String = header.chars().take(80).collect();
                return Err(table.refuse(format!(
                    "the header must name the column {name} once, but names it {found} times: {}",
                    shown.escape_debug()
                )));
            }
            table.quantities.resize(names.len(), None);
            if let Some(place) = names.iter().position(|other| other == name) {
                table.quantities[place] = Some(quantity);
            }
        }
        table.columns = names.len();
        Ok(table)
    }

    /// The next row; `None` at the end of the file.
    pub(crate) fn row(&mut self) -> Result<Option<(f64, Vector<N>)>, CliError> {
        if !self.next_line()? {
            if self.last.is_none() {
                return Err(self.refuse("there is no row"));
            }
            return Ok(None);
        }
        let text = std::str::from_utf8(&self.text).map_err(|_| self.refuse("this is not text"))?;
        let mut time = 0.0;
        let mut position = Vector::zeros();
        let mut decimals = self.decimals;
        let mut cells = 0;
        for (place, cell) in text.split(',').enumerate() {
            cells += 1;
            let Some(Some(quantity)) = self.quantities.get(place) else {
                continue;
            };
            let cell = cell.trim();
            let value: f64 = cell
                .parse()
                .ok()
                .filter(|value: &f64| value.is_finite())
                .ok_or_else(|| {
                    let shown: String = cell.chars().take(40).collect();
                    self.refuse(format!(
                        "column {} is \"{}\", but must be a finite number",
                        place + 1,
                        shown.escape_debug()
                    ))
                })?;
            if *quantity == 0 {
                time = value;
            } else {
                position[*quantity - 1] = value;
                decimals.take(cell);
            }
        }
        if cells != self.columns {
            return Err(self.refuse(format!(
                "the row has {cells} columns, but the header has {}",
                self.columns
            )));
        }
        if let Some(last) = self.last
            && time <= last
        {
            return Err(self.refuse(format!(
                "time is {time} s, but must be later than the {last} s of the row before"
            )));
        }
        self.decimals = decimals;
        self.last = Some(time);
        Ok(Some((time, position)))
    }

    /// The step in which the positions read so far are written, mm; 0 when they are written as
    /// exactly as an `f64` can be.
    pub(crate) fn resolution(&self) -> f64 {
        self.decimals.resolution()
    }

    /// Reads the next line that is not empty; `false` at the end of the file.
    fn next_line(&mut self) -> Result<bool, CliError> {
        loop {
            self.text.clear();
            let mut limited = std::io::Read::take(&mut self.reader, LONGEST_LINE as u64);
            let count = limited
                .read_until(b'\n', &mut self.text)
                .map_err(|reason| CliError::Read {
                    file: self.file.clone(),
                    reason,
                })?;
            if count == 0 {
                return Ok(false);
            }
            self.line += 1;
            if count == LONGEST_LINE {
                return Err(self.refuse(format!("the line is longer than {LONGEST_LINE} bytes")));
            }
            while matches!(self.text.last(), Some(b'\n' | b'\r')) {
                self.text.pop();
            }
            if !self.text.is_empty() {
                return Ok(true);
            }
        }
    }

    fn line_text(&self) -> Result<&str, CliError> {
        std::str::from_utf8(&self.text).map_err(|_| self.refuse("this is not text"))
    }

    /// The motion is outside what is allowed from its first row on.
    pub(crate) fn outside(&self, reason: String) -> CliError {
        CliError::Outside {
            file: self.file.clone(),
            line: self.line,
            reason,
        }
    }

    /// The row read last is refused.
    pub(crate) fn refuse(&self, reason: impl Into<String>) -> CliError {
        CliError::Row {
            file: self.file.clone(),
            line: self.line,
            reason: reason.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::{AxisKind, AxisLimits};

    fn read(text: &[u8]) -> Result<(Vec<(f64, Vector<2>)>, f64), CliError> {
        let axes = ['X', 'Y'].map(|name| Axis {
            name,
            kind: AxisKind::Linear,
            limits: AxisLimits::new(1.0, 1.0, 1.0).unwrap(),
            travel: None,
        });
        let mut table = Table::open(Path::new("motion.csv"), text, &axes)?;
        let mut rows = Vec::new();
        while let Some(row) = table.row()? {
            rows.push(row);
        }
        Ok((rows, table.resolution()))
    }

    #[test]
    fn columns_are_found_by_name() {
        let text = b"\xef\xbb\xbf\"Y_mm\", note ,T_S,x_mm\r\n2,a,0,1\r\n\r\n4,b,0.5,3\r\n";
        let (rows, _) = read(text).unwrap();
        assert_eq!(rows[1], (0.5, Vector::<2>::new(3.0, 4.0)));
        assert_eq!(rows.len(), 2);
    }

    #[test]
    fn resolution_is_that_of_the_finest_number() {
        for (cells, resolution) in [
            ("0.125,3", 1e-3),
            ("0.12,3.00000", 1e-5),
            ("0.123456789012345,3", 0.0),
            ("12.345678901234567,3", 0.0),
            ("1.5e-6,3", 1e-7),
            ("15e1,3", 1.0),
            ("0.000000000000125,3", 1e-15),
        ] {
            let text = format!("t_s,x_mm,y_mm\n0,0,0\n1,{cells}\n");
            let (_, found) = read(text.as_bytes()).unwrap();
            assert!(
                (found - resolution).abs() <= 1e-9 * resolution,
                "{cells}: {found}"
            );
        }
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, line, part) in [
            (&b""[..], 0, "no header"),
            (b"t_s,x_mm,y_mm\n", 1, "no row"),
            (b"t_s,x_mm\n0,0\n", 1, "y_mm once, but names it 0 times"),
            (
                b"t_s,x_mm,y_mm,x_mm\n",
                1,
                "x_mm once, but names it 2 times",
            ),
            (b"0,1,2\n", 1, "t_s once"),
            (
                b"t_s,x_mm,y_mm\n0,0,0\n0.1,nan,0\n",
                3,
                "column 2 is \"nan\"",
            ),
            (b"t_s,x_mm,y_mm\n0,0,inf\n", 2, "column 3"),
            (b"t_s,x_mm,y_mm\n0,,0\n", 2, "column 2 is \"\""),
            (b"t_s,x_mm,y_mm\n0,0,0\n0,0,0\n", 3, "must be later"),
            (
                b"t_s,x_mm,y_mm\n0,0,0\n1,0\n",
                3,
                "2 columns, but the header has 3",
            ),
            (b"t_s,x_mm,y_mm\n0,0,0,0\n", 2, "4 columns"),
            (b"\xff\xfe\x00\x01\n", 1, "not text"),
            (b"t_s,x_mm,y_mm\n0,0,\xff\n", 2, "not text"),
        ] {
            match read(text) {
                Err(CliError::Row {
                    line: found,
                    reason,
                    ..
                }) => {
                    assert_eq!(found, line, "{reason}");
                    assert!(reason.contains(part), "{reason}");
                }
                other => panic!("{text:?}: {other:?}"),
            }
        }
        let long = [b'x'; 2 * LONGEST_LINE];
        assert!(
            matches!(read(&long), Err(CliError::Row { line: 1, .. })),
            "a line without end"
        );
    }
}
