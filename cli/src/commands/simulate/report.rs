//! Reports simulated motions: one in full, several as a table.
//!
//! Not here: the simulation.

use crate::input::setup::Setup;
use crate::output::report::{Shown, quoted};
use serde::Serialize;
use std::fmt::Write as _;
use toolglide_simulation::{AxisOutcome, ErrorFigure, ModeOutcome};

/// What the plan leaves in each mode, mm.
#[derive(Clone, Debug, Default)]
pub(super) struct LeftByPlan {
    pub(super) modes: Vec<f64>,
}

/// An error in figures.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ErrorRow {
    rms_um: f64,
    largest_um: f64,
    at_s: f64,
    line: u32,
    /// Axis that reversed shortly before.
    reversing: Option<char>,
    share_of_tolerance: f64,
}

impl From<(&ErrorFigure, Option<char>)> for ErrorRow {
    fn from((figure, reversing): (&ErrorFigure, Option<char>)) -> Self {
        Self {
            rms_um: 1e3 * figure.rms(),
            largest_um: 1e3 * figure.largest,
            at_s: figure.time,
            line: figure.line,
            reversing,
            share_of_tolerance: figure.share,
        }
    }
}

/// What an axis did.
#[derive(Clone, Debug, Serialize)]
pub(super) struct AxisRow {
    axis: char,
    lag_um: f64,
    force_peak: f64,
    force_rms: f64,
    force_limit: Option<f64>,
    saturated_s: f64,
    reversals: u64,
    reversal_peak_um: f64,
    position_gain: f64,
    velocity_gain: f64,
    integral_gain: f64,
    bandwidth_hz: f64,
    resonance: f64,
    gain_margin_db: Option<f64>,
    lively: bool,
}

impl AxisRow {
    pub(super) fn of(axis: &AxisOutcome) -> Self {
        let finite = |value: f64| value.is_finite().then_some(value);
        Self {
            axis: axis.name,
            lag_um: 1e3 * axis.tracking.largest,
            force_peak: axis.force.largest,
            force_rms: axis.force.rms(),
            force_limit: finite(axis.force_limit),
            saturated_s: axis.saturated,
            reversals: axis.reversals,
            reversal_peak_um: 1e3 * axis.reversal_peak,
            position_gain: axis.gains.position,
            velocity_gain: axis.gains.velocity,
            integral_gain: axis.gains.integral,
            bandwidth_hz: axis.report.bandwidth,
            resonance: axis.report.resonance,
            gain_margin_db: finite(axis.report.gain_margin),
            lively: axis.report.is_lively(),
        }
    }
}

/// What a mode did.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ModeRow {
    axis: char,
    frequency_hz: f64,
    damping: f64,
    /// Frequency with the loop closed, where the drive feels the mode.
    closed_loop_hz: Option<f64>,
    largest_um: f64,
    largest_at_tool_um: f64,
    largest_mm_s2: f64,
    set_points_mm_s2: f64,
    left_by_the_plan_um: f64,
    left_at_the_machine_um: f64,
    left_mm_s2: f64,
}

impl ModeRow {
    pub(super) fn of(mode: &ModeOutcome, plan: f64, closed_loop: Option<f64>) -> Self {
        Self {
            axis: mode.axis,
            frequency_hz: mode.frequency,
            damping: mode.damping,
            closed_loop_hz: closed_loop,
            largest_um: 1e3 * mode.largest_displacement,
            largest_at_tool_um: 1e3 * mode.largest_at_tool,
            largest_mm_s2: mode.largest_acceleration,
            set_points_mm_s2: mode.planned_acceleration,
            left_by_the_plan_um: 1e3 * plan,
            left_at_the_machine_um: 1e3 * mode.left,
            left_mm_s2: mode.left_acceleration,
        }
    }
}

/// One case.
#[derive(Clone, Debug, Serialize)]
pub(super) struct CaseRow {
    #[serde(rename = "case")]
    pub(super) label: String,
    #[serde(skip)]
    pub(super) program: String,
    pub(super) cycle_time_s: f64,
    pub(super) settled_s: Option<f64>,
    pub(super) servo: ErrorRow,
    pub(super) part: ErrorRow,
    pub(super) axes: Vec<AxisRow>,
    pub(super) modes: Vec<ModeRow>,
    pub(super) violations: u64,
    #[serde(skip)]
    pub(super) worst: Vec<String>,
}

