//! Prints the summary of a plan of tool poses.
//!
//! Source: the report of the judge of poses. Not here: judging.

use crate::input::setup::Setup;
use crate::output::report::{Shown, is_zero, quoted, verdict};
use crate::output::summary::{clock, every};
use serde::Serialize;
use std::fmt::Write;
use toolglide_fiveaxis::Slowdown;
use toolglide_kinematics::AxisKind;
use toolglide_verify::PoseReport;

/// How many slowed moves are named.
const NAMED: usize = 5;

/// Largest value and limit of one axis, in mm or degrees.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct AxisSummary {
    axis: char,
    unit: &'static str,
    peak_velocity: f64,
    velocity_limit: f64,
    peak_acceleration: f64,
    acceleration_limit: f64,
    peak_jerk: f64,
    jerk_limit: f64,
    lowest: f64,
    highest: f64,
}

/// A move that is slower than its feedrate.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Slow {
    line: u32,
    factor: f64,
    axis: char,
    limit: &'static str,
}

/// What came out, as JSON names it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PoseSummary {
    pub(crate) program: String,
    pub(crate) machine: String,
    #[serde(rename = "setpoints_file", skip_serializing_if = "Option::is_none")]
    pub(crate) set_points: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) method: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) fir_s: Vec<f64>,
    /// Whether stretches between rests have other filters than those told, which are used for the longest time.
    pub(crate) fir_varies: bool,
    pub(crate) cycle_time_s: f64,
    pub(crate) setpoints: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) period_s: Option<f64>,
    pub(crate) blocks: u64,
    pub(crate) moves: u32,
    pub(crate) path_length_mm: f64,
    pub(crate) path_angle_deg: f64,
    /// Feed moves that turn the tool alone, and degrees of A, B and C that their feedrates count.
    pub(crate) turning_moves: u32,
    pub(crate) turning_deg: f64,
    pub(crate) peak_speed_mm_s: f64,
    pub(crate) tip_deviation_mm: f64,
    pub(crate) tip_deviation_share: f64,
    pub(crate) tip_corner_error_mm: f64,
    pub(crate) tip_corner_error_share: f64,
    pub(crate) orientation_deviation_rad: f64,
    pub(crate) orientation_deviation_share: f64,
    pub(crate) orientation_corner_error_rad: f64,
    pub(crate) orientation_corner_error_share: f64,
    pub(crate) axes: Vec<AxisSummary>,
    pub(crate) slowed_moves: usize,
    pub(crate) slowest: Vec<Slow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) planning_time_s: Option<f64>,
    pub(crate) violations: u64,
    pub(crate) worst: Vec<String>,
    /// How many times rows are too far apart to be judged, and the first of them.
    #[serde(skip_serializing_if = "is_zero")]
    pub(crate) too_coarse: u64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) coarsest: Vec<String>,
}

impl PoseSummary {
    /// A summary of a report; what only a planner knows is added by whoever planned.
    pub(crate) fn of(
        program: &str,
        setup: &Setup,
        report: &PoseReport,
        blocks: u64,
        set_points: u64,
    ) -> Self {
        let axes = setup
            .axes
            .iter()
            .zip(&report.axes)
            .map(|(axis, peaks)| {
                let (scale, unit) = match axis.kind {
                    AxisKind::Linear => (1.0, "mm"),
                    AxisKind::Rotary => (1.0_f64.to_degrees(), "deg"),
                };
                AxisSummary {
                    axis: axis.name,
                    unit,
                    peak_velocity: scale * peaks.velocity.value,
                    velocity_limit: scale * axis.limits.velocity(),
                    peak_acceleration: scale * peaks.acceleration.value,
                    acceleration_limit: scale * axis.limits.acceleration(),
                    peak_jerk: scale * peaks.jerk.value,
                    jerk_limit: scale * axis.limits.jerk(),
                    lowest: scale * peaks.lowest,
                    highest: scale * peaks.highest,
                }
            })
            .collect();
        Self {
            program: program.to_owned(),
            machine: setup.machine.clone(),
            set_points: None,
            method: None,
            fir_s: Vec::new(),
            fir_varies: false,
            cycle_time_s: report.cycle_time,
            setpoints: set_points,
            period_s: None,
            blocks,
            moves: report.moves,
            path_length_mm: report.path_length,
            path_angle_deg: report.path_angle.to_degrees(),
            turning_moves: 0,
            turning_deg: 0.0,
            peak_speed_mm_s: report.peak_speed.value,
            tip_deviation_mm: report.tip_deviation.value,
            tip_deviation_share: report.tip_ratio.value,
            tip_corner_error_mm: report.tip_corner.value,
            tip_corner_error_share: report.tip_corner_ratio.value,
            orientation_deviation_rad: report.orientation_deviation.value,
            orientation_deviation_share: report.orientation_ratio.value,
            orientation_corner_error_rad: report.orientation_corner.value,
            orientation_corner_error_share: report.orientation_corner_ratio.value,
            axes,
            slowed_moves: 0,
            slowest: Vec::new(),
            planning_time_s: None,
            violations: report.violations,
            worst: report.examples.iter().map(ToString::to_string).collect(),
            too_coarse: report.gaps.count,
            coarsest: report
                .gaps
                .examples
                .iter()
                .map(ToString::to_string)
                .collect(),
        }
    }

