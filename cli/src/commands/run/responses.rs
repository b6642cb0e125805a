//! Follows what becomes of each command: from which speed, and when the motion has done what was asked.

use super::events::{Command, Event};
use serde::Serialize;
use toolglide_kinematics::TimeLaw;
use toolglide_realtime::{Activity, Tick};

/// What became of a command, as JSON names it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Response {
    pub(crate) time_s: f64,
    pub(crate) command: String,
    pub(crate) from_mm_s: f64,
    /// "at rest", "constant rate" or "at speed"; `None` where the next command came first.
    pub(crate) outcome: Option<&'static str>,
    pub(crate) to_mm_s: f64,
    pub(crate) after_s: f64,
    pub(crate) after_mm: f64,
    /// Longest time to rest as told at the command, s; only for what stops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) promised_s: Option<f64>,
    pub(crate) line: u32,
    /// Whether a promise was broken.
    pub(crate) late: bool,
    #[serde(skip)]
    stops: bool,
    #[serde(skip)]
    seen: bool,
}

impl Response {
    /// The row of the report.
    pub(crate) fn text(&self) -> String {
        let mut text = format!(
            "{:.3} s  {:<18} from {:.1} mm/s  ",
            self.time_s, self.command, self.from_mm_s
        );
        match self.outcome {
            Some("at rest") => text.push_str("at rest"),
            Some(_) => text.push_str(&format!("at {:.1} mm/s", self.to_mm_s)),
            None => text.push_str("overtaken by the next command"),
        }
        text.push_str(&format!(
            " after {:.3} s, {:.2} mm",
            self.after_s, self.after_mm
        ));
        if let Some(promised) = self.promised_s {
            text.push_str(&format!("; promised {promised:.3} s"));
        }
        text.push_str(&format!("; line {}\n", self.line));
        text
    }
}

/// The responses so far, the last of which may be open.
#[derive(Debug, Default)]
pub(crate) struct Responses {
    pub(crate) done: Vec<Response>,
    open: Option<Response>,
}

impl Responses {
    /// Begins to follow a command that is given now.
    pub(crate) fn begin(&mut self, event: &Event, speed: f64, stops_within: f64, line: u32) {
        self.done.extend(self.open.take());
        let stops = match event.command {
            Command::Hold | Command::Abort => true,
            Command::Feed(value) => value <= 0.0,
            _ => false,
        };
        self.open = Some(Response {
            time_s: event.time,
            command: event.command.text(),
            from_mm_s: speed,
            outcome: None,
            to_mm_s: speed,
            after_s: 0.0,
            after_mm: 0.0,
            promised_s: (stops && stops_within.is_finite()).then_some(stops_within),
            line,
            late: false,
            stops,
            seen: false,
        });
    }

    /// Takes one tick of motion, a period after the one before, in which the tool went `way`.
    pub(crate) fn observe<const N: usize>(
        &mut self,
        tick: &Tick<N>,
        laws: impl Iterator<Item = TimeLaw>,
        period: f64,
        way: f64,
    ) {
        let Some(open) = &mut self.open else {
            return;
        };
        // The tick of the command still shows the motion before it.
        if !open.seen {
            open.seen = true;
            if open.stops && tick.rate.abs() <= 0.0 {
                open.outcome = Some("at rest");
                self.done.extend(self.open.take());
            }
            return;
        }
        open.after_s += period;
        open.after_mm += way;
        open.to_mm_s = tick.sample.velocity.norm();
        let standing = tick.rate.abs() <= 0.0;
        let resting = standing
            && match tick.activity {
                Activity::Holding | Activity::Running => false,
                Activity::Held | Activity::Aborted => open.stops,
                _ => true,
            };
        let constant = !standing
            && laws
                .into_iter()
                .all(|law| law.change.abs() <= 0.0 && law.bend.abs() <= 0.0);
        let outcome = if resting {
            Some("at rest")
        } else if constant && !open.stops {
            Some("constant rate")
        } else {
            None
        };
        if outcome.is_some() {
            open.outcome = outcome;
            // Half a period is the rounding of a count of ticks.
            open.late = open
                .promised_s
                .is_some_and(|promised| open.after_s > promised + 0.5 * period);
            self.done.extend(self.open.take());
        }
    }

    /// All of them.
    pub(crate) fn finish(mut self) -> Vec<Response> {
        self.done.extend(self.open.take());
        self.done
    }
}