impl CaseRow {
    /// Largest part error, mm.
    pub(super) fn part_mm(&self) -> f64 {
        1e-3 * self.part.largest_um
    }
}

/// All that is shown.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Simulation {
    pub(super) program: String,
    machine: String,
    /// Whether the drives are those of the textbook.
    pub(super) textbook: bool,
    required_mm: Option<f64>,
    cases: Vec<CaseRow>,
}

impl Simulation {
    pub(super) fn new(setup: &Setup, required_mm: Option<f64>) -> Self {
        Self {
            program: String::new(),
            machine: setup.machine.clone(),
            textbook: false,
            required_mm,
            cases: Vec::new(),
        }
    }

    pub(super) fn add(&mut self, row: CaseRow) {
        self.cases.push(row);
    }

    /// A line for a picture.
    pub(super) fn subtitle(&self) -> String {
        let drives = if self.textbook {
            ", textbook drives"
        } else {
            ""
        };
        match &self.cases[..] {
            [one] => format!(
                "{} behind the drives of {}{drives} · cycle time {:.3} s · servo error {:.2} µm RMS, {:.1} µm at most · part error {:.1} µm at most",
                one.label,
                self.machine,
                one.cycle_time_s,
                one.servo.rms_um,
                one.servo.largest_um,
                one.part.largest_um
            ),
            several => format!(
                "{} motions behind the drives of {}{drives}",
                several.len(),
                self.machine
            ),
        }
    }

    fn exceeds(&self, row: &CaseRow) -> bool {
        self.required_mm
            .is_some_and(|required| row.part_mm() > required)
    }

    fn one(&self, text: &mut String, row: &CaseRow) {
        let settled = match row.settled_s {
            Some(time) => format!("settled {:.0} ms later", 1e3 * time),
            None => "not settled within 200 ms".to_owned(),
        };
        let _ = writeln!(text, "cycle time   {:.4} s, {settled}", row.cycle_time_s);
        let _ = writeln!(text, "servo error  {}", place(&row.servo));
        let _ = writeln!(
            text,
            "part error   {}, {:.1} % of the tolerance\n",
            place(&row.part),
            100.0 * row.part.share_of_tolerance
        );
        axes(text, row);
        modes(text, row);
        let inside = row.part.share_of_tolerance <= 1.0;
        let verdict = if row.violations > 0 {
            "the plan breaks its limits".to_owned()
        } else if self.exceeds(row) {
            format!(
                "the part error exceeds the {} µm required",
                1e3 * self.required_mm.unwrap_or(0.0)
            )
        } else if inside {
            "the part is inside its tolerance".to_owned()
        } else {
            "the part is outside its tolerance; the plan is not to blame".to_owned()
        };
        let _ = writeln!(text, "verdict      {verdict}");
    }

    fn several(&self, text: &mut String) {
        let width = self
            .cases
            .iter()
            .map(|row| row.label.chars().count())
            .max()
            .unwrap_or(0)
            .max(6);
        let _ = writeln!(
            text,
            "{:<width$} {:>13} {:>10} {:>10} {:>10} {:>10} {:>9} {:>6} {:>12} {:>10}",
            "case",
            "cycle time, s",
            "servo, RMS",
            "most, µm",
            "part, RMS",
            "most, µm",
            "of tol.",
            "line",
            "force, mm/s²",
            "saturated"
        );
        for row in &self.cases {
            let force = row
                .axes
                .iter()
                .map(|axis| axis.force_peak)
                .fold(0.0, f64::max);
            let saturated: f64 = row.axes.iter().map(|axis| axis.saturated_s).sum();
            let _ = writeln!(
                text,
                "{:<width$} {:>13.4} {:>10.3} {:>10.2} {:>10.3} {:>10.2} {:>7.1} % {:>6} {:>12.0} {:>8.3} s",
                row.label,
                row.cycle_time_s,
                row.servo.rms_um,
                row.servo.largest_um,
                row.part.rms_um,
                row.part.largest_um,
                100.0 * row.part.share_of_tolerance,
                row.part.line,
                force,
                saturated
            );
        }
        if self.cases.iter().any(|row| !row.modes.is_empty()) {
            let _ = writeln!(
                text,
                "\n{:<width$} {:>5} {:>9} {:>13} {:>14} {:>15} {:>16}",
                "case",
                "axis",
                "mode, Hz",
                "at most, µm",
                "beam, mm/s²",
                "left by plan",
                "at machine, µm"
            );
            for row in &self.cases {
                for mode in &row.modes {
                    let _ = writeln!(
                        text,
                        "{:<width$} {:>5} {:>9.2} {:>13.2} {:>14.1} {:>15.3} {:>16.3}",
                        row.label,
                        mode.axis,
                        mode.frequency_hz,
                        mode.largest_um,
                        mode.largest_mm_s2,
                        mode.left_by_the_plan_um,
                        mode.left_at_the_machine_um
                    );
                }
            }
        }
    }
}

