//! Writes executed set-points as CSV, with the rate of planned time where that is asked for.

use crate::error::CliError;
use crate::output::csv_writer::{CHUNK, Destination, header, number};
use toolglide_kinematics::{Axis, SamplePeriod};
use toolglide_realtime::{Activity, Tick};

/// Writes the rows, or only counts them.
pub(crate) struct Rows<'a> {
    destination: Option<Destination<'a>>,
    with_rate: bool,
    period: f64,
    text: Vec<u8>,
    pub(crate) count: u64,
}

impl<'a> Rows<'a> {
    /// Begins with the header.
    pub(crate) fn new(
        period: SamplePeriod,
        axes: &[Axis],
        with_rate: bool,
        destination: Option<Destination<'a>>,
    ) -> Self {
        let mut text = Vec::new();
        if destination.is_some() {
            let head = header(axes);
            text.extend_from_slice(head.trim_end().as_bytes());
            text.extend_from_slice(if with_rate { b",rate,state\n" } else { b"\n" });
        }
        Self {
            destination,
            with_rate,
            period: period.seconds(),
            text,
            count: 0,
        }
    }

    /// Writes the row of a tick, counted from 0.
    #[allow(clippy::cast_precision_loss, reason = "ticks stay below 2^53")]
    pub(crate) fn observe<const N: usize>(
        &mut self,
        tick: u64,
        at: &Tick<N>,
    ) -> Result<(), CliError> {
        self.count += 1;
        if self.destination.is_none() {
            return Ok(());
        }
        // 9 ms is written as 0.009 although 9 times 0.001 is not quite that.
        let time = (tick as f64 * self.period * 1e12).round() / 1e12;
        number(&mut self.text, time);
        for &coordinate in &at.sample.position {
            self.text.push(b',');
            number(&mut self.text, coordinate);
        }
        if self.with_rate {
            self.text.push(b',');
            number(&mut self.text, at.rate);
            self.text.push(b',');
            self.text.extend_from_slice(name(at.activity).as_bytes());
        }
        self.text.push(b'\n');
        if self.text.len() >= CHUNK {
            self.hand_on()
        } else {
            Ok(())
        }
    }

    /// Writes what is left.
    pub(crate) fn finish(mut self) -> Result<u64, CliError> {
        self.hand_on()?;
        Ok(self.count)
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

/// The state as rows and summaries name it.
pub(crate) fn name(activity: Activity) -> &'static str {
    match activity {
        Activity::Idle => "idle",
        Activity::Running => "running",
        Activity::Holding => "holding",
        Activity::Held => "held",
        Activity::Starved => "starved",
        Activity::AtBlockEnd => "at-block-end",
        Activity::Aborted => "aborted",
    }
}
