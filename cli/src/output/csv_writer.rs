//! Writes set-points as CSV while the motion is planned.
//!
//! One row at every multiple of the period and one at the end, which is the programmed point
//! exactly. Numbers are the shortest text that reads back to the same `f64`. One row is held back,
//! so that an end which falls on a tick is one row and not two.

use crate::error::CliError;
use std::io::Write;
use std::path::PathBuf;
use toolglide_kinematics::{Axis, AxisKind, Piece, SamplePeriod, Sampler, Vector};

/// Rows nearer than this are one instant, s: the motion comes to rest there and covers less than
/// any rounding.
pub(crate) const SAME_INSTANT: f64 = 1e-9;

/// The same as a share of the period, for periods that are themselves very short.
pub(crate) const SAME_INSTANT_SHARE: f64 = 1e-3;

/// A period whose inverse is this near to a whole number gives times as multiples of a decimal.
pub(crate) const WHOLE_RATE: f64 = 1e-12;

/// Rows are handed on when this many bytes have gathered.
pub(crate) const CHUNK: usize = 1 << 16;

/// Where the rows go.
pub(crate) struct Destination<'a> {
    /// What takes the bytes.
    pub(crate) sink: &'a mut dyn Write,
    /// Its name in messages.
    pub(crate) name: PathBuf,
}

/// Samples a motion and writes the rows, or only counts them.
pub(crate) struct SetPoints<'a, const N: usize> {
    destination: Option<Destination<'a>>,
    sampler: Sampler<N>,
    period: f64,
    rate: Option<f64>,
    held: Option<(f64, Vector<N>)>,
    end: Vector<N>,
    rows: u64,
    text: Vec<u8>,
}

impl<'a, const N: usize> SetPoints<'a, N> {
    /// Begins at rest at `start`.
    pub(crate) fn new(
        period: SamplePeriod,
        axes: &[Axis],
        start: Vector<N>,
        destination: Option<Destination<'a>>,
    ) -> Self {
        let mut text = Vec::new();
        if destination.is_some() {
            text.reserve(2 * CHUNK);
            text.extend_from_slice(header(axes).as_bytes());
        }
        let rate = (1.0 / period.seconds()).round();
        let whole = rate >= 1.0 && (rate * period.seconds() - 1.0).abs() < WHOLE_RATE;
        Self {
            destination,
            sampler: Sampler::new(period),
            period: period.seconds(),
            rate: whole.then_some(rate),
            held: None,
            end: start,
            rows: 0,
            text,
        }
    }

    /// Takes the piece that follows.
    pub(crate) fn observe(&mut self, piece: &Piece<N>) -> Result<(), CliError> {
        self.sampler.feed(piece);
        self.end = piece.end();
        if self.destination.is_none() {
            return Ok(());
        }
        while let Some(row) = self.sampler.next_tick() {
            if let Some((time, position)) = self.held.replace(row) {
                self.write_row(time, &position);
                if self.text.len() >= CHUNK {
                    self.hand_on()?;
                }
            }
        }
        Ok(())
    }

    /// Ends the motion where it has come to, and says how many rows it has.
    pub(crate) fn finish(mut self) -> Result<u64, CliError> {
        let end_time = self.sampler.end_time();
        let instant = SAME_INSTANT.min(SAME_INSTANT_SHARE * self.period);
        if self.destination.is_none() {
            return Ok(rows(end_time, self.period, instant));
        }
        let end = self.end;
        match self.held.take() {
            Some((time, position)) if end_time - time > instant => {
                self.write_row(time, &position);
                self.row(end_time, &end);
            }
            Some((time, _)) => self.write_row(time, &end),
            None => self.row(0.0, &end),
        }
        self.hand_on()?;
        if let Some(destination) = &mut self.destination {
            destination
                .sink
                .flush()
                .map_err(|reason| CliError::write(&destination.name, reason))?;
        }
        Ok(self.rows)
    }

    /// A row on a tick: 9 ms is written as 0.009 although 9 times 0.001 is not quite that.
    fn write_row(&mut self, tick: f64, position: &Vector<N>) {
        let time = match self.rate {
            Some(rate) => (tick * rate).round() / rate,
            None => tick,
        };
        self.row(time, position);
    }

    fn row(&mut self, time: f64, position: &Vector<N>) {
        number(&mut self.text, time);
        for &coordinate in position {
            self.text.push(b',');
            number(&mut self.text, coordinate);
        }
        self.text.push(b'\n');
        self.rows += 1;
    }

    fn hand_on(&mut self) -> Result<(), CliError> {
        if let Some(destination) = &mut self.destination {
            destination
                .sink
                .write_all(&self.text)
                .map_err(|reason| CliError::write(&destination.name, reason))?;
        }
        self.text.clear();
        Ok(())
    }
}

