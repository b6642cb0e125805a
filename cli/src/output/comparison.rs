//! Prints several methods side by side, as a table or as JSON.
//!
//! Source: the judge's reports. Not here: planning.

use crate::input::setup::Setup;
use crate::output::report::{Shown, quoted};
use crate::output::smoothness::Measures;
use crate::output::summary::worst_first;
use serde::Serialize;
use std::fmt::Write;
use std::time::Duration;
use toolglide_verify::{Peak, Report};

/// Several methods on one program, as JSON names it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Comparison {
    program: String,
    machine: String,
    blocks: u64,
    axes: Vec<char>,
    acceleration_limit: Vec<f64>,
    jerk_limit: Vec<f64>,
    methods: Vec<MethodRow>,
}

/// What one method did.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct MethodRow {
    method: String,
    cycle_time_s: f64,
    ratio_to_exact_stop: f64,
    peak_acceleration: Vec<f64>,
    peak_jerk: Vec<f64>,
    max_deviation_mm: f64,
    max_corner_error_mm: f64,
    #[serde(flatten)]
    smoothness: Measures,
    violations: u64,
    planning_us_per_block: f64,
    #[serde(skip)]
    worst: Vec<String>,
}

impl MethodRow {
    /// What a method did; `stop` is the cycle time with exact stops.
    #[allow(clippy::cast_precision_loss, reason = "blocks are fewer than 2^53")]
    pub(crate) fn of<const N: usize>(
        method: &str,
        report: &Report<N>,
        planning_time: Duration,
        blocks: u64,
        stop: f64,
        setup: &Setup,
    ) -> Self {
        let values = |peaks: &[Peak; N]| peaks.iter().map(|peak| peak.value).collect();
        Self {
            method: method.to_owned(),
            cycle_time_s: report.cycle_time,
            // A motion that takes no time takes no less than another.
            ratio_to_exact_stop: if stop > 0.0 {
                report.cycle_time / stop
            } else {
                1.0
            },
            peak_acceleration: values(&report.peak_acceleration),
            peak_jerk: values(&report.peak_jerk),
            max_deviation_mm: report.deviation.value,
            max_corner_error_mm: report.corner_error.value,
            smoothness: Measures::of(report.smoothness.as_ref(), setup),
            violations: report.violations,
            planning_us_per_block: 1e6 * planning_time.as_secs_f64() / blocks.max(1) as f64,
            worst: worst_first(&report.examples),
        }
    }
}

impl Comparison {
    /// The methods of a run.
    pub(crate) fn new(program: &str, setup: &Setup, blocks: u64, methods: Vec<MethodRow>) -> Self {
        let limits = || setup.axes.iter().map(|axis| axis.limits);
        Self {
            program: program.to_owned(),
            machine: setup.machine.clone(),
            blocks,
            axes: setup.letters(),
            acceleration_limit: limits().map(|limits| limits.acceleration()).collect(),
            jerk_limit: limits().map(|limits| limits.jerk()).collect(),
            methods,
        }
    }

    fn peaks(
        &self,
        text: &mut String,
        title: &str,
        limits: &[f64],
        peaks: impl Fn(&MethodRow) -> &[f64],
    ) {
        let _ = write!(text, "\n{title}\n{:<18}", "method");
        for axis in &self.axes {
            let _ = write!(text, " {axis:>12} {:>8}", "");
        }
        trim(text);
        for row in &self.methods {
            let _ = write!(text, "{:<18}", row.method);
            for (peak, limit) in peaks(row).iter().zip(limits) {
                let _ = write!(text, " {peak:>12.1} {:>6.1} %", 100.0 * peak / limit);
            }
            trim(text);
        }
    }
}

impl Shown for Comparison {
    fn passes(&self) -> bool {
        self.methods.iter().all(|row| row.violations == 0)
    }

    fn text(&self) -> String {
        let mut text = format!(
            "{}: {} blocks, planned for {}\n\n",
            self.program, self.blocks, self.machine
        );
        let _ = writeln!(
            text,
            "{:<18} {:>14} {:>11} {:>14} {:>17} {:>11} {:>13}",
            "method",
            "cycle time, s",
            "exact stop",
            "deviation, mm",
            "corner error, mm",
            "violations",
            "µs per block"
        );
        for row in &self.methods {
            let _ = writeln!(
                text,
                "{:<18} {:>14.4} {:>9.1} % {:>14.5} {:>17.5} {:>11} {:>13.1}",
                row.method,
                row.cycle_time_s,
                100.0 * row.ratio_to_exact_stop,
                row.max_deviation_mm,
                row.max_corner_error_mm,
                row.violations,
                row.planning_us_per_block
            );
        }
        self.peaks(
            &mut text,
            "peak acceleration, mm/s² and share of the limit",
            &self.acceleration_limit,
            |row| &row.peak_acceleration,
        );
        self.peaks(
            &mut text,
            "peak jerk, mm/s³ and share of the limit",
            &self.jerk_limit,
            |row| &row.peak_jerk,
        );
        text.push_str("\nhow smooth\n");
        for row in &self.methods {
            for line in row.smoothness.lines().lines() {
                let _ = writeln!(text, "{:<18} {}", row.method, line);
            }
        }
        text
    }

    fn complaint(&self) -> String {
        self.methods
            .iter()
            .map(|row| {
                let whose = format!("{}: {}", self.program, row.method);
                quoted(&whose, &row.worst, row.violations)
            })
            .collect()
    }
}

/// Ends a line without blanks before its end.
fn trim(text: &mut String) {
    text.truncate(text.trim_end().len());
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_method_that_breaks_a_limit_is_named_and_the_comparison_fails() {
        let row = |method: &str, worst: &[&str], violations| MethodRow {
            method: method.to_owned(),
            cycle_time_s: 2.0,
            ratio_to_exact_stop: 0.5,
            peak_acceleration: vec![10.0],
            peak_jerk: vec![30.0],
            max_deviation_mm: 0.0,
            max_corner_error_mm: 0.0,
            smoothness: Measures::default(),
            violations,
            planning_us_per_block: 1.0,
            worst: worst.iter().map(|&wrong| wrong.to_owned()).collect(),
        };
        let mut comparison = Comparison {
            program: "a.ngc".to_owned(),
            machine: "m".to_owned(),
            blocks: 1,
            axes: vec!['X'],
            acceleration_limit: vec![20.0],
            jerk_limit: vec![40.0],
            methods: vec![row("good", &[], 0)],
        };
        assert!(comparison.passes(), "nothing is broken");
        assert_eq!(comparison.complaint(), "");
        comparison.methods.push(row("bad", &["too fast"], 3));
        assert!(!comparison.passes(), "one is broken");
        assert_eq!(
            comparison.complaint(),
            "a.ngc: bad: too fast\na.ngc: bad: and 2 more\n"
        );
        let text = comparison.text();
        assert!(
            text.contains(" 50.0 %") && text.contains(" 75.0 %"),
            "{text}"
        );
        assert!(text.lines().all(|line| line == line.trim_end()), "{text}");
    }
}
