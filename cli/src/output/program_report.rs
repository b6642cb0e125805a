//! Prints the content of a program, as text or as JSON.
//!
//! Not here: reading it.

use serde::Serialize;
use std::fmt::Write;
use toolglide_kinematics::{Feedrate, Move, Path, PoseEnd, PoseFeed, PoseMove, Vector};
use toolglide_program::{Code, ProgramError, Warning};

/// One minute, s.
const MINUTE: f64 = 60.0;

/// Lines that are told beside the first one that says the same.
const MAX_LINES: usize = 10;

/// Points of an arc that its extent is taken from.
const ARC_POINTS: u32 = 64;

/// What a program holds, as JSON names it.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Survey {
    pub(crate) program: String,
    pub(crate) dialect: &'static str,
    pub(crate) lines: u64,
    pub(crate) blocks: u64,
    pub(crate) moves: u64,
    pub(crate) straight_moves: u64,
    pub(crate) arcs: u64,
    pub(crate) rapids: u64,
    pub(crate) dwells: u64,
    pub(crate) length_mm: f64,
    pub(crate) rapid_length_mm: f64,
    pub(crate) least_mm: Option<[f64; 3]>,
    pub(crate) largest_mm: Option<[f64; 3]>,
    pub(crate) least_feedrate_mm_min: Option<f64>,
    pub(crate) largest_feedrate_mm_min: Option<f64>,
    /// Filament that a printer pushes out, less what it draws back; none for other programs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) filament_mm: Option<f64>,
    pub(crate) tools: Vec<u32>,
    pub(crate) codes: Vec<(String, u64)>,
    pub(crate) features: Vec<String>,
    pub(crate) warnings: Vec<Remark>,
    pub(crate) more_warnings: u64,
    pub(crate) errors: Vec<Remark>,
    pub(crate) more_errors: u64,
    /// Refusals that may follow from those before them.
    pub(crate) consequences: u64,
    #[serde(skip)]
    pub(crate) at: Vector<3>,
}

/// Something said about a place.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Remark {
    pub(crate) file: String,
    pub(crate) line: u64,
    pub(crate) column: u32,
    pub(crate) length: u32,
    pub(crate) word: String,
    pub(crate) message: String,
    /// How often it was said, and on which other lines at first.
    pub(crate) times: u64,
    pub(crate) more_lines: Vec<u64>,
}

impl Remark {
    pub(crate) fn of_error(error: &ProgramError) -> Self {
        Self {
            file: error.file().to_owned(),
            line: error.line(),
            column: error.column(),
            length: error.length(),
            word: error.word().to_owned(),
            message: error.reason().to_string(),
            times: 1,
            more_lines: Vec::new(),
        }
    }

    /// Whether another remark says the same: at the same place, or anywhere if its message says all.
    pub(crate) fn is_like(&self, other: &Self, anywhere: bool) -> bool {
        let there = self.line == other.line && self.column == other.column;
        self.message == other.message && self.file == other.file && (anywhere || there)
    }

    /// The same again, on a line.
    pub(crate) fn again(&mut self, line: u64) {
        self.times += 1;
        if self.more_lines.len() < MAX_LINES {
            self.more_lines.push(line);
        }
    }

    /// Where it was said again, for people.
    pub(crate) fn more(&self) -> Option<String> {
        let more = self.times.checked_sub(1).filter(|&more| more > 0)?;
        let mut lines = self.more_lines.clone();
        lines.dedup();
        let rest = if more > self.more_lines.len() as u64 {
            ", ..."
        } else {
            ""
        };
        let mut text = format!("line {}: the same {more} more times", self.line);
        if more == 1 {
            text = format!("line {}: the same once more", self.line);
        }
        if lines != [self.line] {
            let lines: Vec<String> = lines.iter().map(u64::to_string).collect();
            let _ = write!(text, ", on line {}{rest}", lines.join(", "));
        }
        Some(text)
    }

    pub(crate) fn of_warning(warning: &Warning) -> Self {
        let place = warning.place();
        Self {
            file: place.file().to_owned(),
            line: place.line(),
            column: place.column(),
            length: place.length(),
            word: place.word().to_owned(),
            message: warning.notice().to_string(),
            times: 1,
            more_lines: Vec::new(),
        }
    }
}

impl Survey {
    /// Takes a move of straight axes.
    pub(crate) fn meet(&mut self, step: &Move<3>) {
        let start = self.at;
        let end = step.end(start);
        let length = step.length(start);
        let rapid = step.feedrate() == Feedrate::RAPID;
        match step.path() {
            Path::Dwell { .. } => {
                self.dwells += 1;
                return;
            }
            Path::Arc(arc) => {
                self.arcs += 1;
                for point in 1..ARC_POINTS {
                    self.extend(arc.point(f64::from(point) / f64::from(ARC_POINTS)));
                }
            }
            _ if rapid => self.rapids += 1,
            _ => self.straight_moves += 1,
        }
        let speed = (!rapid).then(|| step.feedrate().speed());
        self.go(end, length, speed);
    }