    /// Takes the moves that are slower than their feedrates.
    pub(crate) fn slowed(&mut self, slowdowns: &[Slowdown]) {
        let mut sorted = slowdowns.to_vec();
        sorted.sort_by(|one, two| two.factor.total_cmp(&one.factor));
        self.slowed_moves = slowdowns.len();
        self.slowest = sorted
            .iter()
            .take(NAMED)
            .map(|slow| Slow {
                line: slow.line,
                factor: slow.factor,
                axis: slow.axis,
                limit: slow.quantity,
            })
            .collect();
    }

    /// Tells the moves that turn the tool alone, and the degrees that their feedrate counts.
    fn turning(&self) -> String {
        if self.turning_moves == 0 {
            return String::new();
        }
        let word = if self.turning_moves == 1 {
            "move turns"
        } else {
            "moves turn"
        };
        format!(
            "turning      {} {word} the tool alone; the feedrate counts {:.1} degrees of A, B and C\n",
            self.turning_moves, self.turning_deg
        )
    }

    fn axes_table(&self, text: &mut String) {
        text.push_str(
            "axis         velocity, /s        acceleration, /s²       jerk, /s³               from, to\n",
        );
        for axis in &self.axes {
            // Adding zero takes the sign from what is rounded to nothing.
            let hundredths = |value: f64| (100.0 * value).round() / 100.0 + 0.0;
            let cell = |peak: f64, limit: f64| format!("{peak:.1}  {:.1} %", 100.0 * peak / limit);
            let _ = writeln!(
                text,
                "{:<12} {:<19} {:<23} {:<23} {:.2}, {:.2}",
                format!("{}, {}", axis.axis, axis.unit),
                cell(axis.peak_velocity, axis.velocity_limit),
                cell(axis.peak_acceleration, axis.acceleration_limit),
                cell(axis.peak_jerk, axis.jerk_limit),
                hundredths(axis.lowest),
                hundredths(axis.highest),
            );
        }
        text.push('\n');
    }
}

impl Shown for PoseSummary {
    fn passes(&self) -> bool {
        self.violations == 0 && self.too_coarse == 0
    }

    fn text(&self) -> String {
        let mut text = String::new();
        let how = match &self.method {
            Some(method) => {
                let filters: Vec<_> = self
                    .fir_s
                    .iter()
                    .map(|seconds| format!("{:.1}", 1e3 * seconds))
                    .collect();
                let filters = filters.join(" and ");
                let most = if self.fir_varies {
                    ", most of the time"
                } else {
                    ""
                };
                format!(
                    "planned by {method} for {}, filters of {filters} ms{most}",
                    self.machine
                )
            }
            None => format!(
                "{} judged for {}",
                self.set_points.as_deref().unwrap_or("set-points"),
                self.machine
            ),
        };
        let _ = write!(
            text,
            "{program}: {how}\n\n\
             cycle time   {clock}  ({cycle:.3} s; {rows} set-points{every})\n\
             path         {length:.3} mm and {angle:.2} degrees in {moves} moves from {blocks} blocks\n\
             {turning}feedrate     {fastest:.1} mm/s at most ({per_minute:.0} mm/min)\n\
             tool tip     {tip:.5} mm from the path, {tip_share:.1} % of the tolerance; \
             corners within {corner:.5} mm, {corner_share:.1} %\n\
             orientation  {tool:.6} rad from the path, {tool_share:.1} % of the tolerance; \
             corners within {turned:.6} rad, {turned_share:.1} %\n\n",
            program = self.program,
            clock = clock(self.cycle_time_s),
            cycle = self.cycle_time_s,
            rows = self.setpoints,
            every = every(self.period_s),
            length = self.path_length_mm,
            angle = self.path_angle_deg,
            moves = self.moves,
            blocks = self.blocks,
            turning = self.turning(),
            fastest = self.peak_speed_mm_s,
            per_minute = 60.0 * self.peak_speed_mm_s,
            tip = self.tip_deviation_mm,
            tip_share = 100.0 * self.tip_deviation_share,
            corner = self.tip_corner_error_mm,
            corner_share = 100.0 * self.tip_corner_error_share,
            tool = self.orientation_deviation_rad,
            tool_share = 100.0 * self.orientation_deviation_share,
            turned = self.orientation_corner_error_rad,
            turned_share = 100.0 * self.orientation_corner_error_share,
        );
        self.axes_table(&mut text);
        if self.slowed_moves > 0 {
            let _ = writeln!(
                text,
                "slowed       {} moves; those slowed most:",
                self.slowed_moves
            );
            for slow in &self.slowest {
                let _ = writeln!(
                    text,
                    "             line {}: {:.2} times as long, for the {} of axis {}",
                    slow.line, slow.factor, slow.limit, slow.axis
                );
            }
        }
        if let Some(time) = self.planning_time_s {
            let _ = writeln!(text, "planned in   {time:.3} s");
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
