//! Prints what came out of a run: the plan, the peaks of the executed motion, and what became of each command.

use super::responses::Response;
use crate::output::report::Shown;
use crate::output::summary::Summary;
use serde::Serialize;
use std::fmt::Write as _;

/// What came out, as JSON names it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct RunReport {
    pub(crate) plan: Summary,
    pub(crate) executed: Executed,
    pub(crate) commands: Vec<Response>,
}

/// The executed motion.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Executed {
    pub(crate) reserve: f64,
    pub(crate) max_override: f64,
    pub(crate) duration_s: f64,
    pub(crate) rows: u64,
    /// From the first line read to motion: planned time in hand when it began, and moves read until then.
    pub(crate) first_piece_after_moves: u64,
    pub(crate) motion_after_moves: u64,
    pub(crate) needs_in_hand_s: f64,
    pub(crate) stops_within_s: Option<f64>,
    /// Largest velocity, acceleration and jerk of any axis, as shares of the limits of the machine.
    pub(crate) velocity_share: f64,
    pub(crate) acceleration_share: f64,
    pub(crate) jerk_share: f64,
    /// Largest distance of a set-point from the planned path at its planned time, mm.
    pub(crate) off_path_mm: f64,
    pub(crate) steps_without_a_rate: u64,
    /// Where the motion came to rest, in axis order, and the line that it was on.
    pub(crate) end: Vec<f64>,
    pub(crate) end_line: u32,
    pub(crate) state: &'static str,
    /// What is broken.
    pub(crate) faults: Vec<String>,
}

impl Shown for RunReport {
    fn text(&self) -> String {
        let mut text = self.plan.text();
        let run = &self.executed;
        let _ = write!(
            text,
            "\nexecuted     {:.3} s, {} set-points; {} at {} in line {}\n\
             peaks        velocity {:.2} %, acceleration {:.2} %, jerk {:.2} % of the limits, between set-points too\n\
             geometry     {:.1e} mm from the plan\n\
             start        first piece after {} moves, motion after {}; {:.3} s of plan in hand for full rate\n",
            run.duration_s,
            run.rows,
            run.state,
            place(&self.plan.axes, &run.end),
            run.end_line,
            100.0 * run.velocity_share,
            100.0 * run.acceleration_share,
            100.0 * run.jerk_share,
            run.off_path_mm,
            run.first_piece_after_moves,
            run.motion_after_moves,
            run.needs_in_hand_s,
        );
        let _ = match run.stops_within_s {
            Some(within) => writeln!(text, "holds        over within {within:.3} s, promised"),
            None => writeln!(text, "holds        not promised without a reserve"),
        };
        if !self.commands.is_empty() {
            text.push('\n');
        }
        for response in &self.commands {
            text.push_str(&response.text());
        }
        text
    }

    fn complaint(&self) -> String {
        let mut text = self.plan.complaint();
        for fault in &self.executed.faults {
            let _ = writeln!(text, "{}: {fault}", self.plan.program);
        }
        text
    }

    fn passes(&self) -> bool {
        self.plan.passes() && self.executed.faults.is_empty()
    }
}

fn place(axes: &[char], end: &[f64]) -> String {
    let named: Vec<String> = axes
        .iter()
        .zip(end)
        .map(|(axis, value)| format!("{axis}{value:.3}"))
        .collect();
    named.join(" ")
}
