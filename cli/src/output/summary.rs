//! Prints the summary of a plan, as text or as JSON.
//!
//! Source: the judge's report. Not here: judging.

use crate::input::setup::Setup;
use crate::output::report::{Shown, is_zero, quoted, verdict};
use crate::output::smoothness::Measures;
use serde::Serialize;
use std::fmt::Write;
use toolglide_kinematics::{AxisKind, WindowTally};
use toolglide_verify::{Peak, Report, Violation};

/// What came out, as JSON names it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Summary {
    pub(crate) program: String,
    pub(crate) machine: String,
    #[serde(rename = "setpoints_file", skip_serializing_if = "Option::is_none")]
    pub(crate) set_points: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) method: Option<String>,
    pub(crate) axes: Vec<char>,
    /// Unit of each axis.
    #[serde(skip)]
    pub(crate) units: Vec<&'static str>,
    #[serde(skip)]
    pub(crate) path_unit: &'static str,
    pub(crate) cycle_time_s: f64,
    pub(crate) setpoints: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) period_s: Option<f64>,
    pub(crate) blocks: u64,
    pub(crate) moves: u32,
    pub(crate) path_length_mm: f64,
    pub(crate) peak_speed_mm_s: f64,
    pub(crate) peak_velocity: Vec<f64>,
    pub(crate) peak_acceleration: Vec<f64>,
    pub(crate) peak_jerk: Vec<f64>,
    pub(crate) velocity_limit: Vec<f64>,
    pub(crate) acceleration_limit: Vec<f64>,
    pub(crate) jerk_limit: Vec<f64>,
    pub(crate) max_deviation_mm: f64,
    pub(crate) max_deviation_share: f64,
    pub(crate) max_corner_error_mm: f64,
    pub(crate) max_corner_error_share: f64,
    pub(crate) feedrate_overshoot_mm_s: f64,
    #[serde(flatten)]
    pub(crate) smoothness: Measures,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) planning_time_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) windows: Option<Windows>,
    pub(crate) violations: u64,
    pub(crate) worst: Vec<String>,
    /// How many times rows are too far apart to be judged, and the first of them.
    #[serde(skip_serializing_if = "is_zero")]
    pub(crate) too_coarse: u64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) coarsest: Vec<String>,
}

/// How the windows of a planner came out, as JSON names it.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Windows {
    pub(crate) planned: u64,
    pub(crate) retried: u64,
    pub(crate) kept_old_plan: u64,
    pub(crate) stretches: u64,
    pub(crate) stretches_by_kcs: u64,
}

impl From<WindowTally> for Windows {
    fn from(tally: WindowTally) -> Self {
        Self {
            planned: tally.windows,
            retried: tally.retried,
            kept_old_plan: tally.kept,
            stretches: tally.stretches,
            stretches_by_kcs: tally.yielded,
        }
    }
}

impl Windows {
    fn text(&self) -> String {
        let mut text = format!(
            "{}, of which {} kept the plan before",
            self.planned, self.kept_old_plan
        );
        if self.stretches_by_kcs > 0 {
            let _ = write!(
                text,
                "; {} of {} stretches are faster by kcs",
                self.stretches_by_kcs, self.stretches
            );
        }
        text
    }
}

/// The unit of positions.
pub(crate) fn unit(kind: AxisKind) -> &'static str {
    match kind {
        AxisKind::Linear => "mm",
        AxisKind::Rotary => "deg",
    }
}

impl Summary {
    /// A summary of a report; what only a planner knows is added by whoever planned.
    pub(crate) fn of<const N: usize>(
        program: &str,
        setup: &Setup,
        report: &Report<N>,
        blocks: u64,
        set_points: u64,
    ) -> Self {
        let values = |peaks: &[Peak; N]| peaks.iter().map(|peak| peak.value).collect();
        let limits = setup.limits::<N>();
        Self {
            program: program.to_owned(),
            machine: setup.machine.clone(),
            set_points: None,
            method: None,
            axes: setup.letters(),
            units: setup.axes.iter().map(|axis| unit(axis.kind)).collect(),
            path_unit: setup.path_unit(),
            cycle_time_s: report.cycle_time,
            setpoints: set_points,
            period_s: None,
            blocks,
            moves: report.moves,
            path_length_mm: report.path_length,
            peak_speed_mm_s: report.peak_speed.value,
            peak_velocity: values(&report.peak_velocity),
            peak_acceleration: values(&report.peak_acceleration),
            peak_jerk: values(&report.peak_jerk),
            velocity_limit: limits.velocity().iter().copied().collect(),
            acceleration_limit: limits.acceleration().iter().copied().collect(),
            jerk_limit: limits.jerk().iter().copied().collect(),
            max_deviation_mm: report.deviation.value,
            max_deviation_share: report.deviation_ratio.value,
            max_corner_error_mm: report.corner_error.value,
            max_corner_error_share: report.corner_ratio.value,
            feedrate_overshoot_mm_s: report.feedrate_overshoot.value,
            smoothness: Measures::of(report.smoothness.as_ref(), setup),
            planning_time_s: None,
            windows: None,
            violations: report.violations,
            worst: worst_first(&report.examples),
            too_coarse: report.gaps.count,
            coarsest: report
                .gaps
                .examples
                .iter()
                .map(ToString::to_string)
                .collect(),
        }
    }

