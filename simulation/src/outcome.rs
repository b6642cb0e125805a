//! Collects the figures of a simulated motion: errors, axes, modes.
//!
//! Not here: the simulation.

use crate::gains::Gains;
use crate::model::LoopReport;

/// Root of the mean square and largest value of an error, and where that was.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorFigure {
    squares: f64,
    count: u64,
    /// Largest magnitude, mm or rad.
    pub largest: f64,
    /// When, s.
    pub time: f64,
    /// Program line that was followed then; 0 for none.
    pub line: u32,
    /// Largest share of a tolerance; 0 where there is none.
    pub share: f64,
}

impl ErrorFigure {
    /// Takes a value at a time, s, on a program line.
    #[inline]
    pub(crate) fn add(&mut self, value: f64, time: f64, line: u32) {
        self.squares += value * value;
        self.count += 1;
        if value.abs() > self.largest {
            self.largest = value.abs();
            self.time = time;
            self.line = line;
        }
    }

    /// The same beside a tolerance.
    #[inline]
    pub(crate) fn add_within(&mut self, value: f64, tolerance: f64, time: f64, line: u32) {
        self.add(value, time, line);
        if tolerance > 0.0 {
            self.share = self.share.max(value.abs() / tolerance);
        }
    }

    /// Root of the mean square, mm or rad.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "fewer than 2^53 ticks")]
    pub fn rms(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }
}

/// What one axis did. Lengths in mm or rad, specific forces in mm/s² or rad/s².
#[derive(Clone, Debug, PartialEq)]
pub struct AxisOutcome {
    /// Letter of the axis.
    pub name: char,
    /// Distance of the motor from its set-point.
    pub tracking: ErrorFigure,
    /// Commanded force.
    pub force: ErrorFigure,
    /// Largest force that the drive has; infinite for none.
    pub force_limit: f64,
    /// Time at that limit, s.
    pub saturated: f64,
    /// Reversals of the set-points.
    pub reversals: u64,
    /// Largest distance from the set-point within the window after a reversal.
    pub reversal_peak: f64,
    /// Gains of the cascade.
    pub gains: Gains,
    /// How the loop behaves.
    pub report: LoopReport,
}

/// What one mode did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeOutcome {
    /// Letter of the axis that excites it.
    pub axis: char,
    /// Frequency with the drive held, Hz.
    pub frequency: f64,
    /// Damping ratio.
    pub damping: f64,
    /// Largest displacement relative to the drive during the motion, mm or rad.
    pub largest_displacement: f64,
    /// Largest displacement of the tool by it, mm; 0 for a mode that the tool does not have.
    pub largest_at_tool: f64,
    /// Largest acceleration of the beam during the motion, mm/s² or rad/s².
    pub largest_acceleration: f64,
    /// Largest acceleration of the set-points of its axis, mm/s² or rad/s².
    pub planned_acceleration: f64,
    /// Amplitude left by the motion, mm or rad: that after settling, carried back to the end of the motion by its own damping.
    pub left: f64,
    /// Amplitude of its acceleration left by the motion, mm/s² or rad/s².
    pub left_acceleration: f64,
}

/// What a motion became behind its drives.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// How long the motion takes, s.
    pub cycle_time: f64,
    /// Distance of the tool from the planned motion, mm.
    pub servo: ErrorFigure,
    /// Distance of the tool from the programmed path, mm; `share` is of the tolerance of each move.
    pub part: ErrorFigure,
    /// Time after the end until every axis stays within the window, s; `None` where it does not within the time watched.
    pub settling: Option<f64>,
    /// The axes, in machine order.
    pub axes: Vec<AxisOutcome>,
    /// The modes, axis by axis.
    pub modes: Vec<ModeOutcome>,
}

/// What a motion of poses became behind its drives.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseOutcome {
    /// Figures of the tool tip, the axes and the modes.
    pub tip: Outcome,
    /// Angle of the tool from the planned orientations, rad.
    pub servo_orientation: ErrorFigure,
    /// Angle of the tool from the programmed orientations, rad.
    pub part_orientation: ErrorFigure,
}
