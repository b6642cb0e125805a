//! Writes set-points of pose motion as CSV: time, axes, and the tool pose where asked for.
//!
//! As for straight axes, the end is one more row, exactly. Not here: sampling.

use crate::error::CliError;
use crate::output::csv_writer::{
    CHUNK, Destination, SAME_INSTANT, SAME_INSTANT_SHARE, WHOLE_RATE, header, number,
};
use toolglide_fiveaxis::PoseTick;
use toolglide_kinematics::{Axis, AxisKind, SamplePeriod};

/// Writes rows, or only counts them.
pub(crate) struct Rows<'a> {
    destination: Option<Destination<'a>>,
    kinds: Vec<AxisKind>,
    pose: bool,
    period: f64,
    rate: Option<f64>,
    held: Option<PoseTick>,
    rows: u64,
    text: Vec<u8>,
}

impl<'a> Rows<'a> {
    pub(crate) fn new(
        period: SamplePeriod,
        axes: &[Axis],
        pose: bool,
        destination: Option<Destination<'a>>,
    ) -> Self {
        let mut text = Vec::new();
        if destination.is_some() {
            text.reserve(2 * CHUNK);
            let mut header = header(axes);
            if pose {
                header.truncate(header.trim_end().len());
                header.push_str(",tip_x_mm,tip_y_mm,tip_z_mm,tool_i,tool_j,tool_k\n");
            }
            text.extend_from_slice(header.as_bytes());
        }
        let rate = (1.0 / period.seconds()).round();
        let whole = rate >= 1.0 && (rate * period.seconds() - 1.0).abs() < WHOLE_RATE;
        Self {
            destination,
            kinds: axes.iter().map(|axis| axis.kind).collect(),
            pose,
            period: period.seconds(),
            rate: whole.then_some(rate),
            held: None,
            rows: 0,
            text,
        }
    }

    /// Takes a tick.
    pub(crate) fn tick(&mut self, tick: &PoseTick) -> Result<(), CliError> {
        if let Some(before) = self.held.replace(*tick) {
            self.write(&before, true)?;
        }
        Ok(())
    }

    /// Ends the motion with its last instant, and says how many rows it has.
    pub(crate) fn finish(mut self, last: &PoseTick) -> Result<u64, CliError> {
        let instant = SAME_INSTANT.min(SAME_INSTANT_SHARE * self.period);
        match self.held.take() {
            Some(held) if last.time - held.time > instant => {
                self.write(&held, true)?;
                self.write(last, false)?;
            }
            Some(held) => {
                let end = PoseTick {
                    time: held.time,
                    ..*last
                };
                self.write(&end, true)?;
            }
            None => self.write(last, false)?,
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

    /// A row; 9 ms is written as 0.009 on a tick, although 9 times 0.001 is not quite that.
    fn write(&mut self, tick: &PoseTick, on_tick: bool) -> Result<(), CliError> {
        self.rows += 1;
        if self.destination.is_none() {
            return Ok(());
        }
        let time = match self.rate {
            Some(rate) if on_tick => (tick.time * rate).round() / rate,
            _ => tick.time,
        };
        number(&mut self.text, time);
        for (kind, &position) in self.kinds.iter().zip(tick.axes.iter()) {
            self.text.push(b',');
            number(
                &mut self.text,
                match kind {
                    AxisKind::Linear => position,
                    AxisKind::Rotary => position.to_degrees(),
                },
            );
        }
        if self.pose {
            let (tip, tool) = (tick.pose.tip(), tick.pose.orientation());
            for &coordinate in tip.iter().chain(tool.iter()) {
                self.text.push(b',');
                number(&mut self.text, coordinate);
            }
        }
        self.text.push(b'\n');
        if self.text.len() >= CHUNK {
            self.hand_on()?;
        }
        Ok(())
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
