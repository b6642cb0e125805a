//! Runs the drives of a machine side by side and keeps the figures of each.
//!
//! Not here: errors of the tool.

use crate::drive::Drive;
use crate::error::{DriveError, SimulationError};
use crate::model::DriveModel;
use crate::outcome::{AxisOutcome, ErrorFigure, ModeOutcome};
use crate::simulator::SHOWN_MODES;
use std::f64::consts::TAU;

/// A drive this far from its set-point has lost it, mm or rad.
const LOST: f64 = 1000.0;

/// Steps of set-points below this are rest, mm or rad.
const REST: f64 = 1e-12;

/// Shortest window in which the foot of the tool is looked for, servo periods.
const MIN_LAG: f64 = 20.0;

/// How far ahead of the set-points the tool is looked for, s, and servo periods at least.
const LEAD: f64 = 0.01;
const MIN_LEAD: f64 = 10.0;

/// An axis of a machine: its letter and its drive.
#[derive(Clone, Debug)]
pub struct DrivenAxis {
    /// Letter of the axis.
    pub name: char,
    /// Its drive.
    pub model: DriveModel,
    /// Which coordinate of the tool it is, 0 to 2 for X, Y and Z.
    pub coordinate: Option<usize>,
}

#[derive(Clone, Debug)]
struct Running {
    name: char,
    drive: Drive,
    tracking: ErrorFigure,
    force: ErrorFigure,
    saturated: u64,
    reversals: u64,
    reversal_peak: f64,
    since_reversal: u64,
    direction: f64,
    last: [f64; 2],
    planned_acceleration: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct ModeFigures {
    displacement: f64,
    at_tool: f64,
    acceleration: f64,
}

/// All drives of a machine.
#[derive(Clone, Debug)]
pub(crate) struct Axes {
    axes: Vec<Running>,
    modes: Vec<ModeFigures>,
    has_modes: bool,
    pub(crate) period: f64,
    window: f64,
    /// Last tick at which an axis was outside the window.
    unsettled: u64,
}

impl Axes {
    /// Drives at rest at positions; `window` is how near counts as settled, mm or rad.
    pub(crate) fn new(
        axes: &[DrivenAxis],
        start: &[f64],
        window: f64,
    ) -> Result<Self, SimulationError> {
        let Some(period) = axes.first().map(|axis| axis.model.settings.servo_period) else {
            return Err(DriveError::new("axis", "none", "at least one").into());
        };
        if let Some(other) = axes
            .iter()
            .map(|axis| axis.model.settings.servo_period)
            .find(|other| (other / period - 1.0).abs() > 1e-9)
        {
            return Err(DriveError::new(
                "servo_period_s",
                other,
                format!("that of all axes, {period}"),
            )
            .into());
        }
        let running: Vec<Running> = axes
            .iter()
            .zip(start)
            .map(|(axis, &position)| Running {
                name: axis.name,
                drive: Drive::new(&axis.model, position),
                tracking: ErrorFigure::default(),
                force: ErrorFigure::default(),
                saturated: 0,
                reversals: 0,
                reversal_peak: 0.0,
                since_reversal: u64::MAX,
                direction: 0.0,
                last: [position; 2],
                planned_acceleration: 0.0,
            })
            .collect();
        let modes: usize = axes.iter().map(|axis| axis.model.modes().len()).sum();
        Ok(Self {
            axes: running,
            modes: vec![ModeFigures::default(); modes],
            has_modes: modes > 0,
            period,
            window,
            unsettled: 0,
        })
    }