/// Header of the columns: time, then the axes in machine order.
pub(crate) fn header(axes: &[Axis]) -> String {
    let mut header = "t_s".to_owned();
    for axis in axes {
        header.push(',');
        header.push_str(&column(axis));
    }
    header.push('\n');
    header
}

/// Name of the column of an axis.
pub(crate) fn column(axis: &Axis) -> String {
    let unit = match axis.kind {
        AxisKind::Linear => "mm",
        AxisKind::Rotary => "deg",
    };
    format!("{}_{unit}", axis.name.to_ascii_lowercase())
}

/// How many rows a motion of this length has: every tick before the end, and the end.
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "ticks stay below 2^53 for a hundred thousand years"
)]
fn rows(end_time: f64, period: f64, instant: f64) -> u64 {
    let mut last = (end_time / period).floor() as u64;
    while last > 0 && last as f64 * period >= end_time {
        last -= 1;
    }
    let rest = end_time - last as f64 * period;
    1 + last + u64::from(rest > instant)
}

/// Appends a number, as short as it reads back the same.
#[inline]
pub(crate) fn number(text: &mut Vec<u8>, value: f64) {
    if value == 0.0 {
        text.push(b'0');
        return;
    }
    let mut buffer = zmij::Buffer::new();
    let digits = buffer.format(value);
    let digits = digits.strip_suffix(".0").unwrap_or(digits);
    text.extend_from_slice(digits.as_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;
    use toolglide_kinematics::{AxisLimits, MoveRange, Sample};

    fn axes() -> Vec<Axis> {
        ['X', 'Y']
            .map(|name| Axis {
                name,
                kind: AxisKind::Linear,
                limits: AxisLimits::new(1.0, 1.0, 1.0).unwrap(),
                travel: None,
            })
            .to_vec()
    }

    fn written(period: f64, durations: &[f64]) -> String {
        let period = SamplePeriod::new(period).unwrap();
        let start = Vector::<2>::new(1.0, -0.0);
        let mut sink = Vec::new();
        let destination = Destination {
            sink: &mut sink,
            name: "test".into(),
        };
        let mut counted = SetPoints::new(period, &axes(), start, None);
        let mut rows = SetPoints::new(period, &axes(), start, Some(destination));
        let mut state = Sample::at_rest(start);
        for &duration in durations {
            state.velocity = Vector::<2>::new(10.0, 0.0);
            let end = state.position + state.velocity * duration;
            let piece = Piece::new(&state, duration, end, MoveRange { first: 0, last: 0 });
            rows.observe(&piece).unwrap();
            counted.observe(&piece).unwrap();
            state.position = end;
        }
        let count = rows.finish().unwrap();
        assert_eq!(count, counted.finish().unwrap(), "counted without writing");
        let text = String::from_utf8(sink).unwrap();
        assert_eq!(text.lines().count() as u64, count + 1, "{text}");
        text
    }

    #[test]
    fn the_end_between_two_ticks_is_one_more_row() {
        assert_eq!(
            written(0.1, &[0.15, 0.1]),
            "t_s,x_mm,y_mm\n0,1,0\n0.1,2,0\n0.2,3,0\n0.25,3.5,0\n"
        );
    }

    #[test]
    fn the_end_on_a_tick_is_one_row() {
        assert_eq!(
            written(0.1, &[0.1, 0.1]),
            "t_s,x_mm,y_mm\n0,1,0\n0.1,2,0\n0.2,3,0\n"
        );
        let rounded = written(0.1, &[0.1, 0.1 + 1e-15]);
        assert_eq!(rounded.lines().count(), 4, "{rounded}");
    }

    #[test]
    fn no_motion_is_one_row() {
        assert_eq!(written(0.1, &[]), "t_s,x_mm,y_mm\n0,1,0\n");
        assert_eq!(written(0.1, &[0.0]), "t_s,x_mm,y_mm\n0,1,0\n");
        assert_eq!(written(100.0, &[0.5]), "t_s,x_mm,y_mm\n0,1,0\n0.5,6,0\n");
    }

    #[test]
    fn ticks_are_written_as_people_write_them() {
        let text = written(0.001, &[0.1]);
        assert!(text.contains("\n0.009,"), "{text}");
        let odd = written(0.003, &[0.1]);
        assert!(
            odd.lines()
                .all(|row| row.split(',').all(|cell| !cell.is_empty())),
            "{odd}"
        );
    }

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        for value in [0.1, 1.0 / 3.0, -1e-17, 123_456.789, 5e-324, f64::MAX, 1e21] {
            let mut text = Vec::new();
            number(&mut text, value);
            let text = String::from_utf8(text).unwrap();
            assert_eq!(
                text.parse::<f64>().unwrap().to_bits(),
                value.to_bits(),
                "{text}"
            );
        }
    }
}