/// An error with the place of its largest value.
fn place(error: &ErrorRow) -> String {
    let reverses = error
        .reversing
        .map_or_else(String::new, |axis| format!(": {axis} has reversed"));
    let line = if error.line > 0 {
        format!("line {}, ", error.line)
    } else {
        String::new()
    };
    format!(
        "{:.2} µm RMS, {:.1} µm at most ({line}{:.3} s{reverses})",
        error.rms_um, error.largest_um, error.at_s
    )
}

fn axes(text: &mut String, row: &CaseRow) {
    let _ = writeln!(
        text,
        "{:<6} {:>9} {:>18} {:>10} {:>11} {:>10} {:>13} {:>14} {:>10}",
        "axis",
        "lag, µm",
        "force peak, mm/s²",
        "of limit",
        "saturated",
        "reversals",
        "peak there",
        "bandwidth, Hz",
        "resonance"
    );
    for axis in &row.axes {
        let limit = axis.force_limit.map_or_else(
            || "-".to_owned(),
            |limit| format!("{:.1} %", 100.0 * axis.force_peak / limit),
        );
        let _ = writeln!(
            text,
            "{:<6} {:>9.1} {:>18.0} {:>10} {:>9.3} s {:>10} {:>10.1} µm {:>14.1} {:>10.2}{}",
            axis.axis,
            axis.lag_um,
            axis.force_peak,
            limit,
            axis.saturated_s,
            axis.reversals,
            axis.reversal_peak_um,
            axis.bandwidth_hz,
            axis.resonance,
            if axis.lively { "  lively" } else { "" }
        );
    }
    text.push('\n');
}

fn modes(text: &mut String, row: &CaseRow) {
    if row.modes.is_empty() {
        return;
    }
    let _ = writeln!(
        text,
        "{:<6} {:>9} {:>15} {:>12} {:>13} {:>18} {:>14} {:>18}",
        "axis",
        "mode, Hz",
        "loop closed, Hz",
        "at most, µm",
        "at tool, µm",
        "beam / plan, mm/s²",
        "left by plan",
        "at the machine, µm"
    );
    for mode in &row.modes {
        let closed = mode
            .closed_loop_hz
            .map_or_else(|| "-".to_owned(), |closed| format!("{closed:.2}"));
        let _ = writeln!(
            text,
            "{:<6} {:>9.2} {:>15} {:>12.2} {:>13.2} {:>18} {:>14.3} {:>18.3}",
            mode.axis,
            mode.frequency_hz,
            closed,
            mode.largest_um,
            mode.largest_at_tool_um,
            format!("{:.0} / {:.0}", mode.largest_mm_s2, mode.set_points_mm_s2),
            mode.left_by_the_plan_um,
            mode.left_at_the_machine_um
        );
    }
    text.push('\n');
}

impl Shown for Simulation {
    fn text(&self) -> String {
        let what = match &self.cases[..] {
            [one] => format!("{} on {}", one.label, self.machine),
            several => format!("{} motions on {}", several.len(), self.machine),
        };
        let drives = if self.textbook {
            ", with the textbook drive: the machine file has none"
        } else {
            ""
        };
        let mut text = format!("{}: {what}{drives}\n\n", self.program);
        match &self.cases[..] {
            [one] => self.one(&mut text, one),
            _ => self.several(&mut text),
        }
        text
    }

    fn complaint(&self) -> String {
        let mut text = String::new();
        for row in &self.cases {
            let whose = format!("{}: {}", self.program, row.label);
            text.push_str(&quoted(&whose, &row.worst, row.violations));
            if self.exceeds(row) {
                let _ = writeln!(
                    text,
                    "{whose}: part error {:.4} mm on line {}, but {} mm is required",
                    row.part_mm(),
                    row.part.line,
                    self.required_mm.unwrap_or(0.0)
                );
            }
        }
        text
    }

    fn passes(&self) -> bool {
        self.cases
            .iter()
            .all(|row| row.violations == 0 && !self.exceeds(row))
    }
}