    /// Set-points behind now, and ahead of now, among which the foot of the tool lies.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "windows of time are positive and short"
    )]
    pub(crate) fn windows(axes: &[DrivenAxis]) -> (u64, u64) {
        let slowest = axes
            .iter()
            .map(|axis| axis.model.report().bandwidth)
            .fold(f64::INFINITY, f64::min);
        let period = axes
            .first()
            .map_or(1e-3, |axis| axis.model.settings.servo_period);
        let lag = (8.0 / (TAU * slowest.max(0.1)) / period).max(MIN_LAG);
        let lead = (LEAD / period).max(MIN_LEAD);
        (lag.ceil() as u64, lead.ceil() as u64)
    }

    /// Position of the table of each axis, mm or rad.
    #[inline]
    pub(crate) fn table(&self, axis: usize) -> f64 {
        self.axes.get(axis).map_or(0.0, |axis| axis.drive.table())
    }

    /// Commanded specific force of an axis.
    pub(crate) fn force(&self, axis: usize) -> f64 {
        self.axes.get(axis).map_or(0.0, |axis| axis.drive.command())
    }

    /// Specific friction force of an axis.
    pub(crate) fn friction(&self, axis: usize) -> f64 {
        self.axes
            .get(axis)
            .map_or(0.0, |axis| axis.drive.friction())
    }

    /// Displacement of the first modes relative to their drives.
    #[inline]
    pub(crate) fn mode_displacements(&self) -> [f64; SHOWN_MODES] {
        let mut shown = [0.0; SHOWN_MODES];
        if self.has_modes {
            let all = self.axes.iter().flat_map(|axis| {
                (0..axis.drive.model().modes().len()).map(|mode| axis.drive.mode(mode)[0])
            });
            for (shown, displacement) in shown.iter_mut().zip(all) {
                *shown = displacement;
            }
        }
        shown
    }

    /// What the modes add to the tool, along X, Y and Z.
    #[inline]
    pub(crate) fn at_tool(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        if !self.has_modes {
            return sum;
        }
        for axis in &self.axes {
            for (index, mode) in axis.drive.model().modes().iter().enumerate() {
                let displacement = axis.drive.mode(index)[0];
                for (sum, share) in sum.iter_mut().zip(&mode.at_tool) {
                    *sum += share * displacement;
                }
            }
        }
        sum
    }

    /// Moves all drives by one period towards their set-points, the tick `now`; `moving` until the motion is over. What a
    /// drive is given may be shaped ahead of its set-point.
    #[inline]
    pub(crate) fn tick(
        &mut self,
        set_points: &[f64],
        shaped: &[f64],
        now: u64,
        time: f64,
        moving: bool,
        lag: u64,
    ) -> Result<(), SimulationError> {
        let mut out = false;
        for ((axis, &set_point), &shaped) in self.axes.iter_mut().zip(set_points).zip(shaped) {
            let error = set_point - axis.drive.position();
            if error.is_nan() || error.abs() >= LOST {
                return Err(if set_point.is_finite() {
                    SimulationError::Diverged {
                        time,
                        axis: axis.name,
                        error,
                    }
                } else {
                    SimulationError::NotFinite { time }
                });
            }
            out |= error.abs() > self.window;
            if moving {
                axis.tracking.add(error, time, 0);
                axis.watch_reversal(set_point, error, lag, self.period);
            }
            axis.drive.tick(shaped);
            axis.saturated += u64::from(axis.drive.is_saturated());
            if moving {
                axis.force.add(axis.drive.command(), time, 0);
            }
        }
        if out {
            self.unsettled = now + 1;
        }
        if self.has_modes && moving {
            self.watch_modes();
        }
        Ok(())
    }

    fn watch_modes(&mut self) {
        let mut figures = self.modes.iter_mut();
        for axis in &self.axes {
            for (index, mode) in axis.drive.model().modes().iter().enumerate() {
                let Some(figure) = figures.next() else { return };
                let [displacement, velocity] = axis.drive.mode(index);
                let tool = mode.at_tool.iter().map(|share| share * share).sum::<f64>();
                let acceleration = mode.acceleration(displacement, velocity);
                figure.displacement = figure.displacement.max(displacement.abs());
                figure.at_tool = figure.at_tool.max(displacement.abs() * tool.sqrt());
                figure.acceleration = figure.acceleration.max(acceleration.abs());
            }
        }
    }

    /// The reversal that an axis made within a time before `time`, s, if any: its letter.
    pub(crate) fn reversing(&self, lag: u64) -> Option<char> {
        self.axes
            .iter()
            .filter(|axis| axis.since_reversal <= lag)
            .min_by_key(|axis| axis.since_reversal)
            .map(|axis| axis.name)
    }

    /// Figures of all axes.
    #[allow(clippy::cast_precision_loss, reason = "fewer than 2^53 ticks")]
    pub(crate) fn outcomes(&self) -> Vec<AxisOutcome> {
        self.axes
            .iter()
            .map(|axis| AxisOutcome {
                name: axis.name,
                tracking: axis.tracking,
                force: axis.force,
                force_limit: axis.drive.model().settings.force_limit,
                saturated: axis.saturated as f64 * self.period,
                reversals: axis.reversals,
                reversal_peak: axis.reversal_peak,
                gains: axis.drive.model().gains(),
                report: axis.drive.model().report(),
            })
            .collect()
    }

    /// Figures of all modes; `since` is the time since the end of the motion, s.
    pub(crate) fn mode_outcomes(&self, since: f64) -> Vec<ModeOutcome> {
        let mut found = Vec::with_capacity(self.modes.len());
        let mut figures = self.modes.iter();
        for axis in &self.axes {
            for (index, mode) in axis.drive.model().modes().iter().enumerate() {
                let Some(figure) = figures.next() else { break };
                let [displacement, velocity] = axis.drive.mode(index);
                let decay = (mode.damping * mode.natural() * since).exp();
                let left = mode.amplitude(displacement, velocity) * decay;
                found.push(ModeOutcome {
                    axis: axis.name,
                    frequency: mode.frequency,
                    damping: mode.damping,
                    largest_displacement: figure.displacement,
                    largest_at_tool: figure.at_tool,
                    largest_acceleration: figure.acceleration,
                    planned_acceleration: axis.planned_acceleration,
                    left,
                    left_acceleration: left * mode.natural() * mode.natural(),
                });
            }
        }
        found
    }

    /// Ticks until every axis stayed within the window.
    pub(crate) fn settled(&self) -> u64 {
        self.unsettled
    }
}

impl Running {
    #[inline]
    fn watch_reversal(&mut self, set_point: f64, error: f64, lag: u64, period: f64) {
        let step = set_point - self.last[0];
        let change = (step - (self.last[0] - self.last[1])).abs() / (period * period);
        self.planned_acceleration = self.planned_acceleration.max(change);
        self.last = [set_point, self.last[0]];
        self.since_reversal = self.since_reversal.saturating_add(1);
        if step.abs() > REST {
            if step * self.direction < 0.0 {
                self.reversals += 1;
                self.since_reversal = 0;
            }
            self.direction = step.signum();
        }
        if self.since_reversal <= lag {
            self.reversal_peak = self.reversal_peak.max(error.abs());
        }
    }
}