    fn axes_table(&self, text: &mut String) {
        let turns = self.units.contains(&unit(AxisKind::Rotary));
        text.push_str(if turns {
            "axis         velocity, /s        acceleration, /s²       jerk, /s³\n"
        } else {
            "axis         velocity, mm/s      acceleration, mm/s²     jerk, mm/s³\n"
        });
        for (axis, letter) in self.axes.iter().enumerate() {
            let cell = |peaks: &[f64], limits: &[f64]| {
                let peak = peaks.get(axis).copied().unwrap_or(0.0);
                let limit = limits.get(axis).copied().unwrap_or(f64::INFINITY);
                format!("{peak:.1}  {:.1} %", 100.0 * peak / limit)
            };
            let name = match self.units.get(axis) {
                Some(unit) if turns => format!("{letter}, {unit}"),
                _ => letter.to_string(),
            };
            let _ = writeln!(
                text,
                "{name:<12} {:<19} {:<23} {}",
                cell(&self.peak_velocity, &self.velocity_limit),
                cell(&self.peak_acceleration, &self.acceleration_limit),
                cell(&self.peak_jerk, &self.jerk_limit),
            );
        }
        text.push('\n');
    }
}

impl Shown for Summary {
    fn passes(&self) -> bool {
        self.violations == 0 && self.too_coarse == 0
    }

    fn text(&self) -> String {
        let mut text = String::new();
        let how = match &self.method {
            Some(method) => format!("planned by {method} for {}", self.machine),
            None => format!(
                "{} judged for {}",
                self.set_points.as_deref().unwrap_or("set-points"),
                self.machine
            ),
        };
        let period = every(self.period_s);
        let average = if self.cycle_time_s > 0.0 {
            self.path_length_mm / self.cycle_time_s
        } else {
            0.0
        };
        let _ = write!(
            text,
            "{program}: {how}\n\n\
             cycle time   {clock}  ({cycle:.3} s; {rows} set-points{period})\n\
             path         {length:.3} {unit} in {moves} moves from {blocks} blocks\n\
             feedrate     {average:.1} mm/s on average, {fastest:.1} mm/s at most ({per_minute:.0} mm/min)\n\
             deviation    {deviation:.5} mm from the path, {share:.1} % of the tolerance\n\
             corners      passed within {corner:.5} mm, {corner_share:.1} % of the tolerance\n\n",
            program = self.program,
            clock = clock(self.cycle_time_s),
            cycle = self.cycle_time_s,
            rows = self.setpoints,
            length = self.path_length_mm,
            unit = self.path_unit,
            moves = self.moves,
            blocks = self.blocks,
            fastest = self.peak_speed_mm_s,
            per_minute = 60.0 * self.peak_speed_mm_s,
            deviation = self.max_deviation_mm,
            share = 100.0 * self.max_deviation_share,
            corner = self.max_corner_error_mm,
            corner_share = 100.0 * self.max_corner_error_share,
        );
        self.axes_table(&mut text);
        text.push_str(self.smoothness.lines());
        if let Some(time) = self.planning_time_s {
            let _ = writeln!(text, "planned in   {time:.3} s");
        }
        if let Some(windows) = &self.windows {
            let _ = writeln!(text, "windows      {}", windows.text());
        }
        text.push_str(&verdict(self.violations, self.too_coarse));
        text
    }

    fn complaint(&self) -> String {
        let mut text = quoted(&self.program, &self.worst, self.violations);
        text.push_str(&quoted(&self.program, &self.coarsest, self.too_coarse));
        text
    }
}

/// Hours, minutes and seconds, as a clock on a machine shows them.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cycle time is not negative and far below 2^64 s"
)]
pub(crate) fn clock(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    format!("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
}

/// A number without the digits that its rounding brought, such as 1 for 1e3 times 0.001.
pub(crate) fn shortest(value: f64) -> f64 {
    let rounded = (value * 1e9).round() / 1e9;
    if rounded > 0.0 { rounded } else { value }
}

/// How often there is a set-point, where that is known.
pub(crate) fn every(period_s: Option<f64>) -> String {
    period_s.map_or_else(String::new, |period| {
        format!(" every {} ms", shortest(1e3 * period))
    })
}

/// Violations, the worst first, as text.
pub(crate) fn worst_first(examples: &[Violation]) -> Vec<String> {
    let mut sorted: Vec<_> = examples.iter().collect();
    sorted.sort_by(|one, two| severity(two).total_cmp(&severity(one)));
    sorted.iter().map(ToString::to_string).collect()
}

/// By how much a bound is exceeded; what has no bound is worse than anything that has one.
fn severity(violation: &Violation) -> f64 {
    match *violation {
        Violation::Velocity { value, limit, .. }
        | Violation::Acceleration { value, limit, .. }
        | Violation::Jerk { value, limit, .. } => value / limit,
        Violation::Feedrate {
            value, feedrate, ..
        } => value / feedrate,
        Violation::Deviation {
            value, tolerance, ..
        }
        | Violation::CornerMissed {
            value, tolerance, ..
        } => value / tolerance,
        _ => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_counts_hours_minutes_and_seconds() {
        assert_eq!(clock(0.2), "0:00:00");
        assert_eq!(clock(59.6), "0:01:00");
        assert_eq!(clock(3.0 * 3600.0 + 125.0), "3:02:05");
        assert_eq!(clock(360_000.0), "100:00:00");
    }
}