    /// Takes a move of a tool.
    pub(crate) fn meet_pose(&mut self, step: &PoseMove) {
        let end = match step.end() {
            PoseEnd::Pose(pose) => pose.tip(),
            PoseEnd::Axes { linear, .. } => *linear,
            _ => {
                self.dwells += 1;
                return;
            }
        };
        let length = (end - self.at).norm();
        let speed = match step.feed() {
            PoseFeed::Rapid => None,
            PoseFeed::Speed(feedrate) => Some(feedrate.speed()),
            PoseFeed::Duration(duration) => Some(length / duration),
        };
        if speed.is_some() {
            self.straight_moves += 1;
        } else {
            self.rapids += 1;
        }
        self.go(end, length, speed);
    }

    fn go(&mut self, end: Vector<3>, length: f64, speed: Option<f64>) {
        self.moves += 1;
        self.extend(end);
        self.at = end;
        let Some(speed) = speed else {
            self.rapid_length_mm += length;
            return;
        };
        self.length_mm += length;
        if length > 0.0 {
            let feedrate = speed * MINUTE;
            let least = self.least_feedrate_mm_min.get_or_insert(feedrate);
            *least = least.min(feedrate);
            let largest = self.largest_feedrate_mm_min.get_or_insert(feedrate);
            *largest = largest.max(feedrate);
        }
    }

    fn extend(&mut self, point: Vector<3>) {
        let least = self.least_mm.get_or_insert(point.into());
        let largest = self.largest_mm.get_or_insert(point.into());
        for axis in 0..3 {
            least[axis] = least[axis].min(point[axis]);
            largest[axis] = largest[axis].max(point[axis]);
        }
    }

    /// Names the codes that were met.
    pub(crate) fn name_codes(&mut self, codes: impl Iterator<Item = (Code, u64)>) {
        self.codes = codes
            .map(|(code, count)| (code.to_string(), count))
            .collect();
    }

    /// The survey as text.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        let told: u64 = self.errors.iter().map(|error| error.times).sum();
        let refused = told + self.more_errors;
        let _ = writeln!(text, "{}: read as {}\n", self.program, self.dialect);
        let mut row = |name: &str, value: String| {
            let _ = writeln!(text, "{name:<12} {value}");
        };
        row(
            "lines",
            format!("{} with {} blocks", self.lines, self.blocks),
        );
        row(
            "moves",
            format!(
                "{}: {} straight, {} arcs, {} rapids; {} dwells",
                self.moves, self.straight_moves, self.arcs, self.rapids, self.dwells
            ),
        );
        row(
            "length",
            format!(
                "{:.3} mm at feed, {:.3} mm rapid",
                self.length_mm, self.rapid_length_mm
            ),
        );
        if let (Some(least), Some(largest)) = (self.least_mm, self.largest_mm) {
            for (axis, letter) in ['X', 'Y', 'Z'].into_iter().enumerate() {
                let extent = format!("{:.3} to {:.3} mm", least[axis], largest[axis]);
                row(&letter.to_string(), extent);
            }
        }
        if let (Some(least), Some(largest)) =
            (self.least_feedrate_mm_min, self.largest_feedrate_mm_min)
        {
            row("feedrate", format!("{least:.1} to {largest:.1} mm/min"));
        }
        if let Some(length) = self.filament_mm {
            row("filament", format!("{length:.3} mm"));
        }
        if !self.tools.is_empty() {
            let tools: Vec<String> = self.tools.iter().map(|tool| format!("T{tool}")).collect();
            row("tools", tools.join(" "));
        }
        if !self.codes.is_empty() {
            let codes: Vec<String> = self
                .codes
                .iter()
                .map(|(code, count)| format!("{code}×{count}"))
                .collect();
            row("codes", codes.join(" "));
        }
        if !self.features.is_empty() {
            row("beside them", self.features.join(", "));
        }
        let warnings = self.warnings.len() as u64 + self.more_warnings;
        row("warnings", warnings.to_string());
        let follow = match self.consequences {
            0 => String::new(),
            more => format!(", and {more} that may follow"),
        };
        row(
            "verdict",
            match refused {
                0 => "every line is read".to_owned(),
                1 => format!("1 line is refused{follow}"),
                _ => format!("{refused} lines are refused{follow}"),
            },
        );
        text
    }
}
